"""Closed meshes from heights and outlines, for reliefs, embossing and masks from curves. Lengths in mm."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._core import Mesh
from .hints import hinted

__all__ = ["extrude", "relief", "slab"]


@hinted("shape.slab")
def slab(top: ArrayLike, bottom: ArrayLike, *, cells: ArrayLike | None = None) -> Mesh:
    """The closed mesh between two sheets of points, point by point.

    Seen from the side that top lies on, rows and columns turn counter-clockwise: (right, up, towards the viewer) is
    right-handed. Where the sheets cross, the mesh turns inside out; a volume of it takes both parts as solid.

    Parameters
    ----------
    top, bottom : array_like of shape (n, m, 3), mm
        The sheets, with at least two rows and columns.
    cells : array_like of shape (n - 1, m - 1), bool, or None
        Cells to include; walls along the rim close each piece. Default: all.

    Returns
    -------
    Mesh
        Closed.

    Raises
    ------
    ValueError
        Names argument, row and column: another shape, a value that is not finite, no cell at all.

    Examples
    --------
    >>> x, y = np.meshgrid(np.arange(5.0), np.arange(4.0), indexing="ij")
    >>> plane = np.stack([x, y, 0 * x], axis=2)
    >>> round(riffler.shape.slab(plane + [0, 0, 2], plane).volume, 6)
    24.0
    """
    top, bottom = _sheet(top, "top"), _sheet(bottom, "bottom")
    if top.shape != bottom.shape:
        raise ValueError(f"top and bottom must have one shape, not {top.shape} and {bottom.shape}")
    n, m = top.shape[:2]
    cells = np.ones((n - 1, m - 1), bool) if cells is None else np.asarray(cells, bool)
    if cells.shape != (n - 1, m - 1):
        raise ValueError(f"cells must have the shape {(n - 1, m - 1)}, not {cells.shape}")
    if not cells.any():
        raise ValueError("cells: there is none")
    used = np.zeros((n, m), bool)
    for i, j in ((0, 0), (0, 1), (1, 0), (1, 1)):
        used[i : n - 1 + i, j : m - 1 + j] |= cells
    for name, sheet in (("top", top), ("bottom", bottom)):
        if not np.isfinite(sheet[used]).all():
            row = np.argwhere(used & ~np.isfinite(sheet).all(axis=2))[0]
            raise ValueError(f"{name}, row {row[0]}, column {row[1]}: not finite")
    number = np.full((n, m), -1)
    number[used] = np.arange(used.sum())
    count = int(used.sum())
    a, b = number[:-1, :-1][cells], number[1:, :-1][cells]
    c, d = number[1:, 1:][cells], number[:-1, 1:][cells]
    faces = np.concatenate([np.c_[a, b, c], np.c_[a, c, d]])
    walls = _walls(number, cells, count)
    return Mesh(np.concatenate([top[used], bottom[used]]), np.concatenate([faces, faces[:, ::-1] + count, walls]))


@hinted("shape.relief")
def relief(heights: ArrayLike, size: ArrayLike, depth: float, *, sink: float = 0.0) -> Mesh:
    """A closed mesh of heights on the plane z = 0, with its lower left corner at the origin.

    Parameters
    ----------
    heights : array_like of shape (n, m), from 0 to 1
        Rows go along y, like those of a picture whose first row is the lowest; columns go along x.
    size : array_like of shape (2,), mm
        Width along x and height along y.
    depth : float, mm
        Height of the value 1.
    sink : float, mm
        mm by which the mesh extends below the plane to join the material there; 0 counts as 1e-6 of the depth.

    Returns
    -------
    Mesh
        Closed.

    Raises
    ------
    ValueError
        For a wrong shape, a size that is not positive, or a value that is not finite.

    Examples
    --------
    >>> riffler.shape.relief([[0, 1], [0, 1]], size=(20, 10), depth=2).bounds.round(3).tolist()
    [[0.0, 0.0, -0.0], [20.0, 10.0, 2.0]]
    """
    heights = np.asarray(heights, float)
    if heights.ndim != 2 or min(heights.shape) < 2:
        raise ValueError(f"heights must have two rows and columns at least, not the shape {heights.shape}")
    width, height = np.asarray(size, float).tolist()
    if not (np.isfinite([width, height, depth, sink]).all() and width > 0 and height > 0 and depth > 0 and sink >= 0):
        raise ValueError("size and depth must be positive lengths in mm, sink not negative")
    x, y = np.linspace(0, width, heights.shape[1]), np.linspace(0, height, heights.shape[0])
    # rows of a slab go to the right
    plane = np.stack([*np.meshgrid(x, y, indexing="ij"), np.zeros(heights.T.shape)], axis=2)
    up = np.array([0.0, 0.0, 1.0])
    return slab(plane + heights.T[:, :, None] * depth * up, plane - max(sink, 1e-6 * depth) * up)


@hinted("shape.extrude")
def extrude(outlines: ArrayLike | Sequence[ArrayLike], direction: ArrayLike) -> Mesh:
    """The closed mesh that closed outlines sweep along a direction.

    The caps are fans, whose triangles overlap where an outline is not convex; a volume of the mesh has the right
    material all the same, since it follows how often the surface winds about a point.

    Parameters
    ----------
    outlines : array_like of shape (n, 3), mm, or a list of such
        Corners of the outlines. An outline inside another one is a hole if it turns in the opposite direction.
    direction : array_like of shape (3,), mm
        Direction and length of the sweep; the length must not be 0.

    Returns
    -------
    Mesh
        Closed.

    Raises
    ------
    ValueError
        Names outline and row: fewer than three points, a value that is not finite, a direction of length 0.

    Examples
    --------
    >>> square = np.array([[0, 0, 0], [4, 0, 0], [4, 3, 0], [0, 3, 0]])
    >>> round(riffler.shape.extrude(square, (0, 0, 2)).volume, 6)
    24.0
    """
    direction = np.asarray(direction, float)
    if direction.shape != (3,) or not np.isfinite(direction).all() or not direction.any():
        raise ValueError("direction must be three finite numbers, not all 0")
    several = [outlines] if isinstance(outlines, np.ndarray) else list(outlines)  # pyright: ignore[reportArgumentType]
    points = [_outline(outline, k) for k, outline in enumerate(several)]
    if not points:
        raise ValueError("outlines: there is none")
    if sum(float(_area(p) @ direction) for p in points) < 0:
        points = [p[::-1] for p in points]
    vertices, triangles, first = [], [], 0
    for p in points:
        n = len(p)
        centre = p.mean(axis=0)
        vertices += [p, p + direction, centre[None], (centre + direction)[None]]
        k, after = np.arange(n), (np.arange(n) + 1) % n
        low, high = np.full(n, 2 * n), np.full(n, 2 * n + 1)
        sides = [np.c_[k, after, after + n], np.c_[k, after + n, k + n]]
        caps = [np.c_[low, after, k], np.c_[high, k + n, after + n]]
        triangles += [t + first for t in (*sides, *caps)]
        first += 2 * n + 2
    return Mesh(np.concatenate(vertices), np.concatenate(triangles))


def _sheet(given: ArrayLike, name: str) -> NDArray[np.float64]:
    points = np.asarray(given, float)
    if points.ndim != 3 or points.shape[2] != 3 or min(points.shape[:2]) < 2:
        raise ValueError(f"{name} must have the shape (n, m, 3) with n and m at least 2, not {points.shape}")
    return points


def _walls(number: NDArray, cells: NDArray, count: int) -> NDArray:
    """Triangles from the top sheet down to the bottom one, along every side of a cell that no other cell shares."""
    padded = np.pad(cells, 1)
    walls = []
    # (difference to the neighbour, first and last corner of that side in the cell's own turn)
    for (di, dj), first, last in (
        ((-1, 0), (0, 1), (0, 0)),
        ((1, 0), (1, 0), (1, 1)),
        ((0, -1), (0, 0), (1, 0)),
        ((0, 1), (1, 1), (0, 1)),
    ):
        i, j = np.nonzero(cells & ~padded[1 + di : 1 + di + cells.shape[0], 1 + dj : 1 + dj + cells.shape[1]])
        a, b = number[i + first[0], j + first[1]], number[i + last[0], j + last[1]]
        walls += [np.c_[b, a, a + count], np.c_[b, a + count, b + count]]
    return np.concatenate(walls)


def _outline(outline: ArrayLike, k: int) -> NDArray[np.float64]:
    p = np.asarray(outline, float)
    if p.ndim != 2 or p.shape[1] != 3:
        raise ValueError(f"outlines, number {k}: must have the shape (n, 3), not {p.shape}")
    if not np.isfinite(p).all():
        raise ValueError(f"outlines, number {k}, row {int(np.argmin(np.isfinite(p).all(axis=1)))}: not finite")
    if len(p) > 1 and np.array_equal(p[0], p[-1]):
        p = p[:-1]
    if len(p) < 3:
        raise ValueError(f"outlines, number {k}: needs three points")
    return p


def _area(p) -> np.ndarray:
    """Twice the area vector of a closed polygon."""
    q = p - p[0]
    return np.cross(q, np.roll(q, -1, axis=0)).sum(axis=0)
