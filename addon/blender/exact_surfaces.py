"""Exact faces of objects, in millimetres of the world: of imported CAD files, whose faces are read again from the file,
and of Blender's own NURBS surfaces."""

import os

import numpy as np
import riffler
from riffler.cad import reading
from riffler.cad.surfaces import surface_of

from ..common import cad_python, nurbs_patches, poses, units
from . import meshes, preferences_access, refusals, scene_units

# Properties of an imported mesh: the file, the chord tolerance in mm, and the names of the exact faces.
FILE, TOLERANCE, NAMES = "riffler_cad_file", "riffler_cad_tolerance", "riffler_cad_faces"
SELECT = "Select an object that was imported from a CAD file, or a NURBS surface"
SAMPLES = 400  # vertices that are compared with the exact faces
ROUNDING = 1e-5  # of the largest coordinate: vertices are single precision
COARSE = 0.02  # of a surface's size: tolerance of the mesh that tells inside from outside
_pythons = {}  # Python that reads CAD files, by the user's choice; kept because the search takes a second
_read = (None, None)  # key of the last file, and what the reader returned for it


def python():
    """The Python that reads CAD files. ValueError, with the remedy, if there is none."""
    chosen = preferences_access.cad_python()
    if chosen not in _pythons:
        _pythons[chosen] = cad_python.find(chosen)
    return _pythons[chosen]


def unfit(ob):
    """Why an object has no exact faces, or ""; cheap enough for a poll."""
    if why := refusals.instance(ob):
        return why
    if ob is None or not (ob.type == "SURFACE" or (ob.type == "MESH" and FILE in ob.data)):
        return SELECT
    return ""


def reader(context, ob):
    """A function of `progress` that returns the riffler.Surface of an object, for another thread: it does not touch
    Blender. ValueError, here or there, if the object has none, or is not what its file has."""
    if why := unfit(ob) or refusals.disabled(ob, context.view_layer):
        raise ValueError(why)
    depsgraph = context.evaluated_depsgraph_get()
    evaluated = ob.evaluated_get(depsgraph)
    matrix = meshes.matrix(evaluated.matrix_world)
    if why := refusals.flat(ob, matrix):
        raise ValueError(why)
    mm = scene_units.mm_per_unit(context.scene)
    matrix[:3] *= mm
    co, triangles = meshes.read(ob, depsgraph)
    if len(triangles) == 0:
        raise ValueError(f"{ob.name} has no faces")
    points = poses.transform_points(matrix, co)
    if ob.type == "MESH":
        return _of_file(ob, matrix @ np.diag([1 / mm, 1 / mm, 1 / mm, 1.0]), points)
    return _of_splines(ob, evaluated.data, matrix, points, triangles)


def _of_file(ob, place, points):
    """`place`: from the file's mm to the world's; `points`: the mesh's vertices, mm of the world."""
    path, name = ob.data[FILE], ob.name
    size = np.linalg.svd(place[:3, :3], compute_uv=False)[0]
    allowed = 2 * size * ob.data[TOLERANCE] + ROUNDING * np.abs(points).max()
    sample = points[np.unique(np.linspace(0, len(points) - 1, SAMPLES).astype(int))]
    with_python = python()

    def read(progress):
        answer, arrays, _ = _answer(path, with_python, progress)
        surface = surface_of(answer, arrays, os.path.basename(path), place)
        off = float(surface.closest(sample)[2].max())
        if off > allowed:
            raise ValueError(
                f"the mesh of {name} is {units.trim(off, 3)} mm from the faces of {os.path.basename(path)}: it was "
                "edited or has modifiers, or the file has changed. Change CAD Tolerance reads the file again"
            )
        return surface

    return read


def _answer(path, with_python, progress):
    """What the reader returns for a file; the last one is kept."""
    global _read
    try:
        found = os.stat(path)
    except OSError as error:
        raise ValueError(f"{path}: the exact faces cannot be read: {error.strerror}") from error
    key = (path, found.st_mtime_ns, found.st_size)
    if _read[0] != key:
        _read = (None, None)
        read = reading.answer_to(
            path, reading.BORDERS, python=with_python, progress=progress, borders=reading.BORDERS, mesh=False
        )
        _read = (key, read)
    return _read[1]


def _of_splines(ob, data, matrix, points, triangles):
    """Shape keys and modifiers are not in the splines, so Blender's own mesh is compared with them."""
    name, patches = ob.name, []
    for number, s in enumerate(data.splines):
        if s.hide:
            continue
        if s.type != "NURBS" or s.point_count_v < 2 or s.point_count_u < 2:
            raise ValueError(f"{name}: spline {number + 1} is a curve, not a surface")
        co = np.empty(len(s.points) * 4, np.float32)
        s.points.foreach_get("co", co)
        net = co.reshape(s.point_count_v, s.point_count_u, 4).astype(float).transpose(1, 0, 2)
        ends = [
            (s.order_u, s.use_cyclic_u, s.use_endpoint_u, s.use_bezier_u),
            (s.order_v, s.use_cyclic_v, s.use_endpoint_v, s.use_bezier_v),
        ]
        try:
            patches.append(nurbs_patches.patch(poses.transform_points(matrix, net[..., :3].reshape(-1, 3)), net, ends))
        except ValueError as error:
            raise ValueError(f"{name}: spline {number + 1}: {error}") from error

    def read(progress):
        surface = riffler.Surface([patch() for patch in patches])
        sample = points[np.unique(np.linspace(0, len(points) - 1, SAMPLES).astype(int))]
        off = float(surface.closest(sample)[2].max())
        if off > ROUNDING * np.abs(points).max():
            raise ValueError(
                f"the mesh of {name} is {units.trim(off, 3)} mm from its NURBS surface: remove its "
                "modifiers and shape keys, which the exact surface does not include"
            )
        if _inside_out(surface, points, triangles):
            surface = riffler.Surface([patch(True) for patch in patches])
        return surface

    return read


def _inside_out(surface, points, triangles):
    """Whether the normals point into the material: of a closed surface by its volume, of an open one by the normals
    that Blender shows."""
    mesh = surface.to_mesh(COARSE * float(np.ptp(points, axis=0).max()))
    if not mesh.audit().open_edges:
        return mesh.volume < 0
    corners = points[triangles[:: max(1, len(triangles) // SAMPLES)]]
    shown = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    _, normals, _ = surface.closest(corners.mean(axis=1))
    return float(np.einsum("ij,ij->", shown, normals)) < 0
