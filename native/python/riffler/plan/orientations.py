"""Free orientations: collision-free tool axes, as a map at a point and along a path."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from .._core import Collider, PencilPath, Tool
from ..arguments import Cone, Progress, then
from ..deprecated import DictResult
from ..hints import hinted

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FREE, BLOCKED, BEYOND, UNREACHABLE = range(4)
_WIDEST = math.radians(75)


def _grid(angles: ArrayLike | None, widest: float = _WIDEST, count: int = 21) -> NDArray[np.float64]:
    return np.linspace(-widest, widest, count) if angles is None else np.asarray(angles, dtype=float)


@dataclass(frozen=True, eq=False, repr=False)
class FreeOrientations:
    """The configuration space at one point of a path: see `free_orientations`. Arrays are (inclinations, tilts).

    Attributes
    ----------
    index : int
        Number of the path's point.
    inclinations : ndarray, shape (n,)
        Inclinations of the grid, rad.
    tilts : ndarray, shape (m,)
        Tilts of the grid, rad.
    clearance : ndarray, shape (n, m)
        Clearance, mm; negative inside, NaN if not computed.
    state : ndarray of uint8, shape (n, m)
        FREE, BLOCKED, BEYOND the machine's cone, or UNREACHABLE for the cutter.
    pieces : ndarray of str, shape (n, m)
        The nearest or deepest part.
    axes : ndarray, shape (n, m, 3)
        Unit axes of the tool.
    suggestion : ndarray, shape (3,), or None
        The free axis with the smallest angle to the frame's z.
    reason : str
        Without a suggestion: what collides, and the smallest depth.
    """

    index: int
    inclinations: NDArray[np.float64]
    tilts: NDArray[np.float64]
    clearance: NDArray[np.float64]
    state: NDArray[np.uint8]
    pieces: NDArray[np.str_]
    axes: NDArray[np.float64]
    suggestion: NDArray[np.float64] | None
    reason: str

    @property
    def free(self) -> NDArray[np.bool_]:
        """(n, m): True where ``state`` is FREE."""
        return self.state == FREE

    def __repr__(self) -> str:
        return f"<FreeOrientations at point {self.index}: {int(self.free.sum())} of {self.free.size} free>"


@dataclass(frozen=True, eq=False)
class MapValues:
    """Results of the core for one point: the fields of `FreeOrientations` as flat arrays."""

    axes: NDArray[np.float64]
    clearance: NDArray[np.float64]
    state: NDArray[np.uint8]
    pieces: list[str]
    suggestion: NDArray[np.float64] | None
    reason: str


def _map(
    index: int, inclinations: NDArray[np.float64], tilts: NDArray[np.float64], found: MapValues
) -> FreeOrientations:
    shape = len(inclinations), len(tilts)
    return FreeOrientations(
        index,
        inclinations,
        tilts,
        clearance=found.clearance.reshape(shape),
        state=found.state.reshape(shape),
        pieces=np.array(found.pieces).reshape(shape),
        axes=found.axes.reshape(*shape, 3),
        suggestion=found.suggestion,
        reason=found.reason,
    )


@overload
def free_orientations(
    path: PencilPath, tool: Tool, collider: Collider, *, index: int, inclinations: ArrayLike | None = None,
    tilts: ArrayLike | None = None, clearance: float = 0.0, tolerance: float = 0.01, limit: Cone | None = None,
    progress: Progress = None,
) -> FreeOrientations: ...  # fmt: skip
@overload
def free_orientations(
    path: PencilPath, tool: Tool, collider: Collider, *, index: Sequence[int], inclinations: ArrayLike | None = None,
    tilts: ArrayLike | None = None, clearance: float = 0.0, tolerance: float = 0.01, limit: Cone | None = None,
    progress: Progress = None,
) -> list[FreeOrientations]: ...  # fmt: skip
@hinted("plan.free_orientations")
def free_orientations(
    path: PencilPath,
    tool: Tool,
    collider: Collider,
    *,
    index: int | Sequence[int],
    inclinations: ArrayLike | None = None,
    tilts: ArrayLike | None = None,
    clearance: float = 0.0,
    tolerance: float = 0.01,
    limit: Cone | None = None,
    progress: Progress = None,
) -> FreeOrientations | list[FreeOrientations]:
    """The free orientations at one point of a path, or at several.

    Puts the tool on the path with every axis of the grid ``inclinations`` × ``tilts`` in the path's frame there. An
    axis is free if the tool's clearance from part and fixtures is at least ``clearance`` - ``tolerance``.

    Parameters
    ----------
    path : PencilPath
        The path; it need not be oriented.
    tool : Tool
        Cutter, shank and holder.
    collider : Collider
        Part and fixtures.
    index : int or list of int
        Number of the path's point, from 0.
    inclinations, tilts : array_like, optional
        rad, ascending; None: 21 each within 75 degrees.
    clearance, tolerance : float
        Distance to keep, and by how much it may be smaller, mm.
    limit : tuple of axis and angle, optional
        The cone in which the machine keeps the tool: unit axis, half angle in rad. Nothing is computed beyond it.
    progress : callable, optional
        Called with the finished share; returning False cancels.

    Returns
    -------
    FreeOrientations, or a list of one for each index

    Raises
    ------
    ValueError
        Naming a point that the path does not have, or an invalid size.

    Examples
    --------
    >>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
    >>> tool = riffler.Tool.ball(diameter=4, length=20)
    >>> valley = riffler.plan.pencil(part, tool)[0]
    >>> found = riffler.plan.free_orientations(valley, tool, riffler.Collider(part), index=0)
    >>> found.free.shape, found.suggestion.round(6) + 0.0
    ((21, 21), array([0., 0., 1.]))
    """
    rows, columns = _grid(inclinations), _grid(tilts)
    single = np.ndim(index) == 0
    points = [int(i) for i in ([index] if single else index)]  # pyright: ignore[reportGeneralTypeIssues]
    if any(i < 0 for i in points):
        raise ValueError("index: begins at 0")
    found = _core.orientation_maps(
        path, points, tool, collider, inclinations=rows.tolist(), tilts=columns.tolist(), clearance=clearance,
        tolerance=tolerance, limit=limit, progress=progress,
    )  # fmt: skip

    def maps(found: list[MapValues]) -> FreeOrientations | list[FreeOrientations]:
        made = [_map(i, rows, columns, one) for i, one in zip(points, found, strict=True)]
        return made[0] if single else made

    return then(found, maps)


@dataclass(frozen=True, eq=False)
class TiltReport(DictResult):
    """Result of ``min_tilt``.

    Attributes
    ----------
    found : bool
        Whether there is a free axis at every point, within the largest change.
    angles : ndarray, shape (n,)
        Angle between each axis and the frame's z, rad.
    cost : float
        The sum that was minimised, rad².
    point : int
        Without a result: the point without a free axis.
    reason : str
        Why there is no result: no axis is free at the point, or none that the axes before it can reach.
    """

    found: bool
    angles: NDArray[np.float64]
    cost: float
    point: int
    reason: str


@hinted("plan.min_tilt")
def min_tilt(
    path: PencilPath,
    tool: Tool,
    collider: Collider,
    *,
    inclinations: ArrayLike | None = None,
    tilts: ArrayLike | None = None,
    clearance: float = 0.0,
    tolerance: float = 0.01,
    limit: Cone | None = None,
    max_change: float | None = None,
    smoothness: float = 4.0,
    progress: Progress = None,
) -> tuple[PencilPath | None, TiltReport]:
    """The free orientations along a path with the smallest tilt.

    Chooses one free axis from each map of ``free_orientations``. The choice minimises the sum of the squared angles to
    the frame's z, plus ``smoothness`` times the sum of the squared changes between neighbours: over the grid, by
    dynamic programming; on a closed path, for the given axis of the first point. ``cutter_locations`` checks the motion
    between points.

    Parameters
    ----------
    path : PencilPath
        The path; it need not be oriented.
    tool : Tool
        Cutter, shank and holder.
    collider : Collider
        Part and fixtures.
    inclinations, tilts : array_like, optional
        rad, ascending; None: 21 each within 75 degrees.
    clearance, tolerance : float
        Distance to keep, and by how much it may be smaller, mm.
    limit : tuple of axis and angle, optional
        The cone in which the machine keeps the tool: unit axis, half angle in rad.
    max_change : float, optional
        Largest change between neighbours, rad; None: one and a half diagonals of the grid.
    smoothness : float
        Weight of the changes.
    progress : callable, optional
        Called with the finished share; returning False cancels.

    Returns
    -------
    path : PencilPath or None
        The oriented path; None if there is no result.
    report : TiltReport

    Examples
    --------
    >>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
    >>> tool = riffler.Tool.ball(diameter=4, length=20)
    >>> valley = riffler.plan.pencil(part, tool)[0]
    >>> oriented, report = riffler.plan.min_tilt(valley, tool, riffler.Collider(part))
    >>> report.found, report.angles.round(6)
    (True, array([0., 0.]))
    """
    rows, columns = _grid(inclinations), _grid(tilts)
    if max_change is None:
        steps = [float(np.diff(angles).max()) if len(angles) > 1 else 0.0 for angles in (rows, columns)]
        max_change = max(1.5 * math.hypot(*steps), 1e-3)
    found = _core.min_tilt(
        path, tool, collider, inclinations=rows.tolist(), tilts=columns.tolist(), clearance=clearance,
        tolerance=tolerance, limit=limit, max_change=max_change, smoothness=smoothness, progress=progress,
    )  # fmt: skip

    def oriented(found: tuple[NDArray[np.float64], TiltReport]) -> tuple[PencilPath | None, TiltReport]:
        axes, report = found
        return (path.orient(dict(enumerate(axes)), interpolation="slerp") if report.found else None), report

    return then(found, oriented)


@hinted("plan.draw_map")
def draw_map(orientations: FreeOrientations, *, axes: Axes | None = None) -> Axes:
    """Draws the map with matplotlib, which must be installed.

    Colours show the clearance, and a line the border of the free region. Orientations that were not computed are grey;
    a ring marks the suggestion. Angles are in degrees.

    Parameters
    ----------
    orientations : FreeOrientations
        The map of one point: see `free_orientations`.
    axes : matplotlib.axes.Axes, optional
        Axes to draw into; None: a new figure.

    Returns
    -------
    matplotlib.axes.Axes

    Examples
    --------
    >>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
    >>> tool = riffler.Tool.ball(diameter=4, length=20)
    >>> valley = riffler.plan.pencil(part, tool)[0]
    >>> axes = riffler.plan.draw_map(riffler.plan.free_orientations(valley, tool, riffler.Collider(part), index=0))
    >>> axes.figure.savefig("map.png")
    """
    from matplotlib import colors, pyplot

    if axes is None:
        axes = pyplot.subplots(layout="constrained")[1]
    tilts, inclinations = np.degrees(orientations.tilts), np.degrees(orientations.inclinations)
    clearance = np.ma.masked_invalid(orientations.clearance)
    largest = max(float(np.abs(clearance).max()), 1e-6) if clearance.count() else 1.0
    axes.set_facecolor("0.85")
    shown = axes.pcolormesh(
        tilts,
        inclinations,
        clearance,
        cmap="RdBu",
        shading="nearest",
        norm=colors.SymLogNorm(0.01, vmin=-largest, vmax=largest),
    )
    axes.figure.colorbar(shown, ax=axes, label="clearance, mm")
    if len(tilts) > 1 and len(inclinations) > 1 and orientations.free.any() and not orientations.free.all():
        axes.contour(tilts, inclinations, orientations.free.astype(float), levels=[0.5], colors="black")
    if orientations.suggestion is not None:
        gaps = np.linalg.norm(orientations.axes - orientations.suggestion, axis=-1)
        row, column = np.unravel_index(int(gaps.argmin()), gaps.shape)
        axes.plot(tilts[column], inclinations[row], "o", mfc="none", mec="black", ms=10)
    axes.set(xlabel="tilt, degrees", ylabel="inclination, degrees", title=f"point {orientations.index}")
    return axes
