"""Cuts: exact amounts, axes, units, errors, and undo."""

import json

import bpy
import numpy as np

from support import common


def slot(length, diameter, depth):
    """Volume of the slot of a flat end mill: a rectangle with round ends."""
    return (length * diameter + np.pi * diameter**2 / 4) * depth


@common.core_bound
def test_a_straight_slot_has_the_volume_of_the_formula_in_any_scene():
    for unit in (1000.0, 1.0):
        bpy.ops.wm.read_homefile()
        common.scale(unit)
        ob = common.stock(pitch=0.2)
        c = common.curve("Line", [(10, 15, 20), (30, 15, 20)], mm_per_unit=unit)
        bpy.ops.riffler.cut_curve(curve=c.name, depth=2, tool=common.FLAT)
        removed = 24000 - common.content(ob).volume.volume
        assert abs(removed / slot(20, 6, 2) - 1) < 0.005, (unit, removed)


def test_the_curve_is_used_in_its_place():
    common.scale(1)
    ob = common.stock(pitch=1.0)
    ob.matrix_world = [[0, -1, 0, 7], [1, 0, 0, -3], [0, 0, 1, 2], [0, 0, 0, 1]]
    c = common.curve("Line", [(0, 0, 0), (10, 0, 0)])
    c.scale = (1000, 1000, 1000)
    c.matrix_world = ob.matrix_world @ __import__("mathutils").Matrix.Translation((10, 15, 20)) @ c.matrix_world
    bpy.context.view_layer.update()
    bpy.ops.riffler.cut_curve(curve=c.name, depth=2, tool=common.FLAT)
    poses = common.content(ob).cuts[0].poses
    expected = c.matrix_world @ c.data.splines[0].points[0].co
    expected = np.array(ob.matrix_world.inverted() @ expected)[:3] - (0, 0, 2)
    assert np.allclose(poses[0, :3], expected, atol=1e-4), (poses, expected)
    assert np.allclose(poses[:, 3:], (0, 0, 1))


def test_tilt_leans_the_tool_about_the_curve():
    common.scale(1)
    ob = common.stock()
    c = common.curve("Line", [(10, 15, 20), (30, 15, 20)], mm_per_unit=1, tilt=[0, np.radians(30)])
    bpy.ops.riffler.cut_curve(curve=c.name, depth=1, axis="TILT", tool=common.BALL)
    poses = common.content(ob).cuts[0].poses
    lean = np.radians(30)
    # Turned about +X by the right hand: +Z goes to -Y.
    assert np.allclose(poses[0, 3:], (0, 0, 1)) and np.allclose(poses[-1, 3:], (0, -np.sin(lean), np.cos(lean)))
    assert np.allclose(poses[-1, :3], np.array((30, 15, 20)) - poses[-1, 3:])


def test_the_surface_normal_stands_on_the_sculpt():
    common.scale(1)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=96, ring_count=48, radius=20)
    bpy.ops.riffler.new_stock(source="OBJECT", pitch=0.5, directions="xyz")
    ob = bpy.context.object
    angle = np.linspace(0, 1, 9)
    arc = 23 * np.c_[np.sin(angle), 0 * angle, np.cos(angle)]
    c = common.curve("Arc", arc, mm_per_unit=1)
    bpy.ops.riffler.cut_curve(curve=c.name, depth=1, axis="NORMAL", follow=True, tool=common.BALL)
    poses = common.content(ob).cuts[0].poses
    radial = poses[:, :3] / np.linalg.norm(poses[:, :3], axis=1, keepdims=True)
    assert len(poses) > 30
    assert np.abs(np.linalg.norm(poses[:, :3], axis=1) - 19).max() < 0.3
    assert np.degrees(np.arccos(np.clip((poses[:, 3:] * radial).sum(axis=1), -1, 1))).max() < 6


def test_every_spline_is_a_cut():
    common.scale(1)
    ob = common.stock()
    c = common.curve("Two", [(10, 10, 20), (30, 10, 20)], mm_per_unit=1)
    spline = c.data.splines.new("BEZIER")
    spline.bezier_points.add(1)
    for k, point in enumerate(spline.bezier_points):
        point.co = (10 + 20 * k, 20, 20)
        point.handle_left = point.handle_right = (20, 25, 20)
    bpy.context.view_layer.update()
    bpy.ops.riffler.cut_curve(curve=c.name, depth=1, tool=common.BALL)
    cuts = common.content(ob).cuts
    assert len(cuts) == 2 and cuts[0].moves == 1 and cuts[1].moves > 10
    assert (ob.data.riffler.cuts, ob.data.riffler.moves) == (2, 1 + cuts[1].moves)


def test_the_scenes_tool_is_used_and_kept_with_the_cut():
    common.scale(1)
    ob = common.stock()
    c = common.curve("Line", [(10, 15, 20), (30, 15, 20)], mm_per_unit=1)
    bpy.ops.riffler.tool_preset(name="V-bit 90°")
    bpy.ops.riffler.cut_curve(curve=c.name, depth=2)
    assert common.content(ob).cuts[0].tool["name"] == "V-bit 90°"
    # a groove of 90° and depth d has the section d², with cones at both ends
    removed = 24000 - common.content(ob).volume.volume
    assert abs(removed / (20 * 4 + np.pi * 8 / 3) - 1) < 0.05, removed


