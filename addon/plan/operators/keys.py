"""Key orientations as keyframes: a plan on the timeline; keys set, deleted and jumped to; collisions marked."""

from dataclasses import replace

import bpy
import numpy as np
from bpy.props import BoolProperty, FloatProperty, FloatVectorProperty, IntProperty

from ...blender import operator_parts, scene_units
from ...common import quaternions, units
from ...common.job import AfterJob
from .. import (
    collision_marks,
    current_pose,
    fit_check,
    obstacles,
    path_curves,
    path_switches,
    plan_states,
    plan_store,
    replan,
    timeline,
)
from ..current_pose import plan_object
from ..pure import key_orientations
from .plan_work import TimelineWork, plan_poll, tell, timeline_poll


class RIFFLER_OT_plan_to_timeline(bpy.types.Operator):
    """Lay the plan's paths out on the timeline and animate a tool along them, whose keyframes become the plan's key
    orientations
    """

    bl_idname = "riffler.plan_to_timeline"
    bl_label = "Plan to Timeline"
    bl_options = {"REGISTER", "UNDO"}

    frames_per_mm: FloatProperty(
        name="Frames per mm",
        default=0.0,
        min=0.0,
        max=1e4,
        precision=3,
        description="Frames for each mm of the path; 0: from the feed and the scene's frame rate",
    )
    first: IntProperty(
        name="First Frame", default=1, min=0, max=1_000_000, description="Frame at which the first path begins"
    )

    @classmethod
    def poll(cls, context):
        return plan_poll(cls, context)

    def execute(self, context):
        try:
            replan.flush()
            ob = plan_object(context)
            plan = plan_store.plan(ob)
            if not plan.paths:
                raise ValueError("The plan has no paths: find some first")
            rate = self.frames_per_mm or _rate(context.scene)
            plan, known, quats = self._divided(ob, plan, rate)
            lay_out(context, ob, plan, (rate, self.first), known, quats)
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        return tell(self, ob)

    def _divided(self, ob, plan, rate):
        """The plan with a point at each frame; if it is on the timeline like that already, its current state."""
        paths = [p if k in plan.depths else key_orientations.divided(p, rate) for k, p in enumerate(plan.paths)]
        cl = list(plan.cl) or [None] * len(paths)
        cl = [rows if path.interpolation != "linear" or path is old else None
              for rows, path, old in zip(cl, paths, plan.paths, strict=True)]  # fmt: skip
        plan = replace(plan, paths=paths, cl=cl)
        found = timeline.pair(ob)
        if found is None:
            return plan, None, None
        tool = found[0]
        same = (tool[timeline.RATE], tool[timeline.FIRST], tool[timeline.PATHS])
        if same != (rate, self.first, replan.geometry(plan)):
            return plan, None, None
        frames, quats = timeline.read_keys(tool)
        known = key_orientations.read(key_orientations.Layout(paths, rate, self.first), frames, quats)
        return plan, known, dict(zip(map(float, frames), quats, strict=True))


def lay_out(context, ob, plan, times, known=None, quats=None):
    """Makes `plan` the object's, and puts it on the timeline; `times`: frames per mm, and the first frame. ValueError,
    with nothing changed, if it is too long."""
    rate, first = times
    layout = key_orientations.Layout(plan.paths, rate, first)
    if layout.last > 1_000_000:
        raise ValueError(f"The animation is {layout.last} frames long: use fewer frames per mm")
    tool, _ = timeline.make(context, ob, plan.tool)
    tool[timeline.RATE], tool[timeline.FIRST] = rate, first
    tool[timeline.PATHS] = replan.geometry(plan)
    timeline.write_keys(tool, *key_orientations.written(layout, [p.keys for p in plan.paths], known, quats))
    plan_store.write(ob, plan)
    if path_curves.of(ob):  # as many points as the paths have now
        path_curves.show(ob, plan, scene_units.mm_per_unit(context.scene))
        path_switches.show(ob)
    timeline.show_range(context.scene, first, layout.last)
    replan.sync(context.scene, ob)


def _rate(scene):
    fps = scene.render.fps / scene.render.fps_base
    return key_orientations.frames_per_mm(scene_units.clean(scene.riffler.plan.feed), fps)


