"""Recorded strokes become a plan: of the active sculpt, of a recording, on a moved stock, on the timeline."""

import bpy
import numpy as np
import riffler

from support import common
from support.device_sessions import Hand, sculpt
from support.keyframed_plan import curves, pair, paths, update
from support.sculpting import BALL, live, work

FLAT = riffler.Tool.flat(6, 30)


def store():
    return common.part("plan.plan_store")


def wave(y, n=200, lean=0.4):
    """A groove along x whose axis leans to and fro."""
    x = np.linspace(8, 50, n)
    tilt = lean * np.sin((x - 8) / 7)
    return np.column_stack([x, 0 * x + y, 0 * x + 18, 0 * x, np.sin(tilt), np.cos(tilt)])


def carved(*strokes):
    ob = sculpt("xyz")
    run = work(ob.name)
    for tool, poses in strokes:
        run.begin_stroke()
        run.carve(tool, poses)
        assert run.finish_stroke(bpy.context, "stroke")
    return ob


def planned(**options):
    before = set(store().in_scene(bpy.context.scene))
    assert bpy.ops.riffler.plan_from_strokes("EXEC_DEFAULT", True, **options) == {"FINISHED"}
    return [p for p in store().in_scene(bpy.context.scene) if p not in before]


def distance(path, poses, radius=3.0):
    """mm from the strokes' ball centres to the path, by its nearest of many points."""
    share = np.linspace(0, 1, 200)[:, None]
    line = np.vstack([a + share * (b - a) for a, b in zip(path.centres[:-1], path.centres[1:], strict=True)])
    return max(np.linalg.norm(line - c, axis=1).min() for c in poses[:, :3] + radius * poses[:, 3:])


def test_each_stroke_is_a_path_with_keys_where_its_axis_bends():
    ob = carved((BALL, wave(10)), (BALL, wave(30, lean=0.0)))
    (plan_ob,) = planned(tolerance=0.02)
    plan = store().plan(plan_ob)
    assert [len(p.keys) > 4 for p in plan.paths] == [True, False] and len(plan.paths[1].keys) == 2
    for path, y, lean in zip(plan.paths, (10, 30), (0.4, 0.0), strict=True):
        assert distance(path, wave(y, lean=lean)) < 0.021
    assert plan_ob.riffler.plan.part == ob and plan.part["name"] == ob.name
    assert not common.part("plan.operators.watch").judge(bpy.context, plan_ob).part, "the sculpt is the part"


def test_the_plan_is_edited_on_the_timeline_like_any_other():
    carved((BALL, wave(10)))
    (plan_ob,) = planned(tolerance=0.02)
    before = {k: np.array(a) for k, a in store().plan(plan_ob).paths[0].keys.items()}
    bpy.context.scene.riffler.plan.feed = 600
    assert bpy.ops.riffler.plan_to_timeline("EXEC_DEFAULT", True) == {"FINISHED"}
    assert not common.part("plan.plan_states").state(plan_ob).problems
    (path,) = paths(plan_ob)
    assert len(path.keys) == len(before), "every key has a frame of its own"
    for (_, mine), its in zip(sorted(path.keys.items()), (before[k] for k in sorted(before)), strict=True):
        assert np.allclose(mine, its, atol=1e-6)
    frame = curves(pair(plan_ob)[0])[0].keyframe_points[0].co[0]
    bpy.context.scene.frame_set(int(frame))
    assert bpy.ops.riffler.plan_key(axis=(0.3, 0, 1)) == {"FINISHED"}
    update()
    (path,) = paths(plan_ob)
    assert np.allclose(path.axes[0], np.array([0.3, 0, 1]) / np.hypot(0.3, 1), atol=1e-6)


def test_a_recording_of_a_hand_tool_is_refused_by_its_name():
    ob = carved((BALL, wave(10)))
    journal = riffler.Journal()
    journal.add_tool(1, riffler.Tool.gouge(6, 4, 0.5, 40))
    journal.add_stroke(1, [(8, 10, 18, 0, 0, 1, 1, 0, 0), (40, 10, 18, 0, 0, 1, 1, 0, 0)])
    path = common.out("hand_tool.rjournal")
    journal.save(path)
    bpy.context.view_layer.objects.active = ob
    common.refused(lambda: planned(recording=path), "hand tool", "gouge 6")


def test_a_moved_stock_moves_its_paths():
    ob = carved((BALL, wave(10)))
    ob.location, ob.rotation_euler = (5, 6, 7), (0, 0, np.pi / 2)
    bpy.context.view_layer.update()
    (plan_ob,) = planned()
    poses = wave(10)
    x, y, z, a, b, c = poses.T
    turned = np.column_stack([5 - y, 6 + x, 7 + z, -b, a, c])
    assert distance(store().plan(plan_ob).paths[0], turned) < 0.011
    bpy.context.view_layer.objects.active = ob
    ob.scale = (2, 2, 2)
    bpy.context.view_layer.update()
    common.refused(lambda: bpy.ops.riffler.plan_from_strokes(), "scale")


def test_each_tool_has_a_plan_and_a_flat_one_keeps_its_poses():
    carved((BALL, wave(10)), (FLAT, wave(30)))
    made = []
    said = common.printed(lambda: made.extend(planned()))
    tools = {p.riffler.plan.tool: store().plan(p) for p in made}
    assert len(made) == 2 and {len(p.depths) for p in tools.values()} == {0, 1}
    assert "is not a ball" in said


def test_a_recording_is_planned_without_a_sculpt():
    carved((BALL, wave(10)))
    live().end_all()
    part = bpy.context.object
    bpy.context.scene.riffler.plan.part = part
    journal = riffler.Journal()
    journal.add_tool(1, BALL)
    journal.add_stroke(1, wave(20))
    path = common.out("strokes.rjournal")
    journal.save(path)
    bpy.context.view_layer.objects.active = None
    (plan_ob,) = planned(recording=path)
    assert distance(store().plan(plan_ob).paths[0], wave(20)) < 0.011


def come(hand, y):
    """The tool follows the pointer by up to 2 mm with each event."""

    def there():
        hand._give(5, y, 0)
        pose = hand.session.run.pose
        return pose is not None and np.abs(pose[:2] - (5, y)).max() < 0.01

    hand.look(there)


@common.core_bound
def test_strokes_of_a_device_are_planned_and_motion_in_air_is_not():
    ob = sculpt("xyz")
    hand = Hand(ob)
    for y in (20, 40):
        come(hand, y)
        hand.stroke(y)
    hand.session.finish()
    (plan_ob,) = planned(tolerance=0.05)
    found = store().plan(plan_ob).paths
    assert len(found) == 2
    for path, y in zip(found, (20, 40), strict=True):
        assert np.abs(path.centres[:, 1] - y).max() < 0.1, path.centres.tolist()


def test_strokes_that_cannot_be_planned_are_reported():
    sculpt("xyz")
    common.refused(lambda: bpy.ops.riffler.plan_from_strokes(), "no cuts yet")
    bpy.context.view_layer.objects.active = None
    common.refused(lambda: bpy.ops.riffler.plan_from_strokes(), "Select a sculpt")
    common.refused(lambda: bpy.ops.riffler.plan_from_strokes(recording="nowhere.rjournal"), "nowhere")
    assert not store().in_scene(bpy.context.scene)
