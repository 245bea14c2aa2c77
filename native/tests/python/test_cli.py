"""The command line as a shell sees it: exit status, what is on stdout and stderr, and which files are left."""

import errno
import json
import os
import pty
import signal
import struct
import subprocess
import sys
import time
from functools import partial
from pathlib import Path

import numpy as np
import pytest
import riffler
from commands import ENVIRONMENT, RIFFLER, in_shell, result, riffle
from riffler.command import console, tools

SLOT = "G21 G90 G94\nG0 X-10 Y10 Z5\nG1 Z4 F500\nX50\nG0 Z20\nM30\n"


def box_triangles(lower, upper) -> tuple[np.ndarray, np.ndarray]:
    corners = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=float)
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return np.asarray(lower) + corners * (np.asarray(upper) - np.asarray(lower)), np.array(triangles)


def stl_bytes(vertices: np.ndarray, triangles: np.ndarray) -> bytes:
    """A binary STL, written here so that the reader is not tested against its own writer."""
    data = b"\0" * 80 + struct.pack("<I", len(triangles))
    for corners in vertices[triangles]:
        data += struct.pack("<12fH", 0, 0, 0, *corners.ravel(), 0)
    return data


def stl_volume(data: bytes) -> float:
    (count,) = struct.unpack_from("<I", data, 80)
    assert len(data) == 84 + 50 * count
    rows = np.frombuffer(data, dtype=np.dtype([("normal", "<3f4"), ("corner", "<9f4"), ("x", "<u2")]), offset=84)
    a, b, c = rows["corner"].reshape(-1, 3, 3).astype(float).transpose(1, 0, 2)
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "slot.ngc").write_text(SLOT)
    (tmp_path / "box.stl").write_bytes(stl_bytes(*box_triangles((0, 0, 0), (20, 15, 10))))
    return tmp_path


CARVE = ("volume", "carve", "--stock", "40x20x10", "--pitch", "0.5", "--program", "slot.ngc")


# ---- each command


def test_carve_writes_a_closed_mesh_of_the_remaining_material(folder):
    data = result(*CARVE, "--tool", "flat:6", "--out", "part.stl", cwd=folder, run=in_shell)
    # A flat cutter, 6 wide, 6 deep, through the whole length of 40.
    assert data["removed"] == pytest.approx(6 * 6 * 40, abs=1e-6)
    assert data["volume_before"] == pytest.approx(40 * 20 * 10)
    assert data["volume"] == pytest.approx(40 * 20 * 10 - 6 * 6 * 40)
    assert data["removed_by_rapids"] == 0
    assert (data["moves"], data["directions"], data["pitch"]) == (3, "xyz", 0.5)
    assert data["rays"] == 40 * 20 * 4 + 80 * 20 + 40 * 20
    assert set(data["seconds"]) == {"program", "stock", "carve", "mesh", "write"}
    written = (folder / "part.stl").read_bytes()
    assert data["bytes"] == len(written) == 84 + 50 * data["triangles"]
    assert stl_volume(written) == pytest.approx(data["volume"], rel=1e-3)
    audit = result("mesh", "audit", "part.stl", cwd=folder)
    assert audit["closed"] and audit["triangles"] == data["triangles"]


@pytest.mark.parametrize("name", ["part.obj", "part.ply", "part.rvol", "part.STL"])
def test_carve_writes_every_file_format(folder, name):
    data = result(*CARVE, "--tool", "ball:6", "--out", name, cwd=folder)
    assert (folder / name).stat().st_size == data["bytes"]
    assert (data["triangles"] is None) == (name == "part.rvol")
    if name == "part.rvol":
        assert riffler.Volume.load(folder / name).volume == data["volume"]


def test_carve_agrees_with_the_library(folder):
    result(*CARVE, "--tool", "fillet:8:2:30", "--directions", "z", "--out", "part.rvol", cwd=folder)
    volume = riffler.Volume.block((0, 0, 0), (40, 20, 10), 0.5, "z")
    tips = np.array([[-10, 10, 5], [-10, 10, 4], [50, 10, 4], [50, 10, 20]])
    volume.carve(riffler.Tool.fillet(8, 2, 30), np.hstack([tips, np.tile([0, 0, 1], (4, 1))]))
    loaded = riffler.Volume.load(folder / "part.rvol")
    for ours, theirs in zip(loaded.intervals("z"), volume.intervals("z"), strict=True):
        np.testing.assert_array_equal(ours, theirs)


