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
from .pure.operation_kinds import KINDS, OPERATION_KINDS

KIND_ITEMS = tuple((kind.id, kind.label, kind.description, kind.icon, kind.number) for kind in OPERATION_KINDS)
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

    def options(self, places=lambda collection: []):
        """The arguments of the kind's `plan`. `places`: returns the origins of objects in a collection or None."""
        out = {}
        for field in KINDS[self.kind].fields:
            value = getattr(self, field)
            if field == "points":
                value = places(value)
            out[field] = scene_units.clean(value) if isinstance(value, float) else value
        if "engagement" in out:
            out["engagement"] = scene_units.clean(out["engagement"] / 100)
        for field in ("slope_from", "slope_to"):  # a float32 may be above the largest slope
            if field in out:
                out[field] = min(out[field], math.pi / 2)
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
