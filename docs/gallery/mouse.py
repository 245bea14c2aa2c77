"""Pencil cuts on a mouse-like part: the paths, with parallel passes, and orientations interpolated between a few keys.

python docs/gallery/mouse.py
"""

from __future__ import annotations

import parts
import riffler
from common import TOOL, depths, draw_orientations, keys_from_maps, options
from picture import BETWEEN, PATH, Picture
from riffler import plan


def main() -> None:
    given = options(__doc__)
    part = parts.mouse(160 if given.fast else 480)
    paths = plan.pencil(part, TOOL)
    print(
        f"{len(paths)} paths, " + ", ".join(f"{p.length:.2f} mm" for p in paths) + f"; rest {paths.rest_area:.0f} mm²"
    )

    collider = riffler.Collider(part)
    picture = Picture()
    picture.mesh(part)
    for path in paths:
        keys = keys_from_maps(path, collider)
        oriented = path.orient(keys, interpolation="smooth")
        cl, report = plan.cutter_locations(oriented, TOOL, collider)
        print(
            f"{len(keys)} keys, {len(path)} points: {report}; deepest before {depths(oriented, collider).max():.4f} mm"
        )
        if not report.ok:
            raise SystemExit("a path is not free")
        draw_orientations(picture, oriented, keys)
        for row in (0, len(cl) // 3, 2 * len(cl) // 3)[: 1 if path is paths[0] else 0]:
            picture.tool(TOOL, cl[row], holder=False)
    if given.fast:
        return
    view = {"target": (0, 0, 10), "direction": (-0.5, -0.85, 0.8)}
    picture.render(given.out / "mouse-orientations.jpg", given.blender, width=165, **view)
    picture = Picture()
    picture.mesh(part)
    for path in plan.pencil(part, TOOL, passes=3, stepover=1.5):
        single = (path.contacts[:, 0] == path.contacts[:, 1]).all()
        picture.curve(path.centres, BETWEEN if single else PATH, radius=0.2 if single else 0.4, closed=path.closed)
    picture.render(given.out / "mouse-paths.jpg", given.blender, width=135, **view)


main()
