"""Whether Blender's own tools have changed a sculpt's mesh, for panels: compares every vertex, but only after Blender
has reported that some mesh has changed."""

import bpy

from ..blender import handlers
from . import live_registry, sculpts

CLASSES = ()
_found = {}  # name of a mesh → whether it was changed


def made(ob):
    """True if Blender's own tools have changed a sculpt's mesh since it was shown. While chunks represent the sculpt,
    its mesh is hidden, and cannot have been edited."""
    return live_registry.of(ob) is None and sculpts.changed(ob.data)


def noticed(ob):
    """The same for panels, which are drawn all the time. In Blender's own modes the vertices are not in the mesh yet,
    so a cheaper check is used."""
    if live_registry.of(ob) is not None:
        return False
    if ob.mode != "OBJECT":
        return sculpts.edited(ob.data)
    if ob.data.name not in _found:
        _found[ob.data.name] = made(ob)
    return _found[ob.data.name]


@bpy.app.handlers.persistent
def _look_again(*_):
    _found.clear()


@bpy.app.handlers.persistent
def _on_update(scene, depsgraph):
    if _found and (depsgraph.id_type_updated("MESH") or any(u.is_updated_geometry for u in depsgraph.updates)):
        _found.clear()


_HANDLERS = {
    "depsgraph_update_post": _on_update,
    "load_post": _look_again,
    "undo_post": _look_again,
    "redo_post": _look_again,
}


def attach():
    handlers.listen(_HANDLERS)


def detach():
    handlers.ignore(_HANDLERS)
    _found.clear()
