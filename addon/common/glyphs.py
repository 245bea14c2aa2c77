"""Arrows, rings and bars as triangles, without drawing.

Triangles are (n, 3, 3), their corners counter-clockwise seen from outside; lines are (n, 3) points.
"""

from __future__ import annotations

import numpy as np

SIDES = 16
HEAD = 3.0  # widths of the shaft: width of an arrow's head, which is 1.5 times as long


def frame(axis) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Two directions perpendicular to `axis`, and `axis` as a unit vector: right-handed."""
    axis = np.asarray(axis, float)
    axis = axis / np.linalg.norm(axis)
    helper = np.eye(3)[np.argmin(np.abs(axis))]
    first = np.cross(helper, axis)
    first /= np.linalg.norm(first)
    return first, np.cross(axis, first), axis


def ring(centre, axis, radius: float, sides: int = 64) -> np.ndarray:
    """A closed ring: the first point is not repeated."""
    first, second, _ = frame(axis)
    angle = 2 * np.pi * np.arange(sides) / sides
    return np.asarray(centre) + radius * (np.cos(angle)[:, None] * first + np.sin(angle)[:, None] * second)


def outline(points) -> np.ndarray:
    """The corners of the convex hull of points (n, 2), counter-clockwise, without those on its sides."""
    ordered = sorted({(float(x), float(y)) for x, y in np.asarray(points, float)})
    if len(ordered) < 3:
        return np.array(ordered)

    def side(line):
        kept: list = []
        for p in line:
            while len(kept) > 1 and _left(kept[-2], kept[-1], p) <= 0:
                kept.pop()
            kept.append(p)
        return kept[:-1]

    return np.array(side(ordered) + side(ordered[::-1]))


def _left(a, b, c) -> float:
    """Twice the area of the triangle; positive if c is on the left of the line from a to b."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def tube(line, places, sides: int = SIDES) -> np.ndarray:
    """A tube around `places` (k, 3), with radii `line` (k,). Its rings are perpendicular to the path."""
    places, radii = np.asarray(places, float), np.asarray(line, float)
    way = np.gradient(places, axis=0)
    rings = []
    first = frame(way[0])[0]
    for place, radius, t in zip(places, radii, way, strict=True):
        t = t / np.linalg.norm(t)
        first = first - (first @ t) * t  # transported along the path, so that the tube does not twist
        first /= np.linalg.norm(first)
        angle = 2 * np.pi * np.arange(sides) / sides
        across = np.cos(angle)[:, None] * first + np.sin(angle)[:, None] * np.cross(t, first)
        rings.append(place + radius * across)
    rings = np.array(rings)
    low, high = rings[:-1], rings[1:]
    low_next, high_next = np.roll(low, -1, axis=1), np.roll(high, -1, axis=1)
    quads = [np.stack([low, low_next, high_next], axis=2), np.stack([low, high_next, high], axis=2)]
    triangles = np.concatenate([q.reshape(-1, 3, 3) for q in quads])
    area = np.linalg.norm(np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=1)
    return triangles[area > 1e-12 * max(float(radii.max()), 1e-30) ** 2]


def arrow(start, end, width: float) -> np.ndarray:
    """A closed arrow with a shaft `width` wide. An arrow shorter than its head is a smaller head alone. Empty for
    length 0."""
    start, end = np.asarray(start, float), np.asarray(end, float)
    length = float(np.linalg.norm(end - start))
    if length < 1e-12:
        return np.empty((0, 3, 3))
    head = 1.5 * HEAD * width
    size = min(1.0, length / head)
    neck = max(0.0, 1 - head / length)
    shares = np.array([0, 0, neck, neck, 1.0])
    radii = 0.5 * width * size * np.array([0, 1, 1, HEAD, 0])
    return _turned_about(start, end - start, shares, radii)


