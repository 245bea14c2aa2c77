"""A sole-like part, simulated: finished with a large ball, and after the pencil cuts with a small one.

python docs/gallery/sole.py
"""

from __future__ import annotations

import numpy as np
import parts
import riffler
from common import TOOL, keys_from_maps, options
from picture import Picture
from riffler import plan

FINISHER = riffler.Tool.ball(diameter=12, length=60)


def finish(stock: riffler.Volume, part: riffler.Mesh, step: float) -> None:
    """Three-axis rows: the tool comes down on the part at every point."""
    lower, upper = np.asarray(part.bounds)
    x = np.arange(lower[0] - 7, upper[0] + 7, step)
    rows = []
    for k, y in enumerate(np.arange(lower[1] - 7, upper[1] + 7, step)):
        at = np.column_stack([x[:: -1 if k % 2 else 1], np.full(len(x), y), np.zeros(len(x))])
        heights, _ = plan.drop(at, FINISHER, part)
        at[:, 2] = np.where(np.isnan(heights), lower[2] - 1, heights)
        rows.append(np.hstack([at, np.tile([0.0, 0, 1], (len(at), 1))]))
    stock.carve(FINISHER, np.concatenate(rows))


def main() -> None:
    given = options(__doc__)
    part = parts.sole(200 if given.fast else 640)
    lower, upper = np.asarray(part.bounds)
    stock = riffler.Volume.block(lower, upper + np.array([0, 0, 1]), 1.0 if given.fast else 0.25, "xyz")
    finish(stock, part, 3.0 if given.fast else 0.5)
    before = stock.snapshot()
    left = stock.volume

    collider = riffler.Collider(part)
    for path in plan.pencil(part, TOOL):
        oriented = path.orient(keys_from_maps(path, collider, count=16), interpolation="smooth")
        cl, report = plan.cutter_locations(oriented, TOOL, collider)
        if not report.ok:
            raise SystemExit(f"a path is not free: {report}")
        stock.carve(TOOL, cl)
        print(
            f"{path.length:.1f} mm of pencil cut, {len(cl)} locations, rest material {left - stock.volume:.0f} mm³ less"
        )
    if given.fast:
        return
    after = stock.to_mesh()
    stock.restore(before)
    for name, mesh in (("before", stock.to_mesh()), ("after", after)):
        picture = Picture()
        picture.mesh(mesh, smooth=0)
        view = {"target": (0, 0, 6), "direction": (-0.6, -0.75, 0.9)}
        picture.render(given.out / f"sole-{name}.jpg", given.blender, width=170, **view)
        picture.render(given.out / f"sole-{name}-close.jpg", given.blender, target=(-60, -8, 8),
                       direction=(-0.1, -0.75, 0.75), width=46)  # fmt: skip


main()
