"""Pictures as heights, and heights on a surface, without Blender."""

from __future__ import annotations

import numpy as np

LUMINANCE = (0.2126, 0.7152, 0.0722)  # weights of linear red, green and blue: Rec. ITU-R BT.709-6, item 3.2
STEEP = 4.0  # grid widths: largest drop of a surface from one place to the next


def luminance(pixels: np.ndarray) -> np.ndarray:
    """(n, m) of `pixels` (n, m, channels), 0 to 1; transparent pixels are dark."""
    channels = pixels.shape[2]
    grey = pixels[:, :, 0] if channels < 3 else pixels[:, :, :3] @ np.array(LUMINANCE)
    alpha = pixels[:, :, -1] if channels in (2, 4) else 1.0
    return np.clip(np.nan_to_num(grey * alpha), 0.0, 1.0)


def fitted(heights: np.ndarray, rows: int, columns: int) -> np.ndarray:
    """The picture at `rows` × `columns` places from edge to edge: averaged where it is finer than those, interpolated
    where it is coarser."""
    return _along(_along(heights, rows, 0), columns, 1)


def _along(values: np.ndarray, count: int, axis: int) -> np.ndarray:
    values = np.moveaxis(values, axis, 0)
    n = len(values)
    # the running integral of the pixels: exact means over any window
    integral = np.concatenate([np.zeros((1, *values.shape[1:])), np.cumsum(values, axis=0)])
    step = n / max(count - 1, 1)
    half = max(0.5 * step, 0.5)
    centre = np.arange(count) * step
    low, high = np.clip(centre - half, 0, n), np.clip(centre + half, 0, n)
    out = (_at(integral, high) - _at(integral, low)) / (high - low).reshape(-1, *[1] * (values.ndim - 1))
    return np.moveaxis(out, 0, axis)


def _at(integral: np.ndarray, x: np.ndarray) -> np.ndarray:
    k = np.minimum(x.astype(int), len(integral) - 2)
    share = (x - k).reshape(-1, *[1] * (integral.ndim - 1))
    return (1 - share) * integral[k] + share * integral[k + 1]


def draped(points: np.ndarray, found: np.ndarray, up: np.ndarray, heights: np.ndarray, depth: float, reach: float):
    """(top, bottom, cells) for riffler.shape.slab: `heights` (n, m), 0 to 1, on a surface sampled against `up` at
    `points` (n, m, 3), where it was `found` (n, m). Raised material is `depth` × height above the surface and reaches
    `reach` below it; a negative `depth` engraves, and reaches as much above.

    A cell is left out if the surface is not under all its corners, or drops so steeply that it is another surface.
    """
    level = points @ up
    offset = heights[:, :, None] * abs(depth) * up
    top, bottom = (points + offset, points - reach * up) if depth > 0 else (points + reach * up, points - offset)
    width = max(_spacing(points, up), 1e-12)
    corners = np.stack([level[i : level.shape[0] - 1 + i, j : level.shape[1] - 1 + j] for i in (0, 1) for j in (0, 1)])
    there = np.stack([found[i : found.shape[0] - 1 + i, j : found.shape[1] - 1 + j] for i in (0, 1) for j in (0, 1)])
    with np.errstate(invalid="ignore"):
        cells = there.all(axis=0) & (np.ptp(corners, axis=0) <= STEEP * width)
    return top, bottom, cells


def leaves(top: np.ndarray, raised: np.ndarray, lower, upper, slight: float) -> bool:
    """Whether material raised by more than `slight` (n, m) has a place, of `top` (n, m, 3), further than that outside
    the box from `lower` to `upper`. Places that are not found are NaN."""
    outside = ((top < lower - slight) | (top > upper + slight)).any(axis=2)
    return bool((outside & (raised > slight)).any())


def _spacing(points: np.ndarray, up: np.ndarray) -> float:
    """The distance between places, seen along `up`."""
    across = np.diff(points, axis=0)
    across = across - (across @ up)[:, :, None] * up
    return float(np.nanmax(np.linalg.norm(across, axis=2), initial=0.0))
