"""Settings of the sculpt tool's strokes, on the scene, next to the cutter's."""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty

from ..blender.fields import length
from ..common import units
from .pure import brush_stroke, symmetry

AXES = (
    ("NORMAL", "Surface Normal", "The tool stands perpendicular to the surface under the pointer"),
    ("VIEW", "View", "The tool points towards the viewer"),
    ("UP", "Stock's Z", "The tool stands along the stock's +Z, as on a three-axis machine"),
    ("TILT", "Pen Tilt", "The tool tilts with the tablet's pen; with a mouse it points towards the viewer"),
)
PRESSURES = (
    ("NONE", "Nothing", "Ignore the tablet's pressure"),
    ("DEPTH", "Depth", "More pressure makes the stroke deeper"),
    ("FEED", "Feed", "More pressure makes the tool's assumed speed higher, and so its force"),
)
# Named as those of Blender's brushes.
FALLOFFS = (
    ("SMOOTH", "Smooth", "Round at the centre and at the rim", "SMOOTHCURVE", 0),
    ("SMOOTHER", "Smoother", "Rounder at the centre and at the rim", "SMOOTHCURVE", 1),
    ("SPHERE", "Sphere", "A half sphere, steep at the rim", "SPHERECURVE", 2),
    ("ROOT", "Root", "Pointed at the centre, steep at the rim", "ROOTCURVE", 3),
    ("SHARP", "Sharp", "Pointed at the centre, flat at the rim", "SHARPCURVE", 4),
    ("LINEAR", "Linear", "A cone", "LINCURVE", 5),
    ("SHARPER", "Sharper", "More pointed at the centre, flatter at the rim", "SHARPCURVE", 6),
    ("INVERSE_SQUARE", "Inverse Square", "Round at the centre, steep at the rim", "INVERSESQUARECURVE", 7),
    ("CONSTANT", "Constant", "The same up to the rim", "NOCURVE", 8),
)
LETTERS = (("X", "X", ""), ("Y", "Y", ""), ("Z", "Z", ""))
MIRRORS = tuple((x, x, f"Mirror in the middle of the stock, along its {x}", 1 << k) for k, x in enumerate("XYZ"))


def _radius(self):
    return 0.5 * self.id_data.riffler.tool.diameter


def _set_radius(self, value):
    self.id_data.riffler.tool.diameter = 2 * value


def _width(self):
    return self.id_data.riffler.hand_tool.width


def _set_width(self, value):
    self.id_data.riffler.hand_tool.width = value


class RifflerSculpt(bpy.types.PropertyGroup):
    depth: length("Depth", 0.5, "Depth that the tool cuts into the surface, or height that it adds, in mm", 1e-4, 1e4)
    axis: EnumProperty(name="Axis", items=AXES, default="NORMAL", description="Direction of the tool's axis")
    pressure: EnumProperty(
        name="Pressure", items=PRESSURES, default="DEPTH", description="Effect of the tablet's pressure"
    )
    feed: FloatProperty(
        name="Feed",
        default=50.0,
        min=0.01,
        max=1e5,
        precision=1,
        step=100,
        description="Speed of the tool in mm/s, where neither the clock nor the pressure sets it",
    )
    string: FloatProperty(
        name="Stabiliser",
        subtype="PIXEL",
        default=0.0,
        min=0.0,
        max=500.0,
        precision=0,
        step=100,
        description="Length of a string by which the pointer pulls the tool, which smooths out tremor",
    )
    mirror: EnumProperty(
        name="Mirror",
        items=MIRRORS,
        options={"ENUM_FLAG"},
        default=set(),
        description="Mirror every stroke in the middle of the stock",
    )
    radial: IntProperty(
        name="Radial",
        default=1,
        min=1,
        max=64,
        description="Number of times that every stroke is made around the middle of the stock",
    )
    radial_axis: EnumProperty(
        name="Radial Axis", items=LETTERS, default="Z", description="Axis that the copies are turned about"
    )
    strength: FloatProperty(
        name="Strength",
        subtype="FACTOR",
        default=0.5,
        min=0.0,
        max=1.0,
        description="Strength of smoothing, and of brushes that level, pull or pinch",
    )
    falloff: EnumProperty(
        name="Falloff",
        items=FALLOFFS,
        default="SMOOTH",
        description="How the effect of a brush fades from its centre to its radius",
    )
    accumulate: BoolProperty(
        name="Accumulate",
        default=False,
        description=(
            "Let the tool cut deeper where one stroke crosses itself; off: it follows the surface from "
            "before the stroke"
        ),
    )
    keep: BoolProperty(
        name="Keep Strokes as Curves",
        default=False,
        description=(
            "Keep each stroke of Carve, Add and Hand Tool as a curve object: moving its points cuts the sculpt again"
        ),
    )
    fixtures: PointerProperty(
        name="Fixtures",
        type=bpy.types.Collection,
        description=(
            "Collection of meshes that the tool stays out of: the pointer's tool is lifted along its "
            "axis, a pen pushes the hand back; empty: no fixtures"
        ),
    )
    show_force: BoolProperty(
        name="Show Force",
        default=False,
        description=(
            "Draw force, torque and a gauge while a mouse or a tablet cuts; a pen with motors always shows them"
        ),
    )
    limit: FloatProperty(
        name="Limit",
        default=3.0,
        min=0.01,
        max=1e5,
        precision=1,
        step=100,
        description=(
            "Mark of the force gauge, in N: larger forces are drawn in red; the torque's mark is this "
            "force times the tool's diameter"
        ),
    )
    radius: FloatProperty(
        name="Radius",
        min=5e-4,
        soft_max=100.0,
        max=5e4,
        precision=2,
        get=_radius,
        set=_set_radius,
        description="Radius of the cutter, in mm",
    )
    width: FloatProperty(
        name="Width",
        min=0.01,
        soft_max=100.0,
        max=1e4,
        precision=2,
        get=_width,
        set=_set_width,
        description="Width of the hand tool, in mm",
    )

    def choice(self, mode):
        """The settings of a stroke; `mode`: of sculpt/pure/brush_stroke.py."""
        hand = self.id_data.riffler.hand_tool
        return brush_stroke.Choice(
            mode=mode,
            depth=units.clean(self.depth),
            axis=self.axis,
            pressure=self.pressure,
            feed=units.clean(self.feed),
            string=units.clean(self.string),
            accumulate=self.accumulate,
            strength=units.clean(self.strength),
            falloff=self.falloff.lower(),
            lean=units.clean(hand.lean),
            turn=units.clean(hand.turn),
        )

    def maps(self):
        """The stroke's symmetric copies, in the form of sculpt/pure/symmetry.py."""
        return symmetry.maps("".join(sorted(self.mirror)), self.radial_axis, self.radial)
