"""The pictures of docs/concepts.md: rays and surface, the sweep of a move, a cutter in a valley.

python docs/gallery/concepts.py
"""

from __future__ import annotations

import numpy as np
import riffler
from common import options
from picture import BAD, BETWEEN, KEY, PATH, STEEL, WAX, Picture, lathe
from riffler import plan

RAYS = {"x": ((0, 1, 2), (0.80, 0.10, 0.06)), "y": ((1, 2, 0), (0.10, 0.42, 0.08)), "z": ((2, 0, 1), (0.05, 0.12, 0.6))}


def carved(pitch: float, directions: str) -> riffler.Volume:
    """A block with a bent groove, and a hole from the side, which rays from above leave and enter again."""
    block = riffler.Volume.block((0, 0, 0), (36, 28, 20), pitch, directions)
    t = np.linspace(0, 1, 60)[:, None]
    tips = np.hstack([-4 + 44 * t, 8 + 9 * np.sin(3 * t), 13 + 0 * t])
    block.carve(riffler.Tool.ball(8, 30), np.hstack([tips, np.tile([0.0, 0.0, 1.0], (60, 1))]))
    hole = np.array([[28.0, 40, 6, 0, -1, 0], [28.0, 14, 6, 0, -1, 0]])
    block.carve(riffler.Tool.flat(7, 40), hole)
    return block


def rods(volume: riffler.Volume, name: str) -> np.ndarray:
    """The spans of one direction as segments (n, 2, 3)."""
    (along, u, v), _ = RAYS[name]
    counts, spans = volume.intervals(name)
    i, j = np.divmod(np.repeat(np.arange(counts.size), counts.ravel()), counts.shape[1])
    segments = np.empty((len(spans), 2, 3))
    segments[:, :, along] = spans
    segments[:, :, u] = (volume.lower[u] + (i + 0.5) * volume.pitch)[:, None]
    segments[:, :, v] = (volume.lower[v] + (j + 0.5) * volume.pitch)[:, None]
    return segments


def dexels(given) -> None:
    coarse = carved(2.0, "xyz")
    picture, count = Picture(), 0
    view = {"target": (18, 14, 9), "direction": (-0.35, -0.9, 0.75), "width": 150, "size": (1000, 400)}
    beside = np.array([0.9, -0.35, 0.0]) / np.hypot(0.9, 0.35)  # to the right in the picture
    for shown, at in (("z", -49 * beside), ("xyz", 0 * beside)):
        for name in shown:
            for segment in rods(coarse, name):
                picture.curve(segment + at, RAYS[name][1], radius=0.28)
                count += 1
    fine = carved(0.25, "xyz").to_mesh()
    picture.add(fine.vertices + 49 * beside, fine.triangles, WAX, smooth=25)
    print(f"{count} spans drawn, 2 mm apart")
    if not given.fast:
        picture.render(given.out / "concepts-dexels.jpg", given.blender, **view)


def sweep(given) -> None:
    """One move that turns the tool: what it passes through, put on in an empty box."""
    tool = riffler.Tool.fillet(diameter=10, corner_radius=3, length=34)
    axes = np.array([[-0.35, -0.25, 0.9], [0.45, 0.2, 0.87]])
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    poses = np.hstack([[[-18, 0, 0], [18, 4, 3]], axes])
    box = riffler.Volume.empty((-45, -30, -8), (50, 35, 42), 1.0 if given.fast else 0.3, "xyz")
    put = box.carve(tool, poses, mode="add")
    print(f"the move sweeps {put.removed.sum():.0f} mm³")
    if given.fast:
        return
    picture = Picture()
    picture.mesh(box.to_mesh(), WAX, alpha=0.35)
    within = riffler.Tool.fillet(diameter=9.6, corner_radius=2.8, length=33.6)  # not flush with what it sweeps
    for pose in poses:
        picture.tool(within, pose + np.concatenate([0.2 * pose[3:], np.zeros(3)]))
    steps = np.linspace(0, 1, 9)[:, None]
    turned = poses[0, 3:] * (1 - steps) + poses[1, 3:] * steps
    tips = poses[0, :3] * (1 - steps) + poses[1, :3] * steps
    picture.curve(tips, PATH, radius=0.45)
    picture.arrows(poses[:, :3] + 34 * axes, axes, KEY, length=12, radius=0.5)
    turned /= np.linalg.norm(turned, axis=1)[:, None]
    picture.arrows(tips[1:-1], turned[1:-1], BETWEEN, length=38, radius=0.2)
    view = {"target": (2, 2, 20), "direction": (-0.3, -1, 0.35), "width": 108, "size": (1000, 660)}
    picture.render(given.out / "concepts-sweep.jpg", given.blender, **view)


def valley() -> riffler.Mesh:
    """A floor and a wall that leans back, drawn along x."""
    profile = np.array([(-24, -8), (24, -8), (24, 22), (9, 22), (3, 0), (-24, 0)], float)
    ends = [np.column_stack([np.full(6, x), profile]) for x in (-30, 30)]
    caps = np.array([(0, 4, 5), (0, 1, 4), (1, 2, 4), (2, 3, 4)])[:, ::-1]
    sides = [(k, (k + 1) % 6, 6 + k) for k in range(6)] + [((k + 1) % 6, 6 + (k + 1) % 6, 6 + k) for k in range(6)]
    return riffler.Mesh(np.concatenate(ends), np.concatenate([caps, caps[:, ::-1] + 6, sides]))


def contact(given) -> None:
    part = valley()
    (path,) = plan.pencil(part, riffler.Tool.ball(diameter=12, length=30))
    path = path.divided(5.0)
    k = len(path) // 2
    axis = np.array([0.22, -0.45, 0.9])
    axis /= np.linalg.norm(axis)
    print(f"the ball touches {np.linalg.norm(path.contacts[k, 0] - path.contacts[k, 1]):.2f} mm apart")
    if given.fast:
        return
    picture = Picture()
    picture.mesh(part)
    picture.curve(path.centres, PATH, radius=0.3)
    for side in range(2):
        picture.curve(path.contacts[:, side], BAD, radius=0.3)
    tool = riffler.Tool.ball(diameter=12, length=34).with_shank([(34, 4, 44, 4)])
    centre = path.centres[k]
    outline = np.concatenate([outline for _, outline in tool.outline()])
    stands = np.concatenate([centre - path.radius * axis, axis])
    picture.add(*lathe(outline, stands), STEEL, smooth=35, alpha=0.4)
    picture.arrows(path.contacts[k], path.normals[k], BAD, length=13, radius=0.4)
    picture.arrows([centre], [axis], KEY, length=50, radius=0.5)
    picture.arrows([centre], [np.array([1.0, 0, 0])], PATH, length=18, radius=0.4)
    view = {"target": (0, 0, 14), "direction": (0.75, -1, 0.5), "width": 92, "size": (1000, 740)}
    picture.render(given.out / "concepts-contact.jpg", given.blender, **view)


def main() -> None:
    given = options(__doc__)
    dexels(given)
    sweep(given)
    contact(given)


if __name__ == "__main__":
    main()
