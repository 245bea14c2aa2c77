"""Orientations of the tool: unit quaternions (n, 4), w first as in Blender, and the axes (n, 3) to which they turn z.

Rotation about the axis itself has no meaning for the tool, so an axis has many quaternions; those made here twist as
little as possible from one row to the next.
"""

from __future__ import annotations

import numpy as np

from .poses import unit


def multiply(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Row by row, first `b`, then `a`."""
    w, x, y, z = np.moveaxis(a, -1, 0)
    s, t, u, v = np.moveaxis(b, -1, 0)
    return np.stack(
        [
            w * s - x * t - y * u - z * v,
            w * t + x * s + y * v - z * u,
            w * u - x * v + y * s + z * t,
            w * v + x * u - y * t + z * s,
        ],
        axis=-1,
    )


def axes_of(q: np.ndarray) -> np.ndarray:
    """The images of z, for quaternions of any length but zero, as F-curves give them."""
    w, x, y, z = np.moveaxis(unit(q), -1, 0)
    return unit(np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)], axis=-1))


def between(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """The shortest rotations from the unit axes `a` to `b`; for opposite axes a half turn about some perpendicular
    axis."""
    a, b = np.broadcast_arrays(np.asarray(a, float), np.asarray(b, float))
    total = a + b
    size = np.linalg.norm(total, axis=-1, keepdims=True)  # 2 cos of half the angle
    least = np.zeros_like(a)
    np.put_along_axis(least, np.abs(a).argmin(axis=-1)[..., None], 1.0, axis=-1)
    opposite = np.concatenate([np.zeros_like(size), unit(np.cross(a, least))], axis=-1)
    with np.errstate(divide="ignore", invalid="ignore"):
        turn = np.concatenate([size / 2, np.cross(a, b) / size], axis=-1)
    return np.where(size > 1e-9, turn, opposite)


def transported(axes: np.ndarray, before: np.ndarray | None = None) -> np.ndarray:
    """Quaternions of the axes: each is the previous one turned by the smallest angle onto its axis; the first
    is `before` (4,), by default the identity, turned likewise. Neighbours have the same sign."""
    before = np.array([1.0, 0, 0, 0]) if before is None else unit(np.asarray(before, float))
    first = multiply(between(axes_of(before), axes[0]), before)
    if len(axes) == 1:
        return unit(first)[None]
    q = np.vstack([first, between(axes[:-1], axes[1:])])
    step = 1
    while step < len(q):  # products of all turns so far, by doubling: Hillis and Steele, CACM 29 (1986) 1170
        q[step:] = multiply(q[step:], q[:-step])
        step *= 2
    return unit(q)


def aligned(q: np.ndarray) -> np.ndarray:
    """The same orientations, each with the sign nearer to the previous row: so that F-curves take the shorter arc."""
    if len(q) < 2:
        return q.copy()
    flips = np.where(np.einsum("ij,ij->i", q[1:], q[:-1]) < 0, -1.0, 1.0)
    return q * np.concatenate([[1.0], np.cumprod(flips)])[:, None]


def angle(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Angles between unit axes, row by row, rad; exact for small angles, too."""
    return 2 * np.arctan2(np.linalg.norm(a - b, axis=-1), np.linalg.norm(a + b, axis=-1))


def slerp(a: np.ndarray, b: np.ndarray, share: np.ndarray) -> np.ndarray:
    """Unit axes on the great circles from `a` to `b`, at these shares of the angle, row by row."""
    theta = angle(a, b)
    share = np.asarray(share, float)
    small = theta < 1e-9
    below = np.where(small, 1.0, np.sin(theta))
    left = np.where(small, 1 - share, np.sin((1 - share) * theta) / below)
    right = np.where(small, share, np.sin(share * theta) / below)
    return unit(left[..., None] * a + right[..., None] * b)
