"""List the devices that are plugged in, what each can do, and exactly why a device does not open.

riffler pen list

Devices with the Polhem protocol have USB numbers that any board may have, so the command does not open them; to use
one, give its kind to riffler.pen.open.
"""

from __future__ import annotations

import argparse
from dataclasses import asdict
from typing import Any

from .. import pen
from .console import Console
from .parser import Parser

HELP = "list plugged-in devices, and why a device does not open"


def add_arguments(parser: Parser) -> None:
    pass


def run(arguments: argparse.Namespace, console: Console) -> int:
    found = [device for device in pen.devices() if device.kind]
    rows = [(device.path, chosen_by(device) + describe(device)) for device in found]
    known = ", ".join(kind for kind in pen.kinds() if kind != "simulated")
    unavailable = pen.unavailable()
    rows = rows or [("none", f'no device of the kinds {known}; "simulated" needs no hardware')]
    console.result(
        {"devices": [as_json(device) for device in found], "kinds": pen.kinds(), "unavailable": unavailable},
        "pens",
        [*rows, *unavailable.items()],
    )
    return 0


def as_json(device: pen.DeviceInfo) -> dict[str, Any]:
    """A device for --json, where `tried` tells whether the device was opened and its description read."""
    return {"tried" if key == "was_opened" else key: value for key, value in asdict(device).items()}


def chosen_by(device: pen.DeviceInfo) -> str:
    """The argument that chooses a device among several of its kind."""
    return f'"{device.choice}", ' if device.choice else ""


def describe(device: pen.DeviceInfo) -> str:
    """Describes a device in one line."""
    name = " ".join(filter(None, (device.name, device.id)))
    if device.problem:
        return f"{name}: {device.problem}: {device.text}"
    if device.kind is None:
        return f"{name}: can be opened"
    if not device.was_opened:
        return f'{name}: can be opened; if it is one, as "{device.kind}": {pen.kinds()[device.kind]}'
    return f"{name}: {device.kind}, {device.capability}; {device.about}"
