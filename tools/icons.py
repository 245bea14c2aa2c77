"""Draws the icons of the add-on's tools: triangles in Blender's own format, addon/icons/*.dat.

    python tools/icons.py

The file: "VCO" and a zero, four bytes of size and start, then for each triangle three corners of two bytes (y upwards),
then for each corner four bytes of colour.
"""

from __future__ import annotations

import struct
import sys

import numpy as np

from shell import ROOT, main

sys.path.insert(0, str(ROOT))
from addon.sculpt import brushes

FOLDER = ROOT / "addon" / "icons"
TOOL, SHADE, STOCK, EDGE = (232, 232, 232, 255), (186, 186, 186, 255), (120, 120, 120, 255), (160, 160, 160, 255)
AWAY, ON, SOFT, SAFE = (240, 120, 60, 255), (90, 160, 245, 255), (135, 205, 120, 255), (60, 60, 60, 255)
FLOOR, CENTRE, RADIUS = 100.0, 128.0, 46.0


def convex(points, colour):
    """A fan of triangles."""
    points = [tuple(p) for p in points]
    return [((points[0], points[k], points[k + 1]), colour) for k in range(1, len(points) - 1)]


def band(lower, upper, colour):
    """Between two lines with as many points."""
    out = []
    for a, b, c, d in zip(lower, lower[1:], upper[1:], upper, strict=False):
        out += convex([a, b, c, d], colour)
    return out


def arc(x, y, radius, start, end, count=14):
    angle = np.radians(np.linspace(start, end, count))
    return list(zip(x + radius * np.cos(angle), y + radius * np.sin(angle), strict=True))


def surface(height):
    """Stock below height(x), with a lighter edge."""
    x = np.linspace(14, 241, 40)
    top = [(a, height(a)) for a in x]
    under = [(a, b - 14) for a, b in top]
    return band([(a, 20) for a in x], under, STOCK) + band(under, top, EDGE)


def cutter(tip):
    """A ball end mill, its tip at a height; the right half in the shade."""
    y = tip + RADIUS
    parts = convex([*arc(CENTRE, y, RADIUS, 180, 270), (CENTRE, y)], TOOL)
    parts += convex([*arc(CENTRE, y, RADIUS, 270, 360), (CENTRE, y)], SHADE)
    parts += convex([(CENTRE - RADIUS, y), (CENTRE, y), (CENTRE, 244), (CENTRE - RADIUS, 244)], TOOL)
    return parts + convex([(CENTRE, y), (CENTRE + RADIUS, y), (CENTRE + RADIUS, 244), (CENTRE, 244)], SHADE)


def turned(triangles, degrees, x, y):
    """About a point, counter-clockwise."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    turn = np.array([(c, s), (-s, c)])
    return [(tuple(map(tuple, (np.array(t) - (x, y)) @ turn + (x, y))), colour) for t, colour in triangles]


def dome(x, size, way):
    """Half a circle of the cutter's radius, as high as `size` at its top: what is cut away or put on."""
    y = size - RADIUS
    rest = RADIUS**2 - (x - CENTRE) ** 2
    return way * max(0.0, y + np.sqrt(max(rest, 0.0))) if rest > 0 else 0.0


def groove():
    return surface(lambda x: FLOOR + 6 + dome(x, 40, -1))


def chip():
    return convex(arc(206, FLOOR + 34, 18, 0, 360, 18), AWAY)


def bead():
    """Stock, and what was put on it."""
    return surface(lambda x: FLOOR - 30) + convex(arc(CENTRE, FLOOR - 30, RADIUS, 0, 180, 20), ON)


def wave():
    """Stock that is rough on one side and smooth on the other."""
    x = np.linspace(14, 241, 60)
    rough = FLOOR + 22 * np.sin((x - 14) / 12) * np.clip((150 - x) / 80, 0, 1)
    top = list(zip(x, rough, strict=True))
    return band([(a, 20) for a in x], top, STOCK) + band(list(zip(x, rough - 12, strict=True)), top, SOFT)


def kept():
    """Stock, half of which is protected."""
    parts = surface(lambda x: FLOOR + 6)
    return parts + band([(a, 20) for a in (128, 241)], [(a, FLOOR + 6) for a in (128, 241)], SAFE)


def bump(x, height, width=84.0):
    """A layer with a soft edge."""
    p = max(0.0, 1 - abs(x - CENTRE) / width)
    return height * p * p * (3 - 2 * p)


def between(lower, upper, colour):
    """What lies between two heights."""
    x = np.linspace(14, 241, 60)
    return band([(a, lower(a)) for a in x], [(a, upper(a)) for a in x], colour)


def ring(height=FLOOR + 30, radius=92.0):
    """The ring of a brush, seen from the side."""
    angle = np.radians(np.linspace(0, 360, 41))
    inner, outer = (
        list(zip(CENTRE + r * np.cos(angle), height + 0.3 * r * np.sin(angle), strict=True))
        for r in (radius, radius + 12)
    )
    return band(inner, outer, TOOL)


