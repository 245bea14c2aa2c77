"""How a curve is cut along, and how cuts become NC code."""

import bpy
from bpy.props import BoolProperty, EnumProperty, PointerProperty

from .fields import length

AXES = (
    ("UP", "Stock's Z", "The tool stands along the stock's +Z: three-axis work"),
    (
        "TILT",
        "Curve tilt",
        "The tool stands square to the curve and upright, turned about the curve by its tilt (Ctrl T)",
    ),
    ("NORMAL", "Surface normal", "The tool stands along the sculpt's surface normal nearest to the curve"),
)
POSTS = (
    ("3-axis", "3-axis", "X Y Z; every cut must have the tool along the stock's Z"),
    (
        "tcp",
        "5-axis TCP",
        "Tip in part coordinates with A and C, for controllers with tool centre point control (G43.4)",
    ),
)


class CutSettings:
    """Shared by the panel's settings and the operator."""

    axis: EnumProperty(name="Axis", items=AXES, default="UP", description="Where the tool points")
    depth: length("Depth", 1.0, "How far below the curve the tip goes, against the tool's axis, in mm", -1e5)
    follow: BoolProperty(
        name="Follow surface",
        default=False,
        description="Take the nearest points of the surface instead of the curve's",
    )
    tolerance: length("Tolerance", 0.01, "Largest distance from the exact curve and the exact sweep, in mm", 1e-5, 10.0)


class NcSettings:
    """Shared by the panel's settings and the operator."""

    post: EnumProperty(name="Post", items=POSTS, default="3-axis", description="The machine that the NC code is for")
    feed: length("Feed", 600.0, "mm/min at the tip", 0.001, 1e6)
    spindle: length("Spindle", 12000.0, "rev/min", 0.0, 1e6)


class RifflerCut(CutSettings, bpy.types.PropertyGroup):
    curve: PointerProperty(
        name="Curve", type=bpy.types.Object, poll=lambda _, ob: ob.type == "CURVE", description="Curve to cut along"
    )


class RifflerNc(NcSettings, bpy.types.PropertyGroup):
    pass
