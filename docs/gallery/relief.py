"""A sunflower in relief: heights in closed form, milled out of a block row by row by a ball end dropped on them.

python docs/gallery/relief.py
"""

from __future__ import annotations

import numpy as np
import riffler
import riffler.shape
from common import options
from picture import PLASTER, Picture
from riffler import plan

SIZE, DEPTH, GROUND = 80.0, 6.0, 8.0  # mm: side, height of the relief, thickness of the block below it
GOLDEN = np.pi * (3 - np.sqrt(5))


def petals(x: np.ndarray, y: np.ndarray, count: int, inner: float, outer: float, turn: float) -> np.ndarray:
    """Heights, 0 to 1, of a ring of pointed petals, each hollow along its middle."""
    r, angle = np.hypot(x, y), np.arctan2(y, x) + turn
    aside = (angle * count / (2 * np.pi) + 0.5) % 1 - 0.5
    along = np.clip((r - inner) / (outer - inner), 0, 1)
    half = 0.62 * np.clip(1 - along**2.6, 0, 1) ** 0.75
    across = np.abs(aside) / np.maximum(half, 1e-9)
    rise = 0.55 + 0.45 * np.sin(np.pi * (0.15 + 0.75 * along))
    vein = 0.10 * np.exp(-((aside / 0.05) ** 2)) + 0.05 * np.cos(across * np.pi * 3) * along
    leaf = rise * np.sqrt(np.clip(1 - across**2.2, 0, 1)) - vein
    return np.where((across < 1) & (r > inner) & (r < outer), leaf, 0.0)


def seeds(x: np.ndarray, y: np.ndarray, radius: float, count: int) -> np.ndarray:
    """Heights of a dome of seeds, placed as sunflowers do it: each turned by the golden angle from the one before."""
    number = np.arange(count)
    distance, angle = radius * np.sqrt((number + 0.5) / count), number * GOLDEN
    high = np.zeros_like(x)
    for d, a in zip(distance, angle, strict=True):
        reach = 0.62 * radius * np.sqrt(np.pi / count) * (0.85 + 0.25 * d / radius)
        off = np.hypot(x - d * np.cos(a), y - d * np.sin(a)) / reach
        bump = 0.22 * np.sqrt(np.clip(1 - off**2, 0, 1))
        high = np.maximum(high, np.where(off < 1, bump, 0.0))
    r = np.hypot(x, y)
    dome = 0.62 + 0.16 * np.cos(np.pi * r / radius * 0.9)
    return np.where(r < radius * 1.03, dome + high, 0.0)


def sunflower(points: int) -> np.ndarray:
    """Heights (points, points), 0 to 1, over a square from -1 to 1."""
    x, y = np.meshgrid(*[np.linspace(-1, 1, points)] * 2)
    r = np.hypot(x, y)
    flower = np.maximum(
        0.62 * petals(x, y, 17, 0.25, 0.82, np.pi / 17),
        0.92 * petals(x, y, 17, 0.25, 0.74, 0.0) * (r > 0.3),
    )
    flower = np.maximum(flower, seeds(x, y, 0.34, 233))
    rim = 0.75 * np.exp(-(((r - 0.93) / 0.028) ** 4))
    beads = (np.arctan2(y, x) * 72 / (2 * np.pi)) % 1 - 0.5
    pearl = 0.26 * np.sqrt(np.clip(1 - (beads / 0.42) ** 2 - ((r - 0.868) / 0.030) ** 2, 0, 1))
    return np.clip(np.maximum(np.maximum(flower, rim), pearl), 0, 1)


def milled(part: riffler.Mesh, tool: riffler.Tool, stepover: float, pitch: float) -> tuple[riffler.Volume, int]:
    """A block that the tool cut in rows to and fro, at the height where it first touches the part."""
    block = riffler.Volume.block((0, 0, -GROUND), (SIZE, SIZE, DEPTH), pitch, "xyz")
    lines = np.arange(0.0, SIZE + 1e-9, stepover)
    x, y = np.meshgrid(np.arange(0.0, SIZE + 1e-9, stepover), lines)
    x[1::2] = x[1::2, ::-1]
    points = np.column_stack([x.ravel(), y.ravel(), np.full(x.size, 50.0)])
    heights, _ = plan.drop(points, tool, part, axis=(0, 0, 1))
    points[:, 2] = np.where(np.isnan(heights), 0.0, heights)
    block.carve(tool, np.hstack([points, np.tile([0.0, 0.0, 1.0], (len(points), 1))]))
    return block, len(points) - 1


def main() -> None:
    given = options(__doc__)
    part = riffler.shape.relief(sunflower(161 if given.fast else 641), (SIZE, SIZE), DEPTH, sink=1.0)
    tool = riffler.Tool.ball(diameter=1.0, length=12)
    block, moves = milled(part, tool, 1.0 if given.fast else 0.2, 0.5 if given.fast else 0.2)
    mesh = block.to_mesh()
    print(f"{moves} moves, {block.volume:.0f} mm³ left, {len(mesh.triangles)} triangles")
    if mesh.audit().open_edges:
        raise SystemExit("the relief is not closed")
    if given.fast:
        return
    picture = Picture()
    picture.mesh(mesh, PLASTER, smooth=40)
    view = {"eye": (10, -150, 215), "target": (40, 38, 0), "floor": -GROUND, "width": 104, "size": (1000, 800)}
    picture.photograph(given.out / "relief.jpg", given.blender, **view)


if __name__ == "__main__":
    main()
