"""Turns the plan's tool with a pen or another device (plan/pen_orientation.py), polled thirty times a second; what the
tool touches and the force on it are drawn."""

import time

import bpy
import numpy as np

from ...blender import operator_parts, preferences_access, scene_units, views
from ...common.job import AfterJob, DoneJob
from ...pen import operators as pen_operators
from ...pen import properties as pen_properties
from ...pen import session as pen_session
from ...sculpt import force_view
from .. import current_pose, obstacles, plan_store, replan
from ..pen_orientation import PenOrientation
from . import keys
from .plan_work import PlanWork, part_poll, timeline_poll

HELP = "Button 1: set a key    Button 2: delete it    Esc: end"

_shown = None  # arrows and gauge (sculpt/force_view.py)
_told, _told_at = (), 0.0


class RIFFLER_OT_plan_pen(pen_properties.DeviceSettings, PlanWork, bpy.types.Operator):
    """Turn the plan's tool with a pen or another device: the cutter stays on the path, the hand feels what shank and
    holder hit; the first button sets a key orientation, the second deletes it
    """

    bl_idname = "riffler.plan_pen"
    bl_label = "Orient by Pen"
    bl_options = set()  # each key is an undo step of its own
    doing = "Looking at part and fixtures"
    cancelled = "Looking at part and fixtures was cancelled"

    slide: bpy.props.BoolProperty(
        name="Slide along Path",
        default=True,
        description="The tool follows the hand along the path; otherwise it turns where it is",
    )
    seconds: pen_operators.seconds_field()

    @classmethod
    def poll(cls, context):
        if pen_session.running is not None:
            return True
        return timeline_poll(cls, context) and part_poll(cls, context)

    def execute(self, context):
        """Runs the session for `seconds`, in one call."""
        if pen_session.running is not None:
            return pen_operators.stop(self)
        if not self.seconds > 0:
            return operator_parts.fail(self, ValueError(pen_operators.NO_SECONDS))
        try:
            ob, _ = self.take(context)
            self._spot(context, ob)
            session = self._start(context, obstacles.now(context, ob))
        except (*operator_parts.ERRORS, TypeError) as error:
            return operator_parts.fail(self, error)
        return pen_operators.run_through(self, session)

    def invoke(self, context, event):
        if pen_session.running is not None or self.seconds > 0 or bpy.app.background or context.window is None:
            return self.execute(context)
        return PlanWork.invoke(self, context, event)

    def begin(self, context):
        ob, _ = self.take(context)
        self._spot(context, ob)
        return AfterJob(obstacles.take(context, ob), DoneJob)

    def finish(self, context, job):
        global _shown
        session = self._start(context, job.result)
        bpy.ops.wm.tool_set_by_id(name=current_pose.TOOL, space_type="VIEW_3D")
        if session.run.pushes:
            mm = scene_units.mm_per_unit(context.scene)
            limit = scene_units.clean(context.scene.riffler.sculpt.limit)
            _shown = force_view.begin(limit, session.tool.diameter / 2, np.diag([1 / mm, 1 / mm, 1 / mm, 1.0]))
        bpy.app.timers.register(_look, first_interval=pen_operators.FRAME)
        return {"FINISHED"}

    def _spot(self, context, ob):
        spot = current_pose.spot(context.scene, ob)
        if spot is None:
            layout = replan.layout_of(ob, plan_store.plan(ob))
            frame = context.scene.frame_current_final
            raise ValueError(f"Frame {frame:g} is on no path: go to one between {keys.ranges(layout)}")
        plan_store.refuse_turning(spot.plan, spot.path)
        return spot

    def _start(self, context, near):
        spot = self._spot(context, self.ob)
        options = {"slide": self.slide, "scale": scene_units.clean(self.scale), **preferences_access.limits()}
        device = pen_operators.open_device(self)
        session = PenOrientation(context, spot, near, device, options, _leave)
        _tell(session)
        return session


def _look():
    """Timer function while the session runs."""
    session = pen_session.running
    if not isinstance(session, PenOrientation):
        return None
    try:
        if session.look():
            _tell(session)
            return pen_operators.FRAME
    except operator_parts.ERRORS as error:
        session.fail(error)
    level, text, _ = session.summary()
    pen_operators.say(f"Riffler: {text}" if level == "WARNING" else None)
    return None


def _tell(session):
    global _told, _told_at
    run = session.run
    if _shown is not None and run.pose is not None:
        _shown.pose, (_shown.force, _shown.torque) = run.pose, run.push
    if time.perf_counter() - _told_at < pen_operators.TELL:  # the state's distances cost more than the text
        return
    hand = f"Hand: {run.state}, {run.force:.2f} N, {run.torque:.0f} N·mm"
    told = hand, session.state(), session.problem or run.why
    if told == _told:
        return
    _told, _told_at = told, time.perf_counter()
    state = bpy.context.window_manager.riffler
    state.force, state.text, state.why = told
    why = f"    {told[2]}" if told[2] else ""
    pen_operators.say(f"Riffler: {hand}    {told[1]}    {HELP}{why}")
    views.redraw_sidebars(bpy.context)


def _leave():
    """Called when the session has ended, for any reason."""
    global _shown, _told
    _told = ()
    if _shown is not None:
        _shown = None
        force_view.end()
    pen_operators.say(None)
    views.redraw_sidebars(bpy.context)


CLASSES = (RIFFLER_OT_plan_pen,)
