"""Tools as dictionaries (the form of riffler.Tool.to_dict): the presets, and which sizes a kind has."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path

# The sizes of each kind, in the order in which a panel shows them. Lengths in mm, angles in rad.
SIZES = {
    "ball": ("diameter", "length"),
    "flat": ("diameter", "length"),
    "fillet": ("diameter", "corner_radius", "length"),
    "taper": ("diameter", "tip_radius", "half_angle", "length", "flat_tip"),
    "cone_end": ("diameter", "tip_half_angle", "tip_height", "half_angle", "length"),
}
LABELS = {
    "ball": ("Ball", "Ball end mill"),
    "flat": ("Flat", "Flat end mill"),
    "fillet": ("Fillet", "Bull nose: a flat end mill whose edge is rounded"),
    "taper": ("Taper", "Cone above a ball tip or a flat one, then a cylinder"),
    "cone_end": ("Cone", "Sharp tip, a first cone, a second cone, then a cylinder"),
}


@cache
def presets() -> tuple[dict, ...]:
    """The tools that come with the add-on; `name` is unique."""
    tools = json.loads(Path(__file__).with_name("presets.json").read_text(encoding="utf-8"))
    return tuple(tools)


def preset(name: str) -> dict:
    for tool in presets():
        if tool["name"] == name:
            return dict(tool)
    raise ValueError(f"there is no tool preset {name!r}")


def tool_dict(kind: str, sizes: dict, name: str = "") -> dict:
    """The dictionary of one tool from a superset of its sizes."""
    if kind not in SIZES:
        raise ValueError(f"kind must be one of {', '.join(SIZES)}, not {kind!r}")
    tool = {"kind": kind, **{key: sizes[key] for key in SIZES[kind]}}
    if name:
        tool["name"] = name
    return tool
