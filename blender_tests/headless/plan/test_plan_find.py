"""Pencil cuts found in Blender: on a step, whose one valley has a closed form."""

import bpy
import numpy as np
import riffler

from support import common

WIDTH, RADIUS = 60.0, 3.0  # of the step along x, and of the ball; mm
PROFILE = ((0, 0), (40, 0), (40, 24), (20, 24), (20, 8), (0, 8))  # y, z


def step(name="Step", mm_per_unit=1.0, width=WIDTH):
    """A part with one inner edge along x, at y = 20, z = 8."""
    common.scale(mm_per_unit)
    vertices = [(x / mm_per_unit, y / mm_per_unit, z / mm_per_unit) for x in (0, width) for y, z in PROFILE]
    caps = [(0, 5, 4), (0, 4, 1), (1, 4, 3), (1, 3, 2)]
    caps += [(6 + c, 6 + b, 6 + a) for a, b, c in caps]
    sides = [(k, (k + 1) % 6, 6 + (k + 1) % 6, 6 + k) for k in range(6)]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, [], [*caps, *sides])
    ob = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(ob)
    bpy.context.view_layer.objects.active = ob
    bpy.context.view_layer.update()
    settings().part = ob
    return ob


def settings():
    return bpy.context.scene.riffler.plan


def store():
    return common.part("plan.plan_store")


def find(*how, **options):
    assert bpy.ops.riffler.plan_find(*how, **options) == {"FINISHED"}
    return store().active(bpy.context)


def curves(ob):
    return common.part("plan.path_curves").of(ob)


def judge(ob):
    bpy.context.view_layer.update()
    return common.part("plan.operators.watch").judge(bpy.context, ob)


def test_the_path_of_a_step_has_its_closed_form():
    for unit in (1.0, 1000.0):
        ob = find_on = step(mm_per_unit=unit)
        ob = find()
        (path,) = store().plan(ob).paths
        assert abs(path.length - WIDTH) < 0.01
        assert np.abs(path.centres[:, 1:] - (20 - RADIUS, 8 + RADIUS)).max() < 0.01
        (curve,) = curves(ob)
        co = np.array([p.co[:3] for p in curve.data.splines[0].points]) * unit
        assert np.allclose(co, path.centres, atol=1e-4) and curve.name.startswith("Path 1: 60.0 mm")
        assert curve.parent == ob and curve.users_collection == ob.users_collection
        assert (ob.riffler.plan.part, ob.riffler.plan.paths) == (find_on, 1) and abs(ob.riffler.plan.length - 60) < 0.01


def test_the_part_is_used_in_its_place():
    part = step()
    part.location, part.rotation_euler, part.scale = (5, 6, 7), (0, 0, np.pi / 2), (0.5, 1, 1)
    bpy.context.view_layer.update()
    (path,) = store().plan(find()).paths
    assert abs(path.length - WIDTH / 2) < 0.01
    assert np.abs(path.centres[:, [0, 2]] - (5 - 17, 7 + 11)).max() < 0.01
    assert abs(np.ptp(path.centres[:, 1]) - WIDTH / 2) < 0.01 and path.centres[:, 1].min() > 6 - 0.01


def test_the_plan_remembers_tool_tolerance_and_part():
    step()
    bpy.ops.riffler.plan_tool(name="Ball 10 mm")
    plan = store().plan(find(tolerance=0.02))
    assert plan.tool.name == "Ball 10 mm" and abs(plan.tolerance - 0.02) < 1e-9 and plan.paths[0].radius == 5
    assert plan.part["name"] == "Step" and len(plan.part["sha256"]) == 64
    assert store().plan(find(tool=common.BALL)).paths[0].radius == RADIUS


def test_passes_lie_on_both_sides_of_the_valley():
    step()
    ob = find(passes=2, stepover=0.5)
    assert len(store().plan(ob).paths) == 3 == len(curves(ob))
    assert all(c.name.startswith(f"Path {k + 1}: ") for k, c in enumerate(curves(ob)))


