"""The surroundings of the plan's tool at its current pose: whether it is free, and the map of free orientations.

Drawing asks for them, which costs nothing; missing results are computed from a timer, the map in a native task. After a
change of point the old map stays, marked as old, until the new one is ready. A map belongs to a place, not to an
orientation: turning the tool computes none.
"""

from dataclasses import dataclass

import bpy
import riffler

from ..blender import handlers, scene_units, views
from . import current_pose, obstacles, plan_store
from .pure import tool_rotation

CLASSES = ()
PAUSE = 0.1  # s without a change of frame, before a map is begun
LOOK = 0.03  # s between two polls of a task


@dataclass
class Known:
    """`text`: the tool's clearance, or what is missing; `map`: a riffler FreeOrientations, `old` if it is of another
    point."""

    text: str = ""
    free: bool = True
    map: object = None
    old: bool = True


@dataclass
class _Wanted:
    scene: str
    ob: str
    spot: current_pose.Spot
    key: tuple


_known = Known()
_wanted = None  # _Wanted of the last query
_shown = _begun = None  # keys of the map that is shown, and of the one being computed
_stood = None  # what `text` describes
_task = None
_asked = False  # since the last call of the timer
maps = 0  # maps computed since the add-on runs


def ask(context, spot):
    """Known of a current_pose.Spot, with the results computed so far."""
    global _wanted, _asked, _known
    wanted = _Wanted(context.scene.name, spot.ob.name, spot, _key(context.scene, spot.ob, spot))
    moved = _wanted is None or _wanted.key != wanted.key
    _wanted, _asked = wanted, _asked or moved
    _known.old = _shown != wanted.key
    if (_known.old or _stood != _standing(wanted)) and not bpy.app.timers.is_registered(_look):
        bpy.app.timers.register(_look, first_interval=PAUSE)
    return _known


def _key(scene, ob, spot):
    """The key of a spot's map. The spot's object may have been removed, so it is not accessed."""
    settings = scene.riffler.plan
    return (
        ob.name,
        spot.path,
        spot.index,
        spot.centre.tobytes(),
        str(spot.plan.tool.to_dict()),
        spot.plan.tolerance,
        scene_units.clean(settings.clearance),
        obstacles.version(ob),
    )


def _standing(wanted):
    return wanted.key, wanted.spot.axis.tobytes()


def _look():
    """Timer function."""
    global _asked, _stood
    scene = bpy.data.scenes.get(_wanted.scene)
    ob = scene.objects.get(_wanted.ob) if scene is not None else None
    if not plan_store.is_plan(ob):
        _stop()
        return None
    if _asked:  # scrubbing never waits
        _asked = False
        return PAUSE
    try:
        near = obstacles.ask(obstacles.SceneContext(scene), ob)
        if near is None:
            return LOOK
        wanted = _wanted
        wanted.key = _key(scene, ob, wanted.spot)
        if _stood != _standing(wanted):
            _stand(scene, near, wanted)
        if _map(scene, near, wanted):
            return LOOK
    except (ValueError, OSError, RuntimeError, MemoryError) as error:
        _missing(str(error))
    return None


def _stand(scene, near, wanted):
    global _stood
    _stood = _standing(wanted)
    found = state(scene, near, wanted.spot, wanted.spot.axis)
    _known.text, _known.free = str(found), found.free
    views.redraw()


def state(scene, near, spot, axis):
    """plan.pure.clearance.State of the tool at a spot. ValueError if it cannot stand there."""
    pose = tool_rotation.stand(spot.line, spot.index, axis, spot.plan.tool)
    return near.state(
        spot.plan.tool, pose, spot.plan.tolerance or 0.01, scene_units.clean(scene.riffler.plan.clearance)
    )


def free_orientations(scene, near, spot):
    """Map at a spot, with the plan's tolerance and the scene's clearance of shank and holder."""
    return start_free_orientations(scene, near, spot).result()


def start_free_orientations(scene, near, spot):
    """A riffler.Future of it."""
    tool = riffler.plan.with_room(spot.plan.tool, scene_units.clean(scene.riffler.plan.clearance))
    tolerance = spot.plan.tolerance or 0.01
    free = riffler.plan.free_orientations
    return riffler.submit(free, spot.line, spot.index, tool, near.collider, tolerance=tolerance)


def _map(scene, near, wanted):
    """True while the map is being computed."""
    global _task, _begun, _shown, maps
    if _shown == wanted.key:
        if _known.old:  # a change was suspected for a moment
            _known.old = False
            views.redraw()
        return False
    if _task is None or _begun != wanted.key:
        _cancel()
        _task = start_free_orientations(scene, near, wanted.spot)
        _begun = wanted.key
        return True
    if not _task.done():
        return True
    _known.map, _known.old, _shown = _task.result(), False, _begun
    _task, maps = None, maps + 1
    views.redraw()
    return False


def _missing(text):
    global _shown, _stood
    _cancel()
    _shown, _stood = _wanted.key, _standing(_wanted)  # not tried again before something changes
    _known.text, _known.free, _known.map = text, False, None
    views.redraw()


def _cancel():
    global _task
    if _task is not None:
        _task.cancel()
    _task = None


def _stop():
    global _known, _wanted, _shown, _begun, _stood
    _cancel()
    _known, _wanted, _shown, _begun, _stood = Known(), None, None, None, None


@bpy.app.handlers.persistent
def _on_load(*_):
    _stop()


_HANDLERS = {"load_post": _on_load}


def attach():
    handlers.listen(_HANDLERS)


def detach():
    handlers.ignore(_HANDLERS)
    handlers.stop(_look)
    _on_load()
