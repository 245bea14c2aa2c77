"""The session of a device with a plan: the hand turns the tool at its contact, the buttons set and delete key
orientations, and a timer shows it all thirty times a second.

Each key is one undo step of Blender's. Undo, redo and edits on the timeline work meanwhile: the session takes the keys
that the plan has. It ends when its path is gone.
"""

import time

import bpy
import numpy as np

from ..blender import scene_units, views
from ..common import units
from ..pen import session as pen_session
from . import collision_marks, current_pose, plan_store, replan, timeline
from .operators import keys
from .pure import tool_rotation
from .pure.orient_run import OrientRun

READ = 5.0  # s for which the reason of a refused press is shown
STEP = "Set Key Orientation", "Delete Key Orientation"


class PenOrientation:
    """A session of the open `device` with the path of `spot`; `near`: plan.pure.clearance.Surroundings; `options`:
    riffler.OrientSession's; `view`: the device's axes follow the 3D view. `ended` is called after its end, for any
    reason. ValueError, OSError, RuntimeError if it cannot start; then nothing has changed, and the device is closed."""

    help = "Button 1: set a key    Button 2: delete it    Esc: end"

    def __init__(self, context, spot, near, device, options, ended=lambda: None, view=False):
        self._begin, self._on_end = time.perf_counter(), ended
        self.ended, self.problem, self._refused = False, "", 0.0  # the last: when a press was refused
        self.set, self.deleted = 0, 0  # keys
        self.near, self._scene, self._ob = near, context.scene.name, spot.ob.name
        self.path, self.tool, self._line = spot.path, spot.plan.tool, spot.line
        self._keys = dict(spot.line.keys)
        self._interpolation = spot.line.interpolation or "smooth"
        options = {"point": spot.index, "axis": spot.axis, "interpolation": self._interpolation, **options}
        try:
            self.run = OrientRun(device, spot.line, self.tool, near.collider, options, view)
            self.run.start()
            self._turn()
        except BaseException:
            device.stop()
            raise
        pen_session.running = self
        bpy.context.window_manager.riffler.sculpting = True
        collision_marks.look(context.scene, spot.ob)

    # ------------------------------------------------------------------ what is shown
    @property
    def scene(self):
        return bpy.data.scenes.get(self._scene)

    @property
    def ob(self):
        """The plan's object, or None if it was removed."""
        scene = self.scene
        return scene.objects.get(self._ob) if scene is not None else None

    @property
    def seconds(self):
        return time.perf_counter() - self._begin

    @property
    def contact(self):
        """(path, point) at which the tool is, for the mark in the view."""
        return self.path, self.run.point

    def spot(self):
        """The tool's current_pose.Spot, or None if the path is gone."""
        ob = self.ob
        if not plan_store.is_plan(ob) or timeline.pair(ob) is None:
            return None
        plan = plan_store.plan(ob)
        # Paths after a deleted one have other numbers.
        for path in (self.path, *range(len(plan.paths))):
            if path < len(plan.paths) and _same_line(plan.paths[path], self._line):
                self.path = path
                return current_pose.Spot(ob, plan, path, self.run.point)
        return None

    def _turn(self):
        self.run.turn(views.facing(), np.eye(3), self.run.touching is not None)

    def look(self):
        """Shows what the hand did since the last call. False if the session has ended."""
        if self.ended:
            return False
        spot = self.spot()
        if spot is None:
            self.problem = "its path was deleted or found again"
            self.finish()
            return False
        self._take_over_keys(spot)
        if self.problem and time.perf_counter() - self._refused > READ:
            self.problem = ""
        self._turn()
        for change in self.run.look():
            self._apply(change)
        if self.run.pose is not None:
            self._show(self.spot())
        return True

    def _take_over_keys(self, spot):
        """The plan's keys may have changed by undo, or on the timeline."""
        if not _same_keys(spot.line.keys, self._keys):
            self._keys = dict(spot.line.keys)
            self.run.session.set_keys(self._keys)

    def _show(self, spot):
        """Moves Blender to the point of the path where the tool is, and shows the tool there as the hand holds it."""
        if spot is None:
            return
        scene = self.scene
        frame = replan.layout_of(spot.ob, spot.plan).tracks[self.path].frame_of(spot.index)
        if abs(scene.frame_current_final - frame) > 1e-3:
            timeline.go_to(scene, frame)
        current_pose.held = self.run.pose[3:]
        current_pose.hand(scene, spot, self.run.pose)

    def angles(self):
        """The tool's angles, in words."""
        return tool_rotation.said(*self._line.lean(self.run.point, self.run.pose[3:]))

    def state(self):
        """The plan.pure.clearance.State of the tool, or None before it has a pose, and after its path is gone."""
        spot = self.spot()
        if spot is None or self.run.pose is None:
            return None
        room = scene_units.clean(self.scene.riffler.plan.clearance)
        return self.near.state(self.tool, self.run.pose, spot.plan.tolerance or 0.01, room)

    # ------------------------------------------------------------------ keys
    def _apply(self, change):
        """One press of a button: a key of the plan, and an undo step."""
        self.problem, self._refused = change.refused or "", time.perf_counter()
        spot = self.spot()
        if change.refused or spot is None:
            return
        track = replan.layout_of(spot.ob, spot.plan).tracks[self.path]
        try:
            if change.deleted:
                self._delete(spot, change.point)
            else:
                keys.set_key(self.scene, spot.ob, track.frame_of(change.point), axis=change.axis)
        except ValueError as error:
            self.problem = str(error)
            self._keys = None  # the session takes the plan's again
            return
        self.set += not change.deleted
        self.deleted += change.deleted
        found = self.spot()
        if found is not None:
            self._keys = dict(found.line.keys)
        bpy.ops.ed.undo_push(message=STEP[change.deleted])

    def _delete(self, spot, point):
        """ValueError if the timeline has no such key."""
        tool, _ = timeline.pair(spot.ob)
        frames, quats = timeline.read_keys(tool)
        track = replan.layout_of(spot.ob, spot.plan).tracks[self.path]
        gone = np.array([track.holds(f) and track.nearest(f) == point for f in frames], bool)
        if not gone.any():
            raise ValueError("the key is not on the timeline any more")
        timeline.write_keys(tool, frames[~gone], quats[~gone])
        replan.sync(self.scene, spot.ob)

    # ------------------------------------------------------------------ the end
    def finish(self):
        """Ends the session, once, and keeps its keys."""
        if self.ended:
            return
        self.ended = True
        try:
            for change in self.run.halt():
                self._apply(change)
        finally:
            self.drop()

    def drop(self):
        """Ends the session; presses that were not polled are discarded."""
        self.ended = True
        if pen_session.running is not self:
            return
        pen_session.running = None
        try:
            self.run.halt()
        finally:
            self.run.close()
            current_pose.held = current_pose.said = None
            if self.ob is not None and timeline.pair(self.ob) is not None:
                current_pose.release(self.scene, self.ob)
            state = bpy.context.window_manager.riffler
            state.sculpting, state.force, state.why, state.thread = False, "", "", ""
            self._on_end()

    def fail(self, error):
        """Ends the session after an error elsewhere."""
        self.problem = str(error) or type(error).__name__
        self.drop()

    def summary(self):
        """(level of the report, text, whether anything was done)."""
        keys_set, gone = units.counted(self.set, "key"), units.counted(self.deleted, "key")
        if not self.set and not self.deleted:
            why = self.problem or self.run.why or "no button was pressed"
            return "WARNING", f"No key was set in {self.seconds:.1f} s: {why}", False
        text = f"{keys_set} set" + (f", {gone} deleted" if self.deleted else "") + f" in {self.seconds:.1f} s"
        return ("WARNING", f"{text}; {self.problem}", True) if self.problem else ("INFO", text, True)


def _same_line(a, b):
    return a is b or (len(a) == len(b) and a.closed == b.closed and np.array_equal(a.centres, b.centres))


def _same_keys(a, b):
    return b is not None and a.keys() == b.keys() and all(np.array_equal(a[k], b[k]) for k in a)
