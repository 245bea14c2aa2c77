"""Earlier cutter locations of paths, for keys that come back. In a window the plan's update follows after the undo step
of a key: undo restores the keyframe, but not the plan."""

from __future__ import annotations

from collections import OrderedDict

import numpy as np

from . import key_orientations

COUNT, NBYTES = 2000, 64_000_000  # number and bytes of the stored locations: more than many steps of one plan


class Resolved:
    """The locations of one plan's paths. `mark`: what they are free of (plan/plan_store.py); without one they are not
    stored."""

    def __init__(self, count: int = COUNT, nbytes: int = NBYTES):
        self._count, self._most, self._nbytes = count, nbytes, 0
        self._kept: OrderedDict[tuple, tuple] = OrderedDict()  # holds the path, so that its id stays unique

    def __len__(self) -> int:
        return len(self._kept)

    def put(self, number: int, path, rows, mark) -> None:
        """Stores a path's locations, `rows` (n, 6) or None; the newest ones stay."""
        if rows is None or not len(rows) or not mark:
            return
        name = number, id(path)
        if name in self._kept:
            self._nbytes -= self._kept.pop(name)[1].nbytes
        self._kept[name] = path, rows, mark
        self._nbytes += rows.nbytes
        while len(self._kept) > 1 and (len(self._kept) > self._count or self._nbytes > self._most):
            self._nbytes -= self._kept.popitem(last=False)[1][1].nbytes

    def get(self, number: int, path, wanted: dict, mark):
        """(path, rows) of that path with the keys `wanted`, within single precision, or None."""
        for (other, _), (before, rows, marked) in reversed(self._kept.items()):
            if (
                (other, marked) == (number, mark)
                and _same(before, path)
                and not key_orientations.change(before.keys, wanted)
            ):
                return before, rows
        return None


def _same(before, path) -> bool:
    """Equal except for the keys."""
    rule = before.interpolation == (path.interpolation or before.interpolation)
    return rule and before.closed == path.closed and np.array_equal(before.centres, path.centres)
