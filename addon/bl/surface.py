"""The sculpt's surface under a path."""

import numpy as np
from mathutils import Vector


def nearest(ob, depsgraph, points, mm_per_unit):
    """Nearest points (n, 3) of the sculpt as it is shown and the surface's normals (n, 3) there, in millimetres in its
    own frame like `points`."""
    if not ob.data.polygons:
        raise ValueError("the sculpt has no surface left to follow")
    evaluated = ob.evaluated_get(depsgraph)
    places, normals = np.empty_like(points), np.empty_like(points)
    for k, p in enumerate(points / mm_per_unit):
        found, place, normal, _ = evaluated.closest_point_on_mesh(Vector(p))
        if not found:
            raise ValueError(f"the sculpt has no surface near {points[k]}")
        places[k], normals[k] = place, normal
    return places * mm_per_unit, normals
