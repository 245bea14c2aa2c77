"""A plan's paths resolved, and written as NC code that matches the timeline."""

import itertools
import json
import os
import re
import subprocess
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import bpy
import numpy as np
import riffler

from support import common, plans, programs
from support.keyframed_plan import insert, pair, tracks


def write(name="plan.ngc", **more):
    path = common.out(name)
    Path(path).unlink(missing_ok=True)
    bpy.ops.riffler.plan_nc("EXEC_DEFAULT", filepath=path, **more)
    return path


def free(poses):
    """The smallest clearance of poses over the step."""
    return riffler.Collider(riffler.Mesh(*plans.step())).clearance(plans.TOOL, poses).min()


@common.core_bound
def test_resolved_paths_become_nc_code_that_reads_back():
    ob = programs.resolved()
    (rows,) = programs.content(ob).cl
    assert len(rows) >= len(programs.content(ob).paths[0]) and free(rows) > -0.011
    settings = bpy.context.scene.riffler.plan
    settings.feed, settings.spindle = 750, 9000
    for machine in ("tcp", "linuxcnc-xyzac", "head-table"):
        chosen = {"rot_point": [0, 0, -40]} if machine.startswith("linuxcnc") else {}
        path = write(f"plan-{machine}.ngc", post=machine, options=json.dumps(chosen))
        read = riffler.Program.read(path, machine=machine, options=chosen)
        away = [np.linalg.norm(read.poses[:, :3] - row[:3], axis=1).min() for row in rows]
        assert max(away) < 2e-4, (machine, max(away))
        k = [int(np.linalg.norm(read.poses - row, axis=1).argmin()) for row in rows]
        assert np.abs(read.poses[k, 3:] - rows[:, 3:]).max() < 1e-5 and (np.diff(k) > 0).all()
        assert np.allclose(read.feed[k[1:]], 750, rtol=2e-3) and np.all(read.spindle[k] == 9000)
        assert read.poses[read.rapid, 2].max() > 24  # above the part
    text = Path(path).read_text()
    assert (
        "(part: Step" in text
        and f"(plan: {ob.name})" in text
        and common.part("plan.plan_store").identity(ob)[:16] in text
    )


def interpreted(path):
    """X Y Z A C (n, 5) of the feed moves from LinuxCNC's interpreter. It needs a table of tools, and writes a file into
    the home folder."""
    folder = Path(common.JOB["repo"]) / ".envs" / "linuxcnc" / "usr"
    if not (folder / "bin" / "rs274").exists():
        raise common.Skip("no LinuxCNC interpreter: make envs")
    table, out = path.with_suffix(".tbl"), path.with_suffix(".canon")
    table.write_text("T1 P1 Z0 D6\n")
    out.unlink(missing_ok=True)
    libraries = {"LD_LIBRARY_PATH": f"{folder}/lib:{folder}/lib/x86_64-linux-gnu", "HOME": str(path.parent)}
    call = [folder / "bin" / "rs274", "-t", table, "-g", path, out]
    done = subprocess.run(call, env=os.environ | libraries, capture_output=True, text=True, timeout=60, check=False)
    text = out.read_text() if out.exists() else ""
    assert done.returncode == 0 and "PROGRAM_END" in text, done.stderr or done.stdout
    feeds = re.findall(r"STRAIGHT_FEED\((.*)\)", text)
    return np.array([[float(x) for x in feed.split(",")] for feed in feeds])[:, [0, 1, 2, 3, 5]]


def test_linuxcnc_accepts_it():
    ob = programs.resolved()
    path = Path(write("accepted.ngc", post="linuxcnc-xyzac", options='{"rot_point": [0, 0, -40]}'))
    feeds, (rows,) = interpreted(path), programs.content(ob).cl
    assert len(feeds) >= len(rows)
    # a table tilts by A and turns by C: the axis in the part is Rz(−C) Rx(−A) z or its mirror, whose height is cos A
    wanted = np.degrees(np.arccos(rows[:, 5]))
    assert np.abs(np.abs(feeds[:, 3]).max() - wanted.max()) < 1e-3


def test_colliding_rows_are_lifted_and_listed():
    """A tool that stands upright on the step's floor is free; leaning into the wall it is not, and is lifted."""
    ob = programs.resolved(programs.valley(programs.LEANING, programs.INTO, programs.LEANING))
    plan = programs.content(ob)
    lines = programs.listed(ob.riffler.plan.findings)
    kinds = {e["kind"] for e in lines}
    if plan.cl[0] is None:
        assert kinds & {"blocked", "unsafe"}
    else:
        assert "lifted" in kinds and free(plan.cl[0]) > -0.011
    first = lines[0]
    assert first["path"] == 0 and "Path 1, " in first["name"]
    bpy.context.scene.frame_set(1)
    assert bpy.ops.riffler.finding_go(of="PLAN", index=0) == {"FINISHED"}
    track = common.part("plan.replan").layout_of(ob, plan).tracks[0]
    assert track.nearest(bpy.context.scene.frame_current_final) == first["point"] > 0


