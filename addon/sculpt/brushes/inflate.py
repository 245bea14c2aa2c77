"""Moves the surface along its own normals."""

from .falloff import FalloffBrush


class Inflate(FalloffBrush):
    id, place, label, icon = "inflate", 54, "Inflate", "inflate"
    description = "Inflate the surface along its normals"
    tip = "Inflate what is in the brush, along the surface's own normals (Ctrl: deflate, Shift: smooth)"
    colour = (0.45, 0.6, 1.0)
    opposite = "deflate"
    kind = "inflate"

    def picture(self, draw):
        return draw.blown() + draw.ring()


class Deflate(Inflate):
    id, place, label, icon, tip = "deflate", 55, "Deflate", "", ""
    description = "Deflate the surface along its normals"
    colour = (1.0, 0.55, 0.35)
    opposite = "inflate"
    sign = -1.0


BRUSHES = (Inflate(), Deflate())
