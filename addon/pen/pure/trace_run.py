"""A session in which a device leads a tool over an exact surface, between two polls, without Blender."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import riffler

from .device_run import DeviceRun

STEP = 0.1  # mm of the tool's motion between two points of a trace
MOST_POINTS = 100_000  # of all traces
BUDGET = 3000.0  # µs of a query for what is shown
STIFFNESS = 50.0  # N per mm of depth and mm² of surface: a ball of 6 mm pressed with 1 N is 0.05 mm deep


def collider(surface: riffler.Surface, progress=None) -> riffler.Collider:
    """The surface as the tool feels it."""
    return riffler.Collider.made(surface, stiffness=STIFFNESS, holder_stiffness=STIFFNESS, progress=progress)


@dataclass
class Traces:
    """Points of the surface that the tool has touched, in pieces without a gap: between two pieces it was free."""

    pieces: list[list[np.ndarray]] = field(default_factory=list)  # of (3,) mm
    points: int = 0
    _open: bool = False
    _last: np.ndarray | None = None  # tip of the tool at the last point

    def wants(self, pose: np.ndarray) -> bool:
        """Whether the tool has moved far enough for another point."""
        if self.points >= MOST_POINTS:
            return False
        return not self._open or self._last is None or float(np.linalg.norm(pose[:3] - self._last)) >= STEP

    def add(self, pose: np.ndarray, point: np.ndarray) -> None:
        if not self._open:
            self.pieces.append([])
        self.pieces[-1].append(point)
        self._open, self._last, self.points = True, pose[:3].copy(), self.points + 1

    def lift(self) -> None:
        """The tool is free."""
        self._open = False


class TraceRun(DeviceRun):
    """An open device and its session on one surface: `start`, `look` about thirty times a second, `halt`; finally
    `close`.

    `options` are riffler.Session's; `view`: the device's axes follow a view.
    """

    def __init__(self, device, tool, surface, collider, options, view=False):
        self.device, self.tool = device, tool
        self._surface, self._collider = surface, collider
        self.turns_with(view, options)
        # A session cuts a stock. All of this one is protected, and what is protected is air to the tool.
        stock = riffler.Volume.block((0, 0, 0), (1, 1, 1), pitch=1.0)
        self.session = riffler.Session(stock, tool, device, obstacles=collider, protect=stock.copy(), **options)
        self.pose: np.ndarray | None = None  # (6,) pose of the tool, mm
        self.state, self.force, self.why = "off", 0.0, ""  # the force on the hand
        self.depth, self.part = 0.0, ""  # mm; the deepest part of the tool, "" if it is free
        self.contact: tuple[np.ndarray, np.ndarray] | None = None  # deepest point and normal of the surface there
        self.traces = Traces()

    def _take(self, frame) -> None:
        self.state, self.force = frame.state, float(np.linalg.norm(frame.force))
        if self.gone:
            self.state, self.force = "off", 0.0
        self.why = self.reason(frame)
        if not len(frame):
            return
        self._trace(frame)
        self.pose = frame.tool
        found = self._collider.query(self.tool, self.pose, budget_us=BUDGET)
        self.depth, self.part, self.contact, self.push = found.depth, "", None, np.zeros((2, 3))
        if found.depth > 0:
            point, normal, _ = self._surface.closest(found.points[:1])
            self.part, self.contact = found.parts[0], (point[0], normal[0])
            self.push = np.array([found.force, found.torque])

    def _trace(self, frame) -> None:
        """Adds the steps in which the tool touched."""
        touching = (frame.depth > 0) & (frame.missed == 0)
        for pose, touches in zip(frame.poses, touching, strict=True):
            if not touches:
                self.traces.lift()
            elif self.traces.wants(pose):
                found = self._collider.query(self.tool, pose, budget_us=BUDGET)
                if found.depth > 0:
                    self.traces.add(pose, self._surface.closest(found.points[:1])[0][0])
                else:
                    self.traces.lift()
