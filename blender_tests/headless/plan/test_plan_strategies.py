"""Strategies in Blender: curves engraved into a step, its wall cut by the flank, and refusals."""

import bpy
import numpy as np
import riffler
from mathutils import Matrix

from support import common, plans, programs
from support.keyframed_plan import pair

LINE = np.array([(5, 10, 8), (30, 12, 8), (55, 5, 8)], float)  # on the step's floor
GRAVER = riffler.Tool.ball(diameter=1, length=10).with_shank([(10, 2, 30, 2)])
STRATEGIES = riffler.plan.STRATEGIES


def store():
    return common.part("plan.plan_store")


def fields():
    return common.part("plan.strategy_fields")


def settings():
    return bpy.context.scene.riffler.plan


def scene(mm_per_unit=1.0, points=LINE, tool=GRAVER, **more):
    """The step as part, a tool, and a curve on the step, selected."""
    common.scale(mm_per_unit)
    settings().part = plans.part_object(mm_per_unit)
    settings().take(tool.to_dict())
    curve = common.curve("Line", points, mm_per_unit=mm_per_unit, **more)
    common.select(curve)
    return curve


def engrave(**more):
    assert bpy.ops.riffler.plan_find("EXEC_DEFAULT", True, strategy="ENGRAVE", **more) == {"FINISHED"}
    return store().active(bpy.context)


def rows(ob):
    return [row.state for row in ob.riffler.plan.rows]


def lines(depth=0.3, points=LINE, tool=GRAVER):
    return riffler.plan.engrave([points], tool, riffler.Mesh(*plans.step()), depth=depth)


def test_the_fields_are_those_of_the_table():
    find = bpy.ops.riffler.plan_find.get_rna_type().properties
    entries = [item.identifier.lower() for item in find["strategy"].enum_items]
    assert entries == list(STRATEGIES) and settings().strategy == "PENCIL"
    for strategy in STRATEGIES.values():
        for p in strategy.parameters:
            name = fields().identifier(strategy, p)
            field, kept = find[name], settings().bl_rna.properties[name]
            assert (field.name, field.description) == (p.label, p.help) == (kept.name, kept.description)
            if p.choices:
                assert field.default == p.default.upper() and len(field.enum_items) == len(p.choices)
            else:
                assert abs(field.default - (p.default or 0)) < 1e-7 and field.hard_min <= p.low + 1e-7
            assert (getattr(field, "subtype", "") == "ANGLE") == (p.unit == "rad"), name
    assert {"tolerance", "minimum_length", "passes", "stepover"} <= set(
        find.keys()
    )  # named so before there were other strategies


def test_a_curve_on_the_part_is_engraved_as_the_function_does():
    for unit in (1.0, 1000.0):
        scene(unit)
        ob = engrave(engrave_depth=0.4)
        plan = store().plan(ob)
        (path,) = plan.paths
        (line,) = lines(0.4)
        assert np.allclose(riffler.plan.poses_of(path), line.poses, atol=2e-3 if unit > 1 else 1e-9)
        assert plan.depths == {0: 0.4} and plan.tool == GRAVER and plan.part["name"].startswith("Step")
        assert rows(ob) == ["keyed"] and len(common.part("plan.path_curves").of(ob)) == 1
        assert ob.riffler.plan.part == settings().part


def test_a_curve_is_used_in_its_place_and_cyclic_ones_are_closed():
    ring = 6 * np.array([(1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0)])
    curve = scene(points=ring, cyclic=True)
    curve.matrix_world = Matrix.Translation((30, 10, 8))
    bpy.context.view_layer.update()
    (path,) = store().plan(engrave()).paths
    tips = riffler.plan.poses_of(path)[:, :3]
    assert np.allclose(tips[0], tips[-1]) and np.allclose(np.unique(tips[:, 2].round(9)), 7.7)
    assert np.allclose(np.ptp(tips, axis=0)[:2], 12, atol=1e-5)


