"""Sculpts: mesh objects whose mesh points to a volume."""

import bpy
import numpy as np

from . import meshes, store, units


def is_sculpt(ob):
    return ob is not None and ob.type == "MESH" and ob.data.riffler.store is not None


def active(context):
    """The active object where it is a sculpt, otherwise None."""
    ob = context.object
    return ob if is_sculpt(ob) else None


def new_object(context, name, volume, matrix, cuts=()):
    """A new sculpt in the active collection at `matrix` (world), active and the only one selected."""
    mesh = bpy.data.meshes.new(name)
    commit(mesh, volume, list(cuts), units.mm_per_unit(context.scene))
    ob = bpy.data.objects.new(name, mesh)
    context.collection.objects.link(ob)
    ob.matrix_world = matrix
    for other in context.selected_objects:
        other.select_set(False)
    ob.select_set(True)
    context.view_layer.objects.active = ob
    return ob


def commit(mesh, volume, cuts, mm_per_unit):
    """Makes `volume` the mesh's content and shows it. The volume must not be changed afterwards. Returns triangles."""
    surface = volume.to_mesh()  # whatever can fail comes before the first change
    store.write(mesh, volume, cuts)
    show(mesh, surface, mm_per_unit)
    p = mesh.riffler
    p.lower, p.upper, p.pitch, p.directions = volume.lower, volume.upper, volume.pitch, volume.directions
    p.material = volume.volume
    p.nbytes = float(volume.nbytes)
    p.cuts, p.moves = len(cuts), sum(c.moves for c in cuts)
    return len(surface.triangles)


def show(mesh, surface, mm_per_unit):
    """Fills the mesh from a surface in millimetres."""
    meshes.fill(mesh, np.asarray(surface.vertices) / mm_per_unit, surface.triangles)
    p = mesh.riffler
    p.mm_per_unit = mm_per_unit
    p.shown, p.shown_at = _fingerprint(mesh)


def refill(mesh, mm_per_unit):
    """Shows the stored volume again: after the mesh was edited, or the scene's units were changed."""
    show(mesh, store.content(mesh).volume.to_mesh(), mm_per_unit)


def edited(mesh):
    """True where the mesh is not the surface that was last shown: other counts, or other places of a few vertices (as
    after Apply Scale). Cheap enough for every drawing of a panel; a few pulled vertices may escape it."""
    counts, places = _fingerprint(mesh)
    return tuple(mesh.riffler.shown) != counts or tuple(mesh.riffler.shown_at) != places


def _fingerprint(mesh):
    n = len(mesh.vertices)
    if n == 0:
        return (0, len(mesh.polygons)), (0.0,) * 24
    return (n, len(mesh.polygons)), tuple(x for k in range(8) for x in mesh.vertices[k * (n - 1) // 7].co)


def shown_mm_per_unit(mesh):
    """Millimetres of the volume in one Blender unit of its mesh, as it is shown now."""
    return units.clean(mesh.riffler.mm_per_unit)


def to_world_mm(ob, scene):
    """(4, 4): millimetres in the sculpt's frame → millimetres in the scene."""
    here = units.mm_per_unit(scene)
    m = meshes.matrix(ob.matrix_world)
    m[:3, :3] *= here / shown_mm_per_unit(ob.data)
    m[:3, 3] *= here
    return m


def from_object(ob, other):
    """(4, 4): Blender units in another object's frame → millimetres in the sculpt's frame."""
    m = np.linalg.inv(meshes.matrix(ob.matrix_world)) @ meshes.matrix(other.matrix_world)
    m[:3] *= shown_mm_per_unit(ob.data)
    return m
