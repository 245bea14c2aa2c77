"""Kept strokes: curves that a sculpt follows, their list, undo, files, and what is refused."""

import json
from pathlib import Path

import bpy
import numpy as np
import riffler

from support import common

SIZE, PIXEL = (400, 300), 0.1  # mm


def part(name):
    return common.part(f"sculpt.{name}")


def stroke(*places, **more):
    """A stroke through places on the top of the stock (mm), seen from above."""
    matrix = np.diag([2 / (SIZE[0] * PIXEL), 2 / (SIZE[1] * PIXEL), -0.01, 1.0])
    matrix[:3, 3] = -(matrix[:3, :3] @ np.array([20.0, 15, 0]))
    rows = [[0.5 * SIZE[0] + (x - 20) / PIXEL, 0.5 * SIZE[1] + (y - 15) / PIXEL] for x, y in places]
    view = {"matrix": matrix.ravel().tolist(), "size": list(SIZE)}
    text = json.dumps({"view": view, "rows": rows})
    return bpy.ops.riffler.stroke("EXEC_DEFAULT", True, stroke=text, **{"mode": "REMOVE", **more})


def stock(keep=True):
    common.scale(1)
    ob = common.stock(pitch=0.5, directions="xyz")
    settings = bpy.context.scene.riffler.sculpt
    settings.depth, settings.mirror, settings.radial, settings.axis, settings.string = 0.8, set(), 1, "NORMAL", 0.0
    settings.fixtures, settings.keep = None, keep
    common.push("stock")
    return ob.name


def sculpt(name):
    return bpy.data.objects[name]


def content(name):
    return part("live_registry").content(sculpt(name))


def rows(name):
    return sculpt(name).riffler.strokes.rows


def replayed(name):
    """The bytes after all enabled strokes in order, from the base and the curves alone."""
    kept, ob = part("kept_strokes"), sculpt(name)
    history = kept._link(ob).history
    volume = history.base.volume.copy()
    for wanted in kept._wanted(ob, kept._link(ob))[0]:
        if wanted.on:
            chain = wanted.chain
            volume.carve(riffler.Tool.from_dict(chain.tool), chain.poses, mode=chain.mode)
    return volume.to_bytes()


def bytes_of(name):
    return content(name).volume.to_bytes()


