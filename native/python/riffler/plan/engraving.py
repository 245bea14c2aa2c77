"""Engraving as an operation of a set-up."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import Tool
from ..arguments import Progress
from ..hints import hinted
from .axis_rules import axis_rule, require_rotary
from .locations import contact_locations
from .operations import Blocked, Operation
from .posed import along_poses
from .setups import Setup
from .strategies.engrave import Engraved, engrave

FACING = 0.05  # smallest cosine between the surface's normal and the tool's axis


@hinted("plan.engrave_operation")
def engrave_operation(
    setup: Setup,
    tool: Tool,
    curves: Sequence[ArrayLike],
    *,
    depth: float = 0.3,
    orientation: ArrayLike | str | Mapping[str, ArrayLike] | None = None,
    tolerance: float = 0.01,
    reach: float = 10.0,
    feed: float = 500.0,
    plunge: float | None = None,
    spindle: float = 12000.0,
    progress: Progress = None,
) -> Operation:
    """Engraves curves into the set-up's part: `engrave` as an operation.

    Each curve is projected onto the part, and the cutter touches the plane ``depth`` below the surface there. Nothing
    is deeper in the part than depth + tolerance, by a bound over each move; shank and holder stay out of it. Places
    where the cutter would be deeper, as in hollows narrower than the cutter, are left out and listed in
    ``report.blocked``, as are places where the tool would meet a fixture, and faces that look away from the tool.

    Parameters
    ----------
    setup : Setup
        Part, in-process stock, fixtures, axis.
    tool : Tool
        The cutter.
    curves : list of array_like, shape (n, 3)
        Polylines, mm, within ``reach`` of the part.
    depth : float
        mm below the surface.
    orientation : array_like, str or dict, optional
        By default the set-up's axis; a unit vector (3,) from tip to spindle; "normal", the part's normal; or (lead,
        tilt), rad by which the axis leans from the normal forward and to the left. All but the first need a machine
        with rotary axes.
    tolerance : float
        Largest distance of the path's chords from the surface, and largest further depth, mm.
    reach : float
        Largest distance of a curve from the part, mm.
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
        Its ``engraved`` is the depth.

    Raises
    ------
    ValueError
        An argument is wrong; the message names it, and the curve and its point.

    Examples
    --------
    >>> part = riffler.shape.relief([[1, 1], [1, 1]], size=(30, 20), depth=10)
    >>> setup = riffler.plan.Setup(part, riffler.Volume.block(*part.bounds, pitch=0.5))
    >>> tool = riffler.Tool.taper(tip_radius=0.2, half_angle=0.3, diameter=4, length=20)
    >>> op = riffler.plan.engrave_operation(setup, tool, [[(5, 10, 10), (25, 10, 10)]], depth=0.3)
    >>> float(op.poses[op.kind == 2][0, 2].round(6)), round(op.report.cut_mm, 3)
    (9.7, 20.0)
    """
    if not (np.isfinite(depth) and depth > 0):
        raise ValueError(f"depth must be positive and finite, not {depth}")
    rule = axis_rule(orientation)
    lead, tilt = 0.0, 0.0
    if rule is None:
        setup = setup.along(orientation)  # type: ignore[arg-type]
    elif rule.kind == "lean":
        require_rotary(setup)
        lead, tilt = rule.lead, rule.tilt
    else:
        raise ValueError(
            f"orientation: engraving takes a direction, 'normal' or (lead, tilt) in rad, not {orientation!r}"
        )
    found = engrave(
        curves, tool, setup.part, depth=depth, inclination=lead, tilt=tilt, tolerance=tolerance, reach=reach
    )
    blocked: list[Blocked] = []
    lines = [one.poses for one in found]
    if rule is None:
        lines = [line for one in found for line in _upright(one, tool, setup.axis, depth, blocked)]
    return along_poses(
        setup,
        tool,
        lines,
        engraved=depth,
        tolerance=tolerance,
        max_lift=tolerance,
        feed=feed,
        plunge=plunge,
        spindle=spindle,
        blocked=blocked,
        stats={"curves": len(found)},
        progress=progress,
    )


def _upright(
    curve: Engraved, tool: Tool, axis: NDArray[np.float64], depth: float, blocked: list[Blocked]
) -> list[NDArray[np.float64]]:
    """Lines of poses along one axis at ``depth`` below a curve, where the surface faces the tool."""
    faces = curve.normals @ axis >= FACING
    out = []
    for run in np.split(np.arange(len(faces)), np.flatnonzero(np.diff(faces)) + 1):
        at, normals = curve.contacts[run], curve.normals[run]
        if not faces[run[0]]:
            length = float(np.linalg.norm(np.diff(at, axis=0), axis=1).sum())
            blocked.append(Blocked("the surface faces away from the tool", at[0], length))
        elif len(run) > 1:
            feeds = np.gradient(at, axis=0)
            axes = np.tile(axis, (len(run), 1))
            out.append(contact_locations(at - depth * normals, normals, axes, tool, feeds=feeds))
    return out
