"""Names of a plan's paths on the timeline, where each begins."""

from __future__ import annotations

import re

from ...common import units

_NAME = re.compile(r"(.+ )?▸ Path \d+, [\d.]+ mm( off)?")  # nobody else writes the arrow


def name(path: int, length: float, off: bool = False, plan: str = "") -> str:
    """“▸ Path 3, 12.4 mm”; `path`: from 0; `plan`: where there are several."""
    said = f"▸ Path {path + 1}, {units.trim(length, 1)} mm"
    return f"{plan} {said}".strip() + (" off" if off else "")


def is_name(text: str) -> bool:
    return _NAME.fullmatch(text) is not None
