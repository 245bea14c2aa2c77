"""One .blend passed from the oldest Blender to the newest: each reads the file of the last one, cuts, sets a key
orientation on the timeline, and saves."""

from pathlib import Path

import bpy
import numpy as np

from support import common, plans
from support.keyframed_plan import close, indices, insert, pair, paths, remove, seen, state


def test_each_blender_continues_the_file_of_the_one_before():
    folder = Path(common.JOB["chain"])
    files = sorted(folder.glob("*.blend"))
    path = folder / f"{len(files)}.blend"
    if not files:
        common.scale(1)
        ob = common.stock()
        common.curve("Line", [(10, 15, 20), (30, 15, 20)], mm_per_unit=1)
    else:
        bpy.ops.wm.open_mainfile(filepath=str(files[-1]))
        ob = bpy.data.objects["Stock"]
        expected = dict(np.load(files[-1].with_suffix(".npz")))
        counts, spans = common.content(ob).volume.intervals("z")
        assert np.array_equal(counts, expected["counts"]) and np.array_equal(spans, expected["spans"])
        assert np.array_equal(common.coordinates(ob.data), expected["co"])
        assert len(common.content(ob).cuts) == ob.data.riffler.cuts == len(files)
        assert common.part("sculpt.sculpts").shown_mm_per_unit(ob.data) == 1
    bpy.context.view_layer.objects.active = ob
    common.push("opened")
    before = common.content(ob).volume.volume
    depth = 1 + 0.5 * len(files)
    bpy.ops.riffler.cut_curve("EXEC_DEFAULT", True, curve="Line", depth=depth, tool=common.FLAT)
    bpy.ops.ed.undo()
    assert common.content(bpy.data.objects["Stock"]).volume.volume == before
    bpy.ops.ed.redo()
    ob = bpy.data.objects["Stock"]
    counts, spans = common.content(ob).volume.intervals("z")
    np.savez(path.with_suffix(".npz"), counts=counts, spans=spans, co=common.coordinates(ob.data))
    bpy.ops.wm.save_as_mainfile(filepath=str(path))


def test_each_blender_continues_the_timeline_of_the_one_before():
    """A separate file: the next Blender has the keys and the animation that the last one wrote."""
    folder = Path(common.JOB["chain"]) / "timeline"
    folder.mkdir(exist_ok=True)
    files = sorted(folder.glob("*.blend"))
    if not files:
        name = plans.on_timeline(chosen=plans.paths()[:1]).name
    else:
        name = "Riffler Plan"
        bpy.ops.wm.open_mainfile(filepath=str(files[-1]))
        ob, expected = bpy.data.objects[name], dict(np.load(files[-1].with_suffix(".npz")))
        assert indices(ob)[0] == expected["points"].tolist() and not state(ob).problems
        assert np.array_equal(paths(ob)[0].axes, expected["axes"])
        tip, axis = seen(ob, 33.3)
        assert close(tip, expected["tip"], 1e-4) and close(axis, expected["axis"])
    ob, frame = bpy.data.objects[name], 20 + 20 * len(files)
    insert(pair(ob)[0], frame, (0.1 * len(files), -0.2, 1))
    assert frame - 1 in indices(ob)[0] and state(ob).changes[0].added == [frame - 1]
    insert(pair(ob)[0], 140, (0, 0, 1))
    remove(pair(ob)[0], 140)
    assert indices(ob)[0] == [0, *range(19, frame, 20), 144] and state(ob).difference.small
    tip, axis = seen(ob, 33.3)
    path = folder / f"{len(files)}.blend"
    points = np.array(indices(ob)[0])
    np.savez(path.with_suffix(".npz"), axes=paths(ob)[0].axes, points=points, tip=tip, axis=axis)
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
