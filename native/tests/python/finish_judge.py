"""Parts for operations, and a judge of their results that shares no code with the planner: it uses a z-map in numpy,
with the cutter at dense places of each move, and samples of the surface that the cutter can touch."""

import math

import numpy as np
import riffler
from riffler import plan


def solid_under(x, z):
    """A block with a roof of triangles at the heights of the grid ``x`` × ``x``."""
    n = len(x)
    gx, gy = np.meshgrid(x, x, indexing="ij")
    top = np.stack([gx, gy, z], axis=-1).reshape(-1, 3)
    bottom = top * [1, 1, 0]
    i, j = (k.ravel() for k in np.meshgrid(np.arange(n - 1), np.arange(n - 1), indexing="ij"))
    a, b, c, d = i * n + j, (i + 1) * n + j, (i + 1) * n + j + 1, i * n + j + 1
    roof = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    edge = np.concatenate([np.arange(n) * n, (n - 1) * n + np.arange(1, n), np.arange(n - 2, -1, -1) * n + n - 1,
                           np.arange(n - 2, 0, -1)])  # fmt: skip
    after = np.roll(edge, -1)
    m = n * n
    sides = np.concatenate([np.stack([edge, edge + m, after], 1), np.stack([after, edge + m, after + m], 1)])
    return riffler.Mesh(np.concatenate([top, bottom]), np.concatenate([roof, roof[:, ::-1] + m, sides]))


def boss_on_plate(degrees=10.0):
    """A box, turned by 10°, on a plate. It has long triangles and upright walls."""
    low = np.array([[0, 0], [30, 0], [30, 30], [0, 30]], float)
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    high = (low - 15) * [0.4, 0.3] @ np.array([[c, s], [-s, c]]) + 15
    vertices, triangles = [], []

    def prism(outline, z0, z1):
        k = len(vertices)
        vertices.extend([*p, z0] for p in outline)
        vertices.extend([*p, z1] for p in outline)
        triangles.extend([[k, k + 2, k + 1], [k, k + 3, k + 2], [k + 4, k + 5, k + 6], [k + 4, k + 6, k + 7]])
        for i in range(4):
            j = (i + 1) % 4
            triangles.extend([[k + i, k + j, k + j + 4], [k + i, k + j + 4, k + i + 4]])

    prism(low, 0, 3)
    prism(high, 3, 8)
    return riffler.Mesh(vertices, triangles)


def sphere_on_plate():
    u, v = np.meshgrid(np.linspace(0, 2 * math.pi, 61)[:-1], np.linspace(0, math.pi / 2, 16), indexing="ij")
    points = np.stack([8 * np.cos(u) * np.sin(v), 8 * np.sin(u) * np.sin(v), 8 * np.cos(v)], -1) + np.array([15, 15, 3])
    n, m = points.shape[:2]
    i, j = (k.ravel() for k in np.meshgrid(np.arange(n), np.arange(m - 1), indexing="ij"))
    a, b = i * m + j, (i + 1) % n * m + j
    dome = np.concatenate([np.stack([a, a + 1, b + 1], 1), np.stack([a, b + 1, b], 1)])
    plate = riffler.Volume.block((0, 0, 0), (30, 30, 3), pitch=10, directions="xyz").to_mesh()
    k = n * m
    return riffler.Mesh(
        np.concatenate([points.reshape(-1, 3), plate.vertices]), np.concatenate([dome, np.asarray(plate.triangles) + k])
    )


def heights(mesh, x, y):
    """Heights of a mesh, seen from above, at the points (x, y), by barycentric coordinates; −∞ outside of the mesh."""
    out = np.full(x.shape, -np.inf)
    tri = np.asarray(mesh.vertices)[np.asarray(mesh.triangles)]
    for a, b, c in tri:
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        if abs(area) < 1e-12:
            continue
        near = (x >= min(a[0], b[0], c[0]) - 1e-9) & (x <= max(a[0], b[0], c[0]) + 1e-9)
        near &= (y >= min(a[1], b[1], c[1]) - 1e-9) & (y <= max(a[1], b[1], c[1]) + 1e-9)
        if not near.any():
            continue
        px, py = x[near], y[near]
        u = ((px - a[0]) * (c[1] - a[1]) - (py - a[1]) * (c[0] - a[0])) / area
        v = ((b[0] - a[0]) * (py - a[1]) - (b[1] - a[1]) * (px - a[0])) / area
        inside = (u >= -1e-9) & (v >= -1e-9) & (u + v <= 1 + 1e-9)
        z = a[2] + u * (b[2] - a[2]) + v * (c[2] - a[2])
        out[near] = np.where(inside, np.maximum(out[near], z), out[near])
    return out


