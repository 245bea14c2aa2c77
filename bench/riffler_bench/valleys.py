"""Parts whose pencil curves are known in closed form: where a ball of radius R touches a part at two places at once.

Each part stands upright about the origin; the job turns it. Its curves end where a contact leaves the part's faces, or
where the ball meets a third one.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass, field
from math import cos, pi, radians, sin, tan

import numpy as np

from .remesh import Patch, Surface

R = 3.0  # of the ball
HALF = 15.0  # half a bar's length
WALL = 9.0  # how far a groove's walls reach from its bottom
QUARTER = 16  # least rows on a blend: creases between them are a third of the ball's least valley
ROUND = 64  # least rows around a cylinder, for the same reason


@dataclass(frozen=True)
class Curve:
    """Centres (n, 3) and contacts (n, 2, 3); straight curves have two points, others so many that their chords are
    within 1e-6 mm."""

    centres: np.ndarray
    contacts: np.ndarray
    closed: bool = False

    def placed(self, turn: np.ndarray, shift: np.ndarray) -> Curve:
        return Curve(self.centres @ turn.T + shift, self.contacts @ turn.T + shift, self.closed)


@dataclass(frozen=True)
class Part:
    """`bent`: the radius of the cylinder that the ball touches, whose chords move the centres by up to `lever` times
    their sagitta; 0 where it touches planes alone."""

    name: str
    surface: Surface
    curves: list[Curve] = field(default_factory=list)
    bent: float = 0.0
    lever: float = 1.0
    view: tuple[float, float] = (32, -62)  # elevation and azimuth of its picture, degrees


# ---- bars: a section in (x, z), drawn along y


def bar(pieces: list[tuple[Callable[[np.ndarray], np.ndarray], Patch]]) -> Surface:
    """Pieces of a section, each from a share in [0, 1] to (x, z)."""

    def at(s: np.ndarray, t: np.ndarray) -> np.ndarray:
        which = np.minimum(s.astype(int), len(pieces) - 1)
        out = np.empty((*s.shape, 3))
        out[..., 1] = HALF * (2 * t - 1)
        for k, (piece, _) in enumerate(pieces):
            here = which == k
            out[here] = np.insert(piece(s[here] - k), 1, out[here][:, 1], axis=1)
        return out

    return Surface(at, [patch for _, patch in pieces], [Patch(2 * HALF, 3)], ring=False)


def line(a: np.ndarray, b: np.ndarray) -> tuple[Callable[[np.ndarray], np.ndarray], Patch]:
    return lambda u: (1 - u)[:, None] * a + u[:, None] * b, Patch(float(np.linalg.norm(b - a)))


def arc(middle: np.ndarray, radius: float, begin: float, end: float):
    """From one angle to another, in (x, z)."""
    rows = max(2, round(QUARTER * abs(end - begin) / (pi / 2)))
    return (
        lambda u: middle + radius * np.stack([np.cos(begin + u * (end - begin)), np.sin(begin + u * (end - begin))], 1),
        Patch(radius * abs(end - begin), rows),
    )


def polygon(*corners: tuple[float, float]) -> list:
    at = [np.array(c, float) for c in corners]
    return [line(a, b) for a, b in zip(at, at[1:] + at[:1], strict=True)]


def along(centre: tuple[float, float], *contacts: tuple[float, float]) -> Curve:
    """A straight curve from end to end of a bar, from (x, z)."""
    ends = np.array([-HALF, HALF])

    def drawn(p: tuple[float, float]) -> np.ndarray:
        return np.stack([np.full(2, p[0]), ends, np.full(2, p[1])], 1)

    return Curve(drawn(centre), np.stack([drawn(c) for c in contacts], 1))


def valley(angle: float) -> Curve:
    """The valley of two planes that meet at the origin, alike on both sides."""
    half = radians(angle) / 2
    foot = R / tan(half)
    return along((0, R / sin(half)), *((side * foot * sin(half), foot * cos(half)) for side in (-1, 1)))


def groove(angle: float, blend: float = 0.0, found: bool = True) -> Part:
    half = radians(angle) / 2
    rim = np.array([WALL * sin(half), WALL * cos(half)])
    outer = [(rim[0] + 4, rim[1]), (rim[0] + 4, -5), (-rim[0] - 4, -5), (-rim[0] - 4, rim[1]), (-rim[0], rim[1])]
    if blend:
        start = blend / tan(half) / WALL * rim
        middle = np.array([0, blend / sin(half)])
        bottom = [
            line(rim * [-1, 1], start * [-1, 1]),
            arc(middle, blend, pi + half, 2 * pi - half),
            line(start, rim),
        ]
        name = f"{angle}° groove, blend {blend / R:g} R"
    else:
        bottom = [line(rim * [-1, 1], np.zeros(2)), line(np.zeros(2), rim)]
        name = f"{angle}° groove"
    corners = [rim, *(np.array(c, float) for c in outer)]
    section = bottom + [line(a, b) for a, b in itertools.pairwise(corners)]
    return Part(name, bar(section), [valley(angle)] if found else [])


def slot() -> Part:
    """A T-slot: floor, walls and a ceiling that hangs over."""
    right = [(10, 0), (10, 8), (4, 8), (4, 11), (14, 11), (14, -4)]
    section = polygon(*right, *((-x, z) for x, z in reversed(right)))
    curves = [along((s * 7, z), (s * 7, floor), (s * 10, z)) for s in (-1, 1) for z, floor in ((R, 0), (8 - R, 8))]
    return Part("T-slot", bar(section), curves, view=(12, -74))


def dovetail() -> Part:
    top = 12 - 8 / tan(radians(60))
    right = [(12, 0), (top, 8), (16, 8), (16, -4)]
    section = polygon(*right, *((-x, z) for x, z in reversed(right)))
    foot = R / tan(radians(30))
    curves = [
        along((s * (12 - foot), R), (s * (12 - foot), 0), (s * (12 - foot / 2), foot * sin(radians(60))))
        for s in (-1, 1)
    ]
    return Part("dovetail, 60°", bar(section), curves, view=(14, -72))


# ---- rings: rows from a pole to another one, around z


def ring(rows: list[Callable[[np.ndarray], np.ndarray]], lengths: list[float], around: list[Patch]) -> Surface:
    """Rows are closed lines, each from t to points; straight between them."""

    def at(s: np.ndarray, t: np.ndarray) -> np.ndarray:
        t = np.where(t == len(around), 0, t)
        which = np.minimum(s.astype(int), len(rows) - 2)
        out = np.empty((*s.shape, 3))
        for k in range(len(rows) - 1):
            here = which == k
            u = (s[here] - k)[:, None]
            out[here] = (1 - u) * rows[k](t[here]) + u * rows[k + 1](t[here])
        return out

    return Surface(at, [Patch(length) for length in lengths], around, ring=True)


def circle(radius: float, z: float, slope: float = 0.0) -> Callable[[np.ndarray], np.ndarray]:
    """Seen from above; on a plane that rises with x. A pole has radius 0."""

    def at(t: np.ndarray) -> np.ndarray:
        x, y = radius * np.cos(2 * pi * t), radius * np.sin(2 * pi * t)
        return np.stack([x, y, z + slope * x], -1)

    return at


def rounds(rows: list[Callable[[np.ndarray], np.ndarray]], lengths: list[float]) -> Surface:
    return ring(rows, lengths, [Patch(2 * pi * 16, ROUND)])


def on_slope(radius: float, wall: float, slope: float) -> Curve:
    """The ball that touches a cylinder of radius `wall` about z, and a plane that rises with x; its centre is `radius`
    from the cylinder's axis."""
    t = 2 * pi * np.arange(6000) / 6000
    x, y = np.cos(t), np.sin(t)
    normal = np.array([-slope, 0, 1]) / np.hypot(slope, 1)
    centres = np.stack([radius * x, radius * y, slope * radius * x + R * np.hypot(slope, 1)], 1)
    beside = np.stack([wall * x, wall * y, centres[:, 2]], 1)
    return Curve(centres, np.stack([centres - R * normal, beside], 1), closed=True)