class RIFFLER_OT_plan_key(bpy.types.Operator):
    """Set the tool's orientation as a key of the path at the current frame; turn the tool with R first, or give an
    axis
    """

    bl_idname = "riffler.plan_key"
    bl_label = "Set Key Orientation"
    bl_options = {"REGISTER", "UNDO"}

    axis: FloatVectorProperty(
        name="Axis",
        subtype="XYZ",
        description="World direction from the tip to the spindle; 0, 0, 0: the tool's current direction",
    )
    path: IntProperty(name="Path", default=0, min=0, description="Number of the path; 0: that of the frame")
    point: IntProperty(name="Point", default=0, min=0, description="Point of the path, from 0; needs a path")

    @classmethod
    def poll(cls, context):
        return timeline_poll(cls, context)

    def execute(self, context):
        try:
            ob = plan_object(context)
            frame = self._frame(context, ob)
            axis = np.array(self.axis, float)
            if not np.isfinite(axis).all():
                raise ValueError("axis must be finite")
            quat = None if np.any(axis) else timeline.stands(context.scene, *timeline.pair(ob))
            set_key(context.scene, ob, frame, quat, axis)
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        return tell(self, ob)

    def _frame(self, context, ob):
        if not self.path:
            return context.scene.frame_current_final
        return frame_of(replan.layout_of(ob, plan_store.plan(ob)), self.path, self.point)


def frame_of(layout, path, point):
    """The frame of a path (from 1) and its point (from 0). ValueError."""
    if path > len(layout.tracks):
        raise ValueError(f"path {path}: the plan has {len(layout.tracks)}")
    track = layout.tracks[path - 1]
    if point >= track.points:
        raise ValueError(f"point {point}: path {path} has {track.points}, from 0")
    return track.frame_of(point)


def on_no_path(layout, frame):
    """The ValueError that names a frame between the paths, and where they are."""
    ranges = ", ".join(f"{t.first} and {t.last}" for t in layout.tracks[:3])
    more = " …" if len(layout.tracks) > 3 else ""
    return ValueError(f"Frame {frame:g} is on no path: go to one between {ranges}{more}")


def spot_at(context, ob, path=0, point=0):
    """The current_pose.Spot at the scene's frame, or of a path (from 1) and a point, and its frame. ValueError."""
    plan = plan_store.plan(ob)
    if not replan.fits(ob, plan):
        raise ValueError(replan.OTHER_PATHS)
    layout = replan.layout_of(ob, plan)
    frame = frame_of(layout, path, point) if path else context.scene.frame_current_final
    found = current_pose.spot(context.scene, ob, frame)
    if found is None:
        raise on_no_path(layout, frame)
    return found, frame


def set_key(scene, ob, frame, quat=None, axis=None):
    """Sets a keyframe at `frame`, or changes the one that its point has already, and updates the plan. `quat` (4,), or
    else an axis (3,), converted with as little twist as possible; the plan stores the exact axis, since keyframes are
    single precision. ValueError, with nothing changed, if the path takes no such key."""
    tool, _ = timeline.pair(ob)
    plan = plan_store.plan(ob)
    if not replan.fits(ob, plan):
        raise ValueError(replan.OTHER_PATHS)
    frames, quats = timeline.read_keys(tool)
    layout = replan.layout_of(ob, plan)
    if layout.at(frame) is None:
        raise on_no_path(layout, frame)
    reading = key_orientations.read(layout, frames, quats)
    path, index, _ = layout.place(frame)
    plan_store.refuse_turning(plan, path)
    frame = reading.frames.get((path, index), frame)
    if quat is None:
        before = quats[max(0, int(np.searchsorted(frames, frame)) - 1)] if len(frames) else None
        axis = quaternions.unit(np.asarray(axis, float))
        quat = quaternions.transported(axis[None], before)[0]
    else:
        axis = quaternions.axes_of(np.asarray(quat, float))
    wanted = key_orientations.change(plan.paths[path].keys, {**reading.keys[path], index: axis}).keys
    # The path's errors come before the change.
    turned = plan.paths[path].orient({**wanted, index: axis}, interpolation=plan.paths[path].interpolation or "smooth")
    others = np.abs(frames - frame) > 1e-4
    frames, quats = np.append(frames[others], frame), np.vstack([quats[others], quat])
    order = np.argsort(frames)
    timeline.write_keys(tool, frames[order], quaternions.aligned(quats[order]))
    paths, cl = list(plan.paths), list(plan.cl) or [None] * len(plan.paths)
    paths[path], cl[path] = turned, None
    ob.riffler.plan.forget({path})
    plan_store.write(ob, replace(plan, paths=paths, cl=cl))
    replan.sync(scene, ob)


