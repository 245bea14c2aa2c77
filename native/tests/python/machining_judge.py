"""A judge of operations on any part: height maps and samples in numpy, which share no code with the planner."""

import math

import numpy as np
from finish_judge import heights, lower_side, surface_samples, z_map
from riffler.plan.operations import CUT

CELL = 0.15  # mm, of height maps
ROUNDING = 2e-3  # mm, for the judge's own
SLIVER = 0.03  # mm: thinner material counts as none; places of the cutter lie a cell apart


def part_heights(part, x, y):
    """Heights of a part, seen from above, over the grid x × y; −∞ outside of it."""
    out = np.full((len(x), len(y)), -np.inf)
    for a, b, c in np.asarray(part.vertices)[np.asarray(part.triangles)]:
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        if abs(area) < 1e-12:
            continue
        i = slice(*np.searchsorted(x, [min(a[0], b[0], c[0]) - 1e-9, max(a[0], b[0], c[0]) + 1e-9]))
        j = slice(*np.searchsorted(y, [min(a[1], b[1], c[1]) - 1e-9, max(a[1], b[1], c[1]) + 1e-9]))
        px, py = x[i, None], y[None, j]
        u = ((px - a[0]) * (c[1] - a[1]) - (py - a[1]) * (c[0] - a[0])) / area
        v = ((b[0] - a[0]) * (py - a[1]) - (b[1] - a[1]) * (px - a[0])) / area
        inside = (u >= -1e-9) & (v >= -1e-9) & (u + v <= 1 + 1e-9)
        z = a[2] + u * (b[2] - a[2]) + v * (c[2] - a[2])
        out[i, j] = np.where(inside, np.maximum(out[i, j], z), out[i, j])
    return out


def distances(points, part):
    """Distances of points from the triangles of a part, exact, by brute force."""
    corners = np.asarray(part.vertices)[np.asarray(part.triangles)]
    a, ab, ac = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    normal = np.cross(ab, ac)
    size = np.linalg.norm(normal, axis=1)
    solid = size > 1e-12
    out = np.full(len(points), np.inf)
    for k, p in enumerate(points):
        least = np.inf
        for i in range(3):
            start, way = corners[:, i], corners[:, (i + 1) % 3] - corners[:, i]
            square = np.maximum((way * way).sum(axis=1), 1e-300)
            share = np.clip(((p - start) * way).sum(axis=1) / square, 0, 1)
            least = min(least, np.linalg.norm(start + share[:, None] * way - p, axis=1).min())
        n = normal[solid] / size[solid, None]
        off = p - a[solid]
        high = (off * n).sum(axis=1)
        foot = off - high[:, None] * n
        u = (np.cross(foot, ac[solid]) * n).sum(axis=1) / size[solid]
        v = (np.cross(ab[solid], foot) * n).sum(axis=1) / size[solid]
        over = (u >= 0) & (v >= 0) & (u + v <= 1)
        out[k] = min(least, np.abs(high[over]).min(initial=np.inf))
    return out


def windings(points, part):
    """How often the surface of a part surrounds points: 1 inside a closed part, 0 outside, by the sum of the solid
    angles of its triangles (Van Oosterom and Strackee 1983)."""
    corners = np.asarray(part.vertices)[np.asarray(part.triangles)]
    out = np.empty(len(points))
    for k, p in enumerate(points):
        a, b, c = (corners[:, i] - p for i in range(3))
        la, lb, lc = (np.linalg.norm(x, axis=1) for x in (a, b, c))
        high = (a * np.cross(b, c)).sum(axis=1)
        low = la * lb * lc + (a * b).sum(axis=1) * lc + (b * c).sum(axis=1) * la + (c * a).sum(axis=1) * lb
        out[k] = np.arctan2(high, low).sum() / (2 * np.pi)
    return out


