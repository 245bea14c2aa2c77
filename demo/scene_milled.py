"""The sculpted figure and the bust that was milled after it, roughed and finished: a .blend and its picture. Runs
inside Blender's Python (bpy).

<blender python> demo/scene_milled.py head.stl roughed.stl milled.stl out/demo/milled.blend out/demo/milled.png
"""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

import bpy
import scene
from mathutils import Vector

HEAD_AT = Vector((-56.0, 16.0, -6.0))
ROUGHED_AT, MILLED_AT = Vector((86.0, 30.0, scene.FLOOR + 46.0)), Vector((28.0, -34.0, scene.FLOOR + 46.0))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name in ("head", "roughed", "milled", "blend", "picture"):
        parser.add_argument(name, type=Path)
    parser.add_argument("--samples", type=int, default=48)
    parser.add_argument("--threads", type=int, default=os.cpu_count() or 2)
    parser.add_argument("--percent", type=int, default=100)
    options = parser.parse_args()

    bpy.ops.wm.read_factory_settings(use_empty=True)
    colours = (0.66, 0.37, 0.15), (0.53, 0.275, 0.105), (0.055, 0.018, 0.007)
    sculpted = scene.new_material("Boxwood", *colours, 0.45, True)
    light, dark, stain = (0.60, 0.42, 0.24), (0.50, 0.33, 0.17), (0.12, 0.055, 0.02)
    cut = scene.new_material("Limewood", light, dark, stain, 0.5, True, hollows=1.5)
    scene.carved(options.head, "Sculpted", HEAD_AT, 6.0, 14.0, sculpted)
    scene.carved(options.roughed, "Roughed", ROUGHED_AT, 0.0, -24.0, cut)
    scene.carved(options.milled, "Milled", MILLED_AT, 0.0, -12.0, cut)
    wood, brass = (scene.plain_material("Dark wood", (0.035, 0.017, 0.010), 0.3),
                   scene.plain_material("Brass", (0.78, 0.53, 0.22), 0.28, 1.0))  # fmt: skip
    scene.stand(HEAD_AT + Vector((0, 3, 0)), -10.0, wood, brass)
    scene.studio(bpy.context.scene, (0.0, -430.0, 135.0), (1.0, 0.0, -24.0), 62.0)
    scene.finish(bpy.context.scene, options)


if __name__ == "__main__":
    main()
    # As in suzanne.py: everything is written, so leave before the module is torn down.
    sys.stdout.flush()
    os._exit(0)
