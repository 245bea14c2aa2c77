"""A program is simulated on a stock: the timeline decides how much of it is cut, and nothing of the simulation
remains."""

import bpy
import numpy as np
import riffler
from mathutils import Matrix

from support import common, keyframed_plan, plans, programs


def simulating():
    return common.part("program.simulation")


def now():
    return simulating().active()


def seen():
    """The volume inside all chunks' surface, by the divergence theorem, and the names of the visible objects."""
    chunks = common.part("sculpt.chunks")
    collection = chunks.collection_of(now().mark)
    parts = [ob for ob in collection.objects if chunks.NUMBER in ob and len(ob.data.polygons)]
    return sum(common.mesh_volume(common.coordinates(ob.data), common.triangles(ob.data)) for ob in parts)


def carved(setup, row):
    """The stock after carving all rows up to that one in one call."""
    volume = setup.stock
    for tool, poses in setup.runs:
        some = poses[: max(row + 1, 0)]
        if len(some) > 1:
            volume.carve(tool, some)
        row -= len(poses)
    return volume.to_bytes()


def take():
    """The program and stock of the scene, again: a simulation does not change them."""
    return common.part("program.programs").take(bpy.context, programs.settings())


def test_scrubbing_back_and_forth_equals_carving_the_prefix_by_bytes():
    ob = programs.resolved()
    stock = programs.stock()
    identity = common.part("sculpt.sculpt_store").identity(stock.data)
    before = common.coordinates(stock.data)
    scene = bpy.context.scene
    scene.frame_set(1)
    assert bpy.ops.riffler.simulate(source="PLAN") == {"FINISHED"}
    assert common.is_hidden(stock)
    assert scene.frame_start <= now().program_timeline.first and now().program_timeline.last <= scene.frame_end
    rows = set()
    for frame in (1, 60, 145, 30, 1, 145, 100, 0, 72):
        scene.frame_set(frame)
        row = now().program_timeline.row_at(frame)
        rows.add(row)
        assert now().prefix.row == row
        assert now().prefix.volume.to_bytes() == carved(take(), row), frame
        assert abs(seen() - now().prefix.volume.volume) < 0.02 * now().prefix.volume.volume
    assert len(rows) >= 6
    assert bpy.ops.riffler.simulate_stop() == {"FINISHED"} and now() is None
    assert not common.is_hidden(stock) and common.part("sculpt.chunks").shown() == []
    assert common.part("sculpt.sculpt_store").identity(stock.data) == identity
    assert np.array_equal(common.coordinates(stock.data), before)
    assert common.part("plan.plan_store").is_plan(ob)


def test_the_stock_is_cut_where_the_tool_is_shown():
    """At a frame, the rows that the tool has passed are cut, and those ahead of it are not."""
    programs.resolved()
    programs.stock()
    bpy.ops.riffler.simulate(source="PLAN")
    for frame in (40, 90):
        tip, axis = keyframed_plan.seen(bpy.data.objects["Riffler Plan"], frame)
        _, pose = now().prefix.pose(now().prefix.row)
        assert np.linalg.norm(pose[:3] - tip) <= 60 / 144 + 1e-3 and np.abs(pose[3:] - axis).max() < 1e-3
        # a quarter of a millimetre above the step's floor, under the ball: it goes from x = 0 to 60
        behind, ahead = ((tip[0] - 6, 17, 8.25), (tip[0] + 6, 17, 8.25))
        assert list(now().prefix.volume.contains(np.array([behind, ahead]))) == [False, True]


