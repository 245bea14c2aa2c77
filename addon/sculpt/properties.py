"""How the sculpt tool's strokes are made; on the scene, beside the cutter."""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty

from ..blender.fields import length
from ..common import units
from .pure import brush_stroke, symmetry

AXES = (
    ("NORMAL", "Surface normal", "The tool stands square to the surface under the pointer"),
    ("VIEW", "View", "The tool points at whoever looks"),
    ("UP", "Stock's Z", "The tool stands along the stock's +Z, as on a three-axis machine"),
    ("TILT", "Pen tilt", "The tool leans as the tablet's pen does, upright on the view; a mouse does not lean"),
)
PRESSURES = (
    ("NONE", "Nothing", "The tablet's pressure changes nothing"),
    ("DEPTH", "Depth", "The harder the pen is pressed, the deeper the tool goes"),
    ("FEED", "Feed", "The harder the pen is pressed, the faster the tool is taken to move: more force"),
)
LETTERS = (("X", "X", ""), ("Y", "Y", ""), ("Z", "Z", ""))
MIRRORS = tuple((x, x, f"Mirror in the middle of the stock, along its {x}", 1 << k) for k, x in enumerate("XYZ"))


def _radius(self):
    return 0.5 * self.id_data.riffler.tool.diameter


def _set_radius(self, value):
    self.id_data.riffler.tool.diameter = 2 * value


class RifflerSculpt(bpy.types.PropertyGroup):
    depth: length("Depth", 0.5, "How far the tool goes into the surface, or puts material on it, in mm", 1e-4, 1e4)
    axis: EnumProperty(name="Axis", items=AXES, default="NORMAL", description="Where the tool points")
    pressure: EnumProperty(
        name="Pressure", items=PRESSURES, default="DEPTH", description="What a tablet's pressure does"
    )
    feed: FloatProperty(
        name="Feed",
        default=50.0,
        min=0.01,
        max=1e5,
        precision=1,
        step=100,
        description="In mm/s: how fast the tool is taken to move where the clock or the pressure does not say",
    )
    string: FloatProperty(
        name="Stabiliser",
        subtype="PIXEL",
        default=0.0,
        min=0.0,
        max=500.0,
        precision=0,
        step=100,
        description="The tool is pulled on a string of this length: a hand's trembling stays in the string",
    )
    mirror: EnumProperty(
        name="Mirror",
        items=MIRRORS,
        options={"ENUM_FLAG"},
        default=set(),
        description="Every stroke is made on the other side of the stock's middle, too",
    )
    radial: IntProperty(
        name="Radial",
        default=1,
        min=1,
        max=64,
        description="Every stroke is made so many times around the stock's middle",
    )
    radial_axis: EnumProperty(name="Radial axis", items=LETTERS, default="Z", description="Copies are turned about it")
    strength: FloatProperty(
        name="Strength", subtype="FACTOR", default=0.5, min=0.0, max=1.0, description="How much smoothing smooths"
    )
    accumulate: BoolProperty(
        name="Accumulate",
        default=False,
        description="Within one stroke the tool follows what it has already cut, deeper and deeper; otherwise the "
        "surface as it was at the stroke's start",
    )
    fixtures: PointerProperty(
        name="Fixtures",
        type=bpy.types.Collection,
        description="The tool stays out of this collection's meshes: the pointer's is lifted along its axis, a pen's "
        "hand is pushed back; empty: nothing is in the way",
    )
    show_force: BoolProperty(
        name="Show force",
        default=False,
        description="Draw force, torque and a gauge while a mouse or a tablet cuts, which cannot feel them; a pen with "
        "motors always shows them",
    )
    limit: FloatProperty(
        name="Limit",
        default=3.0,
        min=0.01,
        max=1e5,
        precision=1,
        step=100,
        description="In N: the gauge's mark, beyond which force is drawn in red; torque's is that at the tool's "
        "diameter",
    )
    radius: FloatProperty(
        name="Radius",
        min=5e-4,
        soft_max=100.0,
        max=5e4,
        precision=2,
        get=_radius,
        set=_set_radius,
        description="Of the cutter: half its diameter, in mm",
    )

    def choice(self, mode):
        """How a stroke is made; `mode`: of sculpt/pure/brush_stroke.py."""
        return brush_stroke.Choice(
            mode=mode,
            depth=units.clean(self.depth),
            axis=self.axis,
            pressure=self.pressure,
            feed=units.clean(self.feed),
            string=units.clean(self.string),
            accumulate=self.accumulate,
        )

    def maps(self):
        """The stroke's copies, as sculpt/pure/symmetry.py has them."""
        return symmetry.maps("".join(sorted(self.mirror)), self.radial_axis, self.radial)
