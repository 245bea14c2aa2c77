"""Plans from recorded strokes."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from .._core import Journal, PencilPath, Tool
from ..arguments import Progress
from ..hints import hinted
from .locations import path_of_poses
from .model import Plan
from .thinning import StandsStillError, Thinned, between, thin

CUTS = ("remove", "beside")  # modes of strokes that a machine can make
ANGLE = math.radians(2)
LARGEST = 0.5  # rad: a larger angle between recorded and planned axes gives no useful bound
OPPOSITE = math.pi - 1e-6  # rad: as in PencilPath.orient
ALONG = 0.05  # sine of the angle between axis and feed below which a ball plunges


class NoPathError(ValueError):
    """No stroke of a recording makes a path: see `from_recording`.

    Examples
    --------
    >>> try:
    ...     riffler.plan.from_recording(riffler.Journal())
    ... except riffler.plan.NoPathError as error:
    ...     print(error)
    recording: it has no stroke that removes material, so there is nothing to plan
    """


@dataclass(frozen=True, eq=False)
class StrokePath:
    """The path of a recorded stroke: see `path_of_stroke`.

    Attributes
    ----------
    path : PencilPath
        The path with axes: interpolated between keys, or the recorded ones for a tool without a ball tip.
    error : float
        mm: largest distance of the recorded ball's centre, or tip, from the path.
    turn : float
        rad: largest angle between the recorded axis and the path's.
    poses : int
        Number of recorded poses.
    turns : bool
        Whether the path's axes follow its keys; False for a tool without a ball tip.
    """

    path: PencilPath
    error: float
    turn: float
    poses: int
    turns: bool


@dataclass(frozen=True, eq=False)
class Recorded:
    """The plan of a recording: see `from_recording`.

    Attributes
    ----------
    plan : Plan
        A path for each stroke.
    strokes : list of int
        For each path the number of its stroke, from 0.
    paths : list of StrokePath
        The paths with their bounds.
    notes : list of str
        Further notes for the user, as sentences.
    """

    plan: Plan
    strokes: list[int]
    paths: list[StrokePath]
    notes: list[str] = field(default_factory=list)

    @property
    def error(self) -> float:
        """Largest error of all paths, mm."""
        return max(path.error for path in self.paths)

    @property
    def turn(self) -> float:
        """Largest turn of all paths, rad."""
        return max(path.turn for path in self.paths)


@hinted("plan.path_of_stroke")
def path_of_stroke(
    poses: ArrayLike, tool: Tool, *, tolerance: float = 0.01, angle: float = ANGLE, name: str = "poses"
) -> StrokePath:
    """A recorded motion as a path with few points and few keys.

    The path of a tool with a ball tip has the ball's centres, and keys where the axis bends; between them the axis
    turns by the rule "slerp". Between two recorded poses the tip moves straight and the axis on the great circle, and
    both bounds hold there as well. A point of the tool h mm above the centre is within ``error + 2 h sin(turn / 2)``.
    Each contact stands for both sides: the bottom of the groove that the ball leaves.

    A tool without a ball tip cannot turn about a point and cut the same. Its path keeps the recorded poses, thinned
    to the same bounds, as ``path_of_poses`` has them: tip and axis at every point, no keys.

    Parameters
    ----------
    poses : array_like, shape (n, 6)
        Tip in mm and unit axis of one stroke.
    tool : Tool
        The cutter.
    tolerance : float
        mm: largest distance between the recorded motion and the path.
    angle : float
        rad: largest angle between their axes, at most 0.5.
    name : str
        Name of the poses in errors.

    Returns
    -------
    StrokePath

    Raises
    ------
    ValueError
        Naming the row: fewer than two poses, not finite, not a unit axis, an axis opposite to the one before; and for
        a motion that stays in one place.

    Examples
    --------
    >>> x = np.linspace(0, 20, 500)
    >>> lean = 0.5 * np.sin(x / 8)
    >>> poses = np.column_stack([x, 0 * x, 0 * x, np.sin(lean), 0 * x, np.cos(lean)])
    >>> found = riffler.plan.path_of_stroke(poses, riffler.Tool.ball(diameter=4, length=20), tolerance=0.02)
    >>> len(found.path) < 50, len(found.path.keys) < 10, found.error <= 0.02
    (True, True, True)
    """
    if not (math.isfinite(tolerance) and tolerance > 0):
        raise ValueError(f"tolerance must be a positive length in mm, not {tolerance!r}")
    if not (math.isfinite(angle) and 0 < angle <= LARGEST):
        raise ValueError(f"angle must be positive and at most {LARGEST:g} rad, not {angle!r}")
    _core.require_revolved(tool, "plan.path_of_stroke")
    rows = _checked(poses, name)
    radius = _ball_radius(tool)
    try:
        thinned = thin(rows[:, :3], rows[:, 3:], radius or 0.0, tolerance, angle)
    except StandsStillError as error:
        raise StandsStillError(f"{name}: {error}") from None
    path = _ball_path(thinned, radius) if radius else _pose_path(thinned, tool)
    return StrokePath(path, thinned.error, thinned.turn, len(rows), turns=bool(radius))


@hinted("plan.from_recording")
def from_recording(
    journal: Journal,
    *,
    tool: int | None = None,
    tolerance: float = 0.01,
    angle: float = ANGLE,
    name: str = "recording",
    progress: Progress = None,
) -> Recorded:
    """A plan of a recording's strokes: a path for each, with keys where the axis bends. It can be edited as any other.

    Motion with the button up is not recorded as a stroke and not part of the plan. Strokes that do not remove are left
    out because no machine can make them, and so are strokes that stay in one place; ``notes`` counts both.

    Parameters
    ----------
    journal : Journal
        The recording.
    tool : int, optional
        Number of the tool whose strokes are planned, since a plan has one tool. None: the only tool with strokes.
    tolerance, angle : float
        mm and rad, as in ``path_of_stroke``.
    name : str
        The recording's name, for errors and ``Plan.provenance``.
    progress : callable, optional
        Called with the finished share; returning False cancels.

    Returns
    -------
    Recorded

    Raises
    ------
    NoPathError
        If no stroke makes a path.
    ValueError
        For several tools without ``tool``, and as for ``path_of_stroke``.

    Examples
    --------
    >>> journal = riffler.Journal()
    >>> journal.add_tool(1, riffler.Tool.ball(diameter=6, length=30))
    >>> journal.add_stroke(1, [(0, 10, 8, 0, 0, 1), (20, 10, 8, 0.6, 0, 0.8)])
    >>> found = riffler.plan.from_recording(journal)
    >>> len(found.plan.paths), len(found.plan.paths[0].keys)
    (1, 2)
    """
    strokes = journal.strokes
    cuts = [k for k, stroke in enumerate(strokes) if stroke.mode in CUTS]
    if not cuts:
        raise NoPathError(f"{name}: it has no stroke that removes material, so there is nothing to plan")
    number = _tool_of({strokes[k].tool for k in cuts}, tool, name)
    mine = [k for k in cuts if strokes[k].tool == number]
    cutter = Tool.from_dict(journal.tools[number])
    _core.require_revolved(cutter, f"{name}, tool {number}: a plan")
    numbers, paths, still = [], [], 0
    for done, k in enumerate(mine):
        if progress is not None and progress(done / len(mine)) is False:
            raise _core.Cancelled("cancelled")
        poses = strokes[k].poses
        try:
            poses = poses if len(poses) > 1 else np.repeat(poses, 2, axis=0)
            paths.append(path_of_stroke(poses, cutter, tolerance=tolerance, angle=angle, name=f"{name}, stroke {k}"))
            numbers.append(k)
        except StandsStillError:
            still += 1
    if not paths:
        raise NoPathError(f"{name}: no stroke moves by more than {tolerance:g} mm, so there is no path to plan")
    left_out = {
        "that removed nothing": len(strokes) - len(cuts),
        "of another tool": len(cuts) - len(mine),
        "that stayed in one place": still,
    }
    notes = _notes(left_out, [strokes[k].mode for k in numbers], paths, cutter)
    depths = {} if paths[0].turns else dict.fromkeys(range(len(paths)), 0.0)
    made = Plan(
        [path.path for path in paths], cutter, tolerance=tolerance, depths=depths, provenance={"recording": str(name)}
    )
    return Recorded(made, numbers, paths, notes)


def _checked(poses: ArrayLike, name: str) -> NDArray[np.float64]:
    rows = np.array(poses, dtype=float)
    if rows.ndim != 2 or rows.shape[1] != 6:
        raise ValueError(f"{name} must have the shape (n, 6), not {rows.shape}")
    if len(rows) < 2:
        raise ValueError(f"{name}: two or more are needed for a path, not {len(rows)}")
    if bad := np.flatnonzero(~np.isfinite(rows).all(axis=1)).tolist():
        raise ValueError(f"{name}, row {bad[0]}: not finite")
    lengths = np.linalg.norm(rows[:, 3:], axis=1)
    if bad := np.flatnonzero(np.abs(lengths - 1) >= 1e-6).tolist():
        raise ValueError(f"{name}, row {bad[0]}: the axis is not a unit vector")
    rows[:, 3:] /= lengths[:, None]
    if bad := np.flatnonzero(between(rows[:-1, 3:], rows[1:, 3:]) > OPPOSITE).tolist():
        raise ValueError(
            f"{name}, row {bad[0] + 1}: the axis is opposite to that of the row before, so the direction of the turn "
            "is unknown: divide the stroke there"
        )
    return rows


def _ball_radius(tool: Tool) -> float | None:
    """Radius of the ball at the tip, mm; None for a tool without a ball tip."""
    try:
        return _core.tip_ball_radius(tool, "tool")
    except ValueError:
        return None


def _tool_of(used: set[int], tool: int | None, name: str) -> int:
    listed = ", ".join(map(str, sorted(used)))
    if tool is None:
        if len(used) > 1:
            raise ValueError(f"{name}: its strokes are of the tools {listed}, and a plan has one: choose it with tool")
        return next(iter(used))
    if tool not in used:
        raise ValueError(f"tool: {name} has no stroke of tool {tool} that removes material; it has those of {listed}")
    return tool


def _ball_path(thinned: Thinned, radius: float) -> PencilPath:
    points, axes = thinned.points, thinned.axes
    normals = _normals(points, axes)
    contacts = points - radius * normals
    pairs = (np.stack([each, each], axis=1) for each in (contacts, normals))
    path = PencilPath(radius, points, *pairs)
    return path.orient({k: axes[k] for k in thinned.keys}, interpolation="slerp")


def _pose_path(thinned: Thinned, tool: Tool) -> PencilPath:
    from .strategies.engrave import ABOVE

    poses = np.hstack([thinned.points, thinned.axes])
    return path_of_poses(poses, thinned.points, _normals(thinned.points, thinned.axes), height=ABOVE * tool.diameter)


def _normals(points: NDArray[np.float64], axes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Unit normals of the surface that a ball leaves: perpendicular to the feed, on the axis's side. The axis itself
    where the tool plunges along it."""
    feeds = np.vstack([points[1:2] - points[:1], points[2:] - points[:-2], points[-1:] - points[-2:-1]])
    lengths = np.linalg.norm(feeds, axis=1, keepdims=True)
    feeds = np.divide(feeds, lengths, out=np.zeros_like(feeds), where=lengths > 0)
    normals = axes - np.sum(axes * feeds, axis=1, keepdims=True) * feeds
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.where(lengths > ALONG, normals / np.where(lengths > 0, lengths, 1.0), axes)


def _notes(left_out: dict[str, int], modes: list[str], paths: list[StrokePath], tool: Tool) -> list[str]:
    notes = [f"{_counted(count)} {which}: left out" for which, count in left_out.items() if count]
    if count := modes.count("beside"):
        notes.append(f"{_counted(count)} made next to protected material: the paths do not know that it was protected")
    if not paths[0].turns:
        notes.append(
            f"the tip of {tool.name} is not a ball: its paths keep the recorded poses, and keys do not turn the tool"
        )
    return notes


def _counted(count: int) -> str:
    return f"{count} stroke{'' if count == 1 else 's'}"
