"""The list of a plan's paths: states, lengths, on and off, deleting, names on the timeline, coloured lines."""

from pathlib import Path

import bpy
import numpy as np
import riffler

from support import common, plans, programs


def store():
    return common.part("plan.plan_store")


def rows(ob):
    return [(row.name, row.state, row.on) for row in ob.riffler.plan.rows]


def four():
    """A path that is free, one without keys, one that leans into the wall, which no lift of a millimetre frees, and one
    that was not resolved."""
    bare, blocked = programs.bare(), programs.valley(programs.INTO)
    ob = programs.plan(programs.valley(programs.LEANING), bare, blocked, programs.valley((0, -0.3, 1)))
    bpy.ops.riffler.plan_resolve(max_lift=1.0)
    plan = programs.content(ob)
    assert [rows is not None for rows in plan.cl] == [True, False, False, True]
    bpy.ops.riffler.plan_key(path=4, point=0, axis=(0, -0.5, 1))
    return ob


def test_the_list_has_a_line_for_each_path_with_its_state_and_length():
    ob = four()
    assert [state for _, state, _ in rows(ob)] == ["free", "unplanned", "blocked", "keyed"]
    assert [name for name, _, _ in rows(ob)] == ["Path 1", "Path 2", "Path 3", "Path 4"]
    assert np.allclose([row.length for row in ob.riffler.plan.rows], 60, atol=1e-3)
    text = common.part("plan.paths_panel").summary(ob.riffler.plan)
    assert text == "4 on, 240 mm: 1 Free, 1 Blocked, 1 To Resolve, 1 No Keys", text
    bpy.ops.riffler.plan_key(path=3, point=0, axis=(0, -0.6, 0.8))  # its findings belong to other keys
    assert rows(ob)[2][1] == "keyed" and not any(e["path"] == 2 for e in programs.listed(ob.riffler.plan.findings))


def test_a_path_that_is_off_is_not_resolved_not_written_not_shown():
    ob = four()
    p = ob.riffler.plan
    p.rows[2].on = p.rows[3].on = False  # the boxes
    assert programs.content(ob).off == {2, 3} and [state for _, state, _ in rows(ob)][2:] == ["off", "off"]
    curves = common.part("plan.path_curves")
    curves.show(ob, programs.content(ob), 1.0)
    common.part("plan.path_switches").show(ob)
    assert [c.hide_get() for c in curves.of(ob)] == [False, False, True, True]
    path = Path(common.out("off.ngc"))
    path.unlink(missing_ok=True)
    assert bpy.ops.riffler.plan_nc("EXEC_DEFAULT", filepath=str(path)) == {"FINISHED"}
    assert "(paths: 1, 60 mm)" in path.read_text(), "neither the blocked one nor the one that was not resolved stops it"
    left = common.part("program.programs").left_out(programs.content(ob))
    assert left == "Path 2 has no keys and is not cut. Paths 3, 4 are off and not cut"
    before = programs.content(ob).cl
    bpy.ops.riffler.plan_resolve(max_lift=1.0)
    assert programs.content(ob).cl[3] is None and before[3] is None
    p.rows[3].on = True
    assert programs.content(ob).off == {2} and rows(ob)[3] == ("Path 4", "keyed", True)
    bpy.ops.riffler.plan_resolve(max_lift=1.0)
    assert rows(ob)[3][1] == "free"


def test_several_are_switched_at_once():
    ob = four()
    for which, off in (
        ("BLOCKED", {2}), ("UNPLANNED", {1, 2}), ("INVERT", {0, 3}), ("NONE", {0, 1, 2, 3}), ("ALL", set())
    ):  # fmt: skip
        assert bpy.ops.riffler.plan_switch(which=which) == {"FINISHED"}
        assert programs.content(ob).off == off and [not on for _, _, on in rows(ob)] == [k in off for k in range(4)]
    common.refused(lambda: bpy.ops.riffler.plan_switch(which="ONLY"), "No path is selected in the list")
    ob.riffler.plan.row = 1
    bpy.ops.riffler.plan_switch(which="ONLY")
    assert programs.content(ob).off == {0, 2, 3}
    common.refused(lambda: bpy.ops.riffler.plan_resolve(), "Every path with an orientation is off")


def test_a_click_goes_to_the_path():
    ob = four()
    common.part("plan.path_curves").show(ob, programs.content(ob), 1.0)
    ob.riffler.plan.row = 2
    track = common.part("plan.replan").layout_of(ob, programs.content(ob)).tracks[2]
    assert bpy.context.scene.frame_current_final == track.first
    assert bpy.context.object == common.part("plan.path_curves").of(ob)[2] and store().active(bpy.context) == ob
    area = next(a for a in bpy.context.window_manager.windows[0].screen.areas if a.type == "VIEW_3D")
    assert np.allclose(area.spaces.active.region_3d.view_location, (30, 17, 11), atol=1e-3)


