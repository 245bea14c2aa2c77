"""The tool's motion on the timeline: its pose at each frame, along one path.

The rows are those that become NC code, so that the animation shows the cut: the plan's cutter locations if it has them,
otherwise the poses of the path itself.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ...common import quaternions
from .key_orientations import Track

STEP = math.radians(2)  # largest turn between two keys: there normalised lerp equals the great circle within 1e-6 rad
GAP = 0.0101  # frames: Blender's 0.01 (BEZT_BINARYSEARCH_THRESH), plus the error of single precision
MATCH = 1e-6  # mm off the axis, or rad: tolerance for the same location, lifted or not


@dataclass
class Motion:
    """`frames` (n,) of one path, in order, and `poses` (n, 6): tip and unit axis, mm."""

    frames: np.ndarray
    poses: np.ndarray

    def __len__(self) -> int:
        return len(self.frames)


def along(track: Track, start: np.ndarray, points: np.ndarray, cl: np.ndarray | None) -> Motion:
    """`start` (m, 6): the locations of the path's points before any lift, of a loop the first once more at the end;
    `points` (m,): their numbers. `cl` (n, 6): the plan's cutter locations, or None."""
    number = np.array(points)
    if track.closed and len(number) > 1 and number[-1] == 0:
        number[-1] = track.points  # the last row of a loop is its first point, at the last frame
    frames = track.frames[number]
    if cl is None or not len(cl):
        return Motion(frames, start)
    return Motion(_frames_of_rows(cl, start, frames, (track.first, track.last)), cl)


def _frames_of_rows(cl: np.ndarray, start: np.ndarray, frames: np.ndarray, ends: tuple[float, float]) -> np.ndarray:
    """A location that was lifted along its axis is at its point's frame; inserted ones lie between, in proportion to
    the tip's distance."""
    number = points_of_rows(cl, start)
    known = np.where(number >= 0, frames[number], np.nan)
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(cl[:, :3], axis=0), axis=1))])
    if not way[-1] > 0:
        way = np.arange(len(cl), dtype=float)
    if np.isnan(known[0]):
        known[0] = ends[0]
    if np.isnan(known[-1]):
        known[-1] = ends[1]
    there = ~np.isnan(known)
    way += 1e-12 * np.arange(len(cl))  # where the tip does not move, in order of the rows
    frames, ends = np.interp(way, way[there], known[there]), np.flatnonzero(there)
    for i, j in pairwise(ends):
        if j > i + 1 and np.diff(frames[i : j + 1]).min() <= GAP < known[j] - known[i]:
            frames[i : j + 1] = _spread(frames[i : j + 1])
    return frames


def points_of_rows(cl: np.ndarray, start: np.ndarray) -> np.ndarray:
    """(n,) for each cutter location the number of its location in `start` (m, 6), lifted or not; -1 for inserted ones.
    They are in order."""
    found, at = np.full(len(cl), -1), 0
    for row, pose in enumerate(cl):
        hit = _first_like(pose, start, at)
        if hit is not None:
            found[row], at = hit, hit + 1
    return found


def _spread(frames: np.ndarray) -> np.ndarray:
    """The same beginning and end, and every step long enough for a key of its own, if there is room: next to a long
    vertical lift the inserted rows would have almost the same frame."""
    even = np.linspace(frames[0], frames[-1], len(frames))
    share = min(1.0, 1.5 * GAP / (even[1] - even[0]))
    return frames + share * (even - frames)


def _first_like(pose: np.ndarray, start: np.ndarray, at: int) -> int | None:
    """The first location from number `at` on with the pose's axis and the pose on it."""
    ahead = 8  # it is mostly the next one
    while at < len(start):
        some = start[at : at + ahead]
        off = pose[:3] - some[:, :3]
        aside = off - np.einsum("ij,ij->i", off, some[:, 3:])[:, None] * some[:, 3:]
        hit = (np.linalg.norm(aside, axis=1) <= MATCH) & (quaternions.angle(some[:, 3:], pose[3:]) <= MATCH)
        if hit.any():
            return at + int(hit.argmax())
        at, ahead = at + ahead, 8 * ahead
    return None


def distinct(motion: Motion) -> Motion:
    """Removes rows that Blender cannot store as keys: frames are single precision there, and from 4.x on Blender merges
    keys no more than GAP apart into one, with the frame of the first and the value of the last."""
    frames = np.maximum.accumulate(np.asarray(motion.frames, np.float32)).astype(float)
    rows = np.flatnonzero(np.append(frames[1:] > frames[:-1], True))
    if (np.diff(frames[rows]) <= GAP).any():
        rows = _apart(frames, rows)
    return Motion(frames[rows], motion.poses[rows])


def _apart(frames: np.ndarray, rows: np.ndarray) -> list[int]:
    """As many of these rows as are more than GAP apart, including the last."""
    kept: list[int] = []
    for row in rows.tolist():
        if not kept or frames[row] - frames[kept[-1]] > GAP:
            kept.append(row)
    if kept[-1] != rows[-1]:
        if len(kept) > 1:  # a path needs both its ends
            kept.pop()
        kept.append(int(rows[-1]))
    return kept


def between(poses: np.ndarray, row: np.ndarray, share: np.ndarray) -> np.ndarray:
    """Poses between row and row + 1, interpolated as in programs: the tip on a line, the axis on the great circle."""
    after = np.minimum(row + 1, len(poses) - 1)
    tips = poses[row, :3] + share[:, None] * (poses[after, :3] - poses[row, :3])
    return np.hstack([tips, quaternions.slerp(poses[row, 3:], poses[after, 3:], share)])


def fine(motion: Motion, step: float = STEP) -> Motion:
    """Inserts rows where the axis turns by more than `step` (rad)."""
    turn = quaternions.angle(motion.poses[:-1, 3:], motion.poses[1:, 3:])
    pieces = np.maximum(1, np.ceil(turn / step - 1e-9)).astype(int)
    row = np.repeat(np.arange(len(pieces)), pieces)
    share = np.concatenate([np.arange(n) / n for n in pieces]) if len(pieces) else np.empty(0)
    frames = motion.frames[row] + share * (np.diff(motion.frames)[row] if len(pieces) else 0)
    poses = between(motion.poses, row, share)
    whole = share == 0
    poses[whole] = motion.poses[row[whole]]
    return distinct(Motion(np.append(frames, motion.frames[-1]), np.vstack([poses, motion.poses[-1:]])))


@dataclass
class Played:
    """The animation of one path: fine rows, with the least twist from one to the next."""

    frames: np.ndarray
    poses: np.ndarray
    quats: np.ndarray  # (n, 4)


def played(motion: Motion) -> Played:
    """Depends on this path only, not on the others."""
    if not len(motion):
        return Played(motion.frames, motion.poses, np.empty((0, 4)))
    rows = fine(motion)
    return Played(rows.frames, rows.poses, quaternions.transported(rows.poses[:, 3:]))


def joined(paths: list[Played]) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """All paths as one animation: frames (n,), tips (n, 3) mm, quaternions (n, 4), and the rows after which the tool
    jumps to the next path."""
    paths = [p for p in paths if len(p.frames)]
    if not paths:
        return np.empty(0), np.empty((0, 3)), np.empty((0, 4)), np.empty(0, int)
    ends = np.cumsum([len(p.frames) for p in paths]) - 1
    poses = np.vstack([p.poses for p in paths])
    return np.concatenate([p.frames for p in paths]), poses[:, :3], np.vstack([p.quats for p in paths]), ends