def test_the_mesh_shows_the_cut():
    common.scale(1)
    ob = common.stock(pitch=0.25, directions="xyz")
    c = common.curve("Line", [(-10, 15, 20), (50, 15, 20)], mm_per_unit=1)
    bpy.ops.riffler.cut_curve(curve=c.name, depth=2, tool=common.FLAT)
    bpy.context.view_layer.update()
    hit, place, normal, _ = ob.ray_cast((20, 15, 100), (0, 0, -1))
    assert hit and abs(place.z - 18) < 1e-3 and normal.z > 0.999
    hit, place, _, _ = ob.ray_cast((20, 5, 100), (0, 0, -1))
    assert hit and abs(place.z - 20) < 1e-3
    assert np.allclose(ob.dimensions, (40, 30, 20), atol=1e-4)


def test_one_undo_step_undoes_mesh_and_volume_together():
    common.scale(1)
    name = common.stock().name
    c = common.curve("Line", [(10, 15, 20), (30, 15, 20)], mm_per_unit=1).name
    states = [state(name)]
    common.push("stock")
    for depth in (1, 2, 3):
        bpy.ops.riffler.cut_curve("EXEC_DEFAULT", True, curve=c, depth=depth, tool=common.FLAT)
        states.append(state(name))
    assert len({s[2] for s in states}) == 4
    for cached in (True, False):
        for k in (2, 1, 0, 1, 2, 3):
            bpy.ops.ed.undo() if k < 3 and current(name, states) > k else bpy.ops.ed.redo()
            if not cached:
                common.part("sculpt.sculpt_store").clear_cache()
            agree(state(name), states[k])


def state(name):
    ob = bpy.data.objects[name]
    content = common.content(ob)
    return common.coordinates(ob.data).copy(), common.shape(content.volume), content.volume.volume, len(content.cuts)


def current(name, states):
    return len(common.content(bpy.data.objects[name]).cuts)


def agree(a, b):
    assert np.array_equal(a[0], b[0]) and common.same(a[1], b[1]) and a[2:] == b[2:]


def test_a_cut_after_undo_starts_from_the_undone_state():
    common.scale(1)
    name = common.stock().name
    c = common.curve("Line", [(10, 15, 20), (30, 15, 20)], mm_per_unit=1).name
    common.push("stock")
    bpy.ops.riffler.cut_curve("EXEC_DEFAULT", True, curve=c, depth=3, tool=common.FLAT)
    bpy.ops.ed.undo()
    bpy.ops.riffler.cut_curve("EXEC_DEFAULT", True, curve=c, depth=1, tool=common.FLAT)
    removed = 24000 - common.content(bpy.data.objects[name]).volume.volume
    assert abs(removed / slot(20, 6, 1) - 1) < 0.05, removed


def test_what_is_refused_changes_nothing():
    common.scale(1)
    ob = common.stock()
    key, co = common.part("sculpt.sculpt_store").identity(ob.data), common.coordinates(ob.data)
    c = common.curve("Line", [(10, 15, 20), (30, 15, 20)], mm_per_unit=1)
    common.refused(lambda: bpy.ops.riffler.cut_curve(curve="nobody"), "nobody")
    common.refused(lambda: bpy.ops.riffler.cut_curve(curve=""), "curve")
    far = common.curve("Far", [(900, 900, 900), (950, 940, 930)], mm_per_unit=1)
    one = common.curve("One", [(10, 10, 20)], mm_per_unit=1)
    common.select(ob)
    words = "Far is too far from Stock", "move it nearer, or turn Follow Surface off"
    common.refused(lambda: bpy.ops.riffler.cut_curve(curve=far.name, follow=True), *words)
    common.refused(lambda: bpy.ops.riffler.cut_curve(curve=one.name, follow=True), "One has no spline with two points")
    for tool, word in (("{", "xpecting"), ("[]", "JSON"), ('{"kind": "spoon"}', "spoon")):
        common.refused(lambda t=tool: bpy.ops.riffler.cut_curve(curve=c.name, tool=t), word)
    bad = json.dumps({"kind": "ball", "diameter": -1, "length": 3})
    common.refused(lambda: bpy.ops.riffler.cut_curve(curve=c.name, tool=bad), "diameter")
    dot = common.curve("Dot", [(1, 1, 1)], mm_per_unit=1)
    common.refused(lambda: bpy.ops.riffler.cut_curve(curve=dot.name), "Dot")
    assert common.part("sculpt.sculpt_store").identity(ob.data) == key
    assert np.array_equal(common.coordinates(ob.data), co)


def test_a_cut_into_air_warns_and_counts():
    common.scale(1)
    ob = common.stock()
    c = common.curve("Line", [(10, 15, 90), (30, 15, 90)], mm_per_unit=1)
    assert bpy.ops.riffler.cut_curve(curve=c.name, depth=1, tool=common.BALL) == {"FINISHED"}
    assert common.content(ob).volume.volume == 24000 and ob.data.riffler.cuts == 1


def test_all_material_can_be_cut_away():
    common.scale(1)
    ob = common.stock(size=(4, 4, 4))
    c = common.curve("Line", [(-4, 2, 0), (8, 2, 0)], mm_per_unit=1)
    tool = '{"kind": "flat", "diameter": 12.0, "length": 30.0}'
    bpy.ops.riffler.cut_curve(curve=c.name, depth=1, tool=tool)
    assert common.content(ob).volume.volume == 0 and len(ob.data.polygons) == 0
    common.refused(lambda: bpy.ops.riffler.cut_curve(curve=c.name, axis="NORMAL", tool=tool), "surface")
