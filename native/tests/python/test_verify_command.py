"""``riffler nc verify`` as a shell sees it."""

import json
import struct

import numpy as np
import pytest
import riffler
from riffler.cli import main
from verify_reference import box_mesh

CODE = """G21 G90 G94
T1 M6
M3 S8000
G0 X-10 Y10 Z25
G1 Z17 F500
X50
G0 X50 Y15 Z{height}
X20
G0 Z40
M30
"""
WORDS = ["--stock", "40x30x20", "--pitch", "0.5", "--tool", "ball:6:30", "--holder", "30:20:60:20"]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, height in (("bad", 17), ("good", 20.5)):
        (tmp_path / f"{name}.ngc").write_text(CODE.format(height=height))
    box_mesh([0, 0, 0], [40, 30, 17]).write("part.stl")
    box_mesh([30, 6, 0], [38, 14, 18]).write("clamp.stl")
    return tmp_path


def run(capsys, *words):
    status = main(["nc", "verify", *words, "--json"])
    return status, json.loads(capsys.readouterr().out)


def test_a_good_program_passes_and_a_bad_one_names_the_block(folder, capsys):
    status, data = run(capsys, "good.ngc", *WORDS)
    assert status == 0 and data["passed"] and data["findings"] == []
    status, data = run(capsys, "bad.ngc", *WORDS)
    (found,) = data["findings"]
    assert status == 1 and (found["kind"], found["line"], found["block"]) == ("rapid", 8, "X20")
    assert main(["nc", "verify", "bad.ngc", *WORDS]) == 1
    said = capsys.readouterr().out
    assert "NOT passed" in said and "retract higher" in said and "fixtures: none were given" in said


def test_skipped_words_are_reported_and_skipped_coordinates_never_pass(folder, capsys):
    good = (folder / "good.ngc").read_text()
    skip = ["--machine", "3-axis", "--machine-option", "unknown=skip"]
    (folder / "odd.ngc").write_text(good.replace("G0 Z40", "G187 P1\nG0 Z40\nG60 X9"))
    status = main(["nc", "verify", "odd.ngc", *WORDS, *skip])
    said = capsys.readouterr()
    assert status == 1 and "odd.ngc, line 11: G60 was skipped, with its axis words" in said.err
    assert "line 9: G187" in said.err and "NOT passed" in said.out and "G60" in said.out
    status, data = run(capsys, "odd.ngc", *WORDS, *skip)
    assert status == 1 and data["findings"] == [] and not data["passed"]
    assert "line 9: G187" in data["not_checked"]
    # Without coordinates nothing is uncertain; every option of reading may be given along with a machine's own.
    (folder / "fine.ngc").write_text(good.replace("G0 Z40", "G187 P1\nG0 Z40\nM30\nM30"))
    more = ["--machine-option", "block_delete=true", "--machine-option", "chord_tolerance=0.01"]
    status, data = run(capsys, "fine.ngc", *WORDS, *skip, *more)
    assert status == 0 and data["passed"]
    out = ["--out", "left.rvol", "--program", "odd.ngc", *WORDS[:6]]
    assert main(["volume", "carve", *out, *skip]) == 0
    assert "line 11: G60 was skipped" in capsys.readouterr().err
    assert main(["nc", "post", "odd.ngc", *skip, "--post", "3-axis", "--out", "again.ngc"]) == 0
    assert "line 11: G60 was skipped" in capsys.readouterr().err


