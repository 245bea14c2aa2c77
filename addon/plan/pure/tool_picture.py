"""Pictures of tools: a filled outline, as pixels. The axis has a fixed place and direction, so that pictures can be
compared."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

# Red, green, blue: cutting pieces are warm, pieces that must not touch are grey.
COLOURS = {"cutter": (0.93, 0.55, 0.16), "shank": (0.62, 0.64, 0.68), "holder": (0.40, 0.43, 0.48)}
MARGIN = 0.06  # of the picture's side, on each side
FINER = 4  # samples a pixel along each side, for smooth edges


def profile(outline, size: int = 128) -> np.ndarray:
    """RGBA (size, size, 4) float32, `size` even, from the bottom row upwards, in Blender's order: the area inside a
    tool's outline, of riffler.Tool.outline (piece and polyline of radius and height), from the side."""
    points = np.concatenate([line for _, line in outline])
    low, high, wide = points[:, 1].min(), points[:, 1].max(), points[:, 0].max()
    n = size * FINER
    scale = max(high - low, 2 * wide) / (1 - 2 * MARGIN)  # mm a side
    centres = ((np.arange(n) + 0.5) / n - 0.5) * scale
    height, radius = (low + high) / 2 + centres, centres[n // 2 :]
    fine = np.zeros((n, n // 2, 4), np.float32)  # the right half
    for piece, line in outline:
        reach = _reach(line, height)
        inside = radius[None, :] <= reach[:, None]
        fine[inside] = (*COLOURS[piece], 1.0)
        fine[inside, :3] *= _light(radius, reach)[inside][:, None]
    half = fine.reshape(size, FINER, size // 2, FINER, 4).mean(axis=(1, 3))
    covered = half[..., 3:]
    np.divide(half[..., :3], covered, out=half[..., :3], where=covered > 0)  # empty pixels have no colour
    return np.concatenate([half[:, ::-1], half], axis=1)


def _reach(line: np.ndarray, height: np.ndarray) -> np.ndarray:
    """The outline's largest radius at each height; -1 outside it. Flat stretches have no height."""
    reach = np.full(len(height), -1.0)
    for (r0, z0), (r1, z1) in pairwise(line):
        if z0 == z1:
            continue
        t = (height - z0) / (z1 - z0)
        on = (t >= 0) & (t <= 1)
        reach[on] = np.maximum(reach[on], r0 + t[on] * (r1 - r0))
    return reach


def _light(radius: np.ndarray, reach: np.ndarray) -> np.ndarray:
    """Shading of round bodies: darker where the surface turns away."""
    turn = radius[None, :] / np.maximum(reach, 1e-9)[:, None]
    return (0.55 + 0.45 * np.sqrt(np.clip(1 - turn**2, 0, 1))).astype(np.float32)