def test_deleting_keeps_the_keys_and_locations_of_the_others():
    ob = four()
    common.part("plan.path_curves").show(ob, programs.content(ob), 1.0)
    bpy.ops.riffler.plan_switch(which="BLOCKED")
    plan = programs.content(ob)
    marks = len(ob.riffler.plan.findings)
    assert marks
    ob.riffler.plan.row = 0
    assert bpy.ops.riffler.plan_delete_paths(which="CHOSEN") == {"FINISHED"}
    after = programs.content(ob)
    assert len(after.paths) == 3 and after.off == {1}
    for k in range(3):
        old, new = plan.paths[k + 1], after.paths[k]
        assert np.array_equal(old.centres, new.centres) and list(old.keys) == list(new.keys)
        assert all(np.allclose(old.keys[i], new.keys[i], atol=1e-6) for i in old.keys)
    assert all(e["path"] == 1 and e["name"].startswith("Path 2, ") for e in programs.listed(ob.riffler.plan.findings))
    assert len(common.part("plan.path_curves").of(ob)) == 3
    assert common.part("plan.plan_states").state(ob).problems == [] and common.part("plan.replan").fits(ob, after)
    bpy.ops.riffler.plan_delete_paths(which="OFF")
    assert len(programs.content(ob).paths) == 2 and programs.content(ob).off == set()
    common.refused(lambda: bpy.ops.riffler.plan_delete_paths(which="OFF"), "No path is off")
    for _ in range(2):
        ob.riffler.plan.row = 0
        bpy.ops.riffler.plan_delete_paths(which="CHOSEN")
    assert rows(ob) == [] and names() == []
    common.refused(lambda: bpy.ops.riffler.plan_delete_paths(which="CHOSEN"), "No path is selected in the list")


def names():
    return sorted((m.frame, m.name) for m in bpy.context.scene.timeline_markers)


def test_paths_have_names_on_the_timeline():
    scene = bpy.context.scene
    scene.timeline_markers.new("mine", frame=7)
    ob = programs.plan(programs.valley(programs.LEANING), programs.valley(programs.LEANING))
    tracks = common.part("plan.replan").layout_of(ob, programs.content(ob)).tracks
    wanted = [(round(t.first), f"▸ Path {k + 1}, 60 mm") for k, t in enumerate(tracks)]
    assert names() == sorted([*wanted, (7, "mine")])
    ob.riffler.plan.rows[1].on = False
    assert names() == sorted([wanted[0], (wanted[1][0], "▸ Path 2, 60 mm off"), (7, "mine")])
    scene.riffler.plan.frame_names = False
    assert names() == [(7, "mine")]
    scene.riffler.plan.frame_names = True
    bpy.ops.riffler.plan_to_timeline(first=11)
    assert [f for f, name in names() if name.startswith("▸")] == [f + 10 for f, _ in wanted]
    bpy.data.objects.remove(ob)
    bpy.context.view_layer.update()
    common.part("plan.replan").flush()
    assert names() == [(7, "mine")]


def test_lines_are_coloured_by_what_the_tool_does():
    """The moves between the cuts are shown once a program was made, as long as the plan and the panel are unchanged."""
    ob = programs.resolved(
        programs.valley(programs.LEANING), programs.valley(programs.LEANING), programs.valley(programs.INTO, (0, 0, 1))
    )
    drawn, context = common.part("program.line_view"), bpy.context
    ob.riffler.plan.rows[1].on = False
    plan, found = programs.content(ob), drawn.lines(context, ob)
    assert set(found) == {"cut", "lifted", "off"} and set(found) <= set(drawn.LOOK)
    rows = plan.cl[2]
    assert len(found["lifted"]) > 10 and len(found["cut"]) + len(found["lifted"]) == sum(
        len(plan.cl[k]) - 1 for k in (0, 2)
    )
    before = drawn.signature(context, ob)
    bpy.ops.riffler.plan_nc("EXEC_DEFAULT", filepath=common.out("lines.ngc"))
    found = drawn.lines(context, ob)
    assert {"rapid", "retract", "lead"} <= set(found) and drawn.signature(context, ob) != before
    program = common.part("program.programs").made_of(context, ob)
    assert sum(len(found[k]) for k in found if k != "off") == len(program.poses) - 1
    top = program.poses[:, 2].max()
    rapid = found["rapid"].reshape(-1, 3)
    assert np.ptp(rapid[:, 2]) < 3.5 and rapid[:, 2].min() > top, "between the cuts, at the clearance plane"
    assert np.allclose(found["retract"][-1, 1, 2], top + 3 * rows[-1, 5], atol=3)
    bpy.context.scene.riffler.plan.retract = 4
    assert set(drawn.lines(context, ob)) == {"cut", "lifted", "off"}


def test_a_closed_path_and_one_of_another_unit_are_drawn_whole():
    ob = programs.plan(plans.ring(), mm_per_unit=1000.0)
    drawn = common.part("program.line_view")
    ((kind, pieces),) = drawn.lines(bpy.context, ob).items()
    assert kind == "unplanned" and np.array_equal(pieces[-1, 1], pieces[0, 0])


def test_finding_again_switches_everything_on():
    ob = programs.plan(programs.valley(programs.LEANING), timeline=False)
    ob.riffler.plan.rows[0].on = False
    bpy.context.scene.riffler.plan.take(plans.TOOL.to_dict())
    assert bpy.ops.riffler.plan_find(replace=ob.name) == {"FINISHED"}
    assert programs.content(ob).off == set() and rows(ob) == [("Path 1", "unplanned", True)]


def test_paths_of_two_plans_name_their_plan():
    first = programs.plan(programs.valley(programs.LEANING))
    second = store().new(bpy.context, riffler.plan.Plan([programs.valley(programs.LEANING)], plans.TOOL))
    bpy.ops.riffler.plan_to_timeline(first=500)
    assert [n for _, n in names()] == [f"{first.name} ▸ Path 1, 60 mm", f"{second.name} ▸ Path 1, 60 mm"]
