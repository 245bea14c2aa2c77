"""A session in which a device turns a plan's tool, between two polls, without Blender."""

from __future__ import annotations

import numpy as np
import riffler


class OrientRun:
    """An open device and its session on one path: `start`, `look` about thirty times a second, `halt`; finally `close`.

    `options` are riffler.OrientSession's.
    """

    def __init__(self, device, path, tool, collider, options):
        self.device = device
        self.session = riffler.OrientSession(path, tool, collider, device, **options)
        self.pose: np.ndarray | None = None  # (6,) pose of the tool, mm
        self.station = 0.0  # place on the path: a point index with a fraction
        self.push = np.zeros((2, 3))  # N, N·mm about its tip: on the tool, the mean since the last poll
        self.state, self.force, self.torque, self.why = "off", 0.0, 0.0, ""  # the force on the hand
        self.touching: str | None = None  # part of the tool, or "fixture"
        self._points, self._closed = len(path), path.closed

    def start(self) -> None:
        self.session.start()

    @property
    def running(self) -> bool:
        return self.session.running

    @property
    def point(self) -> int:
        """The nearest point of the path."""
        return round(self.station) % self._points

    @property
    def pushes(self) -> bool:
        """True if the device has motors."""
        return any(axis.pushes for axis in self.device.limits.values())

    def look(self) -> tuple[riffler.KeyChange, ...]:
        """Updates what is shown, and returns what the buttons did."""
        changes = self._take(self.session.frame())
        # A simulated hand presses no button to confirm an error.
        if self.state == "tripped" and self.device.kind == "simulated" and not self.device.state().fault:
            self.session.reset()
        return changes

    def halt(self) -> tuple[riffler.KeyChange, ...]:
        """Stops the device's forces and the session, and returns what the last presses did."""
        if not self.running:
            return ()
        changes = self._take(self.session.stop())
        self.push = np.zeros((2, 3))
        return changes

    def close(self) -> None:
        self.device.stop()

    def _take(self, frame) -> tuple[riffler.KeyChange, ...]:
        self.state, self.touching = frame.state, frame.touching
        if len(frame):
            self.pose, self.station = frame.tool, frame.station
            self.push = frame.tool_forces.mean(axis=0).reshape(2, 3)
        self.force, self.torque = float(np.linalg.norm(frame.force)), float(np.linalg.norm(frame.torque))
        health = self.device.health().problem if self.session.running else None
        cause = frame.cause if frame.state not in ("ready", "ramp", "active") else None
        self.why = frame.problem or health or cause or ""
        return frame.changes
