"""Random contours under cutter compensation, as NC code, and how far a path is from another one and from a contour."""

from __future__ import annotations

import itertools
import math
import random

import numpy as np

TURNS = [0, 0, 0, 0, 0, 0.4, -0.4, math.pi / 2, -math.pi / 2, 2.2, -2.2, 2.8, -2.8, math.pi]


class Contour:
    """``blocks``, and ``points``: by block those of its element, at most 0.01 mm apart; None where nothing moves in the
    plane. The first element begins at (0, 0) along +x."""

    def __init__(self, rng: random.Random, count: int, sharp: bool = True):
        self.rng, self.blocks = rng, []
        self.at, self.heading = np.zeros(2), 0.0
        self.points: list[np.ndarray | None] = []
        for _ in range(count):
            kind = rng.random()
            if kind < 0.12:
                self.add(f"G{rng.choice([0, 1])} Z{rng.uniform(-2, 2):.3f}")
            elif kind < 0.15:
                self.add(rng.choice(["F300", "G1", "G90 (again)", f"G1 {self.word(self.at)}"]))
            elif kind < 0.6:
                self.turn(sharp)
                self.line(rng.choice([0.001, 0.5, 2, 5, 9, 14]))
            else:
                self.turn(sharp)
                sense = rng.choice([1, -1])
                self.arc(rng.choice([0.5, 3.5, 5, 8, 12]), sense * rng.choice([0.2, 1, 1.6, math.pi, 4]))

    def add(self, block: str, points: np.ndarray | None = None) -> None:
        self.blocks.append(block)
        self.points.append(points)

    def turn(self, sharp: bool) -> None:
        self.heading += self.rng.choice(TURNS if sharp else TURNS[:5])

    def word(self, to: np.ndarray) -> str:
        return f"X{to[0]:.6f} Y{to[1]:.6f}"

    def height(self) -> str:
        return f" Z{self.rng.uniform(-2, 2):.3f}" if self.rng.random() < 0.2 else ""

    def line(self, length: float) -> None:
        to = self.at + length * np.array([math.cos(self.heading), math.sin(self.heading)])
        share = np.linspace(0, 1, max(2, int(length / 0.01)))[:, None]
        self.add(f"G{self.rng.choice([1, 1, 1, 0])} {self.word(to)}{self.height()}", self.at + share * (to - self.at))
        self.at = to

    def arc(self, radius: float, sweep: float) -> None:
        sense = math.copysign(1, sweep)
        start = self.heading - sense * math.pi / 2
        centre = self.at - radius * np.array([math.cos(start), math.sin(start)])
        angles = start + np.linspace(0, sweep, max(2, int(radius * abs(sweep) / 0.01)))
        round_points = centre + radius * np.array([np.cos(angles), np.sin(angles)]).T
        to = round_points[-1]
        offset = centre - self.at
        code = 3 if sense > 0 else 2
        words = f"{self.word(to)}{self.height()} I{offset[0]:.6f} J{offset[1]:.6f}"
        self.add(f"G{code} {words}", round_points)
        self.at, self.heading = to, self.heading + sweep

    FIRST_LINE = 5  # of the blocks, in the program

    def program(self, side: str, diameter: float) -> str:
        """From (-8, 0) to the first point at (0, 0), round the contour, and straight on out of it."""
        out = self.at + 8 * np.array([math.cos(self.heading), math.sin(self.heading)])
        head = ["G21 G90 G17 G94 F200", "G0 X-8 Y0 Z0", f"G{side}.1 D{diameter:.6f}", "G1 X0 Y0"]
        return "\n".join([*head, *self.blocks, "G40", f"G1 {self.word(out)}", "M2", ""])


def distance(points: np.ndarray, path: np.ndarray) -> np.ndarray:
    """(n,) of points to the polyline ``path``, in as many dimensions as both have."""
    a, along = path[:-1], np.diff(path, axis=0)
    square = np.maximum((along**2).sum(1), 1e-30)
    out = np.full(len(points), np.inf)
    for first in range(0, len(points), 500):
        some = points[first : first + 500]
        share = np.clip(((some[:, None] - a) * along).sum(2) / square, 0, 1)
        foot = a + share[:, :, None] * along
        out[first : first + 500] = np.sqrt(((some[:, None] - foot) ** 2).sum(2).min(1))
    return out


def dense(path: np.ndarray, step: float) -> np.ndarray:
    """Points of a polyline that are at most so far apart."""
    out = [path[:1]]
    for a, b in itertools.pairwise(path):
        parts = max(1, int(np.ceil(np.linalg.norm(b - a) / step)))
        out.append(a + np.linspace(0, 1, parts + 1)[1:, None] * (b - a))
    return np.concatenate(out)
