"""Cutter locations: poses of the tool along a path, lifted along its axis where it would gouge."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from .._core import Collider, Mesh, PencilPath, Tool
from ..arguments import Progress
from ..deprecated import DictResult
from ..hints import hinted
from .around import with_room


class BlockedPoint(NamedTuple):
    """A point of a path that no lift makes free of collisions."""

    point: int  #: number of the path's point
    reason: str  #: the obstacle


class UnsafeMove(NamedTuple):
    """A move between two rows that could not be made free of collisions."""

    row: int  #: the row that the move starts at
    clearance: float  #: mm: smallest clearance found on it
    bound: float  #: mm: lower bound of the clearance on it
    reason: str  #: what the tool may hit


@dataclass(frozen=True, eq=False, repr=False)
class LocationReport:
    """Changes of a path: see `cutter_locations`.

    Arrays have one entry for each row of ``cl``; clearances are negative inside.

    Attributes
    ----------
    points : ndarray, shape (n,)
        Number of the path's point; -1 for a row that was inserted.
    lift : ndarray, shape (n,)
        Distance of the lift along the tool's axis, mm.
    before, clearance : ndarray, shape (n,)
        Clearance before and after the lift, mm.
    pieces : list of str
        "cutter", "shank", "holder" or "fixture": the colliding or nearest part.
    blocked : list of BlockedPoint
        Points that no lift makes free; they have no row.
    unsafe : list of UnsafeMove
        Moves between two rows that could not be made free.
    min_clearance : float
        Smallest clearance of all computed poses, mm.
    bound : float
        Lower bound of the clearance along all rows, mm.
    evaluations : int
        Number of computed clearances.
    ok : bool
        Whether nothing is blocked or unsafe.
    """

    points: NDArray[np.int64]
    lift: NDArray[np.float64]
    before: NDArray[np.float64]
    clearance: NDArray[np.float64]
    pieces: list[str]
    blocked: list[BlockedPoint]
    unsafe: list[UnsafeMove]
    min_clearance: float
    bound: float
    evaluations: int
    ok: bool

    @property
    def depth_before(self) -> NDArray[np.float64]:
        """(n,) depth to which the tool entered part or fixtures before the lift, mm."""
        return np.maximum(0.0, -self.before)

    @property
    def lifted(self) -> NDArray[np.intp]:
        """Numbers of the rows that were lifted."""
        return np.flatnonzero(self.lift > 0)

    @property
    def inserted(self) -> NDArray[np.intp]:
        """Numbers of the rows that are not points of the path."""
        return np.flatnonzero(self.points < 0)

    def __repr__(self) -> str:
        rows = f"{len(self.points)} rows, {len(self.lifted)} lifted, {len(self.inserted)} inserted"
        return f"<LocationReport: {rows}, {len(self.blocked)} points blocked, {len(self.unsafe)} moves unsafe>"


@hinted("plan.cutter_locations")
def cutter_locations(
    path: PencilPath | ArrayLike,
    tool: Tool,
    collider: Collider,
    *,
    clearance: float = 0.0,
    tolerance: float = 0.01,
    max_lift: float = 100.0,
    max_inserted: int = 200,
    progress: Progress = None,
) -> tuple[NDArray[np.float64], LocationReport]:
    """Cutter locations along an oriented path, for ``Program.from_cl``.

    The tool starts with its tip ball, or both its contacts, on the path. Where its clearance from part and fixtures is
    less than ``clearance``, it is lifted along its own axis by the smallest sufficient distance. Between rows the tip
    moves on a line and the axis on the great circle; a bound, not samples, checks that motion, and rows are inserted
    and lifted where it gouges. A closed path ends by repeating its first row.

    Parameters
    ----------
    path : PencilPath or array_like, shape (n, 6)
        An oriented path, or poses from which the tool starts: tip in mm and unit axis.
    tool : Tool
        Cutter, shank and holder.
    collider : Collider
        Part and fixtures.
    clearance : float
        mm to keep from part and fixtures.
    tolerance : float
        mm by which the clearance may be less than ``clearance``: finishing cuts touch the part everywhere.
    max_lift : float
        Largest distance of a lift, mm.
    max_inserted : int
        Largest number of rows inserted between two points.
    progress : callable, optional
        Called with the finished share; returning False cancels.

    Returns
    -------
    cl : ndarray, shape (m, 6)
        Tip in mm and unit axis.
    report : LocationReport
        Points that are not free within ``max_lift`` and ``max_inserted`` are listed here (``report.ok`` is then False),
        and are not in ``cl``; nothing is left out silently.

    Raises
    ------
    ValueError
        For a path without axes, and for invalid sizes.

    Examples
    --------
    >>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
    >>> tool = riffler.Tool.ball(diameter=4, length=20)
    >>> valley = riffler.plan.pencil(part, tool)[0].orient({0: (0, 0, 1)})
    >>> cl, report = riffler.plan.cutter_locations(valley, tool, riffler.Collider(part))
    >>> cl.shape, report.ok
    ((2, 6), True)
    """
    return _core.cutter_locations(  # pyright: ignore[reportCallIssue] (an overload for each kind of path)
        path,  # pyright: ignore[reportArgumentType]
        tool,
        collider,
        clearance=clearance,
        tolerance=tolerance,
        max_lift=max_lift,
        max_inserted=max_inserted,
        progress=progress,
    )


@hinted("plan.path_of_poses")
def path_of_poses(poses: ArrayLike, contacts: ArrayLike, normals: ArrayLike, *, height: float) -> PencilPath:
    """Poses as a path: its centres lie ``height`` mm above the tips, on the axes.

    Each contact and each normal stands for both sides. ``poses_of`` gives the poses back, to rounding.

    Parameters
    ----------
    poses : array_like, shape (n, 6)
        Tip in mm and unit axis.
    contacts, normals : array_like, shape (n, 3)
        Points of the part, mm, and its unit normals there.
    height : float
        Distance of the centres from the tips, mm.

    Returns
    -------
    PencilPath

    Examples
    --------
    >>> poses = [(0, 0, 0, 0, 0, 1), (10, 0, 0, 0, 0, 1)]
    >>> path = riffler.plan.path_of_poses(poses, [(0, 0, 0), (10, 0, 0)], [(0, 0, 1), (0, 0, 1)], height=2)
    >>> bool((riffler.plan.poses_of(path) == poses).all())
    True
    """
    rows = np.asarray(poses, dtype=float)
    contacts, normals = (np.stack([each, each], axis=1) for each in map(np.asarray, (contacts, normals)))
    return PencilPath(height, rows[:, :3] + height * rows[:, 3:], contacts, normals).with_axes(rows[:, 3:])


@hinted("plan.poses_of")
def poses_of(path: PencilPath) -> NDArray[np.float64]:
    """The poses of a path whose centres lie its radius above the tips: one made by ``path_of_poses``, or a ball's.

    Parameters
    ----------
    path : PencilPath
        An oriented path.

    Returns
    -------
    ndarray, shape (n, 6)
        Tip in mm and unit axis.

    Examples
    --------
    >>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
    >>> valley = riffler.plan.pencil(part, riffler.Tool.ball(diameter=4, length=20))[0]
    >>> riffler.plan.poses_of(valley.orient({0: (0, 0, 1)})).shape
    (2, 6)
    """
    return np.hstack([path.centres - path.radius * path.axes, path.axes])


@hinted("plan.kept_locations")
def kept_locations(
    path: PencilPath,
    tool: Tool,
    collider: Collider,
    *,
    depth: float,
    clearance: float = 0.0,
    tolerance: float = 0.01,
    progress: Progress = None,
) -> tuple[NDArray[np.float64], LocationReport]:
    """``cutter_locations`` of a path in ``Plan.depths``: its own poses, checked and not lifted.

    The cutter enters the part by up to ``depth`` mm there, by ``tolerance`` more at a point, and by twice that more
    between two points, because the path's chords are that far from the surface. Shank and holder keep ``clearance``
    from part and fixtures. (A cutter that enters a fixture by less than ``depth`` is not detected here.)

    Parameters
    ----------
    path : PencilPath
        A path that ``path_of_poses`` has made.
    tool : Tool
        Cutter, shank and holder.
    collider : Collider
        Part and fixtures.
    depth : float
        mm by which the cutter enters the part.
    clearance : float
        Distance of shank and holder from part and fixtures, mm.
    tolerance : float
        Largest distance of the path's chords from the surface, mm.
    progress : callable, optional
        Called with the finished share; returning False cancels.

    Returns
    -------
    cl : ndarray, shape (m, 6)
        Tip in mm and unit axis.
    report : LocationReport

    Examples
    --------
    >>> part = riffler.shape.relief([[1, 1], [1, 1]], size=(30, 20), depth=10)
    >>> tool = riffler.Tool.taper(tip_radius=0.2, half_angle=0.3, diameter=4, length=20)
    >>> line = riffler.plan.engrave([[(5, 10, 10), (25, 10, 10)]], tool, part, depth=0.3)[0]
    >>> path = riffler.plan.path_of_poses(line.poses, line.contacts, line.normals, height=1)
    >>> cl, report = riffler.plan.kept_locations(path, tool, riffler.Collider(part), depth=0.3)
    >>> report.ok
    True
    """
    depth += tolerance
    body = with_room(tool, depth + clearance)
    return cutter_locations(
        poses_of(path), body, collider, clearance=-depth, tolerance=tolerance, max_lift=0.0, progress=progress
    )


@hinted("plan.contact_locations")
def contact_locations(
    contacts: ArrayLike, normals: ArrayLike, axes: ArrayLike, tool: Tool, *, feeds: ArrayLike | None = None
) -> NDArray[np.float64]:
    """Poses at which the cutter touches tangent planes from outside.

    Works for any profile: its furthest point against the normal touches the plane; a hollow arc touches with its ends.

    Parameters
    ----------
    contacts : array_like, shape (n, 3)
        Points of the planes, mm.
    normals, axes : array_like, shape (n, 3)
        Unit normals of the planes and unit axes of the tool.
    tool : Tool
        The cutter.
    feeds : array_like, shape (n, 3), optional
        Feed directions, of any length. Where axis and normal are parallel, every place on the contact circle is
        possible; the result has the place ahead in this direction.

    Returns
    -------
    ndarray, shape (n, 6)
        Tip in mm and unit axis.

    Raises
    ------
    ValueError
        Naming the row where only the cutter's upper end could touch.

    Examples
    --------
    >>> ball = riffler.Tool.ball(diameter=4, length=20)
    >>> riffler.plan.contact_locations([(1, 2, 3)], [(0, 0, 1)], [(0, 0, 1)], ball)
    array([[1., 2., 3., 0., 0., 1.]])
    """
    return _core.contact_locations(tool, contacts, normals, axes, feeds)


@dataclass(frozen=True, eq=False)
class LiftReport(DictResult):
    """Result of ``lift`` for each pose.

    Attributes
    ----------
    lift : ndarray, shape (n,)
        Distance of the lift along the tool's axis, mm.
    free : ndarray of bool, shape (n,)
        False if the pose is not free within ``max_lift``; it is then unchanged.
    before, clearance : ndarray, shape (n,)
        Clearance before and after the lift, mm.
    points : ndarray, shape (n, 3)
        Point of the last collision, or the nearest point, mm.
    pieces : list of str
        "cutter", "shank", "holder" or "fixture", for each of ``points``.
    evaluations : ndarray of int, shape (n,)
        Number of computed clearances.
    """

    lift: NDArray[np.float64]
    free: NDArray[np.bool_]
    before: NDArray[np.float64]
    clearance: NDArray[np.float64]
    points: NDArray[np.float64]
    pieces: list[str]
    evaluations: NDArray[np.int32]


@hinted("plan.lift")
def lift(
    poses: ArrayLike,
    tool: Tool,
    collider: Collider,
    *,
    clearance: float = 0.0,
    tolerance: float = 1e-9,
    max_lift: float = 1000.0,
    max_evaluations: int = 200,
    progress: Progress = None,
) -> tuple[NDArray[np.float64], LiftReport]:
    """Lifts each pose along the tool's own axis by the smallest distance at which it is free.

    At every lower height the clearance from part and fixtures is less than ``clearance``; where the lift ends it is
    ``clearance``, within ``tolerance``.

    Parameters
    ----------
    poses : array_like, shape (n, 6)
        Tip in mm and axis.
    tool : Tool
        Cutter, shank and holder.
    collider : Collider
        Part and fixtures.
    clearance, tolerance, max_lift : float
        Distance to keep, its largest error, and the largest distance of a lift, mm.
    max_evaluations : int
        Largest number of clearances computed for a pose.
    progress : callable, optional
        Called with the finished share; returning False cancels.

    Returns
    -------
    poses : ndarray, shape (n, 6)
        The lifted poses; one that is not free within ``max_lift`` stays where it is.
    report : LiftReport

    Examples
    --------
    >>> part = riffler.shape.relief([[1, 1], [1, 1]], size=(30, 20), depth=10)
    >>> ball = riffler.Tool.ball(diameter=4, length=20)
    >>> poses, report = riffler.plan.lift([(15, 10, 8, 0, 0, 1)], ball, riffler.Collider(part))
    >>> report.lift.round(6), poses[:, 2].round(6)
    (array([2.]), array([10.]))
    """
    lifted = np.array(poses, dtype=float)
    report = _core.lift(
        tool,
        lifted,
        collider,
        clearance=clearance,
        tolerance=tolerance,
        max_lift=max_lift,
        max_evaluations=max_evaluations,
        progress=progress,
    )
    rows = report.free
    lifted[rows, :3] += report.lift[rows, None] * lifted[rows, 3:]
    return lifted, report


@hinted("plan.drop")
def drop(
    points: ArrayLike,
    tool: Tool,
    part_mesh: Mesh,
    *,
    axis: ArrayLike = (0.0, 0.0, 1.0),
    progress: Progress = None,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Lowers the tool along ``axis`` until it first touches the part.

    Exact to rounding, except for hollow arcs, which are replaced by cones to within 1e-3 mm.

    Parameters
    ----------
    points : array_like, shape (n, 3)
        Points through which the tips move along ``axis``, mm.
    tool : Tool
        The cutter.
    part_mesh : Mesh
        The part.
    axis : array_like, shape (3,)
        Unit axis of the tool, tip to spindle.
    progress : callable, optional
        Called with the finished share; returning False cancels.

    Returns
    -------
    heights : ndarray, shape (n,)
        Tips along the axis, mm; NaN if the tool meets nothing.
    contacts : ndarray, shape (n, 3)
        Points of the part, mm; NaN likewise.

    Examples
    --------
    >>> part = riffler.shape.relief([[1, 1], [1, 1]], size=(30, 20), depth=10)
    >>> heights, contacts = riffler.plan.drop([(15, 10, 0)], riffler.Tool.ball(diameter=4, length=20), part)
    >>> heights.round(6)
    array([10.])
    """
    return _core.drop(tool, points, part_mesh, axis, progress)
