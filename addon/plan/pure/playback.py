"""Whether the timeline plays what the program cuts.

The animation is a chain of linear pieces in single precision, tip and quaternion by component; the program moves the
tip on lines and the axis on great circles. Both are compared at ten times as many places as there are rows.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...common import quaternions
from . import motion as motions
from .motion import Motion

TIP, AXIS = 0.01, math.radians(0.01)  # mm and rad: differences that are not worth a report
SAMPLES = 10  # on each move


@dataclass
class Difference:
    """The largest differences between animation and program, and their frames."""

    tip: float = 0.0  # mm
    tip_frame: float = 0.0
    axis: float = 0.0  # rad
    axis_frame: float = 0.0
    samples: int = 0

    @property
    def small(self) -> bool:
        return self.tip <= TIP and self.axis <= AXIS

    def __str__(self) -> str:
        tip, axis = f"{max(self.tip, 1e-4):.2g} mm", f"{max(math.degrees(self.axis), 1e-3):.2g}°"
        if self.small:
            return f"Plays within {tip} and {axis} of the program"
        where = self.tip_frame if self.tip > TIP else self.axis_frame
        return f"Plays up to {tip} and {axis} off the program, at frame {where:.2f}"

    def worse(self, other: Difference) -> Difference:
        """The larger difference of each kind."""
        tip = self if self.tip >= other.tip else other
        axis = self if self.axis >= other.axis else other
        return Difference(tip.tip, tip.tip_frame, axis.axis, axis.axis_frame, self.samples + other.samples)


def compare(motion: Motion, play, samples: int = SAMPLES) -> Difference:
    """`motion` as in the program; `play(frames)` gives the animation's values: tips (n, 3) in mm and quaternions (n, 4)
    of any length."""
    if len(motion) < 2:
        row, share = np.zeros(len(motion), int), np.zeros(len(motion))
    else:
        row = np.append(np.repeat(np.arange(len(motion) - 1), samples), len(motion) - 2)
        share = np.append(np.tile(np.arange(samples) / samples, len(motion) - 1), 1.0)
    if not len(row):
        return Difference()
    after = np.minimum(row + 1, len(motion) - 1)
    frames = motion.frames[row] + share * (motion.frames[after] - motion.frames[row])
    wanted = motions.between(motion.poses, row, share)
    tips, quats = play(frames)
    size = np.linalg.norm(quats, axis=1)
    tip = np.linalg.norm(tips - wanted[:, :3], axis=1)
    # a quaternion near zero has an arbitrary direction
    some = np.where((size > 1e-3)[:, None], quats, 1.0)
    axis = np.where(size > 1e-3, quaternions.angle(quaternions.axes_of(some), wanted[:, 3:]), np.pi)
    k, m = int(tip.argmax()), int(axis.argmax())
    return Difference(float(tip[k]), float(frames[k]), float(axis[m]), float(frames[m]), len(row))
