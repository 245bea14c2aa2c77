"""How far two sets of curves in space are from each other, by exact distances between points and segments."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

SPACING = 0.002  # mm between the points that are looked at
TOGETHER = (4096, 64)  # points that share their candidates: those of the small groups are among those of the large


@dataclass(frozen=True)
class Segments:
    """Polylines cut up: ends (n, 3) each."""

    begin: np.ndarray
    end: np.ndarray

    @staticmethod
    def of(lines: list[np.ndarray], closed: list[bool]) -> Segments:
        begins, ends = [np.empty((0, 3))], [np.empty((0, 3))]
        for points, loop in zip(lines, closed, strict=True):
            begins.append(points if loop else points[:-1])
            ends.append(np.roll(points, -1, axis=0) if loop else points[1:])
        return Segments(np.concatenate(begins), np.concatenate(ends))

    def __len__(self) -> int:
        return len(self.begin)

    @property
    def lengths(self) -> np.ndarray:
        return np.linalg.norm(self.end - self.begin, axis=1)

    def sampled(self, spacing: float = SPACING) -> tuple[np.ndarray, np.ndarray]:
        """The middles (n, 3) of pieces no longer than `spacing`, and the pieces' lengths (n,)."""
        lengths = self.lengths
        counts = np.maximum(1, np.ceil(lengths / spacing)).astype(int)
        which = np.repeat(np.arange(len(self)), counts)
        place = (np.arange(len(which)) - np.repeat(np.cumsum(counts) - counts, counts) + 0.5) / counts[which]
        points = self.begin[which] + place[:, None] * (self.end - self.begin)[which]
        return points, (lengths / counts)[which]

    def nearest(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Distance (n,) of points, the nearest segment and the share of it at its nearest place; infinite without any.

        Points that are near each other are taken together: a ball around some of them tells which segments any of them
        can be nearest to.
        """
        distance = np.full(len(points), np.inf)
        which, share = np.zeros(len(points), int), np.zeros(len(points))
        if not len(self) or not len(points):
            return distance, which, share
        order, (many, few) = z_order(points), TOGETHER
        for start in range(0, len(points), many):
            group = order[start : start + many]
            candidates = self._near(points[group], np.arange(len(self)))
            for first in range(0, len(group), few):
                part = group[first : first + few]
                near = self._near(points[part], candidates)
                d, u = apart(points[part], self.begin[near], self.end[near])
                best, rows = d.argmin(1), np.arange(len(part))
                distance[part], which[part], share[part] = d[rows, best], near[best], u[rows, best]
        return distance, which, share

    def _near(self, points: np.ndarray, among: np.ndarray) -> np.ndarray:
        """Those of the segments `among` that can be nearest to one of the points."""
        middle = (points.min(0) + points.max(0)) / 2
        radius = np.linalg.norm(points - middle, axis=1).max()
        far, _ = apart(middle[None], self.begin[among], self.end[among])
        return among[far[0] <= far[0].min() + 2 * radius + 1e-9]


def z_order(points: np.ndarray) -> np.ndarray:
    """An order in which points that follow each other are near each other: Morton's, on a grid of 1024³ cells."""
    low = points.min(0, initial=np.inf)
    cells = ((points - low) * (1023 / np.ptp(points, axis=0).max(initial=1e-9))).astype(np.int64)
    keys = np.zeros(len(points), np.int64)
    for bit in range(10):
        for k in range(3):
            keys |= (cells[:, k] >> bit & 1) << (3 * bit + k)
    return np.argsort(keys, kind="stable")


def apart(points: np.ndarray, begin: np.ndarray, end: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distances (n, k) of points from segments, and where on each."""
    way = end - begin
    square = np.einsum("ki,ki->k", way, way)
    off = points[:, None] - begin[None]
    share = np.clip(np.einsum("nki,ki->nk", off, way) / np.maximum(square, 1e-300), 0, 1)
    rest = off - share[..., None] * way
    return np.sqrt(np.einsum("nki,nki->nk", rest, rest)), share


@dataclass(frozen=True)
class Agreement:
    """How far the curves found and the true ones differ, all in mm. `missed` is the length of true curves
    farther than `limit` from any found one, `false` the length of found ones farther than that from any true one."""

    hausdorff: float | None  # None where only one of the sets is empty
    mean: float | None
    missed: float
    false: float
    true_length: float
    found_length: float


def compare(found: Segments, true: Segments, limit: float, spacing: float = SPACING) -> Agreement:
    at, weight = true.sampled(spacing)
    back, long = found.sampled(spacing)
    there, here = found.nearest(at)[0], true.nearest(back)[0]
    # The ends of every segment too: they are the farthest places of straight ones from straight ones.
    ends = [found.nearest(np.concatenate([true.begin, true.end]))[0]]
    ends.append(true.nearest(np.concatenate([found.begin, found.end]))[0])
    all_of = np.concatenate([there, here, *ends])
    both = len(found) > 0 and len(true) > 0
    neither = len(found) == len(true) == 0
    return Agreement(
        hausdorff=float(all_of.max()) if both else 0.0 if neither else None,
        mean=float((here @ long) / long.sum()) if both else 0.0 if neither else None,
        missed=float(weight[there > limit].sum()),
        false=float(long[here > limit].sum()),
        true_length=float(weight.sum()),
        found_length=float(long.sum()),
    )
