"""Times in this Blender: the block of 100 × 60 × 30 mm at a pitch of 0.25 mm, tri-dexel, and 200 moves of a 6 mm ball.

Minima of some runs. `blender_tests/run.py --figures` writes them to out/blender/figures.json.
"""

import time
from pathlib import Path

import bpy
import numpy as np
import riffler

from support import common

RUNS = 5


def best(call, before=lambda: None):
    """Smallest wall time and smallest processor time (of all threads) in ms: the second stays right on a busy
    computer."""
    walls, cpus = [], []
    for _ in range(RUNS):
        before()
        wall, cpu = time.perf_counter(), time.process_time()
        call()
        walls.append(time.perf_counter() - wall)
        cpus.append(time.process_time() - cpu)
    return f"{1000 * min(walls):.1f} (CPU {1000 * min(cpus):.1f})"


def ms(name, call, before=lambda: None):
    common.figure(f"{name}, ms", best(call, before))


def test_figures():
    common.scale(1)
    a = np.linspace(0, 1, 201)
    # the ball's centre of the benchmark block's path is 3 mm above the tip
    path = np.c_[10 + 80 * a, 30 + 15 * np.sin(12 * a), 27 - 2 * a]
    common.curve("Path", path, mm_per_unit=1)

    def new():
        common.stock(size=(100, 60, 30), pitch=0.25, directions="xyz")

    def cut():
        bpy.ops.riffler.cut_curve("EXEC_DEFAULT", True, curve="Path", depth=0, tool=common.BALL)

    def fresh():
        for ob in [o for o in bpy.data.objects if o.name.startswith("Stock")]:
            bpy.data.meshes.remove(ob.data)
        new()

    ms("new stock", new)
    common.push("stock")
    ms("cut of 200 moves, whole operator with its undo step", cut, fresh)

    ob = bpy.context.object
    content = common.content(ob)
    poses, tool = content.cuts[0].poses, riffler.Tool.from_dict(content.cuts[0].tool)
    block = riffler.Volume.block((0, 0, 0), (100, 60, 30), 0.25, "xyz")
    ms("- carve", lambda: block.copy().carve(tool, poses))
    ms("- volume to mesh", content.volume.to_mesh)
    surface = content.volume.to_mesh()
    ms("- fill the mesh", lambda: common.part("sculpt.sculpts").show(ob.data, surface, 1.0))
    ms("- pack into the .blend", lambda: common.part("sculpt.sculpt_store").write(ob.data, content))
    common.figure("triangles", len(surface.triangles))
    common.figure("removed, mm³", round(180000 - content.volume.volume, 3))

    name = ob.name
    bpy.ops.ed.undo()
    undo_times(name)
    path = common.out("figures.blend")
    ms("save", lambda: bpy.ops.wm.save_as_mainfile(filepath=path, compress=False))
    common.figure(".blend, MB", round(Path(path).stat().st_size / 1e6, 2))
    image = bpy.data.objects[name].data.riffler.store
    common.figure("- of it the volume and the cuts, MB", round(image.packed_file.size / 1e6, 2))
    ms("open", lambda: bpy.ops.wm.open_mainfile(filepath=path))
    ob = bpy.data.objects[name]
    ms(
        "first read of the volume after opening",
        lambda: common.content(ob),
        common.part("sculpt.sculpt_store").clear_cache,
    )
    ms("export STL", lambda: export(ob))


def undo_times(name):
    ms("undo", bpy.ops.ed.undo, bpy.ops.ed.redo)
    ms("redo", bpy.ops.ed.redo, bpy.ops.ed.undo)
    assert common.content(bpy.data.objects[name]).cuts


def export(ob):
    bpy.context.view_layer.objects.active = ob
    bpy.ops.riffler.export_stl(filepath=common.out("figures.stl"))
