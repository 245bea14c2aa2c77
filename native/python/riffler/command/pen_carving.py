"""The block that the simulated hand carves, and the path of the hand."""

from __future__ import annotations

import numpy as np

from .. import Collider, Volume

STROKE = 3.0  # s
SIZE = np.array([50.0, 40.0, 16.0])  # mm, of the block
TABLE = 6.0  # mm from the block's top down to the table, which the tool must not enter
TOOL = 8.0  # mm, diameter of the ball
REMOVAL = 0.004  # N·s/mm³: soft enough for the hand to keep its pace
ABOVE = 6.0  # mm over the block's top, between strokes


def block_at(home: np.ndarray, pitch: float) -> Volume:
    """The block; the middle of its top is the pen's home."""
    lower = home[:3] - SIZE * [0.5, 0.5, 1.0]
    return Volume.block(lower, lower + SIZE, pitch)


def table_at(home: np.ndarray) -> Collider:
    """The table in the block, wider than it on all sides. Passes deeper than the table press the tool on it."""
    lower = home[:3] - SIZE * [0.7, 0.7, 1.5]
    upper = np.append(home[:2] + 0.7 * SIZE[:2], home[2] - TABLE)
    return Collider(Volume.block(lower, upper, 1.0).to_mesh())


def hand_at(home: np.ndarray, seconds: float) -> tuple[np.ndarray, int]:
    """Pose of the hand and the buttons that it holds. The hand makes passes over the block side by side, each deeper,
    and holds button 1 while the tool is down."""
    number, phase = divmod(seconds / STROKE, 1)
    side = -1 if number % 2 else 1
    along = side * 18 * np.cos(np.pi * np.clip((phase - 0.15) / 0.7, 0, 1))
    down = np.sin(np.pi * np.clip((phase - 0.05) / 0.9, 0, 1)) ** 0.5
    depth = 2 + min(number, 6)
    point = home[:3] + np.array([along, -12 + 4 * (number % 7), ABOVE - (ABOVE + depth) * down])
    axis = home[3:] + np.array([0.15 * side * np.sin(2 * np.pi * phase), 0.0, 0.0])
    return np.concatenate([point, axis / np.linalg.norm(axis)]), int(down > 0.3)
