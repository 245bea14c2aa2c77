"""Plans inside the .blend. A plan is an Empty in a collection of its own; its JSON (riffler.plan.dumps) is in a packed
image that the Empty points to, as for the volume of a sculpt.

A plan is in millimetres of the world: the Empty's place has no meaning, and is locked.
"""

from dataclasses import dataclass

import bpy
import riffler

from ..blender import handlers, packed_images, refusals
from ..common.contents import ContentCache
from ..sculpt import fit, sculpts
from ..sculpt.pure import sculpt_payload
from . import path_rows

RESOLVED = "resolved"  # in a plan's provenance: the fingerprint of the obstacles that its cutter locations are free of


@dataclass
class _Kept:
    plan: riffler.plan.Plan
    nbytes: int


_cache = ContentCache()
_texts = {}  # name of a plan's object → riffler.plan.Texts: an edit of one path formats only that path again
_listed = {}  # name of a scene → number of objects, and its plans: (name, file that it is linked from)
searches = 0  # searches of a scene's objects, since the add-on runs


def clear_cache():
    _cache.clear()
    _texts.clear()
    look_again()


def texts(ob):
    return _texts.setdefault(ob.name, riffler.plan.Texts())


def new(context, plan, name="Riffler Plan"):
    """A new plan in the scene, active and the only one selected."""
    block = riffler.plan.dumps(plan)  # anything that can fail comes before the first change
    collection = bpy.data.collections.new(name)
    context.scene.collection.children.link(collection)
    ob = bpy.data.objects.new(name, None)
    ob.empty_display_type = "PLAIN_AXES"
    lock(ob)
    collection.objects.link(ob)
    _write(ob, plan, block)
    sculpts.select_only(context, ob)
    return ob


def lock(ob):
    """Locks the object against accidental moves."""
    ob.lock_location = ob.lock_rotation = ob.lock_scale = (True, True, True)
    ob.lock_rotation_w = True
    ob.hide_render = True


def is_plan(ob):
    return ob is not None and ob.type == "EMPTY" and ob.riffler.plan.store is not None


def active(context):
    """The plan that the active object is or belongs to, as its curves and its tool do; otherwise the only plan of the
    scene; otherwise None."""
    ob = context.object
    while ob is not None:
        if is_plan(ob):
            return ob
        ob = ob.parent
    plans = in_scene(context.scene)
    return plans[0] if len(plans) == 1 else None


def in_scene(scene):
    """The scene's plans. Every drawing and every button asks for them, so a scene's objects are searched only if their
    number has changed, or Blender has reported that a plan has moved (`look_again`)."""
    global searches
    count, keys = _listed.get(scene.name, (-1, ()))
    found = [bpy.data.objects.get(key) for key in keys]
    if count != len(bpy.data.objects) or not all(map(is_plan, found)):
        searches += 1
        found = [ob for ob in scene.objects if is_plan(ob)]
        keys = tuple(sculpts.key_of(ob) for ob in found)
        _listed[scene.name] = len(bpy.data.objects), keys
    return found


def look_again():
    _listed.clear()


def identity(ob):
    """The content id, or "" if the object is not a plan."""
    return packed_images.identity(ob.riffler.plan.store) if is_plan(ob) else ""


def plan(ob):
    """The object's riffler.plan.Plan. It is shared: make changes on a copy (dataclasses.replace). ValueError if the
    data is damaged."""
    key = identity(ob)
    if not key:
        raise ValueError(f"{ob.name} is not a plan")
    kept = _cache.get(key)
    if kept is None:
        block = packed_images.read(ob.riffler.plan.store, "the plan")
        if sculpt_payload.content_id(block) != key:
            raise ValueError(f"{ob.name}: the plan's data in this .blend is damaged: its checksum does not match")
        kept = _Kept(riffler.plan.loads(block, name=ob.name), len(block))
        _cache.put(key, kept)
    return kept.plan


def wanted(plan):
    """Numbers, from 0, of the paths to cut: those that are on and have an orientation."""
    return [k for k, path in enumerate(plan.paths) if len(path.axes) and k not in plan.off]


def refuse_turning(plan, path):
    """ValueError if the path, by its number from 0, has fixed poses, which keys would change."""
    if path in plan.depths:
        raise ValueError(
            f"Path {path + 1} has its orientations from its strategy, not from keys: find it again with another "
            "inclination or tilt"
        )


def free(plan):
    """Numbers, from 0, of the paths whose cutter locations are all collision-free."""
    return {k for k, rows in enumerate(plan.cl) if rows is not None and len(rows)}


def unresolved(plan):
    """Numbers, from 0, of the paths to cut without cutter locations that are all collision-free."""
    done = free(plan)
    return [k for k in wanted(plan) if k not in done]


def refresh_rows(ob):
    """Call after findings of the paths have changed."""
    now = plan(ob)
    path_rows.update(ob.riffler.plan, now, free(now))


def write(ob, plan):
    """Makes `plan` the object's content. It must not be changed afterwards."""
    if why := refusals.linked(ob):  # the file would load the library's plan again
        raise ValueError(why)
    _write(ob, plan, riffler.plan.dumps(plan, texts=texts(ob)))


def _write(ob, plan, block):
    key = sculpt_payload.content_id(block)
    p = ob.riffler.plan
    if p.store is None or p.store.library or _shared(ob):
        p.store = packed_images.new(ob.name)
    packed_images.write(p.store, block, key)
    _cache.put(key, _Kept(plan, len(block)))
    p.keyed = len(wanted(plan))
    p.resolved = p.keyed - len(unresolved(plan))
    path_rows.update(p, plan, free(plan))
    p.paths, p.length, p.tool = len(plan.paths), sum(path.length for path in plan.paths), plan.tool.name


def _shared(ob):
    """True if a copy of the object has the same image."""
    image = ob.riffler.plan.store
    return any(other != ob and other.riffler.plan.store == image for other in bpy.data.objects)


@bpy.app.handlers.persistent
def _on_load(*_):
    clear_cache()


@bpy.app.handlers.persistent
def _on_history(*_):
    look_again()


@bpy.app.handlers.persistent
def _on_update(scene, depsgraph):
    """An object that moves to another scene does not change the number of objects."""
    if depsgraph.id_type_updated("COLLECTION") or depsgraph.id_type_updated("SCENE"):
        look_again()


_HANDLERS = {
    "load_post": _on_load,
    "undo_post": _on_history,
    "redo_post": _on_history,
    "depsgraph_update_post": _on_update,
}
CLASSES = ()


def attach():
    handlers.listen(_HANDLERS)
    fit.HOLDERS.append(is_plan)


def detach():
    if is_plan in fit.HOLDERS:
        fit.HOLDERS.remove(is_plan)
    handlers.ignore(_HANDLERS)
    clear_cache()
