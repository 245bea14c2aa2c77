"""The cost of displaying a sculpt: milliseconds of the last updates, by stage, the delay from the pointer's samples to
the screen, and counts that do not depend on the computer."""

from __future__ import annotations

import time
from collections import deque
from contextlib import contextmanager

NAMES = ("cut", "mesh", "transfer", "draw")
COUNTS = ("moves", "bricks", "chunks", "triangles", "bytes")


class Stages:
    """`with stages.of("cut"): …` measures time, `count(bricks=3)` counts; `looked` ends an update."""

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
        """Records the longest delay from a pointer event until its effect was drawn."""
        self._waits.append(seconds)

    def lag(self) -> tuple[float, float]:
        """Milliseconds: the median and the longest of the recorded delays."""
        return 1000 * _median(list(self._waits)), 1000 * max(self._waits, default=0.0)

    @property
    def newest(self) -> dict[str, float]:
        """Seconds of the last update, by stage."""
        return {name: self._looks[-1][name] for name in NAMES}

    def take_counts(self) -> dict[str, int]:
        """The counts since the last call."""
        counts, self.counts = self.counts, dict.fromkeys(COUNTS, 0)
        return counts

    def milliseconds(self) -> dict[str, float]:
        """Milliseconds of an update, by stage: the median of the recorded ones."""
        return {name: 1000 * _median([look[name] for look in self._looks]) for name in NAMES}

    def per_look(self) -> dict[str, float]:
        """Counts per update: the mean of the recorded ones."""
        return {name: sum(look[name] for look in self._looks) / max(len(self._looks), 1) for name in COUNTS}


def _median(values: list[float]) -> float:
    if not values:
        return 0.0
    values = sorted(values)
    middle = len(values) // 2
    return values[middle] if len(values) % 2 else 0.5 * (values[middle - 1] + values[middle])
