"""Engraving: curves projected onto a part and cut to a depth, with the tool's axis following the surface."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ... import _core
from ..._core import Mesh, Tool
from ...arguments import Progress
from ...hints import hinted
from ..locations import path_of_poses
from ..model import Plan
from .strategy import Found, Parameter, Strategy


@dataclass(frozen=True, eq=False)
class Engraved:
    """One curve on the part: see `engrave`.

    Attributes
    ----------
    poses : ndarray, shape (n, 6)
        Tip in mm and unit axis, for ``Program.from_cl``.
    contacts, normals : ndarray, shape (n, 3)
        Points of the surface, mm, and its unit normals there.
    """

    poses: NDArray[np.float64]
    contacts: NDArray[np.float64]
    normals: NDArray[np.float64]


@hinted("plan.engrave")
def engrave(
    curves: Sequence[ArrayLike],
    tool: Tool,
    part_mesh: Mesh,
    *,
    depth: float = 0.0,
    inclination: float = 0.0,
    tilt: float = 0.0,
    tolerance: float = 0.01,
    turn: float = 0.0873,
    crease: float = 0.5236,
    reach: float = 10.0,
    progress: Progress = None,
) -> list[Engraved]:
    """Projects curves onto a part and cuts them ``depth`` mm deep; the tool's axis follows the surface.

    Each curve is projected onto the part by nearest points and divided until its chords stay within ``tolerance`` of
    the surface and the axis turns by less than ``turn`` from one point to the next. The cutter touches the plane
    ``depth`` below the surface.

    Parameters
    ----------
    curves : list of array_like, shape (n, 3)
        Polylines, mm, within ``reach`` of the part.
    tool : Tool
        The cutter.
    part_mesh : Mesh
        The part.
    depth : float
        mm below the surface; negative: the cutter stays above it.
    inclination, tilt : float
        rad by which the axis leans forward, along the curve, and to the left, from the surface's normal.
    tolerance : float
        Largest distance of the path's chords from the surface, mm.
    turn : float
        Largest turn of the axis between two points, rad.
    crease : float
        rad; faces that meet at a smaller angle are facets of one round surface, over which normals vary smoothly.
    reach : float
        Largest distance of a curve from the part, mm.
    progress : callable, optional
        Called with the finished share; returning False cancels.

    Returns
    -------
    list of Engraved
        One for each curve.

    Raises
    ------
    ValueError
        Naming the curve and its point.

    Examples
    --------
    >>> part = riffler.shape.relief([[1, 1], [1, 1]], size=(30, 20), depth=10)
    >>> tool = riffler.Tool.taper(tip_radius=0.2, half_angle=0.3, diameter=4, length=20)
    >>> (line,) = riffler.plan.engrave([[(5, 10, 10), (25, 10, 10)]], tool, part, depth=0.3)
    >>> line.poses[0].round(6) + 0.0
    array([ 5. , 10. ,  9.7,  0. ,  0. ,  1. ])
    """
    found = _core.engrave(
        part_mesh,
        curves,
        tool,
        depth=depth,
        inclination=inclination,
        tilt=tilt,
        tolerance=tolerance,
        turn=turn,
        crease=crease,
        reach=reach,
        progress=progress,
    )
    return [Engraved(*arrays) for arrays in found]


ABOVE = 0.1  # height above the surface at which paths are shown, in cutter diameters


class Engrave(Strategy):
    id, place, label, action = "engrave", 20, "Engrave Curves", "Engrave Curves"
    description = "Curves laid on the part and cut to a depth, with the tool's axis following the surface"
    summary = "cut curves into the part"
    needs = "curves"
    missing = "No curve is selected: select the curves to engrave on the part"
    parameters = (
        Parameter(
            "depth",
            "Depth",
            "Depth below the surface, in mm; negative: the cutter stays above it",
            0.3,
            low=-1e3,
            high=1e3,
        ),
        Parameter(
            "inclination",
            "Inclination",
            "How far the tool leans forward, along the curve, from the surface's normal",
            0.0,
            "rad",
            low=-1.5,
            high=1.5,
        ),
        Parameter("tilt", "Tilt", "How far the tool leans to the left of the curve", 0.0, "rad", low=-1.5, high=1.5),
        Parameter(
            "tolerance",
            "Tolerance",
            "Largest distance between path and surface, in mm",
            0.01,
            low=1e-4,
            high=10.0,
        ),
        Parameter(
            "reach",
            "Reach",
            "Largest distance of a curve from the part, in mm; further ones are refused",
            10.0,
            low=1e-3,
        ),
    )

    def run(
        self, part_mesh: Mesh, tool: Tool, given: Sequence[Any], options: Mapping[str, Any], progress: Progress = None
    ) -> Found:
        depth = max(0.0, options["depth"])
        lines = engrave(given, tool, part_mesh, progress=progress, **options)
        above = depth + ABOVE * tool.diameter
        paths = [path_of_poses(line.poses, line.contacts, line.normals, height=above) for line in lines]
        depths = dict.fromkeys(range(len(paths)), depth)
        return Found(Plan(paths, tool, tolerance=options["tolerance"], depths=depths))


STRATEGIES = (Engrave(),)