def test_carve_starts_from_files(folder):
    first = result("volume", "carve", "--stock", "box.stl", "--pitch", 0.5, "--tool", "flat:4", "--program", "slot.ngc",
                   "--out", "a.rvol", cwd=folder)  # fmt: skip
    assert first["removed"] == pytest.approx(20 * 4 * 6)
    again = result(
        "volume", "carve", "--stock", "a.rvol", "--tool", "flat:6", "--program", "slot.ngc", "--out", "b.stl",
        cwd=folder,
    )  # fmt: skip
    assert again["removed"] == pytest.approx(20 * 2 * 6)
    carve = ("volume", "carve", "--stock", "a.rvol", "--tool", "flat:6", "--program", "slot.ngc", "--out", "c.stl")
    for option in (("--pitch", "0.4"), ("--directions", "z"), ("--origin", "0,0,0")):
        done = riffle(*carve, *option, cwd=folder)
        assert done.returncode == 2 and "a.rvol" in done.stderr


@pytest.mark.parametrize(
    ("stock", "volume", "upper"),
    [("sphere:20", 4 / 3 * np.pi * 1000, (20, 20, 20)), ("cylinder:20:15", np.pi * 1500, (20, 20, 15))],
)
def test_stock_may_be_round(folder, stock, volume, upper):
    data = result("volume", "carve", "--stock", stock, "--pitch", 0.2, "--origin", "5.1,1,2", "--tool", "ball:1",
                  "--program", "slot.ngc", "--out", "a.rvol", cwd=folder)  # fmt: skip
    assert data["volume_before"] == pytest.approx(volume, rel=3e-3)
    left = riffler.Volume.load(folder / "a.rvol")
    assert left.lower.tolist() == [5.1, 1, 2] and np.allclose(left.upper - left.lower, upper, atol=1e-12)


@pytest.mark.parametrize(
    ("origin", "lower"),
    [
        ("-5,-1,0", (-5, -1, 0)),
        ("top-centre", (-20, -10, -10)),
        ("bottom-centre", (-20, -10, 0)),
        ("corner", (0, 0, 0)),
    ],
)
def test_a_block_stands_at_its_origin(folder, origin, lower):
    result(*CARVE, "--tool", "ball:1", "--origin", origin, "--out", "a.rvol", cwd=folder)
    assert riffler.Volume.load(folder / "a.rvol").lower.tolist() == list(lower)


def test_a_tool_without_a_length_reaches_out_of_the_stock(folder):
    # 1 mm wide, 100 deep: a cutter of five diameters would leave a roof.
    (folder / "deep.ngc").write_text("G21 G90\nG0 X5 Y5 Z120\nG1 Z0 F100\nM2\n")
    data = result("volume", "carve", "--stock", "10x10x100", "--pitch", 0.1, "--directions", "z", "--tool", "flat:1",
                  "--program", "deep.ngc", "--out", "a.rvol", cwd=folder)  # fmt: skip
    assert data["removed"] == pytest.approx(np.pi / 4 * 100, rel=0.05)
    (counts, spans) = riffler.Volume.load(folder / "a.rvol").intervals("z")
    assert counts.min() == 0 and set(spans.ravel()) == {0, 100}


def test_tools_are_given_by_number_and_from_files(folder):
    (folder / "two.ngc").write_text(
        "G21 G90 G94\nG0 Z20\nT3 M6\nG0 X-10 Y5 Z5\nG1 X50 F500\nG0 Z20\nT12 M6\nG0 X-10 Y15\nZ5\nG1 X50\nG0 Z20\nM2\n"
    )
    carve = ("volume", "carve", "--stock", "40x20x10", "--pitch", 0.5, "--program", "two.ngc", "--out", "a.rvol")
    (folder / "t.json").write_text(json.dumps(riffler.Tool.flat(4, 40).named("roughing").to_dict()))
    (folder / "t.toml").write_text('kind = "flat"\ndiameter = 2\nlength = 40.0\nname = "finishing"\n')
    data = result(*carve, "--tool", "3=t.json", "--tool", "12=t.toml", cwd=folder)
    assert data["removed"] == pytest.approx(40 * 5 * (4 + 2))
    assert [t["name"] for t in data["tools"].values()] == ["roughing", "finishing"]
    assert data["moves_without_tool"] == 0
    for some, what in [
        (("t.json",), "changes between tools 3, 12"),
        (("3=t.json",), "calls tool 12"),
        (("3=t.json", "t.toml"), "every tool its number"),
        (("3=t.json", "3=t.toml"), "two tools for number 3"),
    ]:
        done = riffle(*carve, *[w for t in some for w in ("--tool", t)], cwd=folder)
        assert done.returncode == 2 and what in done.stderr


