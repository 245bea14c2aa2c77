"""Edits of a sculpt's mesh by Blender's own tools are detected by all operators that use the sculpt, and reported."""

from itertools import product
from pathlib import Path

import bpy
import numpy as np

from support import common

LEFT_OUT = "without the edits"


def ball(pitch=1.0):
    """A sphere of radius 20 as a sculpt, with all triangles, as Blender's own tools need them."""
    common.scale(1)
    bpy.ops.mesh.primitive_uv_sphere_add(radius=20, segments=64, ring_count=32)
    bpy.ops.riffler.new_stock(source="OBJECT", pitch=pitch, directions="xyz")
    bpy.ops.riffler.detail(detail="ALL")
    return bpy.context.object


def pull(ob, centre, by=3.0, radius=8.0):
    """Like a brush of Sculpt Mode."""
    co = common.coordinates(ob.data)
    fall = np.clip(1 - np.linalg.norm(co - centre, axis=1) / radius, 0, 1)[:, None]
    co += (by * fall * np.asarray(centre) / np.linalg.norm(centre)).astype(np.float32)
    ob.data.vertices.foreach_set("co", co.ravel())
    ob.data.update()


def test_every_local_edit_is_detected():
    ob, sculpts = ball(pitch=0.5), common.part("sculpt.sculpts")
    whole, missed = common.coordinates(ob.data), 0
    assert not sculpts.changed(ob.data)
    places = np.random.default_rng(5).normal(size=(40, 3))
    for centre in 20 * places / np.linalg.norm(places, axis=1)[:, None]:
        pull(ob, centre)
        assert sculpts.changed(ob.data)
        missed += not sculpts.edited(ob.data)
        ob.data.vertices.foreach_set("co", whole.ravel())
        assert not sculpts.changed(ob.data)
    assert missed > 10  # which the panel's cheap check misses


def local_pull():
    """A sculpt that was edited where the cheap check misses it."""
    ob, sculpts = ball(), common.part("sculpt.sculpts")
    pull(ob, (-12.0, 9.0, 13.0))
    assert sculpts.changed(ob.data) and not sculpts.edited(ob.data)
    return ob


def test_every_change_of_the_sculpt_asks_first_what_becomes_of_the_edits():
    """Nothing is discarded, and either remedy in the message works."""
    from support import sculpting

    line = common.curve("Line", [(-30, 0, 18), (30, 0, 18)], mm_per_unit=1.0)
    calls = {
        "cut": lambda: bpy.ops.riffler.cut_curve(curve=line.name, tool=common.BALL),
        "pitch": lambda: bpy.ops.riffler.resample(pitch=2.0),
        "crop": lambda: bpy.ops.riffler.crop(point=(0, 0, 15), normal=(0, 0, 1)),
        "mask": lambda: bpy.ops.riffler.mask_invert(),
        "units": lambda: bpy.ops.riffler.millimetres(),
        "stroke": lambda: bpy.ops.riffler.stroke(stroke=STROKE),
    }
    for (name, call), remedy in common.fewer(
        product(calls.items(), (bpy.ops.riffler.take_edits, bpy.ops.riffler.rebuild))
    ):
        ob = local_pull()
        common.push("pull")
        kept, before = common.coordinates(ob.data), common.shape(common.content(ob).volume)
        common.refused(call, ob.name, "Apply Mesh Edits", "Rebuild Mesh")
        assert np.array_equal(common.coordinates(ob.data), kept), name
        assert common.same(common.shape(common.content(ob).volume), before), name
        assert remedy() == {"FINISHED"} and call() == {"FINISHED"}, name
        sculpting.live().end_all()


def test_the_panel_notices_every_edit():
    ob, edits = local_pull(), common.part("sculpt.mesh_edits")
    bpy.context.view_layer.update()
    assert edits.noticed(ob)
    bpy.ops.riffler.rebuild()
    bpy.context.view_layer.update()
    assert not edits.noticed(ob)
    pull(ob, (-12.0, 9.0, 13.0), by=0.01)
    bpy.context.view_layer.update()
    assert edits.noticed(ob) and not common.part("sculpt.sculpts").edited(ob.data)


def test_the_stroke_continues_after_the_answer():
    for choice in ("TAKE", "DROP"):
        ob = local_pull()
        common.push("pull")
        volume = common.content(ob).volume.volume
        assert bpy.ops.riffler.edits_first(edits=choice, stroke=STROKE) == {"FINISHED"}
        after = common.part("sculpt.live_registry").content(ob).volume.volume
        assert after > volume + 50 if choice == "TAKE" else after < volume
        common.part("sculpt.live_registry").end_all()


STROKE = (
    '{"view": {"matrix": [0.02, 0, 0, 0, 0, 0.02, 0, 0, 0, 0, -0.01, 0, 0, 0, 0, 1], "size": [200, 200]}, '
    '"rows": [[90, 100], [95, 100], [110, 100]]}'
)


def test_results_of_the_volume_report_that_they_lack_the_edits():
    ob = local_pull()
    path = common.out("edited.stl")
    assert LEFT_OUT in common.printed(lambda: bpy.ops.riffler.export_stl(filepath=path))
    assert LEFT_OUT in common.printed(lambda: bpy.ops.riffler.to_mesh(tolerance=0.0, hide_sculpt=False))
    common.select(ob)
    assert bpy.ops.riffler.take_edits() == {"FINISHED"}
    bend = ob.modifiers.new("Bend", "SIMPLE_DEFORM")
    for seen in (True, False):
        bend.show_viewport = seen
        common.select(ob)
        for call in (
            lambda: bpy.ops.riffler.export_stl(filepath=path),
            lambda: bpy.ops.riffler.to_mesh(tolerance=0.0, hide_sculpt=False),
        ):
            said = common.printed(call)
            assert LEFT_OUT not in said and ("has modifiers" in said) == seen, said
            common.select(ob)


