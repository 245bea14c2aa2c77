"""The tool that traces a surface, and the surface's normal where it touches: drawn in the views, not objects of the
scene. Draw handlers exist only from `begin` to `end`."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Matrix, Vector

from ..blender import batches, views
from ..common import glyphs

TOOL, NORMAL = (0.9, 0.45, 0.1), (0.2, 0.85, 0.35)
LENGTH, WIDTH = 60.0, 5.0  # pixels, of the normal

_kept = batches.Batches()
_in_views = views.InViews()
_shown = None


@dataclass
class Shown:
    """The displayed state; the caller of `begin` updates it."""

    triangles: np.ndarray  # (n, 3, 3) mm: the tool, its tip at the origin, its axis z
    unit: float  # Blender units per mm
    pose: np.ndarray | None = None  # (6,) mm
    contact: tuple | None = None  # point and normal, mm


def begin(solid, unit):
    """A Shown to be updated by the caller. `solid`: vertices and triangles, mm."""
    global _shown
    end()
    vertices, triangles = solid
    _shown = Shown(vertices[triangles], unit)
    _in_views.add(_draw, "POST_VIEW")
    return _shown


def end():
    global _shown
    _shown = None
    _in_views.clear()
    _kept.clear()


def _draw():
    import gpu

    shown, region = _shown, bpy.context.region_data
    if shown is None or shown.pose is None or region is None:
        return
    turn = Vector((0, 0, 1)).rotation_difference(Vector(shown.pose[3:])).to_matrix()
    place = Matrix.Translation(Vector(shown.pose[:3] * shown.unit)) @ (turn * shown.unit).to_4x4()
    towards = np.array(region.view_matrix)[:3, :3]
    own = towards @ np.array(turn)  # the light in the tool's frame
    with batches.state(depth="LESS_EQUAL"), gpu.matrix.push_pop():
        gpu.matrix.multiply_matrix(place)
        tool = _kept.get("tool", own.round(3).tobytes(), lambda: batches.shaded(shown.triangles, TOOL, own))
        batches.draw(tool)
    if shown.contact is None:
        return
    point, normal = shown.contact[0] * shown.unit, shown.contact[1]
    pixel = _pixel(region, point)
    arrow = glyphs.arrow(point, point + LENGTH * pixel * normal, WIDTH * pixel)
    with batches.state(depth="NONE"):
        mark = _kept.get("normal", arrow.tobytes(), lambda: batches.shaded(arrow, NORMAL, towards))
        batches.draw(mark)


def _pixel(region, point):
    """A pixel's size at a point, in Blender units."""
    perspective = np.array(region.perspective_matrix)
    weight = abs(float(perspective[3] @ np.append(point, 1.0)))
    return 2 * weight / (np.linalg.norm(np.array(region.window_matrix)[0, :3]) * max(bpy.context.region.width, 1))
