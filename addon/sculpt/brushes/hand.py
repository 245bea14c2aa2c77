"""Removes material with a hand tool: a blade with an edge, which a stroke pushes ahead."""

from .brush import Brush, Path


class HandTool(Brush):
    id, place, label, icon = "hand", 45, "Hand Tool", "hand_tool"
    description = "Cut with a gouge, a V-tool, a chisel or a knife"
    tip = "Cut with a gouge, a V-tool, a chisel or a knife, pushed along the stroke (Shift: smooth)"
    colour = (0.95, 0.8, 0.35)
    first = "WIDTH"
    journal = "remove"
    shapes = chips = hand = keeps = True  # no machine makes such cuts, so they are not among the sculpt's
    done = "removed"

    def path(self, axis, depth, diameter, pitch):
        """The deepest point of the blade follows the surface (pure/roll.py)."""
        return Path(axis, depth)

    def apply(self, sculpt, tool, poses, dt):
        return sculpt.volume.carve(tool, poses, dt=dt, mode="remove", protect=sculpt.mask)

    def picture(self, draw):
        return draw.gouge()


BRUSHES = (HandTool(),)
