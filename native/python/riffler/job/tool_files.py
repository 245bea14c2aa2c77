"""Reads tool tables: LinuxCNC's tool.tbl, and tool libraries of Fusion (.json, .tools)."""

from __future__ import annotations

import io
import json
import math
import re
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .. import files

FORMATS = (".tbl", ".json", ".tools")
INCH = 25.4
# Words in a comment of tool.tbl from which the kind of cutter is known.
COMMENTS = (
    ("fillet", re.compile(r"\b(bull|corner|torus|toroid)", re.I)),
    ("ball", re.compile(r"\b(ball|kugel)", re.I)),
    ("drill", re.compile(r"\b(drill|bohrer)", re.I)),
    ("flat", re.compile(r"\b(flat|end ?mill|endmill|slot|square|schaftfr)", re.I)),
)
FUSION = {
    "flat end mill": "flat",
    "slot mill": "flat",
    "ball end mill": "ball",
    "bull nose end mill": "fillet",
    "drill": "drill",
}
POINT = 118.0  # degrees: point angle of drills for which the file has none


@dataclass(frozen=True)
class Preset:
    """A tool of a table. ``sizes``: keys of a job's tool, lengths in mm and angles in degrees, with its kind if the
    table has one. Feeds are in mm/min, ``spindle`` in rev/min. ``where``: place in the file, for messages."""

    number: int
    name: str
    where: str
    sizes: Mapping[str, Any] = field(default_factory=dict)
    feed: float | None = None
    plunge: float | None = None
    spindle: float | None = None
    flutes: int | None = None
    problem: str = ""  # why the kind is unknown


def read(path: Path, unit: str = "mm") -> list[Preset]:
    """Reads the tools of a table. ``unit``: "mm" or "inch", for a tool.tbl, because such files do not state it.

    ValueError, which names file and place, if the file is damaged or of another kind.
    """
    data = files.read(path)
    if path.suffix.lower() == ".tbl":
        return _of_table(path.name, data, INCH if unit == "inch" else 1.0)
    return _of_fusion(path.name, data, path.suffix.lower() == ".tools")


def _of_table(name: str, data: bytes, scale: float) -> list[Preset]:
    out = []
    for number, line in enumerate(data.decode("utf-8", "replace").splitlines(), 1):
        words, _, comment = line.partition(";")
        entries = {word[0].upper(): word[1:] for word in words.split()}
        if not entries:
            continue
        where = f"{name}, line {number}"
        if "T" not in entries:
            raise ValueError(f"{where}: a tool number expected, as in T3 P3 D6.0 ;flat end mill")
        tool = _table_number(entries["T"], where, "T")
        if tool != int(tool) or tool < 0:
            raise ValueError(f"{where}: T{entries['T']} is no tool number")
        diameter = scale * _table_number(entries.get("D", "0"), where, "D")
        kind = next((kind for kind, words in COMMENTS if words.search(comment)), None)
        sizes: dict[str, Any] = {"diameter": diameter} if diameter > 0 else {}
        if kind is not None:
            sizes["kind"] = kind
        if kind == "drill":
            sizes["point"] = POINT
        problem = "" if kind else "its comment does not tell the kind of cutter"
        out.append(Preset(int(tool), comment.strip(), where, sizes, problem=problem))
    return out


def _table_number(text: str, where: str, letter: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise ValueError(f"{where}: {letter}{text}: a number expected after {letter}")
    return value


def _of_fusion(name: str, data: bytes, packed: bool) -> list[Preset]:
    try:
        if packed:
            with zipfile.ZipFile(io.BytesIO(data)) as archive:
                inside = next((one for one in archive.namelist() if one.lower().endswith(".json")), None)
                if inside is None:
                    raise ValueError("no .json in it")
                data = archive.read(inside)
        library = json.loads(data.decode("utf-8-sig"))
    except (ValueError, zipfile.BadZipFile, RecursionError) as error:
        raise ValueError(f"{name}: no tool library of Fusion: {error}") from None
    entries = library.get("data") if isinstance(library, dict) else None
    if not isinstance(entries, list) or not all(isinstance(one, dict) for one in entries):
        raise ValueError(f'{name}: no tool library of Fusion: a list "data" of tools expected')
    return [_fusion_tool(one, f"{name}, tool {k + 1}") for k, one in enumerate(entries) if one.get("type") != "holder"]


def _fusion_tool(entry: Mapping[str, Any], where: str) -> Preset:
    scale = INCH if str(entry.get("unit", "")).startswith("inch") else 1.0
    geometry, post = _dict(entry, "geometry"), _dict(entry, "post-process")
    presets = _dict(entry, "start-values").get("presets")
    start = presets[0] if isinstance(presets, list) and presets and isinstance(presets[0], dict) else {}
    kind = FUSION.get(str(entry.get("type")))
    name = str(entry.get("description") or entry.get("type") or "").strip()

    def size(key: str, of: Mapping[str, Any] = geometry, by: float = scale) -> float | None:
        value = of.get(key)
        if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value) or value <= 0:
            return None
        return by * value

    sizes: dict[str, Any] = {"kind": kind, "diameter": size("DC"), "length": size("LCF")}
    if kind == "fillet":
        sizes["corner_radius"] = size("RE")
    if kind == "drill":
        sizes["point"] = size("SIG", by=1) or POINT
    below, shank = size("LB"), size("SFDM")
    length = sizes["length"]
    if below and shank and length and below > length:
        sizes["shank"] = [[length, shank / 2, below, shank / 2]]
    if below and (cones := _holder(_dict(entry, "holder"), below)):
        sizes["holder"] = cones
    number = post.get("number")
    return Preset(
        number if isinstance(number, int) else 0,
        name,
        where,
        {key: value for key, value in sizes.items() if value is not None},
        size("v_f", start),
        size("v_f_plunge", start),
        size("n", start, 1.0),
        int(geometry["NOF"]) if isinstance(geometry.get("NOF"), int | float) else None,
        "" if kind else f"its type {str(entry.get('type'))!r} is none of {', '.join(FUSION)}",
    )


def _holder(holder: Mapping[str, Any], below: float) -> list[list[float]]:
    """Truncated cones of a holder, made from its segments, which are stacked from ``below`` (mm) upwards."""
    scale = INCH if str(holder.get("unit", "")).startswith("inch") else 1.0
    out: list[list[float]] = []
    for one in holder.get("segments") or []:
        try:
            height, low, high = (scale * float(one[k]) for k in ("height", "lower-diameter", "upper-diameter"))
        except (KeyError, TypeError, ValueError):
            return []
        if height > 0:
            out.append([below, low / 2, below + height, high / 2])
            below += height
    return out


def _dict(entry: Mapping[str, Any], key: str) -> Mapping[str, Any]:
    value = entry.get(key)
    return value if isinstance(value, dict) else {}