def test_an_nc_file_is_simulated_in_the_scene_s_and_in_the_stock_s_frame():
    tool = riffler.Tool.flat(diameter=6, length=30)
    poses = np.array([[5, 10, 6, 0, 0, 1], [35, 10, 6, 0, 0, 1.0]])
    program = riffler.Program.from_cl([poses], tools=[tool], feed=600)
    path = common.out("groove.ngc")
    program.write(path, post="3-axis")
    common.scale(1.0)
    bpy.context.scene.riffler.plan.take(tool.to_dict())
    stock = block((0, 0, 0), (40, 20, 10))
    wanted = 40 * 20 * 10 - 4 * (30 * 6 + np.pi * 9)  # a groove 4 mm deep with round ends
    for frame in ("WORLD", "STOCK"):
        assert bpy.ops.riffler.simulate(source="FILE", filepath=path, machine="3-axis", frame=frame) == {"FINISHED"}
        bpy.context.scene.frame_set(now().program_timeline.last)
        assert abs(now().prefix.volume.volume - wanted) < 2, now().prefix.volume.volume
        bpy.ops.riffler.simulate_stop()
    stock.location = (100, 0, 0)
    bpy.context.view_layer.update()
    for frame, left in (("STOCK", wanted), ("WORLD", 8000)):
        bpy.ops.riffler.simulate(source="FILE", filepath=path, machine="3-axis", frame=frame)
        bpy.context.scene.frame_set(now().program_timeline.last)
        assert abs(now().prefix.volume.volume - left) < 2
    bpy.ops.riffler.simulate_stop()
    stock.scale = (2, 2, 2)
    bpy.context.view_layer.update()
    call = lambda: bpy.ops.riffler.simulate(source="FILE", filepath=path, machine="3-axis")  # noqa: E731
    common.refused(call, "scaled or mirrored", "Clear > Scale")
    assert now() is None and not common.is_hidden(stock)


def block(low, high, pitch=0.5):
    volume = riffler.Volume.block(low, high, pitch, "xyz")
    ob = common.part("sculpt.sculpts").new_object(
        bpy.context, "Block", common.part("common.contents").Content(volume), Matrix()
    )
    programs.settings().stock = ob
    bpy.context.view_layer.update()
    return ob


def test_a_sculpt_s_own_cuts_begin_with_the_full_block():
    common.scale(1.0)
    ob = common.stock((40, 30, 20), 0.5, "xyz")
    common.curve("Line", [(-15, 0, 8), (15, 0, 8)], mm_per_unit=1.0)
    common.select(ob)
    bpy.ops.riffler.cut_curve(curve="Line", tool=common.FLAT, depth=2.0)
    left = common.content(ob).volume
    programs.settings().stock = ob
    assert bpy.ops.riffler.simulate(source="CUTS") == {"FINISHED"}
    bpy.context.scene.frame_set(-100)
    assert abs(now().prefix.volume.volume - 40 * 30 * 20) < 1e-6
    bpy.context.scene.frame_set(now().program_timeline.last)
    # approach and retract sweep where the cut itself has been: the same material except for rounding
    both = now().prefix.volume.copy().subtract(left).volume + left.copy().subtract(now().prefix.volume).volume
    assert both < 1e-3 < 40 * 30 * 20 - left.volume, both
    bpy.ops.riffler.simulate_stop()
    assert common.same(common.shape(common.content(ob).volume), common.shape(left))


def test_other_work_waits_until_the_simulation_ends():
    programs.resolved()
    stock = programs.stock()
    bpy.ops.riffler.simulate(source="PLAN")
    bpy.context.view_layer.objects.active = stock
    for name in ("resample", "plan_resolve", "verify", "plan_to_timeline"):
        common.refused(getattr(bpy.ops.riffler, name), "being simulated", "Esc")
    bpy.ops.riffler.simulate_stop()
    assert not bpy.ops.riffler.simulate_stop.poll()
    assert bpy.ops.riffler.plan_resolve.poll()


def test_saving_and_undo_end_the_simulation():
    programs.resolved()
    stock = programs.stock()
    name = stock.name
    count = len(stock.data.polygons)
    common.push("before")
    bpy.ops.riffler.simulate(source="PLAN")
    bpy.ops.wm.save_as_mainfile(filepath=common.out("simulated.blend"), copy=True)
    assert now() is None and not common.is_hidden(bpy.data.objects[name])
    bpy.ops.riffler.simulate(source="PLAN")
    bpy.ops.mesh.primitive_cube_add()
    common.push("cube")
    bpy.ops.ed.undo()
    assert now() is None and common.part("sculpt.chunks").shown() == []
    stock = bpy.data.objects[name]
    assert not common.is_hidden(stock) and len(stock.data.polygons) == count
    assert bpy.ops.riffler.simulate(source="PLAN") == {"FINISHED"}
    bpy.ops.wm.read_homefile()
    assert now() is None and not bpy.context.window_manager.riffler.simulating
    bpy.context.scene.frame_set(5)


