"""Key orientations on a timeline: the point of each frame on its path, and the keyframes' effect on a plan.

All paths of a plan follow one another, each from a whole frame to a whole frame. Between two points of a path frames
are proportional to arc length. A keyframe belongs to the nearest point.
"""

from __future__ import annotations

import hashlib
import math
from dataclasses import dataclass, field

import numpy as np

from ...common import quaternions

GAP = 10  # frames between two paths
REACH = 0.5  # frames beyond a path's ends that still belong to it
SAME = 1e-6  # rad: error of single precision in an axis that was not turned


def frames_per_mm(feed: float, fps: float) -> float:
    """Plays at the speed of the cut; `feed` in mm/min."""
    if not (math.isfinite(feed) and feed > 0 and math.isfinite(fps) and fps > 0):
        raise ValueError("feed and frame rate must be positive")
    return 60 * fps / feed


class Track:
    """One path on the timeline. `stations`: arc length (mm) to its points, and of a loop to its first point again;
    `frames`: their frames."""

    def __init__(self, centres: np.ndarray, closed: bool, first: int, rate: float):
        ring = np.vstack([centres, centres[:1]]) if closed else centres
        self.closed, self.points = bool(closed), len(centres)
        self.stations = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(ring, axis=0), axis=1))])
        length = self.stations[-1]
        shares = self.stations / length if length > 0 else np.linspace(0, 1, len(ring))
        self.first = first
        self.last = first + (max(1, math.ceil(length * rate - 1e-9)) if len(ring) > 1 else 0)
        self.frames = self.first + shares * (self.last - self.first)

    def holds(self, frame: float) -> bool:
        return self.first - REACH <= frame <= self.last + REACH

    def nearest(self, frame: float) -> int:
        """The nearest point in time; the earlier of two equally near ones."""
        return int(np.abs(self.frames - frame).argmin()) % self.points

    def station(self, frame: float) -> float:
        """mm from the path's start."""
        return float(np.interp(frame, self.frames, self.stations))

    def frame_of(self, index: int) -> float:
        """The frame of the point's key: a whole frame, if that is still nearest to the point."""
        frame = float(self.frames[index])
        whole = min(max(round(frame), self.first), self.last)
        return float(whole) if self.nearest(whole) == index else frame


class Layout:
    """The tracks of all paths; `paths` have `centres` and `closed`, which never change. `known`: an earlier layout;
    paths that it has, at the same frames, keep their tracks. `made`: number of new tracks."""

    def __init__(self, paths, rate: float, first: int = 1, known: Layout | None = None):
        if not (math.isfinite(rate) and rate > 0):
            raise ValueError("frames per mm must be positive")
        self.paths, self.rate, self.first, self.made = list(paths), rate, first, 0
        self.tracks: list[Track] = []
        before = known.tracks if known is not None and known.rate == rate else []
        for k, path in enumerate(self.paths):
            if k < len(before) and known.paths[k] is path and before[k].first == first:
                self.tracks.append(before[k])
            else:
                self.tracks.append(Track(np.asarray(path.centres), path.closed, first, rate))
                self.made += 1
            first = self.tracks[-1].last + GAP
        self._firsts = np.array([t.first - REACH for t in self.tracks])

    def of(self, paths, rate: float, first: int) -> bool:
        """True if a layout of these paths would equal this one."""
        same = len(paths) == len(self.paths) and all(a is b for a, b in zip(paths, self.paths, strict=True))
        return same and (rate, first) == (self.rate, self.first)

    @property
    def last(self) -> int:
        return self.tracks[-1].last if self.tracks else 0

    def at(self, frame: float) -> int | None:
        """The number of the path at a frame."""
        k = int(np.searchsorted(self._firsts, frame, side="right")) - 1
        return k if k >= 0 and self.tracks[k].holds(frame) else None

    def place(self, frame: float) -> tuple[int, int, float] | None:
        """(path, nearest point, mm along the path) of a frame."""
        k = self.at(frame)
        return None if k is None else (k, self.tracks[k].nearest(frame), self.tracks[k].station(frame))


@dataclass
class Reading:
    """The keyframes' content: for each path a dict of point to unit axis, the frame of each key, and the keyframes that
    do not count."""

    keys: list[dict[int, np.ndarray]]
    frames: dict[tuple[int, int], float] = field(default_factory=dict)
    outside: list[float] = field(default_factory=list)  # frames on no path
    doubled: list[float] = field(default_factory=list)  # another key is nearer to the same point
    without: list[float] = field(default_factory=list)  # all four components are zero: no orientation

    @property
    def problems(self) -> list[str]:
        said = (
            (self.outside, "outside every path"),
            (self.doubled, "at a point that has a nearer key"),
            (self.without, "without an orientation (0, 0, 0, 0)"),
        )
        return [f"{_keys(frames)} {what}: ignored" for frames, what in said if frames]


def _keys(frames: list[float]) -> str:
    shown = ", ".join(f"{f:g}" for f in frames[:3]) + (" …" if len(frames) > 3 else "")
    return f"{'key' if len(frames) == 1 else 'keys'} at frame {shown}"


