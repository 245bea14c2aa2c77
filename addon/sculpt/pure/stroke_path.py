"""A stroke of a mouse or a tablet as tool poses: the tool follows the surface under the cursor.

Independent of Blender: a `pick` returns the surface at a place of the view, and the result is poses to carve, piece by
piece as the pointer moves. The tool follows a smooth path through the samples (smooth_path.py), some pixels behind the
pointer. The same samples on the same surface give the same poses.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from .smooth_path import SmoothPath

MOST_TILT = 1.0  # rad: tablets report wrong values near the horizon
MOST_PICKS = 1024  # between two samples: limits a jump across the view in one event
FINEST = 0.25  # pixels between two picks


class Sample(NamedTuple):
    """An event's data: pixels, pressure 0 to 1, tilt of the pen to the right and up (-1 to 1, of 90°), seconds."""

    x: float
    y: float
    pressure: float = 1.0
    tilt_x: float = 0.0
    tilt_y: float = 0.0
    time: float = 0.0


class Hit(NamedTuple):
    """Result of a pick: a point of the surface (mm) and its normal, out of the material, in the stock's frame."""

    point: np.ndarray
    normal: np.ndarray


class View(NamedTuple):
    """Unit vectors of the view in the stock's frame; `back` points to the viewer."""

    right: np.ndarray
    up: np.ndarray
    back: np.ndarray


def leaning(view: View, tilt) -> np.ndarray:
    """The unit axis of a pen on the view, upright at a tilt of 0; `tilt` as in Sample."""
    lean = np.asarray(tilt, float) * (np.pi / 2)
    lean = np.where(np.isfinite(lean), lean, 0.0)
    angle = float(np.hypot(*lean))
    if angle < 1e-12:
        return view.back
    lean /= angle
    angle = min(angle, MOST_TILT)
    across = lean[0] * view.right + lean[1] * view.up
    return np.cos(angle) * view.back + np.sin(angle) * across


@dataclass(frozen=True)
class Settings:
    depth: float = 0.5  # mm below the surface, along its normal
    spacing: float = 0.5  # mm between two poses, and between two picks of the surface
    axis: str = "NORMAL"  # of the surface, VIEW, UP (the stock's z) or TILT (of the pen, upright on the view)
    pressure: str = "NONE"  # effect of pressure: NONE, DEPTH (share of depth), FEED (share of feed)
    feed: float = 50.0  # mm/s, where there are no times, and for FEED
    string: float = 0.0  # pixels: length of the string that pulls the tool
    gap: float = 10.0  # mm: a larger step between two places is a jump to another part of the surface


class Piece(NamedTuple):
    """Moves to carve: (n, 6) tip and axis, and (n - 1,) seconds. `new`: it does not continue the last one."""

    poses: np.ndarray
    dt: np.ndarray
    new: bool


@dataclass
class _Place:
    sample: Sample
    hit: Hit | None
    row: np.ndarray | None = None  # the pose; None off the surface


def support(outline: np.ndarray, axis: np.ndarray, towards: np.ndarray) -> np.ndarray:
    """For a tool with its tip at the origin, the point furthest along `towards` (3,). `outline`: (k, 2) radius, height.

    A body of revolution's support is that of its meridian on the side towards which `towards` points.
    """
    along = float(np.dot(towards, axis))
    across = towards - along * axis
    size = float(np.linalg.norm(across))
    best = int(np.argmax(outline[:, 0] * size + outline[:, 1] * along))
    radius, height = outline[best]
    return height * axis + (radius / size * across if size > 1e-12 else 0.0)


