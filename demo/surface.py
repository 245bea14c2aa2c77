"""A figure's surface to lay strokes on: a triangle mesh in numpy with smooth normals and ray casting."""

from __future__ import annotations

from pathlib import Path

import numpy as np

STL_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def unit(vectors: np.ndarray) -> np.ndarray:
    """Rows scaled to length 1."""
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def read_stl(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (n, 3) welded by equality and triangles (k, 3) of a binary STL."""
    rows = np.frombuffer(path.read_bytes(), STL_TRIANGLE, offset=84)
    vertices, indices = np.unique(rows["corners"].reshape(-1, 3), axis=0, return_inverse=True)
    return vertices.astype(np.float64), indices.reshape(-1, 3)


class Surface:
    """Triangles with normals that vary smoothly over them (area-weighted means at the vertices)."""

    def __init__(self, vertices: np.ndarray, triangles: np.ndarray) -> None:
        self.corners = vertices[triangles]
        facets = np.cross(self.corners[:, 1] - self.corners[:, 0], self.corners[:, 2] - self.corners[:, 0])
        at_vertices = np.zeros_like(vertices)
        for corner in range(3):
            np.add.at(at_vertices, triangles[:, corner], facets)
        self.normals = unit(at_vertices)[triangles]
        self.facets = facets
        self.middles = self.corners.mean(axis=1)
        self.reach = np.linalg.norm(self.corners - self.middles[:, None], axis=2).max(axis=1)

    @classmethod
    def read(cls, path: Path) -> Surface:
        return cls(*read_stl(path))

    def outermost(self, origins: np.ndarray, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Point and smooth normal (n, 3) where each ray leaves the figure for the last time; NaN where it misses.

        Neighbouring rays are cast together against the few triangles near them.
        """
        points, normals = np.full_like(origins, np.nan), np.full_like(origins, np.nan)
        for start in range(0, len(origins), 24):
            rays = slice(start, start + 24)
            near = self._near(origins[rays], directions[rays])
            if len(near):
                points[rays], normals[rays] = self._cast(origins[rays], directions[rays], near)
        return points, normals

    def _near(self, origins: np.ndarray, directions: np.ndarray) -> np.ndarray:
        """Indices of triangles that a bundle of rays can meet: those within its spread of the middle ray."""
        origin, direction = origins.mean(axis=0), unit(directions.mean(axis=0))
        offsets = self.middles - origin
        along = offsets @ direction
        farthest = np.abs(along).max() + 1.0
        spread = np.linalg.norm(origins - origin, axis=1) + farthest * np.linalg.norm(directions - direction, axis=1)
        aside = np.linalg.norm(offsets - along[:, None] * direction, axis=1)
        return np.flatnonzero(aside <= self.reach + spread.max())

    def _cast(self, origins: np.ndarray, directions: np.ndarray, near: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Möller and Trumbore, Fast, minimum storage ray/triangle intersection (1997), all rays by all triangles."""
        a, b, c = (self.corners[near, corner] for corner in range(3))
        side_1, side_2 = b - a, c - a
        p = np.cross(directions[:, None], side_2[None])
        determinant = np.einsum("nkj,kj->nk", p, side_1)
        with np.errstate(divide="ignore", invalid="ignore"):
            t = origins[:, None] - a[None]
            u = np.einsum("nkj,nkj->nk", t, p) / determinant
            q = np.cross(t, side_1[None])
            v = np.einsum("nj,nkj->nk", directions, q) / determinant
            distance = np.einsum("nkj,kj->nk", q, side_2) / determinant
        slack = 1e-9
        leaving = np.einsum("nj,kj->nk", directions, self.facets[near]) > 0.0
        hit = leaving & (u >= -slack) & (v >= -slack) & (u + v <= 1.0 + slack) & (distance > 0.0)
        distance = np.where(hit, distance, -np.inf)
        best = distance.argmax(axis=1)
        ray = np.arange(len(origins))
        found = hit[ray, best]
        at, u, v = np.where(found, distance[ray, best], 0.0), u[ray, best], v[ray, best]
        weights = np.stack([1.0 - u - v, u, v], axis=1)
        points, normals = np.full_like(origins, np.nan), np.full_like(origins, np.nan)
        points[found] = (origins + at[:, None] * directions)[found]
        normals[found] = unit(np.einsum("nc,ncj->nj", weights, self.normals[near[best]]))[found]
        return points, normals
