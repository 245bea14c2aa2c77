"""The tool and the part of checks: a tool that is not the panel's, a part that has changed; and the notes on them."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import bpy
import numpy as np
import riffler

from support import common, plans, programs
from support.keyframed_plan import insert, pair, state

SHORT = riffler.Tool.ball(6, 10)
WIDE = SHORT.with_holder([(12, 30, 40, 30)])  # its holder collides with the wall at any tilt


def settings():
    return bpy.context.scene.riffler.plan


def take(tool):
    settings().take(tool.to_dict())


def said(call):
    """The reports of a call that succeeds."""
    return common.printed(lambda: call() == {"FINISHED"} or print("not finished"))


def write():
    path = common.out("fit.ngc")
    Path(path).unlink(missing_ok=True)
    return said(lambda: bpy.ops.riffler.plan_nc(filepath=path))


# ---- the part


def found_on_the_step():
    """A resolved plan that identifies its part by its surface, like plans from a search."""
    ob = programs.plan()
    mesh = common.part("blender.object_surfaces").in_world(bpy.context, ob.riffler.plan.part)
    plan = replace(programs.content(ob), part=riffler.plan.part_of(mesh, "Step"))
    common.part("plan.plan_store").write(ob, plan)
    bpy.ops.riffler.plan_resolve()
    return ob


def shift(ob, z):
    ob.location.z = z
    bpy.context.view_layer.update()


@common.core_bound
def test_a_part_that_was_moved_since_is_reported_and_blocks_nc_code():
    ob = found_on_the_step()
    take(plans.TOOL)
    part = ob.riffler.plan.part
    assert "Warning" not in write()
    header = Path(common.out("fit.ngc")).read_text()
    assert f"Step {programs.content(ob).part['sha256'][:16]}" in header
    shift(part, -0.5)
    for call in (bpy.ops.riffler.plan_resolve, bpy.ops.riffler.plan_check):
        text = said(call)
        assert "Warning" in text and "Step was moved or changed since" in text, text
    common.refused(lambda: bpy.ops.riffler.plan_nc(filepath=common.out("x.ngc")), "move it back", "Find Again")
    programs.stock()
    bpy.context.view_layer.objects.active = ob
    common.refused(lambda: bpy.ops.riffler.simulate(source="PLAN"), "Step was moved or changed since")
    shift(part, 0)
    assert "Warning" not in said(bpy.ops.riffler.plan_resolve) and "Warning" not in write()


def test_a_part_of_unknown_surface_may_lie_anywhere():
    """Its code identifies it."""
    ob = programs.plan()
    shift(ob.riffler.plan.part, -0.5)
    bpy.ops.riffler.plan_resolve()
    write()
    mesh = common.part("blender.object_surfaces").in_world(bpy.context, ob.riffler.plan.part)
    assert f"Step {riffler.plan.part_of(mesh, '')['sha256'][:16]}" in Path(common.out("fit.ngc")).read_text()


def delete(ob):
    """Like X: what points to it still does."""
    common.select(ob)
    bpy.ops.object.delete()


def test_a_part_that_was_deleted_and_brought_back_is_the_part():
    """The same model imported again, and set as the part. Another model is not accepted for it."""
    ob = found_on_the_step()
    take(plans.TOOL)
    judge = common.part("plan.operators.watch").judge
    delete(ob.riffler.plan.part)
    for call in (bpy.ops.riffler.plan_resolve, bpy.ops.riffler.plan_check, bpy.ops.riffler.plan_find):
        common.refused(call, "Step was deleted", "set another part")
    assert judge(bpy.context, ob).part == "The part, Step, is gone from the scene"
    new = plans.part_object()
    common.select(new)
    bpy.ops.riffler.plan_part()
    bpy.context.view_layer.objects.active = ob
    assert judge(bpy.context, ob).part == ""
    for text in (said(bpy.ops.riffler.plan_resolve), said(bpy.ops.riffler.plan_check), write()):
        assert "Warning" not in text and "deleted" not in text, text
    shift(new, 1)
    assert "and Step.001 is not the same" in judge(bpy.context, ob).part
    common.refused(lambda: bpy.ops.riffler.plan_nc(filepath=common.out("x.ngc")), "Find Again")


def test_a_plan_whose_own_part_is_there_is_found_again_without_the_scene_s():
    ob = found_on_the_step()
    settings().part = None
    bpy.context.view_layer.objects.active = ob
    assert bpy.ops.riffler.plan_find(replace=ob.name) == {"FINISHED"}
    common.refused(bpy.ops.riffler.plan_find, "There is no part")
    delete(ob.riffler.plan.part)
    bpy.context.view_layer.objects.active = ob
    common.refused(lambda: bpy.ops.riffler.plan_find(replace=ob.name), "There is no part")


def test_the_verified_code_is_the_written_code():
    """Its lines are those of the file: both are written with the plan's tolerance."""
    ob = programs.plan(programs.valley(programs.LEANING, (0, -0.2, 1), programs.LEANING))
    common.part("plan.plan_store").write(ob, replace(programs.content(ob), tolerance=0.2))
    bpy.ops.riffler.plan_resolve()
    programs.stock()
    bpy.context.view_layer.objects.active = ob
    settings().post = "linuxcnc-xyzac"
    bpy.context.scene.riffler.machines.of("linuxcnc-xyzac").rot_point = (0, 0, -40)
    write()
    setup = common.part("program.programs").take(bpy.context, SimpleNamespace(source="PLAN", frame="WORLD"))
    assert setup.text == Path(common.out("fit.ngc")).read_text()


