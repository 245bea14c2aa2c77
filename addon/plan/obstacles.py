"""The obstacles of a plan's tool: the part that the plan was made on and the scene's fixtures. Keeps their surfaces
until one of them changes. Native tasks build the Surroundings of plan/pure/clearance.py at the first query.

Blender's change notices are not reliable: undo reports every object as changed, and a script's changes are reported
late. So a notice alone rebuilds nothing, and callers that must be right (`take`, `now`) always compare.
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
    """Surfaces in millimetres of the scene, and what builds surroundings of them (with the interface of
    riffler.Future). `prints`: their hashes."""

    who: tuple  # names of part and fixtures, and the scene's mm per unit
    part: riffler.Mesh
    fixtures: list  # of (name, riffler.Mesh)
    prints: tuple
    making: Making | None = None
    made: Surroundings | None = None
    number: int = 0  # serial number
    doubtful: bool = False  # Blender has reported a change since

    def begin(self):
        if self.made is None and self.making is None:
            self.making = Making(self.part, self.who[0], self.fixtures)

    def done(self):
        """Poll this: the first call starts the task. Once it is True, `result` does not wait."""
        self.begin()
        return self.making is None or self.making.done()

    def progress(self):
        return 1.0 if self.making is None else self.making.progress()

    def cancel(self):
        """Does nothing: the task continues for the next query."""

    def result(self):
        """The plan.pure.clearance.Surroundings; waits for them."""
        global made
        if self.made is None:
            self.begin()
            making, self.making = self.making, None
            self.made = making.result()
            made += 1
            self.number = made
        return self.made

    def fingerprint(self, tool, clearance):
        """Identifies what cutter locations are valid for: if it changes, they must be found again."""
        text = json.dumps([self.prints, tool.to_dict(), clearance], sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()[:16]

    @property
    def bounds(self):
        corners = np.array([mesh.bounds for mesh in (self.part, *(m for _, m in self.fixtures))])
        return corners[:, 0].min(axis=0), corners[:, 1].max(axis=0)


class SceneContext:
    """A scene's context for timers, which have no window."""

    def __init__(self, scene):
        self.scene = scene
        self.view_layer = bpy.context.view_layer

    def evaluated_depsgraph_get(self):
        return bpy.context.evaluated_depsgraph_get()


_kept = {}  # name of a plan's object → Taken
made = 0  # plan.pure.clearance.Surroundings built since the add-on runs
_changes = 0  # number of changes that Blender has reported


def part_of(scene, ob=None):
    """The part that a plan's object was made on, while it is in the scene; otherwise the scene's current part."""
    own = ob.riffler.plan.part if ob is not None else None
    if own is not None and scene.objects.get(own.name) == own:
        return own
    return scene.riffler.plan.part


def take(context, ob):
    """Taken of a plan's object in the scene's current state. ValueError if part or fixtures are invalid."""
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
    """The plan.pure.clearance.Surroundings of a plan's object; waits for them."""
    return take(context, ob).result()


def ask(context, ob):
    """The same, or None while they are being built: ask again. ValueError if they cannot be built."""
    kept = _kept.get(ob.name)
    if kept is None or kept.doubtful or kept.who != _objects(context, ob)[2]:
        kept = take(context, ob)
    return kept.result() if kept.done() else None


def known(ob):
    """The same if they exist and nothing has changed since, otherwise None."""
    kept = _kept.get(ob.name)
    return kept.made if kept is not None and not suspect(SceneContext(scene_of(ob)), ob) else None


def suspect(context, ob):
    """True if the known surroundings may be outdated; `ask` checks that."""
    kept = _kept.get(ob.name)
    try:
        return kept is not None and (kept.doubtful or kept.who != _objects(context, ob)[2])
    except ValueError:
        return True


def version(ob):
    """A value that changes when asking again may give other surroundings."""
    return ("made", _kept[ob.name].number) if known(ob) is not None else ("changed", _changes, _who(scene_of(ob), ob))


def _who(scene, ob):
    """The value of Taken.who, or why there is none."""
    try:
        return _objects(SceneContext(scene), ob)[2]
    except ValueError as error:
        return (str(error),)


def _objects(context, ob):
    """Part, fixtures, and the value of Taken.who."""
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
    """The objects of the fixtures' collection that have a surface, except the part. ValueError if the surface of one
    would be ignored."""
    if settings.fixtures is None:
        return []
    if why := next(filter(None, map(refusals.instance, settings.fixtures.all_objects)), ""):
        raise ValueError(f"{why}, or take it out of the fixtures")
    return [ob for ob in settings.fixtures.all_objects if ob.type in object_surfaces.WITH_SURFACE and ob != part]