def read(layout: Layout, frames: np.ndarray, quats: np.ndarray) -> Reading:
    """`frames` (k,) and `quats` (k, 4) of the keyframes; the quaternions may have any length and sign."""
    out = Reading([{} for _ in layout.tracks])
    gaps: dict[tuple[int, int], float] = {}
    for frame, quat in zip(map(float, frames), quats, strict=True):
        place = layout.place(frame)
        if place is None:
            out.outside.append(frame)
            continue
        if not np.isfinite(quat).all() or np.linalg.norm(quat) < 1e-6:
            out.without.append(frame)
            continue
        path, index, _ = place
        gap = float(np.abs(layout.tracks[path].frames - frame).min())
        if (path, index) in gaps:
            loser = frame if gaps[path, index] <= gap else out.frames[path, index]
            out.doubled.append(loser)
            if loser == frame:
                continue
        gaps[path, index], out.frames[path, index] = gap, frame
        out.keys[path][index] = quaternions.axes_of(np.asarray(quat, float))
    out.keys = [dict(sorted(keys.items())) for keys in out.keys]
    return out


@dataclass
class Change:
    """Changes of a path's keys: their points; `moved` has (from, to). `keys`: all current keys; unchanged ones have the
    plan's exact values."""

    keys: dict[int, np.ndarray]
    added: list[int] = field(default_factory=list)
    moved: list[tuple[int, int]] = field(default_factory=list)
    deleted: list[int] = field(default_factory=list)
    turned: list[int] = field(default_factory=list)

    def __bool__(self) -> bool:
        return bool(self.added or self.moved or self.deleted or self.turned)


def change(before: dict[int, np.ndarray], after: dict[int, np.ndarray]) -> Change:
    """From the plan's keys of a path to those on the timeline."""
    out = Change({k: np.asarray(before[k] if k in before and _same(before[k], a) else a) for k, a in after.items()})
    out.turned = [k for k, axis in after.items() if k in before and not _same(before[k], axis)]
    gone, come = [k for k in before if k not in after], [k for k in after if k not in before]
    for k in gone:
        target = next((c for c in come if _same(before[k], after[c])), None)
        if target is None:
            out.deleted.append(k)
        else:
            out.moved.append((k, target))
            out.keys[target] = np.asarray(before[k])
            come.remove(target)
    out.added = come
    return out


def _same(a, b) -> bool:
    return float(quaternions.angle(np.asarray(a, float), np.asarray(b, float))) <= SAME


def written(layout: Layout, keys: list[dict], known: Reading | None = None, quats: dict | None = None):
    """Keyframes of a plan's keys: (frames (k,), quats (k, 4)), with the least twist and signs aligned. A key that
    `known`, the current keyframes, has unturned keeps its frame and its quaternion in `quats` (by frame)."""
    frames, rows = [], []
    for path, (track, of_path) in enumerate(zip(layout.tracks, keys, strict=True)):
        for index, axis in sorted(of_path.items(), key=lambda item: track.frames[item[0]]):
            frame, quat = track.frame_of(index), None
            if known is not None and index in known.keys[path] and _same(known.keys[path][index], axis):
                frame = known.frames[path, index]
                quat = (quats or {}).get(frame)
            if quat is None:
                quat = quaternions.transported(np.asarray(axis, float)[None], rows[-1] if rows else None)[0]
            frames.append(frame)
            rows.append(quat)
    order = np.argsort(frames, kind="stable")
    table = np.array(rows, float).reshape(-1, 4)[order]
    return np.array(frames, float)[order], quaternions.aligned(table)


def replaced(layout: Layout, keys: list[dict], frames: np.ndarray, quats: np.ndarray):
    """Keyframes of a plan's keys to replace those on the timeline, as in `written`; keyframes that do not count or are
    unturned stay unchanged."""
    known, by_frame = read(layout, frames, quats), dict(zip(map(float, frames), quats, strict=True))
    new_frames, new_quats = written(layout, keys, known, by_frame)
    stray = [f for f in (*known.outside, *known.doubled, *known.without) if not np.isin(f, new_frames)]
    if stray:
        new_frames = np.append(new_frames, stray)
        new_quats = np.vstack([new_quats, [by_frame[f] for f in stray]])
    order = np.argsort(new_frames, kind="stable")
    return new_frames[order], quaternions.aligned(new_quats[order])


def fingerprint(*arrays: np.ndarray) -> str:
    """Equal for equal arrays, in single precision."""
    digest = hashlib.blake2b(digest_size=16)
    for array in arrays:
        digest.update(str(np.shape(array)).encode())
        digest.update(np.ascontiguousarray(array, "<f4").tobytes())
    return digest.hexdigest()


def divided(path, rate: float):
    """The path with at least a point at each frame, so that a key can be set at every frame; its keys stay in place.
    The axes between keys are unchanged, except for the rule "linear", which counts points."""
    fine = path.divided(1 / rate)
    if len(fine) == len(path):
        return path
    if not len(path.axes):
        return fine
    places = _places(path.centres, fine.centres)
    if not path.interpolation or not path.keys:  # axes from another source: each is a key
        return fine.orient({places[k]: axis for k, axis in enumerate(path.axes)}, interpolation="slerp")
    return fine.orient({places[k]: axis for k, axis in path.keys.items()}, interpolation=path.interpolation)


def _places(points: np.ndarray, fine: np.ndarray) -> list[int]:
    """The rows of `fine` that are the points; it has them all, in order."""
    out, at = [], 0
    for point in points:
        while not np.array_equal(fine[at], point):
            at += 1
        out.append(at)
        at += 1
    return out
