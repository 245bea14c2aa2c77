"""Rivals that tell where rays meet a part: see clock.py. Rays run up along z from the middles of square cells."""

from __future__ import annotations

from importlib.metadata import version

import clock
import numpy as np

CHUNK = 1 << 18


def part_of(mesh):
    return np.load(f"{mesh}.vertices.npy"), np.load(f"{mesh}.triangles.npy")


def origins(lower, pitch, side, bottom):
    at = [lower[k] + pitch * (np.arange(side) + 0.5) for k in (0, 1)]
    x, y = np.meshgrid(*at, indexing="ij")
    return np.stack([x.ravel(), y.ravel(), np.full(side * side, bottom)], 1)


def told(rays, heights, count, pitch):
    """From the rays' numbers and heights of all hits: rays with an odd number of them, and the volume of the others."""
    order = np.lexsort((heights, rays))
    rays, heights = rays[order], heights[order]
    hits = np.bincount(rays, minlength=count)
    first = np.concatenate([[0], np.cumsum(hits)])[rays]
    out = (np.arange(len(rays)) - first) % 2 == 1
    even = hits[rays] % 2 == 0
    return {
        "odd": int((hits % 2).sum()),
        "volume": float((heights[even & out].sum() - heights[even & ~out].sum()) * pitch**2),
    }


def open3d(mesh, lower, pitch, side, bottom, threads):
    import open3d as o3d

    vertices, triangles = part_of(mesh)
    start = origins(lower, pitch, side, bottom)
    rays = np.concatenate([start, np.tile([0.0, 0.0, 1.0], (len(start), 1))], 1).astype(np.float32)

    def build():
        scene = o3d.t.geometry.RaycastingScene(nthreads=threads)
        scene.add_triangles(vertices.astype(np.float32), triangles.astype(np.uint32))
        return scene

    scene, built = clock.timed(build, 1)

    def cast():
        found = []
        for begin in range(0, len(rays), CHUNK):
            hit = scene.list_intersections(o3d.core.Tensor(rays[begin : begin + CHUNK]), nthreads=threads)
            found.append((hit["ray_ids"].numpy().astype(int) + begin, hit["t_hit"].numpy()))
        return found

    found, times = clock.timed(cast, 1)
    ids, heights = (np.concatenate(x) for x in zip(*found, strict=True))
    figures = told(ids, heights.astype(float), len(rays), pitch)
    return {"engine": f"open3d {version('open3d-cpu')}", **times, "build_s": built["cpu_s"], **figures}


def trimesh(mesh, lower, pitch, side, bottom, threads):
    import trimesh as library
    from trimesh.ray import ray_pyembree

    part = library.Trimesh(*part_of(mesh), process=False)
    start = origins(lower, pitch, side, bottom)
    up = np.tile([0.0, 0.0, 1.0], (len(start), 1))
    scene, built = clock.timed(lambda: ray_pyembree.RayMeshIntersector(part), 1)

    def cast():
        found = []
        for begin in range(0, len(start), CHUNK):
            part_of_rays = slice(begin, begin + CHUNK)
            places, ids, _ = scene.intersects_location(start[part_of_rays], up[part_of_rays], multiple_hits=True)
            found.append((ids + begin, np.asarray(places).reshape(-1, 3)[:, 2]))
        return found

    found, times = clock.timed(cast, 1)
    ids, heights = (np.concatenate(x) for x in zip(*found, strict=True))
    figures = told(ids.astype(int), heights, len(start), pitch)
    return {"engine": f"trimesh {version('trimesh')} with Embree", **times, "build_s": built["cpu_s"], **figures}


def winding(mesh, lower, pitch, side, bottom, threads):
    """Points instead of rays: as many along z as the part is high."""
    import igl

    vertices, triangles = part_of(mesh)
    top = vertices[:, 2].max()
    layers = round((top - bottom) / pitch)
    start = origins(lower, pitch, side, bottom)
    points = np.repeat(start, layers, 0)
    points[:, 2] += np.tile(pitch * (np.arange(layers) + 0.5), len(start))
    inside, times = clock.timed(lambda: igl.fast_winding_number(vertices, triangles, points), 1)
    volume = float((abs(inside) > 0.5).sum() * pitch**3)
    return {"engine": f"libigl {version('libigl')}", **times, "build_s": 0.0, "points": len(points), "volume": volume}


if __name__ == "__main__":
    clock.main({f.__name__: f for f in (open3d, trimesh, winding)})