def test_a_changed_plan_ends_the_simulation():
    """The tool plays the new keys: the old program is not shown at the same time."""
    ob, replan = programs.resolved(), common.part("plan.replan")
    stock = programs.stock()
    bpy.ops.riffler.simulate(source="PLAN")
    keyframed_plan.insert(keyframed_plan.pair(ob)[0], 73, (0, -0.3, 1))
    notice = bpy.context.window_manager.riffler.notice
    assert (
        now() is None and not common.is_hidden(stock) and notice == f"{ob.name}: simulation ended: the plan has changed"
    )
    common.refused(bpy.ops.riffler.simulate, "path 1 may collide")
    bpy.ops.riffler.plan_resolve()
    bpy.ops.riffler.simulate(source="PLAN")
    store = common.part("plan.plan_store")  # a script's change, which Blender does not report
    store.write(ob, riffler.plan.Plan(keyframed_plan.paths(ob), plans.TOOL))
    bpy.context.scene.frame_set(20)
    assert now() is None
    replan.flush()
    bpy.ops.riffler.plan_resolve()
    soon, replan._soon = replan._soon, lambda: None  # as in a window, in the tenth of a second before keys take effect
    try:
        keyframed_plan.insert(keyframed_plan.pair(ob)[0], 73, (0, -0.2, 1))
        common.refused(bpy.ops.riffler.simulate, "path 1 may collide")
    finally:
        replan._soon = soon


def test_missing_input_is_reported():
    bpy.context.view_layer.objects.active = None
    common.refused(bpy.ops.riffler.simulate, "There is no stock")
    programs.stock()
    common.refused(bpy.ops.riffler.simulate, "There is no plan")
    common.refused(lambda: bpy.ops.riffler.simulate(source="FILE"), "Choose an NC file")
    common.refused(lambda: bpy.ops.riffler.simulate(source="FILE", filepath="/nowhere.ngc"), "nowhere.ngc")
    common.refused(lambda: bpy.ops.riffler.simulate(source="CUTS"), "has no cuts")
    tools = [riffler.Tool.ball(diameter=6, length=20), riffler.Tool.ball(diameter=4, length=20)]
    rows = np.array([[0, 0, 5, 0, 0, 1], [9, 0, 5, 0, 0, 1.0]])
    program = riffler.Program.from_cl([rows, rows], tools=tools, feed=600)
    program.write(common.out("two.ngc"), post="tcp")
    call = lambda: bpy.ops.riffler.simulate(source="FILE", filepath=common.out("two.ngc"))  # noqa: E731
    common.refused(call, "calls tools 1, 2", ".rprog")
    program.save(common.out("two.rprog"))
    assert bpy.ops.riffler.simulate(source="FILE", filepath=common.out("two.rprog")) == {"FINISHED"}
    bpy.ops.riffler.simulate_stop()
    programs.plan()
    common.refused(bpy.ops.riffler.simulate, "path 1 may collide")
    assert now() is None


def test_a_simulation_costs_no_more_than_what_changes():
    """Operation counts: one frame further fills a few chunks and carves a row or two."""
    programs.resolved()
    programs.stock()
    bpy.context.scene.frame_set(70)
    bpy.ops.riffler.simulate(source="PLAN")
    before, filled = now().prefix.carved, dict(now().chunks.fillings)
    bpy.context.scene.frame_set(71)
    assert 1 <= now().prefix.carved - before <= 8
    changed = [k for k, f in now().chunks.fillings.items() if filled[k] != f]
    assert len(changed) <= 0.25 * len(filled) or len(filled) < 8
    bpy.context.scene.frame_set(71)
    assert [k for k, f in now().chunks.fillings.items() if filled[k] != f] == changed
