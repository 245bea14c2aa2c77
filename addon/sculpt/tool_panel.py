"""The cutter of strokes and cuts, and the hand tool: their presets and sizes."""

import bpy

from ..blender import operator_parts
from ..blender.panel_parts import Sidebar
from ..common import hand_tools, presets
from ..translations import CONTEXT
from . import brushes


class RIFFLER_OT_tool_preset(bpy.types.Operator):
    """Use the cutter of this name for strokes and cuts"""

    bl_idname = "riffler.tool_preset"
    bl_label = "Tool Preset"
    bl_options = {"INTERNAL"}  # no undo step, as for all settings of the sculpt tools

    name: bpy.props.StringProperty(name="Name", description="Name of the preset")

    def execute(self, context):
        try:
            context.scene.riffler.tool.take(presets.preset(self.name))
        except ValueError as error:
            return operator_parts.fail(self, error)
        return {"FINISHED"}


class RIFFLER_MT_tools(bpy.types.Menu):
    bl_idname = "RIFFLER_MT_tools"
    bl_label = "Tool Presets"

    def draw(self, context):
        for tool in presets.presets():
            op = self.layout.operator(RIFFLER_OT_tool_preset.bl_idname, text=tool["name"], translate=False)
            op.name = tool["name"]


class RIFFLER_OT_hand_tool_preset(bpy.types.Operator):
    """Use the hand tool of this name"""

    bl_idname = "riffler.hand_tool_preset"
    bl_label = "Hand Tool Preset"
    bl_options = {"INTERNAL"}  # no undo step, as for all settings of the sculpt tools

    name: bpy.props.StringProperty(name="Name", description="Name of the preset")

    def execute(self, context):
        try:
            context.scene.riffler.hand_tool.take(hand_tools.preset(self.name))
        except ValueError as error:
            return operator_parts.fail(self, error)
        return {"FINISHED"}


class RIFFLER_MT_hand_tools(bpy.types.Menu):
    bl_idname = "RIFFLER_MT_hand_tools"
    bl_label = "Hand Tool Presets"

    def draw(self, context):
        for tool in hand_tools.presets():
            op = self.layout.operator(RIFFLER_OT_hand_tool_preset.bl_idname, text=tool["name"], text_ctxt=CONTEXT)
            op.name = tool["name"]


def preset_menu(layout, context, hand):
    """The menu of presets of the cutter or of the hand tool, under the name of the current one."""
    own = context.scene.riffler
    preset = (own.hand_tool if hand else own.tool).from_preset()
    menu = RIFFLER_MT_hand_tools if hand else RIFFLER_MT_tools
    layout.menu(menu.bl_idname, text=preset["name"] if preset else "Custom", text_ctxt=CONTEXT)


def hand_tool_fields(layout, tool):
    """All settings of the hand tool."""
    layout.prop(tool, "kind")
    column = layout.column(align=True)
    for key in hand_tools.KINDS[tool.kind].sizes:
        column.prop(tool, key)
    column = layout.column(align=True)
    column.prop(tool, "lean")
    column.prop(tool, "turn")


class RIFFLER_PT_tool(Sidebar, bpy.types.Panel):
    bl_idname = "RIFFLER_PT_tool"
    bl_label = "Tool (mm)"
    bl_order = 3

    def draw(self, context):
        layout = self.layout
        brush = brushes.active(context)
        hand = brush is not None and brush.hand
        preset_menu(layout, context, hand)
        layout.use_property_split = True
        layout.use_property_decorate = False
        if hand:
            hand_tool_fields(layout, context.window_manager.riffler.hand_tool)
            return
        tool = context.window_manager.riffler.tool  # its fields make no undo steps
        layout.prop(tool, "kind")
        column = layout.column(align=True)
        for key in presets.SIZES[tool.kind]:
            column.prop(tool, key)


CLASSES = (
    RIFFLER_OT_tool_preset,
    RIFFLER_MT_tools,
    RIFFLER_OT_hand_tool_preset,
    RIFFLER_MT_hand_tools,
    RIFFLER_PT_tool,
)
