"""Marks the frames of the timeline whose poses collide, once the user asks for it: checked in slices, then shown as
markers. The markers and the request are stored in the file; the results of the checks are not."""

import bpy
import numpy as np

from ..blender import views
from . import obstacles, plan_store, timeline
from .plan_states import on_timeline, rendering, scene_of, state
from .pure import collisions, motion

ERRORS = (ValueError, OSError, RuntimeError)
ASKED = "riffler_marked"  # of the plan's object
WAIT = 0.5  # s, while something renders
LOOK = 0.03  # s between two polls of surroundings that are being built


def look(scene, plan_ob):
    """Checks the poses that were not checked yet: at once without a window, otherwise from a timer."""
    now, near = state(plan_ob), obstacles.known(plan_ob)
    if near is not None and near is not now.near:
        now.near, now.clearances = near, {}
    now.job = clearance_job(plan_ob, now.near, now.clearances)
    if bpy.app.background:
        while not now.job.step(1.0):
            pass
        show(scene, plan_ob)
    elif not bpy.app.timers.is_registered(go_on):
        bpy.app.timers.register(go_on, first_interval=0.0)


def clearance_job(plan_ob, near, known):
    """A job for the clearances of all poses of the animation; `known`: clearances with these surroundings."""
    now = state(plan_ob)
    poses = np.vstack([played.poses for _, played in _played(plan_ob)] or [np.empty((0, 6))])
    return collisions.ClearanceJob(near, now.tool, poses, known)


def _played(plan_ob):
    """(number, plan.pure.motion.Played) of the paths that are on."""
    off = plan_store.plan(plan_ob).off
    return [(k, e.played) for k, e in enumerate(state(plan_ob).motions) if k not in off]


def show(scene, plan_ob, job=None):
    """Marks the frames that collide, and returns them as runs. A scene's marks are those of all its plans."""
    now = state(plan_ob)
    job, now.job = job or now.job, None
    if not asked(plan_ob):
        plan_ob[ASKED] = True
    frames, _, _, ends = motion.joined([played for _, played in _played(plan_ob)])
    plan = plan_store.plan(plan_ob)
    tolerance = plan.tolerance or 0.01
    deep = [np.full(len(p.poses), plan.depths[k] + tolerance if k in plan.depths else 0.0) for k, p in _played(plan_ob)]
    now.looks += job.computed
    # adds the depth by which the cutter is meant to enter the part
    clearances = job.clearances + np.concatenate([np.empty(0), *deep])
    now.colliding = collisions.runs(frames, clearances, -tolerance, ends)
    timeline.mark(scene, collisions.union(state(p).colliding for p in on_timeline() if scene.objects.get(p.name) == p))
    views.redraw()
    return now.colliding


def go_on():
    """Timer function: 20 ms of collision checks per call, until all poses are checked."""
    if rendering():
        return WAIT
    for plan_ob in on_timeline():
        job = state(plan_ob).job
        if job is None:
            continue
        try:
            if job.step(0.02):
                show(scene_of(plan_ob), plan_ob)
        except ERRORS as error:
            state(plan_ob).job = None
            state(plan_ob).problems.append(str(error))
        return 0.01
    return None


def asked(plan_ob):
    """True if the user has asked for marks; undo reverts that, too."""
    return bool(plan_ob.get(ASKED))


def outdated(plan_ob):
    """True if the marks may be from before a change of part or fixtures, or from a file that was opened."""
    now = state(plan_ob)
    looked = now.near is not None and obstacles.known(plan_ob) is now.near and now.job is None
    return asked(plan_ob) and not looked


def look_again():
    """Timer function: after part and fixtures have stayed unchanged for a moment, checks again if they differ now."""
    waiting = False
    for plan_ob in on_timeline():
        now, scene = state(plan_ob), scene_of(plan_ob)
        if not asked(plan_ob) or not now.motions:
            continue
        try:
            near = obstacles.ask(obstacles.SceneContext(scene), plan_ob)
        except ERRORS:
            continue  # without a part the marks stay outdated
        waiting |= near is None
        if near is not None and near is not now.near:
            look(scene, plan_ob)
    return LOOK if waiting else None
