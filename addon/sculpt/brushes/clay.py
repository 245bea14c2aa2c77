"""Adds a layer with a soft edge, or digs one."""

from .falloff import FalloffBrush


class Clay(FalloffBrush):
    id, place, label, icon = "clay", 50, "Clay", "clay"
    description = "Add a layer with a soft edge"
    tip = "Add a layer of clay with a soft edge, along the surface (Ctrl: dig, Shift: smooth)"
    colour = (0.35, 0.7, 1.0)
    opposite = "dig"
    kind = "clay"
    done = "changed"

    def picture(self, draw):
        return draw.soft_bead() + draw.ring()


class Dig(Clay):
    place, label, icon, tip = 51, "Dig", "", ""
    id = "dig"
    description = "Remove a layer with a soft edge"
    colour = (1.0, 0.5, 0.25)
    opposite = "clay"
    sign = -1.0


BRUSHES = (Clay(), Dig())
