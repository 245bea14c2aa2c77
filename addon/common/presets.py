"""Tools as dictionaries (the form of riffler.Tool.to_dict): the presets, and the sizes of each shape."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path

import riffler

SHAPES = {shape.name: shape for shape in riffler.Tool.shapes()}
# Every size by its name, with the same meaning in all shapes that have it. Lengths in mm, angles in rad.
ALL = {size.name: size for shape in SHAPES.values() for size in shape.sizes}
FLAGS = tuple(name for name, size in ALL.items() if size.unit == "bool")
# The sizes of each shape, in a panel's order.
SIZES = {
    name: ("diameter", *(size.name for size in shape.sizes if size.name != "diameter"))
    for name, shape in SHAPES.items()
}
LABELS = {name: (shape.label, shape.description) for name, shape in SHAPES.items()}


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
    """The dictionary of one tool, from a superset of its sizes."""
    if kind not in SIZES:
        raise ValueError(f"kind must be one of {', '.join(SIZES)}, not {kind!r}")
    tool = {"kind": kind, **{key: sizes[key] for key in SIZES[kind]}}
    if name:
        tool["name"] = name
    return tool
