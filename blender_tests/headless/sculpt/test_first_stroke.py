"""A plain object becomes a sculpt: units, pitch and cutter follow its size, the drag becomes a stroke, and a refusal
leaves everything unchanged."""

import json

import bpy
import numpy as np

from support import common

# From above, orthographic: two units of the world fill a view of 200 pixels.
VIEW = {"matrix": [0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, -0.01, 0, 0, 0, 0, 1], "size": [400, 400]}


def drag(*pixels):
    return json.dumps({"view": VIEW, "rows": [list(p) for p in pixels]})


ACROSS = drag((150, 200), (250, 200))


def volume(ob):
    return common.part("sculpt.live_registry").content(ob).volume


def state():
    scene = bpy.context.scene
    return (
        scene.unit_settings.scale_length,
        scene.unit_settings.length_unit,
        sorted(ob.name for ob in bpy.data.objects),
        [ob.matrix_world.copy() for ob in bpy.data.objects],
        bpy.context.object and bpy.context.object.name,
    )


def test_the_default_cube_becomes_a_sculpt_with_its_stroke_and_stays_where_it_is():
    cube = bpy.data.objects["Cube"]
    common.select(cube)
    place = cube.matrix_world.copy()
    assert bpy.ops.riffler.make_sculpt(stroke=ACROSS) == {"FINISHED"}
    made = bpy.context.object
    assert made.name == "Cube Stock" and cube.matrix_world == place and cube.hide_get()
    p, tool = made.data.riffler, bpy.context.scene.riffler.tool
    assert np.isclose(p.mm_per_unit, 50) and np.allclose(np.subtract(p.upper, p.lower), 100)
    assert np.isclose(p.pitch, 0.5) and np.isclose(tool.diameter, 10)
    depth, radius = bpy.context.scene.riffler.sculpt.depth, 5.0
    half = np.arccos((radius - depth) / radius)
    length = 50.0  # of a hundred pixels, mm
    groove = length * radius**2 * (half - np.sin(half) * np.cos(half)) + np.pi * depth**2 * (3 * radius - depth) / 3
    assert abs((1e6 - volume(made).volume) / groove - 1) < 0.03


@common.core_bound
def test_a_tiny_and_a_huge_object_are_as_easy_to_sculpt_as_any():
    for size in (0.002, 0.7, 400.0):
        bpy.ops.wm.read_homefile()
        bpy.ops.mesh.primitive_monkey_add(size=size)
        assert bpy.ops.riffler.make_sculpt() == {"FINISHED"}
        p, tool = bpy.context.object.data.riffler, bpy.context.scene.riffler.tool
        side = max(np.subtract(p.upper, p.lower))
        assert 10 <= side <= 500 and 120 <= side / p.pitch <= 320, (size, side, p.pitch)
        assert side / 12.5 <= tool.diameter <= side / 4
        assert 0.08 <= bpy.context.scene.riffler.sculpt.depth / tool.diameter <= 0.5


def test_an_object_is_made_round_on_request_when_it_becomes_a_sculpt():
    for rounded in (False, True):
        bpy.ops.wm.read_homefile()
        bpy.ops.mesh.primitive_uv_sphere_add()
        assert bpy.ops.riffler.make_sculpt(rounded=rounded) == {"FINISHED"}
        side = np.cbrt(volume(bpy.context.object).volume / (np.pi / 6))
        assert (abs(side - 100) < 0.05) == rounded and (side < 99.5) != rounded, side


def test_a_given_size_is_used_and_pitch_and_cutter_follow():
    common.select(bpy.data.objects["Cube"])
    bpy.ops.riffler.make_sculpt(side=8.0)
    p, tool = bpy.context.object.data.riffler, bpy.context.scene.riffler.tool
    assert np.allclose(np.subtract(p.upper, p.lower), 8) and np.isclose(p.pitch, 0.05)
    assert np.isclose(tool.diameter, 0.8) and np.isclose(tool.length, 4)


def test_a_given_pitch_or_cutter_is_used_with_or_without_a_size():
    given = ({"pitch": 2.0}, {"diameter": 7.0}, {"side": 20.0, "pitch": 2.0}, {"side": 20.0, "diameter": 7.0})
    for settings in given:
        bpy.ops.wm.read_homefile()
        cube = bpy.data.objects["Cube"]
        cube.scale = (1, 0.1, 0.1)  # thin: few triangles
        bpy.context.view_layer.update()
        common.select(cube)
        assert bpy.ops.riffler.make_sculpt(**settings) == {"FINISHED"}
        p, tool = bpy.context.object.data.riffler, bpy.context.scene.riffler.tool
        side = settings.get("side", 100)
        assert np.isclose(max(np.subtract(p.upper, p.lower)), side)
        assert np.isclose(p.pitch, settings.get("pitch", side / 200)), settings
        assert np.isclose(tool.diameter, settings.get("diameter", side / 10)), settings


