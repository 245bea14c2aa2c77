"""The job's panel: stock, axis, the list of operations with their settings, and their moves."""

import bpy

from ..blender.panel_parts import at_work, give, lines, wrapped
from ..common import units
from ..plan.panel import Tab, draw_library
from ..translations import local
from . import calculate, edit_operations, inputs, make_stock, properties
from .pure.operation_kinds import KINDS, fields_of

ICONS = {"OPEN": "FILE_REFRESH", "DONE": "CHECKMARK", "EMPTY": "INFO", "FAILED": "ERROR"}
MEANS = {state: (said, means) for state, said, means in properties.STATES}


def state_of(row, k, glances):
    """The present state of a row: "OPEN" if its settings, or an earlier row, have changed since the calculation."""
    return row.state if row.glance and row.glance == glances.get(k) else "OPEN"


class RIFFLER_UL_operations(bpy.types.UIList):
    bl_idname = "RIFFLER_UL_operations"

    def draw_item(self, context, layout, data, item, icon, active_data, active_property, index=0):
        if index == 0 or not hasattr(self, "_glances"):
            self._glances = inputs.glances(context.scene)
        row = layout.row(align=True)
        row.prop(item, "on", text="")
        state = state_of(item, index, self._glances)
        split = row.split(factor=0.67)
        split.active = item.on
        name = split.row(align=True)
        name.label(text="", icon=ICONS[state] if item.on else "REMOVE")
        name.prop(item, "name", text="", emboss=False)
        end = split.row()
        end.alignment = "RIGHT"
        shown = calculate.clock(item.seconds).split()[0] if state == "DONE" else KINDS[item.kind].label
        end.label(text=shown, translate=state != "DONE")


class RIFFLER_MT_machining_add(bpy.types.Menu):
    bl_idname = "RIFFLER_MT_machining_add"
    bl_label = "Add Operation"

    def draw(self, context):
        add = edit_operations.RIFFLER_OT_machining_add.bl_idname
        for kind in KINDS.values():
            op = self.layout.operator(add, text=kind.label, icon=kind.icon)
            op.kind = kind.id


class RIFFLER_MT_machining_tools(bpy.types.Menu):
    bl_idname = "RIFFLER_MT_machining_tools"
    bl_label = "Tool Library"

    def draw(self, context):
        layout, take = self.layout, edit_operations.RIFFLER_OT_machining_tool.bl_idname
        problems = draw_library(layout, take)
        layout.separator()
        op = layout.operator(take, text="The Plan's Tool", icon="FORWARD")
        op.name = op.path = ""
        for problem in problems:
            layout.label(text=problem, icon="ERROR")


class RIFFLER_PT_job(Tab, bpy.types.Panel):
    bl_idname = "RIFFLER_PT_job"
    bl_label = "Job (mm)"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout, settings = self.layout, context.scene.riffler.machining
        self._stock(layout, context, settings)
        row = layout.row()
        row.template_list(RIFFLER_UL_operations.bl_idname, "", settings, "rows", settings, "row", rows=4)
        column = row.column(align=True)
        column.menu(RIFFLER_MT_machining_add.bl_idname, text="", icon="ADD")
        column.operator(edit_operations.RIFFLER_OT_machining_remove.bl_idname, text="", icon="REMOVE")
        for direction, icon in (("UP", "TRIA_UP"), ("DOWN", "TRIA_DOWN")):
            op = column.operator(edit_operations.RIFFLER_OT_machining_move.bl_idname, text="", icon=icon)
            op.direction = direction
        if (row := settings.active()) is not None:
            self._operation(layout, context, settings, row)
        if at_work(layout, context, calculate.RIFFLER_OT_machining_calculate):
            return
        if why := inputs.unfit(context.scene):
            lines(layout, *wrapped(context, f"{local(why)}."), icon="INFO")
        layout.operator(calculate.RIFFLER_OT_machining_calculate.bl_idname, icon="PLAY")
        if settings.problem:
            lines(layout, *wrapped(context, f"{settings.problem}."), icon="ERROR")
        layout.prop(settings, "draw_moves", toggle=True)
        layout.operator(make_stock.RIFFLER_OT_machining_left.bl_idname, icon="MESH_CUBE")

    def _stock(self, layout, context, settings):
        column = layout.column(align=True)
        column.use_property_split = True
        column.use_property_decorate = False
        column.prop(settings, "stock")
        if inputs.stock_of(context.scene) is None:
            for key in ("shape", "sides", "top", "bottom", "pitch"):
                column.prop(settings, key)
            op = column.operator(make_stock.RIFFLER_OT_machining_stock.bl_idname, icon="MESH_CUBE")
            give(op, settings, properties.StockShape)
        column = layout.column(align=True)
        column.use_property_split = True
        column.use_property_decorate = False
        for key in ("upright", "clearance"):
            column.prop(settings, key)

    def _operation(self, layout, context, settings, row):
        box = layout.box()
        head = box.row(align=True)
        head.label(text=edit_operations.tool_name(row), icon="TOOL_SETTINGS", translate=False)
        head.menu(RIFFLER_MT_machining_tools.bl_idname, text="", icon="DOWNARROW_HLT")
        column = box.column(align=True)
        column.use_property_split = True
        column.use_property_decorate = False
        for key in fields_of(row.kind, row):
            column.prop(row, key)
        if not row.on:
            return
        state = state_of(row, settings.row, inputs.glances(context.scene))
        label, means = MEANS[state]
        said = row.said or means
        if state == "OPEN":
            said = means
        elif state == "DONE":
            said = f"{local(label)}: {calculate.clock(row.seconds)}, {units.trim(row.cut, 0)} mm"
            said += f". {local(row.said)}" if row.said else ""
        lines(box, *wrapped(context, f"{said}."), icon=ICONS[state])


CLASSES = (
    RIFFLER_UL_operations,
    RIFFLER_MT_machining_add,
    RIFFLER_MT_machining_tools,
    RIFFLER_PT_job,
)
