"""The verbs of the command line: groups, the names from before there were groups, wrong words, and the help."""

import argparse
import json
import re

import numpy as np
import pytest
import riffler
from commands import result
from riffler import cli
from riffler.command import completion, console, verbs

SLOT = "G21 G90 G94\nG0 X-10 Y10 Z5\nG1 Z4 F500\nX50\nG0 Z20\nM30\n"
STOCK = ("--stock", "40x20x10", "--pitch", "0.5", "--tool", "flat:6:20")
BALL = ("--tool", "ball:6:30")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A program, a recording, two meshes, one of them open, a volume and a plan."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "slot.ngc").write_text(SLOT)
    block = riffler.Volume.block((0, 0, 0), (20, 15, 10), 0.5, "xyz")
    block.save("box.rvol")
    mesh = block.to_mesh()
    mesh.write("box.stl")
    riffler.Mesh(mesh.vertices, mesh.triangles[1:]).write("open.stl")
    step = riffler.Volume.block((0, 0, 0), (20, 15, 10), 0.5, "xyz")
    step -= _corner()
    step.to_mesh().write("step.stl")
    journal = riffler.Journal()
    journal.set_stock((0, 0, 0), (20, 15, 10), 0.5)
    journal.add_tool(3, riffler.Tool.ball(6, 30))
    poses = np.column_stack([np.linspace(0, 20, 9), np.full(9, 7.0), np.full(9, 8.0), *np.tile([[0], [0], [1]], 9)])
    journal.add_stroke(3, poses, times=np.linspace(0, 2, 9))
    journal.save("s.rjournal")
    return tmp_path


