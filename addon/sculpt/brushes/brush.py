"""What a brush is. Knows no Blender."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import NamedTuple

from ...common.poses import moving


class Path(NamedTuple):
    """How samples of the hand become poses."""

    axis: str  # NORMAL, VIEW, UP, TILT
    depth: float  # mm below the surface
    more: dict = {}  # of stroke_path.Settings, where it differs from what suits the tool


class Brush(ABC):
    """What a stroke does to a sculpt. A subclass says what differs from this one; its module lists its objects in
    BRUSHES, and everything that offers, draws, carves or records brushes reads the table of them all
    (brushes/__init__.py). Strings in files: `id`, `journal`, `cuts`."""

    id = ""  # of the operators' modes (in capitals) and of scripts
    place = 0  # where it stands in the toolbar and in lists: the smallest first
    label, description = "", ""  # of the mode
    tip = ""  # of its tool in the toolbar; "" for the opposite of another brush, which has no tool
    icon = ""  # icons/riffler.<icon>.dat; its tool is riffler.<icon>
    colour = (1.0, 1.0, 1.0)  # of the pointer
    opposite = ""  # id of the brush that Ctrl gives; "": the same
    second = "DEPTH"  # the setting beside the radius: DEPTH or STRENGTH

    journal = ""  # the name of its strokes in a journal, by which riffler.Journal replays them
    cuts = ""  # what its moves are among the sculpt's cuts, which become NC code: "remove", "add", "" for none
    shapes = False  # it changes the material by other means than cuts
    paints = False  # it changes the mask, not the material
    protects = False  # what it paints is protected
    puts_on = False  # it puts material on: from within, and the stock's box may cut it off
    clear = False  # fixtures are in the cutter's way
    chips = False  # the material resists, so there is a force
    session = False  # a device's session can do it

    done = "changed"  # "3 mm³ changed"
    no_stroke = "no stroke"  # why a session changed nothing
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
        """The riffler.Tool that it works with, where `given` is chosen."""
        return given

    def path(self, axis: str, depth: float, diameter: float, pitch: float) -> Path:
        """How it follows the surface, where `axis` and `depth` are chosen; mm."""
        return Path(axis, depth)

    def moves(self, poses, dt, new: bool):
        """Which of the poses, (n, 6), it applies, and the times between them; `new`: they do not go on from the last
        ones."""
        return moving(poses, dt)

    @abstractmethod
    def apply(self, sculpt, tool, poses, dt):
        """Changes the sculpt's volume or mask. Returns riffler.Cut, or None where there is no chip."""

    def record(self, stroke, copy: int, tool, poses, new: bool) -> None:
        """Notes in a StrokeRecord what of it can be cut again; `copy`: of symmetry."""
        stroke.shaped |= self.shapes
        if self.cuts:
            stroke.cut(copy, tool, self.cuts, poses, new)

    def __str__(self) -> str:
        return self.id

    def picture(self, draw) -> list:
        """Its icon, drawn with the functions of tools/icons.py: the cutter on the surface."""
        return draw.cutter(draw.FLOOR)