@common.core_bound
def test_unresolved_paths_are_refused():
    ob = programs.plan(plans.ring())
    path = common.out("refused.ngc")
    Path(path).unlink(missing_ok=True)
    call = lambda: bpy.ops.riffler.plan_nc(filepath=path)  # noqa: E731
    common.refused(call, "No path has an orientation", "set a key")
    common.part("plan.plan_store").write(ob, riffler.plan.Plan([programs.valley(programs.LEANING)], plans.TOOL))
    common.refused(call, "path 1 may collide", "Resolve")
    bpy.ops.riffler.plan_resolve()
    call()
    for change in (lambda: setattr(bpy.context.scene.riffler.plan, "clearance", 0.3), moved):
        change()
        Path(path).unlink(missing_ok=True)
        common.refused(call, "have changed", "Resolve")
        assert not Path(path).exists()
        bpy.ops.riffler.plan_resolve()
        call()
    common.refused(lambda: bpy.ops.riffler.plan_nc(filepath=path, options="[1]"), "JSON object")
    common.refused(lambda: bpy.ops.riffler.plan_nc(filepath=path, post="3-axis"), "axis")


def moved():
    bpy.context.scene.riffler.plan.part.location.z = -0.5
    bpy.context.view_layer.update()


def test_a_key_that_changes_takes_the_path_s_locations_away():
    ob = programs.resolved(programs.valley(programs.LEANING), programs.valley((0, -0.3, 1)))
    assert programs.content(ob).cl[0] is not None and programs.content(ob).cl[1] is not None
    kept = programs.content(ob).cl[1]
    insert(pair(ob)[0], 73, (0, -0.5, 1))
    assert programs.content(ob).cl[0] is None and np.array_equal(programs.content(ob).cl[1], kept)
    common.refused(lambda: bpy.ops.riffler.plan_nc(filepath=common.out("x.ngc")), "path 1 may collide")
    bpy.ops.riffler.plan_resolve()
    assert np.array_equal(programs.content(ob).cl[1], kept) and programs.content(ob).cl[0] is not None


@common.core_bound
def test_blocked_paths_stay_unresolved_and_name_their_points():
    """No lift of at most a hundredth of a millimetre frees a shank that is in the wall."""
    ob = programs.plan(programs.valley(programs.INTO))
    bpy.ops.riffler.plan_resolve(max_lift=0.01)
    assert programs.content(ob).cl[0] is None
    lines = programs.listed(ob.riffler.plan.findings)
    assert lines[0]["kind"] == "blocked" and "points from 0" in lines[0]["name"]
    common.refused(
        lambda: bpy.ops.riffler.plan_nc(filepath=common.out("x.ngc")), "path 1 may collide", "switch the path off"
    )


@common.core_bound
def test_clearance_is_kept_around_shank_and_holder_and_lifts_no_cut():
    """The valley's finish is the same with 0.3 mm of it; where the shank is too near for 15 mm the tool is lifted, and
    a report says so."""
    settings = bpy.context.scene.riffler.plan
    ob = programs.plan(programs.valley(programs.LEANING), timeline=False)
    short = riffler.Tool.ball(6, 10).with_shank([(10, 3, 40, 3)])
    common.part("plan.plan_store").write(ob, replace(programs.content(ob), tool=short))
    settings.take(short.to_dict())
    bpy.ops.riffler.plan_resolve()
    (before,) = programs.content(ob).cl
    settings.clearance = 0.3
    said = common.printed(bpy.ops.riffler.plan_resolve)
    assert np.array_equal(programs.content(ob).cl[0], before) and "Warning" not in said, said
    settings.clearance = 15
    said = common.printed(bpy.ops.riffler.plan_resolve)
    (lifted,) = programs.content(ob).cl
    up = np.linalg.norm(lifted[:, :3] - before[:, :3], axis=1).max()
    assert len(lifted) == len(before) and up > 1
    assert "Warning" in said and f"1 path is free, but {len(lifted)} rows are lifted by up to {up:.3f}" in said, said
    assert "material stays" in said


@common.core_bound
def test_a_cutter_nearer_to_a_fixture_than_the_clearance_is_reported():
    ob = programs.plan(programs.valley(programs.LEANING), timeline=False)
    settings = bpy.context.scene.riffler.plan
    settings.fixtures = bpy.data.collections.new("Fixtures")
    bpy.ops.mesh.primitive_cube_add(size=1, location=(30, 11, 8))  # its edge at y = 13, z = 9.5, 1 mm from the cutter
    bpy.context.object.name, bpy.context.object.scale = "Stop", (4, 4, 3)
    settings.fixtures.objects.link(bpy.context.object)
    bpy.context.view_layer.update()
    for clearance, words in ((0.0, False), (0.3, False), (2.0, True)):
        settings.clearance = clearance
        said = common.printed(bpy.ops.riffler.plan_resolve)
        assert programs.content(ob).cl[0] is not None
        assert ("mm of Stop, nearer than the clearance" in said) == words, said


