"""A ball over waves, what verification is measured on: program, stock and part; and, from definitions and numpy alone,
the surface that the ball leaves and the volume over it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from riffler import Mesh, Program, Tool, VerifyReport, Volume

from .nc_programs import unit
from .scenes import box_mesh, upright

SIZE, DEEP, RADIUS = 100.0, 20.0, 3.0  # mm: the stock is SIZE × SIZE × DEEP, its top at z = 0
OVER = 1.0  # mm that the first and the last line, and the ends of all, lie beyond the stock's sides
# mm from the lowest that the ball is asked to go down to the part. It is 0.12 mm lower where the waves are steep.
ALLOWANCE = 0.2
REST = 0.5  # mm that may stand on the part: ALLOWANCE, and the cusps between lines up to 2.5 mm apart
CHORD = 1e-7  # mm: how far the path of a turning ball's centre may be from the chords that stand for it
WINDOW = 2.0  # mm: points so close together are compared with the same moves


def tool() -> Tool:
    return Tool.ball(2 * RADIUS, 25).with_shank([(25, 3, 40, 3)]).with_holder([(40, 12, 90, 20)])


def wave(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return -3 + 1.5 * np.sin(x / 9) * np.cos(y / 7)


def poses(rows: int, lines: int, tilted: bool, first: int = 0, last: int | None = None) -> np.ndarray:
    """(n, 6): rows `first` to `last` of `rows`, lines to and fro along x. Tilted, up to 30°, the ball's centre goes the
    same way."""
    k = np.arange(first, rows if last is None else last)
    line, along = np.divmod(k * lines, rows)
    along = np.where(line % 2, rows - along, along) / rows
    x, y = (SIZE + 2 * OVER) * np.stack([along, line / (lines - 1)]) - OVER
    axes = np.zeros((len(k), 3))
    axes[:, 2] = 1
    if tilted:
        axes[:, :2] = np.column_stack([0.4 * np.sin(x / 30), 0.4 * np.cos(y / 25)])
    axes = unit(axes)
    return np.hstack([np.column_stack([x, y, wave(x, y) + RADIUS]) - RADIUS * axes, axes])


def as_program(rows: np.ndarray, first: int = 0) -> Program:
    line = np.arange(first, first + len(rows)) + 1
    return Program(rows, 3000.0, spindle=12000.0, tools={1: tool()}, line=line)


def program(rows: int, lines: int, tilted: bool) -> Program:
    return as_program(poses(rows, lines, tilted))


def chunks(rows: int, lines: int, tilted: bool, size: int) -> Iterator[Program]:
    """The program in pieces, each made when it is asked for; each begins with the row at which the one before ended."""
    for first in range(0, max(rows - 1, 1), size):
        yield as_program(poses(rows, lines, tilted, first, min(first + size + 1, rows)), first)


def stock(pitch: float, directions: str = "z") -> Volume:
    return Volume.block([0, 0, -DEEP], [SIZE, SIZE, 0], pitch, directions)


def part(cells: int) -> Mesh:
    """The waves ALLOWANCE deeper down, on a grid of cells² squares, as the upper side of a solid."""
    side, n = np.linspace(0, SIZE, cells + 1), cells + 1
    x, y = (c.ravel() for c in np.meshgrid(side, side, indexing="ij"))
    top, bottom = wave(x, y) - ALLOWANCE, np.full(n * n, -DEEP)
    vertices = np.concatenate([np.column_stack([x, y, top]), np.column_stack([x, y, bottom])])
    at = np.arange(n * n).reshape(n, n)
    a, b, c, d = (at[i : i + cells, j : j + cells].ravel() for i, j in ((0, 0), (1, 0), (1, 1), (0, 1)))
    upper = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    around = np.concatenate([at[:-1, 0], at[-1, :-1], at[:0:-1, -1], at[0, :0:-1]])
    after, under = np.roll(around, -1), n * n
    walls = [
        np.column_stack([around, around + under, after + under]),
        np.column_stack([around, after + under, after]),
    ]
    return Mesh(vertices, np.concatenate([upper, upper[:, ::-1] + under, *walls]))


def pit(rows: int, pitch: float) -> tuple[np.ndarray, Volume]:
    """Rows 1 mm deep over the floor of a square pit of 60 mm with walls 23 mm high, 12 mm from them and further."""
    lines = round(rows**0.5)
    tips = 32 + 36 / (SIZE + 2 * OVER) * (poses(rows, lines, False)[:, :3] + OVER)
    tips[:, 2] = -4
    box = {"lower": [0, 0, -DEEP], "upper": [SIZE, SIZE, 20]}
    around = Volume.block(*box.values(), pitch, "z")
    around.subtract(Volume.from_mesh(box_mesh([20, 20, -3], [80, 80, 21]), pitch, "z", **box))
    return upright(tips), around


def contents(found: VerifyReport) -> tuple[bytes, ...]:
    """What must not depend on who verified, in which pieces, on how many threads, or after which edits."""
    data = found.to_dict()
    del data["stats"]
    return repr(data).encode(), np.asarray(found.removed).tobytes(), found.volume.to_bytes()


# ---- what the ball leaves, without the code that is measured


def ways(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Begins and ends (m, 3) of straight paths of the ball's centre on the moves between poses: where the axis turns,
    chords within CHORD of tip + R · axis, the tip on a line and the axis on the great circle at constant rate."""
    a, b = rows[:-1], rows[1:]
    turn = np.arctan2(np.linalg.norm(np.cross(a[:, 3:], b[:, 3:]), axis=1), (a[:, 3:] * b[:, 3:]).sum(1))
    pieces = np.maximum(1, np.ceil(turn * np.sqrt(RADIUS / (8 * CHORD)))).astype(int)
    move = np.repeat(np.arange(len(turn)), pieces)
    piece = np.arange(len(move)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    a, b, angle, share = a[move], b[move], np.maximum(turn[move], 1e-9), 1 / pieces[move]  # a line, for tiny turns

    def centre(t: np.ndarray) -> np.ndarray:
        axes = np.sin((1 - t) * angle)[:, None] * a[:, 3:] + np.sin(t * angle)[:, None] * b[:, 3:]
        return a[:, :3] + t[:, None] * (b[:, :3] - a[:, :3]) + RADIUS * axes / np.sin(angle)[:, None]

    return centre(piece * share), centre((piece + 1) * share)


def lowest(begin: np.ndarray, end: np.ndarray, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """(points,): the least height that the lower half of a ball reaches over each point (x, y) on any of the straight
    paths of its centre; inf where none comes.

    Over a point, c(t) − √(R² − d(t)²) is convex: c is linear, and −√ of a concave function is convex. With the
    path's slope m and the point's distance p from it in plan, the least is where the centre has w = m √((R² − p²) /
    (1 + m²)) left to the point's foot, or at the end that is nearer to that.
    """
    way = end - begin
    length = np.hypot(way[:, 0], way[:, 1])
    flat = np.maximum(length, 1e-12)
    ux, uy, slope = way[:, 0] / flat, way[:, 1] / flat, way[:, 2] / flat
    dx, dy = x[:, None] - begin[:, 0], y[:, None] - begin[:, 1]
    along, beside = dx * ux + dy * uy, dx * uy - dy * ux
    still = slope / np.sqrt(1 + slope * slope) * np.sqrt(np.maximum(RADIUS**2 - beside * beside, 0))
    upright = np.where(way[:, 2] < 0, 1.0, 0.0)  # a plunge is lowest at its end
    t = np.where(length > 1e-12, np.clip((along - still) / flat, 0, 1), upright)
    square = RADIUS**2 - (dx - t * way[:, 0]) ** 2 - (dy - t * way[:, 1]) ** 2
    height = begin[:, 2] + t * way[:, 2] - np.sqrt(np.maximum(square, 0))
    return np.where(square >= 0, height, np.inf).min(1, initial=np.inf)


def left(rows: np.ndarray, points: np.ndarray) -> np.ndarray:
    """(n,): height of what moves between poses (rows, 6) leave of the stock at points (n, 2).

    Only the ball's lower half is looked at. The cylinder above it never cuts deeper, tilted or not: the waves bend with
    radii over 30 mm, and lines lie closer than the ball is wide.
    """
    begin, end = ways(rows)
    low, high = np.minimum(begin, end)[:, :2] - RADIUS, np.maximum(begin, end)[:, :2] + RADIUS
    out = np.zeros(len(points))
    cell = np.floor(points / WINDOW).astype(int)
    for j in np.unique(cell[:, 1]):
        strip = np.flatnonzero((low[:, 1] <= (j + 1) * WINDOW) & (high[:, 1] >= j * WINDOW))
        mine = np.flatnonzero(cell[:, 1] == j)
        for i in np.unique(cell[mine, 0]):
            near = strip[(low[strip, 0] <= (i + 1) * WINDOW) & (high[strip, 0] >= i * WINDOW)]
            here = mine[cell[mine, 0] == i]
            out[here] = lowest(begin[near], end[near], *points[here].T)
    return np.clip(out, -DEEP, 0)


@dataclass(frozen=True)
class Exact:
    """Heights at points that are spread evenly over the stock, and the volume over all of the surface with its standard
    error in mm³."""

    points: np.ndarray
    heights: np.ndarray
    removed: float
    uncertain: float

    @classmethod
    def of(cls, rows: np.ndarray, side: int) -> Exact:
        """Two points at random in each of side² squares, and the two opposite them about its middle, so that slopes
        cancel; the two pairs' difference tells the error."""
        rng = np.random.default_rng(5)
        middle = np.stack(np.meshgrid(np.arange(side), np.arange(side), indexing="ij"), -1).reshape(-1, 2) + 0.5
        off = rng.uniform(-0.5, 0.5, (2, *middle.shape))
        points = np.stack([middle + off, middle - off]).reshape(-1, 2) * (SIZE / side)
        heights = left(rows, points)
        pair = heights.reshape(2, 2, -1).mean(0)
        area, apart = (SIZE / side) ** 2, (pair[0] - pair[1]) / 2
        return cls(points, heights, -area * float(pair.mean(0).sum()), area * float(np.sqrt((apart**2).sum())))

    def between(self, tops: np.ndarray, pitch: float) -> np.ndarray:
        """How much higher the bilinear surface over the rays' tops is, at the points that have rays all around."""
        inner = np.all((self.points > pitch / 2) & (self.points < SIZE - pitch / 2), axis=1)
        return bilinear(tops, self.points[inner] / pitch - 0.5) - self.heights[inner]


def bilinear(net: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Values at places in units of the net's meshes, within it."""
    i, j = np.clip(np.floor(at).astype(int), 0, np.array(net.shape) - 2).T
    u, v = at[:, 0] - i, at[:, 1] - j
    near = (1 - v) * net[i, j] + v * net[i, j + 1]
    return (1 - u) * near + u * ((1 - v) * net[i + 1, j] + v * net[i + 1, j + 1])


def tops(volume: Volume) -> np.ndarray:
    """(nx, ny): height of the highest material on every z ray; the stock's bottom where there is none."""
    counts, spans = volume.intervals("z")
    out, last = np.full(counts.size, -DEEP), np.cumsum(counts.ravel())
    filled = counts.ravel() > 0
    out[filled] = spans[last[filled] - 1, 1]
    return out.reshape(counts.shape)
