"""Properties of a job: stock, settings and operations."""

import json
import math

import bpy
import riffler
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

from ..blender import scene_units
from ..blender.fields import angle, length, stored_number
from ..common import json_object
from ..sculpt import sculpts
from .pure.job_run import Wanted
from .pure.operation_kinds import OPERATION_KINDS, fields_of

KIND_ITEMS = tuple((kind.id, kind.label, kind.description, kind.icon, kind.number) for kind in OPERATION_KINDS)
SIDES = riffler.plan.strategies.swarf.SIDES
PATTERN_LABELS = {
    "parallel": ("Parallel", "Rows in planes, at an angle about the tool's axis"),
    "waterline": ("Waterline", "Level curves around steep faces"),
    "scallop": ("Scallop", "Curves that are equally far from each other on the surface"),
    "spiral": ("Spiral", "One curve around the middle"),
    "radial": ("Radial", "Rays from the middle"),
}
PATTERNS = tuple(
    (name, *PATTERN_LABELS.get(name, (name.capitalize(), "")), "NONE", stored_number(name))
    for name in riffler.plan.PATTERNS
)
ORIENTATIONS = (
    ("AXIS", "Along the Axis", "The tool stands along the job's axis everywhere"),
    ("NORMAL", "Normal", "The tool stands square to the surface, in five axes"),
    ("LEAD", "Lead and Tilt", "The tool leans forward and to the left from the surface's normal, in five axes"),
    ("TOWARDS", "Towards", "The tool's upper end leans towards an object, in five axes"),
    ("AWAY", "Away From", "The tool's upper end leans away from an object, in five axes"),
    ("LEAST", "Least Tilt", "The tool leans only where it would touch part or fixtures otherwise, in five axes"),
)
SHAPES = (
    ("BOX", "Box", "The part's bounding box with an allowance"),
    ("CYLINDER", "Cylinder", "The part's bounding cylinder about the tool's axis, with an allowance"),
)
CALCULATE = "Calculate"
STATES = (
    ("OPEN", "To Calculate", "The operation, or one before it, has changed since the last calculation"),
    ("DONE", "Calculated", "The operation's moves are known"),
    ("EMPTY", "No Moves", "There is nothing that the operation can cut"),
    ("FAILED", "Failed", "The operation cannot be planned, or its moves must not run"),
)


class OperationSettings:
    """The settings of all kinds of operations; each kind uses some of them."""

    stepdown: length("Step Down", 2.0, "Height of a layer, in mm", 1e-3)
    engagement: FloatProperty(
        name="Engagement",
        default=40.0,
        min=2.0,
        max=100.0,
        subtype="PERCENTAGE",
        precision=1,
        description="Largest width of a cut, as a share of the cutter's diameter",
    )
    pattern: EnumProperty(name="Pattern", items=PATTERNS, default="parallel", description="How the rows run")
    cusp: length("Cusp", 0.01, "Largest height of the ridges between rows, in mm", 1e-5)
    angle: angle("Angle", 0.0, "Direction of the rows about the tool's axis", -2 * math.pi, 2 * math.pi)
    orientation: EnumProperty(
        name="Orientation",
        items=ORIENTATIONS,
        default="AXIS",
        description="How the tool stands along the rows. All but the first need a machine with rotary axes",
    )
    facing: EnumProperty(
        name="Orientation",
        items=ORIENTATIONS[:3],
        default="AXIS",
        description="How the tool stands along the curves. All but the first need a machine with rotary axes",
    )
    lead: angle("Lead", 0.0, "How far the tool leans forward from the surface's normal", -1.5, 1.5)
    tilt: angle("Tilt", 0.0, "How far the tool leans to the left from the surface's normal", -1.5, 1.5)
    target: PointerProperty(
        name="Target",
        type=bpy.types.Object,
        description="Object that the tool leans to or from: the origin, or of a curve the nearest point",
    )
    max_tilt: angle("Largest Tilt", math.radians(60), "Largest angle between tool and axis", 0.01, math.radians(80))
    max_turn: angle("Turn in 1 mm", 0.1, "Largest turn of the tool while it moves 1 mm", 1e-3, math.pi)
    curves: PointerProperty(
        name="Curves",
        type=bpy.types.Collection,
        description="Collection whose curve objects are engraved",
    )
    engrave_depth: length("Depth of Cut", 0.3, "mm of a cut below the surface", 1e-3)
    wall: EnumProperty(
        name="Wall",
        items=[(name, label, about, "NONE", stored_number(name)) for name, label, about in SIDES],
        default="better",
        description="Which of the two walls of a valley the flank cuts",
    )
    wall_height: length("Wall Height", 0.0, "mm of wall above the ball's centre; 0: as far as wall and flank reach")
    slope_from: angle("Slope from", 0.0, "Faces that are more level than this are left out", 0.0, math.pi / 2)
    slope_to: angle("Slope to", math.pi / 2, "Faces that are steeper than this are left out", 0.0, math.pi / 2)
    depth: length("Depth", 0.0, "mm of the tip below the part's highest point; 0: down to the underside of the stock")
    tabs: IntProperty(
        name="Tabs", default=0, min=0, max=100, description="Bridges that stay along each loop and hold the part"
    )
    tab_height: length("Tab Height", 1.0, "mm of a bridge above the lowest layer")
    points: PointerProperty(
        name="Holes",
        type=bpy.types.Collection,
        description="Collection whose objects' origins are the mouths of the holes",
    )
    hole_depth: length("Depth of Holes", 10.0, "mm of the tip below the mouth of a hole", 1e-3)
    peck: length("Peck", 0.0, "mm of a peck, after which the drill leaves the hole; 0: in one go")
    passes: IntProperty(
        name="Passes",
        default=1,
        min=1,
        max=100,
        description="1: one path along each valley; each further pass adds a path on either side of it",
    )
    allowance: length("Allowance", 0.3, "mm of material that stay on the part")
    tolerance: length("Tolerance", 0.05, "Largest distance of the tool's path from the exact one, in mm", 1e-4)
    feed: length("Feed", 1200.0, "mm/min of cuts and links", 0.001, 1e6)
    spindle: FloatProperty(name="Spindle", default=12000.0, min=-1e6, max=1e6, precision=0, description="rev/min")


