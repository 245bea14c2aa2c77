"""The viewpoint of a 3D view, as numbers: rays through its pixels, and pixels of points.

A view is the 4 × 4 matrix that maps points to clip space, and its size in pixels. With millimetres of a stock's frame
as the points' space, the pointer's path and a view define a stroke, in a window or not.
"""

from __future__ import annotations

import math

import numpy as np

from .stroke_path import View


def cross(a, b):
    """Cross product of two sequences of three or more floats: np.cross takes ten times as long."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


class ViewRays:
    """`matrix`: (4, 4) points → clip space, of Blender's perspective_matrix; `size`: pixels across and up."""

    def __init__(self, matrix, size):
        self.matrix = np.array(matrix, float).reshape(4, 4)
        self.size = float(size[0]), float(size[1])
        if not (np.isfinite(self.matrix).all() and abs(np.linalg.det(self.matrix)) > 0 and min(self.size) > 0):
            raise ValueError("view: the matrix must be finite and invertible, and the size positive")

    def ray(self, x: float, y: float) -> tuple[np.ndarray, np.ndarray]:
        """Origin on the near plane and unit direction away from the viewer.

        A pixel's ray is the intersection of two planes. The matrix's depth is not used for the direction, since the
        near and the far plane differ only in its last digits.
        """
        across, up, depth, weight = self.matrix.tolist()
        a, b = 2 * x / self.size[0] - 1, 2 * y / self.size[1] - 1
        first = [u - a * w for u, w in zip(across, weight, strict=True)]
        second = [v - b * w for v, w in zip(up, weight, strict=True)]
        near = [d + w for d, w in zip(depth, weight, strict=True)]
        along = cross(first, second)
        # The intersection of the three planes (Cramer's rule).
        beside, below = cross(second, near), cross(near, first)
        inverse = -1 / sum(n * c for n, c in zip(near[:3], along, strict=True))
        origin = [
            inverse * (first[3] * p + second[3] * q + near[3] * r) for p, q, r in zip(beside, below, along, strict=True)
        ]
        length = math.copysign(math.hypot(*along), sum(d * c for d, c in zip(depth[:3], along, strict=True)))
        return np.array(origin), np.array([c / length for c in along])

    def project(self, points) -> np.ndarray:
        """(n, 2) pixels of (n, 3) points; NaN behind the viewer."""
        clip = np.c_[np.asarray(points, float), np.ones(len(points))] @ self.matrix.T
        with np.errstate(divide="ignore", invalid="ignore"):
            pixels = (clip[:, :2] / clip[:, 3:] + 1) * 0.5 * self.size
        pixels[clip[:, 3] <= 0] = np.nan
        return pixels

    def basis(self) -> View:
        """Right, up and towards the viewer, in the middle of the view."""
        away = self.ray(0.5 * self.size[0], 0.5 * self.size[1])[1]
        right = self.matrix[0, :3] - (self.matrix[0, :3] @ away) * away
        right /= np.linalg.norm(right)
        up = self.matrix[1, :3] - (self.matrix[1, :3] @ away) * away
        up -= (up @ right) * right
        return View(right, up / np.linalg.norm(up), -away)

    def pixels_per_unit(self, point) -> float:
        """At a point, perpendicular to the view."""
        away = self.ray(0.5 * self.size[0], 0.5 * self.size[1])[1]
        across = self.matrix[0, :3] - (self.matrix[0, :3] @ away) * away
        weight = self.matrix[3] @ np.append(point, 1.0)
        return float(np.linalg.norm(across) * 0.5 * self.size[0] / max(abs(weight), 1e-12))
