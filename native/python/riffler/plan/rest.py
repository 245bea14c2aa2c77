"""Rest material: the areas of a part where a tool can still remove some, as closed curves seen along an axis."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from copy import copy

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from .._core import Tool, Volume
from ..hints import hinted
from .axis_rules import rule_arguments
from .locations import drop
from .setups import Setup

MOST = 1_000_000  # cells of a grid
Grid = NDArray[np.float64]


@hinted("plan.rest_region")
def rest_region(
    setup: Setup,
    tool: Tool,
    above: float,
    *,
    allowance: float = 0.0,
    orientation: ArrayLike | None = None,
    reference_tool: Tool | None = None,
) -> list[NDArray[np.float64]]:
    """Returns closed curves around the rest material that the tool can cut.

    The argument ``rest`` of `finish` calls this function. A place of the stock's surface counts if it is farther than
    ``allowance`` + ``above`` from the part, lies over the part and not under other material, and if the tool would cut
    at least half of ``above`` there. The curves run along the sides of cells, one cell outside of these places.

    Parameters
    ----------
    setup : Setup
        Part, in-process stock, axis.
    tool : Tool
        The tool that will cut.
    above : float
        Thickness of material that may stay in addition to ``allowance``, mm. A stock with rays in one direction knows
        walls along its rays to a pitch only: take "xyz", or a thickness of more than the pitch.
    allowance : float
        Thickness of the material that the tool will leave, mm.
    orientation : array_like, shape (3,), optional
        Unit vector from tip to spindle; by default the set-up's axis.
    reference_tool : Tool, optional
        A tool that has finished the whole part, with the same allowance, along the same axis. The material that it
        would leave counts instead of the set-up's stock.

    Returns
    -------
    list of ndarray, shape (k, 3)
        Closed curves in the part's frame; the region is inside an odd number of them. Empty without rest material.

    Examples
    --------
    >>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
    >>> setup = riffler.plan.Setup(part, riffler.Volume.block(*part.bounds, pitch=0.25))
    >>> setup.apply(riffler.plan.finish(setup, riffler.Tool.ball(diameter=8, length=20), cusp=0.02))
    >>> curves = riffler.plan.rest_region(setup, riffler.Tool.ball(diameter=2, length=20), above=0.1)
    >>> len(curves), bool(np.ptp(curves[0][:, 0]) > 29)  # along the whole valley
    (1, True)
    """
    setup = setup.along(orientation)
    if isinstance(above, Tool):
        raise TypeError("the rest is a height in mm, as 0.1; give the tool as reference_tool")
    if not (math.isfinite(above) and above > 0):
        raise ValueError(f"above must be positive and finite, not {above}")
    if not (math.isfinite(allowance) and allowance >= 0):
        raise ValueError(f"allowance must be finite and not negative, not {allowance}")
    stock = setup.stock if reference_tool is None else _left_by(reference_tool, setup, above, allowance)
    surface = stock.to_mesh()
    if not len(surface.triangles):
        return []
    distance = surface.deviation(setup.part, signed=True)
    frame = _frame(setup.axis)
    points = surface.vertices @ frame
    grid = _Cells(points, stock.pitch)  # finer cells would have no points between marked ones
    hidden_below = _around(grid.highest(points), np.minimum)[grid.of(points)] - stock.pitch
    high = np.flatnonzero((distance > allowance + above) & (points[:, 2] > hidden_below))
    normals = _normals(points, surface.triangles)[high]
    high = high[_reached(tool, setup, above, allowance, points[high], normals, frame)]
    if not len(high):
        return []
    mask = np.zeros(grid.shape, bool)
    mask[grid.of(points[high])] = True
    borders = _borders(grid, _around(mask, np.logical_or))
    return [np.column_stack([curve, np.zeros(len(curve))]) @ frame.T for curve in borders]


def inside(curves: Sequence[Grid], axis: Grid, points: Grid) -> NDArray[np.bool_]:
    """Which points, seen along the axis, lie inside an odd number of closed curves."""
    frame = _frame(axis)
    x, y = (points @ frame)[:, :2].T
    out = np.zeros(len(points), bool)
    for curve in curves:
        a = (curve @ frame)[:, :2]
        for (ax, ay), (bx, by) in zip(a, np.roll(a, -1, axis=0), strict=True):
            if ay != by:
                out ^= ((ay > y) != (by > y)) & (x < ax + (y - ay) / (by - ay) * (bx - ax))
    return out


class _Cells:
    """A grid of square cells over points, seen along z, with a border of two cells."""

    def __init__(self, points: Grid, side: float) -> None:
        lower, upper = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
        fewest = math.sqrt(float(np.prod(upper - lower + side)) / MOST)
        self.side = max(side, fewest)
        self.lower = lower - 2 * self.side
        size = np.ceil((upper - self.lower) / self.side).astype(int) + 3
        self.shape = (int(size[0]), int(size[1]))

    def of(self, points: Grid) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        cells = ((points[:, :2] - self.lower) / self.side).astype(np.intp)
        return cells[:, 0], cells[:, 1]

    def highest(self, points: Grid) -> Grid:
        """The largest z of the points in each cell; −∞ without points."""
        out = np.full(self.shape, -np.inf)
        np.maximum.at(out, self.of(points), points[:, 2])
        return out


def _frame(axis: Grid) -> Grid:
    """Columns: two directions perpendicular to the axis, and the axis."""
    other = np.eye(3)[int(np.argmin(np.abs(axis)))]
    x = np.cross(other, axis)
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(axis, x), axis])


def _normals(points: Grid, triangles: NDArray[np.int32]) -> Grid:
    """Unit normals at the points of a surface: means over their triangles, by area."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    out = np.zeros_like(points)
    for k in range(3):
        np.add.at(out, triangles[:, k], np.cross(b - a, c - a))
    return out / np.maximum(np.linalg.norm(out, axis=1), 1e-300)[:, None]


