"""Results of pens: devices, their health and limits, the channels of a pen, and the diagnosis of a counter."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from .deprecated import DictResult

__all__ = [
    "CoordinateCapability",
    "DeviceInfo",
    "GripDiagnosis",
    "PenCapability",
    "PenChannel",
    "PenHealth",
    "PenLimits",
    "PushResult",
    "ThreadPriority",
]


@dataclass(frozen=True)
class DeviceInfo(DictResult):
    """One device of this computer.

    Attributes
    ----------
    path : str
        Argument of ``riffler.pen.open``.
    name, maker, serial : str
        As the device reports them.
    id : str
        vendor:product, hexadecimal; empty for devices other than HID.
    kind : str or None
        Kind of the device in ``riffler.pen.kinds``; None if riffler does not support it.
    choice : str or None
        Another argument of ``riffler.pen.open``, "kind:number", if there are several of a kind; otherwise None.
    was_opened : bool
        Whether the device was opened and its description read.
    problem : str or None
        Why the device does not open, in a few words; None if it opens.
    text : str or None
        Why the device does not open, and what to do.
    capability : str or None
        What the device senses and pushes.
    about : str or None
        The device's own description.
    """

    old_keys: ClassVar[Mapping[str, str]] = {"tried": "was_opened"}

    path: str
    name: str
    maker: str
    id: str
    serial: str
    kind: str | None
    choice: str | None
    was_opened: bool
    problem: str | None
    text: str | None
    capability: str | None
    about: str | None


@dataclass(frozen=True)
class CoordinateCapability(DictResult):
    """What a device senses and pushes along one coordinate: x, y, z in mm and N, or a turn in rad and N·mm.

    Attributes
    ----------
    sensing : {"none", "position", "rate"}
        The sensed quantity.
    pushes : bool
        Whether the coordinate has a motor.
    low, high : float
        Range: mm or rad, or mm/s or rad/s.
    resolution : float
        Smallest step of the sensor, in the same units.
    peak, continuous : float
        Largest force or torque for a short time, and in continuous use.
    """

    sensing: Literal["none", "position", "rate"]
    pushes: bool
    low: float
    high: float
    resolution: float
    peak: float
    continuous: float

    @property
    def senses(self) -> Literal["position", "rate"] | None:
        """``sensing``, or None for "none"."""
        return None if self.sensing == "none" else self.sensing

    def _as_dict(self) -> dict[str, object]:
        return super()._as_dict() | {"senses": self.senses}


@dataclass(frozen=True)
class PenCapability(DictResult):
    """What each coordinate of a pen senses and pushes.

    Attributes
    ----------
    name : str
        Name of the pen.
    text : str
        The capability as text.
    axes : dict
        CoordinateCapability of "x", "y", "z" and of the rotations "a", "b", "c".
    """

    name: str
    text: str
    axes: dict[str, CoordinateCapability]


@dataclass(frozen=True, eq=False)
class PenHealth(DictResult):
    """The connection to a device, its force, and counts since the start.

    Attributes
    ----------
    state : str
        State of the connection.
    problem : str or None
        The fault, or None.
    force_state : str
        off, homing, ready, ramp, active, degraded or tripped.
    cause : str or None
        Why the force was removed, and what to do.
    fault : int
        The device's own code, or 0.
    homed : bool
        Whether the pose is certain.
    force, torque : ndarray, shape (3,)
        Force and torque last sent to the device: N, N·mm.
    reports, superseded, lost, malformed : int
        Reports that were read; replaced by a newer one before a step used them; lost; invalid.
    timeouts : int
        Steps without a report.
    writes : int
        Reports that were sent.
    read_errors, write_errors, silences : int
        Errors that ended a connection.
    connections, attempts : int
        Connections, and attempts at one.
    """

    state: str
    problem: str | None
    force_state: str
    cause: str | None
    fault: int
    homed: bool
    force: NDArray[np.float64]
    torque: NDArray[np.float64]
    reports: int
    superseded: int
    lost: int
    malformed: int
    timeouts: int
    writes: int
    read_errors: int
    write_errors: int
    silences: int
    connections: int
    attempts: int


@dataclass(frozen=True, eq=False)
class PushResult(DictResult):
    """The part of a push that the hand will feel.

    Attributes
    ----------
    force, torque : ndarray, shape (3,)
        Felt force and torque: N, N·mm.
    missing_force, missing_torque : ndarray, shape (3,)
        The part that the device cannot render.
    reason : str or None
        Why the hand feels nothing.
    """

    force: NDArray[np.float64]
    torque: NDArray[np.float64]
    missing_force: NDArray[np.float64]
    missing_torque: NDArray[np.float64]
    reason: str | None


@dataclass(frozen=True)
class PenChannel(DictResult):
    """One motor of a pen with its encoder.

    Attributes
    ----------
    name : str
        Arm and joint: "R1" … "L3".
    steps : float
        Counts per turn of the joint.
    ratio : float
        Turns of the motor per turn of the joint.
    sign : {-1, 1}
        Sign of count and command for a positive rotation of the joint.
    home : int
        Count in the home posture.
    low, high : float
        Range of the joint, rad.
    torque_constant : float
        Torque of the motor per current, N·mm/A.
    peak_current, continuous_current : float
        Largest current for a short time, and in continuous use, A.
    coulomb, viscous : float
        Friction at the motor, N·mm and N·mm·s/rad.
    gravity : float
        Torque of the weight at the joint while its link is horizontal, N·mm.
    inertia : float
        Moment of inertia at the joint, kg·mm².
    resistance : float
        Resistance of the winding, Ω.
    """

    name: str
    steps: float
    ratio: float
    sign: int
    home: int
    low: float
    high: float
    torque_constant: float
    peak_current: float
    continuous_current: float
    coulomb: float
    viscous: float
    gravity: float
    inertia: float
    resistance: float


@dataclass(frozen=True, eq=False)
class PenLimits(DictResult):
    """Limits of a pen.

    Attributes
    ----------
    lower, upper : ndarray, shape (3,)
        Corners of the workspace, mm.
    elbow : tuple of float
        Range of the elbows, rad.
    force, torque : float
        Largest force and torque: N, N·mm.
    speed, turn_rate : float
        Largest speeds: mm/s, rad/s.
    """

    lower: NDArray[np.float64]
    upper: NDArray[np.float64]
    elbow: tuple[float, float]
    force: float
    torque: float
    speed: float
    turn_rate: float


@dataclass(frozen=True)
class GripDiagnosis(DictResult):
    """Diagnosis of a pen's counters: which one is wrong.

    Attributes
    ----------
    fault : {"none", "channel", "several", "unclear"}
        "several": bad homing, or another pen; "unclear": twelve postures that differ by 0.02 rad are needed.
    postures : int
        Number of different postures.
    channel : int or None
        The wrong channel, for "channel".
    counts : float or None
        Counts that the channel reads too many.
    left : float or None
        Stretch of the grip that these counts do not explain: mm, root mean square.
    """

    fault: Literal["none", "channel", "several", "unclear"]
    postures: int
    channel: int | None = None
    counts: float | None = None
    left: float | None = None

    def _as_dict(self) -> dict[str, object]:
        return {key: value for key, value in super()._as_dict().items() if value is not None}


@dataclass(frozen=True)
class ThreadPriority:
    """Real-time priority that the system granted to a thread.

    Attributes
    ----------
    level : int
        1 to 99: the thread runs before all normal threads; 0: a normal thread.
    by : str or None
        What granted the priority: "system" or "rtkit".
    text : str
        The granted priority, or why none was granted.
    remedy : str
        How to get the priority; empty if there is nothing to do.

    Examples
    --------
    >>> granted = riffler.pen.real_time()
    >>> granted.text.startswith("real time" if granted.level else "normal")
    True
    """

    level: int
    by: Literal["system", "rtkit"] | None
    text: str
    remedy: str
