"""Engraving: curves laid on a part and cut to a depth, the tool's axis following the surface."""

from dataclasses import dataclass

import numpy as np

from ... import _core
from ..file import Plan
from ..locations import path_of_poses
from .strategy import Found, Parameter, Strategy


@dataclass
class Engraved:
    """One curve on the part: ``poses`` (n, 6) of the tool; ``contacts`` and ``normals`` (n, 3) of the surface there."""

    poses: np.ndarray
    contacts: np.ndarray
    normals: np.ndarray


def engrave(
    part_mesh,
    curves,
    tool,
    depth=0.0,
    progress=None,
    *,
    inclination=0.0,
    tilt=0.0,
    tolerance=0.01,
    turn=0.0873,
    crease=0.5236,
    reach=10.0,
):
    """Lays curves on a part and cuts them ``depth`` mm deep, the tool's axis following the surface.

    ``curves``: a sequence of (n, 3) arrays, mm, polylines that lie within ``reach`` mm of the part. Each is laid on the
    part by nearest points and divided until its chords stay within ``tolerance`` mm of the surface and the axis turns
    by less than ``turn`` rad from one point to the next. Faces that meet at less than ``crease`` rad are facets of one
    round surface, over which normals vary smoothly. The axis leans by ``inclination`` forward and ``tilt`` to the left
    of the normal, rad, and the cutter touches the plane that lies ``depth`` below the surface.

    Returns one ``Engraved`` for each curve; its ``poses`` go into ``riffler.Program.from_cl``. ValueError naming the
    curve and its point.
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


ABOVE = 0.1  # of the cutter's diameter: so far above the surface the paths are shown


class Engrave(Strategy):
    id, place, label, action = "engrave", 20, "Engrave Curves", "Engrave Curves"
    description = "Curves laid on the part and cut to a depth, the tool's axis following the surface"
    summary = "cut curves into the part"
    needs = "curves"
    missing = "No curve is selected: select the curves that are to be engraved, as they lie on the part"
    parameters = (
        Parameter(
            "depth",
            "Depth",
            "Below the surface, in mm; negative: the cutter stays above it",
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
            "The path stays so near to the surface between its points, in mm",
            0.01,
            low=1e-4,
            high=10.0,
        ),
        Parameter(
            "reach", "Reach", "Curves that are further from the part than this are refused, in mm", 10.0, low=1e-3
        ),
    )

    def run(self, part_mesh, tool, given, options, progress=None):
        depth = max(0.0, options["depth"])
        lines = engrave(part_mesh, given, tool, progress=progress, **options)
        above = depth + ABOVE * tool.diameter
        paths = [path_of_poses(line.poses, line.contacts, line.normals, above) for line in lines]
        depths = dict.fromkeys(range(len(paths)), depth)
        return Found(Plan(paths, tool, tolerance=options["tolerance"], depths=depths))


STRATEGIES = (Engrave(),)
