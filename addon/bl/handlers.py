"""Application handlers.

Sculpts need none of undo and redo: Blender brings back the mesh together with the content id of its volume, and the
volume of that id is in the cache or in the packed image that came back too.
"""

import bpy

from . import attributes, events, plan_store, store

CLASSES = ()


@bpy.app.handlers.persistent
def _on_load(*_):
    plan_store.clear_cache()
    store.clear_cache()  # another file: the memory is worth more than what it held


@bpy.app.handlers.persistent
def _on_history(*_):
    plan_store.look_again()
    attributes.follow()


@bpy.app.handlers.persistent
def _on_update(scene, depsgraph):
    """Objects that go to another scene are no more and no fewer."""
    if depsgraph.id_type_updated("COLLECTION") or depsgraph.id_type_updated("SCENE"):
        plan_store.look_again()


_HANDLERS = {
    "load_post": _on_load,
    "undo_post": _on_history,
    "redo_post": _on_history,
    "depsgraph_update_post": _on_update,
}


def attach():
    events.listen(_HANDLERS)


def detach():
    events.ignore(_HANDLERS)
    plan_store.clear_cache()
    store.clear_cache()
