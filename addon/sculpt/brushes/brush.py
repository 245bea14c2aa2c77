"""The base class of brushes. Knows no Blender."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import NamedTuple

from ...common.poses import moving


class Path(NamedTuple):
    """How samples of the pointer become poses."""

    axis: str  # NORMAL, VIEW, UP, TILT
    depth: float  # mm below the surface
    more: dict = {}  # for stroke_path.Settings, if different from the tool's defaults


class Brush(ABC):
    """The effect of a stroke on a sculpt. A subclass overrides what differs; its module lists its objects in BRUSHES,
    and all code that offers, draws, carves or records brushes reads the table of all of them (brushes/__init__.py).
    Strings in files: `id`, `journal`, `cuts`."""

    id = ""  # in the operators' modes (in capitals) and in scripts
    place = 0  # order in the toolbar and in lists, ascending
    label, description = "", ""  # of the mode
    tip = ""  # tooltip of its tool in the toolbar; "" for the opposite of another brush, which has no tool
    icon = ""  # icons/riffler.<icon>.dat; its tool is riffler.<icon>
    colour = (1.0, 1.0, 1.0)  # of the pointer
    opposite = ""  # id of the brush that Ctrl gives; "": the same
    first = "RADIUS"  # the setting of the key F: RADIUS or WIDTH
    second = "DEPTH"  # the setting next to it: DEPTH or STRENGTH

    journal = ""  # name of its strokes in a journal, from which riffler.Journal replays them
    cuts = ""  # kind of its moves among the sculpt's cuts, which become NC code: "remove", "add", or ""
    shapes = False  # changes the material by other operations than cuts
    paints = False  # changes the mask, not the material
    protects = False  # what it paints becomes protected
    puts_on = False  # adds material: from within, and the stock's box may clip it
    clear = False  # avoids fixtures
    chips = False  # the material resists, so there is a force
    session = False  # usable in a device's session
    hand = False  # works with the scene's hand tool, whose poses have a roll: (n, 9)
    keeps = False  # its strokes can be kept as curves
    falloff = False  # has a falloff; the cursor shows it instead of the cutter's shape
    drags = False  # follows the pointer in the plane of the view, not on the surface
    whole = False  # each move replaces the earlier ones: it is applied to the surface before the stroke

    done = "changed"  # "3 mm³ changed"
    no_stroke = "no stroke"  # reason why a session changed nothing
    unchanged = "The stroke changed nothing: what it met is protected, or there was nothing left to change"

    @property
    def tool(self) -> str:
        """Identifier of its tool in the toolbar, or ""."""
        return f"riffler.{self.icon}" if self.tip else ""

    def refusal(self, volume) -> str:
        """Why it cannot work on that volume, with the remedy, or ""."""
        return ""

    def idle(self, sculpt) -> bool:
        """Whether there is nothing that it could change."""
        return False

    def cutter(self, given, depth: float):
        """The riffler.Tool that it works with, for the chosen tool `given`."""
        return given

    def path(self, axis: str, depth: float, diameter: float, pitch: float) -> Path:
        """How it follows the surface, for the chosen `axis` and `depth`; mm."""
        return Path(axis, depth)

    def moves(self, poses, dt, new: bool):
        """The poses, (n, 6), that it applies, and the times between them; `new`: they do not continue the last ones."""
        return moving(poses, dt)

    def step(self, sculpt, tool, poses, new: bool) -> float:
        """Sculpt.step for these poses, of which `moves` may leave out some before `apply`."""
        return 0.0

    def options(self, sculpt, tool) -> dict:
        """The settings that the journal keeps with a stroke."""
        return {"strength": sculpt.strength}

    @abstractmethod
    def apply(self, sculpt, tool, poses, dt):
        """Changes the sculpt's volume or mask. Returns riffler.Cut, or None for a brush without chips."""

    def record(self, stroke, copy: int, tool, poses, new: bool) -> None:
        """Notes in a StrokeRecord what can be cut again; `copy`: index of the symmetric copy."""
        stroke.shaped |= self.shapes
        if self.cuts:
            stroke.cut(copy, tool, self.cuts, poses, new)

    def __str__(self) -> str:
        return self.id

    def picture(self, draw) -> list:
        """Its icon, drawn with the functions of tools/icons.py: the cutter on the surface."""
        return draw.cutter(draw.FLOOR)
