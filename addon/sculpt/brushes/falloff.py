"""The base class of brushes with falloff: dabs of riffler.Volume.brush, as wide as the cutter."""

from functools import cache

import numpy as np
import riffler

from .brush import Brush, Path

DABS = 1 / 10  # distance between two dabs, as a share of the tool's width
STEPS = 512  # samples of the integral over the falloff


@cache
def share(falloff: str, power: int = 1) -> float:
    """Mean of the falloff, raised to `power`, from the centre to the radius."""
    t = (np.arange(STEPS) + 0.5) / STEPS
    return float(np.mean([riffler.falloff(falloff, x) ** power for x in t]))


class FalloffBrush(Brush):
    """A subclass has the `kind` of Volume.brush. Settings are those of a whole pass of the brush, in mm: each dab gets
    a share in proportion to its distance from the last one, so the result does not depend on the number of dabs."""

    kind = ""
    sign = 1.0  # of the amount
    second = "DEPTH"
    falloff = True
    shapes = clear = True

    @property
    def journal(self):
        return self.kind

    def refusal(self, volume):
        if volume.directions == "xyz":
            return ""
        return (
            "Brushes need rays in three directions: use Change Pitch in Clay, and set Rays to Three "
            "(Tri-Dexel) in the box at the lower left"
        )

    def spacing(self, diameter, pitch):
        return max(pitch, DABS * diameter)

    def path(self, axis, depth, diameter, pitch):
        """A dab's centre is on the surface."""
        return Path("NORMAL", 0.0, {"spacing": self.spacing(diameter, pitch)})

    def moves(self, poses, dt, new):
        """All poses but the first, which has had its dab, or is where the tool comes down."""
        return poses[1:], None

    def step(self, sculpt, tool, poses, new):
        """Mean distance between dabs, mm; a click counts as one dab at the usual distance."""
        way = float(np.linalg.norm(np.diff(poses[:, :3], axis=0), axis=1).sum())
        return way / max(len(poses) - 1, 1) if not new or way > 0 else self.spacing(tool.diameter, sculpt.volume.pitch)

    def options(self, sculpt, tool):
        return {"strength": 1.0, "amount": self.sign * self.height(sculpt, tool), "falloff": sculpt.falloff}

    def height(self, sculpt, tool, power=1):
        """A dab's share of the depth, mm, for an effect that is the falloff raised to `power`."""
        return sculpt.depth * sculpt.pressure * sculpt.step / (tool.diameter * share(sculpt.falloff, power))

    def reach(self, sculpt, tool, strength):
        """A dab's share of the strength that a whole pass reaches."""
        return 1 - (1 - strength) ** (2 * sculpt.step / tool.diameter)

    def apply(self, sculpt, tool, poses, dt):
        made = sculpt.volume.brush(
            self.kind, poses, 0.5 * tool.diameter, protect=sculpt.mask, **self.options(sculpt, tool)
        )
        sculpt.cut_off |= made.clipped
        sculpt.lost += made.lost


class LevellingBrush(FalloffBrush):
    """Moves the surface towards a plane or a line. The strength is that of a whole pass."""

    second = "STRENGTH"

    def options(self, sculpt, tool):
        strength = min(sculpt.strength * sculpt.pressure, 0.99)
        return {"strength": self.reach(sculpt, tool, strength), "amount": 0.0, "falloff": sculpt.falloff}
