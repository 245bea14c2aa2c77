"""A program is verified: its errors are found, and each leads to the frame, the place and the line."""

from dataclasses import replace
from pathlib import Path

import bpy
import numpy as np
import riffler
from mathutils import Matrix

from support import common, plans, programs

SLIP = 0.8  # mm


def findings():
    return programs.listed(programs.settings().findings)


def kinds():
    return sorted({e["kind"] for e in findings()})


def nc(slip=None, name="verify.ngc"):
    """The resolved plan as NC text; with a slip of ten moves into the part, SLIP mm along the tool's axis."""
    ob = bpy.data.objects["Riffler Plan"]
    plan = common.part("plan.plan_store").plan(ob)
    rows = np.array(plan.cl[0])
    if slip is not None:
        rows[slip : slip + 10, :3] -= SLIP * rows[slip : slip + 10, 3:]
    program = riffler.Program.from_cl([rows], tools=[plan.tool], feed=600, spindle=9000, safe_height=60)
    path = common.out(name)
    program.write(path, post="tcp")
    return path, rows


def prepared(**more):
    programs.resolved()
    stock = programs.stock(**more)
    bpy.context.scene.riffler.plan.take(plans.TOOL.to_dict())
    return stock


def test_a_good_plan_passes():
    stock = prepared()
    identity = common.part("sculpt.sculpt_store").identity(stock.data)
    assert bpy.ops.riffler.verify(source="PLAN") == {"FINISHED"}
    assert findings() == [] and "nothing was found" in programs.settings().said
    part = bpy.data.objects["Step"]
    distance = values(part)
    assert len(distance) == len(part.data.vertices)
    # the half millimetre of material remains where the pencil cut does not reach: at all of the part's corners except
    # those of the valley, which the ball cleans to its radius (√2 − 1) · 3 mm from the edge
    co = common.coordinates(part.data)
    inner = (co[:, 1] == 20) & (co[:, 2] == 8)
    assert np.all(distance >= 0) and np.all(distance[~inner] <= 0.5 + 1e-6) and distance[~inner].max() > 0.4
    assert common.part("sculpt.sculpt_store").identity(stock.data) == identity and stock.hide_get()
    bpy.ops.riffler.verify_clear()
    assert not stock.hide_get() and "riffler_deviation" not in part.data.attributes
    assert programs.settings().said == ""


def values(ob):
    out = np.empty(len(ob.data.vertices), np.float32)
    ob.data.attributes["riffler_deviation"].data.foreach_get("value", out)
    return out


def test_a_slip_of_ten_moves_is_found_and_the_jump_sets_frame_view_and_line():
    stock = prepared()
    path, rows = nc(slip=60)
    assert bpy.ops.riffler.verify(source="FILE", filepath=path, gouge=0.05) == {"FINISHED"}
    (found,) = [e for e in findings() if e["kind"] == "gouge"]
    # the ball's bottom went SLIP below the floor
    lines = Path(path).read_text().splitlines()
    read = riffler.Program.read(path)
    slipped = [int(np.linalg.norm(read.poses - row, axis=1).argmin()) for row in rows[60:70]]
    assert slipped[0] <= found["row"] <= slipped[-1] and found["line"] == read.line[found["row"]]
    assert np.linalg.norm(rows[60:70, :3] - found["place"], axis=1).min() < 5
    screen = bpy.context.window_manager.windows[0].screen
    area = next(a for a in screen.areas if a.type == "VIEW_3D")
    other = next(a for a in screen.areas if a.type not in ("VIEW_3D", "TOPBAR", "STATUSBAR"))
    other.type = "TEXT_EDITOR"
    bpy.context.scene.frame_set(1)
    index = findings().index(found)
    assert bpy.ops.riffler.finding_go(of="VERIFY", index=index) == {"FINISHED"}
    assert bpy.context.scene.frame_current_final == found["frame"] > 1
    text = programs.settings().text
    assert (
        text.current_line_index == found["line"] - 1 and text.lines[found["line"] - 1].body == lines[found["line"] - 1]
    )
    space = other.spaces.active
    assert space.text == text and space.top <= found["line"] - 1 <= space.top + 30
    text.clear()  # the user has edited it: frame and place are shown all the same
    bpy.context.scene.frame_set(1)
    bpy.ops.riffler.finding_go(of="VERIFY", index=index)
    assert bpy.context.scene.frame_current_final == found["frame"]
    view = area.spaces.active.region_3d
    assert np.allclose(view.view_location, found["place"], atol=1e-4)
    # at that frame the simulated stock has the row of the finding
    bpy.ops.riffler.verify_clear()
    bpy.ops.riffler.simulate(source="FILE", filepath=path)
    assert common.part("program.simulation").active().prefix.row >= found["row"]
    bpy.ops.riffler.simulate_stop()
    assert not stock.hide_get()


