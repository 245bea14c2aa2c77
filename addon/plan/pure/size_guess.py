"""Whether a part has a plausible size: models have no unit, and the scene's may be wrong."""

from __future__ import annotations

import math

# mm in one unit of the scene, for each unit.
UNITS = {"MM": 1.0, "CM": 10.0, "INCH": 25.4, "M": 1000.0}
LARGE, SMALL = 300.0, 1.0  # diameters of the tool: larger or smaller parts raise a question
USUAL = 120.0  # mm: usual milled parts are about 10 mm to 1 m long


def odd(largest: float, diameter: float) -> bool:
    """True if a part's largest side does not fit a tool's diameter, both in mm."""
    return largest > 0 and not SMALL * diameter <= largest <= LARGE * diameter


def likely(largest: float) -> str:
    """The likely unit of a part whose largest side is so many units."""
    return min(UNITS, key=lambda unit: abs(math.log(largest * UNITS[unit] / USUAL)))


def ratio(largest: float, diameter: float) -> str:
    """“667 times”, “a 300th”."""
    share = largest / diameter
    return f"{share:.0f} times" if share >= 1 else f"1/{1 / share:.0f} of"
