"""What the simulated hand carves, and where it goes."""

from __future__ import annotations

import numpy as np

from .. import Collider, Volume

STROKE = 3.0  # s
SIZE = np.array([50.0, 40.0, 16.0])  # mm, of the block
TABLE = 6.0  # mm below the block's top: what the tool stays out of
TOOL = 8.0  # mm, diameter of the ball
REMOVAL = 0.004  # N·s/mm³: soft enough for the hand to keep its pace
ABOVE = 6.0  # mm over the block's top, between strokes


def block_at(home: np.ndarray, pitch: float) -> Volume:
    """Its top's middle is where the pen is at home."""
    lower = home[:3] - SIZE * [0.5, 0.5, 1.0]
    return Volume.block(lower, lower + SIZE, pitch)


def table_at(home: np.ndarray) -> Collider:
    """In the block, larger than it to all sides: passes that are deeper than it press the tool on it."""
    lower = home[:3] - SIZE * [0.7, 0.7, 1.5]
    upper = np.append(home[:2] + 0.7 * SIZE[:2], home[2] - TABLE)
    return Collider(Volume.block(lower, upper, 1.0).to_mesh())


def hand_at(home: np.ndarray, seconds: float) -> tuple[np.ndarray, int]:
    """Where the hand goes, and which buttons it holds: passes over the block side by side, each deeper, with button 1
    held while the tool is down."""
    number, phase = divmod(seconds / STROKE, 1)
    side = -1 if number % 2 else 1
    along = side * 18 * np.cos(np.pi * np.clip((phase - 0.15) / 0.7, 0, 1))
    down = np.sin(np.pi * np.clip((phase - 0.05) / 0.9, 0, 1)) ** 0.5
    depth = 2 + min(number, 6)
    point = home[:3] + np.array([along, -12 + 4 * (number % 7), ABOVE - (ABOVE + depth) * down])
    axis = home[3:] + np.array([0.15 * side * np.sin(2 * np.pi * phase), 0.0, 0.0])
    return np.concatenate([point, axis / np.linalg.norm(axis)]), int(down > 0.3)
