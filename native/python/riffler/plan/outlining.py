"""Outlines: cuts along a part's silhouette or closed curves, at the cutter's radius."""

from __future__ import annotations

from collections.abc import Sequence
from math import radians

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from .._core import Tool
from ..arguments import Progress, then
from ..hints import hinted
from .operations import Operation, PlannedMoves, operation_of
from .setups import Setup


@hinted("plan.outline")
def outline(
    setup: Setup,
    tool: Tool,
    curves: Sequence[ArrayLike] | None = None,
    depth: float | None = None,
    *,
    inside: bool = False,
    stepdown: float = 2.0,
    tabs: int = 0,
    tab_height: float = 1.0,
    tab_width: float = 4.0,
    allowance: float = 0.0,
    tolerance: float = 0.01,
    slope: float = radians(3),
    climb: bool = True,
    orientation: ArrayLike | None = None,
    feed: float = 1000.0,
    plunge: float | None = None,
    lead: float | None = None,
    spindle: float = 12000.0,
    progress: Progress = None,
) -> Operation:
    """Cuts in layers along the part's silhouette, seen along the axis, or along closed curves.

    The cutter's axis keeps the cutter's radius + ``allowance`` from the outline. Each layer begins with a ramp along
    the loop; the last layer ends with an arc away from the part. Loops in holes are cut before those around the part.

    Parameters
    ----------
    setup : Setup
        Part, in-process stock, fixtures, axis.
    tool : Tool
        A cutter that does not narrow above its widest place.
    curves : list of array_like, shape (k, 3), optional
        Closed curves, seen along the axis. The area inside an odd number of them counts as the part. None: the
        silhouette.
    depth : float, optional
        Depth of the tip below the highest point of part or curves, mm; None: down to the underside of the stock.
    inside : bool
        Whether the tool moves within the curves, as for a pocket, instead of around them.
    stepdown : float
        Height of a layer, mm.
    tabs : int
        Number of bridges that stay along each loop. If fewer fit, the operation leaves as many as fit, and reports it
        in ``report.blocked``.
    tab_height, tab_width : float
        Height of a bridge above the lowest layer, and its length along the loop, mm.
    allowance : float
        Thickness of the material that stays on the part, mm.
    tolerance : float
        Thickness that may stay in addition to the allowance, mm. Never less than the allowance stays.
    slope : float
        Slope of ramps, rad.
    climb : bool
        Whether the part lies to the right of the motion, as it should for a spindle that turns clockwise.
    orientation : array_like, shape (3,), optional
        Unit vector from tip to spindle; by default the set-up's axis. Needs a machine with rotary axes.
    feed : float
        Feed of cuts, mm/min.
    plunge : float, optional
        Feed of leads, mm/min; by default a third of ``feed``.
    lead : float, optional
        Radius of the arcs on which the tool enters and leaves cuts, mm; 0: no arcs. By default half the cutter's
        radius. ``report.stats`` counts ``arcs``, and leads that are ``straight`` because no arc fits.
    spindle : float
        Speed, rev/min; negative: counter-clockwise.
    progress : callable, optional
        Called with the finished share; returning False cancels.

    Returns
    -------
    Operation
        The operation. ``report.blocked`` lists what is left out: holes narrower than the cutter, and stretches where
        part, holder or fixtures obstruct the tool. If there is nothing to cut, it has no poses but a ``reason``.

    Raises
    ------
    ValueError
        An argument is wrong; the message names it.

    Examples
    --------
    >>> part = riffler.Volume.cylinder((15, 15, 2), 10, 4, pitch=0.5, directions="xyz").to_mesh()
    >>> setup = riffler.plan.Setup(part, riffler.Volume.block((0, 0, 0), (30, 30, 4), pitch=0.5))
    >>> op = riffler.plan.outline(setup, riffler.Tool.flat(diameter=4, length=20), tabs=3)
    >>> op.report.stats["loops"], op.report.stats["tabs"]
    (1, 3)
    """
    setup = setup.along(orientation)
    if tabs < 0:
        raise ValueError(f"tabs must not be negative, not {tabs}")
    if depth is not None and not depth > 0:
        raise ValueError(f"depth must be positive, not {depth}")
    if inside and curves is None:
        raise ValueError("inside: needs curves; the silhouette is cut from outside")
    found = _core.outline(
        setup.part,
        setup.obstacles,
        setup.stock,
        tool,
        axis=setup.axis,
        clearance=setup.clearance,
        curves=[] if curves is None else [np.asarray(curve, dtype=float) for curve in curves],
        inside=inside,
        depth=0.0 if depth is None else depth,
        stepdown=stepdown,
        tabs=tabs,
        tab_height=tab_height,
        tab_width=tab_width,
        allowance=allowance,
        tolerance=tolerance,
        slope=slope,
        climb=climb,
        feed=feed,
        plunge=feed / 3 if plunge is None else plunge,
        lead=lead,
        progress=progress,
    )

    def made(moves: PlannedMoves) -> Operation:
        return operation_of(moves, tool, setup.stock.pitch, spindle, tolerance)

    return then(found, made)
