"""The sculpt's surface under a path."""

import numpy as np
from mathutils import Vector
from mathutils.bvhtree import BVHTree


def nearest(points, vertices, triangles):
    """Nearest points (n, 3) of a mesh and the face normals (n, 3) there; all in one frame."""
    tree = BVHTree.FromPolygons(vertices.tolist(), triangles.tolist(), all_triangles=True)
    places, normals = np.empty_like(points), np.empty_like(points)
    for k, p in enumerate(points):
        place, normal, index, _ = tree.find_nearest(Vector(p))
        if index is None:
            raise ValueError("the sculpt has no surface left to follow")
        places[k], normals[k] = place, normal
    return places, normals
