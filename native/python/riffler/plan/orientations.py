"""Free orientations: which tool axes meet nothing, at a point as a map and along a path."""

from __future__ import annotations

import math

import numpy as np

from .. import _core

FREE, BLOCKED, BEYOND, UNREACHABLE = range(4)
_WIDEST = math.radians(75)


def _grid(angles, widest=_WIDEST, count=21) -> np.ndarray:
    return np.linspace(-widest, widest, count) if angles is None else np.asarray(angles, dtype=float)


class FreeOrientations:
    """The configuration space at one point of a path; arrays are (inclinations, tilts).

    ``inclinations``, ``tilts``: rad. ``clearance``: mm, signed, NaN where nothing was computed. ``free``: bool.
    ``state``: FREE, BLOCKED, BEYOND the machine's cone or UNREACHABLE for the cutter. ``pieces``: what is nearest or
    deepest. ``axes`` (…, 3). ``suggestion``: the free axis that leans least, or None; ``reason`` then says what is in
    the way, and by how much at least.
    """

    def __init__(self, index: int, inclinations: np.ndarray, tilts: np.ndarray, found: dict) -> None:
        shape = len(inclinations), len(tilts)
        self.index, self.inclinations, self.tilts = index, inclinations, tilts
        self.clearance = found["clearance"].reshape(shape)
        self.state = found["state"].reshape(shape)
        self.free = self.state == FREE
        self.pieces = np.array(found["pieces"]).reshape(shape)
        self.axes = found["axes"].reshape(*shape, 3)
        self.suggestion = found["suggestion"]
        self.reason = found["reason"]

    def __repr__(self) -> str:
        return f"<FreeOrientations at point {self.index}: {int(self.free.sum())} of {self.free.size} free>"


def free_orientations(
    path, index, tool, collider, *, inclinations=None, tilts=None, clearance=0.0, tolerance=0.01, limit=None,
    progress=None,
):  # fmt: skip
    """The free orientations at point ``index`` of a path, or, for a list of indices, a list of them.

    The tool stands on the path with every axis of the grid ``inclinations`` × ``tilts`` (rad, ascending; by default 21
    each within 75 degrees) about the path's frame there, and is free where its clearance over part and fixtures is at
    least ``clearance`` - ``tolerance``. ``limit``: (axis, angle), the machine's cone; nothing is computed beyond it.
    """
    inclinations, tilts = _grid(inclinations), _grid(tilts)
    single = np.ndim(index) == 0
    points = [int(i) for i in ([index] if single else index)]
    if any(i < 0 for i in points):
        raise ValueError("index: begins at 0")
    found = _core.orientation_maps(
        path, points, tool, collider, inclinations=inclinations, tilts=tilts, clearance=clearance,
        tolerance=tolerance, limit=limit, progress=progress,
    )  # fmt: skip

    def maps(found):
        made = [FreeOrientations(i, inclinations, tilts, one) for i, one in zip(points, found, strict=True)]
        return made[0] if single else made

    return _core.then(found, maps)


def least_tilt(
    path, tool, collider, *, inclinations=None, tilts=None, clearance=0.0, tolerance=0.01, limit=None, max_change=None,
    smoothness=4.0, progress=None,
):  # fmt: skip
    """The free orientations along a path that lean least: ``(oriented path or None, report)``.

    Of the maps of ``free_orientations`` at all points one free axis each is chosen, so that the sum of the squared
    angles to the frame's z plus ``smoothness`` times that of the squared changes between neighbours is least, and no
    change exceeds ``max_change`` (rad; by default one and a half diagonals of the grid). The least over the grid, by
    dynamic programming; on a closed path the least for the first point's axis. The report is a dict: ``found``,
    ``angles`` (n,) to z, ``cost``; where none is found, ``point`` and ``reason``: no orientation is free there, or none
    that those before it lead to. What happens between points is for ``cutter_locations`` to check.
    """
    inclinations, tilts = _grid(inclinations), _grid(tilts)
    if max_change is None:
        steps = [float(np.diff(angles).max()) if len(angles) > 1 else 0.0 for angles in (inclinations, tilts)]
        max_change = max(1.5 * math.hypot(*steps), 1e-3)
    found = _core.least_tilt(
        path, tool, collider, inclinations=inclinations, tilts=tilts, clearance=clearance, tolerance=tolerance,
        limit=limit, max_change=max_change, smoothness=smoothness, progress=progress,
    )  # fmt: skip

    def oriented(report):
        axes = report.pop("axes")
        if not report["found"]:
            return None, report
        return path.oriented(dict(enumerate(axes)), "slerp"), report

    return _core.then(found, oriented)


def draw_map(orientations: FreeOrientations, axes=None):
    """Draws the map with matplotlib, which must be installed, into ``axes`` or a new figure; returns the axes.

    Clearance as colour, the border of the free region as a line, what was not computed hatched, a ring at the
    suggestion. Angles in degrees.
    """
    from matplotlib import colors, pyplot

    if axes is None:
        axes = pyplot.subplots(layout="constrained")[1]
    tilts, inclinations = np.degrees(orientations.tilts), np.degrees(orientations.inclinations)
    clearance = np.ma.masked_invalid(orientations.clearance)
    most = max(float(np.abs(clearance).max()), 1e-6) if clearance.count() else 1.0
    axes.set_facecolor("0.85")
    shown = axes.pcolormesh(
        tilts,
        inclinations,
        clearance,
        cmap="RdBu",
        shading="nearest",
        norm=colors.SymLogNorm(0.01, vmin=-most, vmax=most),
    )
    axes.figure.colorbar(shown, ax=axes, label="clearance, mm")
    if len(tilts) > 1 and len(inclinations) > 1 and orientations.free.any() and not orientations.free.all():
        axes.contour(tilts, inclinations, orientations.free.astype(float), levels=[0.5], colors="black")
    if orientations.suggestion is not None:
        gaps = np.linalg.norm(orientations.axes - orientations.suggestion, axis=-1)
        row, column = np.unravel_index(int(gaps.argmin()), gaps.shape)
        axes.plot(tilts[column], inclinations[row], "o", mfc="none", mec="black", ms=10)
    axes.set(xlabel="tilt, degrees", ylabel="inclination, degrees", title=f"point {orientations.index}")
    return axes
