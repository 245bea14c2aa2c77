"""Adds material in the shape of the cutter."""

import riffler

from ..pure.reach import outline_of
from .brush import Brush


def stub(tool, depth: float):
    """The end of the cutter only: the whole cutter would make a pillar of its full length."""
    line = outline_of(tool)
    widest = line[line[:, 0] >= line[:, 0].max() * (1 - 1e-9), 1].min()
    data = tool.to_dict()
    shorter = {k: v for k, v in data.items() if k not in ("shank", "holder")}
    shorter["length"] = min(tool.length, max(float(widest), depth, 0.05 * tool.diameter))
    return riffler.Tool.from_dict(shorter)


class Add(Brush):
    id, place, label, icon = "add", 20, "Add", "add"
    description = "Add material"
    tip = "Add material in the shape of the cutter (Ctrl: remove, Shift: smooth)"
    colour = (0.3, 0.65, 1.0)
    opposite = "remove"
    journal = cuts = "add"
    puts_on = chips = session = keeps = True
    done = "added"
    no_stroke = "no stroke where the stock's box has room; use Grow Box in Clay to enlarge it"
    unchanged = "Nothing was added: the stock's box is full there, or protected. Use Grow Box in Clay to enlarge it"

    def cutter(self, given, depth):
        return stub(given, depth)

    def apply(self, sculpt, tool, poses, dt):
        return sculpt.volume.carve(tool, poses, dt=dt, mode="add", protect=sculpt.mask)

    def picture(self, draw):
        return draw.bead() + draw.cutter(draw.FLOOR + 24)


BRUSHES = (Add(),)