def test_a_plan_s_findings_have_the_lines_of_its_nc_code():
    """A stock with a block above the wall, which the plan's rows reach, but approach and retract do not."""
    ob = programs.resolved()
    plan = programs.content(ob)
    rows = np.array(plan.cl[0])
    rows[40:50, :3] -= SLIP * rows[40:50, 3:]
    common.part("plan.plan_store").write(ob, replace(plan, cl=[rows]))
    programs.stock()
    bpy.ops.riffler.verify(source="PLAN")
    (found,) = [e for e in findings() if e["kind"] == "gouge"]
    path = common.out("again.ngc")
    Path(path).unlink(missing_ok=True)
    common.refused(lambda: bpy.ops.riffler.plan_nc(filepath=path), "the cutter meets the part", "mm deep")
    assert not Path(path).exists(), "what a verification would find is not written"
    Path(path).write_text("\n".join(line.body for line in programs.settings().text.lines))
    read = riffler.Program.read(path)
    row = int(np.flatnonzero(np.asarray(read.line) == found["line"])[0])
    near = np.linalg.norm(rows[40:50] - read.poses[row], axis=1).min()
    assert near < 1e-3 and found["row"] >= 40
    track = common.part("plan.replan").layout_of(ob, plan).tracks[0]
    assert track.first < found["frame"] < track.last


@common.core_bound
def test_the_same_is_found_wherever_the_stock_stands():
    prepared()
    path, _ = nc(slip=60)
    bpy.ops.riffler.verify(source="FILE", filepath=path)
    first = findings()
    bpy.data.objects.remove(bpy.data.objects["Stock"])
    programs.stock(location=(30, -12, 7), turn=0.4)
    bpy.ops.riffler.verify(source="FILE", filepath=path)
    second = findings()
    assert [e["kind"] for e in first] == [e["kind"] for e in second]
    # The slip is four millimetres long and equally deep: rounding decides which of its places is named.
    assert np.allclose(first[0]["place"], second[0]["place"], atol=2.0)
    assert abs(first[0]["row"] - second[0]["row"]) <= 2


def test_the_remaining_material_is_shown_with_its_distances():
    """Where the pencil cut was, the ball's surface; elsewhere half a millimetre over the part."""
    stock = prepared()
    bpy.ops.riffler.verify(source="PLAN", coloured="LEFT")
    left = programs.settings().left
    part = bpy.data.objects["Step"]
    assert left.matrix_world == stock.matrix_world and not left.hide_get()
    assert stock.hide_get() and part.hide_get()  # it would cover its own gouges
    co, distance = common.coordinates(left.data).astype(float), values(left)
    floor = (np.abs(co[:, 0] - 30) < 20) & (co[:, 1] > 1) & (co[:, 1] < 13) & (co[:, 2] > 6)
    assert floor.sum() > 100 and np.abs(distance[floor] - 0.5).max() < 0.01
    # the ball's centre runs 3 mm off floor and wall
    off = np.hypot(co[:, 1] - 17, co[:, 2] - 11)
    cut = (np.abs(co[:, 0] - 30) < 20) & (off < 3.01)
    wanted = np.minimum(co[cut, 2] - 8, 20 - co[cut, 1])
    assert cut.sum() > 100 and np.abs(distance[cut] - wanted).max() < 0.01
    bpy.ops.riffler.verify(source="PLAN", coloured="LEFT")
    assert [ob.name for ob in bpy.data.objects if ob.name.startswith("Stock")] == ["Stock", "Stock Left"]
    bpy.ops.riffler.verify(source="PLAN", coloured="NONE")
    assert "Stock Left" not in bpy.data.objects and not stock.hide_get() and not part.hide_get()


