"""A stock as it is after any number of a program's rows: forwards by carving, backwards from snapshots.

Whatever way leads to a row, the stock is there what carving all rows up to it in one go makes it, to the byte.
"""

from __future__ import annotations

import time

import numpy as np

SNAPSHOTS = 64  # about as many are kept: going back takes at most that part of all the carving
LEAST = 32  # rows between two


class ProgramPrefix:
    """`stock` is changed; `runs`: (tool, poses (k, 6)), one after the other, in the stock's frame. A run's first row is
    where it begins: between two runs nothing is cut, as another tool is taken there."""

    def __init__(self, stock, runs, tolerance: float = 0.01, clock=time.perf_counter):
        self.volume, self._runs, self._tolerance, self._clock = stock, list(runs), tolerance, clock
        self._ends = np.cumsum([len(poses) for _, poses in self._runs])
        self.rows = int(self._ends[-1]) if len(self._ends) else 0
        if not self.rows:
            raise ValueError("there is nothing to simulate: the program has no rows")
        self.row = 0
        self.carved = 0  # rows, in all
        self._every = max(LEAST, -(-self.rows // SNAPSHOTS))
        self._kept = {0: stock.snapshot()}
        self._rate = 200.0  # rows per second; measured from the first slice on

    def step(self, row: int, budget: float = 0.02) -> bool:
        """Towards a row, for about `budget` seconds, one slice at least; True when the stock is there."""
        end = self._clock() + budget
        row = min(max(row, 0), self.rows - 1)
        self._jump(row)
        while self.row < row:
            left = max(end - self._clock(), 0.0)
            self._carve(int(min(row, self.row + max(1, self._rate * left))))
            if self.row < row and self._clock() >= end:
                return False
        return True

    def reset(self) -> None:
        """The stock as it was."""
        self.volume.restore(self._kept[0])
        self.row = 0

    def pose(self, row: int):
        """(tool, pose (6,)) with which the row ends."""
        run, at = self._place(min(max(row, 0), self.rows - 1))
        return self._runs[run][0], self._runs[run][1][at]

    def _place(self, row):
        run = int(np.searchsorted(self._ends, row, side="right"))
        return run, row - (int(self._ends[run - 1]) if run else 0)

    def _jump(self, row):
        best = max(k for k in self._kept if k <= row)
        if row < self.row or best > self.row:
            self.volume.restore(self._kept[best])
            self.row = best

    def _carve(self, last):
        """From where the stock is to `last`, or to the end of the run or to the next snapshot, which comes first."""
        run, at = self._place(self.row + 1)
        last = min(last, int(self._ends[run]) - 1, (self.row // self._every + 1) * self._every)
        tool, poses = self._runs[run]
        begin, count = self._clock(), last - self.row
        some = poses[max(at - 1, 0) : at + count]
        if len(some) > 1:
            self.volume.carve(tool, some, tolerance=self._tolerance)
        self.row, self.carved = last, self.carved + count
        spent = max(self._clock() - begin, 1e-6)
        self._rate = 0.5 * self._rate + 0.5 * count / spent
        if last % self._every == 0 and last not in self._kept:
            self._kept[last] = self.volume.snapshot()
