"""Roughing: the stock cleared in layers, with a bounded width of cut."""

from __future__ import annotations

from math import radians

from numpy.typing import ArrayLike

from .. import _core
from .._core import Tool
from ..arguments import Progress, then
from ..hints import hinted
from .operations import Operation, PlannedMoves, operation_of
from .setups import Setup


@hinted("plan.rough")
def rough(
    setup: Setup,
    tool: Tool,
    *,
    stepdown: float = 2.0,
    depth: float | None = None,
    engagement: float = 0.4,
    allowance: float = 0.3,
    tolerance: float = 0.05,
    slope: float = radians(3),
    climb: bool = True,
    orientation: ArrayLike | None = None,
    feed: float = 1200.0,
    plunge: float | None = None,
    spindle: float = 12000.0,
    progress: Progress = None,
) -> Operation:
    """Clears the set-up's stock in layers, wherever the whole tool stays clear of part and fixtures.

    Each layer is cleared outwards, from its open side, from a helix or from a ramp to and fro. Each ring goes one step
    further than the one before, so that no cut is wider than ``engagement``, corners included. A pass along the border
    of the reachable region ends the layer. The tool moves to the next pass through the cleared region where that is
    quicker than over the clearance plane. Regions that an earlier operation has cleared are not cut again.
    ``report.blocked`` names the regions that are too narrow for the tool, or for a ramp; they are left out.

    Parameters
    ----------
    setup : Setup
        Part, stock left so far, fixtures, axis.
    tool : Tool
        A cutter that does not narrow above its widest place: flat, fillet, ball, taper or a profile like them.
    stepdown : float
        Height of a layer, mm.
    depth : float, optional
        Depth of the lowest layer below the part's highest point along the axis, mm, as for the first of two sides;
        None: down to the underside of part or stock.
    engagement : float
        Largest width of cut as a share of the cutter's diameter, from 0.02 to 1. Moves that cut wider, as where
        the tool enters a narrow slot, are leads, at ``plunge``.
    allowance : float
        Thickness of the material that stays on the part, mm.
    tolerance : float
        Largest error of curves, mm. Up to half of it stays in addition to ``allowance``.
    slope : float
        Slope of helices and ramps, rad, from 0.001.
    climb : bool
        Whether material lies to the right of the motion, as it should for a spindle that turns clockwise.
    orientation : array_like, shape (3,), optional
        Unit vector from tip to spindle; by default the set-up's axis. Needs a machine with rotary axes.
    feed : float
        Feed of cuts and links, mm/min.
    plunge : float, optional
        Feed of leads, mm/min; by default a third of ``feed``.
    spindle : float
        Speed, rev/min; negative: counter-clockwise.
    progress : callable, optional
        Called with the finished share; returning False cancels.

    Returns
    -------
    Operation
        The operation; without poses, and with a reason, if the tool reaches nothing.

    Raises
    ------
    ValueError
        An argument is wrong; the message names it.

    Examples
    --------
    >>> part = riffler.shape.relief([[0.3, 1.0], [0.6, 0.3]], size=(20, 20), depth=10)
    >>> setup = riffler.plan.Setup(part, riffler.Volume.block((0, 0, 0), (20, 20, 12), pitch=0.5))
    >>> op = riffler.plan.rough(setup, riffler.Tool.flat(diameter=6, length=20), stepdown=2)
    >>> op.report.largest_engagement <= 0.4
    True
    """
    setup = setup.along(orientation)
    if depth is not None and not depth > 0:
        raise ValueError(f"depth must be positive, not {depth}")
    found = _core.rough(
        setup.part,
        setup.obstacles,
        setup.stock,
        tool,
        axis=setup.axis,
        clearance=setup.clearance,
        stepdown=stepdown,
        engagement=engagement,
        allowance=allowance,
        tolerance=tolerance,
        slope=slope,
        climb=climb,
        feed=feed,
        plunge=feed / 3 if plunge is None else plunge,
        depth=0.0 if depth is None else depth,
        progress=progress,
    )

    def made(moves: PlannedMoves) -> Operation:
        return operation_of(moves, tool, setup.stock.pitch, spindle, tolerance)

    return then(found, made)