def test_a_mesh_becomes_a_volume_and_a_mesh_again(folder):
    data = result("volume", "from-mesh", "box.stl", "--pitch", 0.5, "--out", "box.rvol", cwd=folder)
    assert data["volume"] == pytest.approx(20 * 15 * 10)
    assert (data["lower"], data["upper"]) == ([0, 0, 0], [20, 15, 10])
    data = result("volume", "to-mesh", "box.rvol", "--out", "again.stl", cwd=folder)
    assert stl_volume((folder / "again.stl").read_bytes()) == pytest.approx(20 * 15 * 10, rel=1e-5)
    few = result("volume", "to-mesh", "box.rvol", "--out", "few.stl", "--tolerance", 0.01, cwd=folder)
    assert few["triangles_before_decimation"] == few["all_triangles"] == data["all_triangles"]
    assert few["triangles"] == 12 < data["triangles"] < data["all_triangles"] / 10
    assert result("mesh", "audit", "few.stl", cwd=folder)["closed"]


def test_detail_is_a_tenth_of_the_pitch_a_length_or_all(folder):
    carve = [*CARVE, "--tool", "ball:6"]
    full = result(*carve, "--detail", "all", "--out", "full.stl", cwd=folder)
    assert full["mesh_tolerance"] is None and full["all_triangles"] == full["triangles"]
    mesh = riffler.Mesh.read(folder / "full.stl")
    meshed = [full["triangles"]]
    for detail, tolerance in ([], 0.05), (["--detail", 0.002], 0.002):
        data = result(*carve, *detail, "--out", "part.stl", cwd=folder)
        assert data["mesh_tolerance"] == tolerance and data["all_triangles"] == full["triangles"]
        part = riffler.Mesh.read(folder / "part.stl")
        assert len(part.triangles) == data["triangles"]
        assert np.abs(part.deviation(mesh)).max() <= 1e-5 and np.abs(mesh.deviation(part)).max() <= tolerance + 1e-5
        meshed.insert(0, data["triangles"])
    assert meshed[0] > meshed[1], "the smaller tolerance needs more"
    assert max(meshed[:2]) < meshed[2] / 3
    shown = riffle(*carve, "--out", "part.stl", cwd=folder).stdout
    assert "within 0.05 mm (--detail all for all)" in shown


@pytest.mark.parametrize("detail", ["0", "-1", "nan", "fine"])
def test_bad_detail_names_the_option_for_all_triangles(folder, detail):
    done = riffle(*CARVE, "--tool", "ball:6", "--out", "none.stl", "--detail", detail, cwd=folder)
    assert done.returncode == 2 and "--detail" in done.stderr and "--detail all writes all triangles" in done.stderr
    assert not (folder / "none.stl").exists()
    done = riffle("volume", "to-mesh", "a.rvol", "--out", "a.stl", "--detail", "1", "--tolerance", "1", cwd=folder)
    assert done.returncode == 2 and "not both" in done.stderr


