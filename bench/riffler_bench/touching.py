"""Cutters in closed form: how far from a plane, a point or a line, to judge where they touch planes, balls and rods."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin, tan

import numpy as np
from riffler import Tool


@dataclass(frozen=True)
class Shape:
    """A cutter as the union of level discs (radius, height) thickened by a radius, and of what an outline of straight
    lines (radius, height) encloses with the axis; all of it within its convex hull's support."""

    tool: Tool
    discs: tuple[tuple[float, float, float], ...]
    outline: tuple[tuple[float, float], ...]

    def support(self, across: np.ndarray, along: np.ndarray) -> np.ndarray:
        """The most of across · radius + along · height; (across, along) of length 1, across ≥ 0."""
        corners = [across * r + along * z for r, z in self.outline]
        rounds = [across * e + along * z + r for e, z, r in self.discs]
        return np.max(corners + rounds, axis=0)

    def distance(self, points: np.ndarray, poses: np.ndarray) -> np.ndarray:
        """From points (…, 3) outside of the cutter at poses (…, 6)."""
        d = points - poses[..., :3]
        z = (d * poses[..., 3:]).sum(-1)
        rho = np.linalg.norm(d - z[..., None] * poses[..., 3:], axis=-1)
        rounds = [np.hypot(np.maximum(rho - e, 0), z - height) - r for e, height, r in self.discs]
        lines = []
        for a, b in zip(self.outline[:-1], self.outline[1:], strict=True):
            way = np.subtract(b, a)
            share = (((rho - a[0]) * way[0] + (z - a[1]) * way[1]) / (way @ way)).clip(0, 1)
            lines.append(np.hypot(rho - a[0] - share * way[0], z - a[1] - share * way[1]))
        return np.min(rounds + lines, axis=0)


def shapes() -> dict[str, Shape]:
    """One of every named cutter, and a free profile with a waist."""
    taper, cone = 0.2, (1.0, 1.0, 0.4)
    start = (0.5 * cos(taper), 0.5 * (1 - sin(taper)))  # where the tip's ball ends
    end = start[1] + (4 - start[0]) / tan(taper)
    flat_end = (4 - 0.5) / tan(taper)
    step = cone[1] * tan(cone[0])
    rim = cone[1] + (4 - step) / tan(cone[2])
    waist = [(1.5, 0), (3, 1.5, 1.5, 1.5), (2, 6), (4, 8)]
    return {
        "ball Ø6": Shape(Tool.ball(6, 30), ((0, 3, 3),), ((3, 3), (3, 30))),
        "flat Ø6": Shape(Tool.flat(6, 30), (), ((0, 0), (3, 0), (3, 30))),
        "fillet Ø8 r1": Shape(Tool.fillet(8, 1, 30), ((3, 1, 1),), ((4, 1), (4, 30))),
        "taper r0.5 Ø8": Shape(Tool.taper(0.5, taper, 8, 40), ((0, 0.5, 0.5),), (start, (4, end), (4, 40))),
        "taper, flat tip Ø8": Shape(
            Tool.taper(0.5, taper, 8, 40, flat_tip=True), (), ((0, 0), (0.5, 0), (4, flat_end), (4, 40))
        ),
        "cone end Ø8": Shape(Tool.cone_end(*cone, 8, 40), (), ((0, 0), (step, cone[1]), (4, rim), (4, 40))),
        "free profile with a waist": Shape(
            Tool.profile(waist, 30), ((1.5, 1.5, 1.5),), ((3, 1.5), (2, 6), (4, 8), (4, 30))
        ),
    }
