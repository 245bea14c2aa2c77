"""Operations on a sculpt as a whole: pitch, crop, parts, edits, masks, reliefs."""

import bpy
import numpy as np
import riffler
from mathutils import Matrix, Vector

from support import common
from support.sculpting import surface

SIZE = (40, 30, 20)


def sculpt(directions="xyz", pitch=0.5, size=SIZE):
    common.scale(1)
    return common.stock(size=size, pitch=pitch, directions=directions)


def volume(ob):
    return common.content(ob).volume


def close(a, b, share=1e-3):
    return abs(a - b) <= share * abs(b)


def empty(name, matrix):
    ob = bpy.data.objects.new(name, None)
    bpy.context.collection.objects.link(ob)
    ob.matrix_world = matrix
    bpy.context.view_layer.update()
    return ob


def circle(name, centre, radius, matrix=None):
    """A closed poly spline in its own plane z = 0."""
    angle = np.linspace(0, 2 * np.pi, 64, endpoint=False)
    points = np.c_[radius * np.cos(angle), radius * np.sin(angle), 0 * angle] + centre
    return common.curve(name, points, matrix=matrix, mm_per_unit=1.0, cyclic=True)


def matches(ob):
    mesh = surface(volume(ob), common.content(ob).mask)
    assert np.array_equal(common.coordinates(ob.data), np.asarray(mesh.vertices, np.float32))


def test_changing_the_pitch_back_and_forth_keeps_the_shape():
    ob = sculpt()
    bpy.ops.riffler.cut_curve(
        curve=common.curve("C", [(-5, 15, 18), (45, 15, 18)], mm_per_unit=1.0).name, tool=common.BALL
    )
    before = volume(ob).volume
    for pitch in (0.25, 0.5):
        assert bpy.ops.riffler.resample(pitch=pitch) == {"FINISHED"}
        assert close(volume(ob).volume, before) and volume(ob).pitch == pitch
        matches(ob)
    assert bpy.ops.riffler.resample(pitch=1.0, directions="z") == {"FINISHED"}
    assert volume(ob).directions == "z" and len(common.content(ob).cuts) == 1
    common.refused(lambda: bpy.ops.riffler.resample(pitch=1e-4), "coarser pitch")
    assert volume(ob).pitch == 1.0


def test_a_pitch_that_cannot_be_shown_is_refused_before_anything_is_made():
    ob = sculpt()  # 40 × 30 × 20 mm are 130 million triangles at 0.01 mm
    before = volume(ob).to_bytes()
    common.refused(lambda: bpy.ops.riffler.resample(pitch=0.01), "triangles at 0.01 mm", "coarser pitch")
    assert volume(ob).to_bytes() == before


def stays(before, after):
    """Each ray keeps its content, to the bit, and new ones are empty."""
    for direction, was, now in zip(before.directions, common.shape(before), common.shape(after), strict=True):
        assert np.array_equal(was[1], now[1]) and was[0].sum() == now[0].sum()
        assert np.array_equal(before.normals(direction), after.normals(direction))


@common.core_bound
def test_growing_the_box_five_times_moves_no_vertex_of_a_groove():
    ob = sculpt(pitch=0.25)
    path = common.curve("C", [(5, 8, 18), (20, 17, 17), (35, 15, 18)], mm_per_unit=1.0)
    common.select(ob)
    bpy.ops.riffler.cut_curve(curve=path.name, tool=common.BALL)
    bpy.ops.riffler.detail(detail="ALL")
    before, first = common.coordinates(ob.data), volume(ob)
    for _ in range(5):
        text = common.printed(lambda: bpy.ops.riffler.room(room=0.7))
        assert "The box is" in text and "counted" not in text
    after = common.coordinates(ob.data)
    stays(first, volume(ob))
    groove = before[(before[:, 2] < 19.75) & (before[:, 2] > 10) & (before[:, :2] > 0.25).all(axis=1)]
    groove = groove[(groove[:, 0] < 39.75) & (groove[:, 1] < 29.75)]
    there = {tuple(v) for v in after.tolist()}
    assert len(groove) > 1000 and all(tuple(v) in there for v in groove.tolist())


