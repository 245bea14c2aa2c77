"""Programs of several operations: tool changes, turns between two tool axes, and the check by simulation."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import acos, ceil, cos, radians

import numpy as np
from numpy.typing import NDArray

from .. import _core
from .._core import Finding, Program, Tool
from ..arguments import Progress
from ..hints import hinted
from .operations import RAPID, Operation
from .setups import GREATER, ROUNDING, Setup

TURN = radians(10)  # largest angle between two rows of a turn


@dataclass(frozen=True, eq=False)
class _Rows:
    """Rows of a program. ``before``: index of the operation that they belong to, or that they follow."""

    before: int
    poses: NDArray[np.float64]
    feed: NDArray[np.float64]
    rapid: NDArray[np.bool_]
    tool: int
    spindle: float
    turn: bool = False


@hinted("plan.program")
def program(
    setup: Setup,
    operations: Iterable[Operation],
    *,
    numbers: Sequence[int] | None = None,
    progress: Progress = None,
) -> Program:
    """One program of several operations, with tool changes between them on the clearance plane.

    Between two operations with different tool axes, the tool moves out along its axis until it is outside of a ball
    around part, stock and fixtures, turns there, and comes back along the new axis.

    The program is simulated on the stock before its first operation. A fault is an error, and no program
    is returned: a rapid that meets material, shank or holder in stock, the tool in a fixture, a gouge beyond the
    tolerance of the operations. Gouges are measured on the part's triangles; if the set-up has an exact surface, they
    may be deeper by 1.5 times the distance of the triangles from it.

    Parameters
    ----------
    setup : Setup
        The set-up of the operations.
    operations : list of Operation
        In the order in which they run. Those without poses are left out.
    numbers : list of int, optional
        The machine's number of each operation's tool; by default tools are numbered from 1 in order of use.
    progress : callable, optional
        Called with the finished share; returning False cancels.

    Returns
    -------
    Program
        Its zero is the set-up's ``origin``.

    Raises
    ------
    ValueError
        Naming the operation, its row and the place of the first collision, or that no operation has poses.

    Examples
    --------
    >>> part = riffler.shape.relief([[0.3, 1.0], [0.6, 0.3]], size=(20, 20), depth=10)
    >>> setup = riffler.plan.Setup(part, riffler.Volume.block((0, 0, 0), (20, 20, 12), pitch=0.5))
    >>> op = riffler.plan.finish(setup, riffler.Tool.ball(diameter=6, length=30), cusp=0.1, feed=800)
    >>> program = riffler.plan.program(setup, [op])
    >>> len(program) == len(op)
    True
    """
    planned = list(operations)
    chosen = [k for k, op in enumerate(planned) if len(op)]
    if not chosen:
        reasons = "; ".join(op.reason for op in planned if op.reason)
        raise ValueError("operations: none has poses" + (f": {reasons}" if reasons else ""))
    tools: dict[int, Tool] = {}
    called = dict(zip(chosen, _called(planned, numbers, tools), strict=True))
    parts = _with_turns(setup, planned, called)
    poses = np.concatenate([part.poses for part in parts])
    feed = np.concatenate([part.feed for part in parts])
    rest = {
        "rapid": np.concatenate([part.rapid for part in parts]),
        "tool": np.concatenate([np.full(len(part.poses), part.tool) for part in parts]),
        "spindle": np.concatenate([np.full(len(part.poses), part.spindle) for part in parts]),
        "tools": tools,
    }
    tolerance = max(planned[k].tolerance for k in chosen)
    report = _core.verify(
        Program(poses, feed, **rest),
        setup.stock_before(planned[chosen[0]]),
        setup.part,
        setup.obstacles,
        tolerance=tolerance,
        gouge_tolerance=tolerance + ROUNDING + GREATER * setup.deviation,
        progress=progress,
    )
    findings = [found for found in report.findings if not _meant(found, parts, planned, tolerance)]
    if findings:
        first = findings[0]
        at = ", ".join(f"{x:.3f}" for x in first.point)
        raise ValueError(f"{_place(parts, first.row)}, at ({at}): {first.message}")
    return Program(poses - np.concatenate([setup.origin, np.zeros(3)]), feed, **rest)


def _with_turns(setup: Setup, planned: Sequence[Operation], called: dict[int, int]) -> list[_Rows]:
    """The rows of the operations that have a number in ``called``, and of the turns between them."""
    out: list[_Rows] = []
    for k, number in called.items():
        op = planned[k]
        if out:
            last = out[-1]
            turn = turn_between(setup, last.poses[-1, 3:], op.poses[0, 3:])
            if len(turn):
                count = len(turn)
                out.append(
                    _Rows(last.before, turn, np.zeros(count), np.ones(count, bool), last.tool, last.spindle, True)
                )
        out.append(_Rows(k, op.poses, op.feed, op.kind == RAPID, number, op.spindle))
    return out


def turn_between(setup: Setup, before: NDArray[np.float64], after: NDArray[np.float64]) -> NDArray[np.float64]:
    """Poses (n, 6) that turn the tool from one axis to another, outside of a ball around part, stock and fixtures with
    the set-up's clearance. Empty if both axes are equal.

    A tool whose tip is at height h along its own axis above the ball's centre lies entirely above that height, so no
    pose with h at least the ball's radius touches anything, for any length and width of the tool.
    """
    angle = acos(float(np.clip(before @ after, -1, 1)))
    if np.linalg.norm(before - after) < 1e-9:
        return np.zeros((0, 6))
    centre, radius = _ball_around(setup)
    steps = max(1, ceil(angle / TURN))
    # Between two rows the tip moves on a chord, which is lower in its middle.
    height = (radius + setup.clearance) / cos(angle / steps / 2)
    side = after - (before @ after) * before
    if np.linalg.norm(side) < 1e-6:  # opposite axes: turn over the upper side, or over any side if both are upright
        up = np.array([0.0, 0.0, 1.0]) if abs(before[2]) < 0.9 else np.array([0.0, -1.0, 0.0])
        side = up - (before @ up) * before
    side /= np.linalg.norm(side)
    turned = angle * np.arange(steps + 1)[:, None] / steps
    axes = np.cos(turned) * before + np.sin(turned) * side
    axes[-1] = after
    return np.hstack([centre + height * axes, axes])


def _ball_around(setup: Setup) -> tuple[NDArray[np.float64], float]:
    """Centre and radius of a ball around part, stock and fixtures."""
    lower, upper = setup.stock.lower, setup.stock.upper
    corners = [np.array([(lower, upper)[i][0], (lower, upper)[j][1], (lower, upper)[k][2]])
               for i in (0, 1) for j in (0, 1) for k in (0, 1)]  # fmt: skip
    points = np.concatenate([corners, *(mesh.vertices for mesh in (setup.part, *setup.obstacles))])
    centre = 0.5 * (points.min(axis=0) + points.max(axis=0))
    return centre, float(np.linalg.norm(points - centre, axis=1).max())


def _meant(found: Finding, parts: Sequence[_Rows], planned: Sequence[Operation], tolerance: float) -> bool:
    """Whether a finding is the depth of engraving, in rows of operations that engrave."""
    if found.kind != "gouge":
        return False
    ops = [planned[_part_of(parts, row)[0].before] for row in (found.row, found.last_row)]
    return found.value <= tolerance + min(op.engraved for op in ops) + ROUNDING


def _part_of(parts: Sequence[_Rows], row: int) -> tuple[_Rows, int]:
    """The part of a program that has a row, and the row's number in it."""
    for part in parts:
        if row < len(part.poses):
            return part, row
        row -= len(part.poses)
    raise AssertionError("a row beyond the program")


