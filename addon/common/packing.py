"""When a live sculpt is packed into the file: at the end of a stroke as long as nobody can feel it, otherwise when the
hand rests."""

from __future__ import annotations

SMALL = 4_000_000  # bytes
FAST = 0.010  # s
REST = 1.0  # s without a stroke
EVERY = 30.0  # s from one packing of a large sculpt to the next: each stays in the memory of an undo step


class Packing:
    """Of one sculpt. Times are those of any clock that never falls; `nbytes`: of what was packed last."""

    def __init__(self, nbytes: int, now: float):
        self.nbytes, self.seconds = nbytes, 0.0  # that the last packing took
        self._stroke = now
        self._last = now - EVERY

    def stroke(self, now: float) -> None:
        """One has ended, or goes on."""
        self._stroke = now

    @property
    def at_once(self) -> bool:
        return self.nbytes <= SMALL and self.seconds <= FAST

    def due(self, now: float) -> bool:
        """Whether the hand has rested for long enough, and a large one's last packing is long enough ago."""
        return now - self._stroke >= REST and (now - self._last >= EVERY or self.nbytes <= SMALL)

    def done(self, nbytes: int, seconds: float, now: float) -> None:
        self.nbytes, self.seconds, self._last = nbytes, seconds, now
