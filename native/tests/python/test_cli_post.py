"""``riffler nc post`` and ``riffler nc machines``: plans, recordings and programs as NC code for a machine."""

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import riffler
from commands import result, riffle
from riffler import cli, plan
from riffler_bench import nc_judge

import linuxcnc

TABLE = {"rot_point": [0, 0, -40], "offset": [0, 0, 25]}
TABLE_WORDS = ("--post-option", "rot_point=0,0,-40", "--post-option", "offset=0,0,25")
BALL = riffler.Tool.ball(6, 30)
CORNER = plan.PencilPath(
    3.0,
    [[3, y, 3] for y in (0, 4, 9)],
    [[[3, y, 0], [0, y, 3]] for y in (0, 4, 9)],
    [[[0, 0, 1], [1, 0, 0]]] * 3,
)


def swinging(n=30):
    t = np.linspace(0, 1, n)
    axes = np.column_stack([0.4 * np.sin(5 * t), 0.3 * np.cos(4 * t), np.ones(n)])
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    return np.column_stack([60 * t, 8 * np.sin(6 * t), -t, axes])


def corner_part():
    """A floor z ≤ 0 and a wall x ≤ 0 that meet along y: a closed part about the corner."""
    profile = np.array([[-20, -10], [30, -10], [30, 0], [0, 0], [0, 30], [-20, 30.0]])
    vertices = [[x, y, z] for y in (-10, 20) for x, z in profile]
    n = len(profile)
    sides = [t for k in range(n) for a in [(k + 1) % n] for t in ((k, a, k + n), (a, a + n, k + n))]
    # The ends: two rectangles of four corners.
    end = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)]
    ends = [(c, b, a) for a, b, c in end] + [(a + n, b + n, c + n) for a, b, c in end]
    mesh = riffler.Mesh(np.array(vertices, float), np.array(sides + ends, np.int32))
    if mesh.volume < 0:
        mesh = riffler.Mesh(mesh.vertices, mesh.triangles[:, ::-1].copy())
    assert mesh.audit().open_edges == 0
    return mesh


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    mesh = corner_part()
    mesh.write(tmp_path / "corner.stl")
    part = plan.part_of(riffler.Mesh.read(tmp_path / "corner.stl"), "corner.stl")
    plan.save(tmp_path / "plain.json", plan.Plan([CORNER], BALL, part=part, tolerance=0.01))
    leaning = CORNER.orient({0: (0.6, 0, 0.8)})
    plan.save(tmp_path / "leaning.json", plan.Plan([leaning], BALL, part=part))
    program = riffler.Program.from_cl([swinging()], tools=[BALL], feed=800, spindle=12000)
    program.save(tmp_path / "p.rprog")
    program.write(tmp_path / "p.ngc", post="tcp", options={"safe_start": False})
    journal = riffler.Journal()
    journal.set_stock((0, -10, -5), (60, 10, 0), 0.5)
    journal.add_tool(3, BALL)
    journal.add_stroke(3, swinging(), times=np.linspace(0, 6, 30))
    journal.save(tmp_path / "s.rjournal")
    (tmp_path / "empty.ngc").write_text("M2\n")
    (tmp_path / "bad.ngc").write_text("G21 G90\nG1 X9\n")
    plan.save(tmp_path / "none.json", plan.Plan([], BALL))
    plan.save(tmp_path / "flat.json", plan.Plan([CORNER], riffler.Tool.flat(6, 30)))
    return tmp_path


def poses_of(path, machine, **options):
    return riffler.Program.read(path, machine=machine, options=options).poses


def nearest(poses, wanted):
    return max(np.linalg.norm(poses - pose, axis=1).min() for pose in wanted)


# ---- what it writes


