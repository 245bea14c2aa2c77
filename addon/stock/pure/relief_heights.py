"""Pictures as heights, and heights on a surface, without Blender."""

from __future__ import annotations

import numpy as np

LUMINANCE = (0.2126, 0.7152, 0.0722)  # of linear red, green and blue: Rec. ITU-R BT.709-6, item 3.2
STEEP = 4.0  # of a grid's width: what a surface may fall from one place to the next and still be one


def luminance(pixels: np.ndarray) -> np.ndarray:
    """(n, m) of `pixels` (n, m, channels), 0 to 1; what is transparent is dark."""
    channels = pixels.shape[2]
    grey = pixels[:, :, 0] if channels < 3 else pixels[:, :, :3] @ np.array(LUMINANCE)
    alpha = pixels[:, :, -1] if channels in (2, 4) else 1.0
    return np.clip(np.nan_to_num(grey * alpha), 0.0, 1.0)


def fitted(heights: np.ndarray, rows: int, columns: int) -> np.ndarray:
    """The picture over `rows` × `columns` places that reach from rim to rim: means where it is finer than those,
    between its pixels where it is coarser."""
    return _along(_along(heights, rows, 0), columns, 1)


def _along(values: np.ndarray, count: int, axis: int) -> np.ndarray:
    values = np.moveaxis(values, axis, 0)
    n = len(values)
    # the running integral of the pixels: exact means over any window, however fine or coarse
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
    """(top, bottom, cells) for riffler.shape.slab: `heights` (n, m), 0 to 1, on a surface that was looked at against
    `up` at `points` (n, m, 3), where it was `found` (n, m). What is raised stands `depth` × height over the surface and
    reaches `reach` below it; a negative `depth` engraves, and reaches as much above.

    A cell is left out where the surface is not under all its corners, or falls so steeply that it is another one."""
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
    """Whether what is raised by more than `slight` (n, m) has a place, of `top` (n, m, 3), further than that outside of
    the box from `lower` to `upper`. Places that are not found are NaN."""
    outside = ((top < lower - slight) | (top > upper + slight)).any(axis=2)
    return bool((outside & (raised > slight)).any())


def _spacing(points: np.ndarray, up: np.ndarray) -> float:
    """How far the places are from each other, seen along `up`."""
    across = np.diff(points, axis=0)
    across = across - (across @ up)[:, :, None] * up
    return float(np.nanmax(np.linalg.norm(across, axis=2), initial=0.0))
