"""When to pack a live sculpt into the file: at the end of a stroke if the delay is too short to feel, otherwise when
the hand rests."""

from __future__ import annotations

SMALL = 4_000_000  # bytes
FAST = 0.010  # s
REST = 1.0  # s without a stroke
EVERY = 30.0  # s between two packings of a large sculpt: each stays in the memory of an undo step


class Packing:
    """The packing of one sculpt. Times are those of any monotonic clock; `nbytes`: bytes of the last packing."""

    def __init__(self, nbytes: int, now: float):
        self.nbytes, self.seconds = nbytes, 0.0  # size and duration of the last packing
        self._stroke = now
        self._last = now - EVERY

    def stroke(self, now: float) -> None:
        """Called when a stroke ends or continues."""
        self._stroke = now

    @property
    def at_once(self) -> bool:
        return self.nbytes <= SMALL and self.seconds <= FAST

    def due(self, now: float) -> bool:
        """Whether the hand has rested for long enough, and a large sculpt's last packing is long enough ago."""
        return now - self._stroke >= REST and (now - self._last >= EVERY or self.nbytes <= SMALL)

    def done(self, nbytes: int, seconds: float, now: float) -> None:
        self.nbytes, self.seconds, self._last = nbytes, seconds, now
