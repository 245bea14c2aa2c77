"""The pen's panel: the device, its feel, and the state of its session."""

import bpy

from ..blender.panel_parts import Sidebar, at_work, give, lines, wrapped
from . import operators, properties
from .trace import RIFFLER_OT_pen_trace

WHAT = {kind: what for kind, _, what, *_ in properties.DEVICES}


class RIFFLER_PT_pen(Sidebar, bpy.types.Panel):
    bl_idname = "RIFFLER_PT_pen"
    bl_label = "Pen (mm, N)"
    bl_order = 8
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout = self.layout
        layout.use_property_decorate = False
        settings = context.scene.riffler.pen
        state = context.window_manager.riffler
        if state.sculpting:
            self._session(layout, context, state)
        else:
            op = layout.operator(operators.RIFFLER_OT_pen_sculpt.bl_idname, icon="STYLUS_PRESSURE")
            give(op, settings, properties.PenSettings)
            if not at_work(layout, context, RIFFLER_OT_pen_trace):
                op = layout.operator(RIFFLER_OT_pen_trace.bl_idname, icon="CURVE_PATH")
                give(op, settings, properties.TraceSettings)
        self._settings(layout, context, settings, not state.sculpting)

    def _session(self, layout, context, state):
        layout.operator(operators.RIFFLER_OT_pen_stop.bl_idname, icon="CANCEL", depress=True)
        lines(layout, state.force, state.text)
        if state.why:
            lines(layout, *wrapped(context, state.why), icon="INFO")
        if state.thread:
            lines(layout, *wrapped(context, state.thread))
        row = layout.row(align=True)
        row.operator(operators.RIFFLER_OT_pen_home.bl_idname)
        row.operator(operators.RIFFLER_OT_pen_reset.bl_idname)

    def _settings(self, layout, context, settings, enabled):
        column = layout.column()
        column.enabled = enabled
        column.use_property_split = True
        column.prop(settings, "device")
        lines(column, *wrapped(context, WHAT[operators.device_of(settings)]))
        if settings.device == properties.RECORDING:
            column.prop(settings, "recording")
        else:
            if operators.device_of(settings) not in properties.ONE_OF_A_KIND:
                column.prop(settings, "which")
            column.prop(settings, "start")
            if settings.start == "ABOVE":
                column.prop(settings, "gap")
            column.prop(settings, "scale")
            column.prop(settings, "axes")
            column.prop(settings, "pivot")
            column.prop(settings, "touch")
        group = column.column(align=True)
        group.prop(settings, "stiffness")
        group.prop(settings, "removal_constant")
        column.prop(settings, "record")
        if settings.record:
            column.prop(settings, "folder")
        column.prop(settings, "keep_trace")


CLASSES = (RIFFLER_PT_pen,)
