"""The list of a sculpt's kept strokes: its panel, and operators on it."""

import bpy
from bpy.props import EnumProperty

from ..blender import operator_parts
from ..blender.panel_parts import Sidebar, lines
from ..translations import local
from . import kept_strokes, live_registry, sculpts

DIRECTIONS = (("UP", "Up", "Cut the stroke earlier"), ("DOWN", "Down", "Cut the stroke later"))
NO_STROKE = "The sculpt has no kept strokes: turn Keep Strokes as Curves on, or use Add Curves"


def sculpt_of(context):
    """The active sculpt, or that of the active stroke's curve."""
    ob = context.object
    if ob is not None and ob.type == "CURVE":
        return kept_strokes.sculpt_of(ob)
    return sculpts.active(context)


def chosen(ob):
    """The list's chosen row, or None."""
    own = ob.riffler.strokes
    return own.rows[own.index] if 0 <= own.index < len(own.rows) else None


class OnStroke:
    """Mixin of operators on the chosen stroke."""

    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        ob = sculpt_of(context)
        if ob is None or chosen(ob) is None:
            return operator_parts.deny(cls, NO_STROKE)
        return not operator_parts.busy(cls, context)

    def cut_again(self, ob):
        """After a change of the list: a stroke that cannot be cut is reported, and the sculpt stays as it was."""
        try:
            kept_strokes.edit(ob)
        except operator_parts.ERRORS as error:
            self.report({"WARNING"}, str(error))
        return {"FINISHED"}


class RIFFLER_OT_stroke_remove(OnStroke, bpy.types.Operator):
    """Remove the stroke, its cut and its curve"""

    bl_idname = "riffler.stroke_remove"
    bl_label = "Remove Stroke"

    def execute(self, context):
        ob = sculpt_of(context)
        own, row = ob.riffler.strokes, chosen(ob)
        if row.curve is not None:
            if row.curve == context.object:
                if row.curve.mode != "OBJECT":
                    bpy.ops.object.mode_set(mode="OBJECT")
                context.view_layer.objects.active = ob
            bpy.data.curves.remove(row.curve.data)
        own.rows.remove(own.index)
        own.index = min(own.index, len(own.rows) - 1)
        return self.cut_again(ob)


class RIFFLER_OT_stroke_move(OnStroke, bpy.types.Operator):
    """Change the order in which the strokes are cut"""

    bl_idname = "riffler.stroke_move"
    bl_label = "Move Stroke"

    direction: EnumProperty(name="Direction", items=DIRECTIONS, default="UP", description="Where the stroke moves")

    def execute(self, context):
        ob = sculpt_of(context)
        own = ob.riffler.strokes
        place = own.index + (-1 if self.direction == "UP" else 1)
        if not 0 <= place < len(own.rows):
            return {"CANCELLED"}
        own.rows.move(own.index, place)
        own.index = place
        return self.cut_again(ob)


class RIFFLER_OT_stroke_edit(OnStroke, bpy.types.Operator):
    """Edit the stroke's curve: the sculpt is cut again while its points move"""

    bl_idname = "riffler.stroke_edit"
    bl_label = "Edit Stroke"

    def execute(self, context):
        ob = sculpt_of(context)
        curve = chosen(ob).curve
        if curve is None or curve.name not in context.view_layer.objects:
            return operator_parts.fail(self, ValueError("The stroke's curve is not in this view layer"))
        if context.object is not None and context.object.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        try:
            live_registry.begin(context, ob)
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        curve.hide_set(False)
        sculpts.select_only(context, curve)
        bpy.ops.object.mode_set(mode="EDIT")
        return {"FINISHED"}


class RIFFLER_OT_strokes_settle(OnStroke, bpy.types.Operator):
    """Make the strokes part of the sculpt: their curves stay as plain curves"""

    bl_idname = "riffler.strokes_settle"
    bl_label = "Settle Strokes"

    def execute(self, context):
        kept_strokes.forget(sculpt_of(context))
        return {"FINISHED"}


class RIFFLER_OT_strokes_restore(OnStroke, bpy.types.Operator):
    """Make the sculpt what its strokes give: changes by other operations since then are lost"""

    bl_idname = "riffler.strokes_restore"
    bl_label = "Discard Other Changes"

    def execute(self, context):
        try:
            kept_strokes.restore(sculpt_of(context))
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        return {"FINISHED"}


class RIFFLER_UL_strokes(bpy.types.UIList):
    bl_idname = "RIFFLER_UL_strokes"

    def draw_item(self, context, layout, data, item, icon, active_data, active_property, index=0):
        row = layout.row(align=True)
        row.prop(item, "on", text="")
        name = row.row()
        name.active = item.on
        if item.curve is None:
            name.label(text="No Curve", icon="ERROR")
        else:
            kind = "ERROR" if item.problem else "CURVE_DATA"
            name.prop(item.curve, "name", text="", emboss=False, icon=kind)


class RIFFLER_PT_strokes(Sidebar, bpy.types.Panel):
    bl_idname = "RIFFLER_PT_strokes"
    bl_label = "Kept Strokes"
    bl_order = 6
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return sculpt_of(context) is not None

    def draw(self, context):
        layout, ob = self.layout, sculpt_of(context)
        layout.prop(context.window_manager.riffler.sculpt, "keep")
        own = ob.riffler.strokes
        row = layout.row()
        row.template_list(RIFFLER_UL_strokes.bl_idname, "", own, "rows", own, "index", rows=4)
        side = row.column(align=True)
        side.operator("riffler.stroke_add_curves", text="", icon="ADD")
        side.operator(RIFFLER_OT_stroke_remove.bl_idname, text="", icon="REMOVE")
        side.separator()
        for direction, icon in (("UP", "TRIA_UP"), ("DOWN", "TRIA_DOWN")):
            side.operator(RIFFLER_OT_stroke_move.bl_idname, text="", icon=icon).direction = direction
        if not own.rows:
            return
        layout.operator(RIFFLER_OT_stroke_edit.bl_idname, icon="EDITMODE_HLT")
        if kept_strokes.at_rest(ob):
            if kept_strokes.borrowed(ob):
                lines(layout, "The strokes belong to the sculpt", "that this one is a copy of", icon="ERROR")
            else:
                lines(layout, "Other operations have changed the sculpt", "since these strokes were cut", icon="ERROR")
                layout.operator(RIFFLER_OT_strokes_restore.bl_idname)
        layout.operator(RIFFLER_OT_strokes_settle.bl_idname)
        for row in own.rows:
            if row.problem:
                lines(layout, local(row.problem), icon="ERROR")


CLASSES = (
    RIFFLER_OT_stroke_remove,
    RIFFLER_OT_stroke_move,
    RIFFLER_OT_stroke_edit,
    RIFFLER_OT_strokes_settle,
    RIFFLER_OT_strokes_restore,
    RIFFLER_UL_strokes,
    RIFFLER_PT_strokes,
)
