"""What the gallery's scripts share: their command line, the tool, orientations at a few keys."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import riffler
from picture import BETWEEN, KEY, PATH, ROOT, Picture
from riffler import plan

TOOL = (
    riffler.Tool.ball(diameter=6, length=22)
    .with_shank([(22, 3, 34, 3), (34, 3, 42, 8)])
    .with_holder([(42, 13, 70, 16)])
    .named("ball 6")
)


@dataclass
class Options:
    out: Path
    blender: Path
    fast: bool


def options(about: str) -> Options:
    parser = argparse.ArgumentParser(description=about.splitlines()[0])
    parser.add_argument("--out", type=Path, default=ROOT / "docs/images/gallery", help="folder of the pictures")
    parser.add_argument("--blender", type=Path, default=ROOT / ".envs/bpy-4.5/bin/python", help="a Python with bpy")
    parser.add_argument("--fast", action="store_true", help="coarser, and no pictures")
    given = parser.parse_args()
    return Options(given.out, given.blender, given.fast)


def keys_from_maps(path, collider, *, count: int = 8, tool=TOOL) -> dict[int, np.ndarray]:
    """Orientations at a few points of the path: those that the map of free orientations suggests."""
    points = np.linspace(0, len(path), count, endpoint=not path.closed, dtype=int).clip(0, len(path) - 1)
    angles = np.radians(np.linspace(-60, 60, 17))
    maps = plan.free_orientations(path, tool, collider, index=points, inclinations=angles, tilts=angles)
    for found in maps:
        if found.suggestion is None:
            raise SystemExit(f"point {found.index}: {found.reason}")
    return {found.index: found.suggestion for found in maps}


def draw_orientations(picture: Picture, path, keys: dict[int, np.ndarray], *, every: int = 6) -> None:
    """Keys in cyan, what is interpolated between them in blue."""
    rows = np.arange(0, len(path), every)
    rows = rows[~np.isin(rows, list(keys))]
    picture.curve(path.centres, PATH, closed=path.closed)
    picture.arrows(path.centres[rows], path.axes[rows], BETWEEN, length=9, radius=0.16)
    picture.arrows(path.centres[list(keys)], np.array(list(keys.values())), KEY, length=14, radius=0.4)


def depths(path, collider, tool=TOOL) -> np.ndarray:
    """mm by which the tool enters part or fixtures at each point, if it stands where the path wants it."""
    tips = path.centres - path.radius * path.axes
    return np.array([collider.query(tool, pose).depth for pose in np.hstack([tips, path.axes])])
