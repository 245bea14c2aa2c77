"""The benchmark's scenes: B200's path and random volumes."""

from __future__ import annotations

import math

import numpy as np
import riffler

BLOCK = ([0, 0, 0], [100, 60, 30])


def b200_centres(moves: int = 200) -> np.ndarray:
    a = np.linspace(0, 1, moves + 1)
    return np.stack([10 + 80 * a, 30 + 15 * np.sin(12 * a), 30 - 2 * a], 1)


def b200_poses(tip: float = 3.0) -> np.ndarray:
    c = b200_centres()
    return np.concatenate([c - [0, 0, tip], np.tile([0.0, 0, 1], (len(c), 1))], 1)


def box_mesh(lower, upper) -> riffler.Mesh:
    corners = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)], float)
    vertices = np.asarray(lower) + corners * (np.asarray(upper) - np.asarray(lower))
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return riffler.Mesh(vertices, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])


def random_tool(rng) -> riffler.Tool:
    d = float(rng.uniform(1.5, 6))
    return [
        lambda: riffler.Tool.ball(d, 20),
        lambda: riffler.Tool.flat(d, 20),
        lambda: riffler.Tool.fillet(d, d / 5, 20),
        lambda: riffler.Tool.taper(d / 6, 0.3, d, 30),
        lambda: riffler.Tool.cone_end(0.9, d / 8, 0.4, d, 30),
    ][rng.integers(5)]()


def random_poses(rng, lower, size, pitch, snapped: bool) -> np.ndarray:
    """Two or three poses about the box; on its lattice and axes where `snapped`."""
    poses = []
    for _ in range(rng.integers(2, 4)):
        tip = lower + rng.uniform(-0.15, 1.15, 3) * size
        axis = rng.normal(size=3)
        if snapped:
            tip = lower + np.round((tip - lower) / pitch) * pitch
            axis = np.eye(3)[rng.integers(3)] * rng.choice([-1.0, 1.0])
            if poses:
                axis = poses[0][3:]
        elif poses and rng.random() < 0.5:
            axis = poses[0][3:]
        poses.append(np.concatenate([tip, axis / math.sqrt(axis @ axis)]))
    return np.array(poses)


def random_volume(seed: int, directions: str) -> riffler.Volume:
    """Random cuts, thin walls, coincident and grid-aligned faces, isolated columns, cuts through the border."""
    rng = np.random.default_rng(seed)
    pitch = float(rng.choice([0.25, 0.5, 0.37]))
    size = rng.integers(8, 40, 3) * pitch * rng.choice([1.0, 1.03])
    lower = rng.choice([0.0, -7.3, 1000.0, 1e5]) * rng.uniform(-1, 1, 3)
    volume = riffler.Volume.block(lower, lower + size, pitch, directions)
    frame = {"pitch": pitch, "directions": directions, "lower": lower, "upper": lower + size}
    for _ in range(rng.integers(1, 6)):
        snapped = rng.random() < 0.4
        kind = rng.random()
        if kind < 0.55:
            volume.carve(random_tool(rng), random_poses(rng, lower, size, pitch, snapped), tolerance=0.02)
            continue
        a, b = (lower + rng.uniform(-0.2, 1.2, 3) * size for _ in range(2))
        if snapped:
            a, b = (lower + np.round((p - lower) / pitch) * pitch for p in (a, b))
        if kind > 0.9:  # a wall, thinner than the pitch as often as not
            k = rng.integers(3)
            b[k] = a[k] + pitch * rng.uniform(0.05, 2)
        a, b = np.minimum(a, b), np.maximum(a, b)
        if np.any(b - a <= 0) or np.any(a >= lower + size) or np.any(b <= lower):
            continue
        box = riffler.Volume.from_mesh(box_mesh(a, b), **frame)
        getattr(volume, rng.choice(["subtract", "subtract", "add"]))(box)
    return volume