def lower_side(tool, rho, larger=0.0):
    """Height of the lower side of ball, flat, bull-nosed and tapered cutters, `larger` mm thicker, above the tip of the
    thin one; ∞ beyond their radius."""
    flat, rounding, angle = corner(tool)
    rounding, middle = rounding + larger, rounding
    beyond = np.maximum(rho - flat, 0)
    low = middle - np.sqrt(np.maximum(rounding**2 - beyond**2, 0))
    if angle:  # the cone begins where the rounding is as steep
        cone = middle - rounding * math.sin(angle) + (beyond - rounding * math.cos(angle)) / math.tan(angle)
        low = np.where(beyond <= rounding * math.cos(angle), low, cone)
    return np.where(rho <= tool.diameter / 2 + larger, low, np.inf)


def z_map(op, x, y, step=0.05):
    """Height of the material at the points after all moves at feed, by brute force: the cutter at dense places."""
    feeds = np.flatnonzero(np.asarray(op.kind)[1:])
    start, end = op.poses[feeds, :3], op.poses[feeds + 1, :3]
    count = np.maximum(2, np.ceil(np.linalg.norm((end - start)[:, :2], axis=1) / step).astype(int) + 1)
    share = (np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)) / np.repeat(count - 1, count)
    places = np.repeat(start, count, axis=0) + share[:, None] * np.repeat(end - start, count, axis=0)
    out, r = np.full(x.shape, np.inf), op.tool.diameter / 2
    for k in range(0, len(places), 64):
        p = places[k : k + 64, :, None]
        lo, hi = p.min(axis=(0, 2)) - r, p.max(axis=(0, 2)) + r
        near = np.flatnonzero((x >= lo[0]) & (x <= hi[0]) & (y >= lo[1]) & (y <= hi[1]) & (out > lo[2] + r))
        if len(near):
            rho = np.sqrt((x[near] - p[:, 0]) ** 2 + (y[near] - p[:, 1]) ** 2)
            z = p[:, 2] + lower_side(op.tool, rho)
            out[near] = np.minimum(out[near], z.min(axis=0))
    return out


def setup_of(part, pitch=0.4, top=1.0, **more):
    lower, upper = part.bounds
    return plan.Setup(part, riffler.Volume.block(lower, upper + np.array([0, 0, top]), pitch), **more)


# ---- parts


def revolved(profile, sides=48, centre=(15.0, 15.0)):
    """A solid of revolution about the upright axis through ``centre``. Its profile (radius, height) begins and ends on
    the axis."""
    profile = np.asarray(profile, float)
    turn = np.linspace(0, 2 * math.pi, sides + 1)[:-1]
    rings = [
        np.stack([r * np.cos(turn) + centre[0], r * np.sin(turn) + centre[1], np.full(sides, z)], -1)
        for r, z in profile
    ]
    triangles = []
    i, j = np.arange(sides), (np.arange(sides) + 1) % sides
    for k in range(len(profile) - 1):
        a, b = k * sides, (k + 1) * sides
        if profile[k + 1][0] > 0:
            triangles.append(np.stack([a + i, b + j, b + i], 1))
        if profile[k][0] > 0:
            triangles.append(np.stack([a + i, a + j, b + j], 1))
    return riffler.Mesh(np.concatenate(rings), np.concatenate(triangles))


def dome():
    """A spherical dome of 8 mm on a disc."""
    angle = np.linspace(0, math.pi / 2, 25)
    return revolved([(0, 0), (14, 0), (14, 2), *((8 * math.cos(t), 2 + 8 * math.sin(t)) for t in angle[:-1]), (0, 10)])


def cone():
    """A cone with a flat top and walls of 60° on a disc."""
    return revolved([(0, 0), (14, 0), (14, 2), (8, 2), (8 - 8 / math.tan(math.pi / 3), 10), (0, 10)])


def steps():
    """Two steps with upright walls."""
    return revolved([(0, 0), (14, 0), (14, 3), (9, 3), (9, 7), (5, 7), (5, 10), (0, 10)])


def torus():
    """The upper half of a torus, with its hole, on a disc."""
    angle = np.linspace(0, math.pi, 33)
    ring = [(8 + 3 * math.cos(t), 2 + 3 * math.sin(t)) for t in angle]
    return revolved([(0, 0), (14, 0), (14, 2), *ring, (0, 2)], sides=64)


PARTS = {"dome": dome, "cone": cone, "steps": steps, "torus": torus, "cube at 10°": boss_on_plate}


# ---- the judge


