"""Strokes as curves: splines fitted to the poses of a stroke, and the poses of a spline that was edited.

A curve has the places of the tool's tip. The tool's axes are kept apart, at equal shares of its length: they stay
with these shares when control points are moved, added or removed.
"""

from __future__ import annotations

import json
from typing import NamedTuple

import numpy as np
import riffler

from ...common import hand_tools, json_object, poses, splines
from ...common.splines import Spline
from . import symmetry
from .roll import STRING, Roll, lowest
from .stroke_path import Piece

ORDER = 4
STEPS = 4  # of a fit with one number of control points
HOPELESS = 30.0  # tolerances: such a distance needs more control points
MOST_AXES = 65  # of one spline


class Chain(NamedTuple):
    """A path that is carved in one call."""

    tool: dict
    poses: np.ndarray  # (n, 6), or (n, 9) of a hand tool
    mode: str  # "remove" or "add"


class Stroke(NamedTuple):
    """What a curve does not show. Texts are JSON."""

    tool: dict
    mode: str = "remove"
    hand: bool = False
    depth: float = 0.0  # mm of the tip below the curve
    lean: float = 0.0  # rad, of hand tools
    turn: float = 0.0
    heading: tuple = ()  # where the blade of a click points
    axes: tuple = ()  # of each spline, (k, 3) unit vectors at equal shares of its length; () for z
    maps: tuple = ()  # (3, 3) symmetric copies about `centre`; () for none
    centre: tuple = (0.0, 0.0, 0.0)

    def text(self) -> str:
        return json.dumps(
            {
                **self._asdict(),
                "axes": [np.round(a, 7).tolist() for a in self.axes],
                "maps": [np.asarray(m).tolist() for m in self.maps],
                "centre": np.asarray(self.centre, float).tolist(),
                "heading": np.asarray(self.heading, float).tolist(),
            }
        )

    @classmethod
    def of_text(cls, text: str) -> Stroke:
        """ValueError if the text is damaged."""
        data = json_object.loads(text, "the stroke")
        try:
            axes = tuple(np.asarray(a, float).reshape(-1, 3) for a in data["axes"])
            maps = tuple(np.asarray(m, float).reshape(3, 3) for m in data["maps"])
            vectors = {name: tuple(map(float, data[name])) for name in ("centre", "heading")}
            return cls(**{**data, "axes": axes, "maps": maps, **vectors})
        except (KeyError, TypeError, ValueError) as error:
            raise ValueError(f"the stroke's data is damaged: {error}") from error


# ---------------------------------------------------------------------- poses → curve
def fit(points: np.ndarray, tolerance: float) -> tuple[Spline, float]:
    """A clamped cubic B-spline within `tolerance` (mm) of a polyline's corners (n, 3), and a bound of the distance of
    each of them from it. The number of control points grows by two fifths until it fits; where that takes as many
    points as the polyline has, the curve is the polyline."""
    points = points[splines.distinct(points)]
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    count = ORDER
    while count < len(points):
        control, error = _fitted(points, way, count, tolerance)
        if error <= tolerance:
            return Spline("NURBS", control, weights=np.ones(count), order=ORDER, endpoint=True), error
        count = max(count + 1, int(1.4 * count))
    return Spline("POLY", points), 0.0


def _fitted(points, way, count, tolerance):
    """Least squares with both ends held. The parameters are shares of the length, improved by Newton's steps towards
    the nearest places. Returns (count, 3), and the largest distance at these parameters."""
    knot = splines.knots(count, ORDER, False, True, False)
    last = float(knot[count])
    u = way / way[-1] * last
    h = 1e-4 * last
    for turn in range(STEPS):
        b = splines.basis(u, knot, ORDER)[:, :count]
        inner, *_ = np.linalg.lstsq(b[1:-1, 1:-1], (points - b[:, [0, -1]] @ points[[0, -1]])[1:-1], rcond=None)
        control = np.vstack([points[:1], inner, points[-1:]])
        off = points - b @ control
        error = float(np.linalg.norm(off, axis=1).max())
        if error <= tolerance or error > HOPELESS * tolerance or turn == STEPS - 1:
            break
        low, high = np.maximum(u - h, 0.0), np.minimum(u + h, last)
        slope = (splines.basis(high, knot, ORDER) - splines.basis(low, knot, ORDER))[:, :count] @ control
        slope /= (high - low)[:, None]
        step = (off * slope).sum(axis=1) / np.maximum((slope * slope).sum(axis=1), 1e-300)
        u[1:-1] = np.maximum.accumulate(np.clip(u + step, 0.0, last))[1:-1]
    return control, error


