"""OpenCAMLib's drop cutter: see clock.py."""

from __future__ import annotations

import clock
import numpy as np


def cutter_of(kind, sizes):
    import opencamlib as ocl

    return getattr(ocl, kind)(*sizes)


def opencamlib(mesh, kind, sizes, points, result, threads):
    """Heights of the tip, as a file; times of the drops alone, with the tree over the triangles in `build_s`."""
    import opencamlib as ocl

    vertices, triangles = np.load(f"{mesh}.vertices.npy"), np.load(f"{mesh}.triangles.npy")
    where = np.load(points)
    surface = ocl.STLSurf()
    for corners in vertices[triangles]:
        surface.addTriangle(ocl.Triangle(*(ocl.Point(*map(float, c)) for c in corners)))
    cutter = cutter_of(kind, sizes)
    lowest = float(vertices[:, 2].min()) - 1.0

    def build():
        dropper = ocl.BatchDropCutter()
        dropper.setThreads(threads)
        dropper.setSTL(surface)
        dropper.setCutter(cutter)
        return dropper

    dropper, built = clock.timed(build, 1)
    for x, y in where:
        dropper.appendPoint(ocl.CLPoint(float(x), float(y), lowest))
    _, times = clock.timed(dropper.run, 1)
    heights = np.array([p.z for p in dropper.getCLPoints()])
    heights[heights <= lowest] = np.nan  # nothing below
    np.save(result, heights)
    return {"engine": f"OpenCAMLib {ocl.version()}", **times, "build_s": built["cpu_s"]}


if __name__ == "__main__":
    clock.main({"opencamlib": opencamlib})