def test_a_plan_becomes_code_with_the_balls_tip_on_its_paths(folder):
    data = result("nc", "post", "plain.json", "--feed", 700, "--post", "3-axis", "--out", "p.ngc", cwd=folder)
    tips = np.array([[3, y, 0.0, 0, 0, 1] for y in (0, 4, 9)])
    assert nearest(poses_of(folder / "p.ngc", "3-axis"), tips) < 1e-5
    assert data["rows"] == 5 and data["blocks"] == 5 and data["subdivisions"] == 0
    # The feed in along the axis, then 9 mm.
    assert data["length"] == pytest.approx(10 + 9) and data["minutes"] == pytest.approx(19 / 700)
    assert data["tools"] == [1] and data["post"] == "3-axis" and set(data["seconds"]) == {"read", "write"}
    assert any("without axes" in note for note in data["notes"])
    assert any("not checked" in note for note in data["notes"])
    assert data["bytes"] == (folder / "p.ngc").stat().st_size
    assert "part: corner.stl" in (folder / "p.ngc").read_text()


def test_a_plan_without_a_feed_is_cut_slowly_with_a_note(folder):
    data = result("nc", "post", "plain.json", "--post", "linuxcnc-xyzac", *TABLE_WORDS, "--out", "p.ngc", cwd=folder)
    assert data["notes"][0].startswith("feed 500 mm/min") and data["minutes"] == pytest.approx(19 / 500)


def test_axes_come_from_the_plan_or_the_command_line(folder):
    wanted = np.array([[3 - 3 * 0.6, y, 3 - 3 * 0.8, 0.6, 0, 0.8] for y in (0, 4, 9)])
    result("nc", "post", "leaning.json", "--feed", 700, "--post", "tcp", "--out", "a.ngc", cwd=folder)
    result("nc", "post", "plain.json", "--feed", 700, "--axis", "6,0,8", "--post", "tcp", "--out", "b.ngc", cwd=folder)
    for name in ("a.ngc", "b.ngc"):
        assert nearest(poses_of(folder / name, "tcp"), wanted) < 2e-5
    result("nc", "post", "plain.json", "--feed", 9, "--axis", "-6,0,8", "--post", "tcp", "--out", "c.ngc", cwd=folder)
    assert poses_of(folder / "c.ngc", "tcp")[1, 3] == pytest.approx(-0.6)


@pytest.mark.parametrize("more", [(), ("--part", "corner.stl")])
def test_a_path_that_is_off_is_left_out(folder, more):
    part = plan.load(folder / "plain.json").part
    away = CORNER.orient({0: (0.6, 0, 0.8)})  # recognised by its axis
    both = plan.Plan([CORNER, away], BALL, part=part, off=frozenset({1}))
    plan.save(folder / "off.json", both)
    data = result("nc", "post", "off.json", "--feed", 700, *more, "--post", "tcp", "--out", "off.ngc", cwd=folder)
    assert "path 1: switched off in the plan, left out" in data["notes"]
    assert np.all(poses_of(folder / "off.ngc", "tcp")[:, 5] == 1)
    plan.save(folder / "on.json", replace(both, off=frozenset()))
    result("nc", "post", "on.json", "--feed", 700, *more, "--post", "tcp", "--out", "on.ngc", cwd=folder)
    assert not np.all(poses_of(folder / "on.ngc", "tcp")[:, 5] == 1)


def test_a_part_lifts_the_tool_out_of_it(folder):
    # Leaning into the wall the shaft would enter it; upright it stands in the corner as the path says.
    free = result(
        "nc", "post", "plain.json", "--feed", 7, "--part", "corner.stl", "--post", "tcp", "--out", "a.ngc", cwd=folder
    )
    assert any(note.startswith("all rows, approaches and retracts are free of corner.stl") for note in free["notes"])
    assert not any("lifted" in note for note in free["notes"])
    high = result(
        "nc", "post", "plain.json", "--feed", 7, "--part", "corner.stl", "--axis", "-1,0,4", "--post", "tcp", "--out",
        "b.ngc", cwd=folder,
    )  # fmt: skip
    mesh = riffler.Mesh.read(folder / "corner.stl")
    clearance = riffler.Collider(mesh).clearance(BALL, poses_of(folder / "b.ngc", "tcp"))
    assert clearance.min() > -0.011
    note = next(note for note in high["notes"] if "lifted" in note)
    path = riffler.plan.load(folder / "plain.json").paths[0].with_axes([[-0.242535625, 0, 0.9701425]] * 3)
    _, report = riffler.plan.cutter_locations(path, BALL, riffler.Collider(mesh), tolerance=0.01)
    assert note.startswith(f"3 of 3 rows are lifted, by up to {report.lift.max():.3g} mm (path 0): the tool cannot")
    riffler.Mesh(mesh.vertices * 2, mesh.triangles).write(folder / "other.stl")
    done = riffle(
        "nc", "post", "plain.json", "--feed", 7, "--part", "other.stl", "--post", "tcp", "--out", "c.ngc", cwd=folder
    )
    assert done.returncode == 2 and "the plan is for another part, corner.stl" in done.stderr


