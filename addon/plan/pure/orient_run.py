"""A session in which a device turns a plan's tool, between two polls, without Blender."""

from __future__ import annotations

import numpy as np
import riffler

from ...pen.pure.device_run import DeviceRun

STAY = 0.6  # points


def point_at(station: float, last: int, points: int, closed: bool) -> int:
    """The point of a path for a station (a point index with a fraction): `last` if that is within STAY of it, otherwise
    the nearest point. Without STAY, frame and map would flicker where a tool rests half way between two points."""
    away = abs(station - last)
    away = min(away, points - away) if closed else away
    return last if away <= STAY else round(station) % points


class OrientRun(DeviceRun):
    """An open device and its session on one path: `start`, `look` about thirty times a second, `halt`; finally `close`.
    `look` and `halt` return what the buttons did.

    `options` are riffler.OrientSession's; `view`: the device's axes follow a view.
    """

    def __init__(self, device, path, tool, collider, options, view=False):
        self.device = device
        self.turns_with(view, options)
        self.session = riffler.OrientSession(path, tool, collider, device, **options)
        self.pose: np.ndarray | None = None  # (6,) pose of the tool, mm
        self.station = 0.0  # place on the path: a point index with a fraction
        self.state, self.force, self.torque, self.why = "off", 0.0, 0.0, ""  # the force on the hand
        self.touching: str | None = None  # part of the tool, or "fixture"
        self.point = options.get("point", 0)  # of the path, see point_at
        self._points, self._closed = len(path), path.closed

    def halt(self) -> tuple[riffler.KeyChange, ...]:
        """Stops the device's forces and the session, and returns what the last presses did."""
        if not self.running:
            return ()
        changes = self._take(self.session.stop())
        self.push = np.zeros((2, 3))
        return changes

    def _take(self, frame) -> tuple[riffler.KeyChange, ...]:
        self.state, self.touching = frame.state, frame.touching
        if len(frame):
            self.pose, self.station = frame.tool, frame.station
            self.point = point_at(self.station, self.point, self._points, self._closed)
            self.push = self.mean_push(frame)
        self.force, self.torque = float(np.linalg.norm(frame.force)), float(np.linalg.norm(frame.torque))
        if self.gone:
            self.state, self.force, self.torque, self.push = "off", 0.0, 0.0, np.zeros((2, 3))
        self.why = self.reason(frame)
        return frame.changes
