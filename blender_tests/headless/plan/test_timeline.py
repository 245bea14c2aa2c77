"""Keyframes of the tool are the plan's key orientations: edited like a user's edits, through F-curves and Blender's own
operators."""

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
    tracks,
    update,
)


def test_the_plan_s_keys_are_keyframes():
    ob = plans.on_timeline()
    tool, ghost = pair(ob)
    assert not state(ob).problems and ghost.hide_render and common.part("plan.plan_store").active(bpy.context) == ob
    first, second = tracks(ob)
    # 60 mm and 2π 20 mm at 600 mm/min and 24 frames a second, the second after ten frames
    assert (first.first, first.last) == (1, 145)
    assert second.first == 155 and second.last - second.first == np.ceil(2.4 * paths(ob)[1].length)
    frames = sorted({p.co[0] for c in curves(tool) for p in c.keyframe_points})
    assert frames == [1, 145, 155, 155 + round((second.last - 155) / 3), 155 + round((second.last - 155) * 2 / 3)]
    assert bpy.context.scene.frame_end == second.last
    assert np.linalg.norm(np.diff(paths(ob)[0].centres, axis=0), axis=1).max() <= 1 / 2.4 + 1e-9


def test_a_scene_that_begins_later_plays_the_paths():
    scene = bpy.context.scene
    scene.frame_end, scene.frame_start = 1100, 1001
    ob = plans.on_timeline()
    assert (scene.frame_start, scene.frame_end) == (1, 1100)
    bpy.ops.riffler.plan_to_timeline(first=5)
    scene.frame_end = 5
    bpy.ops.riffler.plan_to_timeline(first=3)
    assert (scene.frame_start, scene.frame_end) == (1, tracks(ob)[1].last)


def test_jumping_works_with_stretched_time():
    scene = bpy.context.scene
    for old, new in ((100, 200), (100, 300), (250, 100), (100, 100)):
        bpy.ops.wm.read_homefile()
        scene = bpy.context.scene
        scene.render.frame_map_old, scene.render.frame_map_new = old, new
        ob = plans.on_timeline()
        first, second = tracks(ob)
        assert scene.frame_end >= second.last * new / old
        bpy.ops.riffler.plan_point(path=2, point=30)
        assert abs(scene.frame_current_final - second.frame_of(30)) < 1e-3, (old, new)
        bpy.ops.riffler.plan_key_jump(back=True)
        assert abs(scene.frame_current_final - second.first) < 1e-3, (old, new)
        found = {"kind": "lifted", "path": 0, "point": 7, "name": "here"}
        common.part("plan.findings").write(ob.riffler.plan.findings, [found])
        bpy.ops.riffler.finding_go(of="PLAN", index=0)
        assert abs(scene.frame_current_final - first.frame_of(7)) < 1e-3, (old, new)


def test_a_tool_that_was_deleted_is_in_the_scene_again():
    ob = plans.on_timeline()
    for gone in pair(ob):
        for collection in gone.users_collection:
            collection.objects.unlink(gone)  # like X: the plan still refers to it
    common.select(ob)
    assert bpy.ops.riffler.plan_to_timeline() == {"FINISHED"}
    assert all(found.name in bpy.context.scene.objects for found in pair(ob))


def test_scrubbing_moves_the_tool_along_the_paths():
    """Compared with the closed form: the valley's ball runs on a line, the ring's on a circle; the tip is 3 mm below,
    along the axis."""
    for scale in (1.0, 1000.0):
        bpy.ops.wm.read_homefile()
        ob = plans.on_timeline(scale)
        for frame in (1, 17, 40.5, 100.25, 145):
            tip, axis = seen(ob, frame)
            wanted = np.array([60 * (frame - 1) / 144, 17, 11])
            assert close(tip + 3 * axis, wanted, 2e-4), (scale, frame, tip + 3 * axis)
        ring = tracks(ob)[1]
        for share in (0, 0.1, 0.35, 0.8, 1):
            tip, axis = seen(ob, ring.first + share * (ring.last - ring.first))
            a = 2 * np.pi * share
            assert close(tip + 3 * axis, (20 * np.cos(a), 20 * np.sin(a), 3), 0.02)  # the ring has 90 corners
        assert close(seen(ob, 150)[0], seen(ob, 145)[0])  # between paths it waits


