"""Modelling by strokes, as a hand does it: balls and limbs put on, surfaces smoothed, lines drawn into them."""

from __future__ import annotations

import numpy as np
import riffler

UP, DOWN = (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)


def limb(clay: riffler.Volume, points, radii, *, mode: str = "add", step: float = 0.4) -> None:
    """A round limb along a polyline (n, 3), as thick as `radii` (n,) say, put on or taken away.

    A ball end's cutting part ends at its equator, so each place is met twice, once from above and once from below.
    """
    points, radii = np.atleast_2d(np.asarray(points, float)), np.atleast_1d(np.asarray(radii, float))
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    at = np.linspace(0.0, way[-1], int(way[-1] / step) + 2)
    centres = np.column_stack([np.interp(at, way, column) for column in points.T])
    thick = np.interp(at, way, radii)
    for k in range(len(at) - 1):
        radius = 0.5 * (thick[k] + thick[k + 1])
        tool = riffler.Tool.ball(2 * radius, radius)
        for axis in (UP, DOWN):
            tips = centres[k : k + 2] - radius * np.array(axis)
            clay.carve(tool, np.hstack([tips, np.tile(axis, (2, 1))]), mode=mode)


def mirrored(points) -> np.ndarray:
    """The same on the other side of the plane x = 0."""
    return np.asarray(points, float) * [-1.0, 1.0, 1.0]


def smooth(clay: riffler.Volume, *, radius: float, passes: int, within=None) -> None:
    """Goes over the whole surface with a soft brush, or over what is `within` (a function of (n, 3) points)."""
    for _ in range(passes):
        places = clay.to_mesh().vertices
        if within is not None:
            places = places[within(places)]
        cells = np.unique(np.floor(places / (0.8 * radius)), axis=0, return_index=True)[1]
        clay.smooth(places[np.sort(cells)], radius, strength=1.0)


class Sketcher:
    """Draws lines into a surface as it was when the sketch began."""

    def __init__(self, clay: riffler.Volume) -> None:
        self.clay = clay
        self.surface = riffler.Mesher(clay.copy())

    def line(self, points, direction, tool: riffler.Tool, depth: float, *, glide: float = 1.5) -> np.ndarray:
        """A line through points (n, 3) from where the surface is seen along `direction` (one or one a point), `depth`
        mm deep, rising to the surface over `glide` mm at its ends. Gives the poses (k, 6); none where it is missed."""
        points = np.asarray(points, float)
        rays = np.ascontiguousarray(np.broadcast_to(np.asarray(direction, float), points.shape))
        _, at, normals, brick = self.surface.pick(points, rays)
        if len(points) < 4 or (brick < 0).any():
            return np.zeros((0, 6))
        kernel = np.ones(5) / 5
        padded = np.pad(normals, ((2, 2), (0, 0)), mode="edge")
        normals = np.column_stack([np.convolve(column, kernel, mode="valid") for column in padded.T])
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(at, axis=0), axis=1))])
        edge = np.clip(np.minimum(way, way[-1] - way) / max(glide, 1e-9), 0.0, 1.0)
        deep = depth * edge * edge * (3.0 - 2.0 * edge) - 0.05
        poses = np.hstack([at - deep[:, None] * normals, normals])
        self.clay.carve(tool, poses)
        return poses