HOLDER = ("--holder", "30:20:60:20")
PLAN = (
    *("nc", "post", "plain.json", "--feed", 7, "--part", "corner.stl"),
    *("--post", "tcp", "--safe-height", 60, "--out", "a.ngc"),
)


def test_code_written_next_to_a_clamp_passes_the_verification(folder):
    """The holder would meet the clamp on the wall: what was not named is not seen, and said."""
    clamp = riffler.Volume.block((-20, -10, 30), (-5, 20, 38), pitch=0.5)
    clamp.to_mesh().write(folder / "clamp.stl")
    verify = ("nc", "verify", "a.ngc", "--stock", "corner.stl", "--pitch", 0.5, "--tool", "ball:6:30", *HOLDER)
    notes = result(*PLAN, cwd=folder)["notes"]
    assert any(note.startswith("shank and holder were not checked") for note in notes)
    assert any(note.startswith("no fixtures were checked") for note in notes)
    done = riffle(*verify, "--fixture", "clamp.stl", "--json", cwd=folder)
    assert done.returncode == 1 and {entry["kind"] for entry in json.loads(done.stdout)["findings"]} == {"fixture"}
    clear = ("--fixture", "clamp.stl", *HOLDER)
    for room in (0, 1.5):
        notes = result(*PLAN, *clear, "--clearance", room, cwd=folder)["notes"]
        lifted = next(note for note in notes if "lifted" in note)
        by = re.match(r"3 of 3 rows are lifted, by up to ([\d.]+) mm \(path 0\)", lifted)
        assert float(by[1]) == pytest.approx(8 + room, abs=0.02)  # of a pitch of 0.5, a hundredth
        assert any(
            note.startswith("all rows, approaches and retracts are free of corner.stl, clamp.stl within")
            for note in notes
        )
        assert not any("checked" in note for note in notes)
        done = riffle(*verify, "--fixture", "clamp.stl", "--json", cwd=folder)
        assert done.returncode == 0, done.stdout


def test_paths_that_no_lift_frees_are_named_and_left_out_on_request(folder):
    along = np.array([0, 11, 0])
    far = plan.PencilPath(3.0, CORNER.centres + along, CORNER.contacts + along, CORNER.normals)
    mesh = riffler.Mesh.read(folder / "corner.stl")
    both = plan.Plan([CORNER, far], BALL, part=plan.part_of(mesh, "corner.stl"))
    plan.save(folder / "plain.json", both)
    riffler.Volume.block((-20, -10, 25), (30, 5, 145), pitch=1).save(folder / "lid.rvol")
    words = (*PLAN, "--fixture", "lid.rvol", "--safe-height", 150)
    done = riffle(*words, cwd=folder)
    assert done.returncode == 2 and not (folder / "a.ngc").exists()
    assert (
        "path 0: places that no lift frees, the first at 3.000, 0.000, 3.000; turn the tool with --axis" in done.stderr
    )
    assert done.stderr.strip().endswith("move the fixtures, or leave such paths out with --skip-blocked")
    notes = result(*words, "--skip-blocked", cwd=folder)["notes"]
    assert "path 0: places that no lift frees, the first at 3.000, 0.000, 3.000: left out" in notes
    feeds = riffler.Program.read(folder / "a.ngc", machine="tcp")
    assert feeds.poses[np.asarray(feeds.feed) > 0, 1].min() >= 11


