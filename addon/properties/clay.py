"""Settings of what is done to a sculpt as a whole: pitch, crop, masks, relief."""

import bpy
from bpy.props import BoolProperty, EnumProperty, PointerProperty

from .fields import length

HOW = (
    ("REPLACE", "Replace", "What is protected is this and nothing else"),
    ("ADD", "Add", "This is protected, too"),
    ("SUBTRACT", "Subtract", "This is not protected any more"),
)
RELIEF = (
    ("RAISE", "Raise", "What is light in the picture stands out of the surface"),
    ("ENGRAVE", "Engrave", "What is light in the picture is cut into the surface"),
)


class ReliefSettings:
    """Shared by the panel's settings and the operator."""

    mode: EnumProperty(name="Mode", items=RELIEF, default="RAISE", description="Which way the picture goes")
    depth: length("Depth", 1.0, "Height of what is white in the picture, in mm", 1e-4)
    width: length("Width", 40.0, "Width of the picture, in mm; its height follows", 1e-3)
    invert: BoolProperty(name="Invert", description="What is dark in the picture is high")
    follow: BoolProperty(
        name="Follow Surface",
        default=True,
        description="Heights are over the sculpt's surface; off: over the plane that the picture lies in",
    )


class RifflerClay(ReliefSettings, bpy.types.PropertyGroup):
    pitch: length("Pitch", 0.25, "Distance between rays, in mm: what the surface can resolve", 1e-4)
    room: length("Room", 5.0, "How much larger the sculpt's box becomes on every side, in mm", 1e-3)
    plane: PointerProperty(
        name="Plane", type=bpy.types.Object, description="Its local plane z = 0 is where the sculpt is cut off"
    )
    form: PointerProperty(
        name="Form", type=bpy.types.Object, description="A mesh, or a curve whose closed splines go through the sculpt"
    )
    image: PointerProperty(name="Picture", type=bpy.types.Image, description="Its brightness is the height")
    place: PointerProperty(
        name="Place",
        type=bpy.types.Object,
        description="The picture lies in its local plane z = 0, its middle at the origin, seen from where z points",
    )
