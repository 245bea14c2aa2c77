"""Rivals that take triangles away: see clock.py."""

from __future__ import annotations

from importlib.metadata import version

import clock
import numpy as np


def part_of(mesh):
    return np.load(f"{mesh}.vertices.npy"), np.load(f"{mesh}.triangles.npy")


def save(mesh, vertices, triangles):
    np.save(f"{mesh}.out.vertices.npy", np.ascontiguousarray(vertices, np.float64))
    np.save(f"{mesh}.out.triangles.npy", np.ascontiguousarray(triangles, np.int32))
    return {"triangles": len(triangles)}


def fast_simplification(mesh, wanted, repeats, threads):
    import fast_simplification as library

    vertices, triangles = part_of(mesh)
    share = 1 - wanted / len(triangles)
    result, times = clock.timed(lambda: library.simplify(vertices, triangles, target_reduction=share), repeats)
    return {"engine": f"fast-simplification {version('fast-simplification')}", **times, **save(mesh, *result)}


def meshoptimizer(mesh, wanted, repeats, threads):
    import meshoptimizer as library

    vertices, triangles = part_of(mesh)
    points, indices = vertices.astype(np.float32), triangles.astype(np.uint32).ravel()

    def work():
        out = np.zeros_like(indices)
        count = library.simplify(out, indices, points, target_index_count=3 * wanted, target_error=1.0)
        return out[:count]

    kept, times = clock.timed(work, repeats)
    return {"engine": f"meshoptimizer {version('meshoptimizer')}", **times, **save(mesh, points, kept.reshape(-1, 3))}


def vtk(mesh, wanted, repeats, threads):
    from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    from vtkmodules.vtkFiltersCore import vtkQuadricDecimation

    vertices, triangles = part_of(mesh)
    points, cells, surface = vtkPoints(), vtkCellArray(), vtkPolyData()
    points.SetData(numpy_to_vtk(vertices, deep=True))
    offsets = numpy_to_vtk(3 * np.arange(len(triangles) + 1, dtype=np.int64), deep=True)
    cells.SetData(offsets, numpy_to_vtk(triangles.astype(np.int64).ravel(), deep=True))
    surface.SetPoints(points)
    surface.SetPolys(cells)
    algorithm = vtkQuadricDecimation()
    algorithm.SetInputData(surface)
    algorithm.SetTargetReduction(1 - wanted / len(triangles))

    def work():
        algorithm.Modified()
        algorithm.Update()
        return algorithm.GetOutput()

    output, times = clock.timed(work, repeats)
    kept = vtk_to_numpy(output.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    saved = save(mesh, vtk_to_numpy(output.GetPoints().GetData()), kept)
    return {"engine": f"VTK {version('vtk')} quadric decimation", **times, **saved}


if __name__ == "__main__":
    clock.main({f.__name__: f for f in (fast_simplification, meshoptimizer, vtk)})
