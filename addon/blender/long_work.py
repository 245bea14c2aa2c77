"""Long work: one shell for all operators that take noticeable time.

In a window the work runs on a timer, in slices (a cut) or on a thread of its own (a native task): the status bar and
the panel show its progress, the view can be turned, and Esc cancels and restores everything. Without a window, from a
script, and when settings change in the redo panel, the work runs in one call. In both cases finished work is one undo
step, and cancelled or failed work leaves nothing behind.
"""

import time

import bpy
from bpy.props import FloatProperty, StringProperty

from ..common.job import RefreshClock, run_through, slice_budget
from ..translations import local
from . import handlers, operator_parts, views

TELL = 0.1  # s between two reports of progress
TICK = {False: 0.01, True: 0.05}  # s between two steps: of work in slices; of a check on a thread

AGAIN, SETTLED = 0.5, 10.0  # s between redraws of the sidebars after the end, and their duration

CLASSES = ()
_until = 0.0  # until then the sidebars are redrawn
_running = None  # the operator whose work runs in a window, or None


class WorkProgress:
    running: StringProperty(description="Running operation (“Cutting”); empty if there is none")
    simulating: StringProperty(description="The program being simulated; empty if there is none")
    shading: StringProperty(description="Shading of the views before they showed colours of distances")
    percent: FloatProperty(name="Progress", subtype="PERCENTAGE", min=0, max=100, precision=0)
    notice: StringProperty(description="Message about sculpts that no operator reports; empty if there is none")
    text: StringProperty(description="Progress in words")


class LongWork:
    """Mixin of operators. A subclass has `begin(context)`, which returns the job (common/job.py), or raises one of
    operator_parts.ERRORS without having changed anything; and `finish(context, job)`, which takes over the finished
    job's result and returns the operator's result. Its own attributes hold names, not references to Blender's data,
    which the next event may free."""

    doing = ""  # for the panel, the status bar, and the tooltips of operators that must wait: "Finding pencil paths"
    cancelled = ""  # the report after Esc
    _job = None  # Blender also calls `cancel` before anything has begun, when a file selector is closed

    def lost(self, context):
        """Why the work is pointless now, since its input has changed; otherwise ""."""
        return ""

    def show(self, context, job):
        """Shows the unfinished work; never takes more than a share of the time."""

    def restore(self, context):
        """Removes what `show` has shown."""

    # ------------------------------------------------------------------ in one go
    def execute(self, context):
        wm = context.window_manager
        wm.progress_begin(0, 100)
        try:
            job = self.begin(context)
            run_through(job, lambda share: wm.progress_update(100 * share))
            return self.finish(context, job)
        except operator_parts.ERRORS as error:
            self.cancel(context)
            return operator_parts.fail(self, error)
        finally:
            wm.progress_end()

    # ------------------------------------------------------------------ in a window
    def invoke(self, context, event):
        global _running
        if bpy.app.background or context.window is None:
            return self.execute(context)
        try:
            self._job = self.begin(context)
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        self._clock, self._shown, self._spent = RefreshClock(), False, 0.0
        self._left, self._told = time.perf_counter(), 0.0
        wm = context.window_manager
        wm.progress_begin(0, 100)
        wm.riffler.running = self.doing
        self._timer = wm.event_timer_add(TICK[self._job.in_background], window=context.window)
        wm.modal_handler_add(self)
        _running = self
        self._tell(context)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if self._job is None:  # ended from outside, by `detach`
            return {"CANCELLED"}
        if event.type == "ESC" and event.value == "PRESS":
            self.cancel(context)
            self.report({"INFO"}, local(self.cancelled))
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"} if event.type in operator_parts.NAVIGATION else {"RUNNING_MODAL"}
        try:
            return self._tick(context)
        except operator_parts.ERRORS as error:
            self.cancel(context)
            return operator_parts.fail(self, error)
        except BaseException:
            self.cancel(context)
            raise

    def cancel(self, context):
        """Discards the work. Blender also calls it when the window closes or another file is opened."""
        if self._job is None:
            return
        try:
            self._job.cancel()
            if self._shown and not self.lost(context):
                self.restore(context)
        finally:
            self._end(context)

    def _tick(self, context):
        if why := self.lost(context):
            self.cancel(context)
            self.report({"WARNING"}, why)
            return {"CANCELLED"}
        outside = time.perf_counter() - self._left  # the time that drawing the window took
        if self._spent:
            self._clock.spent(self._spent + outside)
            self._spent = 0.0
        if self._job.step(0.0 if self._job.in_background else slice_budget(outside)):
            done = self.finish(context, self._job)
            self._end(context)
            return done
        self._refresh(context)
        self._tell(context)
        self._left = time.perf_counter()
        return {"RUNNING_MODAL"}

    def _refresh(self, context):
        if self._clock.due():
            begin = time.perf_counter()
            self._shown = True
            self.show(context, self._job)
            self._spent = time.perf_counter() - begin

    def _tell(self, context):
        if time.perf_counter() - self._told < TELL:
            return
        self._told = time.perf_counter()
        state = context.window_manager.riffler
        state.percent = 100 * self._job.fraction
        state.text = self._job.text or "Esc cancels"
        context.window_manager.progress_update(state.percent)
        _status(context, f"Riffler: {local(self.doing)}, {state.percent:.0f} %    {local('Esc: cancel')}")
        views.redraw_sidebars(context)

    def _end(self, context):
        global _running
        _running = self._job = None
        wm = context.window_manager
        wm.event_timer_remove(self._timer)
        wm.progress_end()
        wm.riffler.running = ""
        _status(context, None)
        views.redraw_sidebars(context)
        _settle()


def _settle():
    """Redraws the sidebars after the end. The button that began the work is grey until then, and Blender does not
    refresh a button under the pointer, so the sidebar is redrawn until the pointer has left it."""
    global _until
    _until = time.monotonic() + SETTLED
    if not bpy.app.timers.is_registered(_redraw):
        bpy.app.timers.register(_redraw, first_interval=AGAIN)


def _redraw():
    views.redraw_sidebars(bpy.context)
    return AGAIN if time.monotonic() < _until else None


def _status(context, text):
    if context.workspace is not None:  # None while another file is opened
        context.workspace.status_text_set(text)


def detach():
    """Cancels running work."""
    try:
        if _running is not None:
            _running.cancel(bpy.context)
    finally:
        handlers.stop(_redraw)  # registered by the end of the work