def test_the_remaining_material_is_coloured_by_the_lines_and_tools_that_cut_it():
    stock = prepared()
    path, _ = nc()
    bpy.ops.riffler.verify(source="FILE", filepath=path, coloured="LINE")
    mesh = programs.settings().left.data
    read = {
        name: np.array([v.value for v in mesh.attributes[name].data])
        for name in ("riffler_row", "riffler_line", "riffler_tool")
    }
    centres = np.array([np.array(face.center) for face in mesh.polygons])
    # The ball's centre runs 3 mm off floor and wall, along x; elsewhere is the stock's own surface.
    off = np.abs(np.hypot(centres[:, 1] - 17, centres[:, 2] - 11) - 3)
    inside = np.abs(centres[:, 0] - 30) < 15
    cut = inside & (off < 0.01)
    own = inside & (off > 0.2)
    assert cut.sum() > 100 and (read["riffler_row"][cut] > 0).all() and (read["riffler_row"][own] == -1).all()
    program = riffler.Program.read(path)
    assert (read["riffler_line"][cut] == np.asarray(program.line)[read["riffler_row"][cut]]).all()
    # Rows lie along the path: the move passes the face, up to what the band of equals allows.
    tips = np.asarray(program.poses)[read["riffler_row"][cut], 0]
    before = np.asarray(program.poses)[read["riffler_row"][cut] - 1, 0]
    low, high = np.minimum(tips, before), np.maximum(tips, before)
    assert ((centres[cut, 0] > low - 0.4) & (centres[cut, 0] < high + 0.4)).all()
    assert mesh.color_attributes.active_color.domain == "CORNER" and stock.hide_get()
    legend = common.part("blender.attributes")
    assert not legend.shows_distance(mesh), "no legend of distances"
    bpy.ops.riffler.verify(source="FILE", filepath=path, coloured="TOOL")
    mesh = programs.settings().left.data
    colours = np.array([tuple(c.color) for c in mesh.color_attributes["riffler_deviation_colour"].data])[::3]
    assert len({tuple(c) for c in colours[cut].round(4)}) == 1 and not np.allclose(colours[cut][0], colours[own][0])
    bpy.ops.riffler.verify_clear()
    assert "Stock Left" not in bpy.data.objects and not stock.hide_get()


@common.core_bound
def test_fixtures_are_hit():
    prepared()
    path, _ = nc()
    mesh = bpy.data.meshes.new("Vise")
    x, y, z = np.meshgrid((20, 40), (14, 18), (9, 40), indexing="ij")
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    mesh.from_pydata(np.c_[x.ravel(), y.ravel(), z.ravel()].tolist(), [], faces)
    vise = bpy.data.objects.new("Vise", mesh)
    collection = bpy.data.collections.new("Fixtures")
    bpy.context.scene.collection.children.link(collection)
    collection.objects.link(vise)
    bpy.context.scene.riffler.plan.fixtures = collection
    bpy.context.view_layer.update()
    bpy.ops.riffler.verify(source="FILE", filepath=path)
    assert "fixture" in kinds()


