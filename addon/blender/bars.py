"""A bar with a scale: the gauge of a force, the legend of colours."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..common import glyphs, scale, units
from . import batches

DARK = (0.05, 0.05, 0.05, 0.6)
TEXT = (0.92, 0.92, 0.92, 1.0)
FONT, SIZE = 0, 11  # Blender's own font; points


@dataclass(frozen=True)
class Bar:
    """An upright bar from `low` at its foot to `high`; sizes in pixels at an interface scale of 1."""

    title: str
    low: float
    high: float
    width: float = 12.0
    height: float = 120.0
    colours: tuple = ()  # (share, (r, g, b)) from the foot up; legends only
    value: float | None = None  # filled height; gauges only
    fill: tuple = (0.3, 0.75, 0.35, 1.0)
    limit: float | None = None  # place of the mark

    def at(self, value):
        """Height of a value above the foot."""
        return self.height * scale.share(value, self.low, self.high)


def triangles(bar):
    """The bar's geometry: [(triangles (n, 3, 2), one colour, or one for each corner)], with the foot's left end at the
    origin."""
    parts = [(glyphs.box(-6, -8, bar.width + 58, bar.height + 34), DARK)]
    if bar.colours:
        for (low, a), (high, b) in zip(bar.colours, bar.colours[1:], strict=False):
            middle = tuple((np.asarray(a) + np.asarray(b)) / 2)
            parts.append((glyphs.box(0, low * bar.height, bar.width, (high - low) * bar.height), (*middle, 1.0)))
    else:
        parts.append((glyphs.box(0, 0, bar.width, bar.height), (0.2, 0.2, 0.2, 0.9)))
    if bar.value is not None and bar.at(bar.value) > 0:
        parts.append((glyphs.box(0, 0, bar.width, bar.at(bar.value)), bar.fill))
    marks = [glyphs.box(bar.width, bar.at(t) - 0.5, 5, 1) for t in scale.ticks(bar.low, bar.high)]
    parts.append((np.concatenate(marks), TEXT))
    if bar.limit is not None and bar.low <= bar.limit <= bar.high:
        parts.append((glyphs.box(-3, bar.at(bar.limit) - 1, bar.width + 6, 2), (1.0, 0.35, 0.2, 1.0)))
    return parts


def draw(kept, bar, place, zoom=1.0, name="bar"):
    """`kept`: Batches that hold the bar under `name`; `place`: pixels of the foot's left end in the region; `zoom`: the
    interface's scale."""
    import gpu

    parts = triangles(bar)
    with batches.state(), gpu.matrix.push_pop():
        gpu.matrix.translate(place)
        gpu.matrix.scale_uniform(zoom)
        for k, (shape, colour) in enumerate(parts):
            signature = (k, bar.low, bar.high, bar.limit, shape.tobytes())
            batches.draw(kept.get(f"{name} {k}", signature, lambda s=shape: batches.flat(s)), colour)
    _labels(bar, place, zoom)


def _labels(bar, place, zoom):
    import blf

    blf.size(FONT, SIZE * zoom)
    blf.color(FONT, *TEXT)

    def write(x, y, text):
        blf.position(FONT, place[0] + zoom * x, place[1] + zoom * y, 0)
        blf.draw(FONT, text)

    for tick in scale.ticks(bar.low, bar.high):
        write(bar.width + 8, bar.at(tick) - 4, units.trim(tick, 4))
    write(0, bar.height + 10, bar.title)