def test_positions_of_the_machine_are_neither_cut_nor_compared(folder, capsys):
    """Zero on the table: what G28, G30 and G53 say would be inside of the stock as coordinates of the part."""
    cut = "G0 X10 Y10\nG43 Z25 H1\nG1 Z19 F300\nX30\nG0 Z25\n"
    frames = {
        "fusion": f"G90 G94 G17\nG21\nG28 G91 Z0.\nG90\nT1 M6\nS5000 M3\nG54\n{cut}M5\nG28 G91 Z0.\nG28 X0. Y0.\nM30\n",
        "haas": f"G21 G90\nT1 M6\nG0 G53 Z0\nG0 G54 G90\nS5000 M3\n{cut}G53 G0 Z0 M9\nG53 G0 X-10 Y0\nM30\n",
        "home": f"G21 G90\nT1 M6\nS5000 M3\n{cut}G30\nX15 Y15\nG43 Z25 H1\nG1 Z19\nG0 Z25\nM30\n",
    }
    words = ["--stock", "40x20x20", "--origin", "0,0,0", "--pitch", "0.5", "--tool", "flat:4", "--machine", "3-axis"]
    removed = {}
    for name, text in frames.items():
        (folder / f"{name}.ngc").write_text(text)
        status, data = run(capsys, f"{name}.ngc", *words)
        assert status == 0 and data["findings"] == [], name
        assert sum("a machine position" in sentence for sentence in data["not_checked"]) == 1, name
        program = riffler.Program.read(f"{name}.ngc", machine="3-axis")
        assert program.at_machine.any() and program.poses[~program.at_machine, 2].min() == 19
        # Carving with the program takes what verification takes; posted again it does, too, and never comes lower.
        carved = ["volume", "carve", *words, "--program", f"{name}.ngc", "--out", "left.rvol", "--json"]
        assert main(carved) == 0
        said = capsys.readouterr()
        data = json.loads(said.out)
        assert data["moves_at_machine"] > 0 and "a machine position" in said.err
        removed[name] = data["removed"]
        assert main(["nc", "post", f"{name}.ngc", "--machine", "3-axis", "--post", "3-axis", "--out", "again.ngc"]) == 0
        capsys.readouterr()
        again = riffler.Program.read("again.ngc", machine="3-axis")
        assert again.poses[~again.at_machine, 2].min() == 19
        status, data = run(capsys, "again.ngc", *words)
        assert status == 0 and data["findings"] == []
    assert removed["fusion"] == removed["haas"] < removed["home"]
    # A program whose offsets differ by an unknown distance does not pass; where the option says it, it does.
    two = f"G21 G90\nT1 M6\nS5000 M3\n{cut}G55\nX5 Y5\nG43 Z25 H1\nG1 Z19\nG0 Z25\nM30\n"
    (folder / "two.ngc").write_text(two)
    status, data = run(capsys, "two.ngc", *words)
    assert status == 1 and not data["findings"] and any("G55" in sentence for sentence in data["not_checked"])
    given = ["--machine-option", "g54=0,0,0", "--machine-option", "g55=2,0,0"]
    status, data = run(capsys, "two.ngc", *words, *given)
    assert status == 0 and not any("G55" in sentence for sentence in data["not_checked"])


def test_parts_fixtures_and_holders_are_checked(folder, capsys):
    status, data = run(capsys, "good.ngc", *WORDS, "--part", "part.stl", "--fixture", "clamp.stl")
    assert status == 1 and [f["kind"] for f in data["findings"]] == ["fixture"] and data["findings"][0]["line"] == 6
    status, data = run(capsys, "good.ngc", *WORDS, "--part", "part.stl", "--rest", "0.2")
    assert status == 1 and [f["kind"] for f in data["findings"]] == ["rest"]
    low = [*WORDS[:-1], "1=2.5:20:60:20", "--shank", "1=2:2:2.5:2"]
    status, data = run(capsys, "good.ngc", *low)
    assert "holder" in {f["kind"] for f in data["findings"]}
    assert data["tools"]["1"]["holder"] == [[2.5, 20, 60, 20]]


def test_the_remaining_material_and_its_map_are_written(folder, capsys):
    status, data = run(capsys, "good.ngc", *WORDS, "--part", "part.stl", "--out", "left.rvol", "--map", "map.ply")
    left = riffler.Volume.load("left.rvol")
    assert status == 0 and left.volume == pytest.approx(data["volume"])
    mesh = riffler.Mesh.read("map.ply")
    assert mesh.audit().open_edges == 0
    raw = (folder / "map.ply").read_bytes()
    header, body = raw.split(b"end_header\n", 1)
    assert b"red is gouged" in header
    rows = [struct.unpack_from("<3f3Bf", body, 19 * k) for k in range(len(mesh.vertices))]
    blue = [r for r in rows if r[6] > 0.5]
    assert blue and all(r[3:6] == (33, 102, 172) for r in blue)
    assert np.max([abs(r[6]) for r in rows if abs(r[2]) < 1e-3]) < 0.3  # the stock's lower face is the part's


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--part", "nope.stl"], "nope.stl"),
        (["--holder", "1:2:3"], "Z0:R0:Z1:R1"),
        (["--holder", "9=1:2:3:4"], "does not call tool 9"),
        (["--holder", "x=1:2:3:4"], "tool number"),
        (["--holder", "30:20:20:20"], "z0 must be less"),
        (["--map", "m.ply"], "--map needs --part"),
        (["--rest", "0.1"], "--rest needs --part"),
        (["--gouge", "0"], "--gouge must be positive"),
        (["--out", "left.txt"], "left.txt"),
        (["--fixture", "bad.ngc"], "bad.ngc"),
        (["--machine", "mill"], "mill"),
    ],
)
def test_bad_input_is_one_line_and_writes_nothing(folder, capsys, words, message):
    before = sorted(p.name for p in folder.iterdir())
    status, data = run(capsys, "good.ngc", *WORDS, *words)
    assert status == 2 and message in data["error"] and sorted(p.name for p in folder.iterdir()) == before
