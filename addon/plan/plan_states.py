"""State of the plans on the timeline while Blender runs. None of it is in the file: it follows from the keyframes
(plan/replan.py) and the scene."""

from dataclasses import dataclass, field

import bpy

from ..sculpt import sculpts
from . import timeline
from .pure import key_orientations, motion, playback
from .pure.resolved import Resolved


@dataclass
class Baked:
    """What was computed of one path, and from which input."""

    path: object
    cl: object
    ends: tuple
    motion: motion.Motion  # as in the program
    played: motion.Played  # as on the timeline
    difference: playback.Difference | None = None

    def of(self, path, cl, ends):
        return self.path is path and self.cl is cl and self.ends == ends


@dataclass
class State:
    """The state of one plan, by its object: the panel's messages, and cached results."""

    problems: list = field(default_factory=list)
    difference: playback.Difference = field(default_factory=playback.Difference)
    changes: dict = field(default_factory=dict)  # path → plan.pure.key_orientations.Change: the effect of the last edit
    synced: int = 0  # number of updates of plan and animation, since the add-on runs
    baked: int = 0  # paths whose motion was computed
    laid: int = 0  # paths that were laid out in time
    layout: key_orientations.Layout | None = None
    seen: str = ""  # fingerprint of the last seen keyframes
    motions: list = field(default_factory=list)  # Baked, one for each path
    program: tuple = ((), None)  # the last program made of it: program/programs.py
    near: object = None  # plan.pure.clearance.Surroundings, after the first collision check
    clearances: dict = field(default_factory=dict)  # of checked poses, with those surroundings and that tool
    resolved: Resolved = field(default_factory=Resolved)  # earlier cutter locations, for keys that come back
    tool: object = None
    looks: int = 0  # number of computed clearances
    colliding: list = field(default_factory=list)  # runs of frames
    job: object = None  # plan.pure.collisions.ClearanceJob


followers = []  # functions called after a plan has changed

_states = {}
_known = (-1, ())  # number of objects at the last search, and the keys of the plans on the timeline


def state(plan_ob):
    return _states.setdefault(sculpts.key_of(plan_ob), State())


def tell_followers():
    """A plan has changed: what was made from it may be outdated."""
    for follower in followers:
        follower()


def forget():
    """Clears all state: another file was opened, or the add-on is unregistered."""
    _states.clear()
    search_again()


def search_again():
    """Searches again: names and numbers of objects may have changed, as after an undo."""
    global _known
    _known = (-1, ())


def on_timeline():
    """All plans on the timeline, in a scene. Objects are searched only if their number has changed."""
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
    """A render job reads what timers would change."""
    return bpy.app.is_job_running("RENDER")