@dataclass
class StrokeMaker:
    """Call `add` with each sample, then `end` once; both return the moves to carve now."""

    settings: Settings
    outline: np.ndarray  # (k, 2) radius and height of the cutter, mm, from riffler.Tool.outline
    pick: Callable[[float, float], Hit | None]
    view: View
    _last: _Place | None = field(default=None, init=False)
    _newest: Sample | None = field(default=None, init=False)
    _pulled: Sample | None = field(default=None, init=False)  # the end of the string
    _path: SmoothPath = field(default_factory=SmoothPath, init=False)
    _along: float = field(default=0.0, init=False)  # the tool's distance along the path, in pixels

    def add(self, sample: Sample) -> list[Piece]:
        self._newest, self._pulled = sample, self._pull(sample)
        self._path.add(self._pulled)
        return self._follow()

    def end(self) -> list[Piece]:
        """Moves the tool to the pointer's last place, with or without a string."""
        if self._newest is None:
            return []
        self._path.add(self._newest)
        self._path.finish()
        return self._follow(end=True)

    # ------------------------------------------------------------------ where
    def _pull(self, sample: Sample) -> Sample:
        if self._pulled is None or self.settings.string <= 0:
            return sample
        here = self._pulled
        way = np.hypot(sample.x - here.x, sample.y - here.y)
        share = 0.0 if way <= self.settings.string else 1 - self.settings.string / way
        return sample._replace(x=here.x + share * (sample.x - here.x), y=here.y + share * (sample.y - here.y))

    def _follow(self, end: bool = False) -> list[Piece]:
        """Follows the final part of the path. Except at the end, waits until it is at least half a spacing long."""
        ready = self._path.ready
        if self._last is None:
            return self._pieces(self._places([0.0]))
        if ready <= self._along:
            return []
        (goal,) = self._places([ready])
        wanted = self._wanted(goal, ready - self._along)
        if wanted < 0.5 and not end:
            return []
        count = max(1, int(np.ceil(min(wanted, (ready - self._along) / FINEST, MOST_PICKS))))
        between = self._places(self._along + (ready - self._along) * np.arange(1, count) / count)
        self._along = ready
        self._path.forget(ready)
        return self._pieces([*between, goal])

    def _places(self, along) -> list[_Place]:
        samples = [Sample(*row) for row in self._path.at(along).tolist()]
        return [_Place(s, self.pick(s.x, s.y)) for s in samples]

    def _wanted(self, goal: _Place, pixels: float) -> float:
        """Number of steps for the distance, so that the tool follows the surface between them."""
        last = self._last
        if last.hit is None or goal.hit is None:
            return pixels  # onto the surface or off it: the edge may be at any pixel
        pressed = abs(goal.sample.pressure - last.sample.pressure) if self.settings.pressure == "DEPTH" else 0.0
        way = np.linalg.norm(goal.hit.point - last.hit.point) + pressed * self.settings.depth
        return float(way / self.settings.spacing)

    # ------------------------------------------------------------------ how
    def _pieces(self, places: list[_Place]) -> list[Piece]:
        pieces, rows, times = [], [], []
        new = False
        for place in places:
            last = self._last
            joined = place.hit is not None and last is not None and last.row is not None
            if joined and np.linalg.norm(place.hit.point - last.hit.point) > self.settings.gap:
                joined = False
            if not joined:
                self._close(pieces, rows, times, new)
                rows, times, new = [], [], True
            if place.hit is not None:
                if joined and not rows:
                    rows, new = [last.row], False
                self._row(place, joined, rows, times)
            self._last = place
        self._close(pieces, rows, times, new)
        return pieces

    def _row(self, place: _Place, joined: bool, rows: list, times: list) -> None:
        normal = place.hit.normal
        depth = self.settings.depth * (place.sample.pressure if self.settings.pressure == "DEPTH" else 1.0)
        axis = self._axis(place.sample, normal)
        place.row = self._pose(place.hit.point, normal, axis, depth)
        if not joined:  # comes down on the surface first: a click makes a dent
            rows.append(self._pose(place.hit.point, normal, axis, 0.0))
            times.append(self._seconds(depth, place.sample, 0.0))
        else:
            way = float(np.linalg.norm(place.row[:3] - rows[-1][:3]))
            times.append(self._seconds(way, place.sample, place.sample.time - self._last.sample.time))
        rows.append(place.row)

    def _axis(self, sample: Sample, normal: np.ndarray) -> np.ndarray:
        kind = self.settings.axis
        if kind == "NORMAL":
            return normal
        if kind == "UP":
            return np.array([0.0, 0.0, 1.0])
        return leaning(self.view, (sample.tilt_x, sample.tilt_y) if kind == "TILT" else (0.0, 0.0))

    def _pose(self, point, normal, axis, depth) -> np.ndarray:
        """The cutter's outermost point against the normal is `depth` below `point`."""
        tip = point - depth * normal - support(self.outline, axis, -normal)
        return np.concatenate([tip, axis])

    def _seconds(self, way: float, sample: Sample, passed: float) -> float:
        """Duration of a move, never 0 because forces are per second."""
        if self.settings.pressure == "FEED":
            return max(way, 1e-6) / (self.settings.feed * min(max(sample.pressure, 0.01), 1.0))
        return passed if passed > 0 else max(way, 1e-6) / self.settings.feed

    @staticmethod
    def _close(pieces, rows, times, new) -> None:
        if len(rows) > 1:
            pieces.append(Piece(np.array(rows), np.array(times), new))


def settings_for(pitch: float, diameter: float, **chosen) -> Settings:
    """Spacing and gap that suit a volume's pitch and a tool's width."""
    fitting = Settings(spacing=max(pitch, diameter / 12), gap=max(diameter, 4 * pitch))
    return replace(fitting, **chosen)
