"""The roll of a hand tool: poses of a stroke get the direction in which the blade points.

The blade follows its tip like a weight on a short string: it turns into the direction of the movement, and trembling
does not turn it. Where the pointer turns back sharply, the blade is lifted, turned, and set down again, as a carver
does; so successive poses never differ by a half turn.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from .stroke_path import Piece

STRING = 1 / 12  # share of the tool's width: it turns into the direction of its last movement of this length
SHARP = np.cos(np.radians(60))  # a larger change of direction lifts the blade


def square(v: np.ndarray, axis: np.ndarray) -> np.ndarray:
    """The part of `v` perpendicular to the unit vector `axis`."""
    return v - (v @ axis) * axis


def unit_square(v: np.ndarray, axis: np.ndarray) -> np.ndarray:
    """The unit vector perpendicular to `axis` nearest to `v`; if `v` is parallel to it, any perpendicular one."""
    across = square(v, axis)
    size = float(np.linalg.norm(across))
    if size < 1e-9:
        across = square(np.eye(3)[int(np.argmin(np.abs(axis)))], axis)
        size = float(np.linalg.norm(across))
    return across / size


def lowest(hulls, lean: float) -> float:
    """Height (mm, not positive) of the blade's lowest point above its tip, along the direction from which it leans."""
    heights = [hull[:, 2] * np.cos(lean) + hull[:, 0] * np.sin(lean) for hull in hulls]
    return min(0.0, float(np.min(np.concatenate(heights)))) if heights else 0.0


def held(pose: np.ndarray, forward: np.ndarray, lean: float, turn: float, low: float) -> np.ndarray:
    """(9,): the blade on a pose (6,), which points along `forward` turned by `turn` to the left, and whose handle leans
    back by `lean` (rad). Its lowest point, `low` from `lowest`, is where the tip was."""
    axis = pose[3:6]
    forward = np.cos(turn) * forward + np.sin(turn) * np.cross(axis, forward)
    c, s = np.cos(lean), np.sin(lean)
    return np.concatenate([pose[:3] - low * axis, c * axis - s * forward, s * axis + c * forward])


@dataclass
class Roll:
    """Call `add` with each piece of a stroke, and `end` once; both return pieces with poses (n, 9).

    `string`: mm of movement after which the direction is known; `default`: (3,), of a click.
    """

    string: float
    default: np.ndarray
    lean: float = 0.0
    turn: float = 0.0
    low: float = 0.0
    _rows: list = field(default_factory=list, init=False)  # (6,), and _seconds: waiting for a direction
    _seconds: list = field(default_factory=list, init=False)
    _tail: np.ndarray | None = field(default=None, init=False)  # the end of the string
    _forward: np.ndarray | None = field(default=None, init=False)
    _last: np.ndarray | None = field(default=None, init=False)  # (6,) the newest row that was returned,
    _before: np.ndarray | None = field(default=None, init=False)  # and its direction

    def add(self, piece: Piece) -> list[Piece]:
        made = []
        rows, dt = piece.poses, piece.dt
        if piece.new or (self._last is None and not self._rows):
            made += self.end()
            self._wait(rows[0])
        out, times, new = [], [], False  # of the piece that is being made
        for row, seconds in zip(rows[1:], dt, strict=True):
            if self._forward is None:
                self._rows.append(row)
                self._seconds.append(seconds)
                way = square(row[:3] - self._tail, row[3:])
                if np.linalg.norm(way) < self.string:
                    continue
                self._set(way, row)
                waited, spent = self._release()
                out, times, new = waited, spent, True
                continue
            way = square(row[:3] - self._tail, row[3:])
            forward = unit_square(self._forward, row[3:])
            if np.linalg.norm(way) >= self.string:
                if unit_square(way, row[3:]) @ forward < SHARP:
                    made += self._piece(out, times, new)
                    out, times, new = [], [], False
                    self._wait(self._last)
                    self._rows.append(row)
                    self._seconds.append(seconds)
                    continue
                self._set(way, row)
            else:
                self._forward = forward
            if not out:
                out = [self._held(self._last, self._before)]
            out.append(self._held(row, self._forward))
            times.append(seconds)
            self._last, self._before = row, self._forward
        return made + self._piece(out, times, new)

    def end(self) -> list[Piece]:
        """What waits for a direction, in the default one: a click, or the end of a turn."""
        made = []
        if self._forward is None and len(self._rows) > 1:
            self._forward = unit_square(self.default, self._rows[-1][3:])
            rows, seconds = self._release()
            made = self._piece(rows, seconds, True)
        self._rows, self._seconds, self._forward, self._last = [], [], None, None
        return made

    # ------------------------------------------------------------------ within
    def _wait(self, row) -> None:
        self._rows, self._seconds, self._forward, self._tail = [row], [], None, row[:3]

    def _set(self, way, row) -> None:
        self._forward = unit_square(way, row[3:])
        self._tail = row[:3] - self.string * self._forward

    def _release(self):
        rows = [self._held(row, unit_square(self._forward, row[3:])) for row in self._rows]
        seconds = self._seconds
        self._last, self._before = self._rows[-1], self._forward
        self._rows, self._seconds = [], []
        return rows, seconds

    def _held(self, row, forward):
        return held(row, unit_square(forward, row[3:]), self.lean, self.turn, self.low)

    @staticmethod
    def _piece(rows, seconds, new) -> list[Piece]:
        return [Piece(np.array(rows), np.array(seconds), new)] if len(rows) > 1 else []