class RifflerOperation(OperationSettings, bpy.types.PropertyGroup):
    """An operation of a job. `key`: identifies the inputs of its stored moves; `glance`: a quick key that a panel can
    compare (`inputs.glances`)."""

    name: StringProperty(name="Name", description="Name of the operation")
    kind: EnumProperty(name="Kind", items=KIND_ITEMS, default="ROUGH", description="What the operation does")
    on: BoolProperty(name="On", default=True, description="Operations that are off are not calculated")
    tool: StringProperty(name="Tool", description="Cutter, shank and holder as JSON")
    key: StringProperty()
    glance: StringProperty()
    state: EnumProperty(items=STATES, default="OPEN")
    seconds: FloatProperty(description="Machining time")
    cut: FloatProperty(description="mm of cuts")
    said: StringProperty(description="What the operation does not do, or why it failed; empty: nothing")

    def tool_dict(self):
        """The tool as a dict. ValueError if the text is invalid."""
        return json_object.loads(self.tool, f"the tool of {self.name} (take another one)")

    def take_tool(self, tool):
        self.tool = json.dumps(tool, ensure_ascii=False)

    def options(self, places=None):
        """The arguments of the kind's `plan`. `places`: returns what the fields of `inputs.PLACES` stand for, given
        field and value; without it they are empty."""
        out = {}
        for field in fields_of(self.kind, self):
            value = getattr(self, field)
            if field in ("points", "curves", "target"):
                value = places(field, value) if places else []
            out[field] = scene_units.clean(value) if isinstance(value, float) else value
        if "engagement" in out:
            out["engagement"] = scene_units.clean(out["engagement"] / 100)
        for field, most in (("slope_from", math.pi / 2), ("slope_to", math.pi / 2), ("max_tilt", math.radians(80))):
            if field in out:
                out[field] = min(out[field], most)  # a float32 may be above the largest value
        return out

    def wanted(self, places):
        """The operation for planning. ValueError if its tool is invalid. `places`: as in `options`."""
        return Wanted(self.name, self.kind, self.tool_dict(), self.options(places))


class StockShape:
    """Settings of a stock around the part, shared by the panel and the operator."""

    shape: EnumProperty(name="Shape", items=SHAPES, default="BOX", description="Shape of the stock")
    sides: length("Sides", 2.0, "mm of material around the part")
    top: length("Top", 1.0, "mm of material above the part")
    bottom: length("Bottom", 0.0, "mm of material below the part")
    pitch: length("Pitch", 0.0, "mm between the stock's rays; 0: what suits its size")


def _is_sculpt(_, ob):
    return sculpts.is_sculpt(ob)


class RifflerMachining(StockShape, bpy.types.PropertyGroup):
    """The job of a scene. `store`: the calculated moves (job_store.py)."""

    stock: PointerProperty(
        name="Stock", type=bpy.types.Object, poll=_is_sculpt, description="The sculpt that the job begins with"
    )
    upright: PointerProperty(
        name="Axis of",
        type=bpy.types.Object,
        description="The tool stands along the z of this object; empty: along the scene's z",
    )
    clearance: length("Clearance", 5.0, "mm above part, stock and fixtures at which the tool goes across", 1e-3)
    zero: FloatVectorProperty(
        name="Zero",
        size=3,
        subtype="XYZ",
        precision=3,
        description="The program's zero in the scene, in mm",
    )
    rows: CollectionProperty(type=RifflerOperation, description="The job's operations, in order")
    row: IntProperty(name="Operation", default=0, min=0, description="Selected operation in the list, from 0")
    draw_moves: BoolProperty(
        name="Draw Moves", default=True, description="Draw the moves of the operations, coloured by their kind"
    )
    store: PointerProperty(type=bpy.types.Image, description="The calculated moves of the operations")
    problem: StringProperty(description="Why the operations must not run; empty if they may")

    def active(self):
        """The selected operation, or None."""
        return self.rows[self.row] if 0 <= self.row < len(self.rows) else None

    def switched_on(self):
        """The operations that are on."""
        return [row for row in self.rows if row.on]
