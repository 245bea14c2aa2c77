"""Scales of gauges and legends: round numbers within a range, and their places."""

from __future__ import annotations

import math


def step(low: float, high: float, most: int = 6) -> float:
    """The smallest of 1, 2, 5 times a power of ten with at most `most` multiples in the range."""
    if not (math.isfinite(low) and math.isfinite(high) and low < high and most > 1):
        raise ValueError(f"a scale needs low < high, both finite, and room for two numbers, not {low}, {high}, {most}")
    power = 10.0 ** math.floor(math.log10((high - low) / most))
    for factor in (1, 2, 5, 10, 20):
        if len(_multiples(low, high, factor * power)) <= most:
            return factor * power
    return 50 * power


def ticks(low: float, high: float, most: int = 6) -> list[float]:
    size = step(low, high, most)
    # n / 1000 rather than n * 0.001: the nearest double to the decimal number
    return [n * size if size >= 1 else n / round(1 / size) for n in _multiples(low, high, size)]


def ceiling(value: float) -> float:
    """The smallest of 1, 2, 5 times a power of ten that is not below a positive value."""
    if not (math.isfinite(value) and value > 0):
        raise ValueError(f"a scale's end must be positive and finite, not {value}")
    power = 10.0 ** math.floor(math.log10(value))
    return next(f * power for f in (1, 2, 5, 10) if f * power >= value * (1 - 1e-9))


def share(value: float, low: float, high: float) -> float:
    """The place of a value between the ends of a scale, 0 to 1, clamped."""
    return min(max((value - low) / (high - low), 0.0), 1.0)


def _multiples(low: float, high: float, size: float) -> range:
    slack = 1e-9
    return range(math.ceil(low / size - slack), math.floor(high / size + slack) + 1)
