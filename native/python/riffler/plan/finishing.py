"""Finishing: rows on the part's offset surface, along one tool axis or along axes that follow a rule."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from .._core import Tool
from ..arguments import Progress, then
from ..hints import hinted
from .axis_rules import MAX_TILT, MAX_TURN, axis_rule, require_rotary, rule_arguments
from .operations import Operation, OperationReport, PlannedMoves, operation_of
from .rest import rest_region
from .setups import Setup

PATTERNS: tuple[str, ...] = tuple(_core.finish_patterns())


@hinted("plan.finish")
def finish(
    setup: Setup,
    tool: Tool,
    pattern: str = "parallel",
    *,
    cusp: float = 0.01,
    tolerance: float = 0.005,
    allowance: float = 0.0,
    angle: float = 0.0,
    slopes: tuple[float, float] = (0.0, pi / 2),
    region: Sequence[ArrayLike] | NDArray[np.generic] | None = None,
    rest: float | None = None,
    reference_tool: Tool | None = None,
    centre: ArrayLike | None = None,
    climb: bool = True,
    orientation: ArrayLike | str | Mapping[str, ArrayLike] | None = None,
    max_tilt: float = MAX_TILT,
    max_turn: float = MAX_TURN,
    feed: float = 1000.0,
    plunge: float | None = None,
    lead: float | None = None,
    spindle: float = 12000.0,
    progress: Progress = None,
) -> Operation:
    """Finishes the part with rows on its offset surface.

    Rows are curves of the exact drop surface of cutter, shank and holder over part and fixtures; a bound, not samples,
    limits the error of the moves between their points. Rows lie as far apart as ``cusp`` allows on level faces, with
    further ones between them where the part is steep or curved, or has a border. Rows end where the tool leaves the
    part: a wall without a floor next to it needs an outline.

    If the set-up has an exact surface, the rows are planned on the triangles and then moved onto the exact surface,
    along the tool's axis or, on steep faces, square to it, and divided until the middle of each move is within the
    tolerance. ``report.exact`` has the distances before and after. Rules for axes that change are then refused.

    Parameters
    ----------
    setup : Setup
        Part, in-process stock, fixtures, axis.
    tool : Tool
        A cutter that does not narrow above its widest place: ball, flat, fillet, taper or a profile like them.
    pattern : str
        "parallel": rows in planes at ``angle``. "waterline": level curves, for faces steeper than 3°. "scallop": rows
        at equal distances on the surface, inwards from the border of the selected faces; up to 74°. "spiral": turns
        about ``centre``. "radial": rays from ``centre``.
    cusp : float
        Largest height of the ridges between rows, mm.
    tolerance : float
        Largest depth of cuts below part + allowance, and largest height of rows above it between their points, mm.
    allowance : float
        Thickness of the material that stays on the part, mm.
    angle : float
        Direction of the rows about the axis, rad.
    slopes : tuple of two floats
        Smallest and largest slope of the faces to finish, rad from level.
    region : list of array_like, shape (k, 3), or array_like of int or bool, optional
        Closed curves, seen along the axis: finishes faces inside an odd number of them. Or indices of the part's
        triangles to finish, or for each triangle whether to finish it. None: all faces.
    rest : float, optional
        Finishes only where the stock stands more than this thickness (mm) above part + allowance and the tool can cut
        it; see `rest_region`. May be combined with a region of triangles.
    reference_tool : Tool, optional
        With ``rest``: takes the rest of a tool that has finished the whole part, instead of the set-up's stock.
    centre : array_like, shape (3,), optional
        Centre of "spiral" and "radial", mm, seen along the axis; by default the middle of the part's box.
    climb : bool
        Whether "waterline" moves with the part on the right. Other patterns begin each row at its nearer end.
    orientation : array_like, str or dict, optional
        By default the set-up's axis. A unit vector (3,) from tip to spindle; or a rule for axes that change along the
        rows: "normal", the part's normal at the contact; (lead, tilt), rad by which the axis leans from the normal
        forward and to the left; ``{"towards": p}`` and ``{"away": p}``, where p is a point (3,) or a curve (k, 3) of
        which the nearest point counts; "least_tilt", the axis nearest to the set-up's along which the tool is free of
        part and fixtures. All need a machine with rotary axes; a rule also needs a cutter with a ball at its tip, and
        leaves out places where the tool is not free.
    max_tilt : float
        Largest angle between the axes of a rule and the set-up's axis, rad, at most 80°. Others are moved there.
    max_turn : float
        Largest change of the axes of a rule along the rows, rad per mm of the ball's path.
    feed : float
        Feed of cuts and links, mm/min.
    plunge : float, optional
        Feed of leads, mm/min; by default a third of ``feed``.
    lead : float, optional
        Radius of the arcs on which the tool enters and leaves cuts, mm; 0: no arcs. By default half the cutter's
        radius. ``report.stats`` counts ``arcs``, and leads that are ``straight`` because no arc fits. With a rule for
        axes, all are straight.
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
    >>> op = riffler.plan.finish(setup, riffler.Tool.ball(diameter=6, length=30), cusp=0.05, angle=0.5)
    >>> op.poses.shape[1], op.reason, op.report.air_mm < op.report.cut_mm
    (6, '', True)
    """
    rule = axis_rule(orientation)
    if rule is None:
        setup = setup.along(orientation)  # type: ignore[arg-type]
    else:
        require_rotary(setup)
        if setup.exact is not None:
            raise ValueError(
                "orientation: rules for axes that change plan on triangles; make the set-up from the part's mesh, "
                "without its exact surface"
            )
    low, high = (float(x) for x in slopes)
    curves, faces = _region_of(region, len(setup.part.triangles))
    if rest is None and reference_tool is not None:
        raise ValueError("reference_tool: needs rest, the thickness of material that may stay, as in rest=0.05")
    if rest is not None:
        if curves:
            raise ValueError("rest: give either rest or curves as region; a region of triangles may be combined")
        curves = rest_region(setup, tool, rest, allowance=allowance, reference_tool=reference_tool)
        if not curves:
            nothing = f"no material thicker than {rest:g} mm stands on the part where the tool reaches"
            return Operation(np.zeros((0, 6)), np.zeros(0, np.uint8), np.zeros(0), tool, OperationReport(), nothing,
                             float(spindle), float(tolerance))  # fmt: skip
    found = _core.finish(
        setup.part,
        setup.obstacles,
        setup.stock,
        tool,
        axis=setup.axis,
        clearance=setup.clearance,
        pattern=pattern,
        cusp=cusp,
        tolerance=tolerance,
        allowance=allowance,
        angle=angle,
        min_slope=low,
        max_slope=high,
        region=curves,
        faces=faces,
        centre=centre,
        climb=climb,
        feed=feed,
        plunge=feed / 3 if plunge is None else plunge,
        lead=lead,
        **rule_arguments(rule, max_tilt, max_turn),
        exact=setup.exact_collider,
        deviation=setup.deviation,
        progress=progress,
    )

    def made(moves: PlannedMoves) -> Operation:
        return operation_of(moves, tool, setup.stock.pitch, spindle, tolerance)

    return then(found, made)


def _region_of(
    region: Sequence[ArrayLike] | NDArray[np.generic] | None, triangles: int
) -> tuple[list[NDArray[np.float64]], list[int]]:
    """The closed curves and the indices of triangles of a region, which has one or the other."""
    if region is None or not len(region):
        return [], []
    if np.ndim(region[0]):
        return [np.asarray(curve, dtype=float) for curve in region], []
    numbers = np.asarray(region)
    if numbers.dtype == bool:
        if numbers.size != triangles:
            raise ValueError(f"region: {numbers.size} marks, and the part has {triangles} triangles")
        numbers = np.flatnonzero(numbers)
    if numbers.ndim != 1 or not np.issubdtype(numbers.dtype, np.integer):
        raise ValueError("region must be closed curves (k, 3), numbers of triangles, or a mark for each of them")
    if not numbers.size:
        raise ValueError("region: no triangle is marked")
    return [], numbers.tolist()