def test_what_plays_is_what_nc_code_does():
    """Blender's own evaluation of the curves at ten times as many places as there are points, compared with the program
    read from its NC text."""
    valley, loop = plans.paths()
    ob = plans.on_timeline(chosen=[valley, loop])
    _, ghost = pair(ob)
    found = common.part("blender.versions").channels(ghost)
    tool = plans.TOOL
    for path, track in zip(paths(ob), tracks(ob), strict=True):
        poses = np.hstack([path.centres - 3 * path.axes, path.axes])
        poses = np.vstack([poses, poses[:1]]) if path.closed else poses
        program = riffler.Program.from_cl([poses], tools=[tool], feed=600)
        program.write(common.out("timeline.ngc"), post="tcp")
        read = riffler.Program.read(common.out("timeline.ngc"), machine="tcp").poses
        begin = int(np.linalg.norm(read - poses[0], axis=1).argmin())
        read = read[begin : begin + int(np.linalg.norm(read[begin:] - poses[-1], axis=1).argmin() + 1 + len(poses))]
        frames = np.interp(
            np.linspace(0, len(track.frames) - 1, 10 * len(poses) + 1), range(len(track.frames)), track.frames
        )
        play = np.array([[found.find(p, index=i).evaluate(f) for p, i in CHANNELS] for f in frames])
        tips, axes = play[:, :3], common.part("common.quaternions").axes_of(play[:, 3:])
        off, turn = nearest(read, tips, axes)
        assert off.max() <= 0.01 and turn.max() <= np.radians(0.01), (off.max(), np.degrees(turn.max()))
        said = state(ob).difference
        assert said.small and said.samples > 10 * len(poses)


CHANNELS = [("location", i) for i in range(3)] + [("rotation_quaternion", i) for i in range(4)]


def nearest(poses, tips, axes):
    """For each tip the distance to the program's polyline, and for its axis to the great circle there."""
    a, b = poses[:-1], poses[1:]
    off, turn = np.empty(len(tips)), np.empty(len(tips))
    way = b[:, :3] - a[:, :3]
    square = np.maximum(np.einsum("ij,ij->i", way, way), 1e-300)
    for k, (tip, axis) in enumerate(zip(tips, axes, strict=True)):
        share = np.clip(np.einsum("ij,ij->i", tip - a[:, :3], way) / square, 0, 1)
        gap = np.linalg.norm(a[:, :3] + share[:, None] * way - tip, axis=1)
        best = np.flatnonzero(gap < gap.min() + 1e-4)
        angle = np.arccos(np.clip(np.einsum("ij,ij->i", a[best, 3:], b[best, 3:]), -1, 1))
        s = share[best]
        with np.errstate(invalid="ignore", divide="ignore"):
            mean = (np.sin((1 - s) * angle)[:, None] * a[best, 3:] + np.sin(s * angle)[:, None] * b[best, 3:]) / np.sin(
                angle
            )[:, None]
        mean = np.where(angle[:, None] < 1e-7, a[best, 3:], mean)
        off[k] = gap.min()
        turn[k] = 2 * np.arcsin(np.clip(np.linalg.norm(mean - axis, axis=1) / 2, 0, 1)).min()
    return off, turn


def test_a_key_is_added_by_its_curves():
    ob = plans.on_timeline()
    before, baked = paths(ob), state(ob).baked
    insert(pair(ob)[0], 73, (0, -0.3, 1))
    after = paths(ob)
    assert same_axes(after[0], {0: (0, -0.6, 0.8), 72: (0, -0.3, 1), 144: (0.6, 0, 0.8)})
    assert state(ob).changes[0].added == [72] and state(ob).baked == baked + 1, (state(ob).baked, baked)
    assert np.array_equal(after[1].axes, before[1].axes) and after[1].keys.keys() == before[1].keys.keys()
    assert close(seen(ob, 73)[1], np.array((0, -0.3, 1)) / np.sqrt(1.09))
    reference = after[0].orient({0: (0, -0.6, 0.8), 72: after[0].keys[72], 144: (0.6, 0, 0.8)}, interpolation="smooth")
    assert close(after[0].axes, reference.axes, 1e-12)
    assert close(seen(ob, 37)[1], reference.axes[36])


def test_a_key_is_added_by_keyframe_insert():
    ob = plans.on_timeline()
    tool = pair(ob)[0]
    bpy.context.scene.frame_set(200)
    tool.rotation_quaternion = quat((0.2, 0.1, 1))
    tool.keyframe_insert("rotation_quaternion")
    update()
    index = tracks(ob)[1].nearest(200)
    assert index in paths(ob)[1].keys and close(paths(ob)[1].keys[index], np.array((0.2, 0.1, 1)) / np.sqrt(1.05))
    assert state(ob).changes[1].added == [index] and indices(ob)[0] == [0, 144]


def test_a_key_is_moved():
    ob = plans.on_timeline()
    for curve in curves(pair(ob)[0]):
        next(p for p in curve.keyframe_points if p.co[0] == 145).co[0] = 100
    update()
    assert state(ob).changes[0].moved == [(144, 99)] and indices(ob)[0] == [0, 99]
    assert np.array_equal(paths(ob)[0].keys[99], (0.6, 0, 0.8))  # the exact number, not its single precision
    assert close(seen(ob, 145)[1], (0.6, 0, 0.8)) and close(seen(ob, 100)[1], (0.6, 0, 0.8))


