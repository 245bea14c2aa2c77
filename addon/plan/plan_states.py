"""What is known of the plans on the timeline while Blender runs. Nothing of it is in the file: it follows from the
keyframes (plan/replan.py) and the scene."""

from dataclasses import dataclass, field

import bpy

from ..sculpt import sculpts
from . import timeline
from .pure import key_orientations, motion, playback
from .pure.resolved import Resolved


@dataclass
class Baked:
    """What was computed of one path, and what for."""

    path: object
    cl: object
    ends: tuple
    motion: motion.Motion  # as the program has it
    played: motion.Played  # as the timeline has it
    difference: playback.Difference | None = None

    def of(self, path, cl, ends):
        return self.path is path and self.cl is cl and self.ends == ends


@dataclass
class State:
    """Of one plan, by its object: what the panel says, and what need not be computed again."""

    problems: list = field(default_factory=list)
    difference: playback.Difference = field(default_factory=playback.Difference)
    changes: dict = field(default_factory=dict)  # path → plan.pure.key_orientations.Change: what the last edit did
    synced: int = 0  # how often plan and animation were brought up to date, since the add-on runs
    baked: int = 0  # paths whose motion was computed
    laid: int = 0  # paths that were laid out in time
    layout: key_orientations.Layout | None = None
    seen: str = ""  # fingerprint of the keyframes
    motions: list = field(default_factory=list)  # Baked, one for each path
    program: tuple = ((), None)  # the last that was made of it: program/programs.py
    near: object = None  # plan.pure.clearance.Surroundings, once collisions were asked for
    clearances: dict = field(default_factory=dict)  # of poses that were looked at, with those and that tool
    resolved: Resolved = field(default_factory=Resolved)  # what paths had, for keys that come back
    tool: object = None
    looks: int = 0  # clearances that were computed
    colliding: list = field(default_factory=list)  # runs of frames
    job: object = None  # plan.pure.collisions.ClearanceJob


followers = []  # functions that are called after a plan has changed

_states = {}
_known = (-1, ())  # how many objects there were, and the keys of the plans on the timeline


def state(plan_ob):
    return _states.setdefault(sculpts.key_of(plan_ob), State())


def tell_followers():
    """A plan has changed: what was made of it may be outdated."""
    for follower in followers:
        follower()


def forget():
    """Another file, or the add-on goes."""
    _states.clear()
    list_anew()


def list_anew():
    """Names and numbers of objects may be others, as after an undo."""
    global _known
    _known = (-1, ())


def on_timeline():
    """All plans that are, in a scene. Objects are looked through only where there are more or fewer than before."""
    global _known
    if len(bpy.data.objects) != _known[0] or any(_pair_of(key) is None for key in _known[1]):
        found = [sculpts.key_of(ob) for ob in bpy.data.objects if timeline.TOOL in ob and timeline.pair(ob)]
        _known = (len(bpy.data.objects), tuple(found))
    return [ob for ob in map(bpy.data.objects.get, _known[1]) if timeline.placed(ob)]


def _pair_of(key):
    ob = bpy.data.objects.get(key)
    return timeline.pair(ob) if ob is not None else None


def scene_of(ob):
    return next((s for s in bpy.data.scenes if s.objects.get(ob.name) == ob), bpy.context.scene)


def rendering():
    """A render job reads what timers would change meanwhile."""
    return bpy.app.is_job_running("RENDER")
