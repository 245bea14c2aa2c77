"""Force and torque of the removed material of moves that turn the tool, as an integral in numpy.

Each point of a lattice is removed at the first time at which the tool, from its profile alone, contains it. Nothing of
the core is used.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

CONSTANT, DT = 0.05, 0.02  # N·s/mm³, s
BOX = np.array([[-12.0, -10, -8], [14, 10, 0]])  # mm, of the stock
LENGTH = 30.0  # mm, of the cutters


def ball(z: np.ndarray) -> np.ndarray:
    """Radius of a Ø6 ball end at heights above the tip."""
    return np.where(z < 3, np.sqrt(np.clip(9 - (3 - z) ** 2, 0, None)), 3.0)


def flat(z: np.ndarray) -> np.ndarray:
    return np.full_like(z, 3.0)


def cone(z: np.ndarray) -> np.ndarray:
    return np.minimum(0.5 + 0.25 * z, 4.0)


RADII: dict[str, Callable[[np.ndarray], np.ndarray]] = {"ball": ball, "flat": flat, "cone": cone}


class Move(NamedTuple):
    """From a pose to a pose: tips in mm, unit axes."""

    from_tip: np.ndarray
    from_axis: np.ndarray
    to_tip: np.ndarray
    to_axis: np.ndarray


def _move(*vectors: list[float]) -> Move:
    a, b, c, d = (np.asarray(v, float) for v in vectors)
    return Move(a, b / np.linalg.norm(b), c, d / np.linalg.norm(d))


MOVES = {
    "forward, by 20 degrees": _move([-4, 0, -3], [-0.17, 0, 1], [3, 1, -3.5], [0.17, 0.1, 1]),
    "in one place": _move([0, 0, -4], [-0.5, 0, 1], [0, 0, -4], [0.5, 0.2, 1]),
    "upwards, sideways": _move([-3, -2, -5], [0, -0.6, 1], [2, 2, -2], [0.3, 0.4, 1]),
}


def integral(
    radius: Callable[[np.ndarray], np.ndarray], move: Move, spacing: float = 0.32, times: int = 120
) -> tuple[float, np.ndarray, np.ndarray]:
    """(removed mm³, force N, torque N·mm about the last tip) of a cutter in the block BOX, in DT seconds: each point
    pushes against its velocity. What the tool stands in before it moves has been removed before."""
    sides = [np.arange(low + spacing / 2, high, spacing) for low, high in BOX.T]
    points = np.stack(np.meshgrid(*sides, indexing="ij"), -1).reshape(-1, 3)
    across = np.cross(move.from_axis, move.to_axis)
    angle = np.arccos(np.clip(move.from_axis @ move.to_axis, -1, 1))
    normal = across / np.linalg.norm(across)
    side, spin, way = np.cross(normal, move.from_axis), angle * normal, move.to_tip - move.from_tip
    force, torque, removed = np.zeros(3), np.zeros(3), 0.0
    cell = spacing**3
    for t in np.arange(times + 1) / times:
        axis, tip = np.cos(t * angle) * move.from_axis + np.sin(t * angle) * side, move.from_tip + t * way
        z = (points - tip) @ axis
        aside = np.linalg.norm(points - tip - z[:, None] * axis, axis=1)
        inside = (z >= 0) & (z <= LENGTH) & (aside <= radius(z))
        gone, points = points[inside], points[~inside]
        if t == 0:
            continue
        velocity = way + np.cross(spin, gone - tip)
        pushes = -CONSTANT * cell / DT * velocity / np.linalg.norm(velocity, axis=1)[:, None]
        force += pushes.sum(0)
        torque += np.cross(gone - move.to_tip, pushes).sum(0)
        removed += cell * len(gone)
    return removed, force, torque
