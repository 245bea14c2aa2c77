"""The pen: its description, kinematics and forces.

>>> pen = riffler.pen.PenGeometry.load("riffler")
>>> pen.forward([pen.home])  # one pose a row

Pens of your own are ``.toml`` files, given by path or found in the folders of ``RIFFLER_PENS``.

``devices`` lists the devices that are plugged in and ``open`` opens one; a recording opens as one, too::

    with riffler.pen.open("riffler-pen") as device:
        state = device.state()
        device.push([0.0, 0.0, 1.0])

Without hardware, use ``riffler.pen.open("simulated")``: the same firmware and driver, with simulated arms and hand.
For a tablet or a mouse, a ``Pointer`` makes a device from its events.
"""

from __future__ import annotations

import atexit
import os
import weakref
from collections.abc import Sequence
from typing import Any, Literal, overload

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
    _pen_real_time,
    _pen_unavailable,
    _pens,
    _play_pen,
)
from .hints import hinted
from .pen_results import (
    CoordinateCapability,
    DeviceInfo,
    GripDiagnosis,
    PenCapability,
    PenChannel,
    PenHealth,
    PenLimits,
    PushResult,
    ThreadPriority,
)

__all__ = [
    "CoordinateCapability",
    "DeviceInfo",
    "GripDiagnosis",
    "PenCapability",
    "PenChannel",
    "PenDevice",
    "PenError",
    "PenGeometry",
    "PenHealth",
    "PenLimits",
    "PenState",
    "Pointer",
    "PushResult",
    "SimulatedPen",
    "ThreadPriority",
    "devices",
    "kinds",
    "names",
    "open",
    "real_time",
    "unavailable",
]

_open_devices: weakref.WeakSet[PenDevice] = weakref.WeakSet()


def names() -> dict[str, str]:
    """All pens with a name: those shipped with riffler, then the user's own.

    Returns
    -------
    dict
        Name to description.

    Examples
    --------
    >>> "riffler" in riffler.pen.names()
    True
    """
    return _pens()


def devices() -> list[DeviceInfo]:
    """All HID devices of this computer, and all devices that a maker's service reports.

    Opens devices of known kinds to read their description.

    Returns
    -------
    list of DeviceInfo

    Examples
    --------
    >>> all(device.path for device in riffler.pen.devices())
    True
    """
    return _pen_devices()


def kinds() -> dict[str, str]:
    """The kinds of devices that ``open`` accepts.

    Returns
    -------
    dict
        Kind to description.

    Examples
    --------
    >>> "simulated" in riffler.pen.kinds()
    True
    """
    return _pen_families()


def unavailable() -> dict[str, str]:
    """Kinds that find no device because a program or library of their maker is missing.

    Returns
    -------
    dict
        Kind to reason and remedy.

    Examples
    --------
    >>> set(riffler.pen.unavailable()) <= set(riffler.pen.kinds())
    True
    """
    return _pen_unavailable()


def real_time() -> ThreadPriority:
    """The priority that the system would grant to the thread of a device opened now.

    Devices and sessions request it themselves: see ``PenDevice.priority`` and ``Session.priority``. Takes up to a
    second if a service does not answer.

    Returns
    -------
    ThreadPriority

    Examples
    --------
    >>> riffler.pen.real_time().text.startswith(("real time", "normal"))
    True
    """
    return _pen_real_time()


@overload
def open(
    what: Literal["simulated"],
    *,
    gravity: float | None = None,
    friction: float | None = None,
    seed: int | None = None,
    real_time: bool | None = None,
) -> SimulatedPen: ...
@overload
def open(
    what: str | os.PathLike[str],
    *,
    speed: float | None = None,
    bubble: float | None = None,
    exponent: float | None = None,
    turn_rate: float | None = None,
    hold_orientation: bool | None = None,
    signs: Sequence[int] | None = None,
    geometry: str | None = None,
    gravity: float | None = None,
    friction: float | None = None,
    seed: int | None = None,
    real_time: bool | None = None,
) -> PenDevice: ...
@hinted("pen.open")
def open(
    what: str | os.PathLike[str],
    *,
    speed: float | None = None,
    bubble: float | None = None,
    exponent: float | None = None,
    turn_rate: float | None = None,
    hold_orientation: bool | None = None,
    signs: Sequence[int] | None = None,
    geometry: str | None = None,
    gravity: float | None = None,
    friction: float | None = None,
    seed: int | None = None,
    real_time: bool | None = None,
) -> PenDevice:
    """Opens a device.

    Parameters
    ----------
    what : str or path
        A kind of ``kinds`` (the first device that opens), a kind and which of several ("spacemouse:2", by its number in
        ``riffler pen list``, its serial number or a part of its name), a path of ``devices``, or a journal
        (``.rjournal``), which is played from the first call of ``state`` on.
    speed : float, optional
        Pucks: mm/s at full deflection. Journals: factor on the recorded speed.
    bubble : float, optional
        Pucks: share of the deflection that counts as rest.
    exponent : float, optional
        Pucks: exponent of the response.
    turn_rate : float, optional
        Pucks: rad/s at full deflection.
    hold_orientation : bool, optional
        Pucks: True ignores turns.
    signs : list of int, optional
        Pucks: factor of each of the six coordinates: -1, 0 or 1.
    geometry : str, optional
        For "polhem": "woodenhaptics" or "polhem-1".
    gravity, friction : float, optional
        For Riffler's pen and the simulated one: shares (0 to 1) of the arms' weight and friction that the motors
        compensate while force passes the gate. Default: 1 and 0.5 for an identified pen, 0 for others.
    seed : int, optional
        For the simulated pen: its true motors, friction and weights deviate randomly from the described ones.
    real_time : bool, optional
        For the simulated pen: False runs its clock as fast as the machine computes, for tests.

    Returns
    -------
    PenDevice

    Raises
    ------
    PenError
        If the device does not open; with the reason and the remedy.

    Examples
    --------
    >>> with riffler.pen.open("simulated") as pen:
    ...     pen.state().pose.shape
    (6,)
    """
    path = os.fspath(what)
    given = {
        "bubble": bubble,
        "exponent": exponent,
        "turn_rate": turn_rate,
        "hold_orientation": hold_orientation,
        "signs": signs,
        "geometry": geometry,
        "gravity": gravity,
        "friction": friction,
        "seed": seed,
        "real_time": real_time,
    }
    options: dict[str, Any] = {name: value for name, value in given.items() if value is not None}
    if path.endswith(".rjournal"):
        if options:
            raise ValueError(f"a recording has no option {min(options)!r}")
        strokes = []
        for number, stroke in enumerate(Journal.load(path).strokes):
            if stroke.times is None:
                raise ValueError(f"stroke {number} has no times: it cannot be played")
            strokes.append((stroke.poses, stroke.times))
        return _play_pen(strokes, 1.0 if speed is None else speed)
    if speed is not None:
        options["speed"] = speed
    device = _open_pen(path, **options)
    _open_devices.add(device)
    return device


@atexit.register
def _stop_all() -> None:
    """Ends the force of open devices when the process ends."""
    for device in list(_open_devices):
        device.stop()
