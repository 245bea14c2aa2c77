"""Cutter locations: where the tool stands, lifted along its axis where it would gouge."""

from __future__ import annotations

import numpy as np

from .. import _core
from .around import with_room


class LocationReport:
    """What ``cutter_locations`` did. Arrays have one entry per row of ``cl``; clearances in mm, negative inside.

    ``points``: number of the path's point, -1 for a row that was inserted. ``lift``: mm along the axis. ``before``: the
    clearance before the lift. ``clearance``: after it. ``pieces``: ``"cutter"``, ``"shank"``, ``"holder"`` or
    ``"fixture"``: what was in the way, or is nearest. ``blocked``: a list of (point, reason) of the points that no lift
    frees; they have no row. ``unsafe``: a list of (row, least clearance seen, bound, reason) of the ways from a row to
    the next that were not made free. ``least_clearance``: over every pose that was looked at; ``bound``: nowhere along
    the rows is the clearance less. ``evaluations``: of the clearance, and looks along
    the way. ``ok``: nothing is blocked or unsafe.
    """

    def __init__(self, found: dict) -> None:
        for name, value in found.items():
            setattr(self, name, value)

    @property
    def depth_before(self) -> np.ndarray:
        """mm that the tool entered part or fixtures before the lift."""
        return np.maximum(0.0, -self.before)

    @property
    def lifted(self) -> np.ndarray:
        """Rows that were lifted."""
        return np.flatnonzero(self.lift > 0)

    @property
    def inserted(self) -> np.ndarray:
        """Rows that are not points of the path."""
        return np.flatnonzero(self.points < 0)

    def __repr__(self) -> str:
        rows = f"{len(self.points)} rows, {len(self.lifted)} lifted, {len(self.inserted)} inserted"
        return f"<LocationReport: {rows}, {len(self.blocked)} points blocked, {len(self.unsafe)} ways unsafe>"


def cutter_locations(
    path, tool, collider, clearance=0.0, *, tolerance=0.01, max_lift=100.0, max_inserted=200, progress=None
):
    """Cutter locations along an oriented path: ``(cl, report)``, cl (n, 6) tip and unit axis, for ``Program.from_cl``.

    The tool starts where its tip ball, or both its contacts, lie in the path, and is lifted along its own axis, as
    little as it takes, where its clearance over part and fixtures is less than ``clearance``. Between rows the tip
    moves on a line and the axis on the great circle; that motion is checked with a bound, not by samples, and where it
    gouges, rows are inserted and lifted. ``tolerance`` (mm) is how much less than ``clearance`` it may be: finishing
    cuts touch the part everywhere. A closed path ends with its first row again. ``path`` may also be (n, 6) poses, tip
    and unit axis, from which the tool starts instead.

    What cannot be freed within ``max_lift`` (mm) or ``max_inserted`` rows between two points is in the report
    (``report.ok`` is False then) and its points are not in ``cl``; it is never made to fit silently.
    ValueError for a path without axes and for sizes without meaning.
    """
    found = _core.cutter_locations(
        path,
        tool,
        collider,
        clearance=clearance,
        tolerance=tolerance,
        max_lift=max_lift,
        max_inserted=max_inserted,
        progress=progress,
    )
    return _core.then(found, lambda found: (found.pop("cl"), LocationReport(found)))


def path_of_poses(poses, contacts, normals, height):
    """Poses (n, 6) as a path: its centres lie ``height`` mm above the tips, on the axes, and each of its contacts and
    normals stands for both sides. ``poses_of`` gives the poses back, to rounding."""
    poses = np.asarray(poses, dtype=float)
    twice = [np.stack([rows, rows], axis=1) for rows in (contacts, normals)]
    return _core.PencilPath(height, poses[:, :3] + height * poses[:, 3:], *twice).with_axes(poses[:, 3:])


def poses_of(path):
    """(n, 6) tip and axis of a path whose centres lie its radius above the tips: of one by ``path_of_poses``, or of a
    ball's."""
    return np.hstack([path.centres - path.radius * path.axes, path.axes])


def kept_locations(path, depth, tool, collider, clearance=0.0, *, tolerance=0.01, progress=None):
    """``cutter_locations`` of a path in ``Plan.depths``: its own poses, checked and not lifted.

    The cutter enters the part by up to ``depth`` mm there, and by ``tolerance`` more at a point and twice that between
    two, since the path's chords are as far from the surface; shank and holder keep ``clearance`` from part and
    fixtures. (That the cutter enters a fixture by less than ``depth`` is not seen here.)
    """
    depth += tolerance
    body = with_room(tool, depth + clearance)
    return cutter_locations(
        poses_of(path), body, collider, -depth, tolerance=tolerance, max_lift=0.0, progress=progress
    )


def contact_locations(tool, contacts, normals, axes, feeds=None):
    """(n, 6) poses at which the cutter touches the tangent planes at ``contacts`` (n, 3) mm from outside.

    ``normals`` and ``axes`` are (n, 3) unit vectors, ``feeds`` (n, 3) of any length: where axis and normal are parallel
    the place on the contact circle is free, and lies ahead in the feed direction. Any profile, by its furthest point
    against the normal; a hollow arc touches with its ends. ValueError names the row where only the cutter's upper end
    could touch.
    """
    return _core.contact_locations(tool, contacts, normals, axes, feeds)


def lift(tool, poses, collider, clearance=0.0, *, tolerance=1e-9, max_lift=1000.0, max_evaluations=200, progress=None):
    """The least lift along the tool's own axis at which each pose is free: ``(poses, report)``.

    At every lower height the clearance over part and fixtures is less than ``clearance``; where it ends it is that,
    within ``tolerance`` (mm). The report is a dict of arrays: ``lift`` mm, ``free``, ``before`` and ``clearance`` mm,
    ``points`` (n, 3) and ``pieces`` (what was last in the way, or is nearest), ``evaluations``. A pose that is not free
    within ``max_lift`` has ``free`` False and stays where it is.
    """
    poses = np.array(poses, dtype=float)
    report = _core.lift(
        tool,
        poses,
        collider,
        clearance=clearance,
        tolerance=tolerance,
        max_lift=max_lift,
        max_evaluations=max_evaluations,
        progress=progress,
    )
    rows = report["free"]
    poses[rows, :3] += report["lift"][rows, None] * poses[rows, 3:]
    return poses, report


def drop(tool, points, part_mesh, axis=(0.0, 0.0, 1.0), progress=None):
    """The tool comes down along ``axis`` until it first touches the part: ``(heights, contacts)``.

    ``points`` (n, 3) mm are anywhere on the lines of the tips; ``heights`` (n,) mm of the tips along the axis,
    ``contacts`` (n, 3) of the part; NaN where nothing is met. Exact to rounding but for hollow arcs, of which cones
    stand for all but 1e-3 mm.
    """
    return _core.drop(tool, points, part_mesh, axis, progress)
