"""The pen: what it is, how its arms move, and how they share a force.

>>> pen = riffler.pen.PenGeometry.load("riffler")
>>> pen.forward([pen.home])  # one pose a row

Pens of your own are ``.toml`` files, given by path or found in the folders of ``RIFFLER_PENS``.

Devices that are plugged in are listed by ``devices`` and opened by ``open``; a recording opens as one, too::

    with riffler.pen.open("riffler-pen") as device:
        state = device.state()
        device.push([0.0, 0.0, 1.0])

Without hardware there is ``riffler.pen.open("simulated")``: the same firmware and driver, arms and hand simulated.
Tablet and mouse are a ``Pointer``, for whoever gets their events.
"""

from __future__ import annotations

import atexit
import os
import weakref
from typing import Any

from ._core import (
    Journal,
    PenDevice,
    PenError,
    PenGeometry,
    PenState,
    Pointer,
    SimulatedPen,
    _open_pen,
    _pen_devices,
    _pen_families,
    _pens,
    _play_pen,
)

__all__ = [
    "PenDevice",
    "PenError",
    "PenGeometry",
    "PenState",
    "Pointer",
    "SimulatedPen",
    "devices",
    "kinds",
    "names",
    "open",
]

_open_devices: weakref.WeakSet[PenDevice] = weakref.WeakSet()


def names() -> dict[str, str]:
    """Every pen that has a name, with its description: those that come with riffler, then the user's own."""
    return _pens()


def devices() -> list[dict[str, Any]]:
    """Every HID device: path, name, maker, id (vendor:product), serial, kind (None: not for riffler), tried (it was
    opened and asked who it is), problem (a few words) and text (why it does not open, and what to do), both None where
    it does, capability and about."""
    return _pen_devices()


def kinds() -> dict[str, str]:
    """What ``open`` takes for devices, and what they are."""
    return _pen_families()


def open(what: str | os.PathLike[str], *, speed: float | None = None, **options: Any) -> PenDevice:
    """Opens a device: a kind (the first that opens), a path of ``devices``, or a journal (``.rjournal``), which is
    played from the first call of ``state`` on, ``speed`` times as fast as it was.

    Options of pucks: ``bubble`` (share of the deflection that is rest), ``exponent`` (of the response), ``speed`` (mm/s
    at full deflection), ``turn_rate`` (rad/s), ``hold_orientation``, ``signs`` (six of -1, 0, 1). Option of "polhem":
    ``geometry`` ("woodenhaptics" or "polhem-1"). Options of Riffler's pen and the simulated one: ``gravity`` and
    ``friction``, shares (0 to 1, by themselves 0) of the arms' weight and friction that the motors make up for while
    force is let through. PenError says exactly why a device does not open.
    """
    path = os.fspath(what)
    if path.endswith(".rjournal"):
        if options:
            raise ValueError(f"a recording has no option {min(options)!r}")
        strokes = Journal.read(path).strokes
        for number, stroke in enumerate(strokes):
            if stroke.times is None:
                raise ValueError(f"stroke {number} has no times: it cannot be played")
        return _play_pen([(stroke.poses, stroke.times) for stroke in strokes], 1.0 if speed is None else speed)
    if speed is not None:
        options["speed"] = speed
    device = _open_pen(path, **options)
    _open_devices.add(device)
    return device


@atexit.register
def _stop_all() -> None:
    """A device that nobody stopped is told not to push before the process ends."""
    for device in list(_open_devices):
        device.stop()
