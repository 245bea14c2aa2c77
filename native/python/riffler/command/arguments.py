"""Parses the arguments of commands: lengths, boxes, files. An error names the argument and the fault in one line."""

from __future__ import annotations

import math
import os
import re
from pathlib import Path
from typing import Any

from ..formats import PARTS, VOLUMES
from .parser import Parser

A_PART = ".stl, .obj, .ply, .3mf, .step, .iges or .brep"
PAIRS = re.compile(r"\d+:[-+.\deE]+(,\d+:[-+.\deE]+)*")
ORIGINS = ("corner", "top-centre", "bottom-centre")
PROGRAMS = (".rprog",)
PLANS = (".json",)
JOURNALS = (".rjournal",)
CODE = (".ngc", ".nc", ".cnc", ".tap", ".gcode", ".mpf", ".h", ".i", ".apt", ".cls", ".txt")
SOLIDS = {"block": 3, "sphere": 1, "cylinder": 2}  # sizes of each


def finite(text: str, what: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise ValueError(f"{what} must be a number, not {text!r}")
    return value


def length(text: str, what: str) -> float:
    value = finite(text, what)
    if value <= 0:
        raise ValueError(f"{what} must be positive, not {text}")
    return value


def whole(text: str, what: str) -> int:
    """A whole number from 1; ValueError naming `what`."""
    try:
        value = int(text)
    except ValueError:
        value = 0
    if value < 1:
        raise ValueError(f"{what} must be a whole number from 1, not {text!r}")
    return value


def add_pitch(parser: Parser, required: bool, more: str = "") -> None:
    parser.add_argument("--pitch", metavar="MM", required=required, help="distance between rays, mm" + more)


def add_directions(parser: Parser) -> None:
    parser.add_argument(
        "--directions", choices=("z", "xyz"), help='rays along z, or all three axes for sharp edges (default "xyz")'
    )


def solid(text: str, origin: str) -> tuple[str, list[float], list[float]]:
    """Kind, lower and upper corner of a block ``WxDxH``, ``sphere:D`` or ``cylinder:D:H`` (axis along z).

    ``origin`` is ``x,y,z`` of the box's lower corner, or one of ORIGINS.
    """
    kind, *numbers = text.lower().split(":") if ":" in text else ("block", *text.lower().split("x"))
    sizes = [length(number, f"--stock {text}: size") for number in numbers]
    if len(sizes) != SOLIDS.get(kind):
        raise ValueError(f"--stock {text}: 100x60x30, sphere:40, cylinder:40:60 or a file expected")
    w, d, h = {"block": sizes, "sphere": 3 * sizes, "cylinder": [*sizes[:1], *sizes]}[kind]
    if origin in ORIGINS:
        lower = {"corner": [0.0, 0.0, 0.0], "top-centre": [-w / 2, -d / 2, -h], "bottom-centre": [-w / 2, -d / 2, 0.0]}[
            origin
        ]
    else:
        lower = [finite(part, f"--origin {origin}: coordinate") for part in origin.split(",")]
        if len(lower) != 3:
            raise ValueError(f"--origin {origin}: x,y,z of the lower corner expected, or one of {', '.join(ORIGINS)}")
    return kind, lower, [a + b for a, b in zip(lower, (w, d, h), strict=True)]


def is_solid(text: str) -> bool:
    return not text.lower().endswith(PARTS + VOLUMES) and not os.path.exists(text)


def input_file(text: str, suffixes: tuple[str, ...]) -> Path:
    path = Path(text)
    if path.suffix.lower() not in suffixes:
        raise ValueError(f"{path.name}: {' or '.join(suffixes)} expected")
    if not path.exists():
        raise FileNotFoundError(2, os.strerror(2), text)
    return path


def output_file(text: str, suffixes: tuple[str, ...], option: str = "--out") -> Path:
    """Path of a file to write, checked before the work begins."""
    path = Path(text)
    if path.suffix.lower() not in suffixes:
        raise ValueError(f"{option} {path.name}: a name that ends with {' or '.join(suffixes)} expected")
    if path.is_dir():
        raise ValueError(f"{option} {path.name}: is a directory")
    if not path.parent.is_dir():
        raise ValueError(f"{option} {text}: there is no folder {str(path.parent)!r}")
    if not os.access(path.parent, os.W_OK):
        raise ValueError(f"{option} {text}: the folder {str(path.parent)!r} cannot be written")
    return path


def add_machine_option(parser: Parser) -> None:
    parser.add_argument(
        "--machine-option",
        action="append",
        default=[],
        metavar="KEY=VALUE",
        help="option of the machine or of reading, see docs/reading-nc.md; may be repeated",
    )


def machine_options(texts: list[str], flag: str) -> dict[str, Any]:
    """Options of ``KEY=VALUE`` texts. Values: numbers, lists (0,0,-40), pairs (1:6,2:10), true and false, words."""
    found: dict[str, Any] = {}
    for text in texts:
        key, equals, value = text.partition("=")
        if not (key and equals and value):
            raise ValueError(f"{flag} {text}: KEY=VALUE expected")
        if key in found:
            raise ValueError(f"{flag} {text}: {key} is given twice")
        found[key] = option_value(value, f"{flag} {text}")
    return found


def option_value(value: str, what: str) -> Any:
    if value in ("true", "false"):
        return value == "true"
    if PAIRS.fullmatch(value):
        pairs = [part.split(":") for part in value.split(",")]
        found = {int(number): finite(entry, f"{what}: an entry") for number, entry in pairs}
        if len(found) < len(pairs):
            raise ValueError(f"{what}: a number occurs twice")
        return found
    if "," in value:
        return [finite(part, f"{what}: an entry") for part in value.split(",")]
    return finite(value, what) if value[0] in "+-.0123456789" else value
