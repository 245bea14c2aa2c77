"""Tracing exact faces with a pen or another device (trace_session.py), polled thirty times a second."""

import time

import bpy
import numpy as np
import riffler

from ..blender import exact_surfaces, handlers, operator_parts, preferences_access, scene_units, views
from ..blender.long_work import LongWork
from ..common import poses, tool_solid
from ..common.job import TaskJob, ThreadTask
from ..sculpt import force_view, sculpt_work
from . import operators, properties, trace_view
from . import session as pen_session
from .pure import trace_run
from .trace_session import TraceSession

LIMIT = 5.0  # N: mark of the gauge, unless the preferences have a limit

_force = _tool = None  # what is drawn (sculpt/force_view.py, trace_view.py)
_told, _told_at = (), 0.0


class RIFFLER_OT_pen_trace(sculpt_work.TakesTool, properties.TraceSettings, LongWork, bpy.types.Operator):
    """Lead the tool over the exact faces of the active object with a pen or another device, which feels them; not over
    their triangles. Until Esc, or until the operator is called again
    """

    bl_idname = "riffler.pen_trace"
    bl_label = "Trace"
    bl_options = set()  # it pushes its undo step itself, at the end
    doing = "Reading Exact Faces"
    cancelled = "Not traced: reading the exact faces was cancelled"

    seconds: operators.seconds_field()

    @classmethod
    def poll(cls, context):
        if pen_session.running is not None:
            return True
        if why := exact_surfaces.unfit(context.object):
            return operator_parts.deny(cls, why)
        return operator_parts.object_mode(cls, context) and not operator_parts.busy(cls, context)

    def execute(self, context):
        """Runs the session for `seconds`, in one call."""
        if pen_session.running is not None:
            return operators.stop(self)
        if not self.seconds > 0:
            return operator_parts.fail(self, ValueError(operators.NO_SECONDS))
        self._windowed = False
        return LongWork.execute(self, context)

    def invoke(self, context, event):
        if pen_session.running is not None or self.seconds > 0 or bpy.app.background or context.window is None:
            return self.execute(context)
        self._windowed = True
        return LongWork.invoke(self, context, event)

    def begin(self, context):
        self._object = context.object.name
        read = exact_surfaces.reader(context, context.object)

        def near(progress):
            surface = read(progress)
            return surface, trace_run.collider(surface)

        return TaskJob(ThreadTask(near))

    def lost(self, context):
        there = context.scene.objects.get(self._object)
        return "" if there is not None else "Not traced: the object was removed meanwhile"

    def finish(self, context, job):
        if why := self.lost(context):
            raise ValueError(why)
        ob = context.scene.objects[self._object]
        tool = riffler.Tool.from_dict(self.tool_dict(context))
        options = self._options(context, ob)
        device = operators.open_device(self)
        view = self.axes == "VIEW"
        session = TraceSession(context, ob, device, tool, job.result, options, self.keep_trace, _leave, view)
        if not self._windowed:
            return operators.run_through(self, session)
        _show(context, session)
        bpy.app.timers.register(_look, first_interval=operators.FRAME)
        return {"FINISHED"}

    def _options(self, context, ob):
        """Options of riffler.Session, whose frame is the world in mm."""
        clean, mm = scene_units.clean, scene_units.mm_per_unit(context.scene)
        options = {"stiffness": clean(self.stiffness), **preferences_access.limits()}
        if self.device == properties.RECORDING:
            return options
        options |= {"scale": clean(self.scale), "pivot": clean(self.pivot), "touch": self.touch}
        if self.start == "CURSOR":
            tip = np.array(context.scene.cursor.location) * mm
        else:
            matrix = np.array(ob.matrix_world, float)
            corners = poses.transform_points(matrix, np.array(ob.bound_box, float)) * mm
            lower, upper = corners.min(axis=0), corners.max(axis=0)
            tip = np.append(0.5 * (lower + upper)[:2], upper[2] + clean(self.gap))
        return options | {"at": [*tip, 0, 0, 1]}


def _show(context, session):
    global _force, _tool
    unit = 1 / scene_units.mm_per_unit(context.scene)
    solid = tool_solid.solid(session.tool.outline(tolerance=0.02 * session.diameter))
    _tool = trace_view.begin(solid, unit)  # first, so that the force is drawn over the tool
    limit = preferences_access.limits().get("max_force") or LIMIT
    _force = force_view.begin(limit, session.diameter, np.diag([unit, unit, unit, 1.0]))
    _tell(session)


def _look():
    """Timer function while the session runs."""
    return operators.look_at(TraceSession, _tell)


def _tell(session):
    global _told, _told_at
    run = session.run
    if _tool is not None and run.pose is not None:
        moved = _tool.pose is None or not np.array_equal(_tool.pose, run.pose)
        _tool.pose, _tool.contact = run.pose, run.contact
        _force.pose, (_force.force, _force.torque) = run.pose, run.push
        if moved:
            views.redraw()
    told = f"Hand: {run.state}, {run.force:.2f} N", session.state(), run.why, run.thread
    if told == _told or time.perf_counter() - _told_at < operators.TELL:
        return
    _told, _told_at = told, time.perf_counter()
    state = bpy.context.window_manager.riffler
    state.force, state.text, state.why, state.thread = told
    operators.say("Riffler: " + "    ".join(filter(None, (*told[:2], "Esc: end", run.why))))
    views.redraw_sidebars(bpy.context)


def _leave():
    """Called when the session has ended, for any reason."""
    global _force, _tool, _told
    _told = ()
    if _tool is not None:
        _force = _tool = None
        force_view.end()
        trace_view.end()
        views.redraw()
    operators.say(None)
    views.redraw_sidebars(bpy.context)


@bpy.app.handlers.persistent
def _before_load(*_):
    """Blender removes the timer, and with it what would end the session."""
    if isinstance(pen_session.running, TraceSession):
        pen_session.running.drop()


_HANDLERS = {"load_pre": _before_load}


def attach():
    handlers.listen(_HANDLERS)


def detach():
    handlers.ignore(_HANDLERS)
    handlers.stop(_look, operators.hush)
    if isinstance(pen_session.running, TraceSession):
        pen_session.running.drop()


CLASSES = (RIFFLER_OT_pen_trace,)