def _place(parts: Sequence[_Rows], row: int) -> str:
    """The operation and the row in it of a row of the program."""
    part, row = _part_of(parts, row)
    turn = ", the turn after it" if part.turn else ""
    return f"operations[{part.before}]{turn}, row {row}"


def _called(planned: Sequence[Operation], numbers: Sequence[int] | None, tools: dict[int, Tool]) -> list[int]:
    """The tool numbers of the operations that have poses. Adds their tools to ``tools``."""
    if numbers is None:
        return [_number(op.tool, tools) for op in planned if len(op)]
    if len(numbers) != len(planned):
        raise ValueError(f"numbers: {len(numbers)} for {len(planned)} operations; give one for each")
    for k, (op, number) in enumerate(zip(planned, numbers, strict=True)):
        if number < 1:
            raise ValueError(f"numbers[{k}] must be a tool number from 1, not {number}")
        if len(op) and tools.setdefault(number, op.tool).to_dict() != op.tool.to_dict():
            raise ValueError(f"numbers[{k}]: tool {number} has another shape in an operation before")
    return [number for op, number in zip(planned, numbers, strict=True) if len(op)]


def _number(tool: Tool, tools: dict[int, Tool]) -> int:
    """The number of a tool in the program; equal tools share a number."""
    form = tool.to_dict()
    for number, known in tools.items():
        if known.to_dict() == form:
            return number
    tools[len(tools) + 1] = tool
    return len(tools)
