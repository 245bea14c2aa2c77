"""Jobs: operations are calculated in order, stored in the file, simulated, verified and written."""

import re
from pathlib import Path

import bpy
import numpy as np
import riffler

from support import common, plans

FLAT = {"kind": "flat", "diameter": 8.0, "length": 30.0, "name": "Flat 8"}
BALL = {"kind": "ball", "diameter": 6.0, "length": 30.0, "name": "Ball 6"}


def settings():
    return bpy.context.scene.riffler.machining


def job(mm_per_unit=1.0, **stock):
    """Makes a job that roughs a step with a flat cutter and finishes it coarsely with a ball; returns its rows."""
    common.scale(mm_per_unit)
    plan = bpy.context.scene.riffler.plan
    plan.part = plans.part_object(mm_per_unit)
    bpy.ops.riffler.machining_stock(pitch=1.0, **stock)
    for kind, tool in (("ROUGH", FLAT), ("FINISH", BALL)):
        plan.take(tool)
        bpy.ops.riffler.machining_add(kind=kind)
    rough, finish = settings().rows
    rough.stepdown, rough.allowance, rough.tolerance = 8.0, 0.5, 0.1
    finish.cusp, finish.tolerance = 0.2, 0.05
    return rough, finish


def calculate():
    return bpy.ops.riffler.machining_calculate()


def states():
    """The states that the panel shows."""
    glances = common.part("machining.inputs").glances(bpy.context.scene)
    state_of = common.part("machining.panel").state_of
    return [state_of(row, k, glances) for k, row in enumerate(settings().rows)]


def stored():
    return common.part("machining.job_store").operations(bpy.context.scene)


def refused(call, **more):
    try:
        call(**more)
    except RuntimeError as error:
        return str(error)
    raise AssertionError("it was done")


def heights(volume, points):
    """Height of the topmost material of a mesh at (n, 2) points, by rays in numpy."""
    mesh = volume.to_mesh()
    corners = np.asarray(mesh.vertices)[np.asarray(mesh.triangles)]
    out = np.full(len(points), -np.inf)
    for a, b, c in corners:
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        if area <= 0:
            continue
        u = ((points[:, 0] - a[0]) * (c[1] - a[1]) - (points[:, 1] - a[1]) * (c[0] - a[0])) / area
        v = ((b[0] - a[0]) * (points[:, 1] - a[1]) - (b[1] - a[1]) * (points[:, 0] - a[0])) / area
        inside = (u >= 0) & (v >= 0) & (u + v <= 1)
        out[inside] = np.maximum(out[inside], (a[2] + u * (b[2] - a[2]) + v * (c[2] - a[2]))[inside])
    return out


@common.core_bound
def test_what_is_left_is_the_part_within_allowance_and_cusp():
    job()
    assert states() == ["OPEN", "OPEN"]
    assert calculate() == {"FINISHED"} and settings().problem == ""
    assert states() == ["DONE", "DONE"]
    bpy.ops.riffler.machining_left()
    left = bpy.context.object
    assert left.name == "Step after 2"
    volume = common.part("sculpt.sculpt_store").content(left.data).volume
    x, y = np.meshgrid(np.linspace(5, 55, 11), [4.0, 9.0, 14.0, 25.0, 30.0, 35.0])
    points = np.c_[x.ravel(), y.ravel()]
    wanted = np.where(points[:, 1] < 20, 8.0, 24.0)
    over = heights(volume, points) - wanted
    assert over.min() > -0.06 and over.max() < 0.2 + 0.06, (over.min(), over.max())


@common.core_bound
def test_only_what_has_changed_is_calculated_again():
    rough, finish = job()
    calculate()
    first, before = rough.key, stored()[rough.key]
    finish.cusp = 0.3
    assert states() == ["DONE", "OPEN"]
    calculate()
    assert rough.key == first and stored()[first] is before
    assert states() == ["DONE", "DONE"]
    rough.stepdown = 12.0
    assert states() == ["OPEN", "OPEN"]
    calculate()
    assert rough.key != first and first not in stored()
    finish.on = False
    assert states()[0] == "DONE"