def test_growing_a_box_of_fractional_pitches_keeps_rays_and_symmetry_and_can_be_undone():
    ob = sculpt(pitch=0.4, size=(20.1, 10.2, 5.18))  # 50, 26 and 13 rays, of cells that are wider or narrower
    name, first, middle = ob.name, volume(ob), common.part("sculpt.sculpts").middle
    place = middle(ob.data, first)
    common.push("stock")
    text = common.printed(lambda: bpy.ops.riffler.room("EXEC_DEFAULT", True, room=1.0))
    assert "are counted" in text  # 0.5 mm of each last cell along x become 0.4
    ob = bpy.data.objects[name]
    grown = volume(ob)
    stays(first, grown)
    assert np.allclose(middle(ob.data, grown), place, atol=1e-6)
    assert (grown.lower <= first.lower - 1).all() and (grown.upper >= first.upper + 1).all()
    bpy.ops.ed.undo()
    assert volume(bpy.data.objects[name]).to_bytes() == first.to_bytes()
    bpy.ops.ed.redo()
    assert volume(bpy.data.objects[name]).to_bytes() == grown.to_bytes()
    common.refused(lambda: bpy.ops.riffler.room(room=1e9), "mm at most")
    assert volume(bpy.data.objects[name]).to_bytes() == grown.to_bytes()


def test_a_pitch_that_would_lose_all_material_is_refused():
    ob = sculpt()
    pillar = riffler.Volume.block((3, 3, 0), (4, 4, 1), 0.25, "xyz").resample(0.25, None, (0, 0, 0), (40, 30, 20))
    common.part("sculpt.sculpts").commit(ob.data, common.part("common.contents").Content(pillar), 1.0)
    before = volume(ob).to_bytes()
    common.refused(lambda: bpy.ops.riffler.resample(pitch=15), f"{ob.name} is too thin", "15 mm", "finer")
    for pitch, words in ((1e9, "longer than every side of the box, 40 × 30 × 20 mm"), (float("nan"), "not nan")):
        common.refused(lambda pitch=pitch: bpy.ops.riffler.resample(pitch=pitch), words)
    common.refused(lambda: bpy.ops.riffler.room(room=1e9), "mm at most")
    assert volume(ob).to_bytes() == before and len(ob.data.polygons)


def test_the_box_grows_on_every_side_and_takes_added_material():
    ob = sculpt()
    ring = circle("Ring", (20, 15, 100), 8)
    path = common.curve("C", [(-5, 15, 15), (45, 15, 15)], mm_per_unit=1.0)
    common.select(ob)
    bpy.ops.riffler.mask_form(form=ring.name)
    bpy.ops.riffler.cut_curve(curve=path.name, tool=common.BALL)
    before, place = common.content(ob), ob.matrix_world.copy()
    assert bpy.ops.riffler.room(room=2.2) == {"FINISHED"}
    after = common.content(ob)
    assert np.allclose(after.volume.lower, -2.5) and np.allclose(after.volume.upper, (42.5, 32.5, 22.5))
    assert ob.matrix_world == place and [c.masked for c in after.cuts] == [True]
    stays(before.volume, after.volume)
    stays(before.mask, after.mask)
    matches(ob)
    common.refused(lambda: bpy.ops.riffler.room(room=1e5), "free")
    assert volume(ob).to_bytes() == after.volume.to_bytes()
    bpy.ops.riffler.mask_clear()
    run = common.part("sculpt.live_registry").begin(bpy.context, ob)
    run.carve(riffler.Tool.flat(6, 2), np.array([[10.0, 4, 20, 0, 0, 1], [30.0, 4, 20, 0, 0, 1]]), mode="add")
    assert run.finish_stroke(bpy.context, "added")
    common.part("sculpt.live_registry").end_all()
    assert close(volume(ob).volume - after.volume.volume, (20 * 6 + np.pi * 9) * 2, 0.05)


def test_crop_takes_the_plane_of_an_object_or_numbers():
    ob = sculpt()
    ob.matrix_world = Matrix.Translation((5, 0, 0)) @ Matrix.Rotation(0.5, 4, "Z")
    bpy.context.view_layer.update()
    plane = empty("Plane", ob.matrix_world @ Matrix.Translation((20, 15, 10)) @ Matrix.Rotation(0.7, 4, "X"))
    common.select(ob)
    assert bpy.ops.riffler.crop(plane="Plane") == {"FINISHED"}
    assert close(volume(ob).volume, 12000)  # through the middle: a half
    matches(ob)
    normal = ob.matrix_world.to_3x3() @ Vector((1, 0, 0))
    assert bpy.ops.riffler.crop(point=ob.matrix_world @ Vector((30, 0, 0)), normal=normal) == {"FINISHED"}
    assert close(volume(ob).volume, 9000)
    assert bpy.ops.riffler.crop(point=ob.matrix_world @ Vector((10, 0, 0)), normal=normal, flip=True) == {"FINISHED"}
    assert close(volume(ob).volume, 6000)
    plane.location.z -= 100
    bpy.context.view_layer.update()
    common.refused(lambda: bpy.ops.riffler.crop(plane="Plane"), "nothing would be left")
    common.refused(lambda: bpy.ops.riffler.crop(plane="Nothing"), "there is no object")
    common.refused(lambda: bpy.ops.riffler.crop(), "select the plane")
    assert close(volume(ob).volume, 6000)


