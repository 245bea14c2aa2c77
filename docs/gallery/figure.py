"""An owl, modelled from nothing by strokes that put material on, smooth it, and cut feathers into it.

python docs/gallery/figure.py
"""

from __future__ import annotations

import numpy as np
import riffler
from clay import Sketcher, limb, mirrored, smooth
from common import options
from picture import CLAY, Picture

BOX = (-32, -32, -10), (32, 34, 82)
FEATHER = riffler.Tool.taper(tip_radius=0.35, half_angle=np.radians(38), diameter=4, length=8)


def body(owl: riffler.Volume) -> None:
    limb(owl, [(0, 1, 14), (0, -1, 22), (0, 0, 32), (0, 1, 42)], [13, 17, 17, 14])
    limb(owl, [(0, 8, 14), (0, 17, 3), (0, 19, -1)], [9, 5.5, 4])
    limb(owl, [(-6, -1, 55), (6, -1, 55)], [15, 15])
    for side in (np.asarray, mirrored):
        limb(owl, side([(15, 2, 39), (17, 4, 28), (14, 10, 14), (9, 16, 4)]), [6, 7, 5, 2.5])
        limb(owl, side([(11, -3, 63), (15.5, -3.5, 72), (18, -3, 77)]), [6.5, 3.0, 0.7])


def face(owl: riffler.Volume) -> None:
    for side in (np.asarray, mirrored):
        limb(owl, side([(8.6, -26.0, 54.5)]), [13.2], mode="remove")
        limb(owl, side([(1.0, -17.0, 57.5), (8, -14.5, 64.0), (15.5, -8.0, 69.5)]), [1.5, 2.6, 1.6])
    limb(owl, [(0, -13.5, 57), (0, -17.0, 53), (0, -19.3, 49.0), (0, -18.0, 46.0)], [2.2, 2.8, 2.0, 0.5])


def eyes(owl: riffler.Volume) -> None:
    for side in (np.asarray, mirrored):
        limb(owl, side([(8.2, -10.6, 55.0)]), [5.6])
        pupil = riffler.Tool.ball(4.2, 12)
        tip = side([[8.0, -15.2, 55.0]])
        axis = side([[-0.06, -1.0, 0.05]])
        axis = axis / np.linalg.norm(axis)
        owl.carve(pupil, np.repeat(np.hstack([tip, axis]), 2, axis=0))


def feet(owl: riffler.Volume) -> None:
    for side in (np.asarray, mirrored):
        for toe in (-4.0, 0.0, 4.0):
            limb(
                owl,
                side([(7 + 0.4 * toe, -8, 4.0), (7 + 0.9 * toe, -14, 3.2), (7 + 1.1 * toe, -18, 1.2)]),
                [3, 2.1, 1.1],
            )


def stump(owl: riffler.Volume) -> None:
    owl.carve(riffler.Tool.flat(46, 10), [[0, 0, -9, *(0, 0, 1)]] * 2, mode="add")


def bark(sketch: Sketcher) -> None:
    """Uneven grooves round the stump, from a fixed seed."""
    random = np.random.default_rng(5)
    gouge = riffler.Tool.ball(1.8, 8)
    turn = 0.0
    while turn < 2 * np.pi - 0.06:
        z = np.linspace(0.2, -8.4, 40)
        sway = turn + 0.03 * np.sin(z * random.uniform(0.4, 1.0) + random.uniform(0, 6))
        out = np.column_stack([np.cos(sway), np.sin(sway), np.zeros(len(z))])
        sketch.line(60 * out + np.column_stack([0 * z, 0 * z, z]), -out, gouge, random.uniform(0.4, 1.0), glide=1.0)
        turn += random.uniform(0.07, 0.14)


def scallop(width: float, height: float) -> np.ndarray:
    """(n, 2): a feather's tip, hanging."""
    t = np.linspace(-1, 1, 41)
    return np.column_stack([0.5 * width * np.sin(t * np.pi / 2), -height * np.cos(t * np.pi / 2) ** 0.9])