def test_programs_go_from_one_machine_to_another(folder):
    data = result(
        "nc", "post", "p.ngc", "--machine", "tcp", "--post", "linuxcnc-xyzac", *TABLE_WORDS, "--post-option",
        "safe_start=false", "--out", "q.ngc", cwd=folder,
    )  # fmt: skip
    assert nearest(poses_of(folder / "q.ngc", "linuxcnc-xyzac", **TABLE), swinging()) < 4e-5
    assert data["blocks"] == data["rows"] + data["subdivisions"] and data["subdivisions"] > 0
    # And back, under other options.
    back = [word.replace("--post-option", "--machine-option") for word in TABLE_WORDS]
    result("nc", "post", "q.ngc", "--machine", "linuxcnc-xyzac", *back, "--post", "tcp", "--out", "r.ngc", cwd=folder)
    assert nearest(poses_of(folder / "r.ngc", "tcp"), swinging()) < 6e-5


def test_a_saved_program_is_written_as_the_library_writes_it(folder):
    result(
        "nc", "post", "p.rprog", "--post", "linuxcnc-xyzbc", *TABLE_WORDS, "--post-option", "direction=iso",
        "--post-option", "max_rotary=1200", "--tolerance", 0.003, "--axis-tolerance", np.degrees(0.002),
        "--out", "a.ngc", cwd=folder,
    )  # fmt: skip
    riffler.Program.load(folder / "p.rprog").write(
        folder / "b.ngc", post="linuxcnc-xyzbc", tolerance=0.003, axis_tolerance=0.002,
        options=TABLE | {"direction": "iso", "max_rotary": 1200.0},
    )  # fmt: skip
    assert (folder / "a.ngc").read_text() == (folder / "b.ngc").read_text()


def test_a_recording_becomes_a_program(folder):
    data = result("nc", "post", "s.rjournal", "--spindle", -9000, "--out", "s.rprog", cwd=folder)
    program = riffler.Program.load(folder / "s.rprog")
    wanted = riffler.Journal.load(folder / "s.rjournal").program(spindle=-9000)
    assert program.to_bytes() == wanted.to_bytes()
    assert data["tools"] == [3] and "blocks" not in data and data["post"] is None
    whole = (folder / "s.rjournal").read_bytes()
    (folder / "cut.rjournal").write_bytes(whole + whole[16:28])
    data = result("nc", "post", "cut.rjournal", "--feed", 500, "--post", "tcp", "--out", "s.ngc", cwd=folder)
    assert data["notes"] == [f"the recording is cut off at byte {len(whole)}: all whole strokes"]
    assert set(re.findall(r"F(\S+)", (folder / "s.ngc").read_text())) == {"500"}


def test_feed_spindle_and_tools_of_the_command_line_replace_the_programs(folder):
    words = ("--feed", 321, "--spindle", 4500, "--tool", "1=taper:1:10:12:60")
    result("nc", "post", "p.rprog", *words, "--out", "q.rprog", cwd=folder)
    before, after = riffler.Program.load(folder / "p.rprog"), riffler.Program.load(folder / "q.rprog")
    assert np.array_equal(before.poses, after.poses) and np.array_equal(before.rapid, after.rapid)
    assert set(after.feed[~after.rapid]) == {321} and set(after.spindle) == {4500}
    assert after.tools[1].kind == "taper"
    result("nc", "post", "plain.json", "--feed", 5, "--tool", "12=ball:6:80", "--out", "r.rprog", cwd=folder)
    posted = riffler.Program.load(folder / "r.rprog")
    assert set(posted.tool) == {12} and posted.tools[12].length == 80


@linuxcnc.needed
def test_linuxcnc_reads_what_post_writes(folder):
    result(
        "nc", "post", "leaning.json", "--feed", 700, "--post", "linuxcnc-xyzac", *TABLE_WORDS, "--out", "p.ngc",
        cwd=folder,
    )  # fmt: skip
    moves = linuxcnc.interpreted(folder / "p.ngc")
    at = nc_judge.poses(moves.joints, nc_judge.tilting_table("A", TABLE["rot_point"], TABLE["offset"]))
    wanted = np.array([[3 - 3 * 0.6, y, 3 - 3 * 0.8, 0.6, 0, 0.8] for y in (0, 4, 9)])
    assert nearest(at, wanted) < 1e-3


