"""Hand tools as dictionaries (the form of riffler.Tool.to_dict): carvers' presets, and the sizes of each kind.

A preset also has its lean: the angle by which the handle leans back from the surface's normal, away from the cut.
"""

from __future__ import annotations

import json
import math
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
import riffler

STEEPEST = math.radians(85)
MARGIN = 1.5  # depths that a chip is lifted: a surface is not flat


class Size(NamedTuple):
    name: str
    label: str
    unit: str  # "mm" or "rad"
    default: float
    low: float
    high: float
    description: str


class Kind(NamedTuple):
    label: str
    description: str
    sizes: tuple[str, ...]  # in a panel's order


ALL = {
    size.name: size
    for size in (
        Size("width", "Width", "mm", 10.0, 0.01, 1e4, "Width of the edge, in mm; of a knife from edge to back"),
        Size("radius", "Sweep Radius", "mm", 6.5, 0.005, 1e5, "Radius of the channel, in mm; at least half the width"),
        Size("angle", "Angle", "rad", math.radians(60), math.radians(10), math.radians(170),
             "Angle between the two blades"),
        Size("thickness", "Thickness", "mm", 3.0, 0.01, 1e4, "Thickness of the blade, in mm"),
        Size("bevel", "Bevel", "rad", math.radians(25), math.radians(5), math.radians(85),
             "Angle of the ground end to the blade's back"),
        Size("edge_angle", "Edge Angle", "rad", math.radians(20), math.radians(5), math.radians(150),
             "Angle between the two sides of the edge"),
        Size("skew", "Skew", "rad", 0.0, -math.radians(70), math.radians(70),
             "Angle of the edge to a line straight across the blade"),
        Size("length", "Length", "mm", 25.0, 0.01, 1e4,
             "Length of the blade that cuts, in mm; the handle above it meets no material"),
    )
}  # fmt: skip
KINDS = {
    "gouge": Kind("Carving Gouge", "A blade with a round channel, which cuts round grooves",
                  ("width", "radius", "bevel", "length")),
    "v_tool": Kind("V-Tool", "Two blades at an angle, which cut V-shaped grooves",
                   ("width", "angle", "bevel", "length")),
    "chisel": Kind("Carving Chisel", "A flat blade, straight or skew",
                   ("width", "thickness", "bevel", "skew", "length")),
    "knife": Kind("Carving Knife", "A blade whose edge leads along the stroke, for fine cuts",
                  ("width", "thickness", "edge_angle", "length")),
}  # fmt: skip


@cache
def presets() -> tuple[dict, ...]:
    """The hand tools that come with the add-on, each with `name`, which is unique, and `lean` (rad)."""
    return tuple(json.loads(Path(__file__).with_name("hand_tools.json").read_text(encoding="utf-8")))


def preset(name: str) -> dict:
    for tool in presets():
        if tool["name"] == name:
            return dict(tool)
    raise ValueError(f"there is no hand tool {name!r}")


def tool_dict(kind: str, sizes: dict, name: str = "") -> dict:
    """The dictionary of one tool, from a superset of its sizes."""
    if kind not in KINDS:
        raise ValueError(f"kind must be one of {', '.join(KINDS)}, not {kind!r}")
    tool = {"kind": kind, **{key: sizes[key] for key in KINDS[kind].sizes}}
    if name:
        tool["name"] = name
    return tool


def opened(tool: riffler.Tool, lean: float, depth: float) -> riffler.Tool:
    """The tool with the room that its chip leaves through: the body, moved out of the material by a little more than
    the depth (mm), and everything between. Without it, the chip above the blade would stay at the end of a stroke, and
    in a groove deeper than the blade is high. The handle leans back by `lean` (rad)."""
    if not depth > 0 or not tool.hulls:
        return tool
    out = MARGIN * depth * np.array([math.sin(lean), 0.0, math.cos(lean)])  # of the material, in the tool's frame
    hulls = [np.vstack([hull, hull + out]).tolist() for hull in tool.hulls]
    return riffler.Tool.from_dict({"kind": "convex", "hulls": hulls, "name": tool.name})


def mirrored(tool: riffler.Tool) -> riffler.Tool:
    """The tool's mirror image in the plane of its cutting direction and its axis; the same object if it is
    symmetric."""
    data = tool.to_dict()
    if data["kind"] == "convex":
        data["hulls"] = [(hull * (1, -1, 1)).tolist() for hull in tool.hulls]
    elif data.get("skew", 0.0):
        data["skew"] = -data["skew"]
    else:
        return tool
    return riffler.Tool.from_dict(data)