def test_parts_become_sculpts_whose_volumes_sum():
    ob = sculpt()
    saw = common.curve("Saw", [(13, -5, -1), (13, 40, -1)], mm_per_unit=1.0)
    bpy.ops.riffler.cut_curve(curve=saw.name, tool='{"kind": "flat", "diameter": 2.0, "length": 60.0}')
    before, name = volume(ob).volume, ob.name
    common.push("cut")
    common.scale(1000)  # changed by hand, meanwhile: pieces have the scale of the original
    assert bpy.ops.riffler.split("EXEC_DEFAULT", True) == {"FINISHED"}
    common.scale(1)
    parts = [o for o in bpy.data.objects if o.type == "MESH" and o.data.riffler.store]
    assert len(parts) == 2 and abs(sum(volume(o).volume for o in parts) - before) < 1e-6
    assert close(volume(bpy.data.objects[name]).volume, 26 * 600)
    for o in parts:
        matches(o)
    bpy.ops.ed.undo()
    parts = [o for o in bpy.data.objects if o.type == "MESH" and o.data.riffler.store]
    assert [o.name for o in parts] == [name] and volume(parts[0]).volume == before
    common.select(parts[0])
    assert bpy.ops.riffler.split(least=1e6) == {"CANCELLED"}


def test_edits_with_blenders_own_tools_become_material():
    ob = sculpt()
    co = common.coordinates(ob.data).copy()
    co[:, 0] *= 1.25
    co[:, 2] += 3.0
    ob.data.vertices.foreach_set("co", co.ravel())
    ob.data.update()
    assert bpy.ops.riffler.take_edits() == {"FINISHED"}
    assert close(volume(ob).volume, 1.25 * 24000)
    assert np.allclose(np.ptp(common.coordinates(ob.data), axis=0), (50, 30, 20), atol=1e-4)
    assert np.allclose(volume(ob).lower, (0, 0, 0)) and np.allclose(volume(ob).upper, (50, 30, 23))
    matches(ob)
    modifier = ob.modifiers.new("Bend", "SIMPLE_DEFORM")
    modifier.deform_method, modifier.deform_axis, modifier.factor = "TAPER", "Z", -0.5
    bpy.context.view_layer.update()
    assert bpy.ops.riffler.take_edits() == {"FINISHED"} and not ob.modifiers
    assert volume(ob).volume < 0.95 * 30000
    matches(ob)


def test_edits_without_volume_are_refused_and_nothing_is_lost():
    ob = sculpt()
    before = volume(ob).to_bytes()
    co = common.coordinates(ob.data)
    co[:, 2] = 0
    ob.data.vertices.foreach_set("co", co.ravel())
    ob.data.update()
    common.refused(lambda: bpy.ops.riffler.take_edits(), "volume")
    assert volume(ob).to_bytes() == before


def test_a_mask_from_a_curve_protects_what_lies_under_it():
    ob = sculpt()
    ring = circle("Ring", (20, 15, 100), 8)
    common.select(ob)
    assert bpy.ops.riffler.mask_form(form=ring.name) == {"FINISHED"}
    assert close(common.content(ob).mask.volume, np.pi * 64 * 20, 0.01)
    path = common.curve("C", [(-5, 15, 15), (45, 15, 15)], mm_per_unit=1.0)
    whole = volume(ob).copy()
    bpy.ops.riffler.cut_curve(curve=path.name, tool=common.BALL)
    protected = whole.intersect(common.content(ob).mask)
    assert volume(ob).copy().intersect(common.content(ob).mask).to_bytes() == protected.to_bytes()
    assert volume(ob).volume < 24000 - 100
    matches(ob)