# ---- paths that are others now


def test_paths_that_are_found_again_leave_nothing_of_the_old_ones():
    """Their findings, the animation and the marks of collisions: all of it belonged to the old paths."""
    ob = programs.plan(programs.valley(programs.LEANING, programs.INTO))
    bpy.ops.riffler.plan_resolve(max_lift=0.01)
    bpy.ops.riffler.plan_check()
    scene = bpy.context.scene
    assert state(ob).colliding and len(scene.timeline_markers) and ob.riffler.plan.findings and state(ob).motions
    text = said(lambda: bpy.ops.riffler.plan_find(replace=ob.name, tool=common.BALL, passes=2, stepover=0.5))
    assert "Warning" in text and "put it on the timeline again" in text, text
    assert not ob.riffler.plan.findings and not len(scene.timeline_markers)
    assert not state(ob).motions and not state(ob).colliding
    for again in (False, True):
        if again:
            blend, name = common.out("again.blend"), ob.name
            bpy.ops.wm.save_as_mainfile(filepath=blend)
            bpy.ops.wm.open_mainfile(filepath=blend)
            ob = bpy.data.objects[name]
            bpy.context.view_layer.objects.active = ob
        common.refused(bpy.ops.riffler.plan_check, "put it on the timeline again")
    assert bpy.ops.riffler.plan_to_timeline() == {"FINISHED"} and bpy.ops.riffler.plan_check() == {"FINISHED"}
    assert len(state(ob).motions) == 3 and not state(ob).problems


def test_changing_a_key_drops_the_results_of_its_path():
    ob = programs.plan(programs.valley(programs.INTO), programs.valley(programs.INTO))
    paths = lambda: {e["path"] for e in programs.listed(ob.riffler.plan.findings)}  # noqa: E731
    bpy.ops.riffler.plan_resolve(max_lift=0.01)
    assert paths() == {0, 1}
    insert(pair(ob)[0], 73, programs.LEANING)  # in the graph editor
    assert paths() == {1}
    bpy.ops.riffler.plan_key(axis=programs.LEANING, path=2, point=5)
    assert paths() == set()


