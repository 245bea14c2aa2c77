"""A block of linoleum cut with gouges, and the same block after its first stroke, the river, was bent.

python docs/gallery/linocut.py
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import riffler
from common import options
from picture import Picture

WIDTH, HEIGHT, THICKNESS = 120.0, 84.0, 5.0  # mm
INK, LINO = (0.018, 0.022, 0.030), (0.62, 0.50, 0.33)
LEAN = np.radians(60)  # of the handle, back from the surface's normal
STEP = 0.7  # mm between two poses
HORIZON, SUN, VANISH = 42.0, np.array([84.0, 63.0]), np.array([50.0, 42.0])
TREES = ((21.0, 13.0, 4.6, 40.0), (33.0, 24.0, 2.7, 22.0))  # foot x, y; half width; height
RIVER = ((82.0, 7.0), (66.0, 14.0), (66.0, 22.0), (58.0, 30.0), (51.0, 40.5))
BENT = ((50.0, 7.0), (72.0, 13.0), (84.0, 22.0), (64.0, 31.0), (51.0, 40.5))


def opened(tool: riffler.Tool, depth: float) -> riffler.Tool:
    """The tool with the room that its chip leaves through: the leaning blade, moved out of the material."""
    out = 1.5 * depth * np.array([np.sin(LEAN), 0, np.cos(LEAN)])
    return riffler.Tool.convex([np.vstack([hull, hull + out]) for hull in tool.hulls])


VEINER = opened(riffler.Tool.gouge(3, 1.5, np.radians(25), 20), 1.5)
LINO_GOUGE = opened(riffler.Tool.gouge(2, 1.1, np.radians(25), 12), 1)
GOUGE = opened(riffler.Tool.gouge(10, 6.5, np.radians(25), 25), 2)
V_TOOL = opened(riffler.Tool.v_tool(np.radians(90), 8, np.radians(25), 25), 1.5)


def through(points, count: int = 60) -> np.ndarray:
    """A smooth curve through points (n, 2): Catmull and Rom's spline."""
    p = np.asarray(points, float)
    p = np.vstack([2 * p[0] - p[1], p, 2 * p[-1] - p[-2]])
    t = np.linspace(0, 1, count, endpoint=False)[:, None]
    pieces = [
        0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t**2 + (3 * b - a - 3 * c + d) * t**3)
        for a, b, c, d in zip(p, p[1:], p[2:], p[3:], strict=False)
    ]
    return np.vstack([*pieces, p[-2:-1]])


def even(line: np.ndarray) -> np.ndarray:
    """The same polyline with points at equal distances."""
    s = np.r_[0, np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))]
    at = np.linspace(0, s[-1], max(int(s[-1] / STEP), 4) + 1)
    return np.column_stack([np.interp(at, s, line[:, k]) for k in range(2)])


def stroke(line: np.ndarray, depth, taper: float = 4.0) -> np.ndarray:
    """Poses (n, 9) along a line: `depth` (mm, one or one for each point), which begins and ends at the surface within
    `taper` mm."""
    way = np.gradient(line, axis=0)
    way /= np.linalg.norm(way, axis=1)[:, None]
    s = np.r_[0, np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))]
    rise = np.clip(np.minimum(s, s[-1] - s) / min(taper, 0.45 * s[-1]), 0, 1)
    z = 0.05 - (depth + 0.05) * np.sqrt(rise * (2 - rise))
    flat, up = np.c_[way, np.zeros(len(way))], np.array([0.0, 0, 1])
    return np.hstack(
        [line, z[:, None], np.cos(LEAN) * up - np.sin(LEAN) * flat, np.cos(LEAN) * flat + np.sin(LEAN) * up]
    )


def ridge(x):
    """y of the mountains' ridge, mm."""
    peaks = (61 - 0.8 * abs(x - 46), 57 - 0.55 * abs(x - 10), 54 - 0.6 * abs(x - 72), 53 - 0.45 * abs(x - 112))
    return np.maximum(np.maximum.reduce(peaks) + 0.7 * np.sin(0.9 * x), HORIZON + 1)


def in_tree(p: np.ndarray, margin: float = 1.6) -> np.ndarray:
    """Whether points (n, 2) lie in a cypress or next to it."""
    inside = np.zeros(len(p), bool)
    for x, y, half, high in TREES:
        t = np.clip((p[:, 1] - y) / high, 0, 1)
        wide = half * np.sqrt(np.sin(np.pi * t**0.6)) + margin
        inside |= (abs(p[:, 0] - x) < wide) & (p[:, 1] > y - margin) & (p[:, 1] < y + high + margin)
    return inside


def pieces(line: np.ndarray, keep: np.ndarray, least: float = 3.0) -> Iterator[np.ndarray]:
    """The parts of a line where `keep` holds that are at least `least` mm long."""
    ends = np.flatnonzero(np.diff(np.r_[False, keep, False].astype(int)))
    for first, last in zip(ends[::2], ends[1::2], strict=True):
        if (last - first) * STEP > least:
            yield line[first:last]


def river(points) -> np.ndarray:
    """Wide in front, narrow at the horizon."""
    line = even(through(points))
    near = np.clip((HORIZON - line[:, 1]) / (HORIZON - 3), 0, 1)
    return stroke(line, 0.15 + 0.85 * near**1.3, taper=1.5)


