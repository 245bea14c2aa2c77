"""Drills holes along the axis of a set-up."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from .._core import Collider, Tool
from ..arguments import Progress
from ..hints import hinted
from .operations import CUT, RAPID, Blocked, Operation
from .setups import Setup
from .upright import ABOVE, Moves, stock_tops

BACK = 0.5  # mm above the last peck: where a rapid back into the hole ends


@hinted("plan.drill")
def drill(
    setup: Setup,
    tool: Tool,
    points: ArrayLike,
    depth: ArrayLike,
    peck: float | None = None,
    *,
    tolerance: float = 0.05,
    orientation: ArrayLike | None = None,
    feed: float = 200.0,
    spindle: float = 3000.0,
    progress: Progress = None,
) -> Operation:
    """Drills holes along the set-up's axis, in the order of the points.

    A hole is left out, and reported by name, if the drill would enter the part, if shank or holder would touch the
    part, if these would touch the stock by then, if the tool would touch a fixture, or if there is no stock.

    Parameters
    ----------
    setup : Setup
        Part, in-process stock, fixtures, axis.
    tool : Tool
        A drill, or another cutter that can plunge into full material.
    points : array_like, shape (n, 3)
        Mouths (upper ends) of the holes, mm.
    depth : float or array_like, shape (n,)
        Depth of the tip below the mouth, mm.
    peck : float, optional
        Depth of a peck, mm; the drill leaves the hole after each peck. None: each hole in one move.
    tolerance : float
        Depth to which the drill may enter the part, mm; more than 0, because a hole of flat facets is narrower than a
        round hole.
    orientation : array_like, shape (3,), optional
        Unit vector from tip to spindle; by default the set-up's axis. Needs a machine with rotary axes.
    feed : float
        Feed of the drill, mm/min.
    spindle : float
        Speed, rev/min; negative: counter-clockwise.
    progress : callable, optional
        Called with the finished share; returning False cancels.

    Returns
    -------
    Operation
        The operation. ``report.blocked`` lists the holes that are left out. If all are, it has no poses, and ``reason``
        says why.

    Raises
    ------
    ValueError
        An argument or a point is wrong; the message names it.

    Examples
    --------
    >>> part = riffler.Volume.block((0, 0, 0), (20, 20, 8), pitch=0.25, directions="xyz")
    >>> bit = riffler.Tool.flat(diameter=5, length=30)
    >>> _ = part.carve(bit, [(10, 10, 20, 0, 0, 1), (10, 10, 0, 0, 0, 1)])
    >>> setup = riffler.plan.Setup(part.to_mesh(), riffler.Volume.block((0, 0, 0), (20, 20, 8), pitch=0.25))
    >>> op = riffler.plan.drill(setup, bit, [(10, 10, 8), (4, 4, 8)], depth=8, peck=3)
    >>> op.report.stats["holes"], op.report.blocked[0].reason
    (1, 'points[1]: the cutter would enter the part by 2.500 mm')
    """
    setup = setup.along(orientation)
    _core.require_revolved(tool, "plan.drill")
    places = np.asarray(points, dtype=float).reshape(-1, 3) if np.size(points) else np.zeros((0, 3))
    if not np.isfinite(places).all():
        raise ValueError(f"points[{int(np.argmin(np.isfinite(places).all(axis=1)))}] is not finite")
    depths = np.asarray(depth, dtype=float)
    if depths.ndim and depths.shape != (len(places),):
        raise ValueError(f"depth must be one number or one for each of {len(places)} points")
    depths = np.broadcast_to(depths, len(places))
    if not (np.isfinite(depths) & (depths > 0)).all():
        raise ValueError(f"depth must be positive and finite, not {depth}")
    for name, value in (("peck", peck), ("tolerance", tolerance), ("feed", feed)):
        if value is not None and not (math.isfinite(value) and value > 0):
            raise ValueError(f"{name} must be positive and finite, not {value}")
    bottoms = places - depths[:, None] * setup.axis
    reasons = _reasons(setup, tool, bottoms, tolerance)
    tops = stock_tops(setup, tool, places)
    moves = Moves(setup, feed, feed)
    blocked: list[Blocked] = []
    drilled: dict[int, int] = {}
    for k, (tip, reason, top) in enumerate(zip(bottoms, reasons, tops, strict=True)):
        low = float(tip @ setup.axis)
        if not reason and not top - setup.stock.pitch > low:
            reason = "no stock stands there"
        if reason:
            blocked.append(Blocked(f"points[{k}]: {reason}", tip, float(depths[k])))
            continue
        steps = 1 if peck is None else max(1, math.ceil((top - low) / peck - 1e-9))
        drilled[k] = steps
        above = min(top + ABOVE, moves.plane)
        moves.to(moves.at(tip, moves.plane), RAPID)
        moves.to(moves.at(tip, above), RAPID)
        for step in range(1, steps + 1):
            moves.to(moves.at(tip, low if step == steps else top - step * (peck or 0.0)), CUT)
            if step < steps:
                moves.to(moves.at(tip, above), RAPID)
                moves.to(moves.at(tip, min(above, top - step * (peck or 0.0) + BACK)), RAPID)
        moves.retract()
    reason = blocked[0].reason if blocked else "there are no points"
    op = moves.operation(tool, blocked, reason, {}, spindle, tolerance, progress)
    return _counted(op, setup, bottoms, depths, drilled, len(blocked))


def _counted(
    op: Operation, setup: Setup, bottoms: np.ndarray, depths: np.ndarray, drilled: dict[int, int], known: int
) -> Operation:
    """The operation with its counts, and with the names of the points that it leaves out after the ``known`` ones.
    ``drilled``: the number of pecks at each of the points."""
    blocked = list(op.report.blocked[:known])
    for one in op.report.blocked[known:]:
        off = bottoms[list(drilled)] - one.place
        off -= np.outer(off @ setup.axis, setup.axis)
        k = list(drilled)[int(np.argmin(np.linalg.norm(off, axis=1)))]
        del drilled[k]
        blocked.append(Blocked(f"points[{k}]: {one.reason}", bottoms[k], float(depths[k])))
    stats = {"holes": len(drilled), "pecks": sum(drilled.values())}
    reason = "" if len(op) else (blocked[0].reason if blocked else op.reason)
    return replace(op, report=replace(op.report, blocked=tuple(blocked), stats=stats), reason=reason)


def _reasons(setup: Setup, tool: Tool, bottoms: np.ndarray, tolerance: float) -> list[str]:
    """For each tip, why the tool must not be there; empty if it may."""
    poses = np.hstack([bottoms, np.tile(setup.axis, (len(bottoms), 1))])
    out = [""] * len(bottoms)
    if not len(bottoms):
        return out
    for mesh, whose in [(setup.part, "the part"), *((mesh, "a fixture") for mesh in setup.obstacles)]:
        collider = Collider(mesh)
        for k in np.flatnonzero(collider.clearance(tool, poses) < -tolerance):
            near = collider.nearest(tool, poses[k])
            out[k] = out[k] or f"the {near.part} would enter {whose} by {-near.distance:.3f} mm"
    return out
