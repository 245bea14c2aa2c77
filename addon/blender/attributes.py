"""Values at the vertices of a mesh, and how the views show them."""

import bpy
import numpy as np

from ..common import colours
from . import handlers
from .views import views

DISTANCE = "riffler_deviation"  # mm
COLOUR = "riffler_deviation_colour"
ERROR = "riffler_error"  # on a mesh that was made of a sculpt: mm, how far from it at most
SCALE = "riffler_deviation_scale"  # on the mesh: mm of the full colours; where it is there, a legend is drawn

_undone = False  # an undo has taken the last colours away, and a redo may bring them again


def show_distance(mesh, distance, scale):
    """`distance` (n,) mm of the vertices, as an attribute and as colours that are full from `scale` mm on."""
    _put(mesh, DISTANCE, "FLOAT", "value", np.asarray(distance, np.float32))
    _put(mesh, COLOUR, "FLOAT_COLOR", "color", colours.of_distance(distance, scale))
    mesh.color_attributes.active_color = mesh.color_attributes[COLOUR]
    mesh[SCALE] = float(scale)


def hide_distance(mesh):
    """True where it was shown."""
    for name in (DISTANCE, COLOUR):
        if name in mesh.attributes:
            mesh.attributes.remove(mesh.attributes[name])
    return mesh.pop(SCALE, None) is not None


def coloured(mesh):
    """Whether it shows distances: what has changed the mesh may have taken the colours, and left the scale."""
    return SCALE in mesh and COLOUR in mesh.attributes


def _put(mesh, name, kind, field, values):
    if name in mesh.attributes:
        mesh.attributes.remove(mesh.attributes[name])
    mesh.attributes.new(name, kind, "POINT").data.foreach_set(field, np.ascontiguousarray(values).ravel())


# ------------------------------------------------------------------ how the views show them
def shade_by_attribute():
    """Solid views show vertex colours; how they were is kept on the window manager, which no undo takes back."""
    global _undone
    _undone = False
    before = _before()
    for screen, k, space in views():
        if space.shading.color_type != "VERTEX":
            before[f"{screen}/{k}"] = space.shading.color_type
            space.shading.color_type = "VERTEX"
    bpy.context.window_manager.riffler.shading = "\n".join("/".join(item) for item in before.items())


def settle():
    """Views that were made to show vertex colours are as they were once no mesh is coloured any more. True where they
    were made so until now."""
    before = _before()
    if not before or any(mesh.users and SCALE in mesh for mesh in bpy.data.meshes):
        return False
    for screen, k, space in views():
        if f"{screen}/{k}" in before and space.shading.color_type == "VERTEX":
            space.shading.color_type = before[f"{screen}/{k}"]
    bpy.context.window_manager.riffler.shading = ""
    return True


def follow():
    """Undo and redo bring back meshes, and no views."""
    global _undone
    if settle():
        _undone = True
    elif _undone and any(mesh.users and SCALE in mesh for mesh in bpy.data.meshes):
        shade_by_attribute()


def _before():
    """{view: its colours}"""
    kept = bpy.context.window_manager.riffler.shading
    return dict(line.rsplit("/", 1) for line in kept.split("\n") if line)


@bpy.app.handlers.persistent
def _on_history(*_):
    follow()


_HANDLERS = {"undo_post": _on_history, "redo_post": _on_history}
CLASSES = ()


def attach():
    handlers.listen(_HANDLERS)


def detach():
    handlers.ignore(_HANDLERS)
