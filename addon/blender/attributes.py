"""Values at the vertices of a mesh, and the views that show them."""

import bpy
import numpy as np

from ..common import colours
from . import handlers
from .views import views

DISTANCE = "riffler_deviation"  # mm
COLOUR = "riffler_deviation_colour"
ERROR = "riffler_error"  # on a mesh made from a sculpt: mm, the largest distance from it
# Property of a coloured mesh: distance (mm) at which colours reach full strength; 0 if they show rows or tools.
SCALE = "riffler_deviation_scale"
# Face attributes: the program's row that cut the face, its line and its tool; −1: surface of the uncut stock.
ROW, LINE, TOOL = "riffler_row", "riffler_line", "riffler_tool"
FACE = "riffler_face"  # face attribute of an imported CAD file: the number of its exact face

_undone = False  # True after an undo removed the last colours, which a redo may restore


def show_distance(mesh, distance, scale):
    """Stores `distance` (n,) mm of the vertices as an attribute and as colours, which reach full strength at `scale`
    mm."""
    _put(mesh, DISTANCE, "FLOAT", "value", np.asarray(distance, np.float32))
    _put(mesh, COLOUR, "FLOAT_COLOR", "color", colours.of_distance(distance, scale))
    mesh.color_attributes.active_color = mesh.color_attributes[COLOUR]
    mesh[SCALE] = float(scale)


def show_cuts(mesh, cuts, shown):
    """Stores `cuts`, {ROW, LINE, TOOL: (faces,)}, as attributes of the faces, and their colours `shown` (faces, 4)."""
    for name, values in cuts.items():
        _put(mesh, name, "INT", "value", np.asarray(values, np.int32), "FACE")
    corners = np.repeat(np.asarray(shown, np.float32), 3, axis=0)
    _put(mesh, COLOUR, "FLOAT_COLOR", "color", corners, "CORNER")
    mesh.color_attributes.active_color = mesh.color_attributes[COLOUR]
    mesh[SCALE] = 0.0


def set_exact_faces(mesh, numbers):
    """Stores the number of the exact face, `numbers` (faces,), of each face."""
    _put(mesh, FACE, "INT", "value", np.asarray(numbers, np.int32), "FACE")


def hide_colours(mesh):
    """Removes all colours. True if the mesh showed distances or cuts."""
    for name in (DISTANCE, COLOUR, ROW, LINE, TOOL):
        if name in mesh.attributes:
            mesh.attributes.remove(mesh.attributes[name])
    return mesh.pop(SCALE, None) is not None


def shows_distance(mesh):
    """Whether the mesh shows distances. An edit of the mesh may have removed the colours but not the scale."""
    return mesh.get(SCALE, 0.0) > 0 and COLOUR in mesh.attributes


def _put(mesh, name, kind, field, values, domain="POINT"):
    if name in mesh.attributes:
        mesh.attributes.remove(mesh.attributes[name])
    mesh.attributes.new(name, kind, domain).data.foreach_set(field, np.ascontiguousarray(values).ravel())


# ------------------------------------------------------------------ how the views show them
def shade_by_attribute():
    """Switches solid views to vertex colours. The window manager keeps their previous shading, which no undo
    changes."""
    global _undone
    _undone = False
    before = _before()
    for screen, k, space in views():
        if space.shading.color_type != "VERTEX":
            before[f"{screen}/{k}"] = space.shading.color_type
            space.shading.color_type = "VERTEX"
    bpy.context.window_manager.riffler.shading = "\n".join("/".join(item) for item in before.items())


def settle():
    """Restores the shading of the views once no mesh is coloured. True if views showed vertex colours until now."""
    before = _before()
    if not before or any(mesh.users and SCALE in mesh for mesh in bpy.data.meshes):
        return False
    for screen, k, space in views():
        if f"{screen}/{k}" in before and space.shading.color_type == "VERTEX":
            space.shading.color_type = before[f"{screen}/{k}"]
    bpy.context.window_manager.riffler.shading = ""
    return True


def follow():
    """Updates views after undo or redo, which restore meshes only."""
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
