"""Rivals that mesh a field: see clock.py. Each gets a file of float32 values, z fastest, and writes .npy files."""

from __future__ import annotations

import math
from importlib.metadata import version

import clock
import numpy as np


def field_of(field, shape):
    return np.fromfile(field, np.float32).reshape(shape)


def save(mesh, vertices, triangles):
    np.save(f"{mesh}.vertices.npy", np.ascontiguousarray(vertices, np.float64))
    np.save(f"{mesh}.triangles.npy", np.ascontiguousarray(triangles, np.int32))
    return {"triangles": len(triangles)}


def vtk_image(values, pitch, origin, threads):
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonCore import vtkSMPTools
    from vtkmodules.vtkCommonDataModel import vtkImageData

    # VTK's wheels start with one thread.
    vtkSMPTools.SetBackend("STDThread" if threads > 1 else "Sequential")
    vtkSMPTools.Initialize(threads)
    image = vtkImageData()
    # x is VTK's fastest axis: the axes are given to it in reverse order.
    image.SetDimensions(*values.shape[::-1])
    image.SetSpacing(pitch, pitch, pitch)
    image.SetOrigin(*origin[::-1])
    scalars = numpy_to_vtk(values.ravel())
    image.GetPointData().SetScalars(scalars)
    return image, scalars


def vtk_mesh(output, mesh):
    from vtkmodules.util.numpy_support import vtk_to_numpy

    vertices = vtk_to_numpy(output.GetPoints().GetData())[:, ::-1]
    triangles = vtk_to_numpy(output.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    return save(mesh, vertices, triangles)


def run_vtk(algorithm, mesh, repeats):
    def work():
        algorithm.Modified()
        algorithm.Update()
        return algorithm.GetOutput()

    output, times = clock.timed(work, repeats)
    return {"engine": f"VTK {version('vtk')}", **times, **vtk_mesh(output, mesh)}


def flying_edges(field, shape, pitch, origin, mesh, threads, repeats):
    from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D

    image, _scalars = vtk_image(field_of(field, shape), pitch, origin, threads)
    algorithm = vtkFlyingEdges3D()
    algorithm.SetInputData(image)
    algorithm.SetValue(0, 0.0)
    algorithm.ComputeNormalsOff()
    algorithm.ComputeGradientsOff()
    return run_vtk(algorithm, mesh, repeats)


def surface_nets(field, shape, pitch, origin, mesh, threads, repeats):
    """It meshes labels, not distances."""
    from vtkmodules.vtkFiltersCore import vtkSurfaceNets3D

    image, _scalars = vtk_image((field_of(field, shape) < 0).astype(np.uint8), pitch, origin, threads)
    algorithm = vtkSurfaceNets3D()
    algorithm.SetInputData(image)
    algorithm.SetValue(0, 1.0)
    algorithm.SetOutputMeshTypeToTriangles()
    return run_vtk(algorithm, mesh, repeats)


def open3d(field, shape, pitch, origin, mesh, threads, repeats):
    import open3d as o3d

    values = o3d.core.Tensor(np.ascontiguousarray(field_of(field, shape)))
    make = o3d.t.geometry.TriangleMesh.create_isosurfaces
    result, times = clock.timed(lambda: make(values, [0.0]), repeats)
    vertices = result.vertex.positions.numpy()
    # Coordinates come as (z, y, x) in cells.
    vertices = np.asarray(origin) + pitch * vertices[:, ::-1].astype(float)
    return {
        "engine": f"open3d {version('open3d-cpu')}",
        **times,
        **save(mesh, vertices, result.triangle.indices.numpy()),
    }


def scikit_image(field, shape, pitch, origin, mesh, threads, repeats):
    from skimage.measure import marching_cubes

    values = field_of(field, shape)
    result, times = clock.timed(lambda: marching_cubes(values, 0.0, spacing=(pitch,) * 3), repeats)
    vertices, triangles = result[:2]
    return {
        "engine": f"scikit-image {version('scikit-image')}",
        **times,
        **save(mesh, vertices + np.asarray(origin), triangles),
    }


def manifold(field, shape, pitch, origin, mesh, threads, repeats):
    """It asks a Python function for every value: here the field, between its points linearly."""
    import manifold3d

    values, origin = field_of(field, shape), np.asarray(origin)
    flat, (nx, ny, nz) = (-values).ravel().tolist(), shape
    ox, oy, oz = origin

    def value(x, y, z):
        u, v, w = (x - ox) / pitch, (y - oy) / pitch, (z - oz) / pitch
        i, j, k = (min(max(math.floor(a), 0), n - 2) for a, n in ((u, nx), (v, ny), (w, nz)))
        u, v, w = u - i, v - j, w - k
        n = (i * ny + j) * nz + k
        m = n + ny * nz
        near = (flat[n] * (1 - w) + flat[n + 1] * w) * (1 - v) + (flat[n + nz] * (1 - w) + flat[n + nz + 1] * w) * v
        far = (flat[m] * (1 - w) + flat[m + 1] * w) * (1 - v) + (flat[m + nz] * (1 - w) + flat[m + nz + 1] * w) * v
        return near * (1 - u) + far * u

    upper = origin + pitch * (np.asarray(shape) - 1)
    make = lambda: manifold3d.Manifold.level_set(value, [*origin, *upper], pitch).to_mesh()  # noqa: E731
    result, times = clock.timed(make, repeats)
    return {
        "engine": f"Manifold {version('manifold3d')}",
        **times,
        **save(mesh, result.vert_properties[:, :3], result.tri_verts),
    }


if __name__ == "__main__":
    clock.main({f.__name__: f for f in (flying_edges, surface_nets, open3d, scikit_image, manifold)})