def test_other_sculpts_keep_the_scenes_units():
    common.scale(1)
    common.stock()
    bpy.ops.mesh.primitive_cube_add(size=2000, location=(3000, 0, 0))
    bpy.ops.riffler.make_sculpt()
    assert np.isclose(bpy.context.scene.unit_settings.scale_length, 0.001)
    p = bpy.context.object.data.riffler
    assert np.isclose(p.pitch, 10) and np.isclose(bpy.context.scene.riffler.tool.diameter, 200)


def test_a_plan_keeps_the_scenes_unit():
    common.scale(1)
    fit, plan_store = common.part("sculpt.fit"), common.part("plan.plan_store")
    bpy.ops.mesh.primitive_cube_add(size=2)
    assert not fit.others(bpy.context) and fit.side(bpy.context, 2.0) == 100
    assert plan_store.is_plan in fit.HOLDERS
    fit.HOLDERS.append(lambda ob: ob.name == "Light")
    try:
        assert fit.others(bpy.context) and fit.side(bpy.context, 2.0) == 2
        assert bpy.ops.riffler.make_sculpt() == {"FINISHED"}
    finally:
        fit.HOLDERS.pop()
    assert np.isclose(bpy.context.scene.unit_settings.scale_length, 0.001)


def test_undo_takes_back_the_stroke_then_the_sculpt_with_the_units():
    cube = bpy.data.objects["Cube"]
    common.select(cube)
    common.push("begin")
    before = state()
    bpy.ops.riffler.make_sculpt("EXEC_DEFAULT", True, stroke=ACROSS)
    carved = volume(bpy.context.object).volume
    bpy.ops.ed.undo()
    assert volume(bpy.data.objects["Cube Stock"]).volume == 1e6 > carved
    bpy.ops.ed.undo()
    assert state() == before and not bpy.data.objects["Cube"].hide_get()
    assert np.isclose(bpy.context.scene.riffler.tool.diameter, 10)  # the cutter is a brush's setting, and stays


def test_objects_that_cannot_become_a_sculpt_are_refused_and_nothing_changes():
    bpy.ops.mesh.primitive_plane_add()
    before = state()
    common.refused(lambda: bpy.ops.riffler.make_sculpt(), "Plane", "flat", "Solidify")
    assert state() == before
    common.select(bpy.data.objects["Camera"])
    before = state()
    common.refused(lambda: bpy.ops.riffler.make_sculpt(), "Nothing to sculpt", "Add > Mesh > Riffler")
    assert state() == before
    common.select(bpy.data.objects["Cube"])
    before = state()
    common.refused(lambda: bpy.ops.riffler.make_sculpt(side=1e5, pitch=0.001), "coarser pitch")
    assert (
        state() == before and bpy.context.scene.riffler.tool.diameter == 6 and not bpy.data.objects["Cube"].hide_get()
    )
    common.stock()
    common.refused(lambda: bpy.ops.riffler.make_sculpt(), "a sculpt already")


def test_a_drag_that_is_no_stroke_goes_to_the_object_under_the_pointer():
    """Each key of a tool that makes strokes is followed by one that captures the drag, or Blender would move the
    object."""
    for tool in common.part("sculpt.tools").TOOLS:
        items = [(name, event) for name, event, _ in tool.bl_keymap]
        for k, (name, event) in enumerate(items):
            if name == "riffler.stroke":
                assert items[k + 1] == ("riffler.stroke_elsewhere", event)


def test_an_instance_is_distinguished_from_an_object_that_can_be_sculpted():
    begin, cube = common.part("sculpt.first_stroke"), bpy.data.objects["Cube"]
    assert begin.unfit(bpy.context, cube) == ""
    home = bpy.data.collections.new("Home")
    home.objects.link(cube)
    for collection in [c for c in cube.users_collection if c != home]:
        collection.objects.unlink(cube)
    empty = bpy.data.objects.new("Stands", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", home
    bpy.context.collection.objects.link(empty)
    bpy.context.view_layer.update()
    for ob in (cube, empty):
        why = begin.unfit(bpy.context, ob)
        assert why.startswith("Stands is an instance of Home") and "Make Instances Real" in why, why
    assert begin.unfit(bpy.context, None) == begin.unfit(bpy.context, bpy.data.objects["Light"]) == begin.NOTHING
    common.select(empty)
    with bpy.context.temp_override(object=empty, active_object=empty, selected_editable_objects=[empty]):
        bpy.ops.object.duplicates_make_real()
    real = next(ob for ob in bpy.context.view_layer.objects if ob.type == "MESH")
    assert bpy.ops.riffler.make_sculpt(object=real.name) == {"FINISHED"}
