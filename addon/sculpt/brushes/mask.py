"""Protects the volume that the cutter sweeps from all other brushes, or unprotects it."""

import riffler

from .brush import Brush


class Mask(Brush):
    id, place, label, icon = "mask", 40, "Mask", "mask"
    description = "Protect what the tool sweeps"
    tip = "Protect what the cutter sweeps from all other tools (Ctrl: remove the protection)"
    colour = (0.85, 0.85, 0.85)
    opposite = "unmask"
    journal = "mask"
    paints = protects = True
    done = "protected"

    def apply(self, sculpt, tool, poses, dt):
        if sculpt.mask is None:
            v = sculpt.volume
            sculpt.mask = riffler.Volume.empty(v.lower, v.upper, v.pitch, v.directions)
        return sculpt.mask.carve(tool, poses, dt=dt, mode="add")

    def picture(self, draw):
        return draw.kept() + draw.cutter(draw.FLOOR + 10)


class Unmask(Brush):
    id, place, label = "unmask", 41, "Unmask"
    description = "Remove the protection"
    colour = (0.6, 0.6, 0.6)
    opposite = "mask"
    journal = "unmask"
    paints = True
    done = "unprotected"

    def idle(self, sculpt):
        return sculpt.mask is None

    def apply(self, sculpt, tool, poses, dt):
        return sculpt.mask.carve(tool, poses, dt=dt, mode="remove")


BRUSHES = (Mask(), Unmask())
