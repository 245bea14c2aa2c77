"""A size set by the pointer's distance from the centre of a circle, or by typed digits."""

from __future__ import annotations

import math

FINE = 0.1  # share of the pointer's movement in precise mode
LEAST = 8.0  # pixels: smallest circle that is easy to grab


class Drag:
    """`first`: the initial size; `scale`: pixels per unit of size; `at`: the pointer, which begins on the circle."""

    def __init__(self, first: float, scale: float, at):
        self.first, self.scale, self.value, self.text = float(first), max(float(scale), 1e-9), float(first), ""
        radius = self.first * self.scale
        # A circle too small or too large to grab is replaced by one of usable size, which represents the current size.
        shown = min(max(radius, LEAST), 400.0)
        self.scale *= shown / radius if radius > 0 else 1.0
        self.middle = float(at[0]) - shown, float(at[1])
        self._last = self._distance = shown

    @property
    def radius(self) -> float:
        """Radius of the circle, in pixels."""
        return self.value * self.scale

    def to(self, at, fine: bool = False, rounded: bool = False) -> float:
        """The size at the pointer."""
        now = math.hypot(at[0] - self.middle[0], at[1] - self.middle[1])
        self._distance = max(self._distance + (FINE if fine else 1.0) * (now - self._last), 0.0)
        self._last, self.text = now, ""
        self.value = self._distance / self.scale
        if rounded:
            step = 10.0 ** math.floor(math.log10(max(self.first, 1e-6))) / 2
            self.value = max(round(self.value / step), 1) * step
        return self.value

    def typed(self, key: str) -> float:
        """The size after typed digits; "\b" deletes the last one."""
        text = self.text[:-1] if key == "\b" else self.text + key
        if text.count(".") <= 1:
            self.text = text
        try:
            self.value = float(self.text)
        except ValueError:  # nothing typed yet, or only the point
            self.value = self.first
        return self.value
