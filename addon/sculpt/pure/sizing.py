"""A size that is set by the pointer's distance from the middle of a circle, or by digits."""

from __future__ import annotations

import math

FINE = 0.1  # of the pointer's way
LEAST = 8.0  # pixels: a circle that can be held


class Drag:
    """`first`: the size to begin with; `scale`: pixels for one of it; `at`: the pointer, which begins on the circle."""

    def __init__(self, first: float, scale: float, at):
        self.first, self.scale, self.value, self.text = float(first), max(float(scale), 1e-9), float(first), ""
        radius = self.first * self.scale
        # A circle too small or too large to be held is one that is easy to hold, and stands for the size as it is.
        shown = min(max(radius, LEAST), 400.0)
        self.scale *= shown / radius if radius > 0 else 1.0
        self.middle = float(at[0]) - shown, float(at[1])
        self._last = self._distance = shown

    @property
    def radius(self) -> float:
        """Of the circle, in pixels."""
        return self.value * self.scale

    def to(self, at, fine: bool = False, rounded: bool = False) -> float:
        """The size where the pointer is."""
        now = math.hypot(at[0] - self.middle[0], at[1] - self.middle[1])
        self._distance = max(self._distance + (FINE if fine else 1.0) * (now - self._last), 0.0)
        self._last, self.text = now, ""
        self.value = self._distance / self.scale
        if rounded:
            step = 10.0 ** math.floor(math.log10(max(self.first, 1e-6))) / 2
            self.value = max(round(self.value / step), 1) * step
        return self.value

    def typed(self, key: str) -> float:
        """The size where digits have been typed; "\\b" takes the last one back."""
        text = self.text[:-1] if key == "\b" else self.text + key
        if text.count(".") <= 1:
            self.text = text
        try:
            self.value = float(self.text)
        except ValueError:  # nothing yet, or the point alone
            self.value = self.first
        return self.value
