"""The other stock: an egg on whose blunt end the strokes of the head's dome lie."""

from __future__ import annotations

import numpy as np

# The ellipsoid that the word, the circlet and the whorl fit best (least squares, residuals within 0.9 mm but for the
# end of the flourish): centre and half axes in mm, turned about x. Its lower half is drawn out to an egg.
CENTRE = np.array([0.0, 4.5, 10.1])
HALF_AXES = np.array([40.0, 31.2, 34.0])
TURN = -0.34
LOWER = 50.0  # mm, the half axis of the pointed end
SKIN = 0.7  # mm of stock above the fitted ellipsoid


def build(rings: int = 160, sectors: int = 320) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (n, 3) in mm and triangles (k, 3) of a closed surface, counter-clockwise seen from outside."""
    polar = np.linspace(0.0, np.pi, rings + 1)[1:-1, None]
    around = 2 * np.pi * np.arange(sectors)[None] / sectors
    grid = np.stack(np.broadcast_arrays(np.sin(polar) * np.cos(around), np.sin(polar) * np.sin(around), np.cos(polar)))
    ball = np.concatenate([grid.reshape(3, -1).T, [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]])
    egg = ball * (HALF_AXES + SKIN)
    egg[:, 2] = np.where(ball[:, 2] < 0.0, ball[:, 2] * LOWER, egg[:, 2])
    c, s = np.cos(TURN), np.sin(TURN)
    vertices = egg @ np.array([[1.0, 0.0, 0.0], [0.0, c, s], [0.0, -s, c]]) + CENTRE

    ring, sector = np.meshgrid(np.arange(rings - 2), np.arange(sectors), indexing="ij")
    a, b = ring * sectors + sector, ring * sectors + (sector + 1) % sectors
    bands = np.concatenate([np.stack([a, a + sectors, b], -1), np.stack([b, a + sectors, b + sectors], -1)])
    here, there = np.arange(sectors), (np.arange(sectors) + 1) % sectors
    top, bottom, last = len(ball) - 2, len(ball) - 1, (rings - 2) * sectors
    lid = np.stack([np.full(sectors, top), here, there], -1)
    base = np.stack([np.full(sectors, bottom), last + there, last + here], -1)
    return vertices, np.concatenate([bands.reshape(-1, 3), lid, base]).astype(np.int32)
