"""The map of free orientations at a point, as a clickable picture: cells, angles and pixels.

Tilts go to the right, inclinations upwards, as in riffler.plan.draw_map; a cell is centred on its angles. Pixels are in
the map's own frame, with its lower left corner at the origin.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...common import glyphs

# By the numbers of riffler.plan's FREE, BLOCKED, BEYOND, UNREACHABLE.
COLOURS = np.array([(0.22, 0.62, 0.36), (0.72, 0.24, 0.20), (0.24, 0.24, 0.26), (0.33, 0.33, 0.36)])
DEEP = 2.0  # mm: depth of a collision, or clearance, from which colours are darkest or lightest


@dataclass(frozen=True)
class Grid:
    """`inclinations` and `tilts`: evenly spaced, ascending, rad, two at least; `cell`: pixels across."""

    inclinations: tuple[float, ...]
    tilts: tuple[float, ...]
    cell: float

    @property
    def size(self) -> tuple[float, float]:
        return len(self.tilts) * self.cell, len(self.inclinations) * self.cell

    def cell_at(self, x: float, y: float) -> tuple[int, int] | None:
        """(row, column) of a pixel, or None outside the map."""
        column, row = int(np.floor(x / self.cell)), int(np.floor(y / self.cell))
        inside = 0 <= row < len(self.inclinations) and 0 <= column < len(self.tilts)
        return (row, column) if inside else None

    def angles_of(self, row: int, column: int) -> tuple[float, float]:
        return self.inclinations[row], self.tilts[column]

    def angles_at(self, x: float, y: float) -> tuple[float, float] | None:
        """The angles of the cell at a pixel."""
        cell = self.cell_at(x, y)
        return None if cell is None else self.angles_of(*cell)

    def place(self, inclination: float, tilt: float) -> tuple[float, float]:
        """The pixel of any angles, clamped to the map's edge."""
        out = []
        for angle, angles in ((tilt, self.tilts), (inclination, self.inclinations)):
            share = (angle - angles[0]) / (angles[-1] - angles[0]) * (len(angles) - 1) + 0.5
            out.append(float(np.clip(share, 0, len(angles))) * self.cell)
        return out[0], out[1]

    def triangles(self) -> np.ndarray:
        """(2 n, 3, 2): two for each cell, row by row."""
        rows, columns = len(self.inclinations), len(self.tilts)
        corner = np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), axis=-1).reshape(-1, 1, 1, 2) * self.cell
        return (corner + glyphs.box(0, 0, self.cell, self.cell)).reshape(-1, 3, 2)


def colours(state, clearance, old: bool = False) -> np.ndarray:
    """(rows, columns, 4): lighter with more clearance, darker with deeper collisions; grey if the map belongs to
    another place."""
    state = np.asarray(state)
    depth = np.nan_to_num(np.clip(np.asarray(clearance, float) / DEEP, -1, 1))
    out = np.ones((*state.shape, 4))
    out[..., :3] = COLOURS[state] * (0.85 + 0.35 * depth)[..., None]
    out[..., 3] = 0.9
    if old:
        grey = out[..., :3] @ (0.3, 0.59, 0.11)
        out[..., :3] = grey[..., None]
        out[..., 3] = 0.55
    return np.clip(out, 0, 1)
