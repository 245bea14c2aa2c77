"""Set-ups: part, stock, fixtures and tool axis, for planning operations in order."""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from math import isfinite

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from .._core import Collider, Mesh, Surface, Volume
from ..arguments import Progress
from ..cad.part import CadPart
from .operations import Operation

UPRIGHT = (0.0, 0.0, 1.0)
ROUNDING = 1e-3  # mm by which a verified gouge may exceed the operation's tolerance, for rounding

FORCE_SPACING = 10.0  # mm: no force is asked of the exact collider
SAMPLES = 300  # triangles at which the distance of the part from its exact surface is measured
GREATER = 1.5  # factor on the deviation of triangles from the exact surface, which is measured, not proven
FARTHEST = 0.02  # of the part's size: triangles further away belong to another surface


class Setup:
    """A part in its stock on the machine, for planning operations.

    Parameters
    ----------
    part : Mesh or CadPart
        The part. One of ``riffler.cad.read(path, exact=True)`` brings its exact surface.
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
    exact : Surface, optional
        The exact surface that the part's triangles approximate; its normals point out of the material. `finish` and
        `pencil_operation` then take contacts from it, so that their error does not depend on the triangles.

    Raises
    ------
    ValueError
        Naming the misfit: an exact surface that is not where the triangles are, a stock smaller than the part or in
        another place, an axis that the machine lacks.

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
        part: Mesh | CadPart,
        stock: Volume,
        fixtures: Sequence[Volume | Mesh] = (),
        axis: ArrayLike = UPRIGHT,
        clearance: float = 5.0,
        machine: str = "3-axis",
        origin: ArrayLike = (0.0, 0.0, 0.0),
        *,
        exact: Surface | None = None,
    ) -> None:
        deviation = None
        if isinstance(part, CadPart):
            if exact is None:
                exact, deviation = part.surface, part.report.deviation
            part = part.mesh
        self.part, self.fixtures = part, tuple(fixtures)
        self.axis, self.origin = _unit(axis, "axis"), _vector(origin, "origin")
        self.clearance, self.machine = float(clearance), machine
        if not (isfinite(self.clearance) and self.clearance > 0):
            raise ValueError(f"clearance must be positive and finite, not {clearance}")
        if machine not in _core.machines():
            raise ValueError(f"machine must be one of {', '.join(_core.machines())}, not {machine!r}")
        _check_axis(machine, stock, self.axis, "axis")
        _check_stock(part, stock)
        self._stock = copy(stock)
        self._before: list[tuple[Operation, Volume]] = []
        self.exact = exact
        self.deviation = 0.0
        if exact is not None:
            self.deviation = deviation_of(part, exact) if deviation is None else deviation
        self._collider: Collider | None = None
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

    @property
    def exact_collider(self) -> Collider | None:
        """The exact surface, prepared for distances of tools; None without one."""
        if self._collider is None and self.exact is not None:
            self._collider = Collider(self.exact, spacing=FORCE_SPACING)
        return self._collider

    def along(self, orientation: ArrayLike | None) -> Setup:
        """This set-up with the tool along another direction, on the stock in its present state.

        Parameters
        ----------
        orientation : array_like, shape (3,), or None
            Unit vector from tip to spindle. None: the set-up's axis.

        Returns
        -------
        Setup

        Raises
        ------
        ValueError
            The machine cannot hold the tool there, or the stock has no rays for it.

        Examples
        --------
        >>> part = riffler.shape.relief([[0.3, 1.0], [0.6, 0.3]], size=(20, 20), depth=10)
        >>> stock = riffler.Volume.block((0, 0, 0), (20, 20, 12), pitch=0.5, directions="xyz")
        >>> setup = riffler.plan.Setup(part, stock, machine="tcp")
        >>> setup.along((0, -0.6, 0.8)).axis.tolist()
        [0.0, -0.6, 0.8]
        """
        if orientation is None:
            return self
        if isinstance(orientation, (str, dict)) or np.shape(orientation) != (3,):
            raise ValueError(
                f"orientation must be a direction, three numbers from tip to spindle, not {orientation!r}; plan.finish "
                "and plan.engrave_operation also take rules for axes that change"
            )
        out = copy(self)
        out.axis = _unit(orientation, "orientation")
        _check_axis(self.machine, self._stock, out.axis, "orientation")
        return out

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


def _unit(values: ArrayLike, name: str) -> NDArray[np.float64]:
    out = _vector(values, name)
    if abs(np.linalg.norm(out) - 1) > 1e-6:
        raise ValueError(f"{name} must be a unit vector, not {out.tolist()}")
    return out


def deviation_of(part: Mesh, exact: Surface) -> float:
    """Largest distance of the part's triangles from the exact surface, mm, at their middles, corners and the middles of
    their sides. ValueError if they are not of the same part."""
    rows = np.asarray(part.triangles)
    corners = np.asarray(part.vertices)[rows[:: max(1, len(rows) // SAMPLES)]]
    weights = np.array([(1, 1, 1), (1, 1, 0), (0, 1, 1), (1, 0, 1), (1, 0, 0)])
    points = np.concatenate([np.einsum("j,kji->ki", w / w.sum(), corners) for w in weights])
    far = float(exact.closest(points)[2].max())
    lower, upper = part.bounds
    if far > FARTHEST * float(np.linalg.norm(upper - lower)):
        raise ValueError(
            f"exact: the part's triangles are up to {far:.3g} mm from this surface; give the surface of the same part, "
            "in the same place and in mm"
        )
    return far


def _check_axis(machine: str, stock: Volume, axis: NDArray[np.float64], name: str) -> None:
    if machine == "3-axis" and tuple(axis) != UPRIGHT:
        raise ValueError(
            f"{name} {axis.tolist()}: machine 3-axis holds the tool along z; turn part and stock so that the "
            f"{name} is (0, 0, 1), or name a machine with rotary axes"
        )
    if len(stock.directions) == 1 and abs(axis["xyz".index(stock.directions)]) < 1 - 1e-9:
        raise ValueError(
            f"stock: its rays run along {stock.directions}, the {name} is {axis.tolist()}; make it with directions "
            "'xyz'"
        )


def _check_stock(part: Mesh, stock: Volume) -> None:
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