def clamped(location, scale):
    """A resolved plan of the leaning tool, with a box of the scene as its fixture."""
    ob = programs.plan(programs.valley(programs.LEANING), timeline=False)
    settings = bpy.context.scene.riffler.plan
    settings.fixtures = bpy.data.collections.new("Fixtures")
    bpy.ops.mesh.primitive_cube_add(size=1, location=location)
    bpy.context.object.name, bpy.context.object.scale = "Clamp", scale
    settings.fixtures.objects.link(bpy.context.object)
    bpy.context.view_layer.update()
    bpy.context.view_layer.objects.active = ob
    bpy.ops.riffler.plan_resolve()
    assert programs.content(ob).cl[0] is not None
    return ob, settings


@common.core_bound
def test_links_go_round_a_clamp_that_the_holder_would_meet():
    ob, _ = clamped((30, -66.5, 75), (140, 17, 30))
    (rows,) = programs.content(ob).cl
    near = common.part("plan.obstacles").take(bpy.context, ob).result()
    plain = riffler.Program.from_cl([rows], tools=[plans.TOOL], feed=600, safe_height=150)
    away = common.out("away.ngc")
    try:
        plain.write(away, collider=near.collider)
    except ValueError as error:
        assert "the holder meets a fixture" in str(error)
    else:
        raise AssertionError("the scene is not the intended one")
    read = riffler.Program.read(write("clamped.ngc"))
    assert max(np.linalg.norm(read.poses - row, axis=1).min() for row in rows) < 2e-4
    share = np.linspace(0, 1, 40)[:, None]
    between = np.concatenate([a + share * (b - a) for a, b in itertools.pairwise(read.poses)])
    between[:, 3:] /= np.linalg.norm(between[:, 3:], axis=1)[:, None]
    assert near.clearance(plans.TOOL, between).min() > -0.03


@common.core_bound
def test_the_panel_describes_how_the_tool_approaches_its_cuts():
    ob, settings = clamped((30, -300, 5), (10, 10, 10))
    (rows,) = programs.content(ob).cl

    def before_the_cut():
        poses = riffler.Program.read(write("links.ngc")).poses
        return poses[: int(np.linalg.norm(poses - rows[0], axis=1).argmin())]

    assert np.allclose(np.cross(before_the_cut()[-1, :3] - rows[0, :3], programs.LEANING), 0, atol=1e-3)
    settings.lead_in = 4
    assert np.isclose(np.linalg.norm(before_the_cut()[-1, :3] - rows[0, :3]), 4, atol=1e-4)
    settings.lead_in, settings.leave, settings.retract = 0, "UP", 6
    assert np.allclose(before_the_cut()[-1, :3] - rows[0, :3], (0, 0, 6), atol=1e-4)
    settings.plane = 60
    assert before_the_cut()[0, 2] >= 60
    settings.plane = 12
    common.refused(lambda: bpy.ops.riffler.plan_nc(filepath=common.out("x.ngc")), "Clearance Plane must be above")


@common.core_bound
def test_links_that_collide_are_refused_with_the_place_until_the_fixture_is_moved():
    _, settings = clamped((30, 20, 100), (200, 200, 10))
    path = common.out("roofed.ngc")
    Path(path).unlink(missing_ok=True)
    common.refused(
        lambda: bpy.ops.riffler.plan_nc(filepath=path), "Path 1, row 0: no approach is clear", "mm deep, at ["
    )
    assert not Path(path).exists()
    settings.fixtures.objects["Clamp"].location.y = 900  # move the fixture
    bpy.context.view_layer.update()
    bpy.ops.riffler.plan_resolve()
    write("roofed.ngc")


def test_a_refused_key_is_reported_with_the_code():
    """It is on the timeline, and the program has the previous orientation."""
    ob = programs.resolved()
    bpy.context.scene.riffler.plan.take(plans.TOOL.to_dict())
    (before,) = programs.content(ob).cl
    assert "Warning" not in common.printed(write)
    insert(pair(ob)[0], 73, -np.array(programs.LEANING))
    assert np.array_equal(programs.content(ob).cl[0], before)
    for call in (write, bpy.ops.riffler.plan_resolve):
        said = common.printed(call)
        assert "Warning" in said and "it stays as it was" in said, said