def test_convert_reports_the_defects_of_the_mesh(folder):
    done = riffle("volume", "from-mesh", "box.stl", "--pitch", 0.5, "--out", "box.rvol", cwd=folder)
    assert not any(word in done.stdout for word in ("open", "inside out", "overlap", "edges", "triangles"))
    vertices, triangles = box_triangles((0, 0, 0), (10, 10, 10))
    (folder / "open.stl").write_bytes(stl_bytes(vertices, triangles[1:]))
    data = result("volume", "from-mesh", "open.stl", "--pitch", 0.5, "--out", "open.rvol", cwd=folder)
    assert (data["mesh"]["open_edges"], data["mesh"]["openings"], data["mesh"]["overlap"]) == (3, 1, 0)
    done = riffle("volume", "from-mesh", "open.stl", "--pitch", 0.5, "--out", "open.rvol", cwd=folder)
    assert "1 opening, 3 open edges" in done.stdout and "inside out" not in done.stdout
    (folder / "bad.stl").write_bytes(stl_bytes(vertices, [t[::-1] for t in triangles] * 2))
    done = riffle("volume", "from-mesh", "bad.stl", "--pitch", 0.5, "--out", "bad.rvol", cwd=folder)
    for line in ("1 shell is inside out", "100 % of the volume is enclosed more than once", "12 doubled triangles"):
        assert line in " ".join(done.stdout.split()), done.stdout


def test_audit_fails_a_mesh_that_is_not_closed(folder):
    vertices, triangles = box_triangles((0, 0, 0), (1, 1, 1))
    (folder / "open.stl").write_bytes(stl_bytes(vertices, triangles[1:]))
    data = result("mesh", "audit", "open.stl", cwd=folder, status=1)
    assert not data["closed"] and data["open_edges"] == 3
    done = riffle("mesh", "audit", "open.stl", cwd=folder)
    assert done.returncode == 1 and "not a closed 2-manifold" in done.stdout and done.stderr == ""
    done = riffle("mesh", "audit", "box.stl", cwd=folder)
    assert done.returncode == 0 and "a closed 2-manifold" in done.stdout


def test_doctor_describes_the_machine(folder):
    data = result("doctor", cwd=folder)
    assert data["riffler"] == riffler.__version__
    assert data["numpy"] == np.__version__
    assert data["python"] == ".".join(map(str, sys.version_info[:3]))
    assert data["threads"] >= 1 and data["memory"]["available"] > 0
    assert isinstance(data["devices"], list)
    granted = data["real_time"]
    assert granted["text"].startswith("real time" if granted["level"] else "normal")
    assert granted["level"] or "limits.d" in granted["remedy"]
    off = json.loads(in_shell("doctor", "--json", cwd=folder, RIFFLER_REAL_TIME="0").stdout)["real_time"]
    assert off == {"level": 0, "by": None, "text": "normal: RIFFLER_REAL_TIME is 0", "remedy": ""}
    done = in_shell("doctor", cwd=folder, RIFFLER_THREADS="3")
    assert done.returncode == 0 and done.stderr == ""
    assert any(line.split() == ["threads", "3"] for line in done.stdout.splitlines())


def test_tables_are_for_people_and_bars_for_terminals(folder):
    done = riffle(*CARVE, "--tool", "flat:6", "--out", "part.stl", cwd=folder)
    assert done.returncode == 0 and done.stderr == ""
    for word in ("rays", "moves", "removed", "triangles", "times", "part.stl"):
        assert word in done.stdout
    assert "\x1b" not in done.stdout
    seen = seen_on_a_terminal(folder, "xterm")
    assert b"carve" in seen and b"mesh" in seen
    assert seen_on_a_terminal(folder, "dumb") == b""


def seen_on_a_terminal(folder: Path, kind: str) -> bytes:
    """What a carve shows on a terminal of that kind."""
    ours, theirs = pty.openpty()
    command = [*RIFFLER, *CARVE, "--tool", "flat:6", "--out", "part.stl", "--json"]
    with subprocess.Popen(
        command, cwd=folder, env=ENVIRONMENT | {"TERM": kind}, stdout=subprocess.PIPE, stderr=theirs, text=True
    ) as running:
        stdout = running.communicate(timeout=60)[0]
    os.close(theirs)
    seen = b""
    try:
        while chunk := os.read(ours, 65536):
            seen += chunk
    except OSError as error:
        assert error.errno == errno.EIO  # how a pseudo-terminal says that the other side is closed
    os.close(ours)
    assert json.loads(stdout)["moves"] == 3
    return seen


# ---- bad input

