"""Parts made in code, closed and torn, about 100 mm across: the surface of a cube in squares of two triangles, bent."""

from __future__ import annotations

import numpy as np
from riffler import Mesh

CORNERS = 16  # of the star


def cube(n: int) -> tuple[np.ndarray, np.ndarray]:
    """Lattice points (v, 3) on the surface of a cube of n × n × n, and 12 n² triangles, seen from outside."""
    i, j = (a.ravel() for a in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
    places, quads = [], 0
    for axis in range(3):
        for side in (0, n):
            ring = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
            for a, b in ring if side else ring[::-1]:
                p = np.empty((n * n, 3), int)
                p[:, axis], p[:, (axis + 1) % 3], p[:, (axis + 2) % 3] = side, a, b
                places.append(p)
            quads += n * n
    keys = np.concatenate(places) @ [(n + 1) ** 2, n + 1, 1]
    unique, index = np.unique(keys, return_inverse=True)
    corner = index.reshape(6, 4, n * n)
    triangles = np.concatenate([corner[:, [0, 1, 2]], corner[:, [0, 2, 3]]]).transpose(0, 2, 1).reshape(-1, 3)
    points = np.stack([unique // (n + 1) ** 2, unique // (n + 1) % (n + 1), unique % (n + 1)], 1)
    return points, triangles


def organic(triangles: int) -> Mesh:
    """A pebble with bumps of three sizes and a dent."""
    n = round((triangles / 12) ** 0.5)
    points, faces = cube(n)
    away = np.tan((points / n - 0.5) * (np.pi / 2))  # nearly even on the sphere
    away /= np.linalg.norm(away, axis=1)[:, None]
    x, y, z = away.T
    radius = 45 + 4 * np.sin(4 * x + 1) * np.sin(5 * y) + 1.5 * np.sin(13 * y + 2) * np.sin(11 * z)
    radius += 0.3 * np.sin(41 * x) * np.sin(37 * z) - 12 * np.exp(-12 * ((x - 0.7) ** 2 + (y - 0.5) ** 2))
    return Mesh(radius[:, None] * away, faces)


def torn(mesh: Mesh, holes: int) -> Mesh:
    """A mesh without `holes` of its triangles, here and there."""
    keep = np.ones(len(mesh.triangles), bool)
    keep[np.random.default_rng(1).choice(len(keep), holes, replace=False)] = False
    return Mesh(mesh.vertices, np.asarray(mesh.triangles)[keep])


def halved(mesh: Mesh) -> Mesh:
    """What a mesh has on one side of an oblique plane."""
    vertices, triangles = np.asarray(mesh.vertices), np.asarray(mesh.triangles)
    side = vertices[triangles].mean(1) @ [0.6, 0.3, 0.742]
    return Mesh(vertices, triangles[side < np.median(side)])


def sharp(triangles: int) -> Mesh:
    """A star of 16 corners in three storeys: flat walls, upright, flat ledges, sharp edges."""
    n = 8 * round((triangles / 12) ** 0.5 / 8)
    points, faces = cube(n)
    x, y = (2 * points[:, k] - n for k in (0, 1))
    ring = np.maximum(abs(x), abs(y))  # 0 in the middle, n on the cube's sides
    # How far along the square's border, from 0 to 8 · ring: 16 corners of the star at equal distances.
    along = np.select([x == ring, y == ring, x == -ring], [y, 2 * ring - x, 4 * ring - y], 6 * ring + x) + ring
    share = np.where(ring > 0, along / np.maximum(8 * ring, 1), 0) % 1 * CORNERS
    corner, between = np.floor(share).astype(int), share % 1
    angle = 2 * np.pi * np.arange(CORNERS + 1) / CORNERS
    star = np.where(np.arange(CORNERS + 1) % 2, 34, 50)[:, None] * np.stack([np.cos(angle), np.sin(angle)], 1)
    outline = star[corner] + between[:, None] * (star[corner + 1] - star[corner])
    # Storeys: two layers of points at one height make a ledge.
    third, level = n // 3, points[:, 2]
    storey = (level > third).astype(int) + (level > 2 * third)
    height = (level - storey) * 60 / (n - 2)
    scale = np.array([1, 0.8, 0.55])[storey]
    return Mesh(np.concatenate([(scale * ring / n)[:, None] * outline, height[:, None]], 1), faces)
