"""A session with a pen between two polls, without Blender, and the names of its recordings."""

from __future__ import annotations

import numpy as np
import riffler

from .device_run import DeviceRun


def journal_name(name: str, when) -> str:
    """A file name from a sculpt's name and a date, valid on any file system."""
    kept = "".join(c if c.isalnum() or c in " -_." else "_" for c in name).strip(" .")
    return f"{kept or 'sculpt'} {when:%Y-%m-%d %H-%M-%S}.rjournal"


class PenRun(DeviceRun):
    """A device and its sessions, one after the other. For each session call `prepare`, `start`, `look` about thirty
    times a second and `halt`; at the end call `close`. Nothing else may change a session's volume.

    `options` are riffler.Session's. If they set the tool's pose (`at`), the next session starts from the last pose.
    """

    def __init__(self, device, tool, options):
        self.device, self._tool, self._options = device, tool, dict(options)
        self.session = None
        self.pose: np.ndarray | None = None  # (6,) pose of the tool, mm
        self.state, self.force, self.why = "off", 0.0, ""  # the force on the hand
        self.strokes, self.in_stroke = 0, False  # counts of this session
        self.dropped_ticks = 0  # steps that were dropped because they were not polled in time
        self._rows: list[list[list[float]]] = []
        self._open = False

    def prepare(self, volume, mask=None):
        """Makes the session, which can be given a journal before it starts."""
        if self.pose is not None and "at" in self._options:
            self._options["at"] = self.pose
        if self.axes is not None and self.axes.turn is not None:
            self._options["turn"] = self.axes.turn
        self.session = riffler.Session(volume, self._tool, self.device, protect=mask, **self._options)
        self.strokes, self.in_stroke, self.dropped_ticks, self._open = 0, False, 0, False
        self._rows.clear()
        return self.session

    def halt(self) -> str:
        problem = super().halt()
        self.in_stroke = False
        return problem

    def taken_rows(self) -> list[np.ndarray]:
        """The poses (n, 6) of each stroke finished since the last call."""
        rows = [np.array(stroke) for stroke in self._rows if len(stroke) > 1]
        self._rows.clear()
        return rows

    def _take(self, frame) -> None:
        self.state, self.strokes, self.in_stroke = frame.state, frame.strokes, frame.in_stroke
        if len(frame):
            self.pose, self.push = frame.tool, self.mean_push(frame)
        self.dropped_ticks = frame.dropped_ticks
        self.force = float(np.linalg.norm(frame.force))
        if self.gone:
            self.state, self.force, self.push = "off", 0.0, np.zeros((2, 3))
        self._collect(frame)
        self.why = self.session.journal_problem or self.reason(frame)

    def _collect(self, frame) -> None:
        """Collects a stroke for a journal: from the pose before the first move that removes material."""
        for start, end, cutting, missed in zip(
            frame.starts.tolist(), frame.poses.tolist(), frame.cutting, frame.missed, strict=True
        ):
            if missed:
                continue
            if cutting and not (self._open and self._rows and self._rows[-1][-1] == start):
                self._rows.append([start])
            self._open = bool(cutting)
            if cutting and end != start:
                self._rows[-1].append(end)