def feathers(sketch: Sketcher) -> None:
    for row, z in enumerate(np.arange(41.0, 11.0, -3.6)):
        reach = 10.0 - 0.0125 * (z - 26) ** 2
        for x in np.arange(-13.0, 13.1, 5.2) + 2.6 * (row % 2):
            if abs(x) <= reach:
                xz = np.add(scallop(5.0, 3.4), (x, z))
                points = np.column_stack([xz[:, 0], np.full(len(xz), -60.0), xz[:, 1]])
                sketch.line(points, (0, 1, 0), FEATHER, 0.75)
    for side in (np.asarray, mirrored):
        wing(sketch, side)


def wing(sketch: Sketcher, side) -> None:
    """Seen from the side, (y, z): coverts in rows above, long flight feathers below."""
    look = side([[-1.0, 0.0, 0.0]])[0]

    def draw(yz: np.ndarray, depth: float) -> None:
        sketch.line(side(np.column_stack([np.full(len(yz), 60.0), yz])), look, FEATHER, depth)

    for row, z in enumerate((38.5, 34.5, 30.5)):
        for y in np.arange(-2.0, 13.0, 4.2) + 2.1 * (row % 2) + 0.16 * (38 - z):
            draw(np.add(scallop(4.2, 3.0), (y, z)), 0.7)
    t = np.linspace(0, 1, 60)[:, None]
    for k in range(5):
        start, bend, end = np.array(
            [[-1.0 + 3.1 * k, 27.5 + 0.2 * k], [1.5 + 3.0 * k, 18], [9.0 + 1.9 * k, 7.0 + 1.2 * k]]
        )
        draw((1 - t) ** 2 * start + 2 * t * (1 - t) * bend + t**2 * end, 0.85)


def rays(sketch: Sketcher) -> None:
    """The facial discs' fine lines, away from each eye."""
    fine = riffler.Tool.taper(tip_radius=0.2, half_angle=np.radians(30), diameter=3, length=6)
    for side in (np.asarray, mirrored):
        for turn in np.linspace(0, 2 * np.pi, 34, endpoint=False):
            way = np.linspace(6.6, 9.6, 24)[:, None] * np.array([np.cos(turn), np.sin(turn)])
            if way[:, 0].min() < -7.2:
                continue
            points = np.column_stack([8.4 + way[:, 0], np.full(len(way), -60.0), 54.8 + way[:, 1]])
            sketch.line(side(points), (0, 1, 0), fine, 0.4, glide=1.0)


def largest(made: riffler.Volume) -> riffler.Volume:
    """Without the crumbs that thin ridges leave."""
    return max(made.parts(), key=lambda part: part.volume)


def owl(pitch: float) -> riffler.Volume:
    """Coarse clay for the masses, which is smoothed in a moment; finer clay for what is drawn into them."""
    made = riffler.Volume.empty(*BOX, 2.4 * pitch, "xyz")
    body(made)
    smooth(made, radius=5.0, passes=1)
    face(made)
    smooth(made, radius=2.5, passes=1)
    made = largest(made).resample(pitch)
    eyes(made)
    sketch = Sketcher(made)
    feathers(sketch)
    rays(sketch)
    stump(made)  # after the feathers: below, their cutter would reach into stump and feet
    feet(made)
    bark(Sketcher(made))
    return largest(made)


def main() -> None:
    given = options(__doc__)
    made = owl(0.5 if given.fast else 0.25)
    mesh = made.to_mesh()
    print(f"{made.volume:.0f} mm³, {len(mesh.triangles)} triangles")
    if len(made.parts()) != 1 or mesh.audit().open_edges:
        raise SystemExit("the owl is not one closed piece")
    if given.fast:
        return
    picture = Picture()
    picture.mesh(mesh, CLAY)
    view = {"eye": (-95, -250, 90), "target": (0, 0, 33), "floor": -9, "width": 102, "size": (1000, 1000)}
    picture.photograph(given.out / "figure.jpg", given.blender, **view)


if __name__ == "__main__":
    main()