def boss(tilt: float) -> Part:
    slope, wall = tan(radians(tilt)), 5.0
    rows = [
        circle(0, 15),
        circle(wall, 15),
        circle(wall, 0, slope),
        circle(16, 0, slope),
        circle(16, -12),
        circle(0, -12),
    ]
    name = "boss on a plate" if tilt == 0 else f"boss on a slope of {tilt}°"
    surface = rounds(rows, [wall, 15, 11, 12, 16])
    return Part(name, surface, [on_slope(wall + R, wall, slope)], bent=wall, lever=1 / cos(radians(tilt)))


def hole(tilt: float) -> Part:
    slope, wall = tan(radians(tilt)), 8.0
    rows = [
        circle(0, 0, slope),
        circle(wall, 0, slope),
        circle(wall, 12),
        circle(14, 12),
        circle(14, -8),
        circle(0, -8),
    ]
    name = "blind hole" if tilt == 0 else f"blind hole, floor at {tilt}°"
    surface = rounds(rows, [wall, 12, 6, 20, 14])
    return Part(
        name, surface, [on_slope(wall - R, wall, slope)], bent=wall, lever=1 / cos(radians(tilt)), view=(58, -62)
    )


def loop(corners: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
    """A polygon's border: corner k at t = k."""

    def at(t: np.ndarray) -> np.ndarray:
        k = np.minimum(t.astype(int), len(corners) - 1)
        u = (t - k)[..., None]
        return (1 - u) * corners[k] + u * corners[(k + 1) % len(corners)]

    return at


def rectangle(x: float, y: float, z: float) -> Callable[[np.ndarray], np.ndarray]:
    return loop(np.array([[x, y, z], [-x, y, z], [-x, -y, z], [x, -y, z]], float))


def point(z: float) -> Callable[[np.ndarray], np.ndarray]:
    return lambda t: np.broadcast_to([0.0, 0.0, z], (*t.shape, 3))


def touching(centres: list[list[float]], *ways: np.ndarray) -> Curve:
    """Straight, with both contacts the same ways from the centre everywhere."""
    return Curve(np.array(centres), np.stack([np.array(centres) + way for way in ways], 1))


def pocket() -> Part:
    """Floor and four walls: eight valleys that meet by threes at four places."""
    x, y, top = 10.0, 8.0, 9.0
    rows = [
        point(0),
        rectangle(x, y, 0),
        rectangle(x, y, top),
        rectangle(15, 13, top),
        rectangle(15, 13, -5),
        point(-5),
    ]
    surface = ring(rows, [9, top, 5, 14, 14], [Patch(2 * x, 2), Patch(2 * y, 2)] * 2)
    u, v = x - R, y - R
    curves = []
    for side in (-1, 1):
        to_x, to_y = np.array([side * R, 0, 0]), np.array([0, side * R, 0])
        for at, wall in (([[-u, side * v, R], [u, side * v, R]], to_y), ([[side * u, -v, R], [side * u, v, R]], to_x)):
            curves.append(touching(at, np.array([0, 0, -R]), wall))
        for other in (-1, 1):
            upright = [[side * u, other * v, R], [side * u, other * v, top]]
            curves.append(touching(upright, to_x, np.array([0, other * R, 0])))
    return Part("pocket", surface, curves, view=(52, -62))


def pit(steep: float) -> Part:
    """Three planes alike that meet in a point; `steep`: the angle of their edges with the axis, degrees."""
    a, reach, bottom = radians(steep), 22.0, -5.0
    edges = np.array([[sin(a) * cos(f), sin(a) * sin(f), cos(a)] for f in 2 * pi * np.arange(3) / 3])
    rim, base = reach * edges, reach * edges
    base = np.stack([base[:, 0], base[:, 1], np.full(3, bottom)], 1)
    side = float(np.linalg.norm(rim[1] - rim[0]))
    surface = ring([point(0), loop(rim), loop(base), point(bottom)], [reach, reach, side / 2], [Patch(side, 2)] * 3)
    normals = np.array([np.cross(edges[k], edges[(k + 1) % 3]) for k in range(3)])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    meet = np.array([0, 0, R / normals[0, 2]])
    curves = []
    for k in range(3):
        faces = normals[[k, k - 1]]
        begin = meet @ edges[k]
        # A contact's share of its face's two edges grows with the distance along one of them; on the rim it is `reach`.
        foot = meet - R * faces[0]
        shares = np.linalg.lstsq(np.stack([edges[k], edges[(k + 1) % 3]], 1), foot, rcond=None)[0]
        far = meet + (reach - shares.sum()) * edges[k]
        assert far @ edges[k] > begin
        at = np.stack([meet, far])
        curves.append(Curve(at, at[:, None] - R * faces))
    angle = 180 - np.degrees(np.arccos(normals[0] @ normals[1]))
    return Part(f"three planes at {angle:.0f}°", surface, curves, view=(50, -40))


# ---- convex ones


def box() -> Part:
    rows = [point(0), rectangle(12, 9, 0), rectangle(12, 9, 10), point(10)]
    return Part("box", ring(rows, [10, 10, 10], [Patch(24, 2), Patch(18, 2)] * 2))


def sphere(radius: float = 12.0) -> Part:
    def at(s: np.ndarray, t: np.ndarray) -> np.ndarray:
        t = np.where(t == 1, 0, t)
        r, z = radius * np.sin(pi * s), -radius * np.cos(pi * s)
        r = np.where((s == 0) | (s == 1), 0, r)
        return np.stack([r * np.cos(2 * pi * t), r * np.sin(2 * pi * t), z], -1)

    return Part(
        "sphere", Surface(at, [Patch(pi * radius, 32)], [Patch(2 * pi * radius, ROUND)], ring=True, convex=True)
    )


def parts() -> list[Part]:
    return [
        *(groove(angle) for angle in (60, 75, 90, 120, 150, 170)),
        groove(175, found=False),
        *(groove(90, share * R, share < 1) for share in (0.3, 0.8, 0.95, 1.2)),
        boss(0),
        boss(25),
        hole(0),
        hole(25),
        pocket(),
        pit(40),
        pit(65),
        slot(),
        dovetail(),
        box(),
        sphere(),
    ]
