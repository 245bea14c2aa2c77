"""The stock after any number of a program's rows. Forwards it is carved, backwards it is restored from snapshots.

The order of visits does not matter: at each row the stock has the same bytes as after carving all rows up to it in one
call.
"""

from __future__ import annotations

import time

import numpy as np

SNAPSHOTS = 64  # approximate number kept: a step back carves at most this fraction of the program again
LEAST = 32  # rows between two snapshots


class ProgramPrefix:
    """`stock` is changed; `runs`: (tool, poses (k, 6)), in sequence, in the stock's frame. A run begins at its first
    row: between two runs the tool is changed, and nothing is cut."""

    def __init__(self, stock, runs, tolerance: float = 0.01, clock=time.perf_counter):
        self.volume, self._runs, self._tolerance, self._clock = stock, list(runs), tolerance, clock
        self._ends = np.cumsum([len(poses) for _, poses in self._runs])
        self.rows = int(self._ends[-1]) if len(self._ends) else 0
        if not self.rows:
            raise ValueError("there is nothing to simulate: the program has no rows")
        self.row = 0
        self.carved = 0  # number of carved rows
        self._every = max(LEAST, -(-self.rows // SNAPSHOTS))
        self._kept = {0: stock.snapshot()}
        self._rate = 200.0  # rows per second; measured from the first slice on

    def step(self, row: int, budget: float = 0.02) -> bool:
        """Carves towards a row, for about `budget` seconds, at least one slice; True when the stock has reached it."""
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
        """Restores the initial stock."""
        self.volume.restore(self._kept[0])
        self.row = 0

    def pose(self, row: int):
        """(tool, pose (6,)) at the end of the row."""
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
        """Carves from the current row to the first of `last`, the end of the run and the next snapshot."""
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