NAN = struct.pack("<f", np.nan)
GOOD = stl_bytes(*box_triangles((0, 0, 0), (20, 15, 10)))
FILES = {
    "short.stl": GOOD[:300],
    "nan.stl": GOOD[:96] + NAN + GOOD[100:],
    "none.stl": GOOD[:80] + b"\0\0\0\0",
    "flat.stl": stl_bytes(np.array([[0, 0, 0], [9, 0, 0], [0, 9, 0.0]]), np.array([[0, 1, 2]])),
    "text.rvol": b"not a volume",
    "word.ngc": b"G21 G90\nG0 X0\nG1 X10 Q7 W3 F100\nM2\n",
    "feed.ngc": b"G21 G90\nG0 X0\nG1 X10\nM2\n",
    "nan.ngc": b"G21 G90\nG0 Xnan\nM2\n",
    "empty.ngc": b"",
    "bad.json": b"{",
    "list.json": b"[1]",
    "sizes.json": b'{"kind": "ball", "diameter": -3, "length": 10}',
    "bad.toml": b"kind = ",
}
BAD = {
    # name: (words, what the message must say)
    "no command": ([], "command"),
    "unknown command": (["sculpt"], "sculpt"),
    "unknown option": (["mesh", "audit", "box.stl", "--fast"], "--fast"),
    "missing option": (["volume", "from-mesh", "box.stl", "--out", "a.rvol"], "--pitch"),
    "audit: missing": (["mesh", "audit", "nowhere.stl"], "nowhere.stl: No such file"),
    "audit: truncated": (["mesh", "audit", "short.stl"], "short.stl, byte "),
    "audit: NaN": (["mesh", "audit", "nan.stl"], "nan.stl, byte "),
    "audit: no triangles": (["mesh", "audit", "none.stl"], "none.stl"),
    "audit: another kind of file": (["mesh", "audit", "slot.ngc"], "slot.ngc: .stl"),
    "convert: truncated": (["volume", "from-mesh", "short.stl", "--pitch", 1, "--out", "a.rvol"], "short.stl, byte "),
    "convert: NaN": (["volume", "from-mesh", "nan.stl", "--pitch", 1, "--out", "a.rvol"], "nan.stl, byte "),
    "convert: flat": (["volume", "from-mesh", "flat.stl", "--pitch", 1, "--out", "a.rvol"], "flat.stl"),
    "convert: pitch 0": (["volume", "from-mesh", "box.stl", "--pitch", 0, "--out", "a.rvol"], "--pitch"),
    "convert: pitch -1": (["volume", "from-mesh", "box.stl", "--pitch=-1", "--out", "a.rvol"], "--pitch"),
    "convert: pitch NaN": (["volume", "from-mesh", "box.stl", "--pitch", "nan", "--out", "a.rvol"], "--pitch"),
    "convert: pitch far too fine": (["volume", "from-mesh", "box.stl", "--pitch", 1e-7, "--out", "a.rvol"], "pitch"),
    "convert: pitch longer than the part": (
        ["volume", "from-mesh", "box.stl", "--pitch", 1000, "--out", "a.rvol"],
        "pitch 1000 mm is longer than every side of the box",
    ),
    "convert: out of another kind": (["volume", "from-mesh", "box.stl", "--pitch", 1, "--out", "a.stl"], "--out a.stl"),
    "convert: out nowhere": (["volume", "from-mesh", "box.stl", "--pitch", 1, "--out", "no/a.rvol"], "no folder"),
    "mesh: not a volume": (["volume", "to-mesh", "text.rvol", "--out", "a.stl"], "text.rvol, byte 0"),
    "mesh: missing": (["volume", "to-mesh", "nowhere.rvol", "--out", "a.stl"], "nowhere.rvol: No such file"),
    "mesh: tolerance": (["volume", "to-mesh", "text.rvol", "--out", "a.stl", "--tolerance", "-2"], "--tolerance"),
}
TOOL = ("--tool", "ball:6")
BAD_CARVES = {
    "unknown word": ({"--program": "word.ngc"}, "word.ngc, line 3"),
    "no feed": ({"--program": "feed.ngc"}, "feed.ngc, line 3"),
    "NaN": ({"--program": "nan.ngc"}, "nan.ngc, line 2"),
    "no moves": ({"--program": "empty.ngc"}, "empty.ngc"),
    "no program": ({"--program": "nowhere.ngc"}, "nowhere.ngc"),
    "machine": ({"--machine": "lathe"}, "lathe"),
    "pitch 0": ({"--pitch": "0"}, "--pitch"),
    "pitch far too fine": ({"--pitch": "1e-6"}, "pitch"),
    "pitch longer than the stock": ({"--pitch": "1000"}, "pitch 1000 mm is longer than every side of the box, 40 × 20"),
    "pitch, no number": ({"--pitch": "fine"}, "--pitch"),
    "pitch, infinite": ({"--pitch": "inf"}, "--pitch"),
    "tolerance": ({"--tolerance": "0"}, "--tolerance"),
    "zero tool": ({"--tool": "ball:0"}, "--tool ball:0"),
    "negative tool": ({"--tool": "flat:-3"}, "--tool flat:-3"),
    "NaN tool": ({"--tool": "ball:nan"}, "--tool ball:nan"),
    "tool of no size": ({"--tool": "ball"}, "--tool ball"),
    "tool of unknown kind": ({"--tool": "drill:5"}, "--tool drill:5"),
    "corner too large": ({"--tool": "fillet:6:4"}, "--tool fillet:6:4"),
    "length 0": ({"--tool": "ball:6:0"}, "--tool ball:6:0"),
    "tool number": ({"--tool": "x=ball:6"}, "--tool x=ball:6"),
    "tool file: JSON": ({"--tool": "bad.json"}, "bad.json"),
    "tool file: list": ({"--tool": "list.json"}, "list.json"),
    "tool file: sizes": ({"--tool": "sizes.json"}, "diameter"),
    "tool file: TOML": ({"--tool": "bad.toml"}, "bad.toml"),
    "tool file: none": ({"--tool": "none.json"}, "none.json"),
    "stock: two sizes": ({"--stock": "10x20"}, "--stock 10x20"),
    "stock: zero": ({"--stock": "10x20x0"}, "--stock 10x20x0"),
    "stock: negative": ({"--stock": "10x20x-5"}, "--stock 10x20x-5: size must be positive, not -5"),
    "stock: negative at first": ({"--stock": "-5x20x10"}, "--stock -5x20x10: size must be positive, not -5"),
    "stock: far too large": ({"--stock": "2e9x20x10", "--pitch": "1e6"}, "give its size in millimetres"),
    "stock: words": ({"--stock": "axbxc"}, "--stock axbxc"),
    "stock: sphere": ({"--stock": "sphere:10:20"}, "--stock sphere:10:20"),
    "stock: cylinder of no height": ({"--stock": "cylinder:10:0"}, "--stock cylinder:10:0"),
    "stock: unknown kind": ({"--stock": "cone:10"}, "--stock cone:10"),
    "stock: NaN file": ({"--stock": "nan.stl"}, "nan.stl, byte "),
    "stock: missing file": ({"--stock": "nowhere.stl"}, "nowhere.stl"),
    "origin": ({"--origin": "1,2"}, "--origin 1,2"),
    "directions": ({"--directions": "xy"}, "--directions"),
    "out: kind": ({"--out": "a.step"}, "--out a.step"),
    "out: nowhere": ({"--out": "no/a.stl"}, "no folder"),
    "out: folder": ({"--out": "folder.stl"}, "directory"),
}
for name, (change, message) in BAD_CARVES.items():
    options = {"--stock": "40x20x10", "--pitch": "1", "--tool": "ball:6", "--program": "slot.ngc", "--out": "a.stl"}
    BAD["carve: " + name] = (["volume", "carve", *[w for pair in (options | change).items() for w in pair]], message)


