"""Operators of key orientations, a tool that the user turns, and colliding frames."""

import time

import bpy
import numpy as np
import riffler

from support import common, plans
from support.keyframed_plan import (
    close,
    curves,
    indices,
    insert,
    pair,
    paths,
    quat,
    remove,
    same_axes,
    seen,
    state,
    update,
)


def test_the_operators_set_delete_and_jump():
    ob = plans.on_timeline()
    scene = bpy.context.scene
    scene.frame_set(73)
    assert bpy.ops.riffler.plan_key(axis=(0, -0.6, 2)) == {"FINISHED"}  # of any length
    assert same_axes(paths(ob)[0], {0: (0, -0.6, 0.8), 72: (0, -0.3, 1), 144: (0.6, 0, 0.8)})
    scene.frame_set(90)
    wanted = paths(ob)[0].axes[89]
    bpy.ops.riffler.plan_key()  # with its current orientation
    assert close(paths(ob)[0].keys[89], wanted, 1e-5)
    bpy.ops.riffler.plan_key(axis=(0, 0, 1), path=2, point=10)
    assert close(paths(ob)[1].keys[10], (0, 0, 1), 1e-6)
    scene.frame_set(80)
    bpy.ops.riffler.plan_key_jump(back=False)
    assert scene.frame_current_final == 90
    bpy.ops.riffler.plan_key_jump(back=True)
    assert scene.frame_current_final == 73
    bpy.ops.riffler.plan_key_delete()
    assert indices(ob)[0] == [0, 89, 144]
    common.refused(bpy.ops.riffler.plan_key_delete, "no key at frame 73")
    scene.frame_set(1)
    common.refused(lambda: bpy.ops.riffler.plan_key_jump(back=True), "no key before")
    scene.frame_set(150)
    common.refused(bpy.ops.riffler.plan_key, "Frame 150 is on no path", "1 and 145")
    common.refused(lambda: bpy.ops.riffler.plan_key(path=3), "the plan has 2")
    common.refused(lambda: bpy.ops.riffler.plan_key(path=1, point=145), "path 1 has 145")
    keys = indices(ob)
    scene.frame_set(20)
    common.refused(lambda: bpy.ops.riffler.plan_key(axis=(0, 0.6, -0.8)), "opposite")
    common.refused(lambda: bpy.ops.riffler.plan_key(axis=(np.nan, 0, 1)), "finite")
    assert indices(ob) == keys and len(curves(pair(ob)[0])[0].keyframe_points) == 7


def test_an_operator_s_key_is_one_step():
    ob = plans.on_timeline()
    name = ob.name
    common.push("timeline")
    bpy.context.scene.frame_set(73)
    bpy.ops.riffler.plan_key("EXEC_DEFAULT", True, axis=(0, -0.3, 1))
    bpy.ops.ed.undo()
    update()
    assert indices(bpy.data.objects[name])[0] == [0, 144]
    bpy.ops.ed.redo()
    update()
    assert indices(bpy.data.objects[name])[0] == [0, 72, 144]


def test_the_operators_name_what_is_missing():
    bpy.context.view_layer.objects.active = None
    for call in ("plan_to_timeline", "plan_key", "plan_key_delete", "plan_key_jump", "plan_check"):
        assert not getattr(bpy.ops.riffler, call).poll()
        common.refused(getattr(bpy.ops.riffler, call), "plan")
    plan = riffler.plan.Plan(plans.paths(), plans.TOOL)
    ob = common.part("plan.plan_store").new(bpy.context, plan)
    common.refused(bpy.ops.riffler.plan_key, "not on the timeline")
    common.part("plan.plan_store").write(ob, riffler.plan.Plan([], plans.TOOL))
    common.refused(bpy.ops.riffler.plan_to_timeline, "no paths")
    assert "Riffler Tool" not in bpy.data.objects


def test_a_tool_that_the_user_turns_is_not_held():
    ob = plans.on_timeline()
    tool, _ = pair(ob)
    hold = tool.constraints[common.part("plan.timeline").TURN]
    tip = seen(ob, 73)[0]
    tool.rotation_quaternion = quat((0.3, 0, 1))
    update()
    update()
    assert hold.influence == 0
    shown = np.array(tool.evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world)
    assert close(shown[:3, 2], np.array((0.3, 0, 1)) / np.sqrt(1.09)) and close(shown[:3, 3], tip)
    bpy.ops.riffler.plan_key()
    assert close(paths(ob)[0].keys[72], np.array((0.3, 0, 1)) / np.sqrt(1.09))
    update()
    assert hold.influence == 1 and close(seen(ob, 73)[1], np.array((0.3, 0, 1)) / np.sqrt(1.09))
    tool.rotation_quaternion = quat((0, 1, 1))
    update()
    assert hold.influence == 0
    seen(ob, 74)  # as everywhere in Blender, an orientation without a key is lost with the frame
    update()
    assert hold.influence == 1 and close(seen(ob, 74)[1], paths(ob)[0].axes[73])