def test_stock_from_an_edited_sculpt_is_the_shown_mesh():
    ob = local_pull()
    before = common.content(ob).volume.volume
    assert "edits" not in common.printed(
        lambda: bpy.ops.riffler.new_stock(source="OBJECT", pitch=0.5, directions="xyz")
    )
    made = bpy.context.object
    assert made != ob and common.content(made).volume.volume > before + 50


def test_a_file_of_an_older_add_on_has_no_checksum_to_go_by():
    ob, sculpts = local_pull(), common.part("sculpt.sculpts")
    ob.data.riffler.shown_crc = ""
    assert not sculpts.changed(ob.data)
    path = common.out("edits.blend")
    bpy.ops.riffler.rebuild()
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    ob = bpy.context.object
    assert ob.data.riffler.shown_crc and not sculpts.changed(ob.data)
    pull(ob, (-12.0, 9.0, 13.0))
    assert sculpts.changed(ob.data)
    Path(path).unlink()


def masked_block():
    """A block with a protected ball at one end, and a cut next to it."""
    common.scale(1)
    ob = common.stock(size=(40, 30, 20), pitch=0.5, directions="xyz")
    bpy.ops.mesh.primitive_uv_sphere_add(radius=6, location=(34, 15, 10))
    form = bpy.context.object
    common.select(ob)
    bpy.ops.riffler.mask_form(form=form.name)
    saw = common.curve("Saw", [(13, -5, -1), (13, 40, -1)], mm_per_unit=1.0)
    common.select(ob)
    bpy.ops.riffler.cut_curve(curve=saw.name, tool='{"kind": "flat", "diameter": 2.0, "length": 60.0}')
    return ob


def test_take_edits_keeps_the_mask_and_names_the_lost_cuts():
    ob = masked_block()
    before = common.content(ob)
    co = common.coordinates(ob.data)
    co[co[:, 0] < 1, 0] -= 5  # one side is longer
    ob.data.vertices.foreach_set("co", co.ravel())
    ob.data.update()
    assert "no longer in the NC code: 1 cut" in common.printed(lambda: bpy.ops.riffler.take_edits())
    after = common.content(ob)
    assert after.volume.lower[0] == -5 and not after.cuts and after.shaped
    assert abs(after.mask.volume / before.mask.volume - 1) < 1e-2
    assert after.mask.contains(np.array([[34.0, 15, 10]]))[0] and not after.mask.contains(np.array([[20.0, 15, 10]]))[0]
    after.volume.copy().intersect(after.mask)  # both use the same rays
    assert "any more" not in common.printed(lambda: bpy.ops.riffler.take_edits())


def test_strokes_are_mirrored_where_they_were_after_one_side_has_become_longer():
    from support import sculpting

    ob = sculpting.sculpt(size=(40, 30, 20), pitch=0.5) and bpy.context.object
    mirror = common.part("sculpt.pure.symmetry").maps("X")

    def mirrored(y):
        run = sculpting.work(ob.name)
        run.maps = mirror
        run.begin_stroke()
        run.carve(sculpting.BALL, np.array([[8.0, y, 18, 0, 0, 1], [12.0, y, 18, 0, 0, 1]]))
        assert run.finish_stroke(bpy.context, "stroke")
        sculpting.live().end_all()
        return common.content(ob).cuts[-1].poses[:, 0].tolist()

    assert mirrored(8) == [32, 28]
    co = common.coordinates(ob.data)
    co[co[:, 0] < 1, 0] -= 5
    ob.data.vertices.foreach_set("co", co.ravel())
    ob.data.update()
    assert bpy.ops.riffler.take_edits() == {"FINISHED"} and common.content(ob).volume.lower[0] == -5
    assert mirrored(15) == [32, 28]
    bpy.ops.riffler.room(room=3.0)
    assert mirrored(20) == [32, 28]


def test_parts_keep_the_mask_and_go_where_the_sculpt_is():
    ob = masked_block()
    name, home, other = ob.name, bpy.data.collections.new("Home"), bpy.data.collections.new("Other")
    for collection in (home, other):
        bpy.context.scene.collection.children.link(collection)
    for collection in ob.users_collection:
        collection.objects.unlink(ob)
    home.objects.link(ob)
    bpy.context.view_layer.active_layer_collection = bpy.context.view_layer.layer_collection.children["Other"]
    common.select(ob)
    assert bpy.ops.riffler.split() == {"FINISHED"}
    assert not other.objects and len(home.objects) == 2
    parts = {o.name: common.content(o) for o in home.objects}
    first = parts.pop(name)
    assert first.mask is not None  # of 26 mm, with the ball; the other piece has none of the mask
    assert [part.mask for part in parts.values()] == [None]
    small = next(iter(parts))
    common.select(bpy.data.objects[name])
    bpy.ops.riffler.mask_invert()
    bpy.ops.riffler.crop(point=(39, 0, 0), normal=(1, 0, 0))
    saw = common.curve("Again", [(20, -5, -1), (20, 40, -1)], mm_per_unit=1.0)
    common.select(bpy.data.objects[name])
    bpy.ops.riffler.mask_clear()
    bpy.ops.riffler.cut_curve(curve=saw.name, tool='{"kind": "flat", "diameter": 2.0, "length": 60.0}')
    bpy.ops.riffler.mask_invert()
    assert bpy.ops.riffler.split() == {"FINISHED"}
    pieces = [o for o in home.objects if o.name != small]
    assert len(pieces) == 2 and all(common.content(o).mask is not None for o in pieces)
