"""Distances as colours: white for none, blue for too much material, red for too little."""

from __future__ import annotations

import numpy as np

# ColorBrewer's RdBu (Brewer, Harrower, Pennsylvania State University), which colour-blind people can distinguish.
OVER, UNDER = np.array([33, 102, 172]) / 255, np.array([178, 24, 43]) / 255


def of_distance(distance, scale: float) -> np.ndarray:
    """(n, 4) float32, sRGB, of distances (n,) in mm; full colours from `scale` mm on, grey for values that are not
    finite."""
    distance = np.asarray(distance, float)
    out = np.empty((len(distance), 4), np.float32)
    share = np.clip(np.abs(distance) / scale, 0, 1)[:, None]
    out[:, :3] = 1 + share * (np.where(distance[:, None] > 0, OVER, UNDER) - 1)
    out[:, 3] = 1
    out[~np.isfinite(distance), :3] = 0.5
    return out


def legend(scale: float, steps: int = 16) -> tuple:
    """((share, (r, g, b)), …) from −scale to scale, for a bar."""
    shares = np.linspace(0, 1, steps + 1)
    colours = of_distance((2 * shares - 1) * scale, scale)
    return tuple((float(s), tuple(map(float, c[:3]))) for s, c in zip(shares, colours, strict=True))