def sun() -> Iterator[tuple]:
    """A cleared disc, and rays around it down to the mountains."""
    for radius in np.arange(0.9, 8.5, 1.1):
        turn = np.linspace(0, 2 * np.pi, 90)
        yield VEINER, stroke(even(SUN + radius * np.c_[np.cos(turn), np.sin(turn)]), 0.75, taper=0.5)
    for k, turn in enumerate(np.linspace(0, 2 * np.pi, 64, endpoint=False)):
        way = np.array([np.cos(turn), np.sin(turn)])
        line = even(np.array([SUN + (11.5 + 2.5 * (k % 2)) * way, SUN + 100 * way]))
        x, y = line.T
        free = (x > 6) & (x < WIDTH - 6) & (y < HEIGHT - 6) & (y > ridge(x) + 1.8) & ~in_tree(line)
        for part in pieces(line, free):
            away = np.linalg.norm(part - SUN, axis=1)
            yield LINO_GOUGE, stroke(part, np.clip(0.30 + 0.006 * away, 0, 0.75), taper=9)


def mountains() -> Iterator[tuple]:
    """The ridge as a line, and strokes down its sunny sides."""
    x = np.linspace(6, WIDTH - 6, 400)
    line = even(np.c_[x, ridge(x)])
    for part in pieces(line, (line[:, 1] > HORIZON + 1.2) & ~in_tree(line)):
        yield LINO_GOUGE, stroke(part, 0.4, taper=2)
    for x0 in np.arange(8, WIDTH - 8, 1.9):
        top = ridge(x0) - 1.6
        slope = ridge(x0 + 0.5) - ridge(x0 - 0.5)
        if slope > 0.1:  # in the shade: the sun stands on the right
            continue
        fall = np.array([[x0, top], [x0 + 0.35 * (top - HORIZON), HORIZON + 1.2]])
        line = even(fall)
        for part in pieces(line, (line[:, 1] < ridge(line[:, 0]) - 1.3) & ~in_tree(line), 2.0):
            yield LINO_GOUGE, stroke(part, 0.42, taper=6)


def fields() -> Iterator[tuple]:
    """Furrows from the vanishing point to the front, deeper and wider there, in dashes."""
    for k, front in enumerate(np.arange(-190, 300, 11.0)):
        line = even(np.array([VANISH, [front, -10.0]]))
        x, y = line.T
        near = (HORIZON - y) / HORIZON
        free = (x > 6) & (x < WIDTH - 6) & (y > 6) & (y < HORIZON - 2.5 - 2.5 * (k % 2)) & ~in_tree(line)
        free &= np.sin(9 * np.sqrt(np.clip(near, 0, 1)) * np.pi + 2.3 * k) > -0.93
        for part in pieces(line, free):
            near = (HORIZON - part[:, 1]) / HORIZON
            yield LINO_GOUGE, stroke(part, 0.12 + 0.62 * near, taper=6)


def trees() -> Iterator[tuple]:
    """Flames of small cuts within the cypresses' outlines, left dark between them."""
    for x, y, half, high in TREES:
        for k, t in enumerate(np.linspace(0.1, 0.86, int(high / 2.6))):
            wide = half * np.sqrt(np.sin(np.pi * t**0.6))
            for side in (-1, 1):
                foot = np.array([x + side * 0.3 * wide, y + high * t])
                tip = np.array([x + side * 0.78 * wide, y + high * (t + 0.07) + 0.6 * (k % 2)])
                yield V_TOOL, stroke(even(np.array([foot, 0.5 * (foot + tip) + [0, -0.5], tip])), 0.35, taper=3)


def frame() -> Iterator[tuple]:
    corners = np.array([[3, 3], [WIDTH - 3, 3], [WIDTH - 3, HEIGHT - 3], [3, HEIGHT - 3]], float)
    for a, b in zip(corners, np.roll(corners, -1, 0), strict=True):
        yield VEINER, stroke(even(np.array([a, b])), 0.8, taper=0.6)


def show(picture: Picture, mesh: riffler.Mesh, left: float) -> None:
    """The block, moved by `left` mm in x, with ink on what was not cut."""
    vertices = mesh.vertices + np.array([left, 0, 0])
    inked = (mesh.vertices[:, 2] > -0.015)[mesh.triangles].all(axis=1)
    for those, colour in ((inked, INK), (~inked, LINO)):
        picture.add(vertices, mesh.triangles[those], colour, smooth=30)


def main() -> None:
    given = options(__doc__)
    base = riffler.Volume.block((0, 0, -THICKNESS), (WIDTH, HEIGHT, 0), 0.6 if given.fast else 0.2, "xyz")
    history = riffler.History(base)
    first = history.add(GOUGE, river(RIVER))
    strokes = [*sun(), *mountains(), *fields(), *trees(), *frame()]
    for tool, poses in strokes:
        history.add(tool, poses)
    before = history.volume.to_mesh()
    history.replace(first, poses=river(BENT))
    after = history.volume.to_mesh()
    again = riffler.Volume.from_bytes(base.to_bytes())
    for tool, poses in [(GOUGE, river(BENT)), *strokes]:
        again.carve(tool, poses)
    if again.to_bytes() != history.volume.to_bytes():
        raise SystemExit("the edited history is not what the strokes cut in order")
    print(f"{len(history)} strokes, {base.volume - again.volume:.0f} mm³ cut; {history.stats()}")
    if before.audit().open_edges or after.audit().open_edges:
        raise SystemExit("the block is not closed")
    if given.fast:
        return
    picture = Picture()
    show(picture, before, -WIDTH - 5)
    show(picture, after, 5)
    view = {"eye": (0, -40, 420), "target": (0, 42, 0), "floor": -THICKNESS, "width": 268, "size": (1400, 540)}
    picture.photograph(given.out / "linocut.jpg", given.blender, **view)


if __name__ == "__main__":
    main()
