"""Turns the moves of operations into line segments for drawing, by kind of move."""

from __future__ import annotations

import numpy as np
from riffler.plan import Operation

from ...common import poses

KINDS = {"rapid": 0, "lead": 1, "cut": 2, "link": 3}  # values of Operation.kind


def pieces(op: Operation, to_view: np.ndarray) -> dict[str, np.ndarray]:
    """For each kind of move, the ends (2 n, 3) of its line segments, mapped by `to_view` (4, 4)."""
    if len(op) < 2:
        return {name: np.empty((0, 3)) for name in KINDS}
    tips = poses.transform_points(to_view, op.poses[:, :3])
    ends = np.stack([tips[:-1], tips[1:]], axis=1)
    return {name: ends[op.kind[1:] == number].reshape(-1, 3) for name, number in KINDS.items()}
