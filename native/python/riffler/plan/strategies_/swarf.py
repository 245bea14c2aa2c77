"""What else the same machinery cuts: curves engraved into a part, ruled walls with the cutter's flank."""

from dataclasses import dataclass

import numpy as np

from .. import _core


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