def test_paths_without_keys_are_reported_and_not_cut():
    """The second of three has none, the third is blocked until its keys are deleted."""
    ob = programs.plan(programs.valley(programs.LEANING), plans.ring(), programs.valley(programs.INTO))
    bpy.ops.riffler.plan_resolve(max_lift=0.01)
    call = lambda: bpy.ops.riffler.plan_nc(filepath=common.out("some.ngc"))  # noqa: E731
    common.refused(call, "path 3 may collide", "switch the path off")
    tool = pair(ob)[0]
    frames, quats = common.part("plan.timeline").read_keys(tool)
    first = tracks(ob)[2].first
    common.part("plan.timeline").write_keys(tool, frames[frames < first], quats[frames < first])
    common.part("plan.replan").flush()
    said = common.printed(call)
    assert "Warning" in said and "Paths 2, 3 have no keys and are not cut" in said, said
    programs.stock()
    for look in (bpy.ops.riffler.verify, bpy.ops.riffler.simulate):
        said = common.printed(lambda look=look: look(source="PLAN"))
        assert "Warning" in said and "Paths 2, 3 have no keys and are not cut" in said, said
    bpy.ops.riffler.simulate_stop()
    read = riffler.Program.read(common.out("some.ngc"), machine="tcp")
    (rows, *others) = programs.content(ob).cl
    assert not any(o is not None and len(o) for o in others)
    assert max(np.linalg.norm(read.poses[:, :3] - row[:3], axis=1).min() for row in rows) < 2e-4
    assert "(paths: 1, 60 mm)" in Path(common.out("some.ngc")).read_text()


def test_a_program_of_some_paths_is_at_their_frames():
    ob = programs.plan(plans.ring(), programs.valley(programs.LEANING))
    programs.stock()
    bpy.ops.riffler.plan_resolve()
    bpy.context.view_layer.objects.active = ob
    made = common.part("program.programs")
    wanted = SimpleNamespace(source="PLAN", frame="WORLD")
    second = tracks(ob)[1]
    for setup in (made.take(bpy.context, wanted), made.take(bpy.context, in_file(write()))):
        cut = np.flatnonzero(~setup.program.rapid)
        frames = setup.program_timeline.frames[cut[[1, -1]]]
        assert second.first - 6 < frames[0] < frames[1] < second.last + 6, (frames, second)


def in_file(path):
    more = {"machine": "tcp", "options": "", "frame": "WORLD"}
    return SimpleNamespace(source="FILE", filepath=path, **more)


def test_resolving_is_one_step_of_undo():
    ob = programs.plan()
    name = ob.name
    common.push("plan")
    bpy.ops.riffler.plan_resolve("EXEC_DEFAULT", True)
    assert programs.content(ob).cl[0] is not None
    bpy.ops.ed.undo()
    assert not any(rows is not None for rows in programs.content(bpy.data.objects[name]).cl)


def test_the_plan_s_locations_are_played():
    ob = programs.resolved()
    state = common.part("plan.plan_states").state(ob)
    assert np.array_equal(state.motions[0].motion.poses, programs.content(ob).cl[0])
    assert state.difference.small and not state.problems


def test_inserted_rows_next_to_a_lift_are_played_too():
    """Blender from 4.x on merges two keys that are a hundredth of a frame apart."""
    ob = programs.resolved(programs.valley(programs.LEANING, (0, -0.2, 1), (0, 0.5, 0.8), programs.LEANING))
    found = common.part("plan.plan_states").state(ob)
    rows = found.motions[0].motion
    assert len(rows) > len(programs.content(ob).paths[0]) and np.diff(rows.poses[:, 2]).max() > 5
    assert found.difference.small, found.difference


@common.core_bound
def test_options_reach_the_machine():
    programs.resolved()
    chosen = {"rot_point": [0, 0, -40], "offset": [0, 0, 25]}
    own = bpy.context.scene.riffler.machines.of("linuxcnc-xyzac")
    own.rot_point, own.offset = chosen["rot_point"], chosen["offset"]
    path = write("options.ngc", post="linuxcnc-xyzac")
    read = riffler.Program.read(path, machine="linuxcnc-xyzac", options=chosen)
    rows = common.part("plan.plan_store").plan(bpy.data.objects["Riffler Plan"]).cl[0]
    assert max(np.linalg.norm(read.poses - row, axis=1).min() for row in rows) < 2e-4


def test_missing_input_is_reported():
    bpy.context.view_layer.objects.active = None
    for name in ("plan_resolve", "plan_nc"):
        assert not getattr(bpy.ops.riffler, name).poll()
        common.refused(getattr(bpy.ops.riffler, name), "Select a plan")
    ob = programs.plan(timeline=False)
    ob.riffler.plan.part = None
    bpy.context.scene.riffler.plan.part = None
    common.refused(bpy.ops.riffler.plan_resolve, "There is no part")
