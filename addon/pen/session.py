"""The session of a device with a live sculpt: it cuts on the device's thread, and a timer shows the changes thirty
times a second.

A stroke of the hand is like one of the pointer: a state with a token, an undo step, packed when the hand rests. The
native session has snapshots of its strokes, too, so undo and redo use them. If the session cannot restore a state (it
is older than the session, or a stroke has begun meanwhile), it is ended and a new one begins with that state and the
same pose of the tool. Nothing modal runs, so Blender can make its autosaves.
"""

import time
from datetime import datetime
from pathlib import Path

import bpy

from ..blender import views
from ..common import tool_solid, units
from ..sculpt import brushes, live_registry, sculpts
from ..sculpt.pure import journal, reach
from ..sculpt.undo_states import SPARE, snapshots
from ..translations import local
from .pure import pen_run

LABEL = "Pen Stroke"

running = None  # only one at a time, of any kind: one hand, one device


class PenSession:
    """A session of the open `device` with the sculpt `ob`; `tool`: riffler.Tool. `options`: riffler.Session's.
    `recordings`: the folder for a recording, or None. `ended` is called after its end, for any reason. `view`: the
    device's axes follow the 3D view. ValueError, OSError, RuntimeError if it cannot start; then nothing has changed,
    and the device is closed."""

    def __init__(self, context, ob, device, tool, options, recordings=None, ended=lambda: None, view=False):
        global running
        self.contact = None  # (path, point) of a session that turns a plan's tool
        self._begin, self._recordings, self._on_end = time.perf_counter(), recordings, ended
        self.ended = False
        self.problem, self.count = "", 0  # problem of the session; number of strokes
        self._tool, self.mode = tool, options.get("mode", "remove")
        self.run = pen_run.PenRun(device, tool, {**options, "undo": context.preferences.edit.undo_steps + SPARE})
        self.run.turns_with(view, options)
        fresh = live_registry.of(ob) is None
        self.live = None
        try:
            self.live = live_registry.begin(context, ob)
            self.live.cut_off = False
            self._take_up()
            self.live.chunks.show_tool(tool_solid.solid(tool.outline(tolerance=0.02 * tool.diameter)))
        except BaseException:
            self.run.halt()
            self.run.close()
            if self.live is not None:
                self.live.persistence.end_session()
                if fresh:
                    self.live.end()
            raise
        self._before = self.live.volume.volume
        self.live.device = running = self
        bpy.context.window_manager.riffler.sculpting = True

    def _take_up(self):
        """Starts a native session with the current volume."""
        work = self.live
        self._turn()
        _ = work.mesher  # creates the mesher before the volume changes
        session = self.run.prepare(work.volume, work.mask)
        self._seen, self._strokes = work.volume.revision, 0
        self._states, self._at = [self._seen], 0  # revisions in the session's own undo
        work.persistence.begin_session(work.object, work.token, snapshots.get(work.token).content, session)
        self.run.start()

    def _turn(self):
        self.run.turn(views.facing(), sculpts.from_world(self.live.object)[:3, :3])

    # ------------------------------------------------------------------ while it runs
    @property
    def changed(self):
        """mm³ removed or added since the start, without undone strokes."""
        return abs(self._before - self.live.volume.volume)

    @property
    def diameter(self):
        return self._tool.diameter

    @property
    def seconds(self):
        return time.perf_counter() - self._begin

    def look(self):
        """Shows what was cut since the last call. False if the session has ended."""
        if self.ended:
            return False
        work = self.live
        if work.object is None or not work.awake:
            work.end()
            return False
        if not self.run.running:
            self._take_up()
        self._turn()
        over = self.run.over
        self.run.look()
        self._follow()
        work.chunks.place(work.object.matrix_world)
        if self.run.pose is not None:
            work.chunks.place_tool(self.run.pose)
        if over:
            self.finish()
        return not over

    def _follow(self):
        """Updates the sculpt after the volume has changed; a stroke may have ended."""
        work, run = self.live, self.run
        if work.volume.revision != self._seen:
            self._seen = work.volume.revision
            if not work.in_stroke:
                work.begin_device_stroke()
            work.show()
        if run.in_stroke or run.strokes == self._strokes:
            return
        made, self._strokes = run.strokes - self._strokes, run.strokes
        work.persistence.made(made)
        for rows in run.taken_rows():
            work.took(self._tool.to_dict(), rows, self.mode)
        if run.dropped_ticks:
            self.problem = "Blender was busy for seconds: strokes may be missing among the cuts"
        if work.finish_stroke(bpy.context, LABEL):
            self.count += made
            self._at += 1
            self._states[self._at :] = [self._seen]

    # ------------------------------------------------------------------ undo
    def before_undo(self):
        """Ends the stroke in progress."""
        if self.look() and self.run.in_stroke:
            self._halt()

    def go(self, content):
        """Restores the volume of `content`; False if the session cannot, and no longer owns the volume."""
        wanted = content.volume.revision
        if self.run.running and wanted in self._states:
            to = self._states.index(wanted)
            step = self.run.session.redo if to > self._at else self.run.session.undo
            try:
                while self.live.volume.revision != wanted and step():
                    pass
            except RuntimeError:  # a stroke has begun meanwhile
                pass
            if self.live.volume.revision == wanted:
                self._at, self._seen = to, wanted
                return True
        self.run.halt()
        self._end_journal()
        return False

    # ------------------------------------------------------------------ the end
    def _halt(self):
        self.problem = self.run.halt() or self.problem
        try:
            self._follow()
        finally:
            self._end_journal()

    def _end_journal(self):
        folder = self.live.persistence.end_session()
        if self._recordings is None or folder is None:
            return
        try:
            journal.write_recording(folder, self._recording(), {"sculpt": self.live.name})
        except journal.PROBLEMS as error:
            self.problem = f"no recording was written: {error}"

    def _recording(self):
        path = Path(self._recordings) / pen_run.journal_name(self.live.name, datetime.now())
        k, first = 2, path
        while path.exists():
            path, k = first.with_stem(f"{first.stem} {k}"), k + 1
        return path

    def finish(self):
        """Ends the session, once: the stroke in progress becomes the last one."""
        if self.ended:
            return
        self.ended = True
        try:
            if self.live.object is not None and self.live.awake:
                self._halt()
        finally:
            self.drop()

    def drop(self):
        """Ends the session after its sculpt has changed; strokes that were not polled are discarded."""
        global running
        self.ended = True
        if self.live.device is not self:
            return
        self.live.device = None
        try:
            self.problem = self.run.halt() or self.problem
            self._end_journal()
        finally:
            self.run.close()
            self.live.chunks.hide_tool()
            if running is self:
                running = None
            state = bpy.context.window_manager.riffler
            state.sculpting, state.force, state.why, state.thread = False, "", "", ""
            self._on_end()

    def summary(self):
        """(level of the report, text, whether anything was done)."""
        brush = brushes.of(self.mode)
        if not self.count:
            why = self.problem or self.run.why or brush.no_stroke
            return "WARNING", f"Nothing was {brush.done} in {self.seconds:.1f} s: {why}", False
        note = f"; {self.problem}" if self.problem else ""
        changed, strokes = units.format_volume(self.changed), units.counted(self.count, "stroke")
        text = f"{brush.done.capitalize()} {changed} in {strokes}, {self.seconds:.1f} s{note}"
        if self.live.cut_off:
            text = f"{text}. {local(reach.CUT_OFF)}"
        return ("WARNING" if self.problem or self.live.cut_off else "INFO"), text, True

    def fail(self, error):
        """Ends the session after an error elsewhere; changes that belong to no state yet are undone."""
        self.problem = str(error) or type(error).__name__
        self.drop()
        if self.live.object is not None and self.live.awake:
            self.live.give_up()


def end():
    """Ends the running session, if any."""
    if running is not None:
        running.finish()
