"""Titles of findings in lists: kind, size and place first, to distinguish findings of one kind."""

from __future__ import annotations

from ...common import units

KINDS = {
    "rapid": "Rapid in material",
    "holder": "Holder collision",
    "shank": "Shank collision",
    "fixture": "Fixture collision",
    "gouge": "Gouge",
    "rest": "Rest",
    "spindle": "Spindle stopped",
    "machine": "Out of reach",
    "unknown": "Other",
}


def verified(what: str, value: float, place) -> str:
    """“Gouge 0.77 at 44 17 7”, short enough for a sidebar: the sentence below the list has the units. `what`: of KINDS;
    `value` in mm or mm³, 0 where there is none; `place` in mm of the scene."""
    size = f" {_number(value)}" if value > 0 else ""
    return f"{what}{size} at {' '.join(units.trim(float(x), 0) for x in place)}"


def _number(value: float) -> str:
    """Two digits, which are enough to distinguish findings."""
    return f"{value:.2g}" if value < 10 else f"{value:.0f}"
