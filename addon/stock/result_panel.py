"""From a sculpt to a mesh, and the distance from a reference."""

import bpy

from ..blender import attributes
from ..blender.panel_parts import Sidebar, at_work, give, lines
from . import properties, result


class RIFFLER_PT_result(Sidebar, bpy.types.Panel):
    bl_idname = "RIFFLER_PT_result"
    bl_label = "Mesh (mm)"
    bl_order = 7
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        settings = context.scene.riffler.result
        if at_work(layout, context, result.RIFFLER_OT_to_mesh, result.RIFFLER_OT_show_deviation):
            return
        column = layout.column(align=True)
        for key in properties.ResultSettings.__annotations__:
            if key != "smooth_tolerance" or settings.iterations:
                column.prop(settings, key)
        op = layout.operator(result.RIFFLER_OT_to_mesh.bl_idname, icon="MESH_DATA")
        give(op, settings, properties.ResultSettings)
        made = context.object.data if context.object is not None and context.object.type == "MESH" else None
        if made is not None and attributes.ERROR in made:
            lines(layout, result.said_of(made), icon="INFO")
            layout.label(text="Try others in Adjust Last Operation (F9)")
        layout.separator()
        layout.prop(settings, "reference")
        layout.prop(settings, "scale")
        row = layout.row(align=True)
        op = row.operator(result.RIFFLER_OT_show_deviation.bl_idname, icon="COLOR")
        op.reference = settings.reference.name if settings.reference else ""
        op.scale = settings.scale
        if made is not None and attributes.SCALE in made:
            row.operator(result.RIFFLER_OT_hide_deviation.bl_idname, text="", icon="X")


CLASSES = (RIFFLER_PT_result,)