def corner(tool):
    """Radius of the flat bottom and of the rounding, mm, and half angle of the cone above, rad, of a cutter."""
    if tool.kind == "flat":
        return tool.diameter / 2, 0.0, 0.0
    if tool.kind == "ball":
        return 0.0, tool.diameter / 2, 0.0
    sizes = tool.to_dict()
    if tool.kind == "taper":
        return 0.0, sizes["tip_radius"], sizes["half_angle"]
    return tool.diameter / 2 - sizes["corner_radius"], sizes["corner_radius"], 0.0


def tips_touching(tool, points, normals, gap):
    """Tips of the cutter when its end touches the surface at points with these normals, at a distance of `gap` mm."""
    flat, rounding, _ = corner(tool)
    level = normals[:, :2] / np.maximum(np.linalg.norm(normals[:, :2], axis=1), 1e-12)[:, None]
    tips = points + normals * (rounding + gap)
    tips[:, :2] += level * np.where(np.linalg.norm(normals[:, :2], axis=1) > 1e-6, flat, 0.0)[:, None]
    tips[:, 2] -= rounding
    return tips


def surface_samples(part, count, seed):
    """Random points on the part, spread evenly by area, with their normals and triangles."""
    random = np.random.default_rng(seed)
    corners = np.asarray(part.vertices)[np.asarray(part.triangles)]
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(cross, axis=1)
    chosen = random.choice(len(area), count, p=area / area.sum())
    u, v = random.uniform(size=(2, count, 1))
    over = u + v > 1
    u, v = np.where(over, 1 - u, u), np.where(over, 1 - v, v)
    a, b, c = corners[chosen].transpose(1, 0, 2)
    return a + u * (b - a) + v * (c - a), cross[chosen] / area[chosen, None], chosen


class Judge:
    """Checks what an operation leaves at random points of a part's surface.

    ``reachable``: whether a slightly larger cutter can touch the point without touching any other point of a cloud on
    the surface, and with its tip not below the part. ``standing``: places where material higher than cusp + tolerance
    stays on part + allowance. ``deep``: places that are cut deeper than the tolerance. Both measure along normals.
    """

    def __init__(self, part, tool, allowance, slopes, count=1500, seed=1, larger=0.05, within=None):
        self.part, self.tool, self.allowance = part, tool, allowance
        self.points, self.normals, self.triangles = surface_samples(part, count, seed)
        slope = np.arccos(np.clip(self.normals[:, 2], -1, 1))
        self.asked = (slope >= slopes[0] + (1e-3 if slopes[0] else 0.0)) & (slope <= slopes[1] + 1e-6)
        if within is not None:
            self.asked &= within(self.points, self.triangles)
        cloud = surface_samples(part, 60000, seed + 1)[0]
        x, y, z = np.ascontiguousarray(cloud[np.argsort(cloud[:, 0])].T)
        tips = tips_touching(tool, self.points, self.normals, allowance + larger)
        self.reachable = self.asked & (tips[:, 2] >= part.bounds[0][2] - 1e-9)
        # On steeper faces the flank of a tapered cutter cuts, at a place that this judge does not know.
        self.reachable &= slope <= math.pi / 2 - corner(tool)[2] + 1e-6
        grown = allowance + 0.8 * larger
        reach = tool.diameter / 2 + grown
        for k in np.flatnonzero(self.reachable):
            band = slice(*np.searchsorted(x, tips[k, 0] + np.array([-reach, reach])))
            # Nothing of the cutter is lower than its tip.
            close = band.start + np.flatnonzero(
                (z[band] > tips[k, 2] - grown - 1e-9) & (np.abs(y[band] - tips[k, 1]) < reach)
            )
            rho = np.hypot(x[close] - tips[k, 0], y[close] - tips[k, 1])
            near = rho < reach
            if (z[close[near]] > tips[k, 2] + lower_side(tool, rho[near], grown)).any():
                self.reachable[k] = False

    def _left(self, op, off, which):
        """Height of the material over points at a distance ``off`` from the samples ``which``, a mask."""
        at = self.points[which] + off * self.normals[which]
        return z_map(op, at[:, 0], at[:, 1]) - at[:, 2]

    def standing(self, op, cusp, tolerance):
        """Reachable samples where more material stays than cusp and tolerance allow."""
        left = self._left(op, self.allowance + cusp + tolerance + 2e-3, self.reachable)
        return self.points[self.reachable][left > 0]

    def deep(self, op, tolerance):
        """Samples, reachable or not, where the cut is deeper than the tolerance."""
        off = self.allowance - tolerance - 1e-3
        low = self._left(op, off, np.ones(len(self.points), bool)) < 0
        at = self.points[low] + off * self.normals[low]
        # Next to an edge the point lies just under another face, which may be cut there.
        low[low] = (heights(self.part, at[:, 0], at[:, 1]) + self.allowance - at[:, 2]) > tolerance + 1e-3
        return self.points[low]