def test_a_part_without_valleys_gives_the_reason_and_makes_nothing():
    bpy.ops.mesh.primitive_cube_add(size=20)
    common.scale(1)
    settings().part = bpy.context.object
    before = len(bpy.data.objects), len(bpy.data.collections), len(bpy.data.images)
    common.refused(bpy.ops.riffler.plan_find, f"{settings().part.name}: no pencil cut", "nothing is concave")
    common.refused(lambda: bpy.ops.riffler.plan_find(replace="Nobody"), "no plan 'Nobody'")
    assert (len(bpy.data.objects), len(bpy.data.collections), len(bpy.data.images)) == before


def test_without_a_part_it_says_what_to_do():
    common.refused(bpy.ops.riffler.plan_find, "select one and use Set Part")
    ob = step()
    bpy.data.collections[ob.users_collection[0].name].objects.unlink(ob)
    common.refused(bpy.ops.riffler.plan_find, "Step was deleted", "set another part")
    bpy.data.objects.remove(ob)
    common.refused(bpy.ops.riffler.plan_find, "There is no part")


def test_a_changed_part_is_detected_and_an_equal_one_is_not():
    part = step()
    ob = find()
    assert judge(ob).part == ""
    part.data.vertices[2].co.z += 0.001
    part.data.update()
    assert "Step was changed or moved" in judge(ob).part
    part.data.vertices[2].co.z = PROFILE[2][1]
    part.data.update()
    assert judge(ob).part == ""
    part.location.x = 1
    assert "changed or moved" in judge(ob).part
    part.location.x = 0
    part.modifiers.new("Two", "ARRAY")
    assert "changed or moved" in judge(ob).part
    part.modifiers.clear()
    part.name = "Other"
    assert judge(ob).part == ""
    common.scale(2)
    assert "units" in judge(ob).part
    common.scale(1)
    bpy.data.objects.remove(part)
    assert judge(ob).part == "The part, Step, is gone from the scene"


def test_edits_of_curves_are_noticed_and_change_no_plan():
    step()
    ob = find(passes=2, stepover=0.5)
    before = riffler.plan.dumps(store().plan(ob))
    assert judge(ob).edited == 0
    a, b, c = curves(ob)
    a.data.splines[0].points[0].co.x += 0.1
    b.location.z = 1
    assert judge(ob).edited == 2
    bpy.data.objects.remove(c)
    assert judge(ob).edited == 3
    store().clear_cache()
    assert riffler.plan.dumps(store().plan(ob)) == before
    bpy.context.view_layer.objects.active = curves(ob)[0]
    bpy.ops.riffler.plan_show()
    ob = store().active(bpy.context)
    assert judge(ob).edited == 0 and len(curves(ob)) == 3


def test_find_is_one_undo_step():
    step()
    common.push("part")
    bpy.ops.riffler.plan_find("EXEC_DEFAULT", True)
    name, key = store().active(bpy.context).name, store().identity(store().active(bpy.context))
    bpy.ops.ed.undo()
    assert store().in_scene(bpy.context.scene) == [] and not [c for c in bpy.data.curves if c.name.startswith("Path")]
    bpy.ops.ed.redo()
    ob = bpy.data.objects[name]
    assert store().identity(ob) == key and len(curves(ob)) == 1 and judge(ob).part == ""


def test_finding_again_replaces_the_paths_of_that_plan():
    part = step()
    first = find()
    name = first.name
    part.scale.x = 0.5
    bpy.context.view_layer.update()
    common.push("narrow")
    bpy.ops.riffler.plan_find("EXEC_DEFAULT", True, replace=name)
    ob = bpy.data.objects[name]
    assert store().in_scene(bpy.context.scene) == [ob]
    assert abs(store().plan(ob).paths[0].length - WIDTH / 2) < 0.01 and judge(ob).part == ""
    assert [c.name for c in curves(ob)] == ["Path 1: 30.0 mm"]
    bpy.ops.ed.undo()
    ob = bpy.data.objects[name]
    assert abs(store().plan(ob).paths[0].length - WIDTH) < 0.01 and [c.name for c in curves(ob)] == ["Path 1: 60.0 mm"]


