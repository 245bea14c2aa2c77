"""Where the tool collides along an animation: clearances of its rows, the frames of those that are too small, and names
for runs of frames."""

from __future__ import annotations

import time
from itertools import pairwise

import numpy as np

from ...common import units

MOST = 64  # markers: more would not help the user
SLICE = 64  # poses in one call


class ClearanceJob:
    """Clearances (mm) of poses (n, 6) as a job for blender/long_work.py; `collider` has `clearance(tool, poses)`.
    `known`, a dict of a pose's bytes to its clearance, gives results that are not computed again, and receives the new
    ones. `computed`: their number."""

    in_background = False

    def __init__(self, collider, tool, poses: np.ndarray, known: dict[bytes, float], clock=time.perf_counter):
        self._collider, self._tool, self._known, self._clock = collider, tool, known, clock
        self._poses = np.ascontiguousarray(poses, float)
        self._names = [row.tobytes() for row in self._poses]
        new = {name: k for k, name in enumerate(self._names) if name not in known}
        self._rows = np.array(list(new.values()), int)
        self.computed = 0

    @property
    def fraction(self) -> float:
        return self.computed / len(self._rows) if len(self._rows) else 1.0

    @property
    def text(self) -> str:
        return f"Pose {units.format_count(self.computed)} of {units.format_count(len(self._rows))}"

    def step(self, budget: float = 0.04) -> bool:
        end = self._clock() + budget
        while self.computed < len(self._rows):
            rows = self._rows[self.computed : self.computed + SLICE]
            for row, value in zip(rows, self._collider.clearance(self._tool, self._poses[rows]), strict=True):
                self._known[self._names[row]] = float(value)
            self.computed += len(rows)
            if self._clock() >= end:
                break
        return self.computed == len(self._rows)

    def cancel(self) -> None:
        """Keeps the known clearances, which stay valid."""

    @property
    def clearances(self) -> np.ndarray:
        """(n,) once all are computed."""
        return np.array([self._known[name] for name in self._names])


def runs(frames: np.ndarray, clearances: np.ndarray, least: float, ends=()) -> list[tuple[int, int]]:
    """First and last frame of each run in which the clearance is below `least`; from row to row, extended to whole
    frames. `ends`: rows after which a run cannot continue."""
    bad = np.flatnonzero(np.asarray(clearances) < least)
    if not len(bad):
        return []
    parted = (np.diff(bad) > 1) | np.isin(bad[:-1], ends)
    firsts, lasts = np.append(bad[0], bad[1:][parted]), np.append(bad[:-1][parted], bad[-1])
    found = [
        (int(np.floor(frames[a] + 1e-6)), int(np.ceil(frames[b] - 1e-6))) for a, b in zip(firsts, lasts, strict=True)
    ]
    return union([found])


def union(lists) -> list[tuple[int, int]]:
    """The union of several lists of runs: in order, overlapping runs merged."""
    out: list[tuple[int, int]] = []
    for begin, end in sorted(run for found in lists for run in found):
        if out and begin <= out[-1][1]:
            out[-1] = (out[-1][0], max(end, out[-1][1]))
        else:
            out.append((begin, end))
    return out


def merged(found: list[tuple[int, int]], most: int = MOST) -> list[tuple[int, int]]:
    """At most so many runs: those with the smallest gaps are merged."""
    if len(found) <= most:
        return list(found)
    gaps = np.array([b[0] - a[1] for a, b in pairwise(found)])
    kept = sorted(np.argsort(-gaps, kind="stable")[: most - 1])
    firsts = [found[0][0], *(found[k + 1][0] for k in kept)]
    lasts = [*(found[k][1] for k in kept), found[-1][1]]
    return list(zip(firsts, lasts, strict=True))


def label(run: tuple[int, int]) -> str:
    return f"collides {run[0]}" if run[0] == run[1] else f"collides {run[0]}–{run[1]}"


def is_label(name: str) -> bool:
    word, _, numbers = name.partition(" ")
    parts = numbers.split("–")
    return word == "collides" and len(parts) <= 2 and all(p.lstrip("-").isdigit() for p in parts)
