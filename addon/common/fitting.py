"""Unit, pitch and cutter for the start of sculpting, from an object's size."""

from __future__ import annotations

import math

from . import presets, units

FEW_RAYS = 50  # along the longest side: fewer show no detail
BEGIN_RAYS = 200  # along the longest side of a new sculpt: fine enough to carve, and fast to display
HANDY = (10.0, 500.0)  # mm: an object whose longest side lies in this range keeps the scene's unit
WANTED = 100.0  # mm: about the longest side of any other object, once its unit is set
CUTTERS = 10  # diameters of the cutter along the longest side: a visible chip
SUITS = (1 / 12, 1 / 4)  # shares of the longest side: a cutter whose diameter lies between them is kept
DEPTH = 1 / 6  # share of the diameter
LENGTHS = tuple(name for name, size in presets.ALL.items() if size.unit == "mm")


def rounded(value: float, steps=(1, 2, 2.5, 5, 10)) -> float:
    """The nearest of `steps` × 10ⁿ. ValueError where `value` is not a positive number."""
    if not (math.isfinite(value) and value > 0):
        raise ValueError(f"a size must be a positive length, not {value}")
    decade = 10.0 ** math.floor(math.log10(value))
    step = min(steps, key=lambda s: abs(math.log(s * decade / value)))
    return float(f"{step * decade:.3g}")


def longest(size) -> float:
    """The longest side. ValueError for an object without surface."""
    side = max(float(s) for s in size)
    if not (math.isfinite(side) and side > 0):
        raise ValueError(f"size must be three positive lengths, not {tuple(size)}")
    return side


def is_handy(side: float) -> bool:
    """True if the longest side, in mm, needs no other unit."""
    return HANDY[0] <= side <= HANDY[1]


def unit(side: float) -> float:
    """The round number of millimetres per Blender unit that makes a longest side of `side` units about WANTED."""
    return rounded(WANTED / longest([side]))


def pitch(side: float, rays: int = BEGIN_RAYS) -> float:
    """A round pitch that gives about so many rays along `side`; both in mm."""
    return rounded(side / rays)


def tool(tool: dict, side: float) -> dict:
    """`tool` if its diameter suits the longest side (mm); otherwise the same shape with all lengths scaled."""
    now = float(tool["diameter"])
    if SUITS[0] * side <= now <= SUITS[1] * side:
        return tool
    return scaled(tool, rounded(side / CUTTERS, (1, 1.5, 2, 3, 4, 5, 6, 8, 10)))


def scaled(tool: dict, diameter: float) -> dict:
    """The same shape with another diameter (mm)."""
    share = diameter / float(tool["diameter"])
    lengths = {key: units.clean(share * float(tool[key])) for key in LENGTHS if key in tool}
    return {**{key: value for key, value in tool.items() if key != "name"}, **lengths}


def depth(diameter: float) -> float:
    """Depth of a stroke, in mm, for a cutter whose size was just set."""
    return rounded(DEPTH * diameter)


def depth_suits(depth: float, diameter: float) -> bool:
    """True if a stroke of that depth is neither a scratch nor so deep that it buries the cutter."""
    return diameter / 12 <= depth <= diameter / 2