@common.core_bound
def test_it_is_resolved_written_and_verified_as_deep_as_it_is():
    scene()
    ob = engrave()
    path = common.out("engraved.ngc")
    common.refused(lambda: bpy.ops.riffler.plan_nc(filepath=path), "path 1 may collide", "Resolve")
    assert bpy.ops.riffler.plan_resolve() == {"FINISHED"}
    assert rows(ob) == ["free"] and not ob.riffler.plan.findings
    (found,) = store().plan(ob).cl
    (line,) = lines()
    assert np.allclose(found, line.poses, atol=1e-9)  # nothing is lifted
    settings().spindle = 9000
    assert bpy.ops.riffler.plan_nc(filepath=path, post="tcp") == {"FINISHED"}
    read = riffler.Program.read(path)
    for row in line.poses:
        assert np.linalg.norm(read.poses[:, :3] - row[:3], axis=1).min() < 1e-3
    stock = programs.stock(offset=0.0, pitch=0.25)
    common.select(ob)
    verify = bpy.context.scene.riffler.verify
    assert bpy.ops.riffler.verify(source="PLAN", coloured="NONE") == {"FINISHED"}
    assert not programs.listed(verify.findings) and "0.3 mm below the part's surface are to be cut" in verify.said
    bpy.ops.riffler.verify(source="FILE", filepath=path, machine="tcp", coloured="NONE")
    assert [e["kind"] for e in programs.listed(verify.findings)] == ["gouge"]  # a file has no information on a depth
    assert stock.name in bpy.data.objects


def test_a_cone_without_a_ball_engraves_too():
    tool = riffler.Tool.cone_end(0.5, 1, 0.5, 4, 20)
    scene(tool=tool)
    ob = engrave()
    bpy.ops.riffler.plan_resolve()
    assert rows(ob) == ["free"] and np.allclose(store().plan(ob).cl[0], lines(tool=tool)[0].poses, atol=1e-9)


def test_a_holder_and_a_fixture_in_the_way_are_found():
    scene(tool=GRAVER.with_holder([(12, 15, 40, 15)]))  # the wall is 16 mm high, and 8 mm from the curve
    ob = engrave()
    bpy.ops.riffler.plan_resolve()
    assert rows(ob) == ["blocked"] and "holder meets the part" in ob.riffler.plan.findings[0].name
    # the cutter is meant to enter it less than the part
    bpy.ops.mesh.primitive_cube_add(size=4, location=(30, 14.4, 10))
    block = bpy.context.object
    block.name = "Block"
    bpy.context.view_layer.update()
    home = bpy.data.collections.new("Fixtures")
    home.objects.link(block)
    settings().fixtures = home
    settings().take(GRAVER.to_dict())
    common.select(bpy.data.objects["Line"])
    ob = engrave()
    bpy.ops.riffler.plan_resolve()
    assert rows(ob) == ["blocked"] and "Path 1, the tool enters Block, 0.1" in ob.riffler.plan.findings[0].name
    path = common.out("blocked.ngc")
    common.refused(lambda: bpy.ops.riffler.plan_nc(filepath=path), "path 1 may collide")


def test_on_the_timeline_it_plays_its_poses_and_takes_no_keys():
    scene()
    ob = engrave()
    assert bpy.ops.riffler.plan_to_timeline() == {"FINISHED"}
    states = common.part("plan.plan_states").state(ob)
    assert states.problems == [] and np.allclose(states.motions[0].motion.poses, lines()[0].poses, atol=1e-9)
    why = "Path 1 has its orientations from its strategy"
    common.refused(lambda: bpy.ops.riffler.plan_key(axis=(0, 0.3, 1), path=1, point=1), why)
    common.refused(lambda: bpy.ops.riffler.plan_turn(inclination=0.1), why)
    common.refused(lambda: bpy.ops.riffler.plan_least_tilt(paths="ALL"), "none of them takes keys")
    common.refused(lambda: bpy.ops.riffler.plan_least_tilt(paths="FRAME"), why)
    tool = pair(ob)[0]
    tool.rotation_quaternion = (0.9, 0.1, 0, 0)
    tool.keyframe_insert("rotation_quaternion", frame=20)
    bpy.context.view_layer.update()
    assert any(why in problem for problem in common.part("plan.plan_states").state(ob).problems)
    assert np.allclose(store().plan(ob).paths[0].axes, (0, 0, 1)) and not store().plan(ob).paths[0].keys
    bpy.ops.riffler.plan_check()
    assert common.part("plan.plan_states").state(ob).colliding == []


