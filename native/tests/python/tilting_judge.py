"""A judge of operations whose axes change. It shares no code with the core: tool and part are compared at points of a
cloud on the part, at dense poses of each move that are interpolated here."""

import math

import numpy as np
from finish_judge import surface_samples


def between(a, b, shares):
    """Poses (k, 6) between two poses: the tip on a line, the axis on the great circle."""
    angle = math.atan2(np.linalg.norm(np.cross(a[3:], b[3:])), a[3:] @ b[3:])
    s = np.asarray(shares)[:, None]
    axes = a[3:] + s * (b[3:] - a[3:])
    if angle > 1e-9:
        axes = (np.sin((1 - s) * angle) * a[3:] + np.sin(s * angle) * b[3:]) / math.sin(angle)
    return np.hstack([a[:3] + s * (b[:3] - a[:3]), axes])


def dense(op, kinds, step=0.1, turn=0.02):
    """Poses every ``step`` mm and ``turn`` rad along the moves of these kinds, with the number of each one's move."""
    out, moves = [], []
    for k in range(1, len(op)):
        if op.kind[k] not in kinds:
            continue
        a, b = op.poses[k - 1], op.poses[k]
        count = max(np.linalg.norm(b[:3] - a[:3]) / step, np.linalg.norm(b[3:] - a[3:]) / turn)
        found = between(a, b, np.linspace(0, 1, 2 + math.ceil(count)))
        out.append(found), moves.append(np.full(len(found), k))
    return np.concatenate(out), np.concatenate(moves)


def depth_in_tool(tool, pose, points):
    """Largest depth of the points in a ball-ended tool with shank and holder, mm; negative: the smallest distance. For
    shank and holder, the depth from their sides."""
    off = points - pose[:3]
    z = off @ pose[3:]
    rho = np.linalg.norm(off - z[:, None] * pose[3:], axis=1)
    r = tool.diameter / 2
    deepest = (r - np.hypot(rho, np.where(z < r, z - r, 0.0)))[z < tool.length].max(initial=-np.inf)
    for z0, r0, z1, r1 in [*tool.shank, *tool.holder]:
        side = r0 + (r1 - r0) * (z - z0) / (z1 - z0) - rho
        deepest = max(deepest, np.minimum(side, np.minimum(z - z0, z1 - z)).max(initial=-np.inf))
    return deepest


def deepest(op, part, kinds, count=4000, seed=3, **steps):
    """How deep points of a cloud on the part come into the tool along moves of these kinds, mm, with the move."""
    cloud = surface_samples(part, count, seed)[0]
    poses, moves = dense(op, kinds, **steps)
    worst, where = -np.inf, -1
    for pose, move in zip(poses, moves, strict=True):
        depth = depth_in_tool(op.tool, pose, cloud)
        if depth > worst:
            worst, where = depth, move
    return worst, where


def centres(op):
    """Ball centres at the poses, mm."""
    return op.poses[:, :3] + op.tool.diameter / 2 * op.poses[:, 3:]


def distance_to_cuts(op, points):
    """Distance of points from the straight lines between the ball centres of cuts, mm."""
    c = centres(op)
    least = np.full(len(points), np.inf)
    for k in np.flatnonzero(op.kind == 2):
        a, way = c[k - 1], c[k] - c[k - 1]
        square = way @ way
        t = np.clip((points - a) @ way / square, 0, 1) if square > 0 else np.zeros(len(points))
        least = np.minimum(least, np.linalg.norm(points - a - t[:, None] * way, axis=1))
    return least


def turns(op):
    """Change of the axis, rad, and path of the ball's centre, mm, along cuts and links."""
    rows = np.flatnonzero(np.isin(op.kind, (2, 3)))
    a, b = op.poses[rows - 1, 3:], op.poses[rows, 3:]
    angle = np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), np.einsum("ij,ij->i", a, b))
    c = centres(op)
    return angle, np.linalg.norm(c[rows] - c[rows - 1], axis=1)