def _turned_about(start, way, shares, radii) -> np.ndarray:
    """A body of revolution about a straight path: unlike for a tube, rings may lie in one plane."""
    first, second, _ = frame(way)
    angle = 2 * np.pi * np.arange(SIDES) / SIDES
    across = np.cos(angle)[:, None] * first + np.sin(angle)[:, None] * second
    rings = start + shares[:, None, None] * way + radii[:, None, None] * across
    out = []
    for k in range(len(rings) - 1):
        low, high = rings[k], rings[k + 1]
        low_next, high_next = np.roll(low, -1, axis=0), np.roll(high, -1, axis=0)
        if radii[k] > 0:
            out.append(np.stack([low, low_next, high_next], axis=1))
        if radii[k + 1] > 0:
            out.append(np.stack([low, high_next, high], axis=1))
    return np.concatenate(out) if out else np.empty((0, 3, 3))


def arc_arrow(centre, axis, radius: float, angle: float, width: float) -> np.ndarray:
    """An arrow bent about `axis` by `angle` (rad, less than a turn), right-handed. An arrow shorter than its head is a
    smaller head alone. Empty for angle 0."""
    if angle <= 0:
        return np.empty((0, 3, 3))
    first, second, _ = frame(axis)
    whole = 1.5 * HEAD * width / radius
    size = min(1.0, angle / whole)
    head = size * whole
    shaft = np.linspace(0, angle - head, max(2, int(np.ceil((angle - head) / 0.15)) + 1))

    def at(turn):
        return np.asarray(centre) + radius * (np.cos(turn)[:, None] * first + np.sin(turn)[:, None] * second)

    parts = []
    if angle - head > 1e-9:
        parts.append(tube(np.full(len(shaft), 0.5 * width), at(shaft)))
    # The head is straight: a bent one would point elsewhere than the end of the arc.
    neck, tip = at(np.array([angle - head, angle]))
    radii = 0.5 * HEAD * width * size * np.array([0, 1, 0])
    parts.append(_turned_about(neck, tip - neck, np.array([0, 0, 1.0]), radii))
    return np.concatenate(parts)


def ribbon(points, width: float, closed: bool = False) -> np.ndarray:
    """A line (n, 2) as triangles (m, 2 corners each of x, y): (m, 3, 2), `width` wide. Graphics cards draw lines one
    pixel wide at any width setting. Points that are not numbers break the line."""
    points = np.asarray(points, float)
    ends = np.roll(points, -1, axis=0) if closed else points[1:]
    starts = points if closed else points[:-1]
    way = ends - starts
    length = np.linalg.norm(way, axis=1)
    good = np.isfinite(length) & (length > 1e-9)
    starts, ends, way, length = starts[good], ends[good], way[good], length[good]
    unit = way / length[:, None]
    across = 0.5 * width * np.c_[-unit[:, 1], unit[:, 0]]
    along = 0.5 * width * unit  # half a width longer, so that corners have no notch
    a, b = starts - along - across, starts - along + across
    c, d = ends + along + across, ends + along - across
    return np.concatenate([np.stack([a, d, c], axis=1), np.stack([a, c, b], axis=1)])


def box(x: float, y: float, width: float, height: float) -> np.ndarray:
    """A rectangle as two triangles, (2, 3, 2)."""
    a, b, c, d = (x, y), (x + width, y), (x + width, y + height), (x, y + height)
    return np.array([(a, b, c), (a, c, d)], float)


def meridian(outline, height: float = np.inf) -> np.ndarray:
    """Both sides of a tool's outline in its own plane, up to a height: (n, 2) of a closed line, x across and y up from
    the tip. `outline`: that of riffler.Tool.outline."""
    line = np.vstack([points for _, points in outline])
    if line[-1, 1] > height:
        k = int(np.argmax(line[:, 1] > height))
        share = (height - line[k - 1, 1]) / (line[k, 1] - line[k - 1, 1])
        line = np.vstack([line[:k], line[k - 1] + share * (line[k] - line[k - 1])])
    return np.concatenate([line, line[::-1] * (-1, 1)])
