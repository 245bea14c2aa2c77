"""Show what riffler finds on this machine: versions, processor, memory, Blender, pens.

riffler doctor
"""

from __future__ import annotations

import argparse
import importlib.metadata
import importlib.util
import os
import platform
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from .. import __version__, _core, pen
from .console import Console, number
from .parser import Parser
from .pen_list import as_json, describe

HELP = "show versions and devices, and why a device does not open"

# Instruction sets that matter for arithmetic, best first.
INSTRUCTION_SETS = ("avx512f", "avx2", "avx", "sse4_2", "asimd")


def add_arguments(parser: Parser) -> None:
    pass


def run(arguments: argparse.Namespace, console: Console) -> int:
    found = pen.devices()
    data = report(found)
    console.result(data, "riffler doctor", rows(data, found))
    return 0


def rows(data: dict[str, Any], found: list[pen.DeviceInfo]) -> list[tuple[str, str]]:
    """A report as rows of a table: name and value."""
    devices = [(d.path, describe(d)) for d in found]
    memory = data["memory"]
    cpu = data["cpu"]
    return [
        ("riffler", f"{data['riffler']}, compiled with {data['compiler']}"),
        ("Python", f"{data['python']}, numpy {data['numpy']}"),
        ("system", data["system"]),
        ("processor", f"{cpu['model']}, {cpu['instruction_set'] or 'instruction set unknown'}"),
        ("threads", number(data["threads"])),
        ("memory", f"{gigabytes(memory['available'])} free of {gigabytes(memory['total'])}"),
        ("Blender", data["bpy"] or "no bpy in this Python"),
        ("real time", " — ".join(filter(None, (data["real_time"]["text"], data["real_time"]["remedy"])))),
        *(devices or [("devices", "no HID device (/dev/hidraw*)")]),
        *data["unavailable"].items(),
    ]


def report(found: list[pen.DeviceInfo]) -> dict[str, Any]:
    return {
        "riffler": __version__,
        "compiler": _core.__compiler__,
        "python": platform.python_version(),
        "numpy": np.__version__,
        "system": platform.platform(),
        "cpu": cpu(),
        "threads": _core.threads(),
        "memory": memory(),
        "real_time": asdict(pen.real_time()),
        "bpy": bpy_version(),
        "devices": [as_json(device) for device in found],
        "unavailable": pen.unavailable(),
    }


def cpu(info: Path = Path("/proc/cpuinfo")) -> dict[str, Any]:
    fields: dict[str, str] = {}
    for line in read(info).splitlines():
        key, colon, value = line.partition(":")
        if colon:
            fields.setdefault(key.strip(), value.strip())
    flags = set((fields.get("flags") or fields.get("Features", "")).split())
    best = next((s for s in INSTRUCTION_SETS if s in flags), None)
    return {
        "model": fields.get("model name") or platform.processor() or platform.machine(),
        "instruction_set": best,
        "cores": os.cpu_count(),
    }


def memory(info: Path = Path("/proc/meminfo")) -> dict[str, int | None]:
    kilobytes = {}
    for line in read(info).splitlines():
        key, _, value = line.partition(":")
        if value.split()[:1] and value.split()[0].isdecimal():
            kilobytes[key] = int(value.split()[0])
    found = {"total": kilobytes.get("MemTotal"), "available": kilobytes.get("MemAvailable")}
    return {key: None if value is None else 1024 * value for key, value in found.items()}


def gigabytes(count: int | None) -> str:
    return "unknown" if count is None else f"{count / 1e9:.1f} GB"


def bpy_version() -> str | None:
    """Version of the bpy that ``import bpy`` would find, or None. Does not import it, which would take seconds."""
    try:
        if importlib.util.find_spec("bpy") is None:
            return None
    except (ImportError, ValueError):
        return None
    try:
        return "bpy " + importlib.metadata.version("bpy")
    except importlib.metadata.PackageNotFoundError:
        return "bpy, version unknown"


def read(path: Path) -> str:
    """A system file's text; empty if it cannot be read."""
    try:
        return path.read_text(errors="replace")
    except OSError:
        return ""
