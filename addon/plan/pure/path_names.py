"""Names of a plan's paths on the timeline, at their beginnings."""

from __future__ import annotations

import re

from ...common import units

_NAME = re.compile(r"(.+ )?▸ Path \d+, [\d.]+ mm( off)?")  # other markers do not use the arrow


def name(path: int, length: float, off: bool = False, plan: str = "") -> str:
    """“▸ Path 3, 12.4 mm”; `path`: from 0; `plan`: given if there are several."""
    said = f"▸ Path {path + 1}, {units.trim(length, 1)} mm"
    return f"{plan} {said}".strip() + (" off" if off else "")


def is_name(text: str) -> bool:
    return _NAME.fullmatch(text) is not None
