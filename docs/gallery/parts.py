"""The parts of the gallery, lofted from curves in closed form: a mouse-like one and a sole-like one.

Their valleys are edges of the loft, so the parts are exact there; elsewhere facets stay within a few hundredths of mm.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from riffler import Mesh, Volume

Ring = np.ndarray  # (n, 3), counter-clockwise seen from above


def loft(rings: list[Ring]) -> Mesh:
    """A closed solid: each ring joined to the next, the first closed below and the last above by fans."""
    n = len(rings[0])
    vertices = np.concatenate([*rings, [rings[0].mean(0)], [rings[-1].mean(0)]])
    here = np.arange(n)
    after = (here + 1) % n
    triangles = []
    for k in range(len(rings) - 1):
        a, b, c, d = k * n + here, k * n + after, (k + 1) * n + after, (k + 1) * n + here
        triangles += [np.column_stack([a, b, c]), np.column_stack([a, c, d])]
    below, above, last = len(rings) * n, len(rings) * n + 1, (len(rings) - 1) * n
    triangles += [
        np.column_stack([after, here, np.full(n, below)]),
        np.column_stack([last + here, last + after, np.full(n, above)]),
    ]
    return Mesh(vertices, np.concatenate(triangles))


def between(first: Ring, last: Ring, steps: int) -> list[Ring]:
    """Rings between the first and the last, without the first."""
    return [first + (last - first) * t for t in np.linspace(0, 1, steps + 1)[1:]]


def inwards(ring: Ring, distance: float) -> Ring:
    """Moved to the left of its direction, in the plane."""
    way = np.roll(ring, -1, 0) - np.roll(ring, 1, 0)
    way /= np.linalg.norm(way[:, :2], axis=1)[:, None]
    return ring + distance * np.column_stack([-way[:, 1], way[:, 0], np.zeros(len(ring))])


def at_height(ring: Ring, height: Callable[[np.ndarray, np.ndarray], np.ndarray] | float) -> Ring:
    z = height(ring[:, 0], ring[:, 1]) if callable(height) else np.full(len(ring), float(height))
    return np.column_stack([ring[:, :2], z])


def evenly(curve: Callable[[np.ndarray], np.ndarray], n: int) -> Ring:
    """n points at equal distances along a closed plane curve given over [0, 2π)."""
    dense = curve(np.linspace(0, 2 * np.pi, 64 * n + 1))
    way = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(dense, axis=0), axis=1))])
    at = np.linspace(0, way[-1], n, endpoint=False)
    return np.column_stack([np.interp(at, way, dense[:, 0]), np.interp(at, way, dense[:, 1]), np.zeros(n)])


def superellipse(a: float, b: float, power: float) -> Callable[[np.ndarray], np.ndarray]:
    def curve(t: np.ndarray) -> np.ndarray:
        c, s = np.cos(t), np.sin(t)
        return np.column_stack([a * np.sign(c) * abs(c) ** (2 / power), b * np.sign(s) * abs(s) ** (2 / power)])

    return curve


def mouse(points: int = 480) -> Mesh:
    """A body with leaning walls on a plate, and on its rising shoulder a second, domed step: two valleys, both loops.

    110 × 66 × 12 mm of plate, 40 mm high.
    """
    outline = evenly(superellipse(42, 23, 2.6), points)

    def shoulder(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return 11 + 4.5 * np.sin((x + 10) / 32) - 0.003 * y**2

    def dome(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return shoulder(x, y) + 7 + 5.5 * (1 - (x / 33) ** 2 - (y / 15) ** 2)

    plate = evenly(superellipse(55, 33, 5), points)
    edge = at_height(inwards(outline, 1.6), shoulder)
    foot = at_height(inwards(outline, 7.0), shoulder)
    brow = at_height(inwards(outline, 8.0), dome)
    rings = [at_height(plate, -12)]
    rings += between(rings[-1], at_height(plate, 0), 4)
    rings += between(rings[-1], at_height(outline, 0), 8)
    rings += between(rings[-1], edge, 10)
    rings += [at_height(r, shoulder) for r in between(edge, foot, 6)]
    rings += between(rings[-1], brow, 8)
    for t in np.linspace(1, 0, 28)[1:-1]:
        rings.append(at_height(brow * [t, t, 1], dome))
    return loft(rings)


def foot_outline(t: np.ndarray) -> np.ndarray:
    """Two arcs, of heel and toe, and a cubic on either side between them, the inner one with more of a waist."""
    toe, heel = np.array([42.0, 1.5]), np.array([-52.0, 0.0])
    ball = np.linspace(-1.45, 1.45, 200)
    heel_turn = np.linspace(np.pi - 1.45, np.pi + 1.45, 200)
    front = toe + 26 * np.column_stack([np.cos(ball), np.sin(ball)])
    back = heel + 21 * np.column_stack([np.cos(heel_turn), np.sin(heel_turn)])

    def side(start: np.ndarray, leave: float, end: np.ndarray, arrive: float, waist: float) -> np.ndarray:
        s = np.linspace(0, 1, 200)[1:-1, None]
        pull = 0.4 * np.linalg.norm(end - start)
        first = start + pull * np.array([np.cos(leave), np.sin(leave)])
        second = end - pull * np.array([np.cos(arrive), np.sin(arrive)])
        middle = np.array([0, waist]) * np.exp(-(((s - 0.55) / 0.2) ** 2)) * (s * (1 - s) * 4) ** 2
        return (1 - s) ** 3 * start + 3 * s * (1 - s) ** 2 * first + 3 * s**2 * (1 - s) * second + s**3 * end + middle

    right_angle = np.pi / 2
    upper = side(front[-1], ball[-1] + right_angle, back[0], heel_turn[0] + right_angle, -1.5)
    lower = side(back[-1], heel_turn[-1] + right_angle, front[0], ball[0] + right_angle, 4.0)
    outline = np.concatenate([front, upper, back, lower, front[:1]])
    at = np.linspace(0, 2 * np.pi, len(outline))
    return np.column_stack([np.interp(t, at, outline[:, 0]), np.interp(t, at, outline[:, 1])])


def sole(points: int = 640) -> Mesh:
    """A cup on a welt: a valley outside, between wall and welt, and one inside, between rim and the curved floor."""
    outline = evenly(foot_outline, points)

    def floor(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return 9 + 3.0 * np.cos(x / 30) * np.exp(-(((x + 8) / 46) ** 2)) - 0.0035 * y**2

    def rim(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return 17 + 3.0 * (x / 70) ** 2

    welt = inwards(outline, -7)
    rings = [at_height(welt, -6)]
    rings += between(rings[-1], at_height(welt, 0), 3)
    rings += between(rings[-1], at_height(outline, 0), 6)
    rings += between(rings[-1], at_height(inwards(outline, 1.5), rim), 10)
    rings += between(rings[-1], at_height(inwards(outline, 4.5), rim), 3)
    corner = inwards(outline, 6.0)
    rings += between(rings[-1], at_height(corner, floor), 8)
    for t in np.linspace(1, 0, 28)[1:-1]:
        rings.append(at_height(corner * [t, t, 1], floor))
    return loft(rings)


def vise(room: float = 0.0) -> list[Volume]:
    """For the mouse: two jaws at the plate's long sides and two clamps on its short ones, as dexels 1 mm apart, each
    `room` mm larger."""
    boxes = [
        ((-40, 33, -30), (40, 52, 16)),
        ((-40, -52, -30), (40, -33, 16)),
        ((50, -9, 0), (75, 9, 10)),
        ((-75, -9, 0), (-50, 9, 10)),
    ]
    return [Volume.block(np.subtract(low, room), np.add(high, room), 1.0) for low, high in boxes]