@common.core_bound
def test_a_program_that_was_edited_is_verified_only_where_it_differs():
    prepared()
    good, _ = nc(name="good.ngc")
    bad, _ = nc(slip=60, name="bad.ngc")
    bpy.ops.riffler.verify(source="FILE", filepath=bad)
    kept = common.part("program.verify")._last.verification
    whole = findings()
    bpy.ops.riffler.verify(source="FILE", filepath=good)
    assert common.part("program.verify")._last.verification is kept and findings() == []
    bpy.ops.riffler.verify(source="FILE", filepath=bad)
    assert findings() == whole and whole
    bpy.ops.riffler.verify(source="FILE", filepath=bad, gouge=2.0)
    assert common.part("program.verify")._last.verification is not kept and kinds() == []


@common.core_bound
def test_every_machine_s_program_is_verified():
    """Also of one whose language riffler cannot read: it has no lines then."""
    prepared()
    for machine in riffler.machines():
        if machine == "3-axis":
            continue  # the tool leans
        settings = bpy.context.scene.riffler.plan
        settings.post = machine
        if machine.startswith("linuxcnc"):
            bpy.context.scene.riffler.machines.of(machine).rot_point = (0, 0, -40)
        assert bpy.ops.riffler.verify(source="PLAN") == {"FINISHED"}
        assert kinds() == [] and programs.settings().text is not None, machine


def reports(**how):
    said = common.printed(lambda: bpy.ops.riffler.verify(**how))
    return " ".join(said.split())


@common.core_bound
def test_the_chosen_machine_is_verified_wherever_the_stock_stands():
    """Earlier a turned stock, and a .rprog file, gave “No machine was given”, and no limits were checked."""
    ob = programs.resolved()
    bpy.context.scene.riffler.plan.take(plans.TOOL.to_dict())
    tilt = float(np.degrees(np.arccos(programs.content(ob).cl[0][:, 5].min())))
    own, path = bpy.context.scene.riffler.machines.of("linuxcnc-xyzac"), saved(ob)
    bpy.context.scene.riffler.plan.post = "linuxcnc-xyzac"
    own.rot_point = (0, 0, -40)
    for where in ({}, {"location": (30, -12, 7), "turn": 0.4}):
        programs.stock(**where)
        for limit, found in ((90, []), (tilt / 2, ["machine"])):
            own.limits_a = (-limit, limit)
            said = reports(source="FILE", filepath=path, machine="linuxcnc-xyzac")
            assert kinds() == found and "no machine" not in said, said
        assert findings()[0]["title"].startswith("Out of reach at ")
        own.property_unset("limits_a")
        said = reports(source="PLAN")
        assert kinds() == [] and "no machine" not in said, said
        bpy.data.objects.remove(bpy.data.objects["Stock"])


def saved(ob):
    """The plan's program as a .rprog file."""
    plan = programs.content(ob)
    program = riffler.Program.from_cl(plan.cl, tools=[plan.tool], feed=600, spindle=9000, safe_height=60)
    path = common.out("plan.rprog")
    program.save(path)
    return path


def test_a_sculpt_s_cuts_are_verified_for_the_machine_of_their_nc_code():
    programs.stock()
    ob = bpy.data.objects["Stock"]
    bpy.context.view_layer.objects.active = ob
    line = common.curve("Line", [(5, 5, 8), (50, 5, 8)], mm_per_unit=1.0)
    bpy.context.view_layer.objects.active = ob
    bpy.ops.riffler.cut_curve(curve=line.name, depth=0.2)
    said = reports(source="CUTS")
    assert "no machine" not in said, said


def test_findings_begin_with_what_differs():
    prepared()
    path, _ = nc(slip=60)
    bpy.ops.riffler.verify(source="FILE", filepath=path)
    (found,) = [e for e in findings() if e["kind"] == "gouge"]
    kind, size, at, *place = found["title"].split()
    assert (kind, at) == ("Gouge", "at") and 0.5 * SLIP < float(size) < SLIP, found
    assert np.allclose([float(x) for x in place], found["place"], atol=0.51)
    assert "lift the path" in found["name"], "the whole sentence is under the list"