def test_how_many_paths_are_resolved_is_kept_for_the_panel():
    said = common.part("program.panel").resolved
    ob = programs.plan(programs.valley(programs.LEANING), plans.ring(), programs.valley(programs.INTO))
    p = ob.riffler.plan
    assert said(p) == "0 of 3 paths resolved, 1 without keys"
    bpy.ops.riffler.plan_resolve(max_lift=0.01)
    assert said(p) == "1 of 3 paths resolved, 1 without keys"
    bpy.ops.riffler.plan_least_tilt(paths="ALL", axes="GIVEN", axis=programs.LEANING)
    assert said(p) == "0 of 3 paths resolved"
    p.resolved = -1  # from a file without the count
    assert said(p) == ""


# ---- the tool


@common.core_bound
def test_a_holder_that_was_changed_after_the_search_is_reported():
    ob = programs.resolved()
    take(plans.TOOL)
    for text in (said(bpy.ops.riffler.plan_resolve), said(bpy.ops.riffler.plan_check), write()):
        assert "Warning" not in text, text
    take(plans.TOOL.named("Another name"))
    assert "Warning" not in write()
    take(plans.TOOL.with_holder([]))
    for text in (said(bpy.ops.riffler.plan_resolve), said(bpy.ops.riffler.plan_check), write()):
        assert "Warning" in text and "Use This Tool" in text, text
    take(riffler.Tool.ball(4, 25))
    assert "paths of its own" in said(bpy.ops.riffler.plan_check)
    assert programs.content(ob).tool == plans.TOOL


def test_shank_and_holder_are_exchanged_and_the_keys_stay():
    ob = programs.plan(programs.valley(programs.LEANING, (0, -0.3, 1)), timeline=False)
    common.part("plan.plan_store").write(ob, replace(programs.content(ob), tool=SHORT))
    bpy.ops.riffler.plan_to_timeline()
    bpy.ops.riffler.plan_resolve()
    before, rows = programs.content(ob), len(pair(ob)[0].data.vertices)
    bpy.ops.riffler.plan_check()
    assert not state(ob).colliding
    take(WIDE)
    assert bpy.ops.riffler.plan_use_tool() == {"FINISHED"}
    plan = programs.content(ob)
    assert plan.tool == WIDE and ob.riffler.plan.tool == WIDE.name
    assert list(plan.paths[0].keys) == list(before.paths[0].keys)
    assert np.array_equal(plan.paths[0].axes, before.paths[0].axes)
    assert not any(r is not None for r in plan.cl) and not ob.riffler.plan.findings
    assert len(pair(ob)[0].data.vertices) != rows  # it is displayed on the timeline
    assert state(ob).colliding  # marks follow
    common.refused(lambda: bpy.ops.riffler.plan_nc(filepath=common.out("x.ngc")), "may collide", "Resolve")
    assert "Use This Tool" not in said(bpy.ops.riffler.plan_resolve)


def test_changing_the_cutter_does_not_change_the_holder():
    ob = programs.plan(timeline=False)
    before = common.part("plan.plan_store").identity(ob)
    take(riffler.Tool.ball(4, 25))
    common.refused(bpy.ops.riffler.plan_use_tool, "another cutter", "Find Again")
    assert common.part("plan.plan_store").identity(ob) == before
    take(plans.TOOL.with_holder([]))
    assert bpy.ops.riffler.plan_use_tool() == {"FINISHED"} and not programs.content(ob).tool.holder


def test_the_panel_knows_the_plan_s_tool():
    ob = programs.plan(timeline=False)
    verdict = common.part("plan.operators.watch").judge(bpy.context, ob)
    note = common.part("plan.fit_check").tool_note
    take(plans.TOOL)
    assert note(settings(), verdict.tool) == ""
    take(plans.TOOL.with_holder([]))
    assert "Use This Tool" in note(settings(), verdict.tool)
    settings().tool = "[]"
    assert note(settings(), verdict.tool) == ""