@pytest.mark.parametrize("case", BAD)
def test_bad_input_is_one_clear_line_and_leaves_no_file(folder, case):
    words, message = BAD[case]
    for file, data in FILES.items():
        (folder / file).write_bytes(data)
    (folder / "folder.stl").mkdir()
    before = sorted(p.name for p in folder.rglob("*"))
    as_json = case.endswith(("NaN", "0", "command", "word"))  # the other form for some; both in the test below
    done = riffle(*words, *(["--json"] if as_json else []), cwd=folder)
    assert done.returncode == 2, done.stdout + done.stderr
    if as_json:
        assert done.stderr == ""
        line = json.loads(done.stdout)["error"]
    else:
        assert done.stdout == ""
        assert done.stderr.startswith("riffler: ") and done.stderr.count("\n") == 1
        line = done.stderr
    assert message in line
    assert "Traceback" not in line and "defect" not in line
    assert sorted(p.name for p in folder.rglob("*")) == before


def test_an_error_leaves_the_old_file(folder):
    (folder / "part.stl").write_bytes(b"the old one")
    (folder / "bad.ngc").write_text("G21 G90\nG1 X9\n")
    carve = ("volume", "carve", "--stock", "9x9x9", "--pitch", 1, *TOOL, "--program", "bad.ngc", "--out", "part.stl")
    for extra in ([], ["--json"]):
        done = riffle(*carve, *extra, cwd=folder)
        assert done.returncode == 2
        assert "bad.ngc, line 2" in (json.loads(done.stdout)["error"] if extra else done.stderr)
    assert (folder / "part.stl").read_bytes() == b"the old one"