def test_save_and_reopen():
    rough, finish = job()
    finish.on = False
    calculate()
    poses = stored()[rough.key].poses
    path = common.out("job.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.wm.open_mainfile(filepath=path)
    row = settings().rows[0]
    assert (stored()[row.key].poses == poses).all() and states()[0] == "DONE"
    path = common.out("job.ngc")
    bpy.ops.riffler.machining_nc("EXEC_DEFAULT", filepath=path, post="3-axis")
    read = riffler.Program.read(path, machine="3-axis")
    assert np.abs(read.poses[:, :3].max(axis=0) - poses[:, :3].max(axis=0)).max() < 1e-3


def test_undo():
    rough, finish = job()
    finish.on = False
    calculate()
    bpy.ops.ed.undo_push(message="calculated")
    key = rough.key
    settings().rows[0].stepdown = 12.0
    calculate()
    bpy.ops.ed.undo_push(message="again")
    assert settings().rows[0].key != key
    bpy.ops.ed.undo()
    assert settings().rows[0].key == key and key in stored() and states()[0] == "DONE"


def test_the_nc_code_has_its_zero_and_is_simulated_and_verified():
    job()
    calculate()
    bpy.ops.riffler.machining_zero(place="TOP")
    assert np.allclose(settings().zero, (30, 20, 25), atol=1e-5)  # 1 mm above the step
    bpy.context.scene.cursor.location = (30, 20, 24)
    bpy.ops.riffler.machining_zero(place="CURSOR")
    assert np.allclose(settings().zero, (30, 20, 24))
    path = common.out("job-zero.ngc")
    bpy.ops.riffler.machining_nc("EXEC_DEFAULT", filepath=path, post="3-axis")
    read = riffler.Program.read(path, machine="3-axis")
    cuts = read.poses[~read.rapid]
    assert abs(cuts[:, 2].min() + 24) < 0.1, cuts[:, 2].min()  # around the step, down to the stock's bottom
    assert len(set(read.tool[1:].tolist())) == 2 and re.search(r"\bT2\b", Path(path).read_text())
    bpy.context.scene.riffler.plan.post = "3-axis"
    verify = bpy.context.scene.riffler.verify
    bpy.ops.riffler.verify(source="JOB", gouge=0.1, coloured="NONE")
    assert not verify.findings, [f.name for f in verify.findings]
    bpy.ops.riffler.simulate(source="JOB")
    simulated = common.part("program.simulation")
    now = simulated.active()
    bpy.context.scene.frame_set(now.program_timeline.last)
    left = now.prefix.volume.volume
    simulated.end()
    whole = common.part("sculpt.sculpt_store").content(settings().stock.data).volume.volume
    part = 60 * (40 * 8 + 20 * 16)
    assert part < left < 0.5 * (part + whole), (part, left, whole)


def test_a_changed_part_is_not_written():
    _, finish = job()
    finish.on = False
    calculate()
    part = bpy.context.scene.riffler.plan.part
    part.data.vertices[0].co.z -= 1.0  # a change that the panel does not detect
    part.data.update()
    bpy.context.view_layer.update()
    text = refused(bpy.ops.riffler.machining_nc, filepath=common.out("never.ngc"), post="3-axis")
    assert "Rough" in text and "Calculate" in text, text


@common.core_bound
def test_a_stock_and_a_part_that_are_moved_together_keep_their_moves():
    rough, finish = job(bottom=1.0)
    finish.on = False
    calculate()
    key = rough.key
    for ob in (bpy.context.scene.riffler.plan.part, settings().stock):
        ob.location.x += 100.0
    bpy.context.view_layer.update()
    assert calculate() == {"FINISHED"} and rough.key == key
    path = common.out("moved.ngc")
    bpy.ops.riffler.machining_nc("EXEC_DEFAULT", filepath=path, post="3-axis")
    read = riffler.Program.read(path, machine="3-axis")
    assert read.poses[~read.rapid][:, 0].min() > 80


@common.core_bound
def test_another_axis_and_any_unit():
    rough, finish = job(mm_per_unit=1000.0)
    finish.on = False
    axis = bpy.data.objects.new("Axis", None)
    axis.rotation_euler.x = -np.pi / 2  # its z is the scene's y
    bpy.context.collection.objects.link(axis)
    bpy.context.view_layer.update()
    settings().upright = axis
    rough.take_tool({**FLAT, "length": 50.0})
    bpy.ops.riffler.machining_stock(pitch=1.0)
    assert calculate() == {"FINISHED"} and settings().problem == "", settings().problem
    program, _ = common.part("machining.job_program").of_scene(bpy.context)
    assert np.allclose(program.poses[:, 3:], (0, 1, 0), atol=1e-6)
    assert "3-axis" in refused(bpy.ops.riffler.machining_nc, filepath=common.out("never.ngc"), post="3-axis")


def test_missing_input_is_reported():
    assert "part" in refused(bpy.ops.riffler.machining_calculate)
    bpy.context.scene.riffler.plan.part = plans.part_object(1000.0)
    assert "Make Stock" in refused(bpy.ops.riffler.machining_calculate)
    bpy.ops.riffler.machining_stock(pitch=1.0)
    assert "no operations" in refused(bpy.ops.riffler.machining_calculate)
    bpy.ops.riffler.machining_add(kind="ROUGH")
    (row,) = settings().rows
    row.tool = "[]"
    assert "Rough" in refused(bpy.ops.riffler.machining_calculate)
    bpy.ops.riffler.machining_tool(name="")
    row.on = False
    assert "off" in refused(bpy.ops.riffler.machining_calculate)
    assert "Calculate" in refused(bpy.ops.riffler.machining_left)
    bpy.ops.riffler.machining_remove()
    assert not settings().rows


def test_an_operation_without_moves_gives_the_reason():
    rough, finish = job()
    rough.on = False
    finish.slope_from, finish.slope_to = np.radians(30), np.radians(40)
    calculate()
    assert finish.state == "EMPTY" and finish.said and settings().problem == ""


@common.core_bound
def test_holes_outlines_and_valleys():
    """Drills where a step has no holes, pencil cuts the step's valley, and cuts the step out with tabs."""
    job()
    settings().rows.clear()
    plan = bpy.context.scene.riffler.plan
    holes = bpy.data.collections.new("Holes")
    bpy.context.scene.collection.children.link(holes)
    for k, at in enumerate([(10, 5, 8), (50, 5, 8)]):
        ob = bpy.data.objects.new(f"Hole {k}", None)
        ob.location = at
        holes.objects.link(ob)
    for kind, tool in (
        ("DRILL", {**FLAT, "diameter": 3.0}),
        ("PENCIL", BALL),
        ("OUTLINE", {**FLAT, "length": 40.0}),
    ):
        plan.take(tool)
        bpy.ops.riffler.machining_add(kind=kind)
    drill, pencil, outline = settings().rows
    assert "no holes" in refused(calculate)
    drill.points, drill.hole_depth, drill.peck = holes, 4.0, 2.0
    outline.stepdown, outline.tabs, outline.tab_height = 8.0, 2, 2.0
    bpy.context.view_layer.update()
    assert calculate() == {"FINISHED"}
    # The step has no holes, so both drillings would enter it.
    assert drill.state == "EMPTY" and "enter the part" in drill.said, drill.said
    assert pencil.state == outline.state == "DONE" and settings().problem == "", settings().problem
    valley = stored()[pencil.key]
    cuts = valley.poses[valley.kind == 2]
    assert np.allclose(cuts[:, 1:3], (17, 8), atol=0.05)  # 3 mm off the wall, on the plate
    around = stored()[outline.key]
    assert around.poses[around.kind == 2][:, 2].min() < 0.01
    first = drill.key
    bpy.data.objects["Hole 0"].location.x = 11
    bpy.context.view_layer.update()
    assert states() == ["OPEN", "OPEN", "OPEN"]
    calculate()
    assert drill.key != first


def test_the_order_and_the_names_of_operations():
    job()
    bpy.ops.riffler.machining_add(kind="ROUGH")
    assert [row.name for row in settings().rows] == ["Rough", "Finish", "Rough 2"]
    bpy.ops.riffler.machining_move(direction="UP")
    assert [row.name for row in settings().rows] == ["Rough", "Rough 2", "Finish"] and settings().row == 1
    assert bpy.ops.riffler.machining_move(direction="UP") == {"FINISHED"}
    assert bpy.ops.riffler.machining_move(direction="UP") == {"CANCELLED"}


def test_damaged_moves_are_calculated_again():
    rough, finish = job()
    finish.on = False
    calculate()
    image = settings().store
    image.pack(data=b"nonsense", data_len=8)
    common.part("machining.job_store").detach()
    assert "damaged" in refused(bpy.ops.riffler.machining_nc, filepath=common.out("never.ngc"), post="3-axis")
    assert calculate() == {"FINISHED"} and rough.key in stored()


def curve_object(name, points):
    data = bpy.data.curves.new(name, "CURVE")
    data.dimensions = "3D"
    spline = data.splines.new("POLY")
    spline.points.add(len(points) - 1)
    for point, at in zip(spline.points, points, strict=True):
        point.co = (*at, 1.0)
    return bpy.data.objects.new(name, data)


@common.core_bound
def test_axes_that_change_and_engraving():
    """Finishes a step with the tool towards an object, and engraves a curve into its upper face."""
    _, finish = job()
    settings().rows.remove(0)
    (finish,) = settings().rows
    finish.orientation, finish.slope_to = "TOWARDS", np.radians(20)
    assert "no target" in refused(calculate)
    target = bpy.data.objects.new("Target", None)
    target.location = (30, 20, 90)
    engraved = bpy.data.collections.new("Engraved")
    bpy.context.scene.collection.children.link(engraved)
    engraved.objects.link(target)
    bpy.context.view_layer.update()
    finish.target = target
    bpy.ops.riffler.machining_add(kind="ENGRAVE")
    engrave = settings().rows[1]
    assert "no curves" in refused(calculate)
    curve = curve_object("Line", [(20, 30, 24), (40, 30, 24)])
    engraved.objects.link(curve)
    bpy.context.view_layer.update()
    engrave.curves, engrave.engrave_depth = engraved, 0.25
    assert calculate() == {"FINISHED"} and settings().problem == "", settings().problem
    assert states() == ["DONE", "DONE"]
    op = stored()[finish.key]
    cuts = op.poses[op.kind == 2]
    tilted = np.arccos(cuts[:, 5].clip(-1, 1))
    assert 0.2 < tilted.max() < 0.6
    line = stored()[engrave.key]
    assert np.isclose(line.report.cut_mm, 20, atol=1e-3) and np.isclose(line.engraved, 0.25)
    assert np.isclose(line.poses[line.kind == 2][:, 2].min(), 23.75, atol=1e-3)
    curve.data.splines[0].points[0].co.x = 22
    target.location.z = 120
    bpy.context.view_layer.update()
    assert states() == ["OPEN", "OPEN"]


@common.core_bound
def test_swarf_cuts_and_the_fields_of_each_orientation():
    job()
    settings().rows.clear()
    bpy.ops.riffler.machining_add(kind="SWARF")
    (swarf,) = settings().rows
    calculate()
    assert swarf.state == "DONE" and swarf.cut > 20, (swarf.state, swarf.said)
    fields_of = common.part("machining.pure.operation_kinds").fields_of
    swarf.kind = "FINISH"
    assert "lead" not in fields_of("FINISH", swarf) and "max_tilt" not in fields_of("FINISH", swarf)
    swarf.orientation = "LEAD"
    assert {"lead", "tilt", "max_tilt"} <= set(fields_of("FINISH", swarf))
    assert "target" not in fields_of("FINISH", swarf)