def bend(curve, by):
    """Moves the middle control point (mm), as a user does in Edit Mode."""
    points = curve.data.splines[0].points
    point = points[len(points) // 2]
    point.co[1] += by
    curve.data.update_tag()
    bpy.context.view_layer.update()


def three(name):
    assert stroke((6, 8), (20, 10), (34, 8)) == {"FINISHED"}
    bpy.ops.riffler.hand_tool_preset(name="Gouge No. 9, 6 mm")
    assert stroke((6, 20), (20, 24), (34, 20), mode="HAND") == {"FINISHED"}
    bpy.context.scene.riffler.sculpt.mirror = {"X"}
    assert stroke((5, 15), (12, 16), tool='{"kind": "flat", "diameter": 3.0, "length": 20.0}') == {"FINISHED"}
    bpy.context.scene.riffler.sculpt.mirror = set()
    assert [row.curve.name for row in rows(name)] == ["Stock Carve", "Stock Hand Tool", "Stock Carve.001"]


def test_strokes_become_curves_and_the_sculpt_is_what_they_carve():
    name = stock()
    full = content(name).volume.volume
    three(name)
    assert bytes_of(name) == replayed(name) and content(name).volume.volume < full - 100
    run = part("live_registry").of(sculpt(name))
    assert run.persistence.journal.state(run.token).volume.to_bytes() == bytes_of(name), "after a crash, too"
    curve = rows(name)[0].curve
    assert curve.data.splines[0].type == "NURBS" and len(curve.data.splines[0].points) < 12
    before = bytes_of(name)
    sculpt(name).location, sculpt(name).rotation_euler = (7, 3, 1), (0.3, 0.2, 0.1)
    bpy.context.view_layer.update()
    assert np.allclose(curve.matrix_world, sculpt(name).matrix_world), "a curve moves with its sculpt"
    bend(curve, 0.0)
    assert bytes_of(name) == before == replayed(name)


def test_a_bent_curve_cuts_again_and_undo_goes_back():
    name = stock()
    three(name)
    before = bytes_of(name)
    common.push("strokes")
    bend(rows(name)[0].curve, 4)
    bent = bytes_of(name)
    assert bent != before and bent == replayed(name)
    common.push("bent")
    bend(rows(name)[0].curve, 3)
    assert bytes_of(name) not in (before, bent)
    common.push("bent more")
    for wanted in (bent, before):
        bpy.ops.ed.undo()
        assert bytes_of(name) == wanted == replayed(name)
    bpy.ops.ed.redo()
    assert bytes_of(name) == bent == replayed(name)


def test_the_list_switches_moves_and_removes_strokes():
    name = stock()
    three(name)
    everything = bytes_of(name)
    rows(name)[1].on = False
    assert bytes_of(name) == replayed(name) != everything
    rows(name)[1].on = True
    assert bytes_of(name) == everything
    own = sculpt(name).riffler.strokes
    own.index = 0
    assert bpy.ops.riffler.stroke_move(direction="DOWN") == {"FINISHED"} and own.index == 1
    assert [row.curve.name for row in own.rows][:2] == ["Stock Hand Tool", "Stock Carve"]
    assert bytes_of(name) == replayed(name)
    assert bpy.ops.riffler.stroke_remove() == {"FINISHED"} and len(own.rows) == 2
    assert bytes_of(name) == replayed(name) and "Stock Carve" not in bpy.data.objects
    bpy.data.objects.remove(bpy.data.objects["Stock Hand Tool"])
    bpy.context.view_layer.update()
    part("kept_strokes").soon()
    assert len(rows(name)) == 1 and bytes_of(name) == replayed(name), "a deleted curve is a deleted stroke"


def test_a_file_keeps_the_strokes():
    name = stock()
    three(name)
    before = bytes_of(name)
    path = common.out("kept.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    assert bytes_of(name) == before and len(rows(name)) == 3
    common.select(sculpt(name))
    bend(rows(name)[2].curve, 2)
    assert bytes_of(name) == replayed(name) != before
    Path(path).unlink()


def test_curves_of_the_user_become_strokes():
    name = stock(keep=False)
    bpy.context.scene.riffler.sculpt.axis = "UP"
    curve = common.curve("Path", [(5, 5, 20), (20, 12, 20), (35, 5, 20)], mm_per_unit=1.0, kind="NURBS")
    curve.select_set(True)
    sculpt(name).select_set(True)
    bpy.context.view_layer.objects.active = sculpt(name)
    before = bytes_of(name)
    assert bpy.ops.riffler.stroke_add_curves() == {"FINISHED"}
    assert bytes_of(name) == replayed(name) != before and rows(name)[0].curve == curve
    curve.location.y += 5
    bpy.context.view_layer.update()
    assert bytes_of(name) == replayed(name)


def test_a_copy_of_the_sculpt_leaves_the_strokes_to_it():
    name = stock()
    three(name)
    part("live_registry").end_all()
    copy = sculpt(name).copy()
    copy.data = sculpt(name).data.copy()
    copy.location.x = 60
    bpy.context.scene.collection.objects.link(copy)
    bpy.context.view_layer.update()
    before = bytes_of(copy.name)
    bend(rows(name)[0].curve, 4)
    assert bytes_of(copy.name) == before != bytes_of(name) == replayed(name)
    common.select(copy)
    common.refused(bpy.ops.riffler.strokes_restore, "use Settle Strokes")
    assert bpy.ops.riffler.strokes_settle() == {"FINISHED"}
    bend(rows(name)[0].curve, 2)
    assert bytes_of(copy.name) == before and bytes_of(name) == replayed(name)


def test_what_cannot_be_cut_is_named_and_nothing_changes():
    name = stock()
    three(name)
    before = bytes_of(name)
    curve = rows(name)[0].curve
    curve.data.splines.clear()
    curve.data.update_tag()
    bpy.context.view_layer.update()
    assert bytes_of(name) == before
    assert rows(name)[0].problem.startswith("Stock Carve: its curve has no spline with two points")
    sculpt(name).riffler.strokes.index = 0
    assert bpy.ops.riffler.stroke_remove() == {"FINISHED"}
    assert bytes_of(name) == replayed(name)


def test_other_operations_leave_the_strokes_at_rest_until_the_user_decides():
    name = stock()
    three(name)
    assert stroke((30, 25), (35, 26), mode="SOFTEN") == {"FINISHED"}
    kept = part("kept_strokes")
    assert kept.at_rest(sculpt(name))
    before = bytes_of(name)
    bend(rows(name)[0].curve, 4)
    assert bytes_of(name) == before, "the smoothed place is not lost without a question"
    assert bpy.ops.riffler.strokes_restore() == {"FINISHED"}
    assert bytes_of(name) == replayed(name) != before
    assert stroke((30, 25), (35, 26), mode="SOFTEN") == {"FINISHED"}
    assert stroke((30, 5), (35, 6)) == {"FINISHED"}
    assert len(rows(name)) == 1 and bytes_of(name) == replayed(name), "a new list on what is there"
    bpy.ops.riffler.strokes_settle()
    assert not len(rows(name)) and not kept.at_rest(sculpt(name))
    bpy.context.scene.riffler.sculpt.keep = True
    assert stroke((6, 6), (9, 6), mode="MASK") == {"FINISHED"}
    common.refused(lambda: stroke((30, 5), (35, 6)), "needs a sculpt without a mask")