def test_a_key_moves_from_one_path_to_the_other():
    ob = plans.on_timeline()
    for curve in curves(pair(ob)[0]):
        next(p for p in curve.keyframe_points if p.co[0] == 145).co[0] = 170
        curve.update()
    update()
    index = tracks(ob)[1].nearest(170)
    assert indices(ob)[0] == [0] and index in indices(ob)[1]
    assert state(ob).changes[0].deleted == [144] and state(ob).changes[1].added == [index]


def test_a_key_is_turned():
    ob = plans.on_timeline()
    for curve, value in zip(curves(pair(ob)[0]), quat((0, 0.2, 1)), strict=True):
        next(p for p in curve.keyframe_points if p.co[0] == 1).co[1] = value
    update()
    assert state(ob).changes[0].turned == [0] and same_axes(paths(ob)[0], {0: (0, 0.2, 1), 144: (0.6, 0, 0.8)})
    assert close(seen(ob, 1)[1], np.array((0, 0.2, 1)) / np.sqrt(1.04))


def test_keys_are_deleted():
    ob = plans.on_timeline()
    tool = pair(ob)[0]
    other = paths(ob)[1].axes
    remove(tool, 145)
    assert indices(ob)[0] == [0] and close(paths(ob)[0].axes, np.tile((0, -0.6, 0.8), (145, 1)))
    remove(tool, 1)
    assert indices(ob)[0] == [] and len(paths(ob)[0].axes) == 0  # a path without an orientation is not cut
    assert close(seen(ob, 50)[1], (0, -np.sqrt(0.5), np.sqrt(0.5)))  # it is shown halfway between floor and wall
    assert np.array_equal(paths(ob)[1].axes, other)
    tool.animation_data_clear()
    insert_first(tool, 30, (0, -0.5, 1))
    assert indices(ob) == [[29], []]


def insert_first(tool, frame, axis):
    """For a tool that has no curves any more."""
    tool.rotation_quaternion = quat(axis)
    tool.keyframe_insert("rotation_quaternion", frame=frame)
    update()


def test_sub_frames_signs_lengths_and_easing_do_not_matter():
    ob = plans.on_timeline()
    tool = pair(ob)[0]
    insert(tool, 30.4, (0, -0.3, 1), sign=-0.4)
    assert same_axes(paths(ob)[0], {0: (0, -0.6, 0.8), 29: (0, -0.3, 1), 144: (0.6, 0, 0.8)})
    axes = paths(ob)[0].axes
    for curve in curves(tool):
        for point in curve.keyframe_points:
            point.interpolation = "BEZIER"
    update()
    assert np.array_equal(paths(ob)[0].axes, axes) and state(ob).difference.small
    ghost = [
        common.part("blender.versions").channels(pair(ob)[1]).find("rotation_quaternion", index=i) for i in range(4)
    ]
    norms = [np.linalg.norm([c.evaluate(f) for c in ghost]) for f in np.linspace(1, 145, 500)]
    assert min(norms) > 0.999


def test_the_seam_of_a_loop_is_its_first_point():
    ob = plans.on_timeline()
    tool, last = pair(ob)[0], tracks(ob)[1].last
    before = paths(ob)[1].keys[0]
    insert(tool, last, (0, 0, 1))
    assert close(paths(ob)[1].keys[0], before) and "nearer key" in state(ob).problems[0]
    remove(tool, 155)
    assert close(paths(ob)[1].keys[0], (0, 0, 1)) and not state(ob).problems
    assert close(seen(ob, last)[1], (0, 0, 1)) and close(seen(ob, 155)[1], (0, 0, 1))


def test_keys_outside_every_path_are_reported_and_change_nothing():
    ob = plans.on_timeline()
    tool, before = pair(ob)[0], paths(ob)
    insert(tool, 150, (0, 0, 1))
    insert(tool, 900, (0, 0, 1))
    assert state(ob).problems == ["keys at frame 150, 900 outside every path: ignored"]
    assert all(a is b for a, b in zip(paths(ob), before, strict=True))
    remove(tool, 150)
    remove(tool, 900)
    assert not state(ob).problems
    insert(tool, 73, (0, 0.6, -0.8))  # opposite to the first
    assert "opposite" in state(ob).problems[0] and "Path 1" in state(ob).problems[0]
    assert np.array_equal(paths(ob)[0].axes, before[0].axes)
    insert(tool, 40, (1, 0, 0))  # a detour
    assert not state(ob).problems and indices(ob)[0] == [0, 39, 72, 144]


def test_upside_down_axes_play_as_they_cut():
    ob = plans.on_timeline()
    insert(pair(ob)[0], 60, (0.01, 0, -1))
    insert(pair(ob)[0], 90, (-0.01, 0.001, -1))
    assert indices(ob)[0] == [0, 59, 89, 144] and state(ob).difference.small, state(ob).difference
