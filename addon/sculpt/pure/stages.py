"""What showing a sculpt costs: milliseconds of the last looks, by stage, how long the hand's samples waited to be seen,
and counts that no machine changes."""

from __future__ import annotations

import time
from collections import deque
from contextlib import contextmanager

NAMES = ("cut", "mesh", "transfer", "draw")
COUNTS = ("moves", "bricks", "chunks", "triangles", "bytes")


class Stages:
    """`with stages.of("cut"): …` for what is timed, `count(bricks=3)` for what is counted; `looked` ends a look."""

    def __init__(self, keep: int = 30, clock=time.perf_counter):
        self._clock = clock
        self._looks: deque[dict[str, float]] = deque(maxlen=keep)
        self._waits: deque[float] = deque(maxlen=keep)
        self._now = dict.fromkeys((*NAMES, *COUNTS), 0.0)
        self.counts = dict.fromkeys(COUNTS, 0)

    @contextmanager
    def of(self, name: str):
        begin = self._clock()
        try:
            yield
        finally:
            self._now[name] += self._clock() - begin

    def add(self, name: str, seconds: float) -> None:
        self._now[name] += seconds

    def count(self, **counts: int) -> None:
        for name, n in counts.items():
            self.counts[name] += n
            self._now[name] += n

    def looked(self) -> None:
        self._looks.append(self._now)
        self._now = dict.fromkeys((*NAMES, *COUNTS), 0.0)

    def waited(self, seconds: float) -> None:
        """At most, from an event of the hand until what it has done was drawn."""
        self._waits.append(seconds)

    def lag(self) -> tuple[float, float]:
        """Milliseconds: the median and the longest of the waits that were kept."""
        return 1000 * _median(list(self._waits)), 1000 * max(self._waits, default=0.0)

    @property
    def newest(self) -> dict[str, float]:
        """Seconds of the last look, by stage."""
        return {name: self._looks[-1][name] for name in NAMES}

    def take_counts(self) -> dict[str, int]:
        """What was counted since the last call."""
        counts, self.counts = self.counts, dict.fromkeys(COUNTS, 0)
        return counts

    def milliseconds(self) -> dict[str, float]:
        """Of a look, by stage: the median of those that were kept."""
        return {name: 1000 * _median([look[name] for look in self._looks]) for name in NAMES}

    def per_look(self) -> dict[str, float]:
        """What was counted in a look: the mean of those that were kept."""
        return {name: sum(look[name] for look in self._looks) / max(len(self._looks), 1) for name in COUNTS}


def _median(values: list[float]) -> float:
    if not values:
        return 0.0
    values = sorted(values)
    middle = len(values) // 2
    return values[middle] if len(values) % 2 else 0.5 * (values[middle - 1] + values[middle])
