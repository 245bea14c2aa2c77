"""The motions of `riffler pen identify`: paths of the grip, moving along them, and the records.

A weak spring (0.3 N/mm) moves along the path and leads the grip; every force passes the limits and the safety gate of
all forces. This program is the gate's dead-man switch: it must report itself several times a second.
"""

from __future__ import annotations

import queue
import sys
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise, product

import numpy as np

from .. import pen
from .._core import _PoseFollower
from .pen_fit import JOINTS, SLOWEST, HungWeight, Sweep

LEAN = 0.35  # of the grip's axis from home, standard deviation along two axes
MARGIN = 0.15  # share of the workspace's box that paths avoid at each side
PEAK = 1.875  # peak speed of a quintic, relative to its mean
SLOW, FAST = 0.35, 2.0  # rad/s of the fastest joint
TOP_SPEED = 300.0  # mm/s of the grip
SHORTEST = 0.4  # rad: some joint turns at least this far in a sweep
# Largest angle of joint 2 minus joint 3, rad; 0 at a right angle. The dry friction of a nearly straight arm holds the
# grip against the spring until the grip comes loose faster than is safe.
ELBOW = 0.5
CANDIDATES = 12  # random postures for the end of the next sweep, which takes the most informative one
LATEST = 0.8  # s after which the simulated hand must not let go: the grip would be off the path, and snap back
TRIES = 20  # attempts at a motion of the simulated pen, whose hand is late on a busy machine
HOLD = 1.5  # s at the start in which the motors hold the grip and the hand lets go
WIGGLE = 1.2  # s of a push back and forth
PUSH, TWIST = 0.8, 12.0  # N, N·mm: force and torque of such a push


class MotionStoppedError(RuntimeError):
    """The motion was stopped, or stopped itself."""


class MotionTrippedError(MotionStoppedError):
    """The motion stopped itself: a joint stuck, came loose and was too fast, or the grip was held."""


class _LateHandError(RuntimeError):
    """The simulated hand let go too late, because this program did not get the processor in time."""


@dataclass(frozen=True)
class Path:
    """Poses, times and extra wrenches of a motion; sweeps are between the keys from ``first`` on."""

    times: np.ndarray
    poses: np.ndarray
    wrenches: np.ndarray
    first: int

    @property
    def seconds(self) -> float:
        return float(self.times[-1] - self.times[0])


def home_of(geometry: pen.PenGeometry) -> np.ndarray:
    return geometry.forward([geometry.home])[0]


def sweeps(geometry: pen.PenGeometry, number: int, rate: float, seed: int) -> Path:
    """Home, ``number`` postures all over the middle of the workspace, and home again; the fastest joint at ``rate``.

    In every sweep the joints turn at different speeds, so that no two columns of the fit are alike. The next posture is
    the one of several random ones whose sweep is most informative.
    """
    random = np.random.default_rng(seed)
    home = home_of(geometry)
    lower, upper = np.array(geometry.limits.lower), np.array(geometry.limits.upper)
    lower, upper = lower + MARGIN * (upper - lower), upper - MARGIN * (upper - lower)
    # The box is in the arms' frame, which may differ from that of poses: offsets from home connect the two.
    middle = geometry.ends([geometry.home])[0].mean(axis=0)
    turn = base_axes(geometry)
    poses = [home]
    for _ in range(number):
        tried: list[tuple[float, np.ndarray]] = []
        for _ in range(200 * CANDIDATES):
            axis = home[3:] + turn @ np.append(random.normal(size=2) * LEAN, 0.0)
            place = home[:3] + turn @ (random.uniform(lower, upper) - middle)
            pose = np.concatenate([place, axis / np.linalg.norm(axis)])
            if farthest(geometry, poses[-1], pose) >= SHORTEST and reaches(geometry, poses[-1], pose):
                tried.append((told(geometry, poses[-1], pose, rate), pose))
            if len(tried) == CANDIDATES:
                break
        if not tried:
            break
        poses.append(max(tried, key=lambda one: one[0])[1])
    if len(poses) < number + 1:
        raise ValueError(f"{geometry.name} has too little room for sweeps: are its limits right?")
    poses.append(home)
    times, first = [0.0, HOLD], 1
    for a, b in pairwise(poses):
        times.append(times[-1] + duration(geometry, a, b, rate))
    return Path(np.array(times), np.array([home, *poses]), np.zeros((len(times), 6)), first)


