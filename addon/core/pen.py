"""A session with a pen between two looks at it, without Blender; names of what it records; a tool's shape."""

from __future__ import annotations

import numpy as np


def journal_name(name: str, when) -> str:
    """Of a sculpt and a date, fit for any file system."""
    kept = "".join(c if c.isalnum() or c in " -_." else "_" for c in name).strip(" .")
    return f"{kept or 'sculpt'} {when:%Y-%m-%d %H-%M-%S}.rjournal"


class PenRun:
    """`start`, then `step` some thirty times a second, then `stop`, once. `volume` is the session's, and nobody else's;
    `mesher` holds its mesh."""

    def __init__(self, device, session, mesher, volume):
        self.device, self.session, self.mesher, self.volume = device, session, mesher, volume
        self.tool: np.ndarray | None = None  # (6,) tip and axis, mm
        self.state, self.force, self.why = "off", 0.0, ""
        self.strokes, self.in_stroke = 0, False
        self.removed = 0.0  # mm³ until the last look
        self._before = volume.volume

    def start(self) -> None:
        self.session.start()

    def step(self) -> list[int]:
        """Brings the volume up to date; the bricks of the mesh that changed."""
        frame = self.session.frame()
        self._look(frame)
        # A simulated hand presses no button to say that it has seen what was wrong.
        if frame.state == "tripped" and self.device.kind == "simulated" and not self.device.state().fault:
            self.session.reset()
        return self.mesher.update(self.volume) if len(frame.tiles) else []

    @property
    def over(self) -> bool:
        """True where nothing more will come: a recording that was played to its end."""
        return self.device.kind == "recording" and self.device.health()["state"] == "stopped"

    def stop(self) -> str:
        """The device does not push any more, and the volume is as the session left it. What went wrong, or nothing."""
        problem = ""
        try:
            if self.session.running:
                self._look(self.session.stop())
        except RuntimeError as error:
            problem = str(error)
        finally:
            self.device.stop()
        self.removed = self._before - self.volume.volume
        return problem

    def _look(self, frame) -> None:
        self.state, self.strokes, self.in_stroke = frame.state, frame.strokes, frame.in_stroke
        if len(frame):
            self.tool = frame.tool
        self.force = float(np.linalg.norm(frame.force))
        self.removed += float(frame.removed.sum())
        health = self.device.health()["problem"] if self.session.running else None
        cause = frame.cause if frame.state not in ("ready", "ramp", "active") else None
        self.why = self.session.journal_problem or frame.problem or health or cause or ""


def solid(outline, sides: int = 32) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (n, 3) and triangles (k, 3) of what a tool's outline, of riffler.Tool.outline, sweeps about z."""
    vertices, triangles = [], []
    angle = 2 * np.pi * np.arange(sides) / sides
    a, b = np.arange(sides), (np.arange(sides) + 1) % sides
    first = 0
    for _, line in outline:
        for radius, height in line:
            vertices.append(np.c_[radius * np.cos(angle), radius * np.sin(angle), np.full(sides, height)])
        for k in range(len(line) - 1):
            low, high = first + k * sides, first + (k + 1) * sides
            if line[k][0] > 0:
                triangles.append(np.c_[low + a, low + b, high + b])
            if line[k + 1][0] > 0:
                triangles.append(np.c_[low + a, high + b, high + a])
        first += len(line) * sides
    return np.concatenate(vertices), np.concatenate(triangles)
