"""Swarf cuts: ruled walls above pencil paths, cut by the cutter's flank."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ... import _core
from ..._core import Mesh, PencilPath, Tool
from ...arguments import Progress
from ...hints import hinted
from ..model import Plan
from .strategy import Found, Parameter, Strategy, share_of


@dataclass(frozen=True, eq=False)
class Swarf:
    """A wall cut by the flank: see `swarf`.

    Attributes
    ----------
    path : PencilPath
        The path with the axes.
    height : ndarray, shape (n,)
        mm: height of the wall along the axis.
    error : ndarray, shape (n,)
        mm: largest distance between wall and flank up to that height; inf if there is no wall.
    fits : list of tuple
        Runs (first, last) of points where ``error`` is within the tolerance.
    """

    path: PencilPath
    height: NDArray[np.float64]
    error: NDArray[np.float64]
    fits: list[tuple[int, int]]


@hinted("plan.swarf")
def swarf(
    path: PencilPath,
    tool: Tool,
    part_mesh: Mesh,
    *,
    side: int = 0,
    height: float | None = None,
    tolerance: float = 0.05,
    progress: Progress = None,
) -> Swarf:
    """Axes along which the tool's flank cuts the wall above a pencil path, where the wall is ruled.

    ``cutter_locations`` checks whether the tool gouges the floor or the rest of the part.

    Parameters
    ----------
    path : PencilPath
        A path of ``pencil``.
    tool : Tool
        A tool whose end is a ball of the path's radius, with a cylinder or a cone above it.
    part_mesh : Mesh
        The part.
    side : {0, 1}
        Number of the path's contact that is on the wall.
    height : float, optional
        Height of the wall to cut, mm from the ball's centre; None: up to the end of wall or flank.
    tolerance : float
        Largest distance between wall and flank, mm.
    progress : callable, optional
        Called with the finished share; returning False cancels.

    Returns
    -------
    Swarf

    Raises
    ------
    ValueError
        For a tool or a height that does not fit.

    Examples
    --------
    >>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
    >>> tool = riffler.Tool.ball(diameter=4, length=20)
    >>> (valley,) = riffler.plan.pencil(part, tool)
    >>> riffler.plan.swarf(valley, tool, part, side=0).fits
    [(0, 1)]
    """
    return _core.swarf(path, part_mesh, tool, side=side, height=height, tolerance=tolerance, progress=progress)


SIDES = (
    (
        "better",
        "Better One",
        "The wall that the flank fits along the greater length; if both are alike, the one with the more upright tool",
    ),
    ("first", "First", "The wall that the first contact of each path lies on"),
    ("second", "Second", "The wall that the second contact of each path lies on"),
)


class SwarfCuts(Strategy):
    id, place, label, action = "swarf", 30, "Swarf Cuts", "Swarf Cuts"
    description = "Ruled walls above the paths of a plan, cut by the cutter's flank"
    summary = "cut ruled walls above pencil paths with the cutter's flank"
    nothing = "swarf cut"
    needs = "paths"
    missing = "There is no pencil path yet: choose the strategy Pencil Cuts and find some, then the walls above them"
    parameters = (
        Parameter("side", "Wall", "Which of the two walls of a path the flank cuts", "better", choices=SIDES),
        Parameter(
            "height",
            "Height",
            "Height of the wall to cut, in mm from the ball's centre; 0: as far as wall and flank reach",
            None,
        ),
        Parameter(
            "tolerance",
            "Tolerance",
            "Largest distance between flank and wall, in mm; where it is larger, nothing is cut",
            0.05,
            low=1e-4,
            high=10.0,
        ),
    )

    def check(self, tool: Tool, given: Sequence[Any]) -> None:
        radius = _core.tip_ball_radius(tool, "tool")
        others = [path.radius for path in given if abs(path.radius - radius) > 1e-9 * radius]
        if others:
            raise ValueError(f"tool: the paths are those of a ball of {2 * others[0]:g} mm, not of {2 * radius:g} mm")

    def run(
        self, part_mesh: Mesh, tool: Tool, given: Sequence[Any], options: Mapping[str, Any], progress: Progress = None
    ) -> Found:
        options = dict(options)
        sides = {"first": (0,), "second": (1,)}.get(options.pop("side"), (0, 1))
        jobs = [(path, side) for path in given for side in sides]
        found = [
            swarf(path, tool, part_mesh, side=side, progress=share_of(progress, k, len(jobs)), **options)
            for k, (path, side) in enumerate(jobs)
        ]
        best = [max(found[k : k + len(sides)], key=_worth) for k in range(0, len(found), len(sides))]
        paths = [path for wall in best for path in _fitting(wall)]
        length, whole = sum(p.length for p in paths), sum(p.length for p in given)
        reason = "" if paths else f"the flank of {tool.name} fits no wall within {options['tolerance']:g} mm"
        notes = []
        if paths and length < 0.999 * whole:
            notes.append(f"The flank fits the wall along {length:.1f} of {whole:.1f} mm; the rest is left out")
        return Found(Plan(paths, tool, tolerance=options["tolerance"]), reason, notes)


def _worth(wall: Swarf) -> tuple[float, float]:
    """Length along which the flank fits, mm, then how upright the tool is there."""
    paths = _fitting(wall)
    upright = float(np.mean(np.concatenate([p.axes[:, 2] for p in paths]))) if paths else -1.0
    return round(sum(p.length for p in paths), 3), upright


def _fitting(wall: Swarf) -> list[PencilPath]:
    """Paths of the points where the flank fits. Each of their axes is a key."""
    path, fits = wall.path, list(wall.fits)
    rows = [np.arange(first, last + 1) for first, last in fits]
    whole = fits == [(0, len(path) - 1)]
    if path.closed and len(fits) > 1 and fits[0][0] == 0 and fits[-1][1] == len(path) - 1:
        rows = [np.concatenate([rows[-1], rows[0]]), *rows[1:-1]]  # through the loop's first point
    return [_piece(path, run, path.closed and whole) for run in rows if len(run) > 1]


def _piece(path: PencilPath, rows: NDArray[np.int64], closed: bool) -> PencilPath:
    contacts, normals, axes = path.contacts[rows], path.normals[rows], path.axes[rows]
    piece = PencilPath(path.radius, path.centres[rows], contacts, normals, closed=closed)
    return piece.with_axes(axes, keys=dict(enumerate(axes)), interpolation="slerp")


STRATEGIES = (SwarfCuts(),)
