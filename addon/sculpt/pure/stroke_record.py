"""A stroke while it is made: what it began on, what it has cut, and where it has been."""

from __future__ import annotations

from dataclasses import dataclass, field
from uuid import uuid4

import numpy as np

from ...common.contents import Content
from ...common.job import Cut

Extent = tuple[np.ndarray, np.ndarray]  # lower and upper corner, in rays


@dataclass
class Moves:
    """Poses that go on from each other, of one tool; `copy`: of symmetry, 0 for the hand's own."""

    copy: int
    tool: dict
    mode: str  # of common.job.Cut
    pieces: list[np.ndarray]  # (n, 6)


@dataclass
class StrokeRecord:
    """Of a live sculpt; a brush notes in it what it does (Brush.record)."""

    begin: Content  # the state that it began on; nobody changes it
    token: str = field(default_factory=lambda: uuid4().hex)  # of the state that it makes
    moves: list[Moves] = field(default_factory=list)
    shaped: bool = False  # it has changed the material by other means than cuts
    swept: list[Extent] = field(default_factory=list)  # what tools may have touched of the material
    painted: list[Extent] = field(default_factory=list)  # and of the mask
    apart: set[int] = field(default_factory=set)  # copies whose last moves were kept out

    def cut(self, copy: int, tool, mode: str, poses: np.ndarray, new: bool) -> None:
        """`new`: the poses do not go on from the last ones of that copy."""
        if not new:
            for moves in reversed(self.moves):
                if moves.copy == copy and moves.mode == mode:
                    moves.pieces.append(poses[1:])
                    return
        self.moves.append(Moves(copy, tool.to_dict(), mode, [poses]))

    def cuts(self, masked: bool) -> list[Cut]:
        """`masked`: the sculpt has a mask, beside which they were made."""
        return [Cut(m.tool, np.vstack(m.pieces), mode=m.mode, masked=masked) for m in self.moves]
