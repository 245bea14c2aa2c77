"""The panel of operations on a sculpt as a whole."""

import bpy

from ..blender.panel_parts import Sidebar, at_work, give, lines
from ..common import units
from ..sculpt import sculpts
from ..translations import CONTEXT, local
from . import clay, properties, protection, relief


class Clay(Sidebar):
    bl_parent_id = "RIFFLER_PT_clay"
    bl_options = {"DEFAULT_CLOSED"}


class RIFFLER_PT_clay(Sidebar, bpy.types.Panel):
    bl_idname = "RIFFLER_PT_clay"
    bl_label = "Clay (mm)"
    bl_order = 4
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout = self.layout
        layout.use_property_decorate = False
        settings = context.scene.riffler.clay
        ob = sculpts.active(context)
        if ob is None:
            lines(layout, "No sculpt is active.", icon="INFO")
        if at_work(layout, context, *clay.CLASSES):
            return
        column = layout.column(align=True)
        row = column.row(align=True)
        row.prop(settings, "pitch", text="Pitch", text_ctxt=CONTEXT)
        op = row.operator(clay.RIFFLER_OT_resample.bl_idname, text="", icon="MESH_GRID")
        op.pitch = settings.pitch
        if ob is not None:
            now = ob.data.riffler.pitch
            for factor, text in ((0.5, local("Finer")), (2.0, local("Coarser"))):
                op = column.operator(
                    clay.RIFFLER_OT_resample.bl_idname, text=f"{text}: {units.trim(factor * now, 4)} mm"
                )
                op.pitch = factor * now
        column = layout.column(align=True)  # one below the other: both labels fit a narrow sidebar
        column.prop(settings, "room")
        column.operator(clay.RIFFLER_OT_room.bl_idname).room = settings.room
        column = layout.column(align=True)
        column.prop(settings, "plane")
        op = column.operator(clay.RIFFLER_OT_crop.bl_idname, text="Crop")
        op.plane = settings.plane.name if settings.plane else ""
        column = layout.column(align=True)
        column.operator(clay.RIFFLER_OT_split.bl_idname, icon="MOD_EXPLODE")
        column.operator(clay.RIFFLER_OT_take_edits.bl_idname, icon="IMPORT")


class RIFFLER_PT_mask(Clay, bpy.types.Panel):
    bl_idname = "RIFFLER_PT_mask"
    bl_label = "Mask"

    def draw(self, context):
        layout = self.layout
        settings = context.scene.riffler.clay
        if at_work(layout, context, protection.RIFFLER_OT_mask_form):
            return
        layout.prop(settings, "form")
        row = layout.row(align=True)
        for how, text in (("REPLACE", "Mask"), ("ADD", "Add"), ("SUBTRACT", "Subtract")):
            op = row.operator(protection.RIFFLER_OT_mask_form.bl_idname, text=text)
            op.form = settings.form.name if settings.form else ""
            op.how = how
        row = layout.row(align=True)
        row.operator(protection.RIFFLER_OT_mask_invert.bl_idname, text="Invert")
        row.operator(protection.RIFFLER_OT_mask_clear.bl_idname, text="Clear")


class RIFFLER_PT_relief(Clay, bpy.types.Panel):
    bl_idname = "RIFFLER_PT_relief"
    bl_label = "Emboss"

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        settings = context.scene.riffler.clay
        layout.template_ID(settings, "image", open="image.open")
        layout.prop(settings, "place")
        column = layout.column(align=True)
        for key in properties.ReliefSettings.__annotations__:
            column.prop(settings, key, **({"text": "Follow"} if key == "follow" else {}))  # fits a narrow sidebar
        if at_work(layout, context, relief.RIFFLER_OT_relief):
            return
        op = layout.operator(relief.RIFFLER_OT_relief.bl_idname, icon="MOD_DISPLACE")
        op.image = settings.image.name if settings.image else ""
        op.place = settings.place.name if settings.place else ""
        give(op, settings, properties.ReliefSettings)


CLASSES = (RIFFLER_PT_clay, RIFFLER_PT_mask, RIFFLER_PT_relief)
