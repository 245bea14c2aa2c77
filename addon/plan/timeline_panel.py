"""A plan's keys: on the timeline, with their problems, and the tool's collisions."""

import bpy

from ..blender.panel_parts import give, lines, wrapped
from ..common import units
from ..common.problems import capitalised
from ..pen import operators as pen_operators
from ..pen import properties as pen_properties
from . import collision_marks, current_pose, plan_states, timeline
from .operators import keys, least_tilt, orient_by_pen
from .panel import OfPlan


class RIFFLER_PT_timeline(OfPlan, bpy.types.Panel):
    bl_idname = "RIFFLER_PT_timeline"
    bl_label = "Key Orientations"

    def draw(self, context):
        layout, ob = self.layout, current_pose.plan_object(context)
        layout.operator(keys.RIFFLER_OT_plan_to_timeline.bl_idname, icon="TIME")
        if timeline.pair(ob) is None:
            return
        row = layout.row(align=True)
        row.operator(keys.RIFFLER_OT_plan_key_jump.bl_idname, text="", icon="PREV_KEYFRAME").back = True
        row.operator(keys.RIFFLER_OT_plan_key.bl_idname, text="Set Key", icon="KEY_HLT")
        row.operator(keys.RIFFLER_OT_plan_key_delete.bl_idname, text="Delete", icon="KEY_DEHLT")
        row.operator(keys.RIFFLER_OT_plan_key_jump.bl_idname, text="", icon="NEXT_KEYFRAME").back = False
        layout.operator_menu_enum(least_tilt.RIFFLER_OT_plan_least_tilt.bl_idname, "paths", icon="KEYTYPE_KEYFRAME_VEC")
        now = plan_states.state(ob)
        for problem in (*timeline.faults(timeline.pair(ob)[0], context.scene), *now.problems):
            lines(layout, *wrapped(context, problem), icon="ERROR")
        if now.motions:
            icon = "CHECKMARK" if now.difference.small else "ERROR"
            lines(layout, *wrapped(context, str(now.difference)), icon=icon)
        self._turn(layout, context)
        self._pen(layout, context)
        layout.operator(keys.RIFFLER_OT_plan_check.bl_idname, icon="MOD_PHYSICS")
        if collision_marks.outdated(ob):
            lines(layout, *wrapped(context, "The marks of collisions may be out of date."), icon="INFO")
        for first, last in now.colliding[:4]:
            lines(layout, *wrapped(context, f"Collides at frames {first} to {last}"), icon="ERROR")
        if len(now.colliding) > 4:
            lines(layout, f"and {units.counted(len(now.colliding) - 4, 'time')} more", icon="BLANK1")

    def _turn(self, layout, context):
        """Draws the button of the tool that turns the plan's tool in the view, and its display options."""
        if not current_pose.tool_active(context):
            layout.operator(
                "wm.tool_set_by_id", text="Orient in View", icon="ORIENTATION_GIMBAL"
            ).name = current_pose.TOOL
            return
        layout.row(align=True).prop(context.scene.riffler.plan, "show")

    def _pen(self, layout, context):
        state = context.window_manager.riffler
        if state.sculpting:
            layout.operator(pen_operators.RIFFLER_OT_pen_stop.bl_idname, icon="CANCEL", depress=True)
            lines(layout, *filter(None, state.force.split(", ", 1)), *wrapped(context, state.text))
            if state.why:
                lines(layout, *wrapped(context, capitalised(state.why)), icon="INFO")
            if state.thread:
                lines(layout, *wrapped(context, state.thread))
            return
        settings = context.scene.riffler.plan
        op = layout.operator(orient_by_pen.RIFFLER_OT_plan_pen.bl_idname, icon="STYLUS_PRESSURE")
        give(op, settings, pen_properties.TurningDevice)
        give(op, context.scene.riffler.pen, pen_properties.HandSettings)
        op.slide = settings.slide
        column = layout.column()
        column.use_property_split, column.use_property_decorate = True, False
        column.prop(settings, "device")
        layout.prop(settings, "slide")


def draw_header(context, layout):
    """Header of the tool that turns the plan's tool."""
    if current_pose.plan_object(context) is None:
        layout.label(text="Select a plan first, or find paths on a part", icon="INFO")
        return
    if timeline.pair(current_pose.plan_object(context)) is None:
        layout.operator(keys.RIFFLER_OT_plan_to_timeline.bl_idname, icon="TIME")
    layout.row(align=True).prop(context.scene.riffler.plan, "show")


CLASSES = (RIFFLER_PT_timeline,)
