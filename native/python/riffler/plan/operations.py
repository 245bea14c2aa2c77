"""Operations of a tool on a part in one set-up, with approaches, links and retracts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from .._core import Tool

RAPID, LEAD, CUT, LINK = range(4)
RAPID_FEED = 10000.0  # mm/min, for times, as in riffler.verify


@dataclass(frozen=True, eq=False)
class Blocked:
    """A place that the tool does not cut, with the reason: see `OperationReport`.

    Attributes
    ----------
    reason : str
        Why the places cannot be reached, such as "the holder meets the part" or "the holder meets the stock".
    place : ndarray, shape (3,)
        Tip of the tool at the first of these places, mm.
    length : float
        Length of the omitted rows, mm.
    """

    reason: str
    place: NDArray[np.float64]
    length: float


@dataclass(frozen=True)
class ExactFit:
    """How a finishing operation was moved from the triangles onto the exact surface: see `OperationReport`.

    Attributes
    ----------
    fitted : int
        Number of poses at which the tool touches the exact surface.
    inserted : int
        Number of poses added between those that were planned on triangles.
    raised : int
        Number of poses without such a place near them: raised until the tool is free.
    kept : int
        Number of poses left as they were, because no place near them is free or touches.
    before : float
        Largest distance of the tool from its place at a fitted pose, as planned on triangles, mm.
    after : float
        The same after the fit, also in the middles of moves, mm.
    kept_depth : float
        Largest depth of the tool in the exact surface at a kept pose, mm.
    """

    fitted: int
    inserted: int
    raised: int
    kept: int
    before: float
    after: float
    kept_depth: float


@dataclass(frozen=True, eq=False)
class OperationReport:
    """Times and lengths of an operation: see `Operation`.

    Attributes
    ----------
    time_s : float
        Time at the programmed feeds, with rapids at 10 m/min, s.
    cut_mm : float
        Length of the cuts, mm.
    air_mm : float
        Length of moves at feed that remove no material from the rays of the stock, mm.
    largest_engagement : float, optional
        Largest radial width of cut as a share of the diameter; None for operations that do not bound it.
    blocked : tuple of Blocked
        Places that could not be reached.
    stats : dict
        Counts: direct links, retracts, points of the drop surface; rows, and rows added between those of equal spacing;
        levels, rings in them, helices, ramps.
    exact : ExactFit, optional
        How the moves were corrected, if the set-up has an exact surface and the operation uses it.
    """

    time_s: float = 0.0
    cut_mm: float = 0.0
    air_mm: float = 0.0
    largest_engagement: float | None = None
    blocked: tuple[Blocked, ...] = ()
    stats: Mapping[str, int] = field(default_factory=dict)
    exact: ExactFit | None = None


@dataclass(frozen=True, eq=False)
class Operation:
    """One operation of a set-up: see `finish`. It begins and ends on the clearance plane.

    Attributes
    ----------
    poses : ndarray, shape (n, 6)
        Tip in mm and unit axis, at the ends of the moves.
    kind : ndarray of uint8, shape (n,)
        Kind of the move to each pose: 0 rapid, 1 lead (plunge), 2 cut, 3 link at feed.
    feed : ndarray, shape (n,)
        mm/min; 0 for rapids.
    tool : Tool
        Cutter, shank and holder.
    report : OperationReport
        Times, lengths, and unreached places.
    reason : str
        Why the operation has no poses; empty if it has some.
    spindle : float
        rev/min.
    tolerance : float
        mm by which cuts may enter part + allowance.
    engraved : float
        mm by which cuts are meant to enter the part; 0 for all but engraving.
    """

    poses: NDArray[np.float64]
    kind: NDArray[np.uint8]
    feed: NDArray[np.float64]
    tool: Tool
    report: OperationReport
    reason: str = ""
    spindle: float = 0.0
    tolerance: float = 0.01
    engraved: float = 0.0

    def __len__(self) -> int:
        return len(self.poses)


@dataclass(frozen=True, eq=False)
class PlannedMoves:
    """Moves of an operation, before its report: `poses`, `kind` and `feed` as in `Operation`, the volumes `removed`
    (n - 1,) mm³ by the moves, `blocked`, `reason` and `stats`, the largest width of cut as a share of the diameter if
    that is bounded, and how the moves were corrected on an exact surface, if they were."""

    poses: NDArray[np.float64]
    kind: NDArray[np.uint8]
    feed: NDArray[np.float64]
    removed: NDArray[np.float64]
    blocked: tuple[Blocked, ...]
    reason: str
    stats: Mapping[str, int]
    engagement: float | None = None
    exact: ExactFit | None = None


def lengths_of(poses: NDArray[np.float64]) -> NDArray[np.float64]:
    """Length of the move to each pose, mm; 0 for the first."""
    return np.linalg.norm(np.diff(poses[:, :3], axis=0, prepend=poses[:1, :3]), axis=1)


def report_of(
    poses: NDArray[np.float64],
    kind: NDArray[np.uint8],
    feed: NDArray[np.float64],
    removed: NDArray[np.float64],
    pitch: float,
    blocked: tuple[Blocked, ...],
    stats: Mapping[str, int],
    engagement: float | None = None,
    exact: ExactFit | None = None,
) -> OperationReport:
    """The report of an operation on a stock with rays ``pitch`` mm apart. ``removed[k]``: mm³ that the move to pose
    k + 1 removes. Moves that fit between two rays count as air only in a longer run of such moves."""
    if not len(poses):
        return OperationReport(blocked=blocked, stats=stats, largest_engagement=engagement, exact=exact)
    length, rapid = lengths_of(poses), kind == RAPID
    idle = np.concatenate([[True], removed <= 0]) & ~rapid
    run = np.cumsum(np.diff(idle, prepend=False) != 0)  # odd numbers are runs of idle moves
    idle &= np.bincount(run, weights=length)[run] > 2 * pitch
    return OperationReport(
        time_s=float(60 * np.sum(length / np.where(rapid, RAPID_FEED, feed))),
        cut_mm=float(np.sum(length[kind == CUT])),
        air_mm=float(np.sum(length[idle])),
        largest_engagement=engagement,
        blocked=blocked,
        stats=stats,
        exact=exact,
    )


def operation_of(moves: PlannedMoves, tool: Tool, pitch: float, spindle: float, tolerance: float) -> Operation:
    """An operation from the moves that the core has planned on a stock with rays ``pitch`` mm apart."""
    arrays = moves.poses, moves.kind, moves.feed
    report = report_of(*arrays, moves.removed, pitch, moves.blocked, moves.stats, moves.engagement, moves.exact)
    return Operation(*arrays, tool, report, moves.reason, float(spindle), float(tolerance))
