"""Swarf cuts as an operation of a set-up."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .._core import PencilPath, Tool
from ..arguments import Progress
from ..hints import hinted
from .axis_rules import require_rotary
from .operations import Operation
from .posed import along_poses
from .setups import Setup
from .strategies.pencil import pencil
from .strategies.strategy import share_of
from .strategies.swarf import SIDES, SwarfCuts


@hinted("plan.swarf_operation")
def swarf_operation(
    setup: Setup,
    tool: Tool,
    paths: Sequence[PencilPath] | None = None,
    *,
    side: str = "better",
    height: float | None = None,
    tolerance: float = 0.05,
    feed: float = 500.0,
    plunge: float | None = None,
    spindle: float = 12000.0,
    progress: Progress = None,
) -> Operation:
    """Cuts ruled walls above pencil paths with the tool's flank: `swarf` as an operation.

    Places where the flank does not fit the wall within the tolerance are left out, and so are those where cutter, shank
    or holder would enter the part by more, or fixtures at all; a bound over each move proves the rest.
    ``report.blocked`` lists them.

    Parameters
    ----------
    setup : Setup
        Part, in-process stock, fixtures, axis. Its machine needs rotary axes.
    tool : Tool
        A tool whose end is a ball, with a cylinder or a cone above it.
    paths : list of PencilPath, optional
        The feet of the walls, found by `pencil` with the same ball; by default all valleys of the part.
    side : {"better", "first", "second"}
        Which wall of a path: the one that the flank fits along the greater length, or that of its first or second
        contact.
    height : float, optional
        Height of the wall to cut, mm from the ball's centre; None: up to the end of wall or flank.
    tolerance : float
        Largest distance between wall and flank, and depth to which the tool may enter the part, mm.
    feed : float
        Feed of cuts, mm/min.
    plunge : float, optional
        Feed of leads, mm/min; by default a third of ``feed``.
    spindle : float
        Speed, rev/min; negative: counter-clockwise.
    progress : callable, optional
        Called with the finished share; returning False cancels.

    Returns
    -------
    Operation
        The operation. Without a wall that fits, it has no poses, and ``reason`` says why.

    Raises
    ------
    ValueError
        An argument is wrong; the message names it.

    Examples
    --------
    >>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
    >>> setup = riffler.plan.Setup(part, riffler.Volume.block(*part.bounds, 0.5, "xyz"), machine="tcp")
    >>> op = riffler.plan.swarf_operation(setup, riffler.Tool.ball(diameter=4, length=20), tolerance=0.05)
    >>> op.report.stats["walls"], op.report.cut_mm > 20
    (1, True)
    """
    require_rotary(setup)
    if side not in (names := [name for name, *_ in SIDES]):
        raise ValueError(f"side must be one of {', '.join(names)}, not {side!r}")
    strategy = SwarfCuts()
    reason = ""
    if paths is None:
        valleys = pencil(setup.part, tool, tolerance=min(tolerance, 0.01), progress=share_of(progress, 0, 2))
        paths, reason = list(valleys), valleys.reason
    strategy.check(tool, paths)
    options = {"side": side, "height": height, "tolerance": tolerance}
    found = strategy.run(setup.part, tool, paths, options)
    walls = found.plan.paths
    lines = [_poses(path) for path in walls]
    return along_poses(
        setup,
        tool,
        lines,
        tolerance=tolerance,
        max_lift=tolerance,
        feed=feed,
        plunge=plunge,
        spindle=spindle,
        reason=reason or found.reason,
        stats={"walls": len(walls)},
        progress=share_of(progress, 1, 2),
    )


def _poses(path: PencilPath) -> np.ndarray:
    """Poses of a ball-ended tool along an oriented path; a loop ends where it begins."""
    poses = np.hstack([path.centres - path.radius * path.axes, path.axes])
    return np.concatenate([poses, poses[:1]]) if path.closed else poses
