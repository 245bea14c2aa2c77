"""The add-on's data on scenes, objects, meshes and the window manager. Lengths in mm, angles in rad.

Each module has the fields of one topic; this one combines them, and attaches them to their owners.
"""

import bpy
from bpy.props import PointerProperty, StringProperty

from .blender.long_work import WorkProgress
from .machining.properties import RifflerMachining, RifflerOperation
from .pen.properties import PenProgress, RifflerPen
from .plan.cutter_properties import RifflerCutter
from .plan.machines import GROUPS, RifflerMachines
from .plan.properties import (
    RifflerFinding,
    RifflerPathCurve,
    RifflerPathRow,
    RifflerPlan,
    RifflerPlanObject,
)
from .program.properties import RifflerVerify
from .sculpt.fields_without_undo import RifflerHandToolFields, RifflerStrokeFields, RifflerToolFields
from .sculpt.hand_tool_properties import RifflerHandTool
from .sculpt.kept_strokes import RifflerKeptStroke, RifflerKeptStrokes, RifflerStrokeRow
from .sculpt.properties import RifflerSculpt
from .sculpt.tool_properties import RifflerTool
from .stock.properties import (
    RifflerClay,
    RifflerCut,
    RifflerMesh,
    RifflerNc,
    RifflerResult,
    RifflerStock,
)


class RifflerScene(bpy.types.PropertyGroup):
    stock: PointerProperty(type=RifflerStock)
    tool: PointerProperty(type=RifflerTool)
    hand_tool: PointerProperty(type=RifflerHandTool)
    cutter: PointerProperty(type=RifflerCutter)
    cut: PointerProperty(type=RifflerCut)
    nc: PointerProperty(type=RifflerNc)
    pen: PointerProperty(type=RifflerPen)
    clay: PointerProperty(type=RifflerClay)
    result: PointerProperty(type=RifflerResult)
    plan: PointerProperty(type=RifflerPlan)
    sculpt: PointerProperty(type=RifflerSculpt)
    machining: PointerProperty(type=RifflerMachining)
    verify: PointerProperty(type=RifflerVerify)
    machines: PointerProperty(type=RifflerMachines)


class RifflerObject(bpy.types.PropertyGroup):
    """On an object. `token` and `mark` of a live sculpt: its displayed state, and its session. Blender's undo restores
    both with the object; on the mesh they would make Blender read the whole mesh again."""

    token: StringProperty()
    mark: StringProperty(description="Identifier of the sculpt's session, which stays after its end")
    plan: PointerProperty(type=RifflerPlanObject)
    stroke: PointerProperty(type=RifflerKeptStroke)
    strokes: PointerProperty(type=RifflerKeptStrokes)


class RifflerProgress(WorkProgress, PenProgress, bpy.types.PropertyGroup):
    """On the window manager: the running operation, and what panels change without undo steps."""

    sculpt: PointerProperty(type=RifflerStrokeFields)
    tool: PointerProperty(type=RifflerToolFields)
    hand_tool: PointerProperty(type=RifflerHandToolFields)


CLASSES = (
    *GROUPS.values(),
    RifflerMachines,
    RifflerStock,
    RifflerTool,
    RifflerHandTool,
    RifflerCutter,
    RifflerCut,
    RifflerNc,
    RifflerPen,
    RifflerClay,
    RifflerResult,
    RifflerFinding,
    RifflerPathCurve,
    RifflerPathRow,
    RifflerPlan,
    RifflerSculpt,
    RifflerOperation,
    RifflerMachining,
    RifflerVerify,
    RifflerScene,
    RifflerMesh,
    RifflerPlanObject,
    RifflerKeptStroke,
    RifflerStrokeRow,
    RifflerKeptStrokes,
    RifflerObject,
    RifflerStrokeFields,
    RifflerToolFields,
    RifflerHandToolFields,
    RifflerProgress,
)
_OWNERS = (
    (bpy.types.Scene, RifflerScene),
    (bpy.types.Mesh, RifflerMesh),
    (bpy.types.Object, RifflerObject),
    (bpy.types.WindowManager, RifflerProgress),
)
_given = []  # owners that have their fields


def attach():
    for owner, group in _OWNERS:
        owner.riffler = PointerProperty(type=group)
        _given.append(owner)


def detach():
    while _given:
        del _given.pop().riffler
