"""Pencil cuts: paths of a ball that touches a part at two places at once."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ... import _core
from ..._core import Mesh, PencilPath, Tool
from ...arguments import Progress
from ...deprecated import DictResult
from ...hints import hinted
from ..model import Plan
from .strategy import Found, Parameter, Strategy


@dataclass(frozen=True)
class PencilStats(DictResult):
    """Counters of ``pencil``: ``balls`` laid into the part, and those that ``entered`` it; ``starts`` of paths, and
    those that were ``stuck`` or mere ``faceting``; ``edges``; ``traces`` with their ``steps``; paths that were ``cut``.
    """

    balls: int
    entered: int
    starts: int
    stuck: int
    faceting: int
    edges: int
    traces: int
    steps: int
    cut: int


class PencilPaths(list[PencilPath]):
    """A list of ``PencilPath``, with a report on how they were found: see `pencil`.

    Attributes
    ----------
    ends : list of tuple
        Start and end of each path: "part", "corner", "faded", "loop", "cut", "joined" if another path
        continues or, for passes parallel to a valley, "pass".
    rest_area : float
        Area that the tool's ball cannot reach, mm².
    rest_areas : ndarray, shape (k,)
        The same for each triangle of the part.
    reference_area, reference_areas : float, ndarray of shape (k,)
        The same for the ball of ``reference_tool`` (or of ``overthickness``): the area to be machined. Without
        either, the areas of the tool's ball.
    stats : PencilStats
        Counters.
    reason : str
        Why there are no paths; empty if there are some.
    """

    def __init__(
        self,
        paths: Iterable[PencilPath],
        *,
        ends: list[tuple[str, str]],
        rest_area: float,
        rest_areas: NDArray[np.float64],
        reference_area: float,
        reference_areas: NDArray[np.float64],
        stats: PencilStats,
        reason: str,
    ) -> None:
        super().__init__(paths)
        self.ends = ends
        self.rest_area, self.rest_areas = rest_area, rest_areas
        self.reference_area, self.reference_areas = reference_area, reference_areas
        self.stats, self.reason = stats, reason


@hinted("plan.pencil")
def pencil(
    part_mesh: Mesh,
    tool: Tool,
    *,
    tolerance: float = 0.01,
    passes: int = 1,
    bitangency_angle: float | None = None,
    minimum_length: float = 0.0,
    stepover: float | None = None,
    scallop: float | None = None,
    overthickness: float = 0.0,
    reference_tool: Tool | None = None,
    progress: Progress = None,
) -> PencilPaths:
    """The valleys of a part for the ball at the tool's tip.

    The curves of ball centres along which the ball touches the part at two places at once and enters it nowhere.

    Parameters
    ----------
    part_mesh : Mesh
        The part.
    tool : Tool
        A tool whose tip is a ball.
    tolerance : float
        Largest error of the curves, mm. A valley counts where the ball's gap to its bottom is larger.
    passes : int
        Above 1, each valley is followed by passes - 1 curves on either side; there both contacts are the one point that
        the ball touches.
    bitangency_angle : float, optional
        rad; a valley then counts only where the directions to both contacts differ by at least this angle.
    minimum_length : float
        mm; shorter paths are dropped.
    stepover : float, optional
        mm between two passes.
    scallop : float, optional
        mm, instead of ``stepover``: height of the ridges that passes leave on a plane; None: the tolerance.
    overthickness : float
        mm by which the radius of a second ball is larger. Adds paths in the valleys of that ball, with the tool's ball
        laid into them, where the tool's ball has no valley, as in blends of its own radius or a larger one.
    reference_tool : Tool, optional
        A larger tool that has cut the part before. Adds paths in the same manner where its ball could not reach: rest
        machining, corners included.
    progress : callable, optional
        Called with the finished share; returning False cancels.

    Returns
    -------
    PencilPaths

    Raises
    ------
    ValueError
        For an empty mesh, for sizes that are not positive and finite, and for a tool or reference tool whose tip is
        not a ball.

    Examples
    --------
    >>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
    >>> paths = riffler.plan.pencil(part, riffler.Tool.ball(diameter=4, length=20))
    >>> len(paths), round(paths[0].length, 3)
    (1, 30.0)
    """
    if stepover is not None and scallop is not None:
        raise ValueError("stepover and scallop: only one of them")
    for known in (tool, reference_tool):
        if known is not None:
            _core.require_revolved(known, "plan.pencil")
    radius = _core.tip_ball_radius(tool, "tool")
    if scallop is not None:
        if not 0 < scallop <= radius:
            raise ValueError(f"scallop must be positive and at most the ball's radius, not {scallop}")
        stepover = _core.stepover_of_scallop(radius, scallop)
    if reference_tool is not None:
        larger = _core.tip_ball_radius(reference_tool, "reference_tool")
        if larger <= radius:
            raise ValueError(f"reference_tool must have a ball larger than {2 * radius:g} mm, not {2 * larger:g}")
        overthickness = max(overthickness, larger - radius)
    return _core.pencil(
        part_mesh,
        tool,
        tolerance=tolerance,
        bitangency_angle=bitangency_angle,
        minimum_length=minimum_length,
        passes=passes,
        stepover=stepover,
        overthickness=overthickness,
        progress=progress,
    )


class Pencil(Strategy):
    id, place, label, action = "pencil", 10, "Pencil Cuts", "Find Pencil Cuts"
    description = "Valleys of the part that a ball of the cutter's diameter touches on both sides"
    summary = "find the valleys that a ball touches on both sides"
    nothing = "pencil cut"
    parameters = (
        Parameter(
            "tolerance",
            "Tolerance",
            "Largest error of the paths, in mm; a valley that is no deeper below the ball counts as faceting",
            0.01,
            low=1e-4,
            high=10.0,
        ),
        Parameter("minimum_length", "Shortest", "Paths that are shorter are left out, in mm", None),
        Parameter(
            "passes",
            "Passes",
            "1: one path along each valley; each further pass adds a path on either side of it",
            1,
            "",
            low=1,
            high=100,
        ),
        Parameter(
            "stepover",
            "Stepover",
            "Distance between two passes, in mm; 0: leaves ridges as high as the tolerance",
            None,
        ),
    )

    def check(self, tool: Tool, given: Sequence[Any]) -> None:
        _core.tip_ball_radius(tool, "tool")

    def run(
        self, part_mesh: Mesh, tool: Tool, given: Sequence[Any], options: Mapping[str, Any], progress: Progress = None
    ) -> Found:
        paths = pencil(part_mesh, tool, progress=progress, **options)
        return Found(Plan(list(paths), tool, tolerance=options["tolerance"]), reason=paths.reason)


STRATEGIES = (Pencil(),)
