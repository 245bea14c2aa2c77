"""One .blend handed from the oldest Blender to the newest: each reads what the last one saved, cuts, and saves."""

from pathlib import Path

import bpy
import numpy as np

import support


def test_the_file_goes_on():
    folder = Path(support.JOB["chain"])
    files = sorted(folder.glob("*.blend"))
    path = folder / f"{len(files)}.blend"
    if not files:
        support.scale(1)
        ob = support.stock()
        support.curve("Line", [(10, 15, 20), (30, 15, 20)], mm_per_unit=1)
    else:
        bpy.ops.wm.open_mainfile(filepath=str(files[-1]))
        ob = bpy.data.objects["Stock"]
        expected = dict(np.load(files[-1].with_suffix(".npz")))
        counts, spans = support.content(ob).volume.intervals("z")
        assert np.array_equal(counts, expected["counts"]) and np.array_equal(spans, expected["spans"])
        assert np.array_equal(support.coordinates(ob.data), expected["co"])
        assert len(support.content(ob).cuts) == ob.data.riffler.cuts == len(files)
        assert support.part("bl.sculpts").shown_mm_per_unit(ob.data) == 1
    bpy.context.view_layer.objects.active = ob
    support.push("opened")
    before = support.content(ob).volume.volume
    depth = 1 + 0.5 * len(files)
    bpy.ops.riffler.cut_curve("EXEC_DEFAULT", True, curve="Line", depth=depth, tool=support.FLAT)
    bpy.ops.ed.undo()
    assert support.content(bpy.data.objects["Stock"]).volume.volume == before
    bpy.ops.ed.redo()
    ob = bpy.data.objects["Stock"]
    counts, spans = support.content(ob).volume.intervals("z")
    np.savez(path.with_suffix(".npz"), counts=counts, spans=spans, co=support.coordinates(ob.data))
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
