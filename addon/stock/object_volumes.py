"""Objects as shapes in a sculpt's frame: the input of masks, crops and reliefs."""

import bpy
import numpy as np
import riffler
from riffler import shape

from ..blender import curve_objects, object_surfaces, refusals
from ..common import splines
from ..sculpt import sculpts


def task_of(mesh, volume):
    """A task that makes the mesh (mm, the sculpt's frame) material on the volume's grid."""
    rays = volume.pitch, volume.directions
    return riffler.submit(riffler.Volume.from_mesh, mesh, *rays, lower=volume.lower, upper=volume.upper)


def of_object(context, source, ob):
    """The surface of an object, with its modifiers, in the sculpt's frame."""
    return object_surfaces.surface(source, context.evaluated_depsgraph_get(), sculpts.from_object(ob, source))


def of_outline(context, curve, ob, volume, tolerance):
    """The closed splines of a curve, through the whole sculpt along the curve's own z."""
    to_sculpt = sculpts.from_object(ob, curve)
    along = to_sculpt[:3, 2] if to_sculpt[:3, 2].any() else axes(ob, curve)[3]  # the z scale may be zero
    along = along / np.linalg.norm(along)
    size = float(np.linalg.norm(volume.upper - volume.lower))
    centre = 0.5 * (volume.lower + volume.upper)
    outlines = []
    for spline in curve_objects.splines(curve, context.evaluated_depsgraph_get(), to_sculpt):
        if not spline.cyclic:
            continue
        points, _ = splines.evaluate(spline, tolerance)
        if len(points) > 3:
            # from well below the sculpt, wherever the curve lies
            points = points - np.outer((points - centre) @ along + size, along)
            outlines.append(points)
    if not outlines:
        raise ValueError(f"{curve.name} has no closed spline: make one cyclic")
    return shape.extrude(outlines, 2 * size * along)


def plane(ob, other):
    """(point, normal) of an object's own plane z = 0, mm in the sculpt's frame; the normal points along its z."""
    origin, _, _, up = axes(ob, other)
    mirrored = sculpts.from_object(ob, other)[:3, 2] @ up < 0
    return origin, -up if mirrored else up


def axes(ob, other):
    """An object's origin, unit x and y, and their unit normal: mm in the sculpt's frame. Its z scale may be zero.
    ValueError if that of x or y is."""
    m = sculpts.from_object(ob, other)
    if np.linalg.matrix_rank(m[:3, :2]) < 2:
        raise ValueError(f"{other.name} is scaled to nothing along its x or y: use Object > Clear > Scale")
    x, y = (m[:3, k] / np.linalg.norm(m[:3, k]) for k in range(2))
    up = np.cross(x, y)
    return m[:3, 3], x, y, up / np.linalg.norm(up)


def pixels(image):
    """(rows, columns, channels) float32, the lowest row first; linear, as Blender has it."""
    width, height = image.size
    if not width or not height:
        raise ValueError(f"{image.name} has no pixels: is its file missing?")
    values = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(values)
    return values.reshape(height, width, image.channels).astype(np.float64)


def chosen(context, name, kinds, what):
    """The object of that name, or the other selected one of these types; ValueError with the remedy."""
    ob = bpy.data.objects.get(name) if name else None
    if name and ob is None:
        raise ValueError(f"there is no object {name!r}")
    if ob is None:
        active = sculpts.active(context)
        others = [o for o in context.selected_objects if o != active and o.type in kinds]
        if len(others) != 1:
            raise ValueError(f"select {what} as well as the sculpt, or name it")
        ob = others[0]
    if why := refusals.disabled(ob, context.view_layer):
        raise ValueError(why)
    if ob.type not in kinds:
        raise ValueError(f"{ob.name} is a {ob.type.lower()}: choose {what}")
    return ob