def test_paths_are_deleted_and_the_others_keep_their_depth():
    first = scene()
    second = common.curve("Other", LINE + np.array([0, 3, 0]), mm_per_unit=1.0)
    second.select_set(True)
    first.select_set(True)
    ob = engrave()
    assert store().plan(ob).depths == {0: 0.3, 1: 0.3}
    poses = riffler.plan.poses_of(store().plan(ob).paths[1])
    ob.riffler.plan.row = 0
    bpy.ops.riffler.plan_delete_paths(which="CHOSEN")
    plan = store().plan(ob)
    assert plan.depths == {0: 0.3} and np.array_equal(riffler.plan.poses_of(plan.paths[0]), poses)


def test_engraving_is_one_undo_step_and_finding_again_replaces_it():
    scene()
    common.push("curve")
    name = engrave().name
    bpy.ops.ed.undo()
    assert store().in_scene(bpy.context.scene) == []
    bpy.ops.ed.redo()
    ob = bpy.data.objects[name]
    assert store().plan(ob).depths == {0: 0.3}
    common.select(bpy.data.objects["Line"])
    bpy.ops.riffler.plan_find(strategy="ENGRAVE", engrave_depth=0.1, replace=name)
    assert store().plan(ob).depths == {0: 0.1} and len(store().in_scene(bpy.context.scene)) == 1


def test_missing_or_wrong_input_is_reported_with_the_next_step():
    curve = scene()
    call = lambda **more: bpy.ops.riffler.plan_find(strategy="ENGRAVE", **more)  # noqa: E731
    bpy.ops.object.select_all(action="DESELECT")
    common.refused(call, "No curve is selected: select the curves to engrave")
    common.select(curve)
    common.refused(lambda: call(engrave_reach=0.001, engrave_depth=0.3) if _raise(curve) else None, "more than reach")
    curve.modifiers.new("Array", "ARRAY")
    common.refused(call, "Line has modifiers or shape keys", "convert it to a curve")
    bpy.ops.object.text_add()
    common.refused(call, "is a text: use Object > Convert > Curve")
    swarf = lambda: bpy.ops.riffler.plan_find(strategy="SWARF")  # noqa: E731
    common.refused(swarf, "There is no pencil path yet: choose the strategy Pencil Cuts")
    assert store().in_scene(bpy.context.scene) == []


def _raise(curve):
    curve.location.z = 1
    bpy.context.view_layer.update()
    return True


def test_curves_of_plans_are_not_engraved_by_accident():
    scene(tool=plans.TOOL)
    bpy.ops.riffler.plan_find()
    ob = store().active(bpy.context)
    common.select(common.part("plan.path_curves").of(ob)[0])
    common.refused(lambda: bpy.ops.riffler.plan_find(strategy="ENGRAVE"), "No curve is selected")


def test_the_wall_above_a_pencil_path_is_cut_by_the_flank():
    scene(tool=plans.TOOL)
    bpy.ops.riffler.plan_find()
    pencil = store().active(bpy.context)
    assert bpy.ops.riffler.plan_find(strategy="SWARF") == {"FINISHED"}
    ob = store().active(bpy.context)
    assert ob != pencil and len(store().plan(pencil).paths[0].axes) == 0
    (path,) = store().plan(ob).paths
    wanted = riffler.plan.find("swarf", riffler.Mesh(*plans.step()), plans.TOOL, store().plan(pencil).paths).plan
    assert np.array_equal(path.axes, wanted.paths[0].axes) and np.allclose(path.axes, (0, 0, 1), atol=1e-5)
    assert rows(ob) == ["keyed"]
    bpy.ops.riffler.plan_to_timeline()  # its axes are keys
    assert len(store().plan(ob).paths[0].keys) == len(path)
    bpy.context.view_layer.objects.active = pencil
    settings().take(riffler.Tool.flat(6, 25).to_dict())
    common.refused(lambda: bpy.ops.riffler.plan_find(strategy="SWARF"), "tool", "ball")
    bpy.ops.riffler.plan_switch(which="NONE")
    common.refused(lambda: bpy.ops.riffler.plan_find(strategy="SWARF"), "There is no pencil path yet")


def test_a_wall_that_is_to_be_higher_than_the_flank_is_refused():
    scene(tool=plans.TOOL)
    bpy.ops.riffler.plan_find()
    common.refused(
        lambda: bpy.ops.riffler.plan_find(strategy="SWARF", swarf_height=1000.0), "height must be positive", "flank"
    )
