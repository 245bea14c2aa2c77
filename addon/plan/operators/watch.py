"""Whether a plan still fits its part, for panels: checked once after a change, never while drawing.

A part's identity is the hash of its whole surface, which takes about 0.1 s for half a million triangles. So a panel
gets the last known verdict; if there is none, a timer checks as soon as the scene has been unchanged for a moment.
"""

import time
from dataclasses import dataclass, field

import bpy
import riffler

from ...blender import handlers, object_surfaces, scene_units, views
from ...sculpt import live_registry
from .. import obstacles, path_curves, plan_store

CLASSES = ()
QUIET = 0.4  # s without a change, before a part is checked


@dataclass
class Verdict:
    part: str  # problem of the part, or ""
    edited: int  # paths whose curves differ from the plan
    tool: riffler.Tool | None = field(default=None, compare=False)  # the tool it was planned with


_known = {}  # name of a plan → (its _key then, Verdict)
_asked = set()  # names of plans whose verdict a panel has asked for
_changed = 0.0


def judge(context, ob):
    """The Verdict on a plan, now. ValueError if the plan cannot be read."""
    plan = plan_store.plan(ob)
    edited = path_curves.edited(ob, plan, scene_units.mm_per_unit(context.scene))
    return Verdict(_part(context, ob, plan), edited, plan.tool)


def part_of(scene, ob):
    """The part that a plan is checked with, or None if the scene has none."""
    part = obstacles.part_of(scene, ob)
    return part if part is not None and scene.objects.get(part.name) == part else None


def _part(context, ob, plan):
    part, name = part_of(context.scene, ob), plan.part.get("name", "")
    if part is None:
        return f"The part, {name}, is gone from the scene"
    if part.mode != "OBJECT" or live_registry.of(part) is not None:
        return ""  # the edit is not finished
    try:
        mesh = object_surfaces.in_world(context, part)
    except ValueError as error:
        return str(error)
    if riffler.plan.part_of(mesh, name)["sha256"] == plan.part.get("sha256"):
        return ""
    if part != ob.riffler.plan.part:
        return f"The part, {name}, is gone from the scene, and {part.name} is not the same as it lies there"
    return f"{part.name} was changed or moved since, or the scene's units were"


def known(context, ob):
    """The Verdict on a plan if it is known; otherwise None, and a check is scheduled."""
    key, verdict = _known.get(ob.name, (None, None))
    if key == _key(context, ob):
        return verdict
    _asked.add(ob.name)
    if not bpy.app.background and not bpy.app.timers.is_registered(_look):
        bpy.app.timers.register(_look, first_interval=QUIET)
    return None


def _key(context, ob):
    """What a Verdict is valid for, as far as the comparison is cheap."""
    part = part_of(context.scene, ob)
    return plan_store.identity(ob), scene_units.mm_per_unit(context.scene), part.name if part else ""


def _look():
    left = _changed + QUIET - time.monotonic()
    if left > 0:
        return left
    context = bpy.context
    while _asked:
        ob = context.scene.objects.get(_asked.pop())
        if plan_store.is_plan(ob):
            try:
                verdict = judge(context, ob)
            except ValueError as error:
                verdict = Verdict(str(error), 0)
            _known[ob.name] = (_key(context, ob), verdict)
    views.redraw_sidebars(context)
    return None


@bpy.app.handlers.persistent
def _on_update(scene, depsgraph):
    """Forgets the verdicts on plans whose part or curves have changed."""
    global _changed
    if not _known and not _asked:
        return
    objects = [u.id for u in depsgraph.updates if isinstance(u.id, bpy.types.Object)]
    curves = {ob.parent.name for ob in objects if ob.type == "CURVE" and ob.parent is not None}
    names = {ob.name for ob in objects}
    for name in [*_known, *_asked]:
        ob = scene.objects.get(name)
        part = part_of(scene, ob) if ob is not None else None
        if name in curves or (part is not None and part.name in names):
            _known.pop(name, None)
            _changed = time.monotonic()


@bpy.app.handlers.persistent
def _forget(*_):
    _known.clear()


_HANDLERS = {"depsgraph_update_post": _on_update, "undo_post": _forget, "redo_post": _forget, "load_post": _forget}


def attach():
    handlers.listen(_HANDLERS)


def detach():
    handlers.ignore(_HANDLERS)
    handlers.stop(_look)
    _known.clear()
    _asked.clear()
