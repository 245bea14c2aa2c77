"""Pinch, crease and twist."""

from .falloff import FalloffBrush, LevellingBrush


class Pinch(LevellingBrush):
    id, place, label, icon = "pinch", 68, "Pinch", "pinch"
    description = "Pull the surface together"
    tip = "Pull the surface together towards the middle of the brush (Shift: smooth)"
    colour = (0.85, 0.55, 0.9)
    kind = "pinch"

    def picture(self, draw):
        return draw.ridge(46) + draw.ring()


class Crease(FalloffBrush):
    id, place, label, icon = "crease", 69, "Crease", "crease"
    description = "Make a sharp furrow"
    tip = "Make a sharp furrow, pulling its sides together (Ctrl: a ridge, Shift: smooth)"
    colour = (1.0, 0.5, 0.6)
    opposite = "ridge"
    kind = "crease"
    sign = -1.0

    def options(self, sculpt, tool):
        pinch = self.reach(sculpt, tool, 0.5)
        height = self.sign * self.height(sculpt, tool, power=2)
        amount = height / pinch if pinch > 0 else 0.0  # the strength is a factor of it
        return {"strength": pinch, "amount": amount, "falloff": sculpt.falloff}

    def picture(self, draw):
        return draw.ridge(-46) + draw.ring()


class Ridge(Crease):
    id, place, label, icon, tip = "ridge", 70, "Ridge", "", ""
    description = "Make a sharp ridge"
    colour = (0.6, 0.55, 1.0)
    opposite = "crease"
    sign = 1.0


BRUSHES = (Pinch(), Crease(), Ridge())