def test_a_users_machine_is_a_file(folder):
    shipped = Path(__file__).parents[2] / "nc" / "machine" / "shipped" / "linuxcnc-xyzac.toml"
    (folder / "mine.toml").write_text(shipped.read_text())
    result("nc", "post", "p.rprog", "--post", "mine.toml", *TABLE_WORDS, "--out", "a.ngc", cwd=folder)
    result("nc", "post", "p.rprog", "--post", "linuxcnc-xyzac", *TABLE_WORDS, "--out", "b.ngc", cwd=folder)
    mine, theirs = ((folder / name).read_text().splitlines() for name in ("a.ngc", "b.ngc"))
    assert "mine" in mine[0] and mine[1:] == theirs[1:]


def test_a_saved_program_is_carved(folder):
    words = ("--stock", "60x20x5", "--origin", "0,-10,-5", "--pitch", 0.5, "--directions", "z", "--tool", "ball:6")
    saved = result("volume", "carve", *words, "--program", "p.rprog", "--out", "a.rvol", cwd=folder)
    code = result("volume", "carve", *words, "--program", "p.ngc", "--out", "b.rvol", cwd=folder)
    assert saved["removed"] == pytest.approx(code["removed"], rel=1e-3) and saved["removed"] > 100


def test_machines_are_listed(folder):
    assert result("nc", "machines", cwd=folder)["machines"] == riffler.machines()
    done = riffle("nc", "machines", cwd=folder)
    assert done.returncode == 0 and all(name in done.stdout for name in riffler.machines())


def test_a_table_summarises_the_written_code(folder):
    done = riffle("nc", "post", "plain.json", "--feed", 700, "--post", "tcp", "--out", "a.ngc", cwd=folder)
    assert done.returncode == 0 and done.stderr == ""
    for word in ("a.ngc written", "rows", "blocks", "length", "time", "not checked for gouges"):
        assert word in done.stdout


# ---- bad input

