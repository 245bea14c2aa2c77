"""Bézier, NURBS and poly splines as polylines within a tolerance.

Control points are in millimetres in the stock's frame: both kinds of curve are invariant under affine maps, so the
tolerance is a distance on the stock, independent of the objects' transforms.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

# Maximal number of points of one spline, so that a tolerance that is far too fine ends in a message, not in swapping.
MAX_POINTS = 2_000_000


@dataclass
class Spline:
    """One spline of a curve object. `left` and `right` are the Bézier handles, `order` and the flags are NURBS only."""

    kind: str  # "BEZIER", "NURBS", "POLY"
    points: np.ndarray  # (n, 3) mm
    cyclic: bool = False
    tilt: np.ndarray = field(default_factory=lambda: np.zeros(0))  # (n,) rad; empty = 0
    left: np.ndarray | None = None  # (n, 3)
    right: np.ndarray | None = None  # (n, 3)
    weights: np.ndarray | None = None  # (n,)
    order: int = 4
    endpoint: bool = False
    bezier: bool = False


def evaluate(spline: Spline, tolerance: float) -> tuple[np.ndarray, np.ndarray]:
    """Points (m, 3) whose polyline lies within `tolerance` (mm) of the curve, and the tilt (m,) at each. A cyclic
    spline ends at its start. Coincident points are merged."""
    if not (np.isfinite(tolerance) and tolerance > 0):
        raise ValueError(f"tolerance must be positive, not {tolerance}")
    points = np.ascontiguousarray(spline.points, float).reshape(-1, 3)
    tilt = np.zeros(len(points)) if len(spline.tilt) == 0 else np.asarray(spline.tilt, float)
    if not np.isfinite(points).all() or not np.isfinite(tilt).all():
        raise ValueError("the curve has a point that is not finite")
    if len(points) == 0:
        return points, tilt
    if spline.kind == "BEZIER":
        points, tilt = _bezier(spline, points, tilt, tolerance)
    elif spline.kind == "NURBS":
        points, tilt = _nurbs(spline, points, tilt, tolerance)
    elif spline.kind == "POLY":
        points, tilt = _poly(spline, points, tilt)
    else:
        raise ValueError(f"a spline of type {spline.kind} cannot be cut along")
    keep = distinct(points)
    return points[keep], tilt[keep]


def distinct(points: np.ndarray) -> np.ndarray:
    """(n,) bool: points that differ from the one before (by more than 1e-9 mm)."""
    keep = np.ones(len(points), bool)
    keep[1:] = np.linalg.norm(np.diff(points, axis=0), axis=1) > 1e-9
    return keep


def _poly(spline, p, tilt):
    if spline.cyclic and len(p) > 2:
        return np.vstack([p, p[:1]]), np.append(tilt, tilt[0])
    return p, tilt


def _bezier(spline, p, tilt, tolerance):
    """Uniform steps per segment: the chord of a piece of 1/n is off by at most max|B''| / (8 n²), and B'' is linear, so
    its maximum stands at one of the ends: 6 |P0 − 2 P1 + P2| or 6 |P1 − 2 P2 + P3|."""
    n = len(p)
    left = np.asarray(spline.left, float).reshape(-1, 3)
    right = np.asarray(spline.right, float).reshape(-1, 3)
    out, out_tilt = [p[:1]], [tilt[:1]]
    for i in range(n if spline.cyclic and n > 1 else n - 1):
        j = (i + 1) % n
        b = np.stack([p[i], right[i], left[j], p[j]])
        bend = 6 * max(np.linalg.norm(b[0] - 2 * b[1] + b[2]), np.linalg.norm(b[1] - 2 * b[2] + b[3]))
        steps = max(1, int(np.ceil(np.sqrt(bend / (8 * tolerance)))), int(np.ceil(abs(tilt[j] - tilt[i]) / 0.1)))
        if steps > MAX_POINTS:
            raise ValueError(
                f"tolerance {tolerance} mm needs more than {MAX_POINTS} points on one segment of the curve"
            )
        t = np.arange(1, steps + 1)[:, None] / steps
        s = 1 - t
        out.append(s**3 * b[0] + 3 * s**2 * t * b[1] + 3 * s * t**2 * b[2] + t**3 * b[3])
        out[-1][-1] = p[j]
        out_tilt.append(tilt[i] + (tilt[j] - tilt[i]) * t[:, 0])
    return np.vstack(out), np.concatenate(out_tilt)


def knots(count: int, order: int, cyclic: bool, endpoint: bool, bezier: bool) -> np.ndarray:
    """The knot vector of a Blender NURBS spline with `count` points (periodic part included): uniform; clamped
    (`endpoint`); inner multiplicity order − 1 (`bezier`)."""
    inner = order - 1 if bezier else 1
    free = min(2, inner) if bezier else 1
    head = order - int(cyclic) if endpoint else free
    total = count + (2 * order - 1 if cyclic else order)
    tail = 2 * order - 1 if cyclic else (order if endpoint else 0)
    out = np.zeros(total)
    current, left, first = 0.0, head, 0
    if endpoint and cyclic:
        current, first = 1.0, 1
    for i in range(first, total - tail):
        out[i] = current
        left -= 1
        if left == 0:
            current, left = current + 1.0, inner
    start = total - tail
    out[start:] = current + (out[:tail] - out[0])
    return out


def basis(u: np.ndarray, knot: np.ndarray, order: int) -> np.ndarray:
    """B-spline basis functions at `u` by the Cox–de Boor recursion (Piegl & Tiller, The NURBS Book, eq. 2.5): (len(u),
    len(knot) − order). The last knot belongs to the last non-empty span."""
    wide = len(knot) - 1
    n = np.zeros((len(u), wide))
    span = np.searchsorted(knot, u, side="right") - 1
    last = int(np.max(np.nonzero(knot[:-1] < knot[1:])[0]))
    n[np.arange(len(u)), np.clip(span, 0, last)] = 1
    for k in range(1, order):
        m = np.zeros((len(u), wide - k))
        for i in range(wide - k):
            d0, d1 = knot[i + k] - knot[i], knot[i + k + 1] - knot[i + 1]
            if d0 > 0:
                m[:, i] += (u - knot[i]) / d0 * n[:, i]
            if d1 > 0:
                m[:, i] += (knot[i + k + 1] - u) / d1 * n[:, i + 1]
        n = m
    return n


def _nurbs(spline, p, tilt, tolerance):
    """Halves parameter steps until every new midpoint lies within `tolerance` of its chord."""
    count, order = len(p), min(int(spline.order), len(p))
    odd = spline.bezier and spline.cyclic and count % max(order - 1, 1)
    short = spline.bezier and not spline.endpoint and count <= order
    if order < 2 or odd or short:  # Blender shows the control polygon in these cases
        return _poly(spline, p, tilt)
    weights = np.ones(count) if spline.weights is None else np.asarray(spline.weights, float)
    if not (weights > 0).all():
        raise ValueError("a NURBS point has a weight that is not positive")
    knot = knots(count, order, spline.cyclic, spline.endpoint, spline.bezier)
    wrap = np.arange(count + (order - 1 if spline.cyclic else 0)) % count
    lower, upper = knot[order - 1], knot[count + order - 1 if spline.cyclic else count]

    def at(u):
        b = basis(u, knot, order)[:, : len(wrap)] * weights[wrap]
        b /= b.sum(axis=1, keepdims=True)
        return b @ p[wrap], b @ tilt[wrap]

    inside = np.unique(knot[(knot >= lower) & (knot <= upper)])
    u = np.unique(np.concatenate([np.linspace(a, b, 5) for a, b in pairwise(inside)]))
    x, angle = at(u)
    while True:
        middle = 0.5 * (u[:-1] + u[1:])
        y, between = at(middle)
        gap = _distance_to_chords(y, x[:-1], x[1:])
        split = gap > 0.5 * tolerance
        if not split.any():
            break
        if len(u) + split.sum() > MAX_POINTS:
            raise ValueError(f"tolerance {tolerance} mm needs more than {MAX_POINTS} points on one spline of the curve")
        u = np.concatenate([u, middle[split]])
        order_of = np.argsort(u, kind="stable")
        u = u[order_of]
        x, angle = np.vstack([x, y[split]])[order_of], np.concatenate([angle, between[split]])[order_of]
    if spline.cyclic:
        x[-1] = x[0]
    return x, angle


def _distance_to_chords(p, a, b):
    d = b - a
    squared = np.maximum((d * d).sum(axis=1), 1e-300)
    t = np.clip(((p - a) * d).sum(axis=1) / squared, 0, 1)
    return np.linalg.norm(p - (a + t[:, None] * d), axis=1)


def length(points: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum()) if len(points) > 1 else 0.0


def refine(points: np.ndarray, tilt: np.ndarray, step: float) -> tuple[np.ndarray, np.ndarray]:
    """Inserts points so that no chord is longer than `step`; the polyline's shape is unchanged."""
    if len(points) < 2:
        return points, tilt
    if not (np.isfinite(step) and step > 0):
        raise ValueError(f"step must be positive, not {step}")
    chord = np.linalg.norm(np.diff(points, axis=0), axis=1)
    parts = np.maximum(1, np.ceil(chord / step)).astype(int)
    if parts.sum() > MAX_POINTS:
        raise ValueError(f"a step of {step} mm needs more than {MAX_POINTS} points along the curve")
    first = np.repeat(np.arange(len(parts)), parts)
    share = (np.arange(parts.sum()) - np.repeat(np.cumsum(parts) - parts, parts) + 1) / parts[first]
    new = points[first] + share[:, None] * (points[first + 1] - points[first])
    ends = np.cumsum(parts) - 1
    new[ends] = points[1:]
    return np.vstack([points[:1], new]), np.append(tilt[:1], tilt[first] + share * (tilt[first + 1] - tilt[first]))
