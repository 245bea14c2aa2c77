"""A tool's shape as triangles."""

from __future__ import annotations

import numpy as np


def solid(outline, sides: int = 32) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (n, 3) and triangles (k, 3) of the surface that a tool's outline (riffler.Tool.outline)
    sweeps about z."""
    vertices, triangles = [], []
    angle = 2 * np.pi * np.arange(sides) / sides
    a, b = np.arange(sides), (np.arange(sides) + 1) % sides
    first = 0
    for _, line in outline:
        for radius, height in line:
            vertices.append(np.c_[radius * np.cos(angle), radius * np.sin(angle), np.full(sides, height)])
        for k in range(len(line) - 1):
            low, high = first + k * sides, first + (k + 1) * sides
            if line[k][0] > 0:
                triangles.append(np.c_[low + a, low + b, high + b])
            if line[k + 1][0] > 0:
                triangles.append(np.c_[low + a, high + b, high + a])
        first += len(line) * sides
    return np.concatenate(vertices), np.concatenate(triangles)
