"""Whether a visible object hides a place of the scene in a 3D view."""

import bpy
import numpy as np

from ..blender import scene_units
from . import timeline

MOST = 16  # surfaces along a ray that hide nothing: the plan's own tool has a few
THROUGH = {"WIRE", "BOUNDS"}  # display types that are transparent


def hider(context, view):
    """A function of a place (3,) in mm, outside its own surface: True if something hides it in the context's 3D view,
    given its ViewRays. Rays start at the place and end at the eye: Blender's single precision is finer near the surface
    than near a distant eye."""
    scene, space = context.scene, context.space_data
    if _looks_through(space):
        return lambda place: False
    graph, mm = context.view_layer.depsgraph or context.evaluated_depsgraph_get(), scene_units.mm_per_unit(scene)

    def hidden(place):
        eye, _ = view.ray(*view.project([place])[0])
        way = (eye - place) / mm
        return _meets(scene, graph, space, np.asarray(place) / mm, way)

    return hidden


def _looks_through(space):
    shading = getattr(space, "shading", None)
    return shading is not None and (shading.type == "WIREFRAME" or (shading.type == "SOLID" and shading.show_xray))


def _meets(scene, graph, space, begin, way):
    """Whether an occluder lies on the ray, all in Blender units."""
    left = float(np.linalg.norm(way))
    if not (np.isfinite(left) and left > 0):
        return False
    direction = way / left
    for _ in range(MOST):
        hit, place, _, _, ob, _ = scene.ray_cast(graph, begin, direction, distance=left)
        if not hit:
            return False
        if _hides(ob.original, space):
            return True
        on = float((np.array(place) - begin) @ direction) + 1e-5 * (float(np.abs(begin).max()) + left)
        begin, left = begin + on * direction, left - on
        if left <= 0:
            return False
    return False


def _hides(ob, space):
    if ob.display_type in THROUGH or timeline.plan_of(ob) is not None or not ob.visible_get():
        return False
    return not isinstance(space, bpy.types.SpaceView3D) or ob.visible_in_viewport_get(space)
