"""Devices as the command line names them, and the error for a device that does not open."""

from __future__ import annotations

from typing import Any

from .. import pen
from .arguments import JOURNALS
from .parser import Parser, hint


def add_device(parser: Parser) -> None:
    """Adds the device of a command: by default the first that opens."""
    known = pen.kinds()
    about = (
        f"{', '.join(known)}, one of several (spacemouse:2), a path from riffler pen list, or a .rjournal; "
        "default: the first device that opens"
    )
    parser.add_input("device", about, JOURNALS, required=False, words=known)


def open_device(what: str | None, **options: Any) -> pen.PenDevice:
    """Opens a device. ValueError and PenError list the devices that can be opened instead."""
    if what is None:
        what = first_plugged()
    known = pen.kinds()
    path = any(mark in what for mark in "/\\:") or what.endswith(".rjournal")
    if what not in known and not path:
        raise ValueError(f"no device {what!r}: {', '.join(known)}, a path from riffler pen list or a .rjournal expected"
                         + hint(what, known))  # fmt: skip
    try:
        return pen.open(what, **options)
    except pen.PenError as error:
        raise pen.PenError(f"{error}; {plugged()}") from None


def geometry_of(device: pen.PenDevice) -> pen.PenGeometry:
    """The device's geometry; ValueError for devices without arms."""
    if device.geometry is None:
        raise ValueError(f"{device.kind} has no arms, so no geometry")
    return device.geometry


def first_plugged() -> str:
    """The path of the first device that opens."""
    for device in pen.devices():
        if device.was_opened and device.problem is None:
            return device.path
    raise pen.PenError(f"no device to open; {plugged()}")


def plugged() -> str:
    """The devices that are plugged in, each with the reason if it does not open, in one line."""
    found = [
        f"{device.path} ({device.name}" + (f": {device.problem})" if device.problem else ")")
        for device in pen.devices()
        if device.kind
    ]
    there = f"plugged in: {', '.join(found)}" if found else "no device of a kind that riffler knows is plugged in"
    return f'{there}; "simulated" needs no hardware'
