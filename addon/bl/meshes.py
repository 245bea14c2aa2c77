"""Triangles into and out of Blender meshes.

One place owns every dtype and memory layout: a non-contiguous array in `foreach_set` raises and then crashes Blender at
exit, and the fast paths differ between versions.
"""

import math

import bpy
import numpy as np

# Dexel surfaces facet curved cuts by a few degrees; edges that a tool leaves are steeper than this.
SHARP_ANGLE = math.radians(30)


def fill(mesh, co, tri):
    """Replaces the mesh's geometry: `co` (V, 3) Blender units, `tri` (F, 3) vertex indices. Keeps material slots."""
    co = np.ascontiguousarray(co, np.float32)
    tri = np.ascontiguousarray(tri, np.int32)
    faces = len(tri)
    # Always: new topology in place with equal counts leaves stale vertex-to-face maps (wrong normals, 4.2 to 5.0).
    mesh.clear_geometry()
    if faces:
        mesh.vertices.add(len(co))
        mesh.loops.add(3 * faces)
        mesh.polygons.add(faces)
        mesh.polygons.foreach_set("loop_start", np.arange(0, 3 * faces, 3, dtype=np.int32))
        if bpy.app.version < (4, 0, 0):
            mesh.polygons.foreach_set("loop_total", np.full(faces, 3, np.int32))
        attributes = mesh.attributes
        if "position" in attributes:
            attributes["position"].data.foreach_set("vector", co.ravel())
        else:
            mesh.vertices.foreach_set("co", co.ravel())
        if ".corner_vert" in attributes:
            attributes[".corner_vert"].data.foreach_set("value", tri.ravel())
        else:  # unsigned is the type Blender stores: 14 times as fast as int32 in 3.4
            mesh.loops.foreach_set("vertex_index", tri.ravel().view(np.uint32))
    mesh.update(calc_edges=True)
    _shade(mesh, faces)


def _shade(mesh, faces):
    """Smooth, with edges steeper than SHARP_ANGLE sharp."""
    if bpy.app.version >= (4, 1, 0):  # new polygons are smooth; auto smooth is gone
        mesh.set_sharp_from_angle(angle=SHARP_ANGLE)
    else:
        mesh.polygons.foreach_set("use_smooth", np.ones(faces, bool))
        mesh.use_auto_smooth = True
        mesh.auto_smooth_angle = SHARP_ANGLE


def read(ob, depsgraph):
    """Vertices (V, 3) float64 in Blender units in the object's own frame and triangles (F, 3) int32 of the object with
    its modifiers; meshes, curves, texts, surfaces and metaballs."""
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
