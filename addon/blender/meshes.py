"""Triangles into and out of Blender meshes.

This module owns every dtype and memory layout: a non-contiguous array in `foreach_set` raises an error and then crashes
Blender at exit. Arrays passed to Blender are contiguous float32 and int32; versions.py handles the differences between
versions.
"""

import math

import bpy
import numpy as np

from . import versions

# Angle above which an edge is sharp. Dexel surfaces facet curved cuts by a few degrees, and edges that a tool leaves
# are steeper than this angle. The seam of a bead or groove of the default radius and depth has 25 to 40 degrees: an
# angle within that range makes one edge of the seam sharp and the next smooth, which looks like crumbs.
SHARP_ANGLE = math.radians(20)


def fill(mesh, co, tri, edges=None, **shading):
    """Replaces the mesh's geometry: `co` (V, 3) Blender units, `tri` (F, 3) vertex indices. Keeps material slots.

    `edges`, if known: (E, 2) vertex indices, each edge once, and (F, 3), for each corner of a triangle the edge to the
    next corner. Blender takes three times as long to compute them. A mesh with `edges` is one of the chunks: `shading`
    is that of versions.shade_chunk.
    """
    co = np.ascontiguousarray(co, np.float32)
    tri = np.ascontiguousarray(tri, np.int32)
    _forget_shape_keys(mesh)
    # Always rebuild: new topology in place with equal counts leaves stale vertex-to-face maps (wrong normals, 4.2 to
    # 5.0).
    mesh.clear_geometry()
    if len(tri):
        mesh.vertices.add(len(co))
        mesh.loops.add(tri.size)
        mesh.polygons.add(len(tri))
        versions.write_positions(mesh, co.ravel())
        versions.write_triangles(mesh, tri.ravel())
        if edges is not None:
            ends, corners = (np.ascontiguousarray(a, np.int32) for a in edges)
            mesh.edges.add(len(ends))
            versions.write_edges(mesh, ends.ravel(), corners.ravel())
    mesh.update(calc_edges=edges is None)
    if edges is None:
        versions.shade_by_angle(mesh, SHARP_ANGLE)
    elif len(tri):
        versions.shade_chunk(mesh, SHARP_ANGLE, **shading)


def _forget_shape_keys(mesh):
    """Removes the shape keys, whose vertices no longer exist. Only an object can clear them."""
    if mesh.shape_keys is not None:
        next(ob for ob in bpy.data.objects if ob.data == mesh).shape_key_clear()


def coordinates(mesh):
    """(V, 3) float32, as stored."""
    co = np.empty((len(mesh.vertices), 3), np.float32)
    versions.read_positions(mesh, co.ravel())
    return co


def read(ob, depsgraph):
    """Vertices (V, 3) float64 in Blender units in the object's own frame and triangles (F, 3) int32 of the object with
    its modifiers. Takes meshes, curves, texts, surfaces and metaballs."""
    evaluated = ob.evaluated_get(depsgraph)
    mesh = evaluated.to_mesh()
    try:
        if mesh is None:
            raise ValueError(f"{ob.name} has no surface")
        mesh.calc_loop_triangles()
        co = np.empty((len(mesh.vertices), 3), np.float32)
        tri = np.empty((len(mesh.loop_triangles), 3), np.int32)
        mesh.vertices.foreach_get("co", co.ravel())
        mesh.loop_triangles.foreach_get("vertices", tri.ravel())
    finally:
        evaluated.to_mesh_clear()
    return co.astype(np.float64), tri


def matrix(m):
    """A mathutils.Matrix as a (4, 4) array."""
    return np.array(m, dtype=np.float64)
