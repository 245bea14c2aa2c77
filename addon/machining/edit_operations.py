"""Edits the list of a job's operations: adds, removes and moves operations, and sets their tools."""

import bpy
import riffler
from bpy.props import EnumProperty, StringProperty

from ..blender import operator_parts
from ..plan import tool_libraries
from . import properties
from .pure.operation_kinds import FIRST, KINDS

DIRECTIONS = (("UP", "Up", "Run it earlier"), ("DOWN", "Down", "Run it later"))


def _has_row(cls, context):
    """True if an operation is selected."""
    if context.scene.riffler.machining.active() is None:
        return operator_parts.deny(cls, "The job has no operations: add one")
    return not operator_parts.busy(cls, context)


class RIFFLER_OT_machining_add(bpy.types.Operator):
    """Add an operation behind the selected one, with the plan's tool"""

    bl_idname = "riffler.machining_add"
    bl_label = "Add Operation"
    bl_options = {"REGISTER", "UNDO"}

    kind: EnumProperty(name="Kind", items=properties.KIND_ITEMS, default="ROUGH", description="What it does")

    @classmethod
    def description(cls, context, properties):
        return KINDS[properties.kind].description

    @classmethod
    def poll(cls, context):
        return not operator_parts.busy(cls, context)

    def execute(self, context):
        settings = context.scene.riffler.machining
        try:
            tool = context.scene.riffler.plan.tool_dict()
        except ValueError as error:
            return operator_parts.fail(self, error)
        row = settings.rows.add()
        row.kind, row.name = self.kind, _unused(settings.rows, KINDS[self.kind].label)
        for key, value in FIRST[self.kind].items():
            setattr(row, key, value)
        row.take_tool(tool)
        last = len(settings.rows) - 1
        place = min(settings.row + 1, last)
        settings.rows.move(last, place)
        settings.row = place
        return {"FINISHED"}


def _unused(rows, label):
    names = {row.name for row in rows}
    return next(name for k in range(1, len(rows) + 2) if (name := label if k == 1 else f"{label} {k}") not in names)


class RIFFLER_OT_machining_remove(bpy.types.Operator):
    """Remove the selected operation"""

    bl_idname = "riffler.machining_remove"
    bl_label = "Remove Operation"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return _has_row(cls, context)

    def execute(self, context):
        settings = context.scene.riffler.machining
        settings.rows.remove(settings.row)
        settings.row = max(0, min(settings.row, len(settings.rows) - 1))
        return {"FINISHED"}


class RIFFLER_OT_machining_move(bpy.types.Operator):
    """Change the order of the operations"""

    bl_idname = "riffler.machining_move"
    bl_label = "Move Operation"
    bl_options = {"REGISTER", "UNDO"}

    direction: EnumProperty(name="Direction", items=DIRECTIONS, default="UP", description="Where the operation moves")

    @classmethod
    def poll(cls, context):
        return _has_row(cls, context)

    def execute(self, context):
        settings = context.scene.riffler.machining
        place = settings.row + (-1 if self.direction == "UP" else 1)
        if not 0 <= place < len(settings.rows):
            return {"CANCELLED"}
        settings.rows.move(settings.row, place)
        settings.row = place
        return {"FINISHED"}


class RIFFLER_OT_machining_tool(bpy.types.Operator):
    """Use this tool for the selected operation"""

    bl_idname = "riffler.machining_tool"
    bl_label = "Tool of the Operation"
    bl_options = {"REGISTER", "UNDO"}

    name: StringProperty(name="Name", description="Name of the tool; empty: the plan's tool")
    path: StringProperty(name="File", description="A tool file; empty: the presets", subtype="FILE_PATH")

    @classmethod
    def poll(cls, context):
        return _has_row(cls, context)

    def execute(self, context):
        scene = context.scene.riffler
        try:
            path = bpy.path.abspath(self.path) if self.path else ""
            tool = tool_libraries.tool(self.name, path) if self.name or path else scene.plan.tool_dict()
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        scene.machining.active().take_tool(tool)
        return {"FINISHED"}


def tool_name(row):
    """The name of an operation's tool for a list."""
    try:
        return riffler.Tool.from_dict(row.tool_dict()).name
    except ValueError:
        return "?"


CLASSES = (
    RIFFLER_OT_machining_add,
    RIFFLER_OT_machining_remove,
    RIFFLER_OT_machining_move,
    RIFFLER_OT_machining_tool,
)
