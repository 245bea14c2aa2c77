"""The session of a device that traces exact faces: the hand leads the tool over them, a timer shows it thirty times a
second, and the end makes a curve of the touched points. Nothing of the scene changes before that.
"""

import time

import bpy
import numpy as np

from ..blender import scene_units, views
from ..common import units
from . import session as pen_session
from .pure.trace_run import TraceRun

STEP = "Trace"


class TraceSession:
    """A session of the open `device` with the exact faces of the object `ob`, `surface`, of which `collider` is made;
    both in mm of the world. `options`: riffler.Session's. `keep`: makes the curve. `ended` is called after the end, for
    any reason. ValueError, OSError, RuntimeError if it cannot start; then the device is closed."""

    contact = None  # (path, point) of a session that turns a plan's tool

    def __init__(self, context, ob, device, tool, near, options, keep=True, ended=lambda: None, view=False):
        self._begin, self._on_end = time.perf_counter(), ended
        self.ended, self.problem = False, ""
        self._ob, self._scene, self._matrix = ob.name, context.scene.name, ob.matrix_world.copy()
        self._keep, self._mm = keep, scene_units.mm_per_unit(context.scene)
        self.tool, self.diameter = tool, tool.diameter
        surface, collider = near
        try:
            self._refuse_inside(collider, options)
            self.run = TraceRun(device, tool, surface, collider, options, view)
            self._turn()
            self.run.start()
        except BaseException:
            device.stop()
            raise
        pen_session.running = self
        bpy.context.window_manager.riffler.sculpting = True

    def _refuse_inside(self, collider, options):
        if "at" not in options:
            return
        depth = collider.query(self.tool, options["at"]).depth
        if depth > 0:
            raise ValueError(
                f"the tool would start {units.trim(depth, 3)} mm deep in {self._ob}: move the 3D cursor, or start "
                "above the stock"
            )

    @property
    def ob(self):
        """The traced object, or None if it was removed."""
        scene = bpy.data.scenes.get(self._scene)
        return scene.objects.get(self._ob) if scene is not None else None

    @property
    def seconds(self):
        return time.perf_counter() - self._begin

    def _turn(self):
        self.run.turn(views.facing(), np.eye(3), self.run.contact is not None)

    def look(self):
        """Shows what the hand did since the last call. False if the session has ended."""
        if self.ended:
            return False
        ob = self.ob
        if ob is None or ob.matrix_world != self._matrix:
            self.problem = f"{self._ob} was {'removed' if ob is None else 'moved'}"
            self.finish()
            return False
        self._turn()
        over = self.run.over
        self.run.look()
        if over:
            self.finish()
        return not over

    def state(self):
        """What the tool touches, in words."""
        run = self.run
        if not run.part:
            return "The tool is free"
        return f"{run.part.capitalize()} {units.trim(run.depth, 3)} mm deep"

    # ------------------------------------------------------------------ the end
    def finish(self):
        """Ends the session, once, and makes the curve."""
        if self.ended:
            return
        self.ended = True
        try:
            self.problem = self.run.halt() or self.problem
            self._make_curve()
        finally:
            self.drop()

    def drop(self):
        """Ends the session without a curve, if it was not made."""
        self.ended = True
        if pen_session.running is not self:
            return
        pen_session.running = None
        try:
            self.run.halt()
        finally:
            self.run.close()
            state = bpy.context.window_manager.riffler
            state.sculpting, state.force, state.why, state.thread = False, "", "", ""
            self._on_end()

    def _make_curve(self):
        scene = bpy.data.scenes.get(self._scene)
        pieces = [piece for piece in self.run.traces.pieces if len(piece) > 1]
        if not self._keep or not pieces or scene is None:
            return
        curve = bpy.data.curves.new(f"{STEP} of {self._ob}", "CURVE")
        curve.dimensions = "3D"
        for piece in pieces:
            spline = curve.splines.new("POLY")
            spline.points.add(len(piece) - 1)
            co = np.ones((len(piece), 4), np.float32)
            co[:, :3] = np.array(piece) / self._mm
            spline.points.foreach_set("co", co.ravel())
        scene.collection.objects.link(bpy.data.objects.new(curve.name, curve))
        bpy.ops.ed.undo_push(message=STEP)

    def fail(self, error):
        """Ends the session after an error elsewhere."""
        self.problem = str(error) or type(error).__name__
        self.drop()

    def summary(self):
        """(level of the report, text, whether anything was done)."""
        traces = self.run.traces
        if not traces.points:
            why = self.problem or self.run.why or "the tool touched nothing"
            return "WARNING", f"Nothing was traced in {self.seconds:.1f} s: {why}", False
        pieces = units.counted(len(traces.pieces), "trace")
        text = f"{units.counted(traces.points, 'point')} in {pieces}, {self.seconds:.1f} s"
        return ("WARNING", f"{text}; {self.problem}", True) if self.problem else ("INFO", text, True)
