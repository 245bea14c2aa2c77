"""Flatten, scrape and fill: towards the mean plane of the surface in the brush."""

from .falloff import LevellingBrush


class Flatten(LevellingBrush):
    id, place, label, icon = "flatten", 58, "Flatten", "flatten"
    description = "Flatten the surface towards its mean plane"
    tip = "Flatten the surface towards its mean plane in the brush (Shift: smooth)"
    colour = (0.5, 0.85, 0.6)
    kind = "flatten"

    def picture(self, draw):
        return draw.levelled(above=True, below=True) + draw.ring()


class Scrape(LevellingBrush):
    id, place, label, icon = "scrape", 59, "Scrape", "scrape"
    description = "Remove what stands above the mean plane"
    tip = "Scrape off what stands above the mean plane in the brush (Ctrl: fill, Shift: smooth)"
    colour = (1.0, 0.6, 0.35)
    opposite = "fill"
    kind = "scrape"

    def picture(self, draw):
        return draw.levelled(above=True, below=False) + draw.ring()


class Fill(LevellingBrush):
    id, place, label, icon = "fill", 60, "Fill", "fill"
    description = "Fill what lies below the mean plane"
    tip = "Fill what lies below the mean plane in the brush (Ctrl: scrape, Shift: smooth)"
    colour = (0.35, 0.75, 0.95)
    opposite = "scrape"
    kind = "fill"

    def picture(self, draw):
        return draw.levelled(above=False, below=True) + draw.ring()


BRUSHES = (Flatten(), Scrape(), Fill())
