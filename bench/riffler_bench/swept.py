"""Paths judged from outside: evaluates the motion between rows again, and how deep surfaces enter the tool on it."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from riffler import Mesh, Tool, Volume

from . import _bench as core

# mm between an entry that is attained and the proof that nothing is deeper: everywhere, and where that is not enough.
GAP, CLOSE = 1e-3, 2e-5


def dense(rows: np.ndarray, way: float, turn: float) -> tuple[np.ndarray, np.ndarray]:
    """Poses (m, 6) on the moves between rows (n, 6), at most `way` mm and `turn` rad apart, ends included, and for each
    the number of its move: the tip on a line, the axis on the great circle at constant rate."""
    poses, moves = [], []
    for k, (a, b) in enumerate(pairwise(rows)):
        normal = np.cross(a[3:], b[3:])
        angle = np.arctan2(np.linalg.norm(normal), a[3:] @ b[3:])
        parts = int(max(1, np.ceil(np.linalg.norm(b[:3] - a[:3]) / way), np.ceil(angle / turn)))
        t = np.linspace(0, 1, parts + 1)[:, None]
        side = np.cross(normal, a[3:])  # square to the first axis, towards the second
        length = np.linalg.norm(side)
        side = side / length if length > 0 else side
        axes = np.cos(t * angle) * a[3:] + np.sin(t * angle) * side
        poses.append(np.hstack([a[:3] + t * (b[:3] - a[:3]), axes / np.linalg.norm(axes, axis=1)[:, None]]))
        moves.append(np.full(parts + 1, k))
    if not poses:
        return rows, np.zeros(len(rows), int)
    return np.concatenate(poses), np.concatenate(moves)


@dataclass(frozen=True)
class Box:
    """A jaw: as a dexel volume for what is judged, as its twelve triangles for the judge."""

    lower: np.ndarray
    upper: np.ndarray

    def volume(self, pitch: float) -> Volume:
        return Volume.block(self.lower, self.upper, pitch, directions="xyz")

    def corners(self) -> np.ndarray:
        share = np.stack(np.meshgrid([0, 1], [0, 1], [0, 1], indexing="ij"), -1).reshape(-1, 3)
        return self.lower + share * (self.upper - self.lower)

    def holds(self, points: np.ndarray) -> np.ndarray:
        return ((points > self.lower) & (points < self.upper)).all(-1)


# Corners are numbered 4 x + 2 y + z.
SIDES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
FACES = np.array([face for a, b, c, d in SIDES for face in ((a, b, c), (a, c, d))])


def surface(boxes: list[Box]) -> Mesh:
    corners = np.concatenate([box.corners() for box in boxes])
    return Mesh(corners, np.concatenate([8 * k + FACES for k in range(len(boxes))]))


@dataclass(frozen=True)
class Judge:
    """The part, the jaws, and the tool, of which `top` is the highest piece's height over the tip."""

    part: Mesh
    jaws: list[Box]
    tool: Tool
    top: float

    def entries(self, poses: np.ndarray, allowed: float = np.inf, gap: float = GAP) -> np.ndarray:
        """(n, 2): how deep the surface of part or jaws enters cutter, shank or holder at each pose, mm, as attained at
        a point of it, and as proven; closer where the first proof does not keep to what is `allowed`. Where a solid
        holds all of the tool nothing enters: `holds_top` finds those."""
        out = np.zeros((len(poses), 2))
        for mesh in (self.part, surface(self.jaws)):
            found = core.contact_entries(mesh, self.tool, poses, gap)
            close = found[:, 1] > allowed
            found[close] = core.contact_entries(mesh, self.tool, poses[close], CLOSE)
            out = np.maximum(out, found)
        return out

    def holds_top(self, poses: np.ndarray) -> np.ndarray:
        """Whether the tool's upper end is in a jaw, or within the part's box: otherwise a tool, being in one piece,
        cannot be in either without crossing its surface."""
        tops = poses[:, :3] + self.top * poses[:, 3:]
        lower, upper = np.asarray(self.part.bounds)
        return np.any([box.holds(tops) for box in (*self.jaws, Box(lower, upper))], axis=0)
