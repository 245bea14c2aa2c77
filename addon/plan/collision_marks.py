"""Frames of the timeline whose poses collide: looked for where somebody has asked, a little at a time, and marked. The
markers are in the file, and so is that somebody has asked; what was looked at is not."""

import bpy
import numpy as np

from . import obstacles, plan_store, timeline
from .plan_states import on_timeline, rendering, scene_of, state
from .pure import collisions, motion

ERRORS = (ValueError, OSError, RuntimeError)
ASKED = "riffler_marked"  # of the plan's object
WAIT = 0.5  # s, while something renders
LOOK = 0.03  # s between two looks at surroundings in the making


def look(scene, plan_ob):
    """Looks at the poses that were not looked at yet: at once without a window, otherwise from a timer."""
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
    """Of all poses of the animation; `known`: clearances with these surroundings."""
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
    clearances = job.clearances + np.concatenate([np.empty(0), *deep])  # those that the cutter is to enter the part by
    now.colliding = collisions.runs(frames, clearances, -tolerance, ends)
    timeline.mark(scene, collisions.union(state(p).colliding for p in on_timeline() if scene.objects.get(p.name) == p))
    return now.colliding


def go_on():
    """A timer's: 20 ms of looking at collisions, as long as there is something to look at."""
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
    """True where somebody wants collisions marked: undo takes that back, too."""
    return bool(plan_ob.get(ASKED))


def outdated(plan_ob):
    """True where the marks are of before part or fixtures changed, of a file that was opened, or may be."""
    now = state(plan_ob)
    looked = now.near is not None and obstacles.known(plan_ob) is now.near and now.job is None
    return asked(plan_ob) and not looked


def look_again():
    """A timer's, once part and fixtures have been left alone: looks again where they are others now."""
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