def base_axes(geometry: pen.PenGeometry) -> np.ndarray:
    """(3, 3): the axes of the arms' frame as columns in the frame of poses, from the motion of the pivot."""
    counts = np.array([geometry.home] * 4)
    counts[1:] += (np.eye(6)[[0, 1, 2]] * 2000).astype(counts.dtype)
    ours, its = geometry.ends(counts).mean(axis=1), geometry.forward(counts)[:, :3]
    a, b = (ours[1:] - ours[0]).T, (its[1:] - its[0]).T
    left, _, right = np.linalg.svd(b @ np.linalg.inv(a))
    return left @ right


def farthest(geometry: pen.PenGeometry, a: np.ndarray, b: np.ndarray) -> float:
    """Largest turn of a joint between two poses, rad."""
    joints, _ = geometry.inverse([a, b])
    return float(np.abs(joints[1] - joints[0]).max())


def duration(geometry: pen.PenGeometry, a: np.ndarray, b: np.ndarray, rate: float) -> float:
    """Duration in s of a sweep from a to b whose fastest joint turns at ``rate``."""
    slow = PEAK * farthest(geometry, a, b) / rate
    return max(slow, PEAK * float(np.linalg.norm(b[:3] - a[:3])) / TOP_SPEED, 0.3)


def told(geometry: pen.PenGeometry, a: np.ndarray, b: np.ndarray, rate: float) -> float:
    """How informative a sweep from a to b is about friction: the mean square of the slowest joint's speed, rad²/s²,
    over the time in which no joint is too slow for the fit."""
    u = np.linspace(0, 1, 41)
    between = a + (u**3 * (10 + u * (6 * u - 15)))[:, None] * (b - a)
    between[:, 3:] /= np.linalg.norm(between[:, 3:], axis=1)[:, None]
    joints, _ = geometry.inverse(between)
    slowest = np.abs(np.diff(joints, axis=0)).min(axis=1) * (len(u) - 1) / duration(geometry, a, b, rate)
    return float(np.where(slowest > SLOWEST, slowest**2, 0.0).mean())


def reaches(geometry: pen.PenGeometry, a: np.ndarray, b: np.ndarray) -> bool:
    """Whether both arms reach all poses from a to b, and neither comes near to stretched or folded."""
    between = a + np.linspace(0, 1, 15)[:, None] * (b - a)
    between[:, 3:] /= np.linalg.norm(between[:, 3:], axis=1)[:, None]
    joints, found = geometry.inverse(between)
    if any(one != ("reached", "reached") for one in found):
        return False
    elbows = joints[:, [1, 4]] - joints[:, [2, 5]]
    return bool(np.abs(elbows).max() <= ELBOW)


def wiggles(geometry: pen.PenGeometry) -> Path:
    """Pushes back and forth along the three axes of the arms' frame and twists about two; the hand holds the grip."""
    home, turn = home_of(geometry), base_axes(geometry)
    across = np.linalg.svd(home[None, 3:])[2][1:]  # perpendicular to the grip
    wrenches = [np.concatenate([PUSH * axis, np.zeros(3)]) for axis in turn.T]
    wrenches += [np.concatenate([np.zeros(3), TWIST * axis]) for axis in across]
    times, rows = [0.0, 1.0], [np.zeros(6), np.zeros(6)]
    for wrench in wrenches:
        for share in (1.0, -1.0, 0.0):
            times.append(times[-1] + WIGGLE / 3)
            rows.append(share * wrench)
    return Path(np.array(times), np.array([home] * len(times)), np.array(rows), 1)


