"""Removes material with the cutter."""

from .brush import Brush


class Carve(Brush):
    id, place, label, icon = "remove", 10, "Carve", "carve"
    description = "Remove material"
    tip = "Remove material with the cutter, along the surface (Ctrl: add, Shift: smooth)"
    colour = (1.0, 0.45, 0.2)
    opposite = "add"
    journal = cuts = "remove"
    clear = chips = session = keeps = True
    done = "removed"

    def apply(self, sculpt, tool, poses, dt):
        return sculpt.volume.carve(tool, poses, dt=dt, mode="remove", protect=sculpt.mask)

    def picture(self, draw):
        return draw.groove() + draw.cutter(draw.FLOOR - 34) + draw.chip()


BRUSHES = (Carve(),)
