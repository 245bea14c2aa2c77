"""A program on the timeline: the frame at which each of its rows is done.

Rows from a plan's cutter locations are at the plan's frames; a program from elsewhere follows its own feeds.
"""

from __future__ import annotations

import math

import numpy as np

from ...common import quaternions

RAPID = 10_000.0  # mm/min
TURN = math.radians(3600)  # rad/min of an axis that turns while the tip does not move
LEAD = 5  # frames before a path's beginning and after its end, for approach and retract
MOST = 100_000  # frames: longer programs are played faster
REACH = 4096  # other rows that may lie between two matching ones
HERE = 1e-3  # mm and axis: tolerance for the same place, after being written as text


class ProgramTimeline:
    """`frames` (n,) of a program's rows, monotonic."""

    def __init__(self, frames: np.ndarray):
        self.frames = np.maximum.accumulate(np.asarray(frames, float))

    @property
    def first(self) -> int:
        return math.floor(self.frames[0])

    @property
    def last(self) -> int:
        return math.ceil(self.frames[-1] - 1e-6)

    def row_at(self, frame: float) -> int:
        """The last row done at a frame; before all of them the first, where the tool begins."""
        return max(0, int(np.searchsorted(self.frames, frame + 1e-3, side="right")) - 1)

    def frame_of(self, row: int) -> int:
        """The first whole frame at which the row is done."""
        return math.ceil(self.frames[row] - 1e-3)


def seconds(poses: np.ndarray, feed: np.ndarray, rapid: np.ndarray) -> np.ndarray:
    """(n,) duration of each row's move; row 0: 0. `feed`: mm/min."""
    way = np.linalg.norm(np.diff(poses[:, :3], axis=0), axis=1)
    turn = quaternions.angle(poses[:-1, 3:], poses[1:, 3:])
    speed = np.where(rapid[1:], RAPID, feed[1:])
    with np.errstate(divide="ignore", invalid="ignore"):
        minutes = np.where(way > 0, way / speed, turn / TURN)
    return np.concatenate([[0.0], 60 * minutes])


def by_time(duration: np.ndarray, fps: float, first: int = 1, most: int = MOST) -> ProgramTimeline:
    """Frames from `seconds`, compressed to at most `most` frames."""
    at = np.cumsum(duration) * fps
    return ProgramTimeline(first + at * min(1.0, most / max(at[-1], 1e-9)))


def of_paths(poses: np.ndarray, paths: list) -> ProgramTimeline:
    """For a program (n, 6) made from `paths`: (rows (k, 6), their frames (k,)), in order, with moves of its own before,
    between and after them. ValueError if it does not contain them."""
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
    """The rows at which `paths`, each (k, 6), begin in a program (n, 6) that contains them in order. ValueError if it
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
    """The first row from `begin` on where `rows` follow one another."""
    for at in begin + np.flatnonzero(np.abs(poses[begin : len(poses) - len(rows) + 1] - rows[0]).max(axis=1) < HERE):
        if np.abs(poses[at : at + len(rows)] - rows).max() < HERE:
            return int(at)
    return None


def like_paths(poses: np.ndarray, paths: list) -> ProgramTimeline | None:
    """For a program (n, 6) written from `paths`, read again and perhaps edited: it has other rows between theirs. None
    unless it contains nine in ten of them, in order."""
    rows, when = (np.concatenate([p[k] for p in paths]) for k in (0, 1))
    found = _in_order(rows, poses)
    there = np.flatnonzero(found >= 0)
    if len(there) < 0.9 * len(rows):
        return None
    at, frames = found[there], when[there]
    ends = [max(frames[0] - LEAD, min(frames[0], 0.0)), *frames, frames[-1] + LEAD]
    return ProgramTimeline(np.interp(np.arange(len(poses)), [at[0] - 1, *at, at[-1] + 1], ends))


def lines(poses: np.ndarray, read: np.ndarray, numbers: np.ndarray) -> np.ndarray:
    """(n,) line numbers of a program's rows in the text it was written as: `read` (m, 6) and `numbers` (m,) are the
    text read again, which has each of the rows, in order, and rows between them. 0 for rows that are not found."""
    found = _in_order(poses, read)
    return np.where(found >= 0, numbers[found], 0)


def _in_order(rows, poses):
    """(n,) for each row the index of the first equal one in `poses` after the match of the row before; -1 if it is not
    among the next ones, and for all rows if hardly any is found."""
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
    size = 8  # it is mostly the next one
    while at < len(poses) and size <= REACH:
        near = np.abs(poses[at : at + size] - row).max(axis=1) < HERE
        if near.any():
            return at + int(near.argmax())
        at, size = at + size, 8 * size
    return None