def test_two_plans_have_nothing_to_do_with_each_other():
    a_part = step("A")
    a = find()
    b_part = step("B", width=30.0)
    b = find()
    assert a != b and a.users_collection != b.users_collection
    assert abs(store().plan(a).paths[0].length - 60) < 0.01 and abs(store().plan(b).paths[0].length - 30) < 0.01
    b_part.location.x = 3
    assert judge(a).part == "" and judge(b).part != ""
    find(replace=a.name)  # on its own part, not the scene's
    assert abs(store().plan(a).paths[0].length - 60) < 0.01 and a.riffler.plan.part == a_part
    bpy.context.view_layer.objects.active = curves(a)[0]
    assert store().active(bpy.context) == a and a.riffler.plan.part == a_part


def test_a_duplicated_plan_is_a_plan_of_its_own():
    part = step()
    first = find()
    bpy.ops.object.select_all(action="DESELECT")
    for ob in (first, *curves(first)):
        ob.select_set(True)
    bpy.ops.object.duplicate()
    (second,) = (ob for ob in store().in_scene(bpy.context.scene) if ob != first)
    assert len(curves(first)) == len(curves(second)) == 1 and store().identity(first) == store().identity(second)
    part.scale.x = 0.5
    bpy.context.view_layer.update()
    find(replace=second.name)
    assert abs(store().plan(first).paths[0].length - 60) < 0.01 and curves(first)[0].name.startswith("Path 1: 60.0 mm")
    assert abs(store().plan(second).paths[0].length - 30) < 0.01 and len(curves(second)) == 1
    assert judge(first).edited == 0 and judge(first).part != "" and judge(second).part == ""


def names():
    return {c.name for c in bpy.data.objects if c.type == "CURVE"}


def redraw(ob):
    bpy.ops.object.select_all(action="DESELECT")
    bpy.context.view_layer.objects.active = ob
    assert bpy.ops.riffler.plan_show() == {"FINISHED"}


def test_copies_of_path_curves_belong_to_the_user():
    """By any method of copying; also if the original curve was deleted since."""
    step()
    ob = find(passes=2, stepover=0.5)
    a, b, c = curves(ob)
    kept = set()
    for curve, linked in ((a, False), (b, True), (c, False)):
        common.select(curve)
        bpy.ops.object.duplicate(linked=linked)
        kept.add(bpy.context.object.name)
    by_script = a.copy()
    ob.users_collection[0].objects.link(by_script)
    kept.add(by_script.name)
    common.select(c)
    bpy.ops.object.delete()
    assert len(curves(ob)) == 2 and judge(ob).edited == 1 and len(names()) == 7  # the plan points to the deleted one
    was = {name: [p.co[:] for p in bpy.data.objects[name].data.splines[0].points] for name in kept}
    redraw(ob)
    assert len(curves(ob)) == 3 and judge(ob).edited == 0 and names() == kept | {c.name for c in curves(ob)}
    assert {name: [p.co[:] for p in bpy.data.objects[name].data.splines[0].points] for name in kept} == was
    find(replace=ob.name)
    assert kept <= names() and len(curves(ob)) == 1 and len(names()) == 5
    assert not [d for d in bpy.data.curves if not d.users], "what was drawn is gone with its points"


def test_renamed_or_used_curves_belong_to_the_user():
    step()
    ob = find(passes=4, stepover=0.5)
    named, bound, parent, cut, other, thick, *_ = curves(ob)
    named.name = "Nose"
    follower = bpy.data.objects.new("Follower", None)
    bpy.context.scene.collection.objects.link(follower)
    follower.constraints.new("FOLLOW_PATH").target = bound
    rider = bpy.data.objects.new("Rider", None)
    bpy.context.scene.collection.objects.link(rider)
    rider.parent = parent
    bpy.context.scene.riffler.cut.curve = cut
    bpy.context.scene.collection.objects.link(other)
    thick.modifiers.new("Thick", "SOLIDIFY")
    kept = {c.name for c in (named, bound, parent, cut, other, thick)}
    redraw(ob)
    assert kept <= names() and len(curves(ob)) == 7 and len(names()) == 13 and judge(ob).edited == 0
    assert follower.constraints[0].target.name in kept and rider.parent.name in kept
    assert not kept & {c.name for c in curves(ob)}
    redraw(ob)
    assert kept <= names() and len(names()) == 13, "curves drawn the second time did not belong to the user"


