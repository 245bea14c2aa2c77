"""A plan on the timeline through undo, files, another speed, cutter locations, copies, several plans."""

import bpy
import numpy as np
import riffler

from support import common, plans, programs
from support.keyframed_plan import close, curves, indices, insert, pair, paths, remove, seen, state, tracks, update


def test_a_key_and_its_consequences_are_one_step_of_undo():
    ob = plans.on_timeline()
    name = ob.name
    common.push("timeline")
    before = [p.axes for p in paths(ob)]
    insert(pair(ob)[0], 73, (0, -0.3, 1))
    common.push("key")
    with_key = [p.axes for p in paths(ob)]
    insert(pair(bpy.data.objects[name])[0], 20, (0, -0.2, 1))
    common.push("another")
    both = [p.axes for p in paths(bpy.data.objects[name])]

    def check(wanted, count):
        update()
        ob = bpy.data.objects[name]
        assert all(np.allclose(p.axes, a, atol=1e-7) for p, a in zip(paths(ob), wanted, strict=True))
        assert len(curves(pair(ob)[0])[0].keyframe_points) == 5 + count
        axis = seen(ob, 73)[1]
        assert close(axis, wanted[0][72], 1e-5), "the animation is not that of the plan"

    check(both, 2)
    for _ in range(2):
        bpy.ops.ed.undo()
        check(with_key, 1)
        bpy.ops.ed.undo()
        check(before, 0)
        bpy.ops.ed.redo()
        check(with_key, 1)
        bpy.ops.ed.redo()
        check(both, 2)


def test_undo_works_if_the_consequence_came_after_the_step():
    """As in a window: Blender's step is made when the key is set, the plan is updated a moment later."""
    ob = plans.on_timeline()
    name, replan = ob.name, common.part("plan.replan")
    common.push("timeline")
    before = paths(ob)[0].axes
    with_held(replan, lambda: (insert(pair(ob)[0], 73, (0, -0.3, 1)), common.push("key")))
    assert np.array_equal(paths(bpy.data.objects[name])[0].axes, before)
    replan.flush()
    after = paths(bpy.data.objects[name])[0].axes
    assert not np.allclose(after, before)
    for _ in range(2):
        bpy.ops.ed.undo()
        update()
        ob = bpy.data.objects[name]
        assert np.allclose(paths(ob)[0].axes, before, atol=1e-7) and close(seen(ob, 73)[1], before[72])
        bpy.ops.ed.redo()
        update()
        ob = bpy.data.objects[name]
        assert np.allclose(paths(ob)[0].axes, after, atol=1e-7) and close(seen(ob, 73)[1], after[72])


def test_undo_brings_resolved_paths_back_and_so_does_a_key_that_is_moved_back():
    """As in a window; Blender keeps the updated plan, since it is the same in both of its steps."""
    ob = programs.resolved(programs.valley(programs.LEANING, programs.LEANING))
    name, replan, store = ob.name, common.part("plan.replan"), common.part("plan.plan_store")
    common.push("resolved")
    identity, (rows,) = store.identity(ob), store.plan(ob).cl
    with_held(replan, lambda: (insert(pair(ob)[0], 73, (0, -0.3, 1)), common.push("key")))
    replan.flush()
    assert store.plan(bpy.data.objects[name]).cl == [None]
    for _ in range(2):
        bpy.ops.ed.undo()
        update()
        ob = bpy.data.objects[name]
        assert store.identity(ob) == identity and np.array_equal(store.plan(ob).cl[0], rows)
        assert bpy.ops.riffler.plan_nc("EXEC_DEFAULT", filepath=common.out("undone.ngc")) == {"FINISHED"}
        bpy.ops.ed.redo()
        update()
        ob = bpy.data.objects[name]
        assert store.plan(ob).cl == [None] and store.identity(ob) != identity
    remove(pair(ob)[0], 73)
    assert store.identity(ob) == identity
    bpy.context.scene.riffler.plan.clearance = 0.1
    insert(pair(ob)[0], 73, (0, -0.3, 1))
    bpy.ops.riffler.plan_resolve()
    assert store.plan(ob).cl[0] is not None
    remove(pair(ob)[0], 73)
    assert store.plan(ob).cl == [None], "what was resolved for another clearance came back"


def with_held(replan, action):
    """Runs it while no updates from keyframes are made."""
    soon, replan._soon = replan._soon, lambda: None
    try:
        action()
    finally:
        replan._soon = soon


