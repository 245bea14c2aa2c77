"""The scenes, as poses and volumes. B200's path and the named cutters are the core's, as in the C++ benchmarks."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from riffler import Mesh, Tool

from . import _bench as core

BLOCK = ([0.0, 0.0, 0.0], [100.0, 60.0, 30.0])
MOVES = core.MOVES
# mm³ that B200 takes away with a ball end mill that reaches out of the block: the limit of ever finer pitch.
B200_REMOVED = 180000 - 177055.25


@dataclass(frozen=True)
class Cutter:
    """A named cutter; the point `centre_height` above its tip is what follows a path."""

    name: str
    tool: Tool
    centre_height: float

    def path(self, turning: bool) -> np.ndarray:
        return core.path(self.centre_height, turning)


def cutters() -> list[Cutter]:
    return [Cutter(*entry) for entry in core.cutters()]


def upright(tips: np.ndarray) -> np.ndarray:
    return np.concatenate([tips, np.tile([0.0, 0.0, 1.0], (len(tips), 1))], 1)


# ---- single moves


@dataclass(frozen=True)
class Motion:
    """One move; `angle` in degrees and `about` say how it turns, if it does."""

    name: str
    poses: np.ndarray
    angle: float = 0.0
    about: str = ""


def motions() -> list[Motion]:
    """Moves in B200's block: rotations about the tip and about a point 50 mm up the axis, plunges, retracts, others."""
    middle, tilt = np.array([50.0, 30.0, 22.0]), unit([0.3, -0.5, 1])
    out = []
    for about, arm in (("tip", 0.0), ("50 mm up", 50.0)):
        for angle in (1, 10, 60, 120):
            half = math.radians(angle) / 2
            axes = np.array([turned(-half), turned(half)])
            # The tip's chord runs through the block at the same height for every angle.
            tips = middle + np.array([0, 0, arm * math.cos(half)]) - arm * axes
            out.append(Motion(f"{angle}° about {about}", np.concatenate([tips, axes], 1), angle, about))
    straight = {
        "level": ([20, 20, 22], [40, 33, 22], [0, 0, 1]),
        "ramp": ([20, 20, 26], [40, 33, 21], [0, 0, 1]),
        "tilted ramp": ([20, 20, 26], [40, 33, 21], tilt),
        "plunge": ([50, 30, 36], [50, 30, 8], [0, 0, 1]),
        "retract": ([50, 30, 8], [50, 30, 36], [0, 0, 1]),
        "tilted plunge": (middle + 16 * tilt, middle - 12 * tilt, tilt),
        "tilted retract": (middle - 12 * tilt, middle + 16 * tilt, tilt),
    }
    for name, (start, end, axis) in straight.items():
        out.append(Motion(name, np.array([[*start, *axis], [*end, *axis]], float)))
    return out


def unit(vector) -> np.ndarray:
    return np.asarray(vector, float) / np.linalg.norm(vector)


def turned(angle: float) -> np.ndarray:
    """The upright axis turned by `angle` (rad) about a level line that is square to no row of rays."""
    side = unit([1.0, 0.35, 0.0])
    return math.sin(angle) * side + math.cos(angle) * np.array([0.0, 0.0, 1.0])


# ---- long and fine paths

S500K_BLOCK = ([0.0, 0.0, 0.0], [100.0, 60.0, 20.0])
S500K_STEP = 0.4


def s500k(moves: int, ramping: bool) -> np.ndarray:
    """A zigzag in layers through a block of 100 × 60 × 20 mm: rows along x 0.4 mm apart, layers 1.4 mm apart, every
    move 0.4 mm long in the plane; ramping, the tip rises and falls by 0.3 mm once every 20 mm."""
    along, rows = 250, 150
    k = np.arange(moves + 1)
    layer, inside = np.divmod(k, rows * (along + 1))
    row, column = np.divmod(inside, along + 1)
    forth = (row + layer * rows) % 2 == 0
    back_and_forth = np.where(layer % 2 == 0, row, rows - 1 - row)
    x = S500K_STEP * np.where(forth, column, along - column)
    z = 20 - 1.4 * (layer + 1)
    if ramping:
        z = z + 0.3 * np.sin(2 * np.pi * k / 50)
    return upright(np.stack([x, S500K_STEP * back_and_forth, z], 1))


def spiral(steps: int, step: float, middle: tuple[float, float], turning: bool) -> np.ndarray:
    """Ball centres at z = 0 on an inward spiral, steps of `step` mm; the poses are those of a ball of radius 10.

    Turning, the axis swings by 15° as a hand's would.
    """
    angle, points = 0.0, []
    for _ in range(steps + 1):
        radius = 20 - 4 * angle / (2 * math.pi)
        points.append([middle[0] + radius * math.cos(angle), middle[1] + radius * math.sin(angle), 0.0])
        angle += step / radius
    centres = np.array(points)
    swing = math.radians(15) * np.sin(np.arange(steps + 1) / 40) if turning else np.zeros(steps + 1)
    axes = np.array([turned(a) for a in swing])
    return np.concatenate([centres - 10 * axes, axes], 1)


def box_mesh(lower, upper) -> Mesh:
    corners = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)], float)
    vertices = np.asarray(lower) + corners * (np.asarray(upper) - np.asarray(lower))
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return Mesh(vertices, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