def opened(process, file):
    """Whether the process has the file open."""
    try:
        return any(os.path.samefile(path, file) for path in Path(f"/proc/{process}/fd").iterdir() if path.exists())
    except OSError:  # closed meanwhile
        return False


def test_ctrl_c_leaves_nothing_behind(folder):
    moves = "".join(f"X{k % 2 * 90} Y{k % 60}\n" for k in range(1_000_000))
    (folder / "long.ngc").write_text("G21 G90 G94\nG0 Z5\nG1 X0 Y0 F500\n" + moves + "M2\n")
    before = sorted(p.name for p in folder.iterdir())
    command = [*RIFFLER, "volume", "carve", "--stock", "90x60x30", "--pitch", "0.2", *TOOL, "--program",
               "long.ngc", "--out", "part.stl"]  # fmt: skip
    # Tests that run in the background may have been set to ignore it.
    heed = partial(signal.signal, signal.SIGINT, signal.SIG_DFL)
    with subprocess.Popen(
        command, cwd=folder, env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, preexec_fn=heed
    ) as running:
        while not opened(running.pid, folder / "long.ngc"):
            time.sleep(0.002)  # on a busy machine it has not even been loaded
        time.sleep(1)
        assert running.poll() is None, "it was done before it could be interrupted"
        running.send_signal(signal.SIGINT)
        stdout, stderr = running.communicate(timeout=30)
    assert running.returncode == 130
    assert stdout == "" and stderr == "riffler: interrupted, nothing was written\n"
    assert sorted(p.name for p in folder.iterdir()) == before


# ---- the parts that a process cannot show


def test_ctrl_c_while_writing_leaves_the_old_file(tmp_path):
    out, said = tmp_path / "part.stl", console.Console(json_output=True)
    out.write_text("old")
    with pytest.raises(KeyboardInterrupt), said.writing(out) as beside:
        beside.write_text("new")  # a native writer is through before Python sees the signal
        raise KeyboardInterrupt
    assert out.read_text() == "old" and said.written is None
    with pytest.raises(RuntimeError, match=r"^part\.stl: disk full$"), said.writing(out) as beside:
        raise RuntimeError(f"{beside.name}: disk full")
    with said.writing(out) as beside:
        assert beside.suffix == out.suffix
        beside.write_text("new")
    assert out.read_text() == "new" and said.written == "part.stl"
    assert [p.name for p in tmp_path.iterdir()] == ["part.stl"]


def test_angles_are_degrees_on_the_command_line_and_rad_in_files():
    taper = tools.parse("taper:1:10:12:60").make(0).to_dict()
    assert taper["half_angle"] == pytest.approx(np.radians(10))
    assert (taper["tip_radius"], taper["diameter"], taper["length"]) == (1, 12, 60)
    cone = tools.parse("7=cone-end:60:2:5:10:50")
    assert cone.number == 7
    assert cone.make(0).to_dict()["tip_half_angle"] == pytest.approx(np.radians(60))


def test_runs_of_tools_cover_every_move_once():
    assert tools.runs(np.array([0])) == []
    assert tools.runs(np.array([1, 1, 1])) == [(0, 2, 1)]
    assert tools.runs(np.array([0, 0, 1, 1, 2, 1])) == [(0, 1, 0), (1, 3, 1), (3, 4, 2), (4, 5, 1)]


def test_numbers_are_readable():
    assert console.number(177055.2541, "mm³") == "177\u2009055.254 mm³"
    assert (console.number(1234567), console.number(100.0), console.number(0.5)) == (
        "1\u2009234\u2009567",
        "100",
        "0.5",
    )
