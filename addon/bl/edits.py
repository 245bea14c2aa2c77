"""Whether Blender's own tools have changed a sculpt's mesh, for panels: every vertex counts, and is looked at only once
Blender has said that some mesh is another one."""

import bpy

from . import events, live, sculpts

CLASSES = ()
_found = {}  # name of a mesh → whether it was changed


def noticed(ob):
    """Of a sculpt; nobody edits what is shown in chunks, and in Blender's own modes the vertices are elsewhere."""
    if live.of(ob) is not None:
        return False
    if ob.mode != "OBJECT":
        return sculpts.edited(ob.data)
    mesh = ob.data
    if mesh.name not in _found:
        _found[mesh.name] = sculpts.changed(mesh)
    return _found[mesh.name]


@bpy.app.handlers.persistent
def _look_again(*_):
    _found.clear()


@bpy.app.handlers.persistent
def _on_update(scene, depsgraph):
    if depsgraph.id_type_updated("MESH"):
        _found.clear()
        return
    if any(update.is_updated_geometry for update in depsgraph.updates):
        _found.clear()


_HANDLERS = {
    "depsgraph_update_post": _on_update,
    "load_post": _look_again,
    "undo_post": _look_again,
    "redo_post": _look_again,
}


def attach():
    events.listen(_HANDLERS)


def detach():
    events.ignore(_HANDLERS)
    _found.clear()