def soft_bead():
    """Stock, and a layer on it."""
    base = FLOOR - 30
    return surface(lambda x: base) + between(lambda x: base, lambda x: base + bump(x, 56), ON)


def blown():
    """A bulge, and what it has grown by."""

    def dome_of(radius):
        return lambda x: FLOOR - 50 + np.sqrt(max(radius**2 - (x - CENTRE) ** 2, 0.0))

    return surface(dome_of(62)) + between(dome_of(62), dome_of(88), ON)


def levelled(above, below):
    """A rough surface: the peaks that go, the valleys that are filled."""

    def rough(x):
        return FLOOR + 34 * np.sin((x - CENTRE) / 19)

    parts = surface(lambda x: min(rough(x), FLOOR) if above else rough(x))
    if above:
        parts += between(lambda x: FLOOR, lambda x: max(rough(x), FLOOR), AWAY)
    if below:
        parts += between(lambda x: min(rough(x), FLOOR), lambda x: FLOOR, ON)
    return parts


def pulled(height, lean=0.0):
    """A tip pulled out of the stock."""
    base = FLOOR - 40
    p = np.linspace(0, 1, 20)
    width = 78 * (1 - p) ** 2 + 9
    left, right = (
        list(zip(CENTRE + lean * p * p + side * width, base + (height + 40) * p, strict=True)) for side in (-1, 1)
    )
    return surface(lambda x: base) + band(left, right, ON)


def ridge(height):
    """A sharp ridge, or a furrow if the height is negative."""
    return surface(lambda x: FLOOR + height * max(0.0, 1 - abs(x - CENTRE) / 70) ** 2)


def whirl():
    """Arms of a spiral on the stock."""
    out = surface(lambda x: FLOOR - 20)
    for k in range(3):
        angle, r = np.radians(120 * k + np.linspace(0, 200, 30)), np.linspace(8, 84, 30)
        inner, outer = ((CENTRE + (r + w) * np.cos(angle), FLOOR + 30 + 0.3 * (r + w) * np.sin(angle)) for w in (-6, 6))
        out += band(list(zip(*inner, strict=True)), list(zip(*outer, strict=True)), ON)
    return out


def gouge():
    """A groove, and a leaning blade that pushes a curl ahead."""
    y = FLOOR - 28
    stock = surface(lambda x: FLOOR - 34 if x < 150 else FLOOR)
    blade = convex([(150, y), (112, y + 34), (30, y + 34), (30, y)], TOOL) + convex(
        [(150, y), (30, y), (30, y + 12), (137, y + 12)], SHADE
    )
    blade += convex([(30, y - 10), (30, y + 44), (-40, y + 44), (-40, y - 10)], (150, 110, 70, 255))
    curl = band(arc(176, FLOOR + 30, 22, -90, 200, 24), arc(176, FLOOR + 30, 34, -90, 200, 24), AWAY)
    return stock + turned(blade, -38, 150, y) + curl


def plan():
    """A slim cutter that leans in a valley, and the ring that turns it."""
    low, slim = 30, [((np.array(t) - (CENTRE, 0)) * (0.62, 0.8) + (CENTRE, 0), c) for t, c in cutter(0)]
    stand = [(np.add(t, (0, low + 26)), c) for t, c in slim]
    valley = band([(14, 14), (CENTRE, 14), (241, 14)], [(14, 118), (CENTRE, low), (241, 118)], STOCK)
    valley += band([(14, 104), (CENTRE, low - 14), (241, 104)], [(14, 118), (CENTRE, low), (241, 118)], EDGE)
    ring = band(arc(CENTRE, low + 54, 150, 55, 105, 40), arc(CENTRE, low + 54, 168, 55, 105, 40), ON)
    return valley + turned(stand, 18, CENTRE, low + 54) + ring


def icons():
    """{name: triangles}: the plan's, and those of the brushes, which draw their own with the functions above."""
    draw = sys.modules[__name__]
    return {"riffler.plan": plan(), **{brush.tool: brush.picture(draw) for brush in brushes.with_tool()}}


def encode(triangles) -> bytes:
    corners = np.array([t for t, _ in triangles]).round().clip(0, 255).astype(np.uint8)
    colours = np.repeat(np.array([c for _, c in triangles], np.uint8), 3, axis=0)
    return struct.pack("<4s4B", b"VCO\0", 255, 255, 0, 0) + corners.tobytes() + colours.tobytes()


def run() -> int:
    FOLDER.mkdir(exist_ok=True)
    for name, triangles in icons().items():
        (FOLDER / f"{name}.dat").write_bytes(encode(triangles))
        print(f"{name}: {len(triangles)} triangles")
    return 0


if __name__ == "__main__":
    main(run)