def sampled_axes(path: np.ndarray) -> np.ndarray:
    """(k, 3): the axes of poses (n, 6) at equal shares of their length; one row if they are all the same."""
    if np.ptp(path[:, 3:6], axis=0).max() < 1e-9:
        return path[:1, 3:6]
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(path[:, :3], axis=0), axis=1))])
    at = np.linspace(0, way[-1], min(MOST_AXES, max(2, len(path))))
    return poses.unit(np.stack([np.interp(at, way, path[:, k]) for k in (3, 4, 5)], axis=1))


# ---------------------------------------------------------------------- curve → poses
def chains(stroke: Stroke, curve: list[Spline], pitch: float, tolerance: float) -> list[Chain]:
    """What a curve's splines (mm) carve, with symmetric copies. ValueError if no spline has two places."""
    tool = riffler.Tool.from_dict(stroke.tool)
    paths = []
    for k, spline in enumerate(curve):
        points, tilt = splines.evaluate(spline, tolerance)
        if len(points) > 1:
            paths += _paths(stroke, tool, points, tilt, k, pitch)
    if not paths:
        raise ValueError("its curve has no spline with two points: add points, or remove the stroke from the list")
    image = hand_tools.mirrored(tool) if stroke.hand else tool
    made = []
    for path in paths:
        for copy, mirrors in symmetry.copies(path, list(stroke.maps) or [np.eye(3)], stroke.centre, image is tool):
            made.append(Chain((image if mirrors else tool).to_dict(), copy, stroke.mode))
    return made


def _paths(stroke, tool, points, tilt, k, pitch) -> list[np.ndarray]:
    axes = stroke.axes[min(k, len(stroke.axes) - 1)] if stroke.axes else poses.UP[None]
    if len(axes) > 1:  # they turn between the points, too
        points, tilt = splines.refine(points, tilt, max(splines.length(points) / (2 * len(axes)), pitch))
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    at = way / way[-1] * (len(axes) - 1)
    here = poses.unit(np.stack([np.interp(at, np.arange(len(axes)), axes[:, j]) for j in range(3)], axis=1))
    if tilt.any():  # turns the axis about the curve
        t = poses.tangents(points)
        c, s = np.cos(tilt)[:, None], np.sin(tilt)[:, None]
        here = poses.unit(here * c + np.cross(t, here) * s + t * (t * here).sum(axis=1)[:, None] * (1 - c))
    path = poses.make_poses(points, here, stroke.depth)
    if not stroke.hand:
        return [path]
    string = max(pitch, tool.diameter * STRING)
    heading = np.array(stroke.heading) if stroke.heading else points[-1] - points[0]
    roll = Roll(string, heading, stroke.lean, stroke.turn, lowest(tool.hulls, stroke.lean))
    fine, tilt = splines.refine(path[:, :3], tilt, string)
    path = np.hstack([fine, _between(path, fine)])
    pieces = roll.add(Piece(path, np.ones(len(path) - 1), True)) + roll.end()
    return [piece.poses for piece in pieces]


def _between(path, fine):
    """Axes of the refined places of a path: (m, 3)."""
    way, there = (
        np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(p[:, :3], axis=0), axis=1))]) for p in (path, fine)
    )
    return poses.unit(np.stack([np.interp(there, way, path[:, k]) for k in (3, 4, 5)], axis=1))