class RIFFLER_OT_plan_key_delete(bpy.types.Operator):
    """Delete the path's key at the current frame"""

    bl_idname = "riffler.plan_key_delete"
    bl_label = "Delete Key Orientation"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return timeline_poll(cls, context)

    def execute(self, context):
        ob, frame = plan_object(context), context.scene.frame_current_final
        tool, _ = timeline.pair(ob)
        frames, quats = timeline.read_keys(tool)
        here = np.abs(frames - frame) < 0.5
        if not here.any():
            return operator_parts.fail(self, ValueError(f"There is no key at frame {frame:g}: jump to one first"))
        here = np.arange(len(frames)) == np.abs(frames - frame).argmin()
        timeline.write_keys(tool, frames[~here], quaternions.aligned(quats[~here]))
        replan.sync(context.scene, ob)
        return tell(self, ob)


class RIFFLER_OT_plan_key_jump(bpy.types.Operator):
    """Go to the next or the previous key orientation"""

    bl_idname = "riffler.plan_key_jump"
    bl_label = "Jump to Key Orientation"
    bl_options = {"REGISTER"}  # in Blender a change of frame is not an undo step

    back: BoolProperty(name="Back", description="Go to the previous key")

    @classmethod
    def poll(cls, context):
        return timeline_poll(cls, context)

    def execute(self, context):
        frames, _ = timeline.read_keys(timeline.pair(plan_object(context))[0])
        now = context.scene.frame_current_final
        there = frames[frames < now - 1e-3] if self.back else frames[frames > now + 1e-3]
        if not len(there):
            return operator_parts.fail(
                self, ValueError(f"There is no key {'before' if self.back else 'after'} this frame")
            )
        frame = float(there[-1] if self.back else there[0])
        timeline.go_to(context.scene, frame)
        return {"FINISHED"}


class RIFFLER_OT_plan_check(TimelineWork, bpy.types.Operator):
    """Mark the frames where cutter, shank or holder collide with the part or a fixture, and update the marks when keys
    change
    """

    bl_idname = "riffler.plan_check"
    bl_label = "Mark Collisions"
    doing = "Checking for collisions"
    cancelled = "Check for collisions cancelled"

    def begin(self, context):
        ob, plan = self.take(context)
        if not replan.fits(ob, plan):
            raise ValueError(replan.OTHER_PATHS)
        if not plan_states.state(ob).motions:
            raise ValueError(
                "; ".join(plan_states.state(ob).problems) or "Nothing is on the timeline: use Plan to Timeline"
            )
        taken = obstacles.take(context, ob)
        self._notes = fit_check.notes(context, plan, taken)
        return AfterJob(taken, self._look, in_background=False)

    def _look(self, near):
        self._near, self._known = near, {}
        return collision_marks.clearance_job(self.ob, near, self._known)

    def finish(self, context, job):
        now = plan_states.state(self.ob)
        now.near, now.clearances, now.job = self._near, self._known, None
        found = collision_marks.show(context.scene, self.ob, job)
        done = f"No collision at {units.counted(job.computed, 'pose')}"
        if found:
            done = f"The tool collides at {units.counted(sum(b - a + 1 for a, b in found), 'frame')}, marked below"
        operator_parts.tell_all(self, done, self._notes, bool(found))
        return {"FINISHED"}


CLASSES = (
    RIFFLER_OT_plan_to_timeline,
    RIFFLER_OT_plan_key,
    RIFFLER_OT_plan_key_delete,
    RIFFLER_OT_plan_key_jump,
    RIFFLER_OT_plan_check,
)