def test_a_described_holder_is_not_requested_again():
    """Material is where the spindle would be: earlier findings asked for the shank and the holder."""
    programs.resolved()
    bpy.context.scene.riffler.plan.take(plans.TOOL.to_dict())
    path, _ = nc()
    vertices, triangles = plans.step()
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    above = np.array([0, -60, 75]) + (vertices - low) / (high - low) * [60, 30, 30]
    both = riffler.Mesh(np.vstack([vertices, above]), np.vstack([triangles, triangles + len(vertices)]))
    stock = riffler.Volume.from_mesh(both, 1.0)
    ob = common.part("sculpt.sculpts").new_object(
        bpy.context, "Tall", common.part("common.contents").Content(stock), Matrix.Identity(4)
    )
    programs.settings().stock = ob
    bpy.context.view_layer.update()
    bpy.ops.riffler.verify(source="FILE", filepath=path)
    unknown = [e["name"] for e in findings() if e["kind"] == "unknown"]
    assert unknown, [(e["kind"], e["name"]) for e in findings()]
    assert unknown and not any("describe the shank" in name for name in unknown)
    assert all(name.startswith("the holder of tool 1 ends 70.0 mm above the tip") for name in unknown), unknown[0]


def test_a_verification_is_one_step_of_undo():
    prepared()
    path, _ = nc(slip=60)
    common.push("before")
    bpy.ops.riffler.verify("EXEC_DEFAULT", True, source="FILE", filepath=path)
    assert findings()
    bpy.ops.ed.undo()
    assert findings() == [] and "riffler_deviation" not in bpy.data.objects["Step"].data.attributes
    assert not bpy.data.objects["Stock"].hide_get()


def test_missing_input_is_reported():
    common.refused(bpy.ops.riffler.finding_go, "There are no findings")
    common.refused(bpy.ops.riffler.verify_clear, "Nothing was verified")
    bpy.context.view_layer.objects.active = None
    common.refused(bpy.ops.riffler.verify, "There is no stock")
    prepared()
    path, _ = nc(slip=60)
    bpy.ops.riffler.verify(source="FILE", filepath=path)
    common.refused(lambda: bpy.ops.riffler.finding_go(index=99), "no finding 99")


def test_the_legend_is_of_the_mesh_that_is_coloured():
    prepared()
    legend = common.part("stock.deviation_legend")
    assert legend.mesh_of(bpy.context) is None
    bpy.ops.riffler.verify(source="PLAN", scale=0.4)
    mesh = legend.mesh_of(bpy.context)
    assert mesh == bpy.data.objects["Step"].data
    bar = legend.bar(mesh)
    assert (bar.low, bar.high, bar.at(0.4), bar.at(-0.4)) == (-0.4, 0.4, bar.height, 0)
    # the colours at its ends are those of the mesh
    of = common.part("common.colours").of_distance(np.array([-0.4, 0.0, 0.4]), 0.4)
    assert np.allclose([bar.colours[k][1] for k in (0, 8, 16)], of[:, :3])


def test_an_edited_text_is_kept_when_it_is_verified_again():
    prepared()
    path, _ = nc(slip=60)
    other, _ = nc(name="other.ngc")

    def verified(path):
        assert bpy.ops.riffler.verify(source="FILE", filepath=path) == {"FINISHED"}
        return programs.settings().text

    first = verified(path)
    assert verified(other) == first, "it is unedited"
    mine = first.as_string().replace("G1", "G1 (mine)", 1)
    first.from_string(mine)
    second = verified(path)
    assert second != first and first.as_string() == mine and second.name != first.name
    assert second.lines[2].body == Path(path).read_text().splitlines()[2]
    assert verified(other) == second == verified(path) and first.as_string() == mine
    assert (first.name, second.name) == ("other.ngc", "verify.ngc")
    findings = common.part("plan.findings")
    second.write("G0 X0")
    third, edited = findings.text_of(second, second.name, "G0 Z50")
    assert third != second and edited == second.name != third.name and third.as_string().strip() == "G0 Z50"