def test_turning_begins_with_the_displayed_axis():
    """Between keys, on a key, and on a path that has none; the test calls what a window's timer would call."""
    ob = plans.on_timeline(chosen=[*plans.paths()[:1], plans.ring()])
    tool, _ = pair(ob)
    ready = common.part("plan.replan")._settle_all
    for frame in (1, 50, 73, 145, 200, 310.5):
        axis = seen(ob, frame)[1]
        ready()
        update()
        assert close(np.array(tool.rotation_quaternion.to_matrix())[:, 2], axis, 1e-4), frame
        assert tool.constraints[common.part("plan.timeline").TURN].influence == 1
    bpy.context.scene.frame_set(145)
    ready()
    # Blender shows the keyed orientation
    assert list(tool.rotation_quaternion) == [c.evaluate(145) for c in curves(tool)]


def test_a_plan_without_keys_gets_its_first_one():
    ob = plans.on_timeline(chosen=[plans.ring()])
    tool = pair(ob)[0]
    assert not state(ob).problems and indices(ob) == [[]]
    tip, axis = seen(ob, 40)
    bpy.ops.riffler.plan_key()
    assert len(indices(ob)[0]) == 1 and close(paths(ob)[0].axes, np.tile(axis, (len(paths(ob)[0]), 1)))
    assert close(seen(ob, 40)[0], tip, 1e-4) and len(curves(tool)[0].keyframe_points) == 1


def markers():
    """Except those that name the paths."""
    return sorted((m.frame, m.name) for m in bpy.context.scene.timeline_markers if "▸ " not in m.name)


def test_colliding_frames_are_marked_and_checked_again_where_keys_change():
    part = plans.part_object()
    ob = plans.on_timeline(chosen=plans.paths()[:1])
    bpy.context.scene.timeline_markers.new("mine", frame=5)
    common.refused(bpy.ops.riffler.plan_check, "There is no part")
    bpy.context.scene.riffler.plan.part = part
    bpy.ops.riffler.plan_check()
    assert markers() == [(5, "mine")] and state(ob).colliding == []
    looks = state(ob).looks
    assert looks >= 145
    insert(pair(ob)[0], 73, (0, 1, 0.2))  # into the wall, y from 20 on
    (run,) = state(ob).colliding
    assert run[0] <= 73 <= run[1] and (run[0], f"collides {run[0]}–{run[1]}") in markers() and len(markers()) == 2
    # compared with the closed form: the shank is a cylinder of 6 mm about the axis through the ball's centre, up to z =
    # 24
    for frame in range(1, 146):
        axis = seen(ob, frame)[1]
        inside = axis[1] > 1e-3
        if run[0] < frame < run[1] or frame < run[0] - 1 or frame > run[1] + 1:
            assert inside == (run[0] < frame < run[1]), (frame, axis, run)
    looks = state(ob).looks
    remove(pair(ob)[0], 73)
    assert state(ob).colliding == [] and markers() == [(5, "mine")] and state(ob).looks == looks


def test_marks_of_one_plan_stay_while_another_is_checked():
    part = plans.part_object()
    first, second = (plans.on_timeline(chosen=plans.paths()[:1]) for _ in range(2))
    bpy.context.scene.riffler.plan.part = part
    insert(pair(first)[0], 73, (0, 1, 0.2))
    common.select(first)
    bpy.ops.riffler.plan_check()
    marked = markers()
    assert len(marked) == 1 and len(state(first).colliding) == 1
    common.select(second)
    bpy.ops.riffler.plan_check()
    assert state(second).colliding == [] and markers() == marked
    insert(pair(second)[0], 20, (0, 1, 0.2))
    assert len(state(second).colliding) == 1 and markers()[0][0] == state(second).colliding[0][0] < marked[0][0]
    remove(pair(second)[0], 20)
    assert markers() == marked
    remove(pair(first)[0], 73)
    assert markers() == []


def test_only_paths_whose_keys_changed_are_checked():
    part = plans.part_object()
    ob = plans.on_timeline()
    bpy.context.scene.riffler.plan.part = part
    bpy.ops.riffler.plan_check()
    looks = state(ob).looks
    insert(pair(ob)[0], 73, (0, -0.5, 1))
    assert 0 < state(ob).looks - looks <= 200  # of the valley, which has 145 points; the ring has 360