class HeightMap:
    """Heights of a stock over small cells, cut by all moves of operations in order."""

    def __init__(self, lower, upper):
        self.x, self.y = (np.arange(lower[k] + CELL / 2, upper[k], CELL) for k in (0, 1))
        self.z, self.floor = np.full((len(self.x), len(self.y)), float(upper[2])), float(lower[2])

    def copy(self):
        other = object.__new__(HeightMap)
        other.x, other.y, other.z, other.floor = self.x, self.y, self.z.copy(), self.floor
        return other

    def cut(self, op):
        """Carves an operation. Returns the largest height (mm) that a move removes, of rapids and of links; and for
        each cut its length and the width of what it removes."""
        radius, thick, widths = op.tool.diameter / 2, [0.0, 0.0, 0.0, 0.0], []
        for k in range(1, len(op)):
            a, b, kind = op.poses[k - 1, :3], op.poses[k, :3], int(op.kind[k])
            steps = max(1, math.ceil(np.linalg.norm(b - a) / CELL))
            flat = np.linalg.norm((b - a)[:2])
            across = np.array([a[1] - b[1], b[0] - a[0]]) / max(flat, 1e-12)
            width = 0.0
            for p in np.linspace(a, b, steps + 1)[1:]:
                i = slice(*np.searchsorted(self.x, [p[0] - radius, p[0] + radius]))
                j = slice(*np.searchsorted(self.y, [p[1] - radius, p[1] + radius]))
                here = self.z[i, j]
                if not here.size or here.max() <= p[2]:
                    continue
                dx, dy = self.x[i, None] - p[0], self.y[None, j] - p[1]
                low = np.maximum(p[2] + lower_side(op.tool, np.hypot(dx, dy)), self.floor)
                gone = here - low
                most = gone.max()
                if most <= 0:
                    continue
                thick[kind] = max(thick[kind], most)
                if kind == CUT and most > SLIVER:
                    at = (dx * across[0] + dy * across[1])[gone > SLIVER]
                    width = max(width, at.max() - at.min())
                self.z[i, j] = np.minimum(here, low)
            if kind == CUT and flat > 0:
                widths.append((width, flat))
        return thick, np.array(widths).reshape(-1, 2)


class PartJudge:
    """Finds gouges of operations in a part: at random places, and next to random points of its surface."""

    SUSPECTS = 150  # places whose distance from the part is measured

    def __init__(self, part, random, count=1500):
        self.part, self.closed = part, part.audit().open_edges == 0
        lower, upper = (np.array(corner) for corner in part.bounds)
        self.places = random.uniform(lower[:2], upper[:2], (count, 2))
        self.points, self.normals, _ = surface_samples(part, count, int(random.integers(1 << 30)))

    def gouges(self, op, allowance, tolerance):
        """Places where the moves at feed come nearer to the part than allowance − tolerance, with the depth, mm."""
        inside = self.points - (tolerance + 2 * ROUNDING) * self.normals
        at = np.concatenate([self.places, inside[:, :2]])
        low = z_map(op, *at.T)
        cut = np.isfinite(low)
        at, low = at[cut], low[cut]
        over = heights(self.part, *at.T)
        suspect = np.flatnonzero(low < over + allowance - tolerance - ROUNDING)[: self.SUSPECTS]
        beside = np.setdiff1d(np.arange(len(low)), suspect)[: self.SUSPECTS if allowance else 0]
        chosen = np.concatenate([suspect, beside]).astype(int)
        points = np.column_stack([at, low])[chosen]
        away = distances(points, self.part)
        below = low[chosen] < over[chosen]
        if self.closed and below.any():  # a cutter may enter a thin overhang within its tolerance, and the void below
            below[below] = np.abs(windings(points[below], self.part)) > 0.5
        depth = np.where(below, allowance + away, allowance - away)
        return [(p, d) for p, d in zip(points, depth, strict=True) if d > tolerance + ROUNDING]


def opened(z, tool, larger, floor):
    """The height map that a cutter leaves, thicker by `larger` mm, if it moves over every place of the height map z as
    low as it can, but not below the floor."""
    reach = math.ceil((tool.diameter / 2 + larger) / CELL)
    g = np.arange(-reach, reach + 1) * CELL
    lower = lower_side(tool, np.hypot(g[:, None], g[None, :]), larger)
    n, m = z.shape
    tips = np.full(z.shape, float(floor))
    padded = np.pad(z, reach, constant_values=-np.inf)
    for i, j in np.argwhere(np.isfinite(lower)):
        tips = np.maximum(tips, padded[i : i + n, j : j + m] - lower[i, j])
    out = np.full(z.shape, np.inf)
    padded = np.pad(tips, reach, constant_values=np.inf)
    lower = lower_side(tool, np.hypot(g[:, None], g[None, :]))
    for i, j in np.argwhere(np.isfinite(lower)):
        out = np.minimum(out, padded[i : i + n, j : j + m] + lower[i, j])
    return out
