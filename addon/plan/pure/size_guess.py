"""Whether a part has the size that it was drawn with in mind: lengths of models have no unit, and a scene's may be
another one."""

from __future__ import annotations

import math

# mm in one unit of the scene, if it is this one.
UNITS = {"MM": 1.0, "CM": 10.0, "INCH": 25.4, "M": 1000.0}
LARGE, SMALL = 300.0, 1.0  # diameters of the tool: a part that is larger, or smaller, is asked about
USUAL = 120.0  # mm: parts that people mill are some 10 mm to 1 m long


def odd(largest: float, diameter: float) -> bool:
    """Of a part's largest side and a tool's diameter, mm."""
    return largest > 0 and not SMALL * diameter <= largest <= LARGE * diameter


def likely(largest: float) -> str:
    """The unit that a part has whose largest side is so many of them."""
    return min(UNITS, key=lambda unit: abs(math.log(largest * UNITS[unit] / USUAL)))


def ratio(largest: float, diameter: float) -> str:
    """“667 times”, “a 300th”."""
    share = largest / diameter
    return f"{share:.0f} times" if share >= 1 else f"1/{1 / share:.0f} of"