def test_a_copy_of_the_plan_alone_removes_no_curves():
    step()
    ob = find()
    common.select(ob)
    bpy.ops.object.duplicate()
    twin = bpy.context.object
    assert store().is_plan(twin) and curves(twin) == [] and len(curves(ob)) == 1
    before = names()
    redraw(twin)
    assert before < names() and len(curves(twin)) == len(curves(ob)) == 1
    redraw(ob)
    assert len(names()) == 2


def test_curves_copied_with_their_plan_belong_to_the_copy():
    step()
    ob = find()
    common.select(ob)
    curves(ob)[0].select_set(True)
    bpy.ops.object.duplicate()
    (twin,) = (p for p in store().in_scene(bpy.context.scene) if p != ob)
    redraw(twin)
    assert len(names()) == 2 and len(curves(twin)) == len(curves(ob)) == 1, "nothing is left of what was copied"


def test_work_for_a_panel_is_done_once():
    """A part is read again only if it was changed; other objects cost nothing."""
    part, watch = step(), common.part("plan.operators.watch")
    ob = find()
    bpy.context.view_layer.update()
    other = common.curve("Other", [(0, 0, 0), (1, 1, 1)])

    def known():
        bpy.context.view_layer.update()
        return watch.known(bpy.context, ob)

    assert known() is None, "never while drawing"
    watch._changed = 0.0
    watch._look()
    assert known() == watch.Verdict("", 0)
    other.location.x = 1
    assert known() == watch.Verdict("", 0)
    for change in (lambda: setattr(part.location, "x", 1), lambda: setattr(curves(ob)[0].location, "x", 1)):
        change()
        assert known() is None and watch._look() > 0, "not before the scene is left alone"
        watch._changed = 0.0
        assert watch._look() is None and known() is not None
    assert known().edited == 1 and "moved" in known().part
    bpy.data.objects.remove(part)
    assert known() is None, "it is gone: something else than it was"


def test_a_live_sculpt_is_a_part_in_its_present_state():
    common.scale(1)
    part = common.stock(size=(40, 30, 20), pitch=0.5, directions="xyz")
    live = common.part("sculpt.live_registry")
    run = live.begin(bpy.context, part)
    run.begin_stroke()
    slot = np.array([(x, 15, 12, 0, 0, 1) for x in (-10.0, 50.0)])
    run.carve(riffler.Tool.flat(12, 30), slot)
    run.finish_stroke(bpy.context, "Slot")
    settings().part = part
    plan = store().plan(find())
    assert live.of(part) is None
    long = [p for p in plan.paths if p.length > 30]
    middle = sorted(p.centres[len(p) // 2].tolist()[1:] for p in long)
    assert np.allclose(middle, [(12, 15), (18, 15)], atol=0.1), middle
    assert judge(store().active(bpy.context)).part == ""


def test_a_file_keeps_everything_when_saved_and_reopened():
    step()
    ob = find()
    name, key = ob.name, store().identity(ob)
    path = common.out("found.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile()
    bpy.ops.wm.open_mainfile(filepath=path)
    ob = bpy.data.objects[name]
    assert store().identity(ob) == key and judge(ob) == common.part("plan.operators.watch").Verdict("", 0)
    assert settings().part.name == "Step" and len(curves(ob)) == 1
    bpy.ops.riffler.plan_find(replace=name)
    assert store().identity(ob) == key, "the same part, the same plan: the same bytes"


def test_running_work_blocks_a_search():
    step()
    bpy.context.window_manager.riffler.running = "Cutting"
    common.refused(bpy.ops.riffler.plan_find, "Cutting: Esc cancels")
    bpy.context.window_manager.riffler.running = ""
    assert find() is not None
