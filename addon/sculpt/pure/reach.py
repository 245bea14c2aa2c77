"""How far a cutter that adds material reaches out of the stock's box, where no material can be."""

from __future__ import annotations

import numpy as np

SLIGHT = 0.01  # pitches: an invisible amount
CUT_OFF = "The added material was cut off at the stock's box: use Grow Box in Clay to enlarge it"


def outline_of(tool) -> np.ndarray:
    """(k, 2) radius and height of a riffler.Tool's cutter, without shank and holder; mm."""
    return np.vstack([line for part, line in tool.outline(tolerance=1e-3 * tool.diameter) if part == "cutter"])


def is_cut_off(outline: np.ndarray, poses: np.ndarray, volume) -> bool:
    """True if material added along these poses would visibly stick out of the volume's box."""
    return past(outline, poses, volume.lower, volume.upper) > SLIGHT * volume.pitch


def past(outline: np.ndarray, poses: np.ndarray, lower, upper) -> float:
    """mm by which a cutter with this outline sticks out of the box at one of the poses (n, 6), on any side; 0 if it
    does not. Between two poses it stays within the reach of both, apart from the turn of the axis."""
    tip, axis = poses[:, None, :3], poses[:, None, 3:]
    radius, height = outline[:, 0, None], outline[:, 1, None]
    across = radius * np.sqrt(np.maximum(1 - axis**2, 0))  # of a disc, along each axis of the box
    middle = tip + height * axis
    out = max((middle + across - upper).max(), (lower - (middle - across)).max())
    return max(float(out), 0.0)
