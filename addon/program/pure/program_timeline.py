"""A program on the timeline: at which frame each of its rows is done.

The rows that a plan's cutter locations become are at the frames at which the plan plays them; a program that comes from
elsewhere goes at its own feeds.
"""

from __future__ import annotations

import math

import numpy as np

from ...common import quaternions

RAPID = 10_000.0  # mm/min
TURN = math.radians(3600)  # rad/min of an axis that turns while the tip stands still
LEAD = 5  # frames before a path's beginning and after its end, for approach and retract
MOST = 100_000  # frames: what takes longer is played faster
REACH = 4096  # rows that may lie between two of them
HERE = 1e-3  # mm and axis: the same place, after having been written as text


class ProgramTimeline:
    """`frames` (n,) of a program's rows, never falling."""

    def __init__(self, frames: np.ndarray):
        self.frames = np.maximum.accumulate(np.asarray(frames, float))

    @property
    def first(self) -> int:
        return math.floor(self.frames[0])

    @property
    def last(self) -> int:
        return math.ceil(self.frames[-1] - 1e-6)

    def row_at(self, frame: float) -> int:
        """The last row that is done at a frame; before all of them the first, which is where the tool begins."""
        return max(0, int(np.searchsorted(self.frames, frame + 1e-3, side="right")) - 1)

    def frame_of(self, row: int) -> int:
        """The first whole frame at which the row is done."""
        return math.ceil(self.frames[row] - 1e-3)


def seconds(poses: np.ndarray, feed: np.ndarray, rapid: np.ndarray) -> np.ndarray:
    """(n,) what each row's move takes; row 0: nothing. `feed`: mm/min."""
    way = np.linalg.norm(np.diff(poses[:, :3], axis=0), axis=1)
    turn = quaternions.angle(poses[:-1, 3:], poses[1:, 3:])
    speed = np.where(rapid[1:], RAPID, feed[1:])
    with np.errstate(divide="ignore", invalid="ignore"):
        minutes = np.where(way > 0, way / speed, turn / TURN)
    return np.concatenate([[0.0], 60 * minutes])


def by_time(duration: np.ndarray, fps: float, first: int = 1, most: int = MOST) -> ProgramTimeline:
    """As `seconds` says, or as fast as it takes to end within `most` frames."""
    at = np.cumsum(duration) * fps
    return ProgramTimeline(first + at * min(1.0, most / max(at[-1], 1e-9)))


def of_paths(poses: np.ndarray, paths: list) -> ProgramTimeline:
    """Of a program (n, 6) that is made of `paths`: (rows (k, 6), their frames (k,)), in order, with ways of its own
    before, between and after them. ValueError where it does not have them."""
    frames, at = np.full(len(poses), np.nan), 0
    for begin, (_, when) in zip(begins(poses, [rows for rows, _ in paths]), paths, strict=True):
        at = begin + len(when)
        frames[begin:at] = when
    if at == 0:
        raise ValueError("there are no paths")
    cut = np.flatnonzero(~np.isnan(frames))
    begin, end = frames[cut[0]], frames[cut[-1]]
    frames[0] = begin if cut[0] == 0 else max(begin - LEAD, min(begin, 0.0))  # timelines begin at 0
    frames[-1] = end + LEAD * (at < len(poses))
    known = np.flatnonzero(~np.isnan(frames))
    return ProgramTimeline(np.interp(np.arange(len(frames)), known, frames[known]))


def begins(poses: np.ndarray, paths: list) -> list[int]:
    """The rows at which `paths`, each (k, 6), begin in a program (n, 6) that has them in order. ValueError where it
    does not."""
    out, at = [], 0
    for number, rows in enumerate(paths):
        begin = _find(poses, rows, at)
        if begin is None:
            raise ValueError(f"the program does not contain path {number + 1} unchanged")
        out.append(begin)
        at = begin + len(rows)
    return out


def _find(poses, rows, begin):
    """The first row from `begin` on where `rows` are, one after the other."""
    for at in begin + np.flatnonzero(np.abs(poses[begin : len(poses) - len(rows) + 1] - rows[0]).max(axis=1) < HERE):
        if np.abs(poses[at : at + len(rows)] - rows).max() < HERE:
            return int(at)
    return None


def like_paths(poses: np.ndarray, paths: list) -> ProgramTimeline | None:
    """Of a program (n, 6) that was written from `paths`, read again and perhaps edited: it has other rows between
    theirs. None where it has not nine in ten of them, in order."""
    rows, when = (np.concatenate([p[k] for p in paths]) for k in (0, 1))
    found = _in_order(rows, poses)
    there = np.flatnonzero(found >= 0)
    if len(there) < 0.9 * len(rows):
        return None
    at, frames = found[there], when[there]
    ends = [max(frames[0] - LEAD, min(frames[0], 0.0)), *frames, frames[-1] + LEAD]
    return ProgramTimeline(np.interp(np.arange(len(poses)), [at[0] - 1, *at, at[-1] + 1], ends))


def lines(poses: np.ndarray, read: np.ndarray, numbers: np.ndarray) -> np.ndarray:
    """(n,) the source lines of a program's rows, of the text it was written as: `read` (m, 6) and `numbers` (m,) are
    that read again, which has each of the rows, in order, and rows between them. 0 where a row is not found."""
    found = _in_order(poses, read)
    return np.where(found >= 0, numbers[found], 0)


def _in_order(rows, poses):
    """(n,) of each row the first of `poses` after that of the row before where it is; -1 where it is not among the next
    ones, and for all where hardly any is."""
    out, at, missed = np.full(len(rows), -1), 0, 0
    for k, row in enumerate(rows):
        hit = _ahead(poses, row, at)
        if hit is not None:
            out[k], at = hit, hit + 1
        else:
            missed += 1
            if missed > 100 + k // 5:
                return np.full(len(rows), -1)
    return out


def _ahead(poses, row, at):
    size = 8  # most often it is the very next
    while at < len(poses) and size <= REACH:
        near = np.abs(poses[at : at + size] - row).max(axis=1) < HERE
        if near.any():
            return at + int(near.argmax())
        at, size = at + size, 8 * size
    return None