POST = ("--post", "tcp")
OUT = ("--out", "a.ngc")
BAD = {
    "no file": (["nowhere.rprog", *POST, *OUT], "nowhere.rprog: No such file"),
    "no post": (["p.rprog", *OUT], "--post"),
    "unknown post": (["p.rprog", "--post", "lathe", *OUT], "lathe"),
    "post for a .rprog": (["p.rprog", *POST, "--out", "b.rprog"], "leave out --post"),
    "option": (["p.rprog", *POST, "--post-option", "speed=3", *OUT], "unknown option 'speed'; known: "),
    "misspelt option": (
        ["p.rprog", *POST, "--post-option", "max_rotry=3", *OUT],
        "unknown option 'max_rotry'; did you mean max_rotary? known: ",
    ),
    "option without value": (
        ["p.rprog", *POST, "--post-option", "max_rotary", *OUT],
        "--post-option max_rotary: KEY=VALUE",
    ),
    "option twice": (["p.rprog", *POST, "--post-option", "a=1", "--post-option", "a=2", *OUT], "a is given twice"),
    "option, no number": (["p.rprog", *POST, "--post-option", "max_rotary=3x", *OUT], "--post-option max_rotary=3x"),
    "option, list": (["p.rprog", *POST, "--post-option", "rot_point=1,,2", *OUT], "--post-option rot_point=1,,2"),
    "tolerance": (["p.rprog", *POST, "--tolerance", "0", *OUT], "--tolerance"),
    "tolerance too fine": (["p.rprog", *POST, "--tolerance", "1e-7", *OUT], "tolerance"),
    "axis tolerance": (["p.rprog", *POST, "--axis-tolerance", "nan", *OUT], "--axis-tolerance"),
    "no machine": (["p.ngc", *POST, *OUT], "--machine: name the machine that p.ngc was written for"),
    "machine": (["p.ngc", "--machine", "lathe", *POST, *OUT], "lathe"),
    "machine of a program": (["p.rprog", "--machine", "tcp", *POST, *OUT], "--machine: only for NC code"),
    "code": (["bad.ngc", "--machine", "tcp", *POST, *OUT], "bad.ngc, line 2"),
    "nothing moves": (["empty.ngc", "--machine", "tcp", *POST, *OUT], "empty.ngc: it has no moves"),
    "a plan without paths": (["none.json", "--feed", "5", *POST, *OUT], "none.json: it has no moves"),
    "feed": (["plain.json", "--feed", "-5", *POST, *OUT], "--feed"),
    "no ball": (["flat.json", "--feed", "5", *POST, *OUT], "no ball of radius 3 mm"),
    "another ball": (["plain.json", "--feed", "5", "--tool", "ball:8", *POST, *OUT], "the plan is for ball 6"),
    "two tools": (["plain.json", "--feed", "5", "--tool", "ball:6", "--tool", "2=ball:6", *POST, *OUT], "one tool"),
    "axis": (["plain.json", "--feed", "5", "--axis", "0,0", *POST, *OUT], "--axis 0,0"),
    "axis 0": (["plain.json", "--feed", "5", "--axis", "0,0,0", *POST, *OUT], "--axis 0,0,0"),
    "axis of a program": (["p.rprog", "--axis", "0,0,1", *POST, *OUT], "--axis: only for .json"),
    "safe height of a program": (
        ["p.rprog", "--safe-height", "9", *POST, *OUT],
        "--safe-height: only for .json and .rjournal files; a program takes --post-option safe_height=…",
    ),
    "safe height too low": (["plain.json", "--feed", "5", "--safe-height", "-9", *POST, *OUT], "safe_height"),
    "part: missing": (["plain.json", "--feed", "5", "--part", "no.stl", *POST, *OUT], "no.stl: No such file"),
    "fixture: missing": (["plain.json", "--part", "corner.stl", "--fixture", "no.stl", *POST, *OUT], "no.stl: No such"),
    "a fixture without a part": (
        ["plain.json", "--fixture", "corner.stl", *POST, *OUT],
        "--fixture: only with",
    ),
    "a holder without a part": (
        ["plain.json", *("--holder", "30:9:60:9"), *POST, *OUT],
        "--holder: only with",
    ),
    "a holder of a program": (["p.rprog", *("--holder", "30:9:60:9"), *POST, *OUT], "--holder: only for .json files"),
    "nothing to skip": (["plain.json", "--skip-blocked", *POST, *OUT], "--skip-blocked: only with --part"),
    "clearance of nothing": (
        ["plain.json", "--part", "corner.stl", "--clearance", "1", *POST, *OUT],
        "--clearance needs a shank or a holder, which --shank and --holder describe",
    ),
    "clearance": (
        ["plain.json", "--part", "corner.stl", "--holder", "30:9:60:9", "--clearance", "-1", *POST, *OUT],
        "--clearance -1: must not be negative",
    ),
    "tilted on three axes": (["leaning.json", "--feed", "5", "--post", "3-axis", *OUT], "row"),
    "out: kind": (["p.rprog", *POST, "--out", "a.stl"], "--out a.stl"),
    "out: nowhere": (["p.rprog", *POST, "--out", "no/a.ngc"], "no folder"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input_is_one_clear_line_and_leaves_no_file(folder, case, monkeypatch, capsys):
    words, message = BAD[case]
    monkeypatch.chdir(folder)
    before = sorted(path.name for path in folder.iterdir())
    status = cli.main(["nc", "post", *words])
    out, err = capsys.readouterr()
    assert status == 2 and out == ""
    assert err.startswith("riffler: ") and err.count("\n") == 1
    assert message in err and "Traceback" not in err and "defect" not in err
    assert sorted(path.name for path in folder.iterdir()) == before


def test_a_damaged_program_names_the_byte(folder):
    data = bytearray((folder / "p.rprog").read_bytes())
    data[100] ^= 1
    (folder / "p.rprog").write_bytes(data)
    done = riffle("nc", "post", "p.rprog", *POST, *OUT, "--json", cwd=folder)
    assert done.returncode == 2
    assert json.loads(done.stdout)["error"] == "p.rprog, byte 60: the record's checksum does not match"
