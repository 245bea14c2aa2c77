"""What a plan's tool must stay clear of: the part that the plan was made on and the scene's fixtures. Keeps their
surfaces until one of them changes. Native tasks make the Surroundings of plan/pure/clearance.py at the first query.

Blender is not believed at once that something has changed, as undo says so of every object; nor, by whoever may not be
wrong (`take`, `now`), that nothing has: a script's changes are told later.
"""

import hashlib
import json
from dataclasses import dataclass

import bpy
import numpy as np
import riffler

from ..blender import handlers, object_surfaces, refusals, scene_units
from .plan_states import scene_of
from .pure.clearance import Making, Surroundings

CLASSES = ()


@dataclass
class Taken:
    """Surfaces in millimetres of the scene, and the task (as a riffler.Task is one) that makes surroundings of them.
    `prints`: their hashes."""

    who: tuple  # names of part and fixtures, and the scene's millimetres
    part: riffler.Mesh
    fixtures: list  # of (name, riffler.Mesh)
    prints: tuple
    making: Making | None = None
    made: Surroundings | None = None
    number: int = 0  # of those that were made
    doubtful: bool = False  # Blender has said since that something has changed

    def begin(self):
        if self.made is None and self.making is None:
            self.making = Making(self.part, self.who[0], self.fixtures)

    @property
    def done(self):
        """Asked now and then, from the first time on it is made; where it is, `result` does not wait."""
        self.begin()
        return self.making is None or self.making.done

    @property
    def share(self):
        return 1.0 if self.making is None else self.making.share

    def cancel(self):
        """It goes on: whoever asks next has it."""

    def result(self):
        """The plan.pure.clearance.Surroundings, however long they take."""
        global made
        if self.made is None:
            self.begin()
            making, self.making = self.making, None
            self.made = making.result()
            made += 1
            self.number = made
        return self.made

    def fingerprint(self, tool, clearance):
        """What cutter locations hold for: another one, and they have to be found again."""
        text = json.dumps([self.prints, tool.to_dict(), clearance], sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()[:16]

    @property
    def bounds(self):
        corners = np.array([mesh.bounds for mesh in (self.part, *(m for _, m in self.fixtures))])
        return corners[:, 0].min(axis=0), corners[:, 1].max(axis=0)


class SceneContext:
    """What a timer, which has no window, knows of a scene."""

    def __init__(self, scene):
        self.scene = scene
        self.view_layer = bpy.context.view_layer

    def evaluated_depsgraph_get(self):
        return bpy.context.evaluated_depsgraph_get()


_kept = {}  # name of a plan's object → Taken
made = 0  # plan.pure.clearance.Surroundings, since the add-on runs
_changes = 0  # that Blender told of


def part_of(scene, ob=None):
    """What a plan's object was made on, while that is in the scene; otherwise what plans are made on now."""
    own = ob.riffler.plan.part if ob is not None else None
    if own is not None and scene.objects.get(own.name) == own:
        return own
    return scene.riffler.plan.part


def take(context, ob):
    """Taken of a plan's object, as the scene is now. ValueError where part or fixtures are not what they should be."""
    part, fixtures, who = _objects(context, ob)
    mesh = object_surfaces.in_world(context, part)
    held = [(fixture.name, object_surfaces.in_world(context, fixture)) for fixture in fixtures]
    prints = tuple(riffler.plan.part_of(surface, "")["sha256"] for surface in (mesh, *(m for _, m in held)))
    kept = _kept.get(ob.name)
    if kept is None or (kept.who, kept.prints) != (who, prints):
        kept = _kept[ob.name] = Taken(who, mesh, held, prints)
    kept.doubtful = False
    return kept


def now(context, ob):
    """The plan.pure.clearance.Surroundings of a plan's object, however long they take."""
    return take(context, ob).result()


def ask(context, ob):
    """The same, or None while they are made: ask again. ValueError where there can be none."""
    kept = _kept.get(ob.name)
    if kept is None or kept.doubtful or kept.who != _objects(context, ob)[2]:
        kept = take(context, ob)
    return kept.result() if kept.done else None


def known(ob):
    """The same if they are there and nothing has changed since, otherwise None."""
    kept = _kept.get(ob.name)
    return kept.made if kept is not None and not suspect(SceneContext(scene_of(ob)), ob) else None


def suspect(context, ob):
    """True where what is known may be of before: asking again says."""
    kept = _kept.get(ob.name)
    try:
        return kept is not None and (kept.doubtful or kept.who != _objects(context, ob)[2])
    except ValueError:
        return True


def version(ob):
    """Another one wherever it may be worth asking again, or the surroundings are others."""
    return ("made", _kept[ob.name].number) if known(ob) is not None else ("changed", _changes, _who(scene_of(ob), ob))


def _who(scene, ob):
    """What Taken.who has, or why there is nothing to be had."""
    try:
        return _objects(SceneContext(scene), ob)[2]
    except ValueError as error:
        return (str(error),)


def _objects(context, ob):
    """Part, fixtures, and what Taken.who has of them."""
    part = part_of(context.scene, ob)
    if why := object_surfaces.unfit(part, context.scene):
        raise ValueError(why)
    fixtures = fixture_objects(context.scene.riffler.plan, part)
    return part, fixtures, (part.name, *(f.name for f in fixtures), scene_units.mm_per_unit(context.scene))


@bpy.app.handlers.persistent
def _on_update(scene, depsgraph):
    global _changes
    _changes += 1
    if not _kept:
        return
    names = {
        u.id.name
        for u in depsgraph.updates
        if isinstance(u.id, bpy.types.Object) and (u.is_updated_geometry or u.is_updated_transform)
    }
    for kept in _kept.values():
        kept.doubtful |= not names.isdisjoint(kept.who[:-1])


@bpy.app.handlers.persistent
def _on_load(*_):
    _kept.clear()


_HANDLERS = {"depsgraph_update_post": _on_update, "load_post": _on_load}


def attach():
    handlers.listen(_HANDLERS)


def detach():
    handlers.ignore(_HANDLERS)
    _kept.clear()


def fixture_objects(settings, part):
    """The objects of the fixtures' collection that have a surface, but the part. ValueError where there is one whose
    surface would be passed over."""
    if settings.fixtures is None:
        return []
    if why := next(filter(None, map(refusals.instance, settings.fixtures.all_objects)), ""):
        raise ValueError(f"{why}, or take it out of the fixtures")
    return [ob for ob in settings.fixtures.all_objects if ob.type in object_surfaces.WITH_SURFACE and ob != part]
