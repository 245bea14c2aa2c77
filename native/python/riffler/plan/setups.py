"""Set-ups: part, stock, fixtures and tool axis, for planning operations in order."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from copy import copy
from math import isfinite

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from .._core import Mesh, Program, Tool, Volume
from ..arguments import Progress
from ..hints import hinted
from .operations import RAPID, Operation

UPRIGHT = (0.0, 0.0, 1.0)
ROUNDING = 1e-3  # mm by which a verified gouge may exceed the operation's tolerance, for rounding


class Setup:
    """A part in its stock on the machine, for planning operations.

    Parameters
    ----------
    part : Mesh
        The part.
    stock : Volume
        The material before the first operation, in the part's frame; its rays run along the axis, or in all three
        directions ("xyz"). It is not changed.
    fixtures : list of Volume or Mesh
        Bodies that the tool must stay clear of.
    axis : array_like, shape (3,)
        Unit vector from tip to spindle.
    clearance : float
        Height of the rapids across, mm above part, stock and fixtures along the axis.
    machine : str
        One of ``riffler.machines()``. A machine of three axes needs the axis (0, 0, 1).
    origin : array_like, shape (3,)
        Zero of the program, mm.

    Raises
    ------
    ValueError
        Naming the misfit: a stock smaller than the part or in another place, an axis that the machine lacks.

    Examples
    --------
    >>> part = riffler.shape.relief([[0.3, 1.0], [0.6, 0.3]], size=(20, 20), depth=10)
    >>> stock = riffler.Volume.block((0, 0, 0), (20, 20, 12), pitch=0.5)
    >>> setup = riffler.plan.Setup(part, stock)
    >>> setup.clearance, setup.machine
    (5.0, '3-axis')
    """

    def __init__(
        self,
        part: Mesh,
        stock: Volume,
        fixtures: Sequence[Volume | Mesh] = (),
        axis: ArrayLike = UPRIGHT,
        clearance: float = 5.0,
        machine: str = "3-axis",
        origin: ArrayLike = (0.0, 0.0, 0.0),
    ) -> None:
        self.part, self.fixtures = part, tuple(fixtures)
        self.axis, self.origin = _vector(axis, "axis"), _vector(origin, "origin")
        if abs(np.linalg.norm(self.axis) - 1) > 1e-6:
            raise ValueError(f"axis must be a unit vector, not {self.axis.tolist()}")
        self.clearance, self.machine = float(clearance), machine
        if not (isfinite(self.clearance) and self.clearance > 0):
            raise ValueError(f"clearance must be positive and finite, not {clearance}")
        if machine not in _core.machines():
            raise ValueError(f"machine must be one of {', '.join(_core.machines())}, not {machine!r}")
        if machine == "3-axis" and tuple(self.axis) != UPRIGHT:
            raise ValueError(
                f"axis {self.axis.tolist()}: machine 3-axis holds the tool along z; turn part and stock so that the "
                "axis is (0, 0, 1), or name a machine with rotary axes"
            )
        _check_stock(part, stock, self.axis)
        self._stock = copy(stock)
        self._before: list[tuple[Operation, Volume]] = []
        self._obstacles = [one.to_mesh() if isinstance(one, Volume) else one for one in self.fixtures]

    @property
    def stock(self) -> Volume:
        """The stock after the applied operations.

        Examples
        --------
        >>> part = riffler.shape.relief([[0.3, 1.0], [0.6, 0.3]], size=(20, 20), depth=10)
        >>> setup = riffler.plan.Setup(part, riffler.Volume.block((0, 0, 0), (20, 20, 12), pitch=0.5))
        >>> round(setup.stock.volume)
        4800
        """
        return self._stock

    @property
    def obstacles(self) -> list[Mesh]:
        """The fixtures as meshes."""
        return list(self._obstacles)

    def apply(self, op: Operation, progress: Progress = None) -> None:
        """Carves the stock with an operation; the next operation is planned on the result.

        Parameters
        ----------
        op : Operation
            An operation of this set-up. An operation without poses changes nothing.
        progress : callable, optional
            Called with the finished share; returning False cancels, and the stock is unchanged.

        Examples
        --------
        >>> part = riffler.shape.relief([[0.3, 1.0], [0.6, 0.3]], size=(20, 20), depth=10)
        >>> setup = riffler.plan.Setup(part, riffler.Volume.block((0, 0, 0), (20, 20, 12), pitch=0.5))
        >>> setup.apply(riffler.plan.finish(setup, riffler.Tool.ball(diameter=6, length=30), cusp=0.1))
        >>> setup.stock.volume < 4800
        True
        """
        after = copy(self._stock)
        if len(op):
            after.carve(op.tool, op.poses, progress=progress)
        self._before.append((op, self._stock))
        self._stock = after

    def stock_before(self, op: Operation) -> Volume:
        """The stock before an operation: the stock when ``op`` was applied, or the present one if it was not.

        Parameters
        ----------
        op : Operation
            An operation of this set-up.

        Returns
        -------
        Volume

        Examples
        --------
        >>> part = riffler.shape.relief([[0.3, 1.0], [0.6, 0.3]], size=(20, 20), depth=10)
        >>> setup = riffler.plan.Setup(part, riffler.Volume.block((0, 0, 0), (20, 20, 12), pitch=0.5))
        >>> op = riffler.plan.finish(setup, riffler.Tool.ball(diameter=6, length=30), cusp=0.1)
        >>> setup.apply(op)
        >>> round(setup.stock_before(op).volume)
        4800
        """
        return next((stock for one, stock in self._before if one is op), self._stock)


def _vector(values: ArrayLike, name: str) -> NDArray[np.float64]:
    out = np.array(values, dtype=float)
    if out.shape != (3,) or not np.all(np.isfinite(out)):
        raise ValueError(f"{name} must be three finite numbers")
    return out


def _check_stock(part: Mesh, stock: Volume, axis: NDArray[np.float64]) -> None:
    if len(stock.directions) == 1 and abs(axis["xyz".index(stock.directions)]) < 1 - 1e-9:
        raise ValueError(
            f"stock: its rays run along {stock.directions}, the axis is {axis.tolist()}; make it with directions 'xyz'"
        )
    if not len(part.triangles):
        raise ValueError("part: it has no triangles")
    (lower, upper), (low, high) = part.bounds, (stock.lower, stock.upper)
    for k, name in enumerate("xyz"):
        if lower[k] > high[k] or upper[k] < low[k]:
            raise ValueError(
                f"part: outside of the stock, {name} from {lower[k]:g} to {upper[k]:g} mm, and the stock from "
                f"{low[k]:g} to {high[k]:g} mm; bring both into one frame"
            )
        if lower[k] < low[k] - stock.pitch or upper[k] > high[k] + stock.pitch:
            raise ValueError(
                f"stock: smaller than the part, {name} from {low[k]:g} to {high[k]:g} mm, and the part from "
                f"{lower[k]:g} to {upper[k]:g} mm"
            )


@hinted("plan.program")
def program(
    setup: Setup,
    operations: Iterable[Operation],
    *,
    numbers: Sequence[int] | None = None,
    progress: Progress = None,
) -> Program:
    """One program of several operations, with tool changes between them on the clearance plane.

    The program is simulated on the stock before its first operation. A fault is an error, and no program
    is returned: a rapid that meets material, shank or holder in stock, the tool in a fixture, a gouge beyond the
    tolerance of the operations.

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
    chosen = [op for op in planned if len(op)]
    if not chosen:
        reasons = "; ".join(op.reason for op in planned if op.reason)
        raise ValueError("operations: none has poses" + (f": {reasons}" if reasons else ""))
    tools: dict[int, Tool] = {}
    called = _called(planned, numbers, tools)
    poses = np.concatenate([op.poses for op in chosen])
    rest = {
        "rapid": np.concatenate([op.kind == RAPID for op in chosen]),
        "tool": np.concatenate([np.full(len(op), n) for op, n in zip(chosen, called, strict=True)]),
        "spindle": np.concatenate([np.full(len(op), op.spindle) for op in chosen]),
        "tools": tools,
    }
    feed = np.concatenate([op.feed for op in chosen])
    tolerance = max(op.tolerance for op in chosen)
    report = _core.verify(
        Program(poses, feed, **rest),
        setup.stock_before(chosen[0]),
        setup.part,
        setup.obstacles,
        tolerance=tolerance,
        gouge_tolerance=tolerance + ROUNDING,
        progress=progress,
    )
    if report.findings:
        first = report.findings[0]
        ends = np.cumsum([len(op) for op in chosen])
        index = int(np.searchsorted(ends, first.row, side="right"))
        row = first.row - (int(ends[index - 1]) if index else 0)
        at = ", ".join(f"{x:.3f}" for x in first.point)
        raise ValueError(f"operations[{planned.index(chosen[index])}], row {row}, at ({at}): {first.message}")
    return Program(poses - np.concatenate([setup.origin, np.zeros(3)]), feed, **rest)


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
