"""A simulated hand that carves a block with a pen: what moves the hand, what pushes it, what was cut.

`Carving` is the part of riffler.Session that a display needs. `PushedField` is one without the haptic step: a field
that Python pushes with, as any program of a user's may.
"""

from __future__ import annotations

import threading
import time
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from .. import Tool, Volume, pen

STROKE = 3.0  # s
SIZE = np.array([50.0, 40.0, 16.0])  # mm, of the block
TOOL = 8.0  # mm, diameter of the ball


@dataclass
class Frame:
    """What happened since the last one."""

    times: np.ndarray = field(default_factory=lambda: np.zeros(0))  # s
    poses: np.ndarray = field(default_factory=lambda: np.zeros((0, 6)))  # of the tool
    forces: np.ndarray = field(default_factory=lambda: np.zeros((0, 6)))  # on the hand: N, N·mm
    step_seconds: np.ndarray = field(default_factory=lambda: np.zeros(0))  # of the processor
    removed: float = 0.0  # mm³
    energy: float = 0.0  # N·mm that the hand has given to what is rendered, since the start
    late: int = 0
    state: str = "Off"
    cause: str | None = None


class Carving(Protocol):
    def start(self) -> None: ...
    def frame(self) -> Frame: ...
    def stop(self) -> None: ...


def block_at(home: np.ndarray, pitch: float) -> Volume:
    """The block that the hand carves: its top's middle is where the pen is at home."""
    lower = home[:3] - SIZE * [0.5, 0.5, 1.0]
    return Volume.block(lower, lower + SIZE, pitch)


def hand_at(home: np.ndarray, seconds: float) -> tuple[np.ndarray, int]:
    """Where the hand goes, and which buttons it holds: passes over the block side by side, each deeper, with button 1
    held while the tool is down."""
    number, phase = divmod(seconds / STROKE, 1)
    side = -1 if number % 2 else 1
    along = side * 18 * np.cos(np.pi * np.clip((phase - 0.15) / 0.7, 0, 1))
    down = np.sin(np.pi * np.clip((phase - 0.05) / 0.9, 0, 1)) ** 0.5
    depth = 2 + min(number, 8)
    point = home[:3] + np.array([along, -12 + 4 * (number % 7), 6 - (6 + depth) * down])
    lean = 0.15 * side * np.sin(2 * np.pi * phase)
    axis = home[3:] + np.array([lean, 0.0, 0.0])
    return np.concatenate([point, axis / np.linalg.norm(axis)]), int(down > 0.3)


class PushedField:
    """A viscous block on a springy table, pushed with from a thread of Python's, as fast as that gets."""

    PERIOD = 1e-3
    VISCOSITY = 0.015  # N·s/mm of a tool that is a radius deep

    def __init__(self, device: pen.PenDevice, volume: Volume, stiffness: float) -> None:
        self.device, self.volume, self.stiffness = device, volume, stiffness
        self.tool = Tool.ball(TOOL, 40.0)
        self.top, self.table = float(volume.upper[2]), float(volume.upper[2]) - 6
        self.lock = threading.Lock()
        self.fresh: list[tuple[float, np.ndarray, np.ndarray, float, bool]] = []
        self.late, self.energy = 0, 0.0
        self.ended = threading.Event()
        self.last_cut: np.ndarray | None = None
        self.thread = threading.Thread(target=self._loop, daemon=True)

    def start(self) -> None:
        self.thread.start()

    def stop(self) -> None:
        self.ended.set()
        self.thread.join()

    def frame(self) -> Frame:
        with self.lock:
            fresh, self.fresh = self.fresh, []
            late, energy = self.late, self.energy
        health = self.device.health()
        out = Frame(late=late, energy=energy, state=health["force_state"], cause=health["cause"])
        if fresh:
            times, poses, forces, seconds, down = zip(*fresh, strict=True)
            out.times, out.poses, out.forces = np.array(times), np.array(poses), np.array(forces)
            out.step_seconds = np.array(seconds)
            out.removed = self._carve(out.poses, np.array(down))
        return out

    def _carve(self, poses: np.ndarray, down: np.ndarray) -> float:
        """A stroke lasts while button 1 is held."""
        removed = 0.0
        for pose, cuts in zip(poses, down, strict=True):
            if not cuts:
                self.last_cut = None
            elif self.last_cut is None:
                self.last_cut = pose
            elif np.linalg.norm(pose[:3] - self.last_cut[:3]) > 0.2:
                removed += float(self.volume.carve(self.tool, [self.last_cut, pose], tolerance=0.02).removed.sum())
                self.last_cut = pose
        return removed

    def _loop(self) -> None:
        start, before, held = time.monotonic(), None, np.zeros(3)
        sequence = 0
        while not self.ended.wait(self.PERIOD / 2):
            state = self.device.state()
            if state.sequence == sequence:
                continue
            if sequence and state.sequence > sequence + 10:
                self.late += 1
            sequence, began = state.sequence, time.thread_time()
            force = self._force(state)
            self.device.push(force)
            applied = np.concatenate(state.applied)
            if before is not None:
                # The hold's energy: what the motors had, by the way that the grip went meanwhile.
                self.energy -= float(held @ (state.pose[:3] - before))
            before, held = state.pose[:3], applied[:3]
            spent = time.thread_time() - began
            with self.lock:
                self.fresh.append((time.monotonic() - start, state.pose, applied, spent, bool(state.buttons & 1)))

    def _force(self, state: pen.PenState) -> np.ndarray:
        depth = np.clip((self.top - state.pose[2]) / (TOOL / 2), 0, 1)
        inside = bool(state.buttons & 1) and np.all(np.abs(state.pose[:2] - self._middle()) < SIZE[:2] / 2)
        force = -self.VISCOSITY * depth * state.velocity if inside else np.zeros(3)
        force[2] += self.stiffness * max(0.0, self.table - state.pose[2])
        return np.clip(force, -5, 5)

    def _middle(self) -> np.ndarray:
        return np.asarray(self.volume.lower[:2]) + SIZE[:2] / 2
