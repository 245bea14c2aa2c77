"""The exact surface of B200's part, from its definition and numpy alone: what the meshes of the job ``mesh`` are judged
by, and the fields that rivals mesh.

A ball end mill that reaches out of the block takes, on a straight move, a vertical half-strip grown by the ball's
radius: the strip stands on the path of the ball's centre. The part is the block less 200 of those.
"""

from __future__ import annotations

import numpy as np

from . import scenes

RADIUS = 3.0
UPPER = np.asarray(scenes.BLOCK[1])
# Moves on either side of a point that are looked at. Each goes 0.4 mm in x, so the others are further away than REACH.
WINDOW, REACH = 13, 2.0


def centres() -> np.ndarray:
    """The ball's centres (201, 3)."""
    a = np.linspace(0, 1, scenes.MOVES + 1)
    return np.stack([10 + 80 * a, 30 + 15 * np.sin(12 * a), 30 - 2 * a], 1)


def cuts(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Signed distance (n, k) of points from what each of the moves around them takes, negative inside, and gradients
    (n, k, 3)."""
    c = centres()
    near = np.floor((points[:, 0] - 10) / 0.4).astype(int)
    moves = np.clip(near[:, None] + np.arange(-WINDOW, WINDOW + 1), 0, scenes.MOVES - 1)
    a, way = c[moves], c[moves + 1] - c[moves]
    length = np.hypot(way[..., 0], way[..., 1])
    # In the strip's plane: s along the move, level, z up; q is square to the plane.
    along = way[..., :2] / length[..., None]
    off = points[:, None] - a
    s = off[..., 0] * along[..., 0] + off[..., 1] * along[..., 1]
    q = off[..., 0] * along[..., 1] - off[..., 1] * along[..., 0]
    z, slope = off[..., 2], way[..., 2] / length
    # The nearest place of the strip: level with the point, or on its lower edge.
    level = np.clip(s, 0, length)
    on_edge = np.clip((s + z * slope) / (1 + slope**2), 0, length)
    above = z >= level * slope
    ds = s - np.where(above, level, on_edge)
    dz = np.where(above, 0, z - on_edge * slope)
    distance = np.sqrt(ds**2 + dz**2 + q**2)
    gradient = np.stack([ds * along[..., 0] + q * along[..., 1], ds * along[..., 1] - q * along[..., 0], dz], -1)
    return distance - RADIUS, gradient / np.maximum(distance, 1e-300)[..., None]


def faces(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Signed distances (n, 6) of points from the planes of the block's faces, positive outside; normals (6, 3)."""
    return np.concatenate([-points, points - UPPER], 1), np.concatenate([-np.eye(3), np.eye(3)])


def near_groove(points: np.ndarray) -> np.ndarray:
    """Whether a point is so close to the groove that REACH does not cut its distance off: a box about the path."""
    x = np.clip(points[:, 0], 10, 90)
    ways = np.interp(x, centres()[:, 0], centres()[:, 1])
    # The path's slope in y against x is up to 2.25, so square to it is at least 0.4 times as far.
    across = abs(points[:, 1] - ways) < (RADIUS + REACH) / 0.4
    along = abs(points[:, 0] - x) < RADIUS + REACH
    return across & along & (points[:, 2] > 28 - RADIUS - REACH)


def bound(points: np.ndarray) -> np.ndarray:
    """Signed distance (n,) of points from the part, negative inside: exact there; outside no more than the distance,
    and less only beyond edges. Cut off at ±REACH."""
    distance = np.clip(faces(points)[0].max(1), -REACH, REACH)
    close = np.flatnonzero(near_groove(points))
    for part in chunks(close):
        distance[part] = np.maximum(distance[part], np.minimum(-cuts(points[part])[0].min(1), REACH))
    return distance


def from_surface(points: np.ndarray) -> np.ndarray:
    """Distance (n,) of points from the part's surface, for points closer to it than REACH."""
    distance = bound(points)
    for part in chunks(np.flatnonzero(distance > 1e-9)):
        distance[part] = beyond(points[part], distance[part])
    return abs(distance)


def chunks(indices: np.ndarray) -> list[np.ndarray]:
    return np.array_split(indices, len(indices) // 20_000 + 1)


def beyond(points: np.ndarray, least: np.ndarray) -> np.ndarray:
    """How far points outside the part are from it; `least`: their bound.

    A point that breaks one limit alone is as far as that says. The others are near an edge: the nearest point that
    keeps all limits is sought with their tangent planes, which are updated until no limit is broken.
    """
    level, normals = limits(points)
    rows = np.arange(len(points))
    foot = points - least[:, None] * normals[rows, level.argmax(1)]
    edge = np.flatnonzero(limits(foot)[0].max(1) > 1e-9)
    out = least.copy()
    start, at = points[edge], foot[edge]
    for _ in range(50):
        level, normals = limits(at)
        if level.max(initial=0) < 1e-10:
            break
        at = start + shortest(normals, level - np.einsum("nki,ni->nk", normals, at - start))
    out[edge] = np.linalg.norm(at - start, axis=1)
    return out


def limits(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """What the part must keep: values (n, k) that are positive where it is broken, and their gradients (n, k, 3)."""
    planes, normals = faces(points)
    depth, gradient = cuts(points)
    sides = np.broadcast_to(normals, (len(points), 6, 3))
    return np.concatenate([planes, -depth], 1), np.concatenate([sides, -gradient], 1)


def shortest(normals: np.ndarray, level: np.ndarray) -> np.ndarray:
    """The shortest steps x (n, 3) with normals · x + level ≤ 0, by Hildreth's coordinate ascent on the dual (1957)."""
    weight, step = np.zeros_like(level), np.zeros((len(level), 3))
    for _ in range(100):
        before = step.copy()
        for k in range(level.shape[1]):
            change = np.maximum(-weight[:, k], np.einsum("ni,ni->n", normals[:, k], step) + level[:, k])
            weight[:, k] += change
            step -= change[:, None] * normals[:, k]
        if abs(step - before).max(initial=0) < 1e-12:
            break
    return step


def field(pitch: float, margin: int = 2) -> tuple[np.ndarray, np.ndarray]:
    """``bound`` on the lattice of a volume of this pitch and `margin` points around it, float32 (nx, ny, nz), and the
    place of its first point. Exact within four pitches of the surface; further away the sign holds."""
    counts = np.round(UPPER / pitch).astype(int) + 2 * margin
    origin = np.full(3, pitch * (0.5 - margin))
    x, y, z = (origin[k] + pitch * np.arange(counts[k]) for k in range(3))
    sides = [np.maximum(-c, c - top) for c, top in zip((x, y, z), UPPER, strict=True)]
    level = np.maximum(sides[0][:, None], sides[1][None]).astype(np.float32)
    out = np.maximum(level[:, :, None], sides[2].astype(np.float32))
    # The groove, block by block: where it passes far from a block's middle, it passes far from all of it.
    side = max(1, round(1 / pitch))
    band = 4 * pitch + side * pitch * np.sqrt(3) / 2
    first = [np.arange(0, n, side) for n in counts]
    corners = np.stack(np.meshgrid(*first, indexing="ij"), -1).reshape(-1, 3)
    middles = origin + pitch * (corners + (side - 1) / 2)
    corners, middles = corners[near_groove(middles)], middles[near_groove(middles)]
    depth = np.concatenate([-cuts(middles[part])[0].min(1) for part in chunks(np.arange(len(middles)))])
    for i, j, k in corners[depth > band]:
        out[i : i + side, j : j + side, k : k + side] = REACH
    inside = np.stack(np.meshgrid(*[np.arange(side)] * 3, indexing="ij"), -1).reshape(-1, 3)
    close = (corners[abs(depth) <= band][:, None] + inside).reshape(-1, 3)
    close = close[(close < counts).all(1)]
    for part in chunks(np.arange(len(close))):
        i, j, k = close[part].T
        value = -cuts(np.stack([x[i], y[j], z[k]], 1))[0].min(1)
        out[i, j, k] = np.maximum(out[i, j, k], np.minimum(value, REACH))
    return out, origin
