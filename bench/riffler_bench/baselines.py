"""The two methods by which open systems find pencil curves, rewritten here to be compared with riffler's.

``creases``: edges whose two triangles stand at more than a threshold to each other, hollow side out; the ball's centre
lies on their bisector. ``height_map``: the ball is dropped along z on every pixel, and where the map of its heights
bends up by more than a threshold from pixel to pixel, there is a valley; blind to what it cannot see from above.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from riffler import Mesh, Volume

from .curves import Segments

PIXEL = 0.1  # mm
WAYS = ((1, 0), (0, 1), (1, 1), (1, -1))


@dataclass(frozen=True)
class Creases:
    """All hollow edges of a mesh with the centres of a ball that touches both faces, once for any threshold."""

    angle: np.ndarray  # rad between the normals
    edges: np.ndarray  # (n, 2) vertices
    ends: np.ndarray  # (n, 2, 3) centres

    @staticmethod
    def of(mesh: Mesh, radius: float) -> Creases:
        points, triangles = np.asarray(mesh.vertices), np.asarray(mesh.triangles)
        a, b, c = (points[triangles[:, k]] for k in range(3))
        normals = np.cross(b - a, c - a)
        normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-300)[:, None]
        half = np.concatenate([triangles[:, [k, (k + 1) % 3]] for k in range(3)])
        opposite = np.concatenate([triangles[:, (k + 2) % 3] for k in range(3)])
        face = np.tile(np.arange(len(triangles)), 3)
        ordered = np.sort(half, axis=1)
        order = np.lexsort((ordered[:, 1], ordered[:, 0]))
        same = (ordered[order[1:]] == ordered[order[:-1]]).all(1)
        one, two = order[:-1][same], order[1:][same]
        n, m = normals[face[one]], normals[face[two]]
        angle = np.arctan2(np.linalg.norm(np.cross(n, m), axis=1), np.einsum("ij,ij->i", n, m))
        # Hollow: the other triangle's far corner is above this one's plane.
        above = np.einsum("ij,ij->i", points[opposite[two]] - points[half[one][:, 0]], n) > 0
        hollow = above & (angle > np.radians(1)) & (angle < np.radians(179))
        n, m, edges = n[hollow], m[hollow], half[one[hollow]]
        # Equal distance R from both planes: along n + m, by R / cos(half the angle between them).
        away = radius * (n + m) / (1 + np.einsum("ij,ij->i", n, m))[:, None]
        return Creases(angle[hollow], edges, points[edges] + away[:, None])

    def sharper(self, degrees: float) -> tuple[Segments, int]:
        """The centres' segments, and how many chains they make."""
        keep = self.angle > np.radians(degrees)
        return Segments(self.ends[keep, 0], self.ends[keep, 1]), chains(self.edges[keep])


@dataclass(frozen=True)
class HeightMap:
    """Heights (nx, ny) of the ball's centre above the pixels' middles; NaN where there is nothing below."""

    lower: np.ndarray
    heights: np.ndarray
    bend: np.ndarray  # second difference, mm, the largest of four directions
    way: np.ndarray

    @staticmethod
    def of(mesh: Mesh, radius: float) -> HeightMap:
        volume = Volume.from_mesh(mesh, PIXEL, "z")
        counts, spans = volume.intervals("z")
        last = np.cumsum(counts.ravel())
        top = np.full(counts.size, -np.inf)
        some = counts.ravel() > 0
        top[some] = spans[last[some] - 1, 1]
        top = top.reshape(counts.shape)
        n = int(radius / PIXEL)
        wide = np.pad(top, n, constant_values=-np.inf)
        heights = np.full(top.shape, -np.inf)
        for i in range(-n, n + 1):
            for j in range(-n, n + 1):
                square = radius**2 - PIXEL**2 * (i * i + j * j)
                if square >= 0:
                    shifted = wide[n + i : n + i + top.shape[0], n + j : n + j + top.shape[1]]
                    np.maximum(heights, shifted + np.sqrt(square), out=heights)
        heights[~np.isfinite(top)] = np.nan  # only above the part itself
        bends = np.full((len(WAYS), *top.shape), -np.inf)
        for k, (i, j) in enumerate(WAYS):
            before, after = shifted_by(heights, -i, -j), shifted_by(heights, i, j)
            bends[k] = (before + after - 2 * heights) / (i * i + j * j)  # for steps of one pixel
        bends = np.where(np.isnan(bends), -np.inf, bends)
        way = bends.argmax(0)
        return HeightMap(np.asarray(volume.lower), heights, bends.max(0), way)

    def bent(self, threshold: float) -> tuple[Segments, int]:
        """Ridges of the bend, a pixel wide, neighbours joined."""
        keep = self.bend > threshold
        crest = np.zeros_like(keep)
        for k, (i, j) in enumerate(WAYS):
            before, after = shifted_by(self.bend, -i, -j), shifted_by(self.bend, i, j)
            # One of two equal ones.
            crest |= keep & (self.way == k) & ~(self.bend < before) & ~(self.bend <= after)
        number = np.full(crest.shape, -1)
        number[crest] = np.arange(crest.sum())
        places = np.argwhere(crest)
        pixel = self.lower[:2] + (places + 0.5) * PIXEL
        points = np.concatenate([pixel, self.heights[crest][:, None]], 1)
        pairs = []
        filled = np.pad(crest, 1)
        for i, j in WAYS:
            other = np.nan_to_num(shifted_by(number.astype(float), i, j), nan=-1).astype(int)
            both = (number >= 0) & (other >= 0)
            if i and j:  # the two sides of a right angle say what its diagonal does
                both &= ~(shifted_by(filled, i, 0) | shifted_by(filled, 0, j))[1:-1, 1:-1]
            pairs.append(np.stack([number[both], other[both]], 1))
        edges = np.concatenate(pairs)
        return Segments(points[edges[:, 0]], points[edges[:, 1]]), chains(edges)


def shifted_by(values: np.ndarray, i: int, j: int) -> np.ndarray:
    """values[x + i, y + j]; NaN, or False, from beyond the border."""
    out = np.full(values.shape, np.nan if values.dtype == float else False)
    x, y = values.shape
    out[max(-i, 0) : x - max(i, 0), max(-j, 0) : y - max(j, 0)] = values[
        max(i, 0) : x + min(i, 0), max(j, 0) : y + min(j, 0)
    ]
    return out


def chains(edges: np.ndarray) -> int:
    """How many pieces hang together."""
    if not len(edges):
        return 0
    vertices, index = np.unique(edges, return_inverse=True)
    index = index.reshape(-1, 2)
    label = np.arange(len(vertices))
    while True:
        low = np.minimum(label[index[:, 0]], label[index[:, 1]])
        new = label.copy()
        np.minimum.at(new, index[:, 0], low)
        np.minimum.at(new, index[:, 1], low)
        new = new[new]
        if np.array_equal(new, label):
            return len(np.unique(label))
        label = new