class Keyboard:
    """Lines from the terminal: answers to questions, and Enter while the pen moves, which stops it."""

    def __init__(self, asks: bool) -> None:
        self.lines: queue.Queue[str] = queue.Queue()
        self.asks = asks
        if asks:
            threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        for line in sys.stdin:
            self.lines.put(line.strip())

    def ask(self, text: str, waiting: Callable[[], None] = lambda: None) -> str:
        """Asks a question and returns the answer; calls ``waiting`` meanwhile. With --yes, asks nothing."""
        if not self.asks:
            return ""
        self.forget()
        print(text, end="", flush=True)
        while True:
            waiting()
            try:
                return self.lines.get(timeout=0.05)
            except queue.Empty:
                continue

    def forget(self) -> None:
        while not self.lines.empty():
            self.lines.get()

    def pressed(self) -> bool:
        return not self.lines.empty()


@dataclass(frozen=True)
class Record:
    """Record of a motion along a path."""

    sequence: np.ndarray  # (n,) numbers of the reports
    times: np.ndarray  # (n,) s on the path
    counts: np.ndarray  # (n, 6)
    currents: np.ndarray  # (n, 6) A
    free_from: float = 0.0  # s on the path after which no hand holds the grip


def drive(
    device: pen.PenDevice,
    path: Path,
    keyboard: Keyboard,
    *,
    leads: bool = True,
    weight: HungWeight | None = None,
    shown: Callable[[float], None] = lambda _: None,
) -> Record:
    """Moves along the path. MotionStoppedError if the motion did not reach the end."""
    for _ in range(TRIES):
        try:
            return _drive(device, path, keyboard, leads, weight, shown)
        except _LateHandError:
            device.aim(home_of(device.truth))  # type: ignore[attr-defined]
            time.sleep(0.2)
    raise MotionStoppedError("this computer is too busy to move the simulated hand in time")


def _drive(
    device: pen.PenDevice, path: Path, keyboard: Keyboard, leads: bool, weight: HungWeight | None,
    shown: Callable[[float], None],
) -> Record:  # fmt: skip
    hook, force = (0.0, 0.0) if weight is None else (weight.hook, weight.force)
    keyboard.forget()
    wait_for_no_fault(device)
    follower = _PoseFollower(
        device, path.times, path.poses, path.wrenches, leads=leads, gravity=float(leads), weight=force, hook=hook
    )
    try:
        free_from = watch(device, follower, path, keyboard, leads, shown)
        if leads:
            take_hold(device, keyboard, follower)
        sequence, times, counts, currents = follower.records()
    finally:
        follower.end()
    return Record(sequence, times, counts, 1e-3 * currents, free_from)


def wait_for_no_fault(device: pen.PenDevice) -> None:
    """Waits until a device that has stopped by itself clears its fault, which it does once no force is sent."""
    end = time.monotonic() + 2
    while device.state().fault:
        if time.monotonic() > end:
            raise MotionStoppedError(f"the pen reports fault {device.state().fault}: switch it off and on again")
        time.sleep(0.01)


def watch(
    device: pen.PenDevice, follower: _PoseFollower, path: Path, keyboard: Keyboard, leads: bool,
    shown: Callable[[float], None],
) -> float:  # fmt: skip
    """Waits for the end of the path; returns `free_from` of its record. The simulated hand lets go at the beginning."""
    simulated = device if leads and isinstance(device, pen.SimulatedPen) else None
    begun, free_from = time.monotonic(), 0.0
    while (state := follower.state) != "holding":
        follower.alive()
        if simulated is not None and not free_from and follower.time > LATEST:
            raise _LateHandError
        if keyboard.pressed():
            follower.stop()
            raise MotionStoppedError("stopped by Enter")
        if state == "stopped" and follower.time >= path.seconds:
            break  # the pen itself ends a long hold at the end
        if state == "stopped":
            if simulated is not None and not free_from:
                raise _LateHandError
            raise MotionTrippedError(str(follower.why))
        if state == "waiting" and time.monotonic() - begun > 5:
            raise MotionStoppedError(follower.why or device.health().problem or "the pen lets no force through")
        if simulated is not None and state == "moving" and not free_from:
            simulated.aim(home_of(simulated.truth), grip=0.0)
            if follower.time > LATEST:
                raise _LateHandError
            time.sleep(0.002)
            free_from = follower.time + 0.5
        shown(follower.time)
        time.sleep(0.002 if simulated else 0.02)
    return free_from


