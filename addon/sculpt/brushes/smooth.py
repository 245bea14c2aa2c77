"""Smooths the surface by dabs at the cutter's tip, as wide as the cutter."""

from .brush import Brush, Path

DABS = 1 / 6  # share of the tool's width between two dabs


class Smooth(Brush):
    id, place, label, icon = "soften", 30, "Smooth", "smooth"
    description = "Smooth the surface"
    tip = "Smooth the surface as wide as the cutter"
    colour = (0.55, 0.9, 0.45)
    second = "STRENGTH"
    journal = "soften"
    shapes = clear = True

    def refusal(self, volume):
        if volume.directions == "xyz":
            return ""
        return (
            "Smooth needs rays in three directions: use Change Pitch in Clay, and set Rays to Three "
            "(Tri-Dexel) in the box at the lower left"
        )

    def path(self, axis, depth, diameter, pitch):
        """A dab's centre is the tip, on the surface."""
        return Path("NORMAL", 0.0, {"spacing": max(pitch, DABS * diameter)})

    def moves(self, poses, dt, new):
        """The first pose of a continued move was already dabbed with the last ones."""
        return poses[0 if new else 1 :], None

    def apply(self, sculpt, tool, poses, dt):
        sculpt.volume.smooth(poses[:, :3], 0.5 * tool.diameter, strength=sculpt.strength, protect=sculpt.mask)

    def picture(self, draw):
        return draw.wave() + draw.cutter(draw.FLOOR + 4)


SMOOTH = Smooth()  # the brush that Shift selects with every tool
BRUSHES = (SMOOTH,)
