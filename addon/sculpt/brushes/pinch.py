"""Pinch, crease and twist."""

import math

from .falloff import FalloffBrush, LevellingBrush, share

WHOLE = math.pi / 2  # rad that a pass of full strength turns the middle of the brush


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


class Twist(FalloffBrush):
    id, place, label, icon = "twist", 72, "Twist", "twist"
    description = "Turn the surface counter-clockwise about its normal"
    tip = "Turn the surface counter-clockwise in the brush (Ctrl: clockwise, Shift: smooth)"
    colour = (0.75, 0.8, 0.4)
    opposite = "untwist"
    second = "STRENGTH"
    kind = "twist"

    def options(self, sculpt, tool):
        strength = sculpt.strength * sculpt.pressure
        angle = self.sign * WHOLE * strength * sculpt.step / (tool.diameter * share(sculpt.falloff))
        return {"strength": 1.0, "amount": angle, "falloff": sculpt.falloff}

    def picture(self, draw):
        return draw.whirl() + draw.ring()


class Untwist(Twist):
    place, label, icon, tip = 73, "Untwist", "", ""
    id = "untwist"
    description = "Turn the surface clockwise about its normal"
    colour = (0.5, 0.8, 0.75)
    opposite = "twist"
    sign = -1.0


BRUSHES = (Pinch(), Crease(), Ridge(), Twist(), Untwist())
