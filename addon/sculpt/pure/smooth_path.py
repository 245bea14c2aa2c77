"""A smooth path through the pointer's samples. A mouse reports whole pixels: a tool that went straight from one to the
next would turn by 20° at nearly every sample, and its groove would look like bamboo.

A cubic runs through the samples, and the path is its mean over `REACH` pixels before and behind each place. The mean is
centred, so a curve stays in place: one of radius R moves inwards by REACH² / 10 R. The price is that the path is final
only `REACH` pixels and one sample behind the pointer. Beyond both ends the cubic continues as its mirror image, so the
path begins at the first sample and ends at the last. It depends on the samples alone, not on the times of the calls.
"""

from __future__ import annotations

import numpy as np

REACH = 10.0  # pixels
# pixels: the distance that a change of pressure from 0 to 1 counts as, so that a pen at rest can press harder
PRESSED = 10.0
OFFSETS = np.linspace(-1, 1, 25)[1:-1]
# Epanechnikov's kernel: nearly the best noise damping of all with the same reach
WEIGHTS = (1 - OFFSETS**2) / (1 - OFFSETS**2).sum()
MOST = 1024  # rows between two samples


class SmoothPath:
    """Call `add` with rows (x and y in pixels, pressure, more columns), then `finish`, once. `at` returns the path's
    rows."""

    def __init__(self):
        self._knots: list[np.ndarray] = []  # the last three samples
        self._places: list[float] = []  # their distances along the path, pixels
        self._rows = np.empty((0, 0))  # of the cubic, about one a pixel
        self._along = np.empty(0)
        self._reach, self._begin, self._end = REACH, None, None

    @property
    def ready(self) -> float:
        """Length of the final part of the path, in pixels from its first sample."""
        return self._along[-1] if self._end is not None else max(0.0, self._along[-1] - REACH)

    def add(self, row) -> None:
        row = np.asarray(row, float)
        if not self._knots:
            self._knots, self._places, self._begin = [row], [0.0], row
            self._rows, self._along = row[None], np.zeros(1)
            return
        change = row[:3] - self._knots[-1][:3]
        way = float(np.hypot(np.hypot(change[0], change[1]), PRESSED * change[2]))
        if way == 0:
            return
        self._knots.append(row)
        self._places.append(self._places[-1] + way)
        if len(self._knots) > 2:
            self._join(-3)
            del self._knots[:-3], self._places[:-3]

    def finish(self) -> None:
        if len(self._knots) > 1:
            self._join(-2)
        self._end = self._rows[-1]
        self._reach = min(REACH, self._along[-1])  # for a shorter stroke

    def at(self, along) -> np.ndarray:
        """Rows (n, columns) at `along` (n,), all of them within `ready`."""
        asked = np.asarray(along, float)[:, None] + self._reach * OFFSETS
        rows = np.einsum("k,nkc->nc", WEIGHTS, self._cubic(asked))
        rows[:, 2] = np.clip(rows[:, 2], 0, 1)
        return rows

    def forget(self, along: float) -> None:
        """Forgets what is before: it is not needed any more."""
        first = int(np.searchsorted(self._along, along - REACH)) - 1
        if along > 2 * REACH and first > 0:
            self._rows, self._along = self._rows[first:], self._along[first:]

    # ------------------------------------------------------------------ within
    def _cubic(self, asked) -> np.ndarray:
        """Rows of the cubic, or of its images beyond both ends."""
        end = self._along[-1]
        before, behind = asked < 0, asked > end
        inside = np.where(before, -asked, np.where(behind, 2 * end - asked, asked))
        if len(self._along) == 1:
            rows = np.broadcast_to(self._rows[0], (*asked.shape, len(self._begin))).copy()
        else:
            k = np.clip(np.searchsorted(self._along, inside) - 1, 0, len(self._along) - 2)
            share = ((inside - self._along[k]) / (self._along[k + 1] - self._along[k]))[..., None]
            rows = (1 - share) * self._rows[k] + share * self._rows[k + 1]
        rows[before] = 2 * self._begin - rows[before]
        if self._end is not None:
            rows[behind] = 2 * self._end - rows[behind]
        return rows

    def _join(self, k: int) -> None:
        """The cubic from knot k to the next, Catmull–Rom for uneven steps; other columns are interpolated linearly."""
        a, b = self._knots[k], self._knots[k + 1]
        way = self._places[k + 1] - self._places[k]
        share = np.linspace(0, 1, int(np.clip(np.ceil(way), 1, MOST)) + 1)[1:, None]
        rows = a + share * (b - a)
        chord = b[:2] - a[:2]
        leave, arrive = way * self._slope(k), way * self._slope(k + 1)
        rest = share * (1 - share)
        rows[:, :2] += rest * ((1 - share) * (leave - chord) - share * (arrive - chord))
        self._rows = np.vstack([self._rows, rows])
        self._along = np.append(self._along, self._places[k] + way * share[:, 0])

    def _slope(self, k: int) -> np.ndarray:
        """Slope of the parabola through a knot and its neighbours; of the chord at the first and at the last."""
        steps = []
        for i in (k - 1, k):
            if -len(self._knots) <= i and i + 1 <= -1:
                way = self._places[i + 1] - self._places[i]
                steps.append(((self._knots[i + 1][:2] - self._knots[i][:2]) / way, way))
        if len(steps) == 1:
            return steps[0][0]
        (before, h), (behind, g) = steps
        return (g * before + h * behind) / (g + h)
