"""A stroke in progress: its initial state, its cuts, and the regions it has touched."""

from __future__ import annotations

from dataclasses import dataclass, field
from uuid import uuid4

import numpy as np

from ...common.contents import Content
from ...common.job import Cut

Extent = tuple[np.ndarray, np.ndarray]  # lower and upper corner, in rays


@dataclass
class Moves:
    """Successive poses of one tool; `copy`: index of the symmetric copy, 0 for the original."""

    copy: int
    tool: dict
    mode: str  # of common.job.Cut
    pieces: list[np.ndarray]  # (n, 6)


@dataclass
class StrokeRecord:
    """Record of a live sculpt's stroke, filled by its brush (Brush.record)."""

    begin: Content  # the initial state, which nothing changes any more
    token: str = field(default_factory=lambda: uuid4().hex)  # of the resulting state
    moves: list[Moves] = field(default_factory=list)
    shaped: bool = False  # other operations than cuts have changed the material
    painted: list[Extent] = field(default_factory=list)  # regions of the mask that tools may have touched
    apart: set[int] = field(default_factory=set)  # copies whose last moves were kept out

    def cut(self, copy: int, tool, mode: str, poses: np.ndarray, new: bool) -> None:
        """`new`: the poses do not continue the last ones of that copy."""
        if not new:
            for moves in reversed(self.moves):
                if moves.copy == copy and moves.mode == mode:
                    moves.pieces.append(poses[1:])
                    return
        self.moves.append(Moves(copy, tool.to_dict(), mode, [poses]))

    def cuts(self, masked: bool) -> list[Cut]:
        """`masked`: the sculpt has a mask, which limited the cuts."""
        return [Cut(m.tool, np.vstack(m.pieces), mode=m.mode, masked=masked) for m in self.moves]
