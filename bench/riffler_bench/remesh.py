"""Surfaces with two parameters as closed triangle meshes of three kinds; every vertex is on the exact surface.

"coarse": as few rows as the surface's bends allow, evenly. "fine": rows 0.6 mm apart, every vertex moved at random
along the surface, each square cut along its shorter diagonal as Delaunay would. "needles": rows at random distances
down to microns, each running the surface's whole length.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from riffler import Mesh

WAYS = ("coarse", "fine", "needles")
STEP = 0.6  # mm between the rows of the fine mesh
JITTER = 0.24  # of a row's distance: below a quarter every square stays convex
NEEDLES = 14  # rows of needles on a flat patch
WELD = 1e-7  # mm: rows that meet in a pole, and the seam


@dataclass(frozen=True)
class Patch:
    """One smooth stretch of a parameter: its length in mm, and the least number of rows that its bend allows."""

    length: float
    least: int = 1


@dataclass(frozen=True)
class Surface:
    """``at(s, t)`` gives points (…, 3); s runs over [0, len(across)], t over [0, len(along)], and sharp edges are at
    whole numbers. A ring closes in t and has a pole, or a point within a flat face, at either end of s; a bar closes in
    s and has flat ends. A round one that is convex stays so in any mesh if whole rows are moved instead of vertices."""

    at: Callable[[np.ndarray, np.ndarray], np.ndarray]
    across: Sequence[Patch]
    along: Sequence[Patch]
    ring: bool
    convex: bool = False


def rows(patches: Sequence[Patch], way: str, rng: np.random.Generator, whole: bool, step: float = STEP) -> np.ndarray:
    """The parameter's values, sharp edges among them; `whole`: needles lie along this parameter."""
    found = []
    for k, patch in enumerate(patches):
        n = patch.least
        if way == "fine":
            n = max(n, round(patch.length / step))
        inner = np.arange(n) / n
        if way == "needles" and not whole:
            # Gaps from a micron to a few millimetres, all sizes alike; never more than the least number allows.
            gaps = 10 ** rng.uniform(-3, 0.5, max(NEEDLES, 2 * n))
            inner = np.concatenate([[0], np.cumsum(gaps) / gaps.sum()])[:-1]
            inner = np.unique(np.concatenate([inner, np.arange(n) / n])) if n > 1 else inner
        found.append(k + inner)
    return np.concatenate([*found, [len(patches)]])


def mesh(surface: Surface, way: str, rng: np.random.Generator, step: float = STEP) -> tuple[Mesh, float, float]:
    """A closed mesh (`step`: mm between rows of the fine one), and the largest part of s and of t, in patches, that a
    triangle spans."""
    s = rows(surface.across, way, rng, whole=surface.ring, step=step)
    t = rows(surface.along, way, rng, whole=not surface.ring, step=step)
    at_s, at_t = np.meshgrid(s, t, indexing="ij")
    if way == "fine":
        at_s, at_t = moved(at_s, 0, rng, surface.convex), moved(at_t, 1, rng, surface.convex)
        if surface.ring:  # the seam is one row
            at_s[:, -1] = at_s[:, 0]
        else:
            at_t[-1] = at_t[0]
    points = surface.at(at_s, at_t)
    index = np.arange(at_s.size).reshape(at_s.shape)
    a, b, c, d = (x.ravel() for x in (index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]))
    flat = points.reshape(-1, 3)
    first = np.linalg.norm(flat[a] - flat[c], axis=1) <= np.linalg.norm(flat[b] - flat[d], axis=1)
    if way != "fine":
        first[:] = True
    triangles = np.concatenate(
        [np.stack(np.where(first, x, y), 1) for x, y in (((a, b, c), (a, b, d)), ((a, c, d), (b, c, d)))]
    )
    if not surface.ring:
        triangles = np.concatenate([triangles, *ends(flat, index)])
    return closed(flat, triangles), span(at_s), span(at_t)


def span(values: np.ndarray) -> float:
    """The largest difference within a square of the grid."""
    corners = np.stack([values[:-1, :-1], values[1:, :-1], values[1:, 1:], values[:-1, 1:]])
    return float(np.max(corners.max(0) - corners.min(0)))


def moved(values: np.ndarray, axis: int, rng: np.random.Generator, rows: bool) -> np.ndarray:
    """Values moved along `axis` by a share of the lesser distance to a neighbour, or whole `rows` of them; sharp edges
    stay."""
    gap = np.diff(values, axis=axis)
    ends = [(1, 0), (0, 0)] if axis == 0 else [(0, 0), (1, 0)]
    before = np.pad(gap, [(1, 0), (0, 0)] if axis == 0 else ends, constant_values=np.inf)
    after = np.pad(gap, [(0, 1), (0, 0)] if axis == 0 else [(0, 0), (0, 1)], constant_values=np.inf)
    shape = [n if k == axis or not rows else 1 for k, n in enumerate(values.shape)]
    loose = abs(values - np.round(values)) > 1e-12
    return values + loose * JITTER * np.minimum(before, after) * rng.uniform(-1, 1, shape)


def ends(points: np.ndarray, index: np.ndarray) -> list[np.ndarray]:
    """The two flat ends of a bar, whose sections are in (x, z), as triangles of its own vertices."""
    found = []
    for column, turn in ((0, -1), (-1, 1)):
        outline = index[:-1, column]
        ears = clipped(points[outline][:, [0, 2]])
        found.append(outline[ears][:, ::turn])
    return found


def clipped(outline: np.ndarray) -> np.ndarray:
    """A simple polygon (n, 2), in either sense, as n - 2 triangles in its own order, by clipping ears (Meisters 1975);
    of the ears at hand, the one with the widest least angle, but for the first."""
    x, y = outline.T
    sense = np.sign(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))
    left, found, k = list(range(len(outline))), [], 0
    misses = 0
    while len(left) > 3:
        n = len(left)
        i, j, m = left[k % n - 1], left[k % n], left[(k + 1) % n]
        if misses > n:
            raise ArithmeticError("a polygon without an ear")
        if ear(outline, left, i, j, m, sense):
            found.append((i, j, m))
            del left[k % n]
            misses = 0
            k += 1  # not always at the same place, which would make a fan
        else:
            misses += 1
            k += 1
    return np.array([*found, left])


def ear(outline: np.ndarray, left: list[int], i: int, j: int, m: int, sense: float) -> bool:
    a, b, c = outline[[i, j, m]]

    def side(p: np.ndarray, q: np.ndarray, r: np.ndarray) -> np.ndarray:
        return sense * ((q[0] - p[0]) * (r[..., 1] - p[1]) - (q[1] - p[1]) * (r[..., 0] - p[0]))

    if side(a, b, c) <= 1e-12:
        return False
    others = outline[[k for k in left if k not in (i, j, m)]]
    within = (side(a, b, others) >= -1e-12) & (side(b, c, others) >= -1e-12) & (side(c, a, others) >= -1e-12)
    return not within.any()


def closed(points: np.ndarray, triangles: np.ndarray) -> Mesh:
    """Equal points welded, triangles without area left out, turned outward."""
    _, first, index = np.unique(np.round(points / WELD), axis=0, return_index=True, return_inverse=True)
    triangles = index.ravel()[triangles]
    a, b, c = triangles.T
    mesh = Mesh(points[first], triangles[(a != b) & (b != c) & (c != a)])
    return mesh if mesh.volume > 0 else Mesh(points[first], np.asarray(mesh.triangles)[:, ::-1])
