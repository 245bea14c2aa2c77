"""A name engraved into a curved plate, and the same strokes with another tool in a second one.

python docs/gallery/characters.py
"""

from __future__ import annotations

import sys

import numpy as np
import riffler
import riffler.shape
from common import options
from picture import CLAY, PLASTER, ROOT, Picture
from riffler import plan

sys.path.insert(0, str(ROOT))

from demo import font

SIZE = np.array([116.0, 44.0])  # mm
CAP = 17.0  # mm, height of the letters
TOOLS = {
    "clay": riffler.Tool.taper(tip_radius=0.3, half_angle=np.radians(40), diameter=6, length=12),
    "plaster": riffler.Tool.ball(diameter=3.2, length=12),
}
DEPTHS = {"clay": 1.8, "plaster": 1.3}


def plate(points: int) -> riffler.Mesh:
    """A slab with a top that rises to the middle and waves along it, its corners rounded."""
    u, v = np.meshgrid(np.linspace(-1, 1, points), np.linspace(-1, 1, points), indexing="ij")
    top = np.stack([u * SIZE[0] / 2, v * SIZE[1] / 2, 5.5 * (1 - 0.45 * v**2) - 1.6 * u**2 + 0.9 * np.sin(3 * u)], 2)
    bottom = top.copy()
    bottom[:, :, 2] = -5.0
    return riffler.shape.slab(top, bottom)


def strokes() -> list[np.ndarray]:
    """The word's strokes (n, 3) over the plate, and a line round them."""
    out = []
    for _, xy in font.write(["R", "I", "F", "F", "L", "E", "R~"]):
        x, y = CAP * xy[:, 0], CAP * (xy[:, 1] - 0.40)
        out.append(np.column_stack([x, y, np.full(len(x), 5.0)]))
    t = np.linspace(0, 2 * np.pi, 721)
    half, power = SIZE / 2 - 3.6, 2 / 9
    x = half[0] * np.sign(np.cos(t)) * abs(np.cos(t)) ** power
    y = half[1] * np.sign(np.sin(t)) * abs(np.sin(t)) ** power
    return [*out, np.column_stack([x, y, np.full(len(t), 5.0)])]


def onto(part: riffler.Mesh, curves: list[np.ndarray]) -> list[np.ndarray]:
    """The curves brought down on the part along z."""
    needle = riffler.Tool.ball(diameter=0.02, length=1)
    laid = []
    for curve in curves:
        heights, _ = plan.drop(curve * [1, 1, 0] + [0, 0, 60], needle, part, axis=(0, 0, 1))
        laid.append(np.column_stack([curve[:, :2], heights]))
    return laid


def engraved(part: riffler.Mesh, name: str, pitch: float) -> riffler.Volume:
    volume = riffler.Volume.from_mesh(part, pitch, "xyz")
    for found in plan.engrave(onto(part, strokes()), TOOLS[name], part, depth=DEPTHS[name]):
        volume.carve(TOOLS[name], found.poses)
    return volume


def main() -> None:
    given = options(__doc__)
    part = plate(61 if given.fast else 161)
    picture = Picture()
    for name, colour, place in (("clay", CLAY, (0, 29, 0)), ("plaster", PLASTER, (0, -29, 0))):
        volume = engraved(part, name, 0.5 if given.fast else 0.2)
        mesh = volume.to_mesh()
        print(f"{name}, {TOOLS[name].name}: {part.volume - volume.volume:.0f} mm³ removed")
        if mesh.audit().open_edges:
            raise SystemExit("the plate is not closed")
        picture.add(mesh.vertices + place, mesh.triangles, colour, smooth=32)
    if not given.fast:
        view = {"eye": (-35, -215, 250), "target": (0, -5, 0), "floor": -5, "width": 146, "size": (1000, 760)}
        picture.photograph(given.out / "characters.jpg", given.blender, **view)


if __name__ == "__main__":
    main()
