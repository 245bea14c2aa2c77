"""Pencil cuts as an operation of a set-up."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .._core import Collider, Mesh, Tool
from ..arguments import Progress
from ..hints import hinted
from .exact_path import PathFit, fit_path, total_fit
from .locations import cutter_locations
from .operations import Blocked, Operation
from .path_order import order_paths
from .posed import along_poses
from .rest import inside, rest_region
from .setups import FORCE_SPACING, Setup
from .strategies.pencil import pencil
from .upright import joined


@hinted("plan.pencil_operation")
def pencil_operation(
    setup: Setup,
    tool: Tool,
    *,
    tolerance: float = 0.01,
    rest: float | None = None,
    orientation: ArrayLike | None = None,
    feed: float = 800.0,
    plunge: float | None = None,
    spindle: float = 12000.0,
    progress: Progress = None,
    **options: Any,
) -> Operation:
    """Cuts along the valleys of the set-up's part, with the tool along the set-up's axis.

    The paths are those of `pencil`. Where cutter, shank or holder would touch part or fixtures, the tool is lifted; a
    bound over each move proves that it is then clear. Left out, and listed in ``report.blocked``, are places that no
    lift frees, and places where the lift is larger than the cutter's radius, as in valleys on the other side. Leads and
    retracts are proven clear in the same way: where the tool cannot come down along its axis, as under an overhang, it
    comes from the side, or the cut begins elsewhere; a cut that no lead reaches is left out and listed, too.

    If the set-up has an exact surface, the ball's centres are moved until it touches the exact faces on both sides, and
    lifts are those from the exact surface. Fixtures must then be volumes. Points without such a place nearby stay where
    they are on the triangles; ``report.exact`` counts them as ``kept``, and rows that were lifted as ``raised``.

    Parameters
    ----------
    setup : Setup
        Part, in-process stock, fixtures, axis.
    tool : Tool
        A tool whose tip is a ball.
    tolerance : float
        Largest error of the paths, and depth to which cuts may enter the part, mm.
    rest : float, optional
        Cuts only where the stock stands more than this thickness (mm) above the part; see `rest_region`.
    orientation : array_like, shape (3,), optional
        Unit vector from tip to spindle; by default the set-up's axis. Needs a machine with rotary axes.
    feed : float
        Feed of cuts, mm/min.
    plunge : float, optional
        Feed of leads, mm/min; by default a third of ``feed``.
    spindle : float
        Speed, rev/min; negative: counter-clockwise.
    progress : callable, optional
        Called with the finished share; returning False cancels.
    options : keyword arguments
        Further arguments of `pencil`: ``passes``, ``bitangency_angle``, ``minimum_length``, ``stepover``, ``scallop``,
        ``overthickness``, ``reference_tool``.

    Returns
    -------
    Operation
        The operation. If the part has no valley for the ball, it has no poses, and ``reason`` says why.

    Raises
    ------
    ValueError
        An argument is wrong; the message names it.

    Examples
    --------
    >>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
    >>> setup = riffler.plan.Setup(part, riffler.Volume.block(*part.bounds, pitch=0.5))
    >>> op = riffler.plan.pencil_operation(setup, riffler.Tool.ball(diameter=4, length=20), tolerance=0.02)
    >>> op.report.stats["paths"], op.report.cut_mm > 25
    (1, True)
    """
    setup = setup.along(orientation)
    curves = None if rest is None else rest_region(setup, tool, rest)
    found = pencil(setup.part, tool, tolerance=tolerance, progress=progress, **options)
    collider = _collider(setup) if len(found) else None
    blocked, cuts = [], []
    fits: list[PathFit] = []
    raised = 0
    for index, backwards in order_paths(found):
        path = found[index]
        if setup.exact is not None:
            path, fit = fit_path(path, setup.exact, setup.deviation, tolerance)
            fits.append(fit)
        assert collider is not None
        cl, report = cutter_locations(path.orient({0: setup.axis}), tool, collider, tolerance=tolerance)
        blocked += [Blocked(one.reason, path.centres[one.point], 0.0) for one in report.blocked]
        blocked += [Blocked(one.reason, cl[one.row, :3], 0.0) for one in report.unsafe]
        raised += int((report.lift > 0).sum())
        out = report.lift > tool.diameter / 2  # the ball is out of the valley
        if out.any():
            first = cl[int(np.argmax(out)), :3]
            length = float(np.linalg.norm(np.diff(cl[:, :3], axis=0), axis=1)[out[1:]].sum())
            blocked.append(Blocked("the tool does not reach the valley along this axis", first, length))
        wanted = ~out if curves is None else ~out & inside(curves, setup.axis, cl[:, :3])
        after = report.points  # a blocked point has no row: divide the path there
        gaps = [k + 1 for k in range(len(cl) - 1) if any(after[k] < one.point < after[k + 1] for one in report.blocked)]
        ends = sorted({one.row + 1 for one in report.unsafe} | set(gaps) | set(np.flatnonzero(np.diff(wanted)) + 1))
        pieces = [piece for piece in np.split(np.arange(len(cl)), ends) if len(piece) > 1 and wanted[piece[0]]]
        cuts += [cl[piece[::-1]] for piece in pieces[::-1]] if backwards else [cl[piece] for piece in pieces]
    reason = found.reason or (blocked[0].reason if blocked else "there is no valley")
    if rest is not None and found and not blocked:
        reason = f"no valley has more than {rest:g} mm of material"
    return along_poses(
        setup,
        tool,
        cuts,
        tolerance=tolerance,
        max_lift=tolerance,
        feed=feed,
        plunge=plunge,
        spindle=spindle,
        blocked=blocked,
        reason="" if cuts else reason,
        stats={"paths": len(found)},
        exact=None if setup.exact is None else total_fit(fits, raised),
    )


def _collider(setup: Setup) -> Collider:
    """Part and fixtures, for cutter locations: the exact surface if there is one."""
    if setup.exact is None:
        return Collider(joined([setup.part, *setup.obstacles]))
    volumes = [one for one in setup.fixtures if not isinstance(one, Mesh)]
    if len(volumes) < len(setup.fixtures):
        raise ValueError(
            "fixtures: a pencil cut on exact faces needs them as volumes; make them with riffler.Volume.from_mesh"
        )
    return Collider(setup.exact, fixtures=volumes, spacing=FORCE_SPACING)