@common.core_bound
def test_masks_are_added_subtracted_inverted_and_cleared():
    ob = sculpt()
    a, b = circle("A", (12, 15, 0), 6), circle("B", (28, 15, 0), 6)
    common.select(ob)
    one = np.pi * 36 * 20

    def mask():
        found = common.content(ob).mask
        return 0.0 if found is None else found.volume

    bpy.ops.riffler.mask_form(form=a.name)
    bpy.ops.riffler.mask_form(form=b.name, how="ADD")
    assert close(mask(), 2 * one, 0.01)
    bpy.ops.riffler.mask_form(form=a.name, how="SUBTRACT")
    assert close(mask(), one, 0.01)
    bpy.ops.riffler.mask_invert()
    assert close(mask(), 24000 - one, 0.01)
    bpy.ops.riffler.mask_clear()
    assert common.content(ob).mask is None
    bpy.ops.riffler.mask_invert()
    assert close(mask(), 24000)
    open_curve = common.curve("Open", [(0, 0, 0), (10, 10, 0)], mm_per_unit=1.0)
    common.refused(lambda: bpy.ops.riffler.mask_form(form=open_curve.name), "no closed spline")
    bpy.ops.mesh.primitive_uv_sphere_add(radius=8, location=(20, 15, 20))
    ball = bpy.context.object
    common.select(ob)
    bpy.ops.riffler.mask_form(form=ball.name)
    assert close(mask(), 0.5 * 4 / 3 * np.pi * 8**3, 0.03)


def test_a_picture_is_raised_and_engraved_to_the_requested_depth():
    ob = sculpt()
    image = bpy.data.images.new("Picture", 40, 20, float_buffer=True)
    pixels = np.zeros((20, 40, 4), np.float32)
    pixels[:, :, 3] = 1
    pixels[5:15, 10:30, :3] = 1
    image.pixels.foreach_set(pixels.ravel())
    # stock with room to raise something
    empty("Lid", Matrix.Translation((0, 0, 15)))
    common.select(ob)
    bpy.ops.riffler.crop(plane="Lid")
    before = volume(ob).volume
    empty("Place", Matrix.Translation((20, 15, 30)))
    common.select(ob)
    settings = {"image": "Picture", "place": "Place", "width": 20.0, "depth": 2.0}
    assert bpy.ops.riffler.relief(mode="RAISE", **settings) == {"FINISHED"}
    # 10 × 5 mm of white in a picture of 20 × 10 mm, its rim blurred by a pixel
    assert close(volume(ob).volume - before, 100, 0.05)
    assert abs(volume(ob).intervals("z")[1].max() - 17) < 1e-6
    assert abs(common.coordinates(ob.data)[:, 2].max() - 17) < 0.25  # walls that are steeper than rays can resolve
    matches(ob)
    assert bpy.ops.riffler.relief(mode="ENGRAVE", invert=True, **settings) == {"FINISHED"}
    assert abs(volume(ob).volume - before - 100 + 300) < 20
    common.refused(lambda: bpy.ops.riffler.relief(place="Place"), "choose a picture")
    common.refused(
        lambda: bpy.ops.riffler.relief(
            image="Picture",
            place=empty("Away", Matrix.Translation((500, 0, 0))).name,
            width=20.0,
            depth=1.0,
        ),
        "does not lie over",
    )


@common.core_bound
def test_a_picture_that_the_box_cuts_off_is_reported_with_the_remedy():
    ob = sculpt()
    image = bpy.data.images.new("White", 8, 8, float_buffer=True)
    image.pixels.foreach_set(np.ones(256, np.float32))
    bpy.ops.riffler.crop(point=(0, 0, 19), normal=(0, 0, 1))
    empty("Place", Matrix.Translation((20, 15, 30)))
    common.select(ob)
    settings = {"image": "White", "place": "Place", "width": 10.0}

    def said(**more):
        text = common.printed(lambda: bpy.ops.riffler.relief(**settings, **more))
        bpy.ops.riffler.crop(point=(0, 0, 19), normal=(0, 0, 1))
        return "Warning" in text, "Grow Box" in text

    assert said(depth=2.0) == (True, True) and said(depth=0.9) == (False, False)
    assert said(depth=2.0, mode="ENGRAVE") == (False, False)
    assert bpy.ops.riffler.room(room=2.0) == {"FINISHED"}
    assert said(depth=2.0) == (False, False)


def test_every_operator_names_what_is_missing():
    for ob in list(bpy.context.selected_objects):
        ob.select_set(False)
    bpy.context.view_layer.objects.active = None
    for name in ("resample", "room", "crop", "split", "take_edits", "mask_form", "mask_invert", "mask_clear", "relief"):
        assert not getattr(bpy.ops.riffler, name).poll(), name
