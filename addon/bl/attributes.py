"""Values at the vertices of a mesh, and how the views show them."""

import numpy as np

from ..core import colours
from . import chunks

DISTANCE = "riffler_deviation"  # mm
COLOUR = "riffler_deviation_colour"
ERROR = "riffler_error"  # on a mesh that was made of a sculpt: mm, how far from it at most
SCALE = "riffler_deviation_scale"  # on the mesh: mm of the full colours; where it is there, a legend is drawn


def show_distance(mesh, distance, scale):
    """`distance` (n,) mm of the vertices, as an attribute and as colours that are full from `scale` mm on."""
    _put(mesh, DISTANCE, "FLOAT", "value", np.asarray(distance, np.float32))
    _put(mesh, COLOUR, "FLOAT_COLOR", "color", colours.of_distance(distance, scale))
    mesh.color_attributes.active_color = mesh.color_attributes[COLOUR]
    mesh[SCALE] = float(scale)


def hide_distance(mesh):
    for name in (DISTANCE, COLOUR):
        if name in mesh.attributes:
            mesh.attributes.remove(mesh.attributes[name])
    if SCALE in mesh:
        del mesh[SCALE]


def _put(mesh, name, kind, field, values):
    if name in mesh.attributes:
        mesh.attributes.remove(mesh.attributes[name])
    mesh.attributes.new(name, kind, "POINT").data.foreach_set(field, np.ascontiguousarray(values).ravel())


def shade_by_attribute(collection):
    """Solid views show vertex colours; how they were is kept on `collection`, a datablock's custom properties."""
    before = []
    for screen, k, space in chunks.views():
        if space.shading.color_type != "VERTEX":
            before.append(f"{screen}/{k}/{space.shading.color_type}")
            space.shading.color_type = "VERTEX"
    if before:
        collection["riffler_shading"] = "\n".join(before)


def shade_as_before(collection):
    before = dict(line.rsplit("/", 1) for line in collection.pop("riffler_shading", "").split("\n") if line)
    for screen, k, space in chunks.views():
        if f"{screen}/{k}" in before and space.shading.color_type == "VERTEX":
            space.shading.color_type = before[f"{screen}/{k}"]
