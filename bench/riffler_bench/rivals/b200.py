"""What others need for B200, in the same run. Each gives rows of figures; one that is not there says so in its row."""

from __future__ import annotations

import itertools
import os
import statistics
import time
from collections.abc import Iterator
from typing import Any

import numpy as np

from .. import scenes
from ..measure import Settings
from . import HERE, LeftOutError, program, spoken

BLENDER_SCRIPT = HERE / "blender_boolean.py"
# mm³ that is left of the block by bare capsules, which do not reach out of it, and by 200 static balls.
CAPSULES_LEFT, BALLS_LEFT = 177091.43, 177126.8
WHOLE = float(np.prod(scenes.BLOCK[1]))


def rivals(settings: Settings) -> Iterator[dict[str, Any]]:
    """Rows: engine; us_per_move (median); triangles, mesh_s where meshing is a step of its own; removed less than the
    engine's own exact limit as a share, `removed_short`."""
    yield z_map(0.5 if settings.quick else 0.25)
    yield from manifold(10 if settings.quick else scenes.MOVES)
    yield from openvdb(settings)
    yield from blender(settings)


def left_out(engine: str, why: object) -> dict[str, Any]:
    return {"engine": f"{engine}: left out, {why}"}


def short(left: float, limit: float) -> float:
    """How much less than the exact limit was removed."""
    return (left - limit) / (WHOLE - limit)


def centres() -> np.ndarray:
    return scenes.cutters()[0].path(turning=False)[:, :3] + [0, 0, 3]


def z_map(pitch: float) -> dict[str, Any]:
    """A height map in numpy: window by window, the same capsules as the yardstick's."""
    x, y = (np.arange(round(size / pitch)) * pitch + pitch / 2 for size in scenes.BLOCK[1][:2])
    top = np.full((len(x), len(y)), scenes.BLOCK[1][2])
    times = stamp(top, x, y, centres(), 3.0)
    left = float(top.sum()) * pitch**2
    limit = WHOLE - scenes.B200_REMOVED
    return {
        "engine": f"numpy height map, h = {pitch:g}",
        "us_per_move": 1e6 * statistics.median(times),
        "removed_short": short(left, limit),
        "note": "3 axes only",
    }


def stamp(top: np.ndarray, x: np.ndarray, y: np.ndarray, centres: np.ndarray, r: float) -> list[float]:
    """Takes the capsules between centres (n, 3) off the heights over x and y; seconds of each."""
    times = []
    for a, b in itertools.pairwise(centres):
        start = time.perf_counter()
        v, lower, upper = b - a, np.minimum(a, b) - r, np.maximum(a, b) + r
        i = slice(*np.searchsorted(x, [lower[0], upper[0]]))
        j = slice(*np.searchsorted(y, [lower[1], upper[1]]))
        dx, dy = x[i, None] - a[0], y[None, j] - a[1]
        low = np.full((dx.shape[0], dy.shape[1]), np.inf)
        for t in (0, 1):
            rest = r * r - (dx - t * v[0]) ** 2 - (dy - t * v[1]) ** 2
            np.minimum(low, a[2] + t * v[2] - np.sqrt(rest, where=rest >= 0, out=np.full_like(rest, -np.inf)), out=low)
        low[np.isinf(low)] = np.inf
        vv, along = v @ v, dx * v[0] + dy * v[1]
        qa, qb = 1 - v[2] ** 2 / vv, -along * v[2] / vv
        disc = qb * qb - qa * (dx * dx + dy * dy - along * along / vv - r * r)
        s = (-qb - np.sqrt(np.maximum(disc, 0))) / qa
        t = (along + s * v[2]) / vv
        side = (disc >= 0) & (t >= 0) & (t <= 1)
        low[side] = np.minimum(low, a[2] + s)[side]
        np.minimum(top[i, j], low, out=top[i, j])
        times.append(time.perf_counter() - start)
    return times


def manifold(moves: int, segments: int = 64) -> Iterator[dict[str, Any]]:
    try:
        import manifold3d
    except ImportError:
        yield left_out("Manifold", "manifold3d is not installed")
        return
    ball = manifold3d.Manifold.sphere(3, segments)
    solid = manifold3d.Manifold.cube(scenes.BLOCK[1])
    times = []
    for a, b in itertools.islice(itertools.pairwise(centres()), moves):
        start = time.perf_counter()
        swept = manifold3d.Manifold.batch_hull([ball.translate(a), ball.translate(b)])
        solid = solid - swept
        solid.num_tri()
        times.append(time.perf_counter() - start)
    yield {
        "engine": f"Manifold, hulls of two balls of {segments} segments",
        "us_per_move": 1e6 * statistics.median(times),
        "triangles": solid.num_tri(),
        "removed_short": short(solid.volume(), CAPSULES_LEFT) if moves == scenes.MOVES else None,
        "note": "" if moves == scenes.MOVES else f"first {moves} moves",
    }


def openvdb(settings: Settings) -> Iterator[dict[str, Any]]:
    for pitch in (0.5,) if settings.quick else (0.5, 0.25):
        try:
            r = program(settings, "riffler_openvdb_csg", pitch)
        except LeftOutError as why:
            yield left_out("OpenVDB", why)
            return
        yield {
            "engine": f"OpenVDB {r['version']} CSG, static balls, h = {pitch:g}",
            "us_per_move": 1e6 * r["median"],
            "triangles": r["triangles"],
            "mesh_s": r["mesh"],
            "removed_short": short(WHOLE - (r["volume_before"] - r["volume"]), BALLS_LEFT),
        }


def blender(settings: Settings) -> Iterator[dict[str, Any]]:
    """Modifiers take static balls one by one, as one would by hand; their cost grows with the mesh."""
    if settings.quick:
        return
    environment = {k: v for k, v in os.environ.items() if not k.startswith("PYTHON")}
    for solver, moves in (("FLOAT", 60), ("MANIFOLD", 60), ("EXACT", 20)):
        try:
            python = next((p for p in settings.blenders if p.name.startswith("python") and p.exists()), None)
            if python is None:
                raise LeftOutError("there is no Python with bpy (--blender)")
            r = spoken([python, BLENDER_SCRIPT, solver, str(moves)], environment)
        except LeftOutError as why:
            yield left_out(f"Blender {solver}", why)
            continue
        yield {
            "engine": f"Blender {r['version']} boolean {r['solver']}, first {moves} static balls",
            "us_per_move": 1e6 * r["median"],
            "triangles": r["triangles"],
            "note": f"volume left {r['volume']:.0f} mm³ of 180 000",
        }
