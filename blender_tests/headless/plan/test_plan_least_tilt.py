"""Keys on many paths at once: one change, one undo step; paths without a solution are named."""

import math
from itertools import pairwise

import bpy
import numpy as np
import riffler

from support import common, plans
from support.keyframed_plan import close, curves, indices, insert, pair, paths, state, update

SLOPE = (0, -math.sqrt(0.5), math.sqrt(0.5))  # in the middle between floor and wall


def store():
    return common.part("plan.plan_store")


def laid(count=4, roof=False):
    """A plan of so many pieces of the step's valley, without keys; `roof`: over the last of them, up to the wall."""
    part = plans.part_object()
    (valley,) = riffler.plan.pencil(riffler.Mesh(*plans.step()), plans.TOOL)
    fine = valley.divided(1.0)
    ends = np.linspace(0, len(fine), count + 1).astype(int)
    pieces = [
        riffler.plan.PencilPath(fine.radius, fine.centres[a:b], fine.contacts[a:b], fine.normals[a:b])
        for a, b in pairwise(ends)
    ]
    ob = plans.on_timeline(chosen=pieces)
    bpy.context.scene.riffler.plan.part = part
    if roof:
        cover(pieces[-1].centres[:, 0].mean())
    return ob


def cover(x):
    """A fixture: a block over the valley at x, lower than the ball's height."""
    mesh = bpy.data.meshes.new("Clamp")
    corners = [(a, b, c) for a in (x - 4, x + 4) for b in (-20, 40) for c in (13, 40)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    mesh.from_pydata(corners, [], faces)
    clamp = bpy.data.objects.new("Clamp", mesh)
    collection = bpy.data.collections.new("Fixtures")
    bpy.context.scene.collection.children.link(collection)
    collection.objects.link(clamp)
    bpy.context.scene.riffler.plan.fixtures = collection
    update()


def counts(ob):
    now = state(ob)
    return np.array([now.synced, now.baked, now.laid, store().texts(ob).made])


def test_every_path_has_its_keys_after_one_step_that_undo_takes_back():
    ob = laid(4)
    name, before = ob.name, counts(ob)
    common.push("timeline")
    assert bpy.ops.riffler.plan_least_tilt("EXEC_DEFAULT", True) == {"FINISHED"}
    # updated before and after, for any number of paths; each of them baked, laid out and formatted once
    assert (counts(ob) - before).tolist() == [2, 4, 4, 4]
    for path in paths(ob):
        assert list(path.keys) == [0, len(path) - 1] and close(path.axes, np.tile(SLOPE, (len(path), 1)))
    assert len(curves(pair(ob)[0])[0].keyframe_points) == 8 and not state(ob).problems
    made = store().identity(ob)
    bpy.ops.ed.undo()
    update()
    ob = bpy.data.objects[name]
    assert indices(ob) == [[]] * 4
    bpy.ops.ed.redo()
    update()
    ob = bpy.data.objects[name]
    assert [len(k) for k in indices(ob)] == [2] * 4 and store().identity(ob) == made


@common.core_bound
def test_a_path_on_which_nothing_is_free_is_named_and_listed():
    ob = laid(3, roof=True)
    bpy.ops.riffler.plan_least_tilt()
    assert [len(k) for k in indices(ob)][:2] == [2, 2] and indices(ob)[2] == []
    (entry,) = [e for e in ob.riffler.plan.findings if e.path == 2]
    assert entry.kind == "blocked" and entry.name.startswith("Path 3, no key, point ")
    assert close(entry.place, paths(ob)[2].centres[entry.point], 1e-3)
    bpy.ops.riffler.finding_go(of="PLAN", index=list(ob.riffler.plan.findings).index(entry))
    track = common.part("plan.replan").layout_of(ob, store().plan(ob)).tracks[2]
    assert bpy.context.scene.frame_current == track.frame_of(entry.point)
    bpy.data.objects.remove(bpy.data.objects["Clamp"])
    update()
    bpy.ops.riffler.plan_least_tilt()  # those without keys
    assert [len(k) for k in indices(ob)] == [2, 2, 2] and not [e for e in ob.riffler.plan.findings if e.path == 2]


def test_least_tilt_takes_the_selected_or_all_paths():
    ob = laid(4)
    curve = common.part("plan.path_curves")
    bpy.ops.riffler.plan_show()
    bpy.ops.object.select_all(action="DESELECT")
    common.refused(lambda: bpy.ops.riffler.plan_least_tilt(paths="SELECTED"), "No path is selected")
    curve.of(ob)[1].select_set(True)
    bpy.ops.riffler.plan_least_tilt(paths="SELECTED", count=3)
    assert [len(k) for k in indices(ob)] == [0, 3, 0, 0]
    tracks = common.part("plan.replan").layout_of(ob, store().plan(ob)).tracks
    bpy.context.scene.frame_set(tracks[2].first + 3)
    bpy.ops.riffler.plan_least_tilt(paths="FRAME", count=1)
    assert [len(k) for k in indices(ob)] == [0, 3, 1, 0]
    before = counts(ob)
    bpy.ops.riffler.plan_least_tilt()
    assert [len(k) for k in indices(ob)] == [2, 3, 1, 2] and (counts(ob) - before).tolist() == [2, 2, 2, 2]
    common.refused(bpy.ops.riffler.plan_least_tilt, "Every path has keys", "All")
    bpy.ops.riffler.plan_least_tilt(paths="ALL", axes="GIVEN", axis=(0, -1, 2))
    assert [len(k) for k in indices(ob)] == [1] * 4
    assert all(close(p.axes, np.tile(np.array((0, -1, 2)) / math.sqrt(5), (len(p), 1))) for p in paths(ob))
    bpy.context.scene.frame_set(tracks[0].last + 5)
    common.refused(lambda: bpy.ops.riffler.plan_least_tilt(paths="FRAME"), "is on no path")
    common.refused(lambda: bpy.ops.riffler.plan_least_tilt(paths="ALL", axis=(0, 0, 0)), "axis")


def test_keyframes_of_other_paths_and_strays_stay():
    ob = laid(2)
    tool = pair(ob)[0]
    tracks = common.part("plan.replan").layout_of(ob, store().plan(ob)).tracks
    bpy.context.scene.frame_set(tracks[0].first + 2, subframe=0.25)
    bpy.ops.riffler.plan_key(axis=(0, -0.5, 1))
    insert(tool, tracks[0].last + 5, (0, 0, 1))  # on no path
    assert state(ob).problems
    bpy.ops.riffler.plan_least_tilt()
    frames = [p.co[0] for p in curves(tool)[0].keyframe_points]
    assert frames == [tracks[0].first + 2.25, tracks[0].last + 5, tracks[1].first, tracks[1].last]
    assert close(paths(ob)[0].axes[0], np.array((0, -0.5, 1)) / math.sqrt(1.25))


def test_a_search_that_is_cancelled_halfway_changes_nothing():
    """With the report of a native task, after two paths have their keys already."""
    ob = laid(4)
    made, before = store().identity(ob), counts(ob)
    search = common.part("plan.pure.tilt_search").Search
    judge, judged = search._judge, []

    def cancelled(self, found):
        judged.append(self)
        if len(judged) == 3:
            raise riffler.Cancelled("cancelled")
        judge(self, found)

    search._judge = cancelled
    try:
        common.refused(bpy.ops.riffler.plan_least_tilt, "cancelled")
    finally:
        search._judge = judge
    assert store().identity(ob) == made and indices(ob) == [[]] * 4 and not len(ob.riffler.plan.findings)
    assert (counts(ob) - before)[1:].tolist() == [0, 0, 0] and not state(ob).problems


def test_least_tilt_names_what_is_missing():
    ob = laid(2)
    bpy.context.scene.riffler.plan.part = None
    common.refused(bpy.ops.riffler.plan_least_tilt, "There is no part")
    bpy.data.objects.remove(pair(ob)[0])
    common.refused(bpy.ops.riffler.plan_least_tilt, "not on the timeline")


def test_setting_one_key_costs_only_the_work_of_its_path():
    ob = laid(4)
    bpy.ops.riffler.plan_least_tilt()
    before = counts(ob)
    bpy.ops.riffler.plan_key(axis=(0, -0.5, 1), path=2, point=5)
    assert (counts(ob) - before).tolist() == [1, 1, 1, 1]
