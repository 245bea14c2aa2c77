"""Swarf cuts: ruled walls above pencil paths, cut by the cutter's flank."""

from dataclasses import dataclass

import numpy as np

from ... import _core
from ..file import Plan
from .strategy import Found, Parameter, Strategy, share_of


@dataclass
class Swarf:
    """A wall cut by the flank.

    ``path`` has the axes; ``height`` (n,) mm is up to where along the axis there is wall, ``error`` (n,) mm how far it
    is from the flank at most up to there (inf where nothing stands); ``fits``: runs (first, last) of points where that
    is within the tolerance.
    """

    path: _core.PencilPath
    height: np.ndarray
    error: np.ndarray
    fits: list


def swarf(path, part_mesh, tool, side=0, progress=None, *, height=None, tolerance=0.05):
    """Axes along which the tool's flank cuts the wall above a pencil path, where the wall is ruled.

    ``side``: which of the path's contacts is the wall's. ``height``: how much of the wall, mm from the ball's centre;
    without it as far as wall and flank go. The cutter's end must be a ball of the path's radius, with a cylinder or a
    cone above it. What the floor and the rest of the part say to it is for ``cutter_locations``. ValueError for a tool
    or a height that does not fit.
    """
    found = _core.swarf(path, part_mesh, tool, side=side, height=height, tolerance=tolerance, progress=progress)
    return Swarf(**found)


SIDES = (
    (
        "better",
        "Better One",
        "The wall that the flank fits along the greater length; of two alike the one where the tool is more upright",
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
            "How much of the wall, in mm from the ball's centre; 0: as far as wall and flank go",
            None,
        ),
        Parameter(
            "tolerance",
            "Tolerance",
            "The flank may be so far from the wall, in mm; where it is further, nothing is cut",
            0.05,
            low=1e-4,
            high=10.0,
        ),
    )

    def check(self, tool, given):
        radius = _core.tip_ball_radius(tool, "tool")
        others = [path.radius for path in given if abs(path.radius - radius) > 1e-9 * radius]
        if others:
            raise ValueError(f"tool: the paths are those of a ball of {2 * others[0]:g} mm, not of {2 * radius:g} mm")

    def run(self, part_mesh, tool, given, options, progress=None):
        options = dict(options)
        sides = {"first": (0,), "second": (1,)}.get(options.pop("side"), (0, 1))
        jobs = [(path, side) for path in given for side in sides]
        found = [
            swarf(path, part_mesh, tool, side, share_of(progress, k, len(jobs)), **options)
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


def _worth(wall):
    """Length along which the flank fits, mm, then how upright the tool is there."""
    paths = _fitting(wall)
    upright = np.mean(np.concatenate([p.axes[:, 2] for p in paths])) if paths else -1.0
    return round(sum(p.length for p in paths), 3), upright


def _fitting(wall):
    """Paths of the points where the flank fits. Each of their axes is a key."""
    path, fits = wall.path, list(wall.fits)
    rows = [np.arange(first, last + 1) for first, last in fits]
    whole = fits == [(0, len(path) - 1)]
    if path.closed and len(fits) > 1 and fits[0][0] == 0 and fits[-1][1] == len(path) - 1:
        rows = [np.concatenate([rows[-1], rows[0]]), *rows[1:-1]]  # through the loop's first point
    return [_piece(path, run, path.closed and whole) for run in rows if len(run) > 1]


def _piece(path, rows, closed):
    contacts, normals, axes = path.contacts[rows], path.normals[rows], path.axes[rows]
    piece = _core.PencilPath(path.radius, path.centres[rows], contacts, normals, closed)
    return piece.with_axes(axes, dict(enumerate(axes)), "slerp")


STRATEGIES = (SwarfCuts(),)
