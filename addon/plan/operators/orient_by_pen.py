"""Turns the plan's tool with a pen, mouse, tablet or another device (plan/pen_orientation.py), polled thirty times a
second; what the tool touches and the force on it are drawn."""

import time

import bpy
import numpy as np

from ...blender import handlers, operator_parts, preferences_access, scene_units, views
from ...common.job import AfterJob, DoneJob
from ...pen import operators as pen_operators
from ...pen import properties as pen_properties
from ...pen import session as pen_session
from ...sculpt import force_view
from .. import current_pose, obstacles, plan_store
from ..pen_orientation import PenOrientation
from ..pointer_orientation import PointerOrientation
from . import keys
from .plan_work import PlanWork, part_poll, timeline_poll

NO_EVENTS = "device: mouse and tablet turn the tool in a window only, until Esc; choose another device for a script"
MOST_TORQUE = 300.0  # N·mm: a session's largest, unless the preferences name one

_shown = None  # arrows and gauge (sculpt/force_view.py)
_told, _told_at = (), 0.0


class RIFFLER_OT_plan_pen(pen_properties.HandSettings, pen_properties.TurningDevice, PlanWork, bpy.types.Operator):
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
        if self.device == pen_properties.POINTER:
            return operator_parts.fail(self, ValueError(NO_EVENTS))
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
        session = self._start(context, job.result)
        bpy.ops.wm.tool_set_by_id(name=current_pose.TOOL, space_type="VIEW_3D")
        _show_force(context, session.tool.diameter)
        bpy.app.timers.register(_look, first_interval=pen_operators.FRAME)
        if self.device == pen_properties.POINTER:
            bpy.ops.riffler.plan_pointer("INVOKE_DEFAULT")
        return {"FINISHED"}

    def _spot(self, context, ob):
        spot, _ = keys.spot_at(context, ob)
        plan_store.refuse_turning(spot.plan, spot.path)
        return spot

    def _start(self, context, near):
        spot = self._spot(context, self.ob)
        options = {"slide": self.slide, **preferences_access.limits()}
        if self.device == pen_properties.POINTER:
            session = PointerOrientation(context, spot, near, options, _leave)
        else:
            clean = scene_units.clean
            options |= {"scale": clean(self.scale), "pivot": clean(self.pivot)}
            device = pen_operators.open_device(self)
            session = PenOrientation(context, spot, near, device, options, _leave, view=self.axes == "VIEW")
        _tell(session)
        return session


def _show_force(context, diameter):
    """Arrows and gauges of what the tool touches. Their marks: the largest torque that the hand gets, and the force
    that has it a tool's diameter from the tip."""
    global _shown
    torque = preferences_access.limits().get("max_torque") or MOST_TORQUE
    mm = scene_units.mm_per_unit(context.scene)
    _shown = force_view.begin(torque / diameter, diameter, np.diag([1 / mm, 1 / mm, 1 / mm, 1.0]))


def _look():
    """Timer function while the session runs."""
    return pen_operators.look_at(PenOrientation, _tell)


def _tell(session):
    global _told, _told_at
    run = session.run
    if _shown is not None and run.pose is not None:
        _shown.pose, (_shown.force, _shown.torque) = run.pose, run.push
    if time.perf_counter() - _told_at < pen_operators.TELL:  # the state's distances cost more than the text
        return
    found, why = session.state(), run.why or session.problem
    current_pose.said = (str(found), found.free) if found is not None else None
    hand = f"Hand: {run.state}, {run.force:.2f} N, {run.torque:.0f} N·mm" if run.pushes else ""
    told = hand, f"{session.angles()}: {found}" if found is not None else "", why, run.thread
    if told == _told:
        return
    _told, _told_at = told, time.perf_counter()
    state = bpy.context.window_manager.riffler
    state.force, state.text, state.why, state.thread = told
    pen_operators.say("Riffler: " + "    ".join(filter(None, (*told[:2], session.help, why))))
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


@bpy.app.handlers.persistent
def _before_load(*_):
    """Blender removes the timer, and with it what would end the session."""
    if isinstance(pen_session.running, PenOrientation):
        pen_session.running.drop()


_HANDLERS = {"load_pre": _before_load}


def attach():
    handlers.listen(_HANDLERS)


def detach():
    handlers.ignore(_HANDLERS)
    handlers.stop(_look, pen_operators.hush)


CLASSES = (RIFFLER_OT_plan_pen,)
