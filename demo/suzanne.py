"""Blender's own Suzanne as a closed figure in millimetres. Runs inside Blender's Python (bpy).

    <blender python> demo/suzanne.py out/demo/suzanne.stl [--width 120] [--levels 3]

The eyes are shells of their own that overlap the head, and stay so: `riffler.Volume.from_mesh` decides by winding
number, so overlapping closed shells are one solid.
"""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

import bpy
import numpy as np

STL_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def build(width: float, levels: int) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (n, 3) in mm and triangles (k, 3); the face looks along -y, z is up, `width` (mm) spans the ears."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.mesh.primitive_monkey_add()
    figure = bpy.context.object
    subdivision = figure.modifiers.new("Subdivision", "SUBSURF")
    subdivision.levels = levels
    evaluated = figure.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    mesh.calc_loop_triangles()
    vertices = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", vertices)
    triangles = np.empty(3 * len(mesh.loop_triangles), np.int32)
    mesh.loop_triangles.foreach_get("vertices", triangles)
    vertices = vertices.reshape(-1, 3).astype(np.float64)
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    vertices = (vertices - 0.5 * (low + high)) * (width / (high[0] - low[0]))
    return vertices, triangles.reshape(-1, 3)


def write_stl(path: Path, vertices: np.ndarray, triangles: np.ndarray) -> None:
    corners = vertices[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    rows = np.zeros(len(triangles), STL_TRIANGLE)
    rows["normal"] = normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
    rows["corners"] = corners
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("wb") as file:
        file.write(b"Suzanne, mm".ljust(80, b"\0"))
        file.write(np.uint32(len(rows)).tobytes())
        rows.tofile(file)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("--width", type=float, default=120.0, help="mm across the ears")
    parser.add_argument("--levels", type=int, default=3, help="levels of subdivision")
    options = parser.parse_args()
    vertices, triangles = build(options.width, options.levels)
    write_stl(options.out, vertices, triangles)
    print(f"{options.out}: {len(triangles)} triangles, {np.ptp(vertices, axis=0).round(1).tolist()} mm")


if __name__ == "__main__":
    main()
    # A bpy module that is torn down at interpreter exit may hang (4.5); everything is written, so leave at once.
    sys.stdout.flush()
    os._exit(0)
