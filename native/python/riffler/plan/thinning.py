"""Thins a motion to fewer points and keys, within a tolerance of its places and within an angle of its axes.

The recorded motion is compared with the thinned one place by place, in order. Each recorded row has a station on the
thinned line, a polyline through some of the rows' points, and the axis there turns along great circles from key to key
in proportion to arc length, as `PencilPath.orient` does with the rule "slerp". Both errors are bounds for the whole
motion, not samples of it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# The tolerance is divided among: the distance of the points from the line; the shift along the line, which gives a tool
# that turns in one place room to turn; the arc that a point above the tip makes between two rows.
APART, SHIFT, ARC = 0.65, 0.25, 0.05
STEP = 0.05  # rad: a turn between two rows is divided into steps of this size
WIDE = 3.0  # rad: keys further apart get one between them, because opposite axes have no unique great circle
BLOCK = 512  # rows searched together for the next turn


class StandsStillError(ValueError):
    """The motion stays in one place."""


@dataclass(frozen=True, eq=False)
class Thinned:
    """A thinned motion. ``keys``: rows of ``points`` whose axes are the recorded ones. ``error``, ``turn``: bounds, mm
    and rad."""

    points: Array  # (m, 3)
    axes: Array  # (m, 3)
    keys: list[int]
    error: float
    turn: float


def thin(tips: Array, axes: Array, above: float, tolerance: float, angle: float) -> Thinned:
    """Thins the motion of the point ``above`` mm above the tip, on the axis. Between two rows the tip moves straight
    and the axis on the great circle. StandsStillError for a point that stays within ``tolerance`` of its first place.
    """
    tips, axes, arcs = _refined(tips, axes, above, ARC * tolerance, min(STEP, angle / 2))
    points = tips + above * axes
    if np.linalg.norm(points - points[0], axis=1).max() <= tolerance:
        raise StandsStillError(f"it stands still: no place is more than {tolerance:g} mm from the first")
    rows, stations = _line(points, APART * tolerance)
    corners = points[rows]
    at = stations[rows]
    shifted = _shifted(stations, axes, SHIFT * tolerance, tolerance, angle)
    knots, points, axes, is_corner, arcs = _with_corners(shifted, points, axes, arcs, at)
    keys, turn = _keys(knots, axes, is_corner, angle, 0.1 * tolerance)
    on_line = np.column_stack([np.interp(knots, at, corners[:, k]) for k in range(3)])
    apart = np.linalg.norm(points - on_line, axis=1)
    error = float(np.max(np.maximum(apart[:-1], apart[1:]) + arcs))
    kept = np.flatnonzero(is_corner | np.isin(np.arange(len(knots)), keys))
    made = _interpolated(knots[keys], axes[keys], knots[kept])
    return Thinned(on_line[kept], made, np.searchsorted(kept, keys).tolist(), error, turn)


def between(a: Array, b: Array) -> Array:
    """Angles between unit vectors, rad, precise for small ones."""
    return 2 * np.arctan2(np.linalg.norm(a - b, axis=-1), np.linalg.norm(a + b, axis=-1))


def slerp(a: Array, b: Array, share: Array) -> Array:
    """Unit vectors at ``share`` of the great circle from ``a`` to ``b``, row by row."""
    turn = between(a, b)[..., None]
    share = np.asarray(share)[..., None]
    sine = np.sin(turn)
    small = sine < 1e-9
    safe = np.where(small, 1.0, sine)
    first = np.where(small, 1 - share, np.sin((1 - share) * turn) / safe)
    last = np.where(small, share, np.sin(share * turn) / safe)
    out = first * a + last * b
    return out / np.linalg.norm(out, axis=-1, keepdims=True)


def _refined(tips: Array, axes: Array, above: float, arc: float, step: float) -> tuple[Array, Array, Array]:
    """The rows without repeated ones and with each turn divided; for each move, the distance between arc and chord of
    the point ``above`` the tip."""
    moves = np.any(np.diff(tips, axis=0) != 0, axis=1) | np.any(np.diff(axes, axis=0) != 0, axis=1)
    keep = np.concatenate([[True], moves])
    tips, axes = tips[keep], axes[keep]
    turns = between(axes[:-1], axes[1:])
    flat = 2 * math.acos(max(0.0, 1 - arc / above)) if above > 0 else math.inf  # turn whose arc is `arc` high
    parts = np.maximum(1, np.ceil(turns / min(step, flat))).astype(int)
    if not len(parts):
        return tips, axes, np.zeros(0)
    of = np.repeat(np.arange(len(parts)), parts)
    ends = np.cumsum(parts)
    share = (np.arange(len(of)) - np.repeat(ends - parts, parts) + 1) / parts[of]
    more_tips = tips[of] + share[:, None] * (tips[of + 1] - tips[of])
    more_axes = slerp(axes[of], axes[of + 1], share)
    more_tips[ends - 1], more_axes[ends - 1] = tips[1:], axes[1:]
    arcs = above * (1 - np.cos(0.5 * (turns / parts)[of]))
    return np.vstack([tips[:1], more_tips]), np.vstack([axes[:1], more_axes]), arcs


def _line(points: Array, tolerance: float) -> tuple[list[int], Array]:
    """Rows of the corners of a line that passes near all points, and for each row its station on that line: the foot of
    its point, but never behind that of a row before it (after Douglas and Peucker 1973)."""
    corners, feet = [0], np.zeros(len(points))
    todo = [(0, len(points) - 1)]
    while todo:
        first, last = todo.pop()
        way = points[last] - points[first]
        length = float(np.linalg.norm(way))
        towards = points[first : last + 1] - points[first]
        unit = way / length if length > 0 else way
        foot = np.clip(np.maximum.accumulate(towards @ unit), 0.0, length)
        foot[-1] = length
        apart = np.linalg.norm(towards - foot[:, None] * unit, axis=1)
        worst = int(apart.argmax())
        if apart[worst] > tolerance and 0 < worst < last - first:
            todo += [(first + worst, last), (first, first + worst)]
            continue
        feet[first : last + 1] = foot + feet[first]
        if length > 0:
            corners.append(last)
    return corners, feet


def _shifted(stations: Array, axes: Array, most: float, tolerance: float, angle: float) -> Array:
    """Stations shifted by at most ``most`` mm, so that rows between which the tool turns are apart: by as many mm for
    each rad as this allows. First and last station stay."""
    turned = _turned(axes, angle / 4)
    steps, way = np.diff(turned, prepend=turned[0]), np.diff(stations, prepend=stations[0])
    room = tolerance / angle  # mm for each rad
    while True:
        sums = np.cumsum(room * steps - way)
        late = sums - np.minimum.accumulate(np.minimum(sums, 0.0))  # mm by which a row is behind its turn
        latest = stations[-1] - room * (turned[-1] - turned)
        out = np.minimum(stations + late, latest)
        if latest[0] >= 0 and np.abs(out - stations).max() <= most:
            return out
        room /= 2


def _turned(axes: Array, least: float) -> Array:
    """Angle that the axis has turned up to each row, rad. A tremor of less than ``least`` does not count."""
    out, at, limit = np.zeros(len(axes)), 0, 2 * math.sin(least / 2)
    while at + 1 < len(axes):
        for begin in range(at + 1, len(axes), BLOCK):
            far = np.linalg.norm(axes[begin : begin + BLOCK] - axes[at], axis=1) > limit
            if far.any():
                break
        else:
            break
        to = begin + int(far.argmax())
        out[to] = between(axes[at], axes[to])
        at = to
    return np.cumsum(out)


def _with_corners(shifted: Array, points: Array, axes: Array, arcs: Array, at: Array):
    """The motion with a row at each corner of the line: (stations, points, axes, whether it is a corner, arcs)."""
    exact = np.isin(at, shifted)
    new = at[~exact]
    right = np.clip(np.searchsorted(shifted, new), 1, len(shifted) - 1)
    left = right - 1
    share = (new - shifted[left]) / (shifted[right] - shifted[left])
    more_points = points[left] + share[:, None] * (points[right] - points[left])
    stations = np.concatenate([shifted, new])
    order = np.argsort(stations, kind="stable")
    moves = np.concatenate([arcs, arcs[-1:], arcs[left]])[order][:-1]
    is_corner = np.concatenate([np.zeros(len(shifted), bool), np.ones(len(new), bool)])
    is_corner[np.searchsorted(shifted, at[exact][:-1])] = True
    is_corner[len(shifted) - 1] = True  # the last row, not the first one at the end of the line
    return (
        stations[order],
        np.vstack([points, more_points])[order],
        np.vstack([axes, slerp(axes[left], axes[right], share)])[order],
        is_corner[order],
        moves,
    )


def _keys(knots: Array, axes: Array, is_corner: Array, angle: float, near: float) -> tuple[list[int], float]:
    """Rows whose axes are keys, and the bound of the angle. A key is set where the axis is furthest from the axis that
    its neighbours give, or at a corner of the line within ``near`` mm of that place."""
    last = len(knots) - 1
    todo, keys, worst_bound = [(0, last)], {0, last}, 0.0
    corners = np.flatnonzero(is_corner)
    while todo:
        first, end = todo.pop()
        if between(axes[first], axes[end]) > WIDE:
            inner = axes[first + 1 : end]
            worst = first + 1 + int(np.minimum(between(inner, axes[first]), between(inner, axes[end])).argmax())
        else:
            off, bounds = _off(knots, axes, first, end)
            k = int(bounds.argmax())
            if bounds[k] <= angle:
                worst_bound = max(worst_bound, float(bounds[k]))
                continue
            worst = first + k + int(off[k + 1] > off[k])
            if not knots[first] < knots[worst] < knots[end]:
                worst = first + _inside(knots[first : end + 1], off)
                if worst == first:  # every row further off is at the station of a key
                    worst_bound = max(worst_bound, float(bounds[k]))
                    continue
            worst = _snapped(worst, first, end, knots, corners, near)
        keys.add(worst)
        todo += [(worst, end), (first, worst)]
    return sorted(keys), worst_bound


def _off(knots: Array, axes: Array, first: int, end: int) -> tuple[Array, Array]:
    """Angles between the motion's axes and the axes that two keys give, and a bound of them for each interval.

    The distance of two points on great circles, each at a constant speed, is at most the larger one at both ends over
    cos(ω/2), where ω is the larger turn over the cosine of half the distance (Rauch's comparison on the unit sphere).
    """
    length = knots[end] - knots[first]
    share = (knots[first : end + 1] - knots[first]) / length if length > 0 else np.linspace(0, 1, end - first + 1)
    made = slerp(axes[first], axes[end], share)
    own = axes[first : end + 1]
    off = between(own, made)
    off[0] = off[-1] = 0.0
    most = np.maximum(off[:-1], off[1:])
    turns = np.maximum(between(own[:-1], own[1:]), between(made[:-1], made[1:]))
    return off, most / np.cos(np.minimum(0.5 * turns / np.cos(most / 2), 1.5))


def _inside(knots: Array, off: Array) -> int:
    """The row furthest off among those between first and last station; 0 if there is none."""
    inside = (knots > knots[0]) & (knots < knots[-1])
    return int(np.where(inside, off, -1.0).argmax()) if inside.any() else 0


def _snapped(worst: int, first: int, end: int, knots: Array, corners: NDArray[np.intp], near: float) -> int:
    k = int(np.searchsorted(knots[corners], knots[worst]))
    for corner in corners[max(0, k - 1) : k + 1].tolist():
        inside = first < corner < end and knots[first] < knots[corner] < knots[end]
        if inside and abs(knots[corner] - knots[worst]) <= near:
            return corner
    return worst


def _interpolated(places: Array, keys: Array, at: Array) -> Array:
    """Axes at the stations ``at``, interpolated between keys at the stations ``places``."""
    k = np.clip(np.searchsorted(places, at, side="right") - 1, 0, len(places) - 2)
    length = places[k + 1] - places[k]
    share = np.where(length > 0, (at - places[k]) / np.where(length > 0, length, 1.0), 0.0)
    return slerp(keys[k], keys[k + 1], np.clip(share, 0.0, 1.0))