def fixture(xs, ys, zs):
    """A box, in the collection of fixtures."""
    mesh = bpy.data.meshes.new("Vise")
    x, y, z = np.meshgrid(xs, ys, zs, indexing="ij")
    corners = np.c_[x.ravel(), y.ravel(), z.ravel()]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    mesh.from_pydata(corners.tolist(), [], faces)
    vise = bpy.data.objects.new("Vise", mesh)
    collection = bpy.data.collections.new("Fixtures")
    bpy.context.scene.collection.children.link(collection)
    collection.objects.link(vise)
    bpy.context.scene.riffler.plan.fixtures = collection
    update()
    return vise


def test_fixtures_are_checked_for_collisions():
    part = plans.part_object()
    ob = plans.on_timeline(chosen=[plans.paths()[0].orient({0: (0, -0.6, 0.8)})])
    fixture((20, 40), (0, 10), (8, 40))
    bpy.context.scene.riffler.plan.part = part
    bpy.ops.riffler.plan_check()
    # The tool leans away from the wall, over the vise; the cutter, 3 mm in radius, is inside it for x in 17 … 43, that
    # is after frame 41.8 and before 104.2.
    assert state(ob).colliding == [(42, 104)]


def looked_again():
    """What a window's timer does once the scene has not changed for a moment."""
    again = common.part("plan.collision_marks").look_again
    while again() is not None:
        time.sleep(0.01)


def test_marks_are_outdated_once_a_fixture_has_moved_until_the_next_check():
    part = plans.part_object()
    ob = plans.on_timeline(chosen=[plans.paths()[0].orient({0: (0, -0.6, 0.8)})])
    outdated = common.part("plan.collision_marks").outdated
    vise = fixture((20, 40), (0, 10), (8, 40))
    assert not outdated(ob)  # no marks were requested
    bpy.context.scene.riffler.plan.part = part
    bpy.ops.riffler.plan_check()
    assert state(ob).colliding == [(42, 104)] and not outdated(ob)
    made, looks = common.part("plan.obstacles").made, state(ob).looks
    vise.location.x += 5
    update()
    assert outdated(ob) and state(ob).colliding == [(42, 104)]
    looked_again()
    # 5 mm, at 2.4 frames a mm, against the path's direction or along it
    along = np.sign(paths(ob)[0].centres[-1, 0] - paths(ob)[0].centres[0, 0])
    assert not outdated(ob) and np.allclose(state(ob).colliding, np.add([(42, 104)], along * 12), atol=1)
    assert common.part("plan.obstacles").made == made + 1 and state(ob).looks > looks
    looks = state(ob).looks
    vise.location.x += 0  # Blender reports a change
    vise.update_tag()
    update()
    looked_again()
    assert not outdated(ob) and state(ob).looks == looks and common.part("plan.obstacles").made == made + 1


def test_marks_of_an_opened_file_or_a_renamed_plan_are_checked_again():
    part = plans.part_object()
    ob = plans.on_timeline(chosen=[plans.paths()[0].orient({0: (0, -0.6, 0.8)})])
    outdated = common.part("plan.collision_marks").outdated
    vise = fixture((20, 40), (0, 10), (8, 40))
    bpy.context.scene.riffler.plan.part = part
    bpy.ops.riffler.plan_check()
    assert markers() == [(42, "collides 42–104")] and not outdated(ob)
    vise.location.z = -100
    path, name = common.out("marked.blend"), ob.name
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile()
    bpy.ops.wm.open_mainfile(filepath=path)
    ob = bpy.data.objects[name]
    assert markers() and outdated(ob), "nothing says that the marks are of before"
    looked_again()
    assert not outdated(ob) and markers() == []
    bpy.data.objects["Vise"].location.z = 0
    ob.name = "Mine"
    assert outdated(ob)
    pair(ob)[0].update_tag()
    update()
    looked_again()
    assert not outdated(ob) and markers() == [(42, "collides 42–104")]


def test_marks_that_are_undone_do_not_come_back_by_themselves():
    part = plans.part_object()
    ob = plans.on_timeline(chosen=plans.paths()[:1])
    bpy.context.scene.riffler.plan.part, name = part, ob.name
    insert(pair(ob)[0], 73, (0, 1, 0.2))
    common.push("plan")
    bpy.ops.riffler.plan_check("EXEC_DEFAULT", True)
    assert len(markers()) == 1
    bpy.ops.ed.undo()
    update()
    assert markers() == [] and not common.part("plan.collision_marks").outdated(bpy.data.objects[name])
    bpy.ops.ed.redo()
    update()
    assert len(markers()) == 1
