"""The mouse-like part in a vise: orientations found without the jaws enter them, the corrected ones do not.

python docs/gallery/mouse_fixtures.py
"""

from __future__ import annotations

import numpy as np
import parts
import riffler
from common import TOOL, depths, draw_orientations, keys_from_maps, options
from picture import BAD, FIXTURE, Picture
from riffler import plan

VIEW = {"target": (0, 0, 22), "direction": (-0.45, -0.8, 0.75), "width": 190}


def show(given, name: str, part, fixtures, cl, oriented, keys, entered: np.ndarray) -> None:
    picture = Picture()
    picture.mesh(part)
    for fixture in fixtures:
        picture.mesh(fixture.to_mesh(), FIXTURE)
    draw_orientations(picture, oriented, keys)
    for row in np.linspace(0, len(cl), 6, endpoint=False, dtype=int):
        picture.tool(TOOL, cl[row], colour=BAD if entered[row] > 0.01 else None)
    picture.render(given.out / f"{name}.jpg", given.blender, **VIEW)


def main() -> None:
    given = options(__doc__)
    part, fixtures = parts.mouse(160 if given.fast else 480), parts.vise()
    alone, all_of_it = riffler.Collider(part), riffler.Collider(part, fixtures=fixtures)
    path = max(plan.pencil(part, TOOL), key=lambda p: p.length)

    # Each point's middle between wall and plate: a good axis, where nothing else stands.
    lean = {
        k: sum(path.normals[k]) / np.linalg.norm(sum(path.normals[k])) for k in range(0, len(path), len(path) // 12)
    }
    first = path.orient(lean, interpolation="smooth")
    entered = depths(first, all_of_it)
    print(f"without the vise: {depths(first, alone).max():.4f} mm deep; with it {entered.max():.2f} mm, ", end="")
    print(f"{(entered > 0.01).sum()} of {len(path)} points")
    if not entered.max() > 1:
        raise SystemExit("the vise should collide")
    tips = np.hstack([first.centres - first.radius * first.axes, first.axes])

    # Keys stay 2 mm from the vise, so that what is interpolated between them does not enter it.
    keys = keys_from_maps(path, riffler.Collider(part, fixtures=parts.vise(2.0)), count=24)
    corrected = path.orient(keys, interpolation="smooth")
    cl, report = plan.cutter_locations(corrected, TOOL, all_of_it)
    print(f"corrected: {report}, nowhere deeper than {-report.bound:.4f} mm")
    if not report.ok or len(report.lifted):
        raise SystemExit("the corrected path is not free")
    if not given.fast:
        show(given, "mouse-vise-before", part, fixtures, tips, first, lean, entered)
        show(given, "mouse-vise-after", part, fixtures, cl, corrected, keys, np.zeros(len(cl)))


main()
