"""A plan's settings: part, tool, machine; and the data on a plan's objects."""

import json

import bpy
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

from ..blender.fields import length
from ..blender.object_surfaces import WITH_SURFACE
from ..common import json_object, presets
from ..pen.properties import TurningDevice
from . import strategy_fields
from .machines import MACHINES

SHOWN = (
    ("CONTACTS", "Contacts", "Where the cutter touches the part, on both sides of each path", 1),
    ("NORMALS", "Normals", "Normals of the part at the contacts", 2),
    ("AXES", "Axes", "Axes of the tool along each path; those of keys are highlighted", 4),
)


LEAVE = (
    ("CLEAR", "Clear Direction", "Along the tool axis where that is clear, otherwise in another direction"),
    ("UP", "Up", "Along the scene's z"),
)


class FindSettings:
    """Shared by the panel's settings and the operator: the strategy, and the parameters of all strategies."""

    __annotations__ = strategy_fields.FIELDS


def _named(settings, context):
    from . import replan

    replan.name_paths(settings.id_data)


class RifflerPlan(FindSettings, TurningDevice, bpy.types.PropertyGroup):
    """On a scene. The tool is stored whole, so that a plan can be made again without the tool's file."""

    part: PointerProperty(
        name="Part",
        type=bpy.types.Object,
        poll=lambda _, ob: ob.type in WITH_SURFACE,
        description="The finished part, as it lies in the scene",
    )
    sized: StringProperty(description="Part, and its unit, whose size was confirmed")
    slide: BoolProperty(
        name="Slide along Path",
        default=True,
        description="The tool follows the hand along the path; otherwise it turns where it is",
    )
    fixtures: PointerProperty(
        name="Fixtures",
        type=bpy.types.Collection,
        description="Vises, clamps and other objects that the tool must stay clear of",
    )
    tool: StringProperty(name="Tool", description="Cutter, shank and holder as JSON", default="")
    source: StringProperty(name="From", description="The file that the tool was taken from; empty: the presets")
    clearance: length("Clearance", 0.0, "Distance that shank and holder keep from part and fixtures, in mm")
    plane: length(
        "Clearance Plane",
        0.0,
        "z in mm of the scene, above part, fixtures and stock, at which the tool goes from path to path; 0: 10 mm "
        "above what is known",
        -1e5,
    )
    retract: length("Retract", 0.0, "mm that the tool first leaves a cut by; 0: what is clear, the shortest first")
    leave: EnumProperty(
        name="Leave",
        items=LEAVE,
        default="CLEAR",
        description="Direction in which the tool leaves and approaches a cut",
    )
    lead_in: length(
        "Lead-In", 0.0, "mm before a cut that are fed, with air above them; 0: all the way from the clearance plane"
    )
    feed: length("Feed", 800.0, "mm/min at the tip", 0.001, 1e6)
    spindle: FloatProperty(name="Spindle", default=12000.0, min=0.0, max=1e6, precision=0, description="rev/min")
    show: EnumProperty(
        name="Show",
        items=SHOWN,
        options={"ENUM_FLAG"},
        default={"CONTACTS", "AXES"},
        description="What to draw of the active plan while the Orient tool is active",
    )
    draw_paths: BoolProperty(
        name="Draw Paths", default=True, description="Draw thick lines, coloured by the tool's movement along them"
    )
    frame_names: BoolProperty(
        name="Path Names",
        default=True,
        update=_named,
        description="Markers on the timeline where each path begins",
    )
    post: EnumProperty(
        name="Machine", items=MACHINES, default="tcp", description="Machine that the NC code is written for"
    )

    def tool_dict(self):
        """The tool in the form of riffler.Tool.to_dict. ValueError if the text is invalid."""
        if not self.tool:
            return presets.preset(presets.presets()[0]["name"])
        return json_object.loads(self.tool, "the plan's tool (take one from a library)")

    def take(self, tool, source=""):
        self.tool = json.dumps(tool, ensure_ascii=False)
        self.source = source


class RifflerFinding(bpy.types.PropertyGroup):
    """One row of a list. `path` and `point`: of the plan, from 0; -1: the finding belongs to a program's row. `place`:
    mm of the scene."""

    name: StringProperty()
    title: StringProperty(description="Text of the list's row, with kind, size and place first; empty: the name")
    kind: StringProperty()
    path: IntProperty(default=-1)
    point: IntProperty(default=-1)
    row: IntProperty(default=-1)
    line: IntProperty()
    frame: FloatProperty()
    place: FloatVectorProperty(size=3)


STATES = (
    ("free", "Free", "Resolved: the tool is clear of part and fixtures along the whole path"),
    ("blocked", "Blocked", "The tool collides somewhere on the path: turn its keys, or switch the path off"),
    ("keyed", "To Resolve", "The path has not been resolved since it was found or turned"),
    ("unplanned", "No Keys", "The path has no key orientation"),
    ("off", "Off", "The path is off: it is neither resolved nor written"),
)


def _switched(row, context):
    """Called for a box in the list; a value written by the add-on equals the plan's already."""
    from . import path_switches

    path_switches.follow(row)


def _chosen(p, context):
    from . import path_switches

    path_switches.go(context, p.id_data, p.row)


class RifflerPathRow(bpy.types.PropertyGroup):
    """A list's row for a path."""

    name: StringProperty()
    length: FloatProperty(description="mm")
    state: EnumProperty(items=STATES, default="unplanned")
    on: BoolProperty(
        name="On", default=True, update=_switched, description="Paths that are off are neither resolved nor written"
    )


class RifflerPathCurve(bpy.types.PropertyGroup):
    """The curve object of one path, and the name it was given."""

    name: StringProperty()
    curve: PointerProperty(type=bpy.types.Object)


class RifflerPlanObject(bpy.types.PropertyGroup):
    """On a plan's Empty: the plan's image, the panel's facts, and the objects that show its paths, in order
    (plan/path_curves.py)."""

    store: PointerProperty(type=bpy.types.Image)
    part: PointerProperty(type=bpy.types.Object)
    paths: IntProperty()
    length: FloatProperty()
    keyed: IntProperty()
    resolved: IntProperty(default=-1)  # of the paths with keys; -1 in a file from before it was counted
    tool: StringProperty()
    curves: CollectionProperty(type=RifflerPathCurve)
    rows: CollectionProperty(type=RifflerPathRow, description="The plan's paths, in order")
    row: IntProperty(name="Path", default=-1, update=_chosen, description="Selected finding in the list, from 0")
    findings: CollectionProperty(
        type=RifflerFinding, description="What resolving the paths changed, and what it could not"
    )
    index: IntProperty(name="Finding", default=-1, description="Selected finding in the list, from 0")

    def forget(self, paths):
        """Removes findings of paths, by their numbers from 0, that have changed."""
        for k in reversed(range(len(self.findings))):
            if self.findings[k].path in paths:
                self.findings.remove(k)
