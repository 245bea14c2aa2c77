"""Operations along given poses: collisions, leads and links are those of the core's cut_along."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from .. import _core
from .._core import Tool
from ..arguments import Progress
from .operations import Blocked, ExactFit, Operation, operation_of
from .setups import GREATER, Setup

STEEPEST = np.cos(np.radians(80)) + 1e-9  # cosine of the largest angle from the set-up's axis: see kMaxTilt


def along_poses(
    setup: Setup,
    tool: Tool,
    lines: Sequence[NDArray[np.float64]],
    *,
    engraved: float = 0.0,
    tolerance: float,
    max_lift: float,
    feed: float,
    plunge: float | None,
    spindle: float,
    blocked: Sequence[Blocked] = (),
    reason: str = "",
    stats: Mapping[str, int] | None = None,
    exact: ExactFit | None = None,
    progress: Progress = None,
) -> Operation:
    """An operation that cuts lines of poses (n, 6), at most ``engraved`` + ``tolerance`` mm deep in the part and
    ``tolerance`` mm in fixtures. Poses that no lift up to ``max_lift`` mm frees are left out. ``blocked`` and ``stats``
    are added to the report; ``reason``: why there are no lines. ``exact``: how the lines were moved onto the set-up's
    exact surface; they may then enter the part's triangles by as much as these may lie outside of it."""
    for name, value in (("feed", feed), ("plunge", plunge)):
        if value is not None and not (np.isfinite(value) and value > 0):
            raise ValueError(f"{name} must be positive and finite, not {value}")
    kept, more = _within_reach(setup, lines)
    # Shank and holder stay out of the part, although the cutter enters it.
    below = engraved + (GREATER * setup.deviation if exact is not None else 0.0)
    checked = tool.with_margins(shank=engraved, holder=engraved) if engraved > 0 else tool
    moves = _core.cut_along(
        setup.part,
        setup.obstacles,
        setup.stock,
        checked,
        axis=setup.axis,
        clearance=setup.clearance,
        lines=kept,
        distance=-below,
        fixture_distance=0.0 if below else None,
        tolerance=tolerance,
        max_lift=max_lift,
        feed=feed,
        plunge=feed / 3 if plunge is None else plunge,
        progress=progress,
    )
    every = (*blocked, *more, *moves.blocked)
    why = "" if len(moves.poses) else reason or (every[0].reason if every else moves.reason)
    moves = replace(moves, blocked=every, reason=why, stats={**(stats or {}), **moves.stats}, exact=exact)
    return replace(operation_of(moves, tool, setup.stock.pitch, spindle, tolerance), engraved=float(engraved))


def _within_reach(
    setup: Setup, lines: Sequence[NDArray[np.float64]]
) -> tuple[list[NDArray[np.float64]], list[Blocked]]:
    """The parts of lines whose axes lean by at most 80° from the set-up's axis, and the others."""
    kept: list[NDArray[np.float64]] = []
    blocked: list[Blocked] = []
    for line in lines:
        if len(line) < 2:
            continue
        within = line[:, 3:] @ setup.axis >= STEEPEST
        for run in np.split(np.arange(len(line)), np.flatnonzero(np.diff(within)) + 1):
            if within[run[0]]:
                kept += [line[run]] if len(run) > 1 else []
            else:
                length = float(np.linalg.norm(np.diff(line[run, :3], axis=0), axis=1).sum())
                why = "the tool would lean by more than 80° from the set-up's axis"
                blocked.append(Blocked(why, line[run[0], :3], length))
    return kept, blocked
