"""Changes one size or the shape of a tool, as a panel's fields do. The other sizes stay the same where possible."""

from __future__ import annotations

import json
import math
from functools import lru_cache

import riffler

from . import presets, units


@lru_cache(maxsize=8)
def parsed(text: str) -> dict:
    """The tool's dictionary from a JSON text known to be valid; not to be changed."""
    return json.loads(text)


def changed(tool: dict, key: str, value) -> dict:
    """The dictionary with another `kind` or size. Shank and holder move with the cutter's length, and a rounded edge is
    no wider than the cutter. ValueError, from riffler, if there is no such tool."""
    kind = value if key == "kind" else tool["kind"]
    sizes = {**_first(tool), **{k: v for k, v in tool.items() if k in presets.ALL}}
    if key != "kind":
        sizes[key] = value
    half = sizes["diameter"] / 2
    for name, size in presets.ALL.items():
        if size.largest is not None:
            sizes[name] = min(sizes[name], size.largest * sizes["diameter"])
    if kind != tool["kind"] or key in ("diameter", "length"):
        sizes["tip_radius"] = min(sizes["tip_radius"], 0.9 * half)
        widest = 0.9 * half / math.tan(sizes["tip_half_angle"])  # where the first cone would be as wide
        sizes["tip_height"] = units.clean(min(sizes["tip_height"], widest, sizes["length"] / 2))
        sizes["half_angle"] = max(sizes["half_angle"], _least_angle(kind, sizes))
    out = presets.tool_dict(kind, sizes, _name(kind, sizes["diameter"]))
    further = units.clean(sizes["length"] - tool["length"]) if "length" in tool else 0.0
    for part in ("shank", "holder"):
        if part in tool:
            out[part] = [[units.clean(a + further), r, units.clean(b + further), s] for a, r, b, s in tool[part]]
    riffler.Tool.from_dict(out)
    return out


def _least_angle(kind: str, sizes: dict) -> float:
    """Smallest half angle of the flank (rad), with which a cone ends within nine tenths of the cutter's length."""
    half, height = sizes["diameter"] / 2, 0.9 * sizes["length"]
    if kind == "taper":
        return math.atan2(half - 0.9 * sizes["tip_radius"], height)
    if kind == "cone_end":
        low = sizes["tip_height"] * math.tan(sizes["tip_half_angle"])
        return math.atan2(half - low, height - sizes["tip_height"])
    return 0.0


def _first(tool: dict) -> dict:
    """Default sizes for a cutter of this diameter."""
    diameter = tool.get("diameter", 6.0)
    share = diameter / presets.ALL["diameter"].default
    first = {
        name: units.clean(share * size.default) if size.unit == "mm" else size.default
        for name, size in presets.ALL.items()
    }
    return {**first, "diameter": diameter}


def _name(kind: str, diameter: float) -> str:
    return f"{presets.LABELS[kind][0]} {units.trim(diameter, 3)} mm"