def take_hold(device: pen.PenDevice, keyboard: Keyboard, follower: _PoseFollower) -> None:
    """Holds the grip at home until the hand has it."""
    if isinstance(device, pen.SimulatedPen):
        device.aim(home_of(device.truth))
        time.sleep(0.05)
    keyboard.ask("The motors hold the grip. Take it in your hand; Enter switches them off. ", follower.alive)


def cut(path: Path, record: Record, kind: str) -> list[Sweep]:
    """The sweeps of a record, without those in which the grip was held or reports were lost."""
    out = []
    for start, end in zip(path.times[path.first : -1], path.times[path.first + 1 :], strict=True):
        mine = (record.times >= start) & (record.times < end)
        steps = np.diff(record.sequence[mine].astype(np.int64))
        if start >= record.free_from and len(steps) and (steps == 1).all():
            within = record.times[mine]
            period = float((within[-1] - within[0]) / len(steps))
            out.append(Sweep(record.counts[mine], record.currents[mine], period, kind))
    return out


def reversed_motors(geometry: pen.PenGeometry, counts: np.ndarray, currents: np.ndarray) -> list[str]:
    """Joints whose motor turns against its encoder, by the record of `wiggles`.

    A held grip moves in the direction of the push, by a distance that depends on the hand. The result is the
    combination of reversed motors that explains the motion best.
    """
    home = np.array([geometry.home])
    jacobian, ends = geometry.jacobian(home)[0], geometry.ends(home)[0]
    apart = ends[1] - ends[0]
    length = float(np.linalg.norm(apart))
    order = [JOINTS.index(c.name) for c in geometry.channels]
    torques = np.empty((len(counts), 6))
    for k, (joint, c) in enumerate(zip(order, geometry.channels, strict=True)):
        torques[:, joint] = c.sign * c.ratio * c.torque_constant * currents[:, k]
    # Each joint's share of the force on the grip, and of the turning force at its ends: (n, joint, 2, xyz).
    shares = np.empty((len(counts), 6, 2, 3))
    for joint in range(6):
        arm, k = divmod(joint, 3)
        force = torques[:, joint, None] * np.linalg.inv(jacobian[arm])[k]
        shares[:, joint, 0], shares[:, joint, 1] = force, (force if arm else -force) / length
    moved = geometry.ends(counts)
    motion = np.stack([moved.mean(axis=1), (moved[:, 1] - moved[:, 0]) / length], axis=1)
    along = apart / length
    square = np.eye(3) - np.outer(along, along)
    shares[:, :, 1], motion[:, 1] = shares[:, :, 1] @ square, motion[:, 1] @ square
    shares, motion = shares - shares.mean(axis=0), motion - motion.mean(axis=0)
    if np.abs(motion[:, 0]).max() < 0.1:
        raise MotionStoppedError(
            "the grip did not move when it was pushed: are the motors connected? Is the grip held too firmly?"
        )

    def agreement(signs: Sequence[float]) -> float:
        """Correlation of push and motion: of translation and of rotation, the mean of both."""
        push = np.einsum("njdx,j->ndx", shares, np.array(signs))
        each = [
            float((push[:, d] * motion[:, d]).sum() / np.sqrt((push[:, d] ** 2).sum() * (motion[:, d] ** 2).sum()))
            for d in (0, 1)
        ]
        return sum(each) / 2

    best = max(product((1.0, -1.0), repeat=6), key=agreement)
    return [name for name, sign in zip(JOINTS, best, strict=True) if sign < 0]
