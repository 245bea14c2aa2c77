"""A plan's lines in the view, by the tool's movement along them: along the ball's centres, in mm.

Segments are (n, 2, 3), the two ends of each.
"""

from __future__ import annotations

import numpy as np

from . import motion

# In a legend's order: problems first, then what is written, then what is not.
KINDS = ("collides", "blocked", "lifted", "cut", "lead", "retract", "rapid", "keyed", "unplanned", "off")
LIFTED = 1e-3  # mm: smaller lifts are rounding


def of_path(path, rows, state: str, hits=()) -> dict[str, np.ndarray]:
    """{kind: segments} of one path in a state of plan/path_rows.py; `rows`: its cutter locations, or None; `hits`: for
    each point, and of a loop for the first once more, whether the tool collides there, or empty."""
    if state != "free" or rows is None or not len(rows):
        line = np.vstack([path.centres, path.centres[:1]]) if path.closed else path.centres
        both = pieces(line)
        if state not in ("keyed", "unplanned") or len(hits) != len(line):
            return {state: both}
        off = np.asarray(hits[:-1]) | np.asarray(hits[1:])
        return {state: both[~off], "collides": both[off]}
    line, high = centres(rows, path.radius), lifts(path, rows) > LIFTED
    both, off = pieces(line), high[:-1] | high[1:]
    return {"cut": both[~off], "lifted": both[off]}


def hits(frames: np.ndarray, runs) -> np.ndarray:
    """Which frames (n,) lie in runs of whole frames (first, last)."""
    found = np.zeros(len(frames), bool)
    for first, last in runs:
        found |= (frames >= first - 1e-6) & (frames <= last + 1e-6)
    return found


def centres(rows: np.ndarray, radius: float) -> np.ndarray:
    return rows[:, :3] + radius * rows[:, 3:]


def pieces(line: np.ndarray) -> np.ndarray:
    return np.stack([line[:-1], line[1:]], axis=1)


def lifts(path, rows: np.ndarray) -> np.ndarray:
    """(n,) mm by which rows are lifted off their path along the tool axis; for inserted rows, interpolated."""
    start = np.hstack([path.centres - path.radius * path.axes, path.axes])
    if path.closed:
        start = np.vstack([start, start[:1]])
    number = motion.points_of_rows(rows, start)
    known = np.flatnonzero(number >= 0)
    if not len(known):
        return np.zeros(len(rows))
    off = rows[known, :3] - start[number[known], :3]
    return np.interp(np.arange(len(rows)), known, np.einsum("ij,ij->i", off, rows[known, 3:]))


def of_links(poses: np.ndarray, begins: list[int], lengths: list[int], radius: float) -> dict[str, np.ndarray]:
    """{kind: segments} of a program's own rows: before, between and after the cuts, which are `lengths` rows long from
    `begins` on. The first move up from a cut is a retract, the last one down to the next a lead-in, all between a
    rapid."""
    line, found = centres(poses, radius), {"lead": [], "retract": [], "rapid": []}
    ends = [b + n - 1 for b, n in zip(begins, lengths, strict=True)]
    for first, last in zip([0, *ends], [*begins, len(poses) - 1], strict=True):
        way, both = poses[first : last + 1, 2], pieces(line[first : last + 1])
        if not len(both):
            continue
        top = np.flatnonzero(way >= way.max() - 1e-6)
        up = top[0] if first else 0
        down = top[-1] if last < len(poses) - 1 or not ends else len(way) - 1
        found["retract"].append(both[:up])
        found["rapid"].append(both[up:down])
        found["lead"].append(both[down:])
    return {kind: np.concatenate(some) for kind, some in found.items() if some}
