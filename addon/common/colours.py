"""Values as colours: distances (white for none, blue for too much material, red for too little), places in a sequence,
and numbers of tools."""

from __future__ import annotations

import numpy as np

# ColorBrewer's RdBu (Brewer, Harrower, Pennsylvania State University), which colour-blind people can distinguish.
OVER, UNDER = np.array([33, 102, 172]) / 255, np.array([178, 24, 43]) / 255

# From the first to the last: blue, grey, yellow.
SEQUENCE = np.array([[0, 32, 77], [124, 123, 120], [255, 233, 69]]) / 255
# Okabe and Ito, "Color Universal Design", 2002, without black.
KINDS = np.array(
    [[230, 159, 0], [86, 180, 233], [0, 158, 115], [240, 228, 66], [0, 114, 178], [213, 94, 0], [204, 121, 167]]
) / 255  # fmt: skip
NONE = 0.8  # grey


def of_sequence(places, count: int) -> np.ndarray:
    """(n, 4) float32, sRGB, of places (n,) from 0 to `count` − 1; light grey for −1."""
    places = np.asarray(places)
    share = np.clip(places / max(count - 1, 1), 0, 1)
    rgb = [np.interp(share, (0, 0.5, 1), SEQUENCE[:, k]) for k in range(3)]
    return _or_none(np.stack(rgb, axis=1), places >= 0)


def of_kinds(numbers) -> np.ndarray:
    """(n, 4) float32, sRGB, of numbers (n,): equal colours for equal numbers; light grey for −1."""
    numbers = np.asarray(numbers)
    _, order = np.unique(np.append(numbers, -1), return_inverse=True)
    return _or_none(KINDS[(order[:-1] - 1) % len(KINDS)], numbers >= 0)


def _or_none(rgb, some):
    out = np.full((len(rgb), 4), NONE, np.float32)
    out[some, :3] = rgb[some]
    out[:, 3] = 1
    return out


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
