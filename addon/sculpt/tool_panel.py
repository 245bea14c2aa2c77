"""The cutter of strokes and cuts: its presets and its sizes."""

import bpy

from ..blender import operator_parts
from ..blender.panel_parts import Sidebar
from ..common import presets
from ..translations import CONTEXT


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


class RIFFLER_PT_tool(Sidebar, bpy.types.Panel):
    bl_idname = "RIFFLER_PT_tool"
    bl_label = "Tool (mm)"
    bl_order = 3

    def draw(self, context):
        layout = self.layout
        preset = context.scene.riffler.tool.from_preset()
        layout.menu(RIFFLER_MT_tools.bl_idname, text=preset["name"] if preset else "Custom", text_ctxt=CONTEXT)
        layout.use_property_split = True
        layout.use_property_decorate = False
        tool = context.window_manager.riffler.tool  # its fields make no undo steps
        layout.prop(tool, "kind")
        column = layout.column(align=True)
        for key in presets.SIZES[tool.kind]:
            column.prop(tool, key)


CLASSES = (RIFFLER_OT_tool_preset, RIFFLER_MT_tools, RIFFLER_PT_tool)
