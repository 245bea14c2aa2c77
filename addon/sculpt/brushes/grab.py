"""Grab and snake hook: the surface follows the pointer, in the plane of the view."""

import numpy as np

from .falloff import FalloffBrush, Path


class Pulls(FalloffBrush):
    second = "STRENGTH"
    drags = True

    def moves(self, poses, dt, new):
        """No move while the pointer stands still."""
        return poses if np.ptp(poses[:, :3], axis=0).any() else poses[:0], None

    def options(self, sculpt, tool):
        return {"strength": sculpt.strength, "amount": 0.0, "falloff": sculpt.falloff}


class Grab(Pulls):
    id, place, label, icon = "grab", 64, "Grab", "grab"
    description = "Drag the surface along with the pointer"
    tip = "Grab the surface under the brush and drag it with the pointer (Shift: smooth)"
    colour = (0.95, 0.75, 0.35)
    kind = "grab"
    whole = True

    def path(self, axis, depth, diameter, pitch):
        return Path("NORMAL", 0.0)

    def picture(self, draw):
        return draw.pulled(60) + draw.ring(draw.FLOOR + 60)


class SnakeHook(Pulls):
    id, place, label, icon = "snake_hook", 65, "Snake Hook", "snake_hook"
    description = "Pull the surface out along the pointer's path"
    tip = "Pull the surface out along the pointer's path, like a hook (Shift: smooth)"
    colour = (0.9, 0.65, 0.45)
    kind = "snake_hook"

    def picture(self, draw):
        return draw.pulled(96, lean=44) + draw.ring(draw.FLOOR + 60)


BRUSHES = (Grab(), SnakeHook())