def test_a_file_keeps_everything_when_saved_and_reopened():
    ob = plans.on_timeline()
    insert(pair(ob)[0], 73, (0, -0.3, 1))
    name, axes, where = ob.name, [p.axes for p in paths(ob)], seen(ob, 60.5)
    path = common.out("timeline.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile()
    bpy.ops.wm.open_mainfile(filepath=path)
    ob = bpy.data.objects[name]
    assert all(np.array_equal(p.axes, a) for p, a in zip(paths(ob), axes, strict=True))
    assert all(close(a, b, 1e-6) for a, b in zip(seen(ob, 60.5), where, strict=True))
    insert(pair(ob)[0], 100, (0.1, 0, 1))
    assert indices(ob)[0] == [0, 72, 99, 144] and not state(ob).problems


def test_a_file_whose_keys_were_edited_without_the_add_on():
    ob = plans.on_timeline()
    name, replan = ob.name, common.part("plan.replan")
    path = common.out("edited.blend")
    with_held(replan, lambda: (insert(pair(ob)[0], 73, (0, -0.3, 1)), bpy.ops.wm.save_as_mainfile(filepath=path)))
    bpy.ops.wm.read_homefile()
    bpy.ops.wm.open_mainfile(filepath=path)
    update()
    assert indices(bpy.data.objects[name])[0] == [0, 72, 144]


def test_another_speed_keeps_keys_and_orientations():
    ob = plans.on_timeline()
    insert(pair(ob)[0], 73, (0, -0.3, 1))
    before = paths(ob)
    places = [[tuple(p.centres[k]) for k in p.keys] for p in before]
    bpy.ops.riffler.plan_to_timeline(frames_per_mm=10, first=100)
    assert (tracks(ob)[0].first, tracks(ob)[0].last) == (100, 700)
    after = paths(ob)
    assert [[tuple(p.centres[k]) for k in p.keys] for p in after] == places
    assert len(after[0]) == 721, len(after[0])
    assert close(after[0].axes[::5], before[0].axes, 1e-6)
    assert close(seen(ob, 400)[1], before[0].axes[72], 1e-6)
    images = len(bpy.data.images)
    bpy.ops.riffler.plan_to_timeline(frames_per_mm=10, first=100)
    assert len(bpy.data.objects) == len(set(bpy.data.objects)) and len(bpy.data.images) == images
    assert [len(p) for p in paths(ob)] == [len(p) for p in after]


def test_cutter_locations_are_played_until_a_key_changes():
    """Rows that were lifted 5 mm, one was inserted, two are blocked."""
    ob = plans.on_timeline()
    store = common.part("plan.plan_store")
    plan = store.plan(ob)
    path = plan.paths[0]
    rows = np.hstack([path.centres + 2 * path.axes, path.axes])
    rows = np.vstack([rows[:50], (rows[50] + rows[51]) / 2, rows[53:]])
    rows[:, 3:] /= np.linalg.norm(rows[:, 3:], axis=1)[:, None]
    ring = plan.paths[1]
    store.write(ob, riffler.plan.Plan(plan.paths, plan.tool, cl=[rows, None], tolerance=0.01))
    common.part("plan.replan").sync(bpy.context.scene, ob)
    for frame in (1, 30, 49, 90, 145):
        tip, axis = seen(ob, frame)
        assert close(tip, path.centres[frame - 1] + 2 * path.axes[frame - 1], 2e-4)
    assert state(ob).difference.small
    insert(pair(ob)[0], 200, (0, 0.1, 1))  # the other path
    assert np.array_equal(store.plan(ob).cl[0], rows) and store.plan(ob).paths[1] is not ring
    insert(pair(ob)[0], 73, (0, -0.3, 1))
    assert store.plan(ob).cl[0] is None
    tip, axis = seen(ob, 30)
    assert close(tip + 3 * axis, path.centres[29], 2e-4)


def test_two_plans_do_not_mix():
    a = plans.on_timeline()
    b = plans.on_timeline()
    assert pair(a)[0] != pair(b)[0] and pair(a)[1] != pair(b)[1]
    insert(pair(b)[0], 73, (0, -0.3, 1))
    assert indices(a)[0] == [0, 144] and indices(b)[0] == [0, 72, 144]
    bpy.context.view_layer.objects.active = pair(a)[0]
    bpy.context.scene.frame_set(30)
    bpy.ops.riffler.plan_key(axis=(0, 0, 1))
    assert indices(a)[0] == [0, 29, 144] and indices(b)[0] == [0, 72, 144]


def test_a_copy_of_the_tool_has_no_plan_and_a_deleted_tool_is_made_again():
    ob = plans.on_timeline()
    tool, ghost = pair(ob)
    copy = tool.copy()
    bpy.context.collection.objects.link(copy)
    update()
    assert common.part("plan.timeline").plan_of(copy) is None and common.part("plan.timeline").plan_of(tool) == ob
    tool.name, ghost.name, ob.name = "Cutter", "Way", "Mine"
    insert(tool, 73, (0, -0.3, 1))
    assert indices(ob)[0] == [0, 72, 144]
    bpy.data.objects.remove(tool)
    bpy.data.objects.remove(copy)
    update()
    assert pair(ob) is None and indices(ob)[0] == [0, 72, 144]
    bpy.context.view_layer.objects.active = ob
    bpy.ops.riffler.plan_to_timeline()
    assert pair(ob)[1] == ghost and close(seen(ob, 73)[1], np.array((0, -0.3, 1)) / np.sqrt(1.09))


def test_a_deleted_or_scaled_tool_is_reported_and_a_deleted_plan_leaves_the_timeline():
    ob = plans.on_timeline()
    tool = pair(ob)[0]

    def faults(tool):
        return common.part("plan.timeline").faults(tool, bpy.context.scene)

    assert tuple(tool.lock_scale) == (True, True, True) and faults(tool) == []
    tool.scale = (2, 2, 2)
    update()
    assert "is scaled" in faults(tool)[0]
    tool.scale = (1, 1, 1)
    update()
    common.scale(1000.0)
    assert "unit has changed" in faults(tool)[0]
    common.scale(1.0)
    common.select(tool)
    bpy.ops.object.delete()
    update()
    assert pair(ob) is not None and "was deleted: use Plan to Timeline" in faults(tool)[0]
    common.select(ob)
    bpy.ops.riffler.plan_to_timeline()
    update()
    assert faults(tool) == [] and common.part("plan.plan_states").on_timeline() == [ob]
    common.select(ob)
    bpy.ops.object.delete()
    assert common.part("plan.plan_states").on_timeline() == []


def duplicated(*objects):
    """The result of Shift D on the first of them, with the others."""
    bpy.ops.object.select_all(action="DESELECT")
    for ob in objects:
        ob.select_set(True)
    bpy.context.view_layer.objects.active = objects[0]
    bpy.ops.object.duplicate()
    update()
    return bpy.context.object


def test_a_copy_of_a_plan_leaves_the_original_s_animation_alone():
    """The motion cannot be selected: a copy of the plan, with its tool or alone, points to the original's."""
    for with_tool in (True, False):
        bpy.ops.wm.read_homefile()
        ob = plans.on_timeline()
        tool, ghost = pair(ob)
        before = seen(ob, 73)[1]
        copy = duplicated(ob, *[tool] * with_tool)
        own = copy[common.part("plan.timeline").TOOL]
        assert copy != ob and (own != tool) == with_tool and pair(copy) is None and pair(ob) == (tool, ghost)
        if with_tool:
            insert(own, 73, (0, -0.3, 1))
            assert close(seen(ob, 73)[1], before) and indices(ob)[0] == [0, 144]
        common.select(copy)
        assert bpy.ops.riffler.plan_to_timeline() == {"FINISHED"}
        assert pair(copy)[1] != ghost and (pair(copy)[0] == own) == with_tool
        insert(pair(copy)[0], 73, (0, -0.3, 1))
        assert indices(copy)[0] == [0, 72, 144] and indices(ob)[0] == [0, 144]
        assert close(seen(copy, 73)[1], np.array((0, -0.3, 1)) / np.sqrt(1.09)) and close(seen(ob, 73)[1], before)


def test_keys_stay_with_the_paths_that_they_were_set_for():
    ob = plans.on_timeline()
    store = common.part("plan.plan_store")
    other = plans.ring(radius=30)
    store.write(ob, riffler.plan.Plan([other], plans.TOOL))
    insert(pair(ob)[0], 73, (0, -0.3, 1))
    assert "other paths" in state(ob).problems[0] and len(paths(ob)[0].axes) == 0
    common.refused(bpy.ops.riffler.plan_key, "other paths")
    bpy.ops.riffler.plan_to_timeline()
    assert not state(ob).problems and indices(ob) == [[]]


def test_a_scene_without_a_plan_has_no_work():
    states = common.part("plan.plan_states")
    calls, pair_of = [], common.part("plan.timeline").pair
    ob = bpy.data.objects["Cube"]
    states.on_timeline()
    common.part("plan.timeline").pair = lambda p: calls.append(p) or pair_of(p)
    try:
        for frame in range(1, 20):
            bpy.context.scene.frame_set(frame)
            ob.keyframe_insert("location", frame=frame)
            update()
    finally:
        common.part("plan.timeline").pair = pair_of
    assert calls == [] and states._states == {}