def _corner():
    lower, upper = np.array([10.0, 0, 5]), np.array([20.0, 15, 10])
    corners = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)])
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    mesh = riffler.Mesh(lower + corners * (upper - lower), [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    return riffler.Volume.from_mesh(mesh, 0.5, "xyz", lower=(0, 0, 0), upper=(20, 15, 10))


# The names from before there were groups: what is called, the exit status, and the file that it writes.
OLD = {
    "carve": (["--program", "slot.ngc", *STOCK, "--out", "a.stl"], 0, "a.stl"),
    "convert": (["box.stl", "--pitch", "0.5", "--out", "a.rvol"], 0, "a.rvol"),
    "mesh": (["box.rvol", "--out", "a.stl", "--tolerance", "0.01"], 0, "a.stl"),
    "audit": (["open.stl"], 1, None),
    "pencil": (["step.stl", *BALL, "--out", "a.json"], 0, "a.json"),
    "post": (["s.rjournal", "--post", "tcp", "--post-option", "safe_start=false", "--out", "a.ngc"], 0, "a.ngc"),
    "verify": (["slot.ngc", *STOCK], 1, None),
    "replay": (["s.rjournal", "--out", "a.rvol"], 0, "a.rvol"),
    "machines": ([], 0, None),
}


def run(words, capsys, folder, file):
    """Status, stdout, stderr and the written file of a command."""
    status = cli.main([str(word) for word in words])
    out, err = capsys.readouterr()
    data = None
    if file is not None:
        data = (folder / file).read_bytes()
        (folder / file).unlink()
    return status, out, err, data


@pytest.mark.parametrize("more", [[], ["--json"]], ids=["table", "json"])
@pytest.mark.parametrize("old", verbs.OLD)
def test_an_old_name_does_the_same_and_warns_once_on_stderr(folder, capsys, monkeypatch, old, more):
    monkeypatch.setattr(console.time, "perf_counter", lambda: 0.0)
    words, status, file = OLD[old]
    path = verbs.OLD[old].path
    before = run([old, *words, *more], capsys, folder, file)
    after = run([*path.split(), *words, *more], capsys, folder, file)
    assert before[0] == after[0] == status
    assert before[1] == after[1] and len(after[1]) > 20
    assert before[3] == after[3]
    warning = f"riffler: riffler {old} is an old name of riffler {path}\n"
    assert before[2] == warning + after[2] and "old name" not in after[2]


def test_every_name_of_the_first_command_line_still_works():
    first = {"carve", "convert", "mesh", "audit", "pencil", "post", "verify", "replay", "machines"}
    assert first == set(verbs.OLD) == set(OLD)
    alone = {("doctor",), ("bench",), ("pen", "list"), ("pen", "monitor"), ("pen", "calibrate"), ("pen", "simulate")}
    assert alone <= {tuple(verb.path.split()) for verb in verbs.VERBS}


@pytest.mark.parametrize(
    "words",
    [
        ["mesh", "--out", "a.stl", "box.rvol"],
        ["mesh", "--json", "box.rvol", "--out", "a.stl"],
        ["mesh", "--decimate", "0.01", "box.rvol", "--out", "a.stl"],
        ["mesh", "./box.rvol", "--out", "a.stl"],
    ],
)
def test_mesh_is_a_group_and_still_the_old_verb(folder, capsys, words):
    assert cli.main(words) == 0
    assert "riffler volume to-mesh" in capsys.readouterr().err
    assert riffler.Mesh.read("a.stl").audit().open_edges == 0


# Verb, its words, the old name of an option, today's, and values.
OLD_OPTIONS = [
    ("volume to-mesh", ["box.rvol", "--out", "a.stl"], "--decimate", "--tolerance", ["0.01"]),
    ("nc post", ["s.rjournal", "--post", "tcp", "--out", "a.ngc"], "--option", "--post-option",
     ["safe_start=false", "line_numbers=10"]),
]  # fmt: skip


@pytest.mark.parametrize("more", [[], ["--json"]], ids=["table", "json"])
@pytest.mark.parametrize("verb, words, old, new, values", OLD_OPTIONS, ids=lambda x: x if isinstance(x, str) else "")
def test_an_old_option_does_the_same_and_warns_once_on_stderr(
    folder, capsys, monkeypatch, verb, words, old, new, values, more
):
    monkeypatch.setattr(console.time, "perf_counter", lambda: 0.0)
    base, file = [*verb.split(), *words, *more], words[-1]
    without = run(base, capsys, folder, file)
    before = run([*base, *(word for value in values for word in (old, value))], capsys, folder, file)
    mixed = run([*base, f"{old}={values[0]}", *(f"{new}={value}" for value in values[1:])], capsys, folder, file)
    after = run([*base, *(word for value in values for word in (new, value))], capsys, folder, file)
    assert before[0] == mixed[0] == after[0] == 0
    assert before[1] == mixed[1] == after[1]
    assert before[3] == mixed[3] == after[3] != without[3]
    assert before[2] == mixed[2] == f"riffler: riffler {verb} {old} is an old name of {new}\n" + after[2]
    assert "old name" not in after[2]


def test_an_option_is_given_once_by_either_name(folder, capsys):
    for words in (["--decimate", "0.1", "--tolerance", "0.2"], ["--tolerance", "0.1", "--decimate", "0.2"]):
        assert cli.main(["volume", "to-mesh", "box.rvol", "--out", "a.stl", *words]) == 2
        assert "one tolerance expected, not both 0.1 and 0.2" in capsys.readouterr().err
    assert not (folder / "a.stl").exists()


@pytest.mark.parametrize("verb, words, old, new, values", OLD_OPTIONS, ids=lambda x: x if isinstance(x, str) else "")
def test_help_hints_and_completion_have_only_todays_names(capsys, monkeypatch, verb, words, old, new, values):
    text = "\n".join(screen([*verb.split(), "--help"], capsys, monkeypatch))
    assert f"{new} " in text and f"{old} " not in text
    assert cli.main([*verb.split(), *words, old[:-1], values[0]]) == 2
    assert f"no option {old[:-1]}; did you mean {new}?" in capsys.readouterr().err
    (entry,) = (entry for entry in completion.entries() if entry.path == verb)
    flags = {flag for option in entry.options for flag in option.flags}
    assert new in flags and old not in flags


def test_the_old_verb_mesh_still_refuses_files_that_are_no_volumes(folder, capsys):
    assert cli.main(["mesh", "box.stl", "--out", "a.stl"]) == 2
    assert "box.stl: .rvol expected" in capsys.readouterr().err


# ---- the same word for the same thing

SPELLED = {
    "program": [
        (["nc", "verify", "slot.ngc", *STOCK], ["nc", "verify", *STOCK, "--program", "slot.ngc"], None),
        (["volume", "carve", "slot.ngc", *STOCK, "--out", "a.rvol"],
         ["volume", "carve", *STOCK, "--out", "a.rvol", "--program=slot.ngc"], "a.rvol"),
        (["nc", "post", "slot.ngc", "--machine", "tcp", "--post", "tcp", "--out", "a.ngc"],
         ["nc", "post", "--program", "slot.ngc", "--machine", "tcp", "--post", "tcp", "--out", "a.ngc"], "a.ngc"),
    ],
    "journal": [
        (["volume", "replay", "s.rjournal", "--out", "a.rvol"],
         ["volume", "replay", "--out", "a.rvol", "--journal", "s.rjournal"], "a.rvol"),
        (["nc", "post", "s.rjournal", "--post", "tcp", "--out", "a.ngc"],
         ["nc", "post", "--journal", "s.rjournal", "--post", "tcp", "--out", "a.ngc"], "a.ngc"),
    ],
    "part": [
        (["plan", "pencil", "step.stl", *BALL, "--out", "a.json"],
         ["plan", "pencil", *BALL, "--out", "a.json", "--part", "step.stl"], "a.json"),
    ],
    "mesh": [
        (["mesh", "audit", "box.stl"], ["mesh", "audit", "--mesh", "box.stl"], None),
        (["volume", "from-mesh", "box.stl", "--pitch", 1, "--out", "a.rvol"],
         ["volume", "from-mesh", "--pitch", 1, "--mesh", "box.stl", "--out", "a.rvol"], "a.rvol"),
    ],
    "volume": [
        (["volume", "to-mesh", "box.rvol", "--out", "a.stl"],
         ["volume", "to-mesh", "--volume", "box.rvol", "--out", "a.stl"], "a.stl"),
    ],
}  # fmt: skip


@pytest.mark.parametrize("thing", SPELLED)
def test_a_file_stands_alone_or_after_its_name(folder, capsys, monkeypatch, thing):
    monkeypatch.setattr(console.time, "perf_counter", lambda: 0.0)
    for alone, named, file in SPELLED[thing]:
        expected = run(alone, capsys, folder, file)
        assert expected[0] in (0, 1), expected
        assert run(named, capsys, folder, file) == expected


def test_one_thing_has_one_name_in_all_verbs():
    """Every option that takes a program, a stock and so on, by what its help calls its value."""
    flags = {}
    for verb in verbs.VERBS:
        for action in verb.parser()._actions:
            for flag in action.option_strings:
                flags.setdefault(flag, set()).add(verb.path)
    for flag, count in {"--program": 3, "--stock": 2, "--tool": 6, "--machine": 3, "--part": 5, "--out": 14}.items():
        assert len(flags[flag]) >= count, (flag, flags[flag])
    assert all("--json" in verb.parser()._option_string_actions for verb in verbs.VERBS)
    assert not {"--input", "--file", "--output", "--model", "--stl", "--cutter"} & set(flags)


# ---- wrong words

WRONG = {
    "group": (["volum", "carve"], "riffler has no command 'volum'; did you mean riffler volume?"),
    "verb": (["nc", "verfy", "a.ngc"], "riffler nc has no verb 'verfy'; did you mean riffler nc verify?"),
    "verb of a strategy": (["plan", "pensil"], "did you mean riffler plan pencil?"),
    "verb of another group": (
        ["mesh", "carve"],
        "riffler mesh has no verb 'carve'; did you mean riffler volume carve?",
    ),
    "old verb, misspelt": (["convrt", "a.stl"], "did you mean riffler volume from-mesh?"),
    "nothing like it": (["xyzzy"], "riffler has no command 'xyzzy' (see riffler --help)"),
    "no verb": (["pen"], "a verb expected: list, monitor, calibrate, identify, simulate"),
    "nothing": ([], "a command expected: mesh, volume, plan, nc, pen, job, doctor, bench, completion"),
    "option": (["nc", "verify", "slot.ngc", "--stok", "9x9x9"], "no option --stok; did you mean --stock?"),
    "option with =": (["mesh", "audit", "box.stl", "--jsn=1"], "no option --jsn; did you mean --json?"),
    "abbreviated": (["volume", "from-mesh", "box.stl", "--pit", "1"], "no option --pit; did you mean --pitch?"),
    "nothing like the option": (["mesh", "audit", "box.stl", "--quux"], "no option --quux (see riffler mesh audit"),
    "short option": (["mesh", "audit", "box.stl", "-q"], "no option -q"),
    "option before the verb": (["--quick"], "--quick: the command comes first"),
    "two files": (["mesh", "audit", "box.stl", "open.stl"], "'open.stl' is one word too many"),
    "two programs": (["nc", "verify", "a.ngc", "--program", "b.ngc", *STOCK], "one program expected, not both b.ngc"),
    "no file": (["mesh", "audit"], "MESH is missing: a file, alone or after --mesh"),
    "no option's value": (["volume", "to-mesh", "box.rvol", "--out"], "--out"),
    "choice": (
        ["volume", "from-mesh", "box.stl", "--directions", "xy", "--out", "a.rvol"],
        "--directions xy: z or xyz expected; did you mean xyz?",
    ),
    "shell": (["completion", "tcsh"], "SHELL tcsh: bash or zsh or fish expected"),
    "machine": (["nc", "verify", "slot.ngc", *STOCK, "--machine", "3-axes"], "did you mean 3-axis?"),
    "post": (
        ["nc", "post", "s.rjournal", "--post", "linuxcnc_xyzac", "--out", "a.ngc"],
        "did you mean linuxcnc-xyzac?",
    ),
    "tool": (["plan", "pencil", "step.stl", "--tool", "bal:6", "--out", "a.json"], "did you mean ball?"),
    "device": (["pen", "monitor", "simulate"], "did you mean simulated?"),
    "decimate how far": (["mesh", "decimate", "box.stl", "--out", "a.stl"], "--tolerance or --triangles expected"),
}


@pytest.mark.parametrize("case", WRONG)
def test_a_wrong_word_is_answered_with_the_nearest_right_one(folder, capsys, case):
    words, message = WRONG[case]
    before = sorted(path.name for path in folder.iterdir())
    assert cli.main(list(words)) == 2
    out, err = capsys.readouterr()
    assert out == "" and message in err and err.count("\n") == 1, err
    assert cli.main([*words, "--json"]) == 2
    out, err = capsys.readouterr()
    assert err == "" and json.loads(out)["error"]
    assert sorted(path.name for path in folder.iterdir()) == before


# ---- help


def screen(words, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "100")
    try:
        assert cli.main(words) == 0
    except SystemExit as stop:  # how argparse ends after --help
        assert stop.code == 0
    out, err = capsys.readouterr()
    assert err == ""
    return out.splitlines()


@pytest.mark.parametrize("words", [["--help"], ["help"], *([group, "--help"] for group in verbs.GROUPS)], ids=" ".join)
def test_an_overview_fits_a_small_terminal(capsys, monkeypatch, words):
    lines = screen(words, capsys, monkeypatch)
    assert len(lines) <= 24 and max(map(len, lines)) <= 80
    names = [verb.name for verb in verbs.VERBS] if words[0] in ("help", "--help") else verbs.of(words[0])
    assert all(re.search(rf"\b{name}\b", "\n".join(lines)) for name in names)


@pytest.mark.parametrize("verb", verbs.VERBS, ids=lambda verb: verb.path)
def test_the_help_of_a_verb_fits_a_screen(capsys, monkeypatch, verb):
    lines = screen([*verb.path.split(), "--help"], capsys, monkeypatch)
    assert len(lines) <= 50 and max(map(len, lines)) <= 120
    usage, text = lines[0], "\n".join(lines)
    assert usage.startswith(f"usage: riffler {verb.path}")
    assert f"riffler {verb.path}" in "\n".join(lines[1:]), "no example"
    assert all(flag in text for a in verb.parser()._actions if a.help != argparse.SUPPRESS for flag in a.option_strings)
    assert screen(["help", *verb.path.split()], capsys, monkeypatch) == lines


# ---- the verbs that are new with the groups


def test_a_mesh_changes_its_format_and_unit(folder):
    data = result("mesh", "convert", "box.stl", "--out", "box.ply", cwd=folder)
    box = riffler.Mesh.read("box.ply")
    assert data["triangles"] == len(box.triangles) and data["upper"] == [20, 15, 10]
    assert box.volume == pytest.approx(20 * 15 * 10, rel=1e-5)
    data = result("mesh", "convert", "box.ply", "--unit", "inch", "--out", "inch.stl", cwd=folder)
    assert data["upper"] == pytest.approx([508, 381, 254])
    assert riffler.Mesh.read("inch.stl").volume == pytest.approx(3000 * 25.4**3, rel=1e-5)


def test_decimation_stays_within_its_tolerance(folder):
    ball = riffler.Volume.sphere((0, 0, 0), 10, 0.5, "xyz").to_mesh()
    ball.write("ball.stl")
    data = result("mesh", "decimate", "ball.stl", "--tolerance", 0.05, "--out", "small.stl", cwd=folder)
    small = riffler.Mesh.read("small.stl")
    assert data["triangles"] == len(small.triangles) < len(ball.triangles) / 3 == data["triangles_before"] / 3
    assert 0.005 < data["deviation"] <= 0.05
    assert np.abs(np.linalg.norm(small.vertices, axis=1) - 10).max() < 0.05 + 0.1
    few = result("mesh", "decimate", "ball.stl", "--triangles", 200, "--out", "few.stl", cwd=folder)
    assert few["triangles"] <= 200


def test_tools_are_listed_in_the_form_that_the_option_accepts(folder):
    listed = result("nc", "tools", cwd=folder)["tools"]
    assert listed["fillet"]["form"] == "fillet:diameter:corner_radius[:length]"
    assert {"ball", "flat", "fillet", "taper", "cone-end"} <= set(listed)
    assert [size["unit"] for size in listed["taper"]["sizes"]].count("rad") == 1
