"""What verification is judged by: a height map, exact under cutters that only move, and dense sampling. And scenes.

Shares nothing with the core but the names of the cutters' sizes.
"""

from __future__ import annotations

import json

import numpy as np
import riffler


def box_mesh(lower, upper) -> riffler.Mesh:
    (x0, y0, z0), (x1, y1, z1) = lower, upper
    corners = [[x, y, z] for z in (z0, z1) for y in (y0, y1) for x in (x0, x1)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return riffler.Mesh(np.array(corners, float), np.array(triangles))


def blocks(pitch, lower, upper, *parts, directions="z") -> riffler.Volume:
    """A volume from `lower` to `upper` that holds the boxes `parts`."""
    out = None
    for part in parts:
        one = riffler.Volume.from_mesh(box_mesh(*part), pitch, directions, lower=lower, upper=upper)
        out = one if out is None else out.add(one)
    return out


class HeightMap:
    """Heights of the top over ray centres. `profile` = (radius, corner radius) of a cutter that reaches out of it."""

    def __init__(self, lower, upper, pitch):
        n = np.maximum(1, np.round((np.subtract(upper, lower)[:2]) / pitch).astype(int))
        self.x = (lower[0] + (np.arange(n[0]) + 0.5) * pitch)[:, None]
        self.y = (lower[1] + (np.arange(n[1]) + 0.5) * pitch)[None, :]
        self.z = np.full(n, float(upper[2]))
        self.bottom, self.pitch = lower[2], pitch

    def under(self, profile, a, b):
        """The least height of the cutter's lower side over each ray on the move from a to b; inf elsewhere.

        z + f(distance from the axis) is convex on the move, as f is convex and grows: golden section finds its least.
        """
        radius, corner = profile
        a, b = np.asarray(a, float), np.asarray(b, float)
        ux, uy, dx, dy = self.x - a[0], self.y - a[1], b[0] - a[0], b[1] - a[1]
        square = dx * dx + dy * dy
        with np.errstate(invalid="ignore", divide="ignore"):
            middle = (ux * dx + uy * dy) / square if square > 0 else np.zeros(self.z.shape)
            off = ux * ux + uy * uy - middle * middle * square
            half = np.sqrt((radius * radius - off) / square) if square > 0 else np.where(off <= radius**2, 2.0, np.nan)
        low, high = np.maximum(middle - half, 0), np.minimum(middle + half, 1)
        met = low <= high  # False for nan

        out = np.full(self.z.shape, np.inf)
        ux, uy = (np.broadcast_to(u, out.shape)[met] for u in (ux, uy))

        def height(t):
            rho = np.hypot(ux - t * dx, uy - t * dy)
            beyond = np.clip(rho - (radius - corner), 0, corner)
            return a[2] + t * (b[2] - a[2]) + corner - np.sqrt(corner**2 - beyond**2)

        low, high = low[met], high[met]
        g = (np.sqrt(5) - 1) / 2
        best = np.minimum(height(low), height(high))
        for _ in range(60):
            p, q = high - g * (high - low), low + g * (high - low)
            right = height(p) > height(q)
            low, high = np.where(right, p, low), np.where(right, high, q)
        out[met] = np.minimum(best, height((low + high) / 2))
        return out

    def cut(self, profile, a, b):
        """Returns what each ray lost, mm."""
        new = np.maximum(np.minimum(self.z, self.under(profile, a, b)), self.bottom)
        lost, self.z = self.z - new, new
        return lost


def tops(volume) -> np.ndarray:
    """Height of the highest material on every z ray; the bottom where there is none."""
    counts, spans = volume.intervals("z")
    out = np.full(counts.size, volume.lower[2])
    ends = np.cumsum(counts.ravel())
    filled = counts.ravel() > 0
    out[filled] = spans[ends[filled] - 1, 1]
    return out.reshape(counts.shape)


def points_of(volume, step, lower=(-np.inf,) * 3, upper=(np.inf,) * 3) -> np.ndarray:
    """Points in the material that lie in the box, `step` apart along the z rays, from the top of each span down."""
    counts, spans = volume.intervals("z")
    index = np.repeat(np.arange(counts.size), counts.ravel())
    places = np.array(volume.lower)[:2] + (np.column_stack(np.divmod(index, counts.shape[1])) + 0.5) * volume.pitch
    chosen = np.flatnonzero(((places > lower[:2]) & (places < upper[:2])).all(axis=1))
    near, far = spans[chosen].T
    steps = np.ceil((far - near) / step).astype(int)  # and the lower end
    first = np.cumsum(steps + 1) - (steps + 1)
    z = np.repeat(far, steps + 1) - step * (np.arange((steps + 1).sum()) - np.repeat(first, steps + 1))
    z[first + steps] = near
    kept = (z > lower[2]) & (z < upper[2])
    return np.column_stack([np.repeat(places[chosen], steps + 1, axis=0)[kept], z[kept]])


def in_frusta(points, frusta, pose) -> np.ndarray:
    """How deep each point is in the union of a tool's truncated cones at a pose, negative outside.

    The least distance to a side or an end, measured square to the axis and along it."""
    d = points - pose[:3]
    z = d @ pose[3:]
    rho = np.linalg.norm(d - z[:, None] * pose[3:], axis=1)
    depth = np.full(len(points), -np.inf)
    for z0, r0, z1, r1 in frusta:
        radius = r0 + (r1 - r0) * (z - z0) / (z1 - z0)
        depth = np.maximum(depth, np.minimum(radius - rho, np.minimum(z - z0, z1 - z)))
    return depth


def near_frusta(points, frusta, poses, margin=0.5) -> np.ndarray:
    """The points that truncated cones could come within `margin` of at any of the poses: those in a box of all the
    balls about them."""
    z0, z1 = min(f[0] for f in frusta), max(f[2] for f in frusta)
    radius = np.hypot((z1 - z0) / 2, max(max(f[1], f[3]) for f in frusta)) + margin
    centres = poses[:, :3] + (z0 + z1) / 2 * poses[:, 3:]
    for k, (low, high) in enumerate(zip(centres.min(0) - radius, centres.max(0) + radius, strict=True)):
        points = points[(points[:, k] > low) & (points[:, k] < high)]
    # And of the slabs across the tool's axis at the middle pose, as far as any pose leans from it.
    middle = poses[len(poses) // 2]
    ends = np.concatenate([poses[:, :3] + z * poses[:, 3:] for z in (z0, z1)]) - middle[:3]
    side = max(max(f[1], f[3]) for f in frusta) * np.sqrt(np.clip(1 - (poses[:, 3:] @ middle[3:]) ** 2, 0, 1)).max()
    along, ends = (points - middle[:3]) @ middle[3:], ends @ middle[3:]
    return points[(along > ends.min() - side - margin) & (along < ends.max() + side + margin)]


UP = [0.0, 0.0, 1.0]


def path(tips, axis=UP):
    tips = np.asarray(tips, float)
    return np.column_stack([tips, np.broadcast_to(np.asarray(axis, float), tips.shape)])


def program(poses, cutter=None, **columns):
    columns = {"feed": 1000.0, "spindle": 8000.0, "line": np.arange(len(poses)) + 100} | columns
    tools = {} if cutter is None else {1: cutter}
    return riffler.Program(poses, columns.pop("feed"), tools=tools, **columns)


def line_of_moves(first, last, step):
    first, last = np.asarray(first, float), np.asarray(last, float)
    n = int(np.ceil(np.linalg.norm(last - first) / step))
    return first + np.linspace(0, 1, n + 1)[:, None] * (last - first)


def rows(report, kind):
    """All rows of the findings of a kind."""
    return [r for f in report.findings if f.kind == kind for r in range(f.row, f.last_row + 1)]


def kinds(report):
    return sorted({f.kind for f in report.findings})


def state(report):
    """Everything a report says, but how much work it was."""
    data = report.to_dict()
    del data["stats"]
    return (
        json.dumps(data),
        np.asarray(report.removed).tobytes(),
        np.asarray(report.seconds).tobytes(),
        report.volume.to_bytes(),
    )


def raster(width, over, z, step=1.0):
    tips = []
    for k, y in enumerate(np.arange(0, width + 1e-9, over)):
        tips += list(line_of_moves([0, y, z], [width, y, z], step)[:: 1 if k % 2 == 0 else -1])
    return np.array(tips)


def busy_scene():
    """A five-axis program with everything going wrong somewhere."""
    rng = np.random.default_rng(3)
    n = 600
    t = np.linspace(0, 1, n)
    tips = np.column_stack([30 + 24 * np.sin(17 * t), 20 + 16 * np.cos(23 * t), -4 - 4 * np.sin(40 * t)])
    axes = UP + 0.3 * np.column_stack([np.sin(9 * t), np.cos(7 * t), 0 * t])
    poses = np.column_stack([tips, axes / np.linalg.norm(axes, axis=1)[:, None]])
    rapid = rng.random(n) < 0.05
    tool = riffler.Tool.ball(6, 8).with_shank([(8, 2, 14, 4)]).with_holder([(14, 8, 40, 10)])
    stock = blocks(0.5, [0, 0, -20], [60, 40, 8], ([0, 0, -20], [60, 40, -4]), ([40, 0, -20], [60, 40, 8]))
    part = box_mesh([0, 0, -20], [60, 40, -7])
    fixtures = [box_mesh([-10, 10, -20], [4, 30, 2])]
    return poses, rapid, tool, stock, part, fixtures


def busy_program(poses, rapid, tool):
    return program(poses, tool, rapid=rapid, feed=np.where(rapid, 0, 1000), line=np.arange(len(poses)))


HOLDER = [(20, 10, 50, 10)]


def held(length=15):
    return riffler.Tool.ball(6, length).with_shank([(length, 3, 20, 3)]).with_holder(HOLDER)
