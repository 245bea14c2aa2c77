"""Tool poses along a polyline: rows (tip xyz, unit axis xyz), the axis from the tip to the spindle."""

from __future__ import annotations

import numpy as np

UP = np.array([0.0, 0.0, 1.0])


def unit(v: np.ndarray) -> np.ndarray:
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def fixed_axes(count: int, axis=UP) -> np.ndarray:
    return np.tile(unit(np.asarray(axis, float)), (count, 1))


def tangents(points: np.ndarray) -> np.ndarray:
    """Unit tangents of a polyline of distinct points: at a corner the mean of both directions. A polyline that ends at
    its start is closed."""
    d = unit(np.diff(points, axis=0))
    closed = len(points) > 3 and np.array_equal(points[0], points[-1])
    before = np.vstack([d[-1:] if closed else d[:1], d])
    after = np.vstack([d, d[:1] if closed else d[-1:]])
    mean = before + after
    # a reversal: either direction is right
    turn = np.linalg.norm(mean, axis=1) < 1e-9
    mean[turn] = after[turn]
    return unit(mean)


def tilted_axes(points: np.ndarray, tilt: np.ndarray) -> np.ndarray:
    """Axes perpendicular to the path: +Z of the stock projected perpendicular to the tangent, then turned about the
    tangent by `tilt` (right hand). Where the path itself is vertical, the previous axis is kept."""
    t = tangents(points)
    axes = np.empty_like(t)
    # A vertical start uses the next direction that is not vertical, or +X.
    level = np.nonzero(np.abs(t[:, 2]) < 1 - 1e-6)[0]
    last = _square(UP, t[level[0]]) if len(level) else np.array([1.0, 0.0, 0.0])
    for k in range(len(t)):
        base = _square(UP if abs(t[k, 2]) < 1 - 1e-6 else last, t[k])
        if base is None:
            base = _square(np.array([1.0, 0.0, 0.0]), t[k])
        axes[k] = last = base
    c, s = np.cos(tilt)[:, None], np.sin(tilt)[:, None]
    return unit(axes * c + np.cross(t, axes) * s)


def _square(v, t):
    out = v - np.dot(v, t) * t
    size = np.linalg.norm(out)
    return out / size if size > 1e-9 else None


def smooth_axes(points: np.ndarray, axes: np.ndarray, window: float) -> np.ndarray:
    """Mean of the axes over `window` (mm of path) around each point, by the trapezoidal rule on the running integral,
    so unevenly spaced points have the right weights. A closed path is averaged across its seam."""
    if len(points) < 3 or window <= 0:
        return axes
    chord = np.linalg.norm(np.diff(points, axis=0), axis=1)
    s = np.concatenate([[0], np.cumsum(chord)])
    total, half = s[-1], 0.5 * min(window, s[-1])
    integral = np.vstack([np.zeros(3), np.cumsum(0.5 * (axes[1:] + axes[:-1]) * chord[:, None], axis=0)])
    closed = np.array_equal(points[0], points[-1])

    def at(x):
        turns = np.floor(x / total) if closed else np.zeros_like(x)
        inside = np.clip(x - turns * total, 0, total)
        k = np.clip(np.searchsorted(s, inside, side="right") - 1, 0, len(chord) - 1)
        r = ((inside - s[k]) / chord[k])[:, None]
        mean = axes[k] + 0.5 * r * (axes[k + 1] - axes[k])
        return integral[k] + mean * r * chord[k][:, None] + turns[:, None] * integral[-1]

    lower, upper = s - half, s + half
    if not closed:
        lower, upper = np.maximum(lower, 0), np.minimum(upper, total)
    mean = at(upper) - at(lower)
    size = np.linalg.norm(mean, axis=1)
    weak = size < 1e-6 * half
    mean[weak], size[weak] = axes[weak], 1.0
    return mean / size[:, None]


def make_poses(points: np.ndarray, axes: np.ndarray, depth: float = 0.0) -> np.ndarray:
    """Tips `depth` below the points, against the axis. carve refuses successive rows with opposite axes."""
    if not np.isfinite(depth):
        raise ValueError("depth must be finite")
    return np.ascontiguousarray(np.hstack([points - depth * axes, unit(axes)]))


def transform_points(matrix: np.ndarray, points: np.ndarray) -> np.ndarray:
    """4 × 4 affine `matrix` on (n, 3) points."""
    return points @ matrix[:3, :3].T + matrix[:3, 3]


def moving(poses, dt=None):
    """The poses, (n, 6), and the times of their moves, without poses equal to the one before: a journal does not count
    them as moves. If none moves, the first two are one move: the tool cuts in place."""
    stands = (poses[1:] == poses[:-1]).all(axis=1)
    if not stands.any():
        return poses, dt
    kept = np.r_[True, ~stands]
    if stands.all():
        kept[1] = True
    return poses[kept], None if dt is None else np.asarray(dt)[kept[1:]]