def _reached(
    tool: Tool, setup: Setup, above: float, allowance: float, points: Grid, normals: Grid, frame: Grid
) -> NDArray[np.bool_]:
    """Which points of the stock's surface over the part the cutter enters by at least half of ``above``, at one of
    three places: as far next to the point as its normal requires, half as far, and above the point."""
    radii, rises = _lower_side(tool)
    slopes = np.arctan2(np.diff(rises), np.diff(radii))
    steep = np.arccos(np.clip(normals[:, 2], 0, 1))
    aside = radii[np.minimum(np.searchsorted(slopes, steep), len(radii) - 1)] - above * np.sin(steep)
    level = normals[:, :2] / np.maximum(np.linalg.norm(normals[:, :2], axis=1), 1e-300)[:, None]
    upright = np.interp(radii, 0.5 * (radii[1:] + radii[:-1]), np.cos(slopes))
    below = np.column_stack([points[:, :2], np.zeros(len(points))]) @ frame.T
    needle = Tool.flat(diameter=1e-3 * tool.diameter, length=tool.length)
    over = ~np.isnan(drop(below, needle, setup.part, axis=setup.axis)[0])  # rows end where the part ends
    out = np.zeros(len(points), bool)
    for share in (1.0, 0.5, 0.0):
        rest = np.flatnonzero(over & ~out)
        off = share * np.maximum(aside[rest], 0)
        places = np.column_stack([points[rest, :2] + off[:, None] * level[rest], np.zeros(len(rest))]) @ frame.T
        heights = drop(places, tool, setup.part, axis=setup.axis)[0] + allowance
        depth = (points[rest, 2] - heights - np.interp(off, radii, rises)) * np.interp(off, radii, upright)
        out[rest] = np.minimum(depth, radii[-1] - off) >= above / 2
    return out


def _lower_side(tool: Tool) -> tuple[Grid, Grid]:
    """Radii, ascending, and the heights of the cutter's lower side above the tip there."""
    line = next(line for piece, line in tool.outline(tolerance=1e-3 * tool.diameter) if piece == "cutter")
    below = line[: int(np.argmax(line[:, 0])) + 1]
    return below[:, 0], below[:, 1]


def _shifted(i: int, j: int) -> tuple[tuple[slice, slice], tuple[slice, slice]]:
    """Slices of an array, and of the cells that lie i and j cells further."""
    to = tuple(slice(max(0, -k), None if k <= 0 else -k) for k in (i, j))
    of = tuple(slice(max(0, k), None if k >= 0 else k) for k in (i, j))
    return to, of  # type: ignore[return-value]


def _around(values: NDArray, best: Callable[..., NDArray]) -> NDArray:
    """``best`` of the values of each cell and its eight neighbours."""
    out = values.copy()
    for i in (-1, 0, 1):
        for j in (-1, 0, 1):
            to, of = _shifted(i, j)
            out[to] = best(out[to], values[of])
    return out


def _left_by(tool: Tool, setup: Setup, above: float, allowance: float) -> Volume:
    """The stock after a tool has finished the whole part, with ridges of a quarter of ``above``."""
    left = copy(setup.stock)
    done = _core.finish(
        setup.part,
        [],
        setup.stock,
        tool,
        axis=setup.axis,
        clearance=setup.clearance,
        pattern="parallel",
        cusp=above / 4,
        tolerance=above / 4,
        allowance=allowance,
        angle=0.0,
        min_slope=0.0,
        max_slope=math.pi / 2,
        region=[],
        faces=[],
        centre=None,
        climb=True,
        feed=1.0,
        plunge=1.0,
        lead=0.0,
        **rule_arguments(None),
        exact=None,
        deviation=0.0,
        progress=None,
    )
    if len(done.poses):
        left.carve(tool, done.poses)
    return left


def _borders(grid: _Cells, mask: NDArray[np.bool_]) -> list[Grid]:
    """The borders of the marked cells, as closed polygons of their corners, (k, 2). No marked cell is at the rim."""
    steps: dict[tuple[int, int], list[tuple[int, int]]] = {}
    for di, dj, first, last in ((0, -1, (0, 0), (1, 0)), (1, 0, (1, 0), (1, 1)), (0, 1, (1, 1), (0, 1)),
                                (-1, 0, (0, 1), (0, 0))):  # fmt: skip
        to, of = _shifted(di, dj)
        open_side = mask.copy()
        open_side[to] &= ~mask[of]
        for i, j in np.argwhere(open_side).tolist():
            steps.setdefault((i + first[0], j + first[1]), []).append((i + last[0], j + last[1]))
    curves = []
    while steps:
        start = at = next(iter(steps))
        corners = []
        while not corners or at != start:
            following = steps[at].pop()
            if not steps[at]:
                del steps[at]
            corners.append(at)
            at = following
        line = np.array(corners)
        ahead, behind = np.roll(line, -1, axis=0) - line, line - np.roll(line, 1, axis=0)
        curves.append(grid.lower + line[(ahead != behind).any(axis=1)] * grid.side)
    return curves
