"""The pen's axes turned with the view: right, up and away of the hand are those of the picture. No Blender.

The axes follow the view only between strokes. While a button is held, or the tool touches something, they stay: a
stroke that changes its direction because the view turns is not what the hand does. They turn when it is released. The
tool does not jump: pen and tool are paired again where both are (riffler.Session.set_workspace).
"""

from __future__ import annotations

import numpy as np

# Right, up and away from the user, in a device's own frame.
RIGHT_AWAY_UP = np.array([[1.0, 0, 0], [0, 0, 1], [0, 1, 0]])
TOWARDS_RIGHT_UP = np.array([[0.0, 1, 0], [0, 0, 1], [-1, 0, 0]])  # x towards the hand
OF_ARMS = {"riffler-pen", "simulated", "polhem"}  # devices whose frame is that of their arms (docs/pen-geometry.md)
SAME = 1e-6  # of the entries of a turn


def axes_of(kind: str) -> np.ndarray:
    """(3, 3): right, up and away of the user, in the frame of a device of that kind."""
    return TOWARDS_RIGHT_UP if kind in OF_ARMS else RIGHT_AWAY_UP


def turn_of(kind: str, view: np.ndarray, to_frame: np.ndarray) -> np.ndarray:
    """Rotation (3, 3) from the frame of a device to that of the tool. `view`: rows are right, up and towards the viewer
    in the world; `to_frame`: world → the tool's frame. Both may scale, or be in single precision."""
    seen = _rotation(view) * np.array([[1.0], [1.0], [-1.0]])
    return _rotation(_rotation(to_frame) @ seen.T @ axes_of(kind))


def _rotation(matrix: np.ndarray) -> np.ndarray:
    """The nearest rotation. ValueError for a matrix that has none: flat, or not finite."""
    matrix = np.asarray(matrix, float)
    if not np.isfinite(matrix).all():
        raise ValueError("the view's axes are not finite")
    u, size, v = np.linalg.svd(matrix)
    if size[-1] <= 1e-9 * size[0]:
        raise ValueError("the view's axes are flat: set the scale of the object to other values than 0")
    if np.linalg.det(u @ v) < 0:  # an object that mirrors: a hand cannot
        u[:, -1] *= -1
    return u @ v


class ViewTurn:
    """The turn of a device of that kind, which follows a view. `turn` is None until the first view."""

    def __init__(self, kind: str):
        self.kind, self.turn = kind, None

    def follow(self, view: np.ndarray, to_frame: np.ndarray, held: bool = False) -> np.ndarray | None:
        """The new turn, or None if it stays: because nothing has changed, or `held`."""
        if held and self.turn is not None:
            return None
        turn = turn_of(self.kind, view, to_frame)
        if self.turn is not None and np.abs(turn - self.turn).max() <= SAME:
            return None
        self.turn = turn
        return turn
