"""STEP, IGES and BREP files: volumes compared with closed forms, names, colours, units, damaged files, the process.

OpenCASCADE writes the files in a separate process (cad_files.py).
"""

import json
import os
import random
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
import riffler
from cad_reader import shared_import
from riffler import cad, cli
from riffler.cad import process

needs_occ = pytest.mark.skipif(find_spec("OCP") is None, reason="the package cadquery-ocp-novtk is not installed")
HEADER = b"ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n"
END = b"ENDSEC;\nEND-ISO-10303-21;\n"


@pytest.fixture(scope="module", autouse=True)
def one_import():
    """Readers are forked from one process that has imported OpenCASCADE. Only
    test_opencascade_stays_out_of_the_callers_process has the process that users have."""
    if find_spec("OCP") is None:
        yield
        return
    with shared_import(process):
        yield


@pytest.fixture(scope="session")
def files(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("cad")
    program = Path(__file__).with_name("cad_files.py")
    done = subprocess.run([sys.executable, str(program), str(folder)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr[-2000:]
    return folder


def whole(part: cad.CadPart) -> bool:
    audit = part.mesh.audit()
    return not (audit.open_edges or audit.nonmanifold_edges or audit.degenerate or audit.duplicates or audit.folds)


# --- shapes -----------------------------------------------------------------------------------------------------------

EXACT = {
    "box.step": (6000, 2200),
    "inch.stp": (6000, 2200),
    "cylinder.step": (np.pi * 500, np.pi * 250),
    "sphere.step": (4 / 3 * np.pi * 343, 4 * np.pi * 49),
    "cone.step": (np.pi * 49 * 3, np.pi * 49 + np.pi * 7 * np.hypot(7, 9)),
    "torus.step": (2 * np.pi**2 * 20 * 64, 4 * np.pi**2 * 160),
}


@needs_occ
@pytest.mark.parametrize("name", EXACT)
def test_solids_are_closed_and_have_their_volume(files, name):
    volume, area = EXACT[name]
    part = cad.read(files / name, tolerance=0.01)
    assert whole(part) and part.report.closed and part.report.notes == ()
    assert part.mesh.audit().components == part.report.solids == 1
    assert part.report.volume == pytest.approx(volume, rel=1e-9)
    assert part.report.area == pytest.approx(area, rel=1e-9)
    # A surface within the tolerance of the exact one has the same volume, up to tolerance times area.
    assert abs(part.mesh.volume - volume) <= 0.01 * area
    assert part.report.deviation <= 0.01


@needs_occ
def test_triangles_of_a_torus_are_within_the_tolerance_everywhere(files):
    part = cad.read(files / "torus.step", tolerance=0.05)
    weights = np.array([(i, j, 8 - i - j) for i in range(9) for j in range(9 - i)]) / 8
    points = np.einsum("wc,tcx->twx", weights, part.mesh.vertices[part.mesh.triangles]).reshape(-1, 3)
    distance = np.hypot(np.hypot(points[:, 0], points[:, 1]) - 20, points[:, 2]) - 8
    assert abs(distance).max() <= 0.05 * 1.1  # 10 % more, because the tolerance is measured at middles, not proven
    assert part.report.deviation <= 0.05
    finer = cad.read(files / "torus.step", tolerance=0.02)
    assert len(finer.mesh.triangles) > 1.5 * len(part.mesh.triangles)


@needs_occ
@pytest.mark.parametrize("name", ["rounded.step", "rounded.igs", "rounded.brep"])
def test_rounded_box_in_every_format(files, name):
    part = cad.read(files / name)
    # 26 faces: 6 planes, 12 quarter cylinders, 8 eighths of a sphere of radius 2.
    volume = 26 * 16 * 6 + 2 * 2 * (26 * 16 + 16 * 6 + 26 * 6) + np.pi * 4 * (26 + 16 + 6) + 4 / 3 * np.pi * 8
    assert len(part.faces) == 26 and whole(part) and part.report.closed
    assert part.report.volume == pytest.approx(volume, rel=1e-6)
    assert abs(part.mesh.volume - volume) < 0.01 * part.report.area
    assert part.report.unit == ("inch" if name.endswith("igs") else "mm")
    assert part.report.sewn == (48 if name.endswith("igs") else 0)


@needs_occ
def test_every_triangle_lies_on_its_face(files):
    part = cad.read(files / "cylinder.step")
    assert sorted(face.kind for face in part.faces) == ["cylinder", "plane", "plane"]
    assert part.face_of_triangle.shape == (len(part.mesh.triangles),) and not part.face_of_triangle.flags.writeable
    for number, face in enumerate(part.faces):
        corners = part.mesh.vertices[part.mesh.triangles[part.triangles_of(number)]].reshape(-1, 3)
        if face.kind == "plane":
            assert np.ptp(corners[:, 2]) == 0
            assert face.area == pytest.approx(np.pi * 25)
        else:
            assert np.allclose(np.hypot(corners[:, 0], corners[:, 1]), 5, atol=1e-12)
            assert face.area == pytest.approx(np.pi * 200)
    assert sum(part.mesh_of(n).area for n in range(3)) == pytest.approx(part.mesh.area)


@needs_occ
def test_outline_of_picked_faces_is_a_region_for_finishing(files):
    part = cad.read(files / "box.step")
    tops = [n for n in range(6) if part.mesh_of(n).bounds[0, 2] == 10]
    (curve,) = part.outline(tops)
    assert curve.shape == (4, 3) and (curve[:, 2] == 10).all()
    x, y = curve[:, 0], curve[:, 1]
    assert 0.5 * (x @ np.roll(y, -1) - y @ np.roll(x, -1)) == 600  # counter-clockwise from outside
    assert part.outline(range(6)) == []
    stock = riffler.Volume.block((0, 0, 0), (30, 20, 10.5), 0.5)
    setup = riffler.plan.Setup(part.mesh, stock)
    rows = riffler.plan.finish(setup, riffler.Tool.ball(4, 20), cusp=0.05, region=[0.5 * curve + 0.25 * curve.max(0)])
    assert "finish" in type(rows).__name__.lower() or rows is not None
    with pytest.raises(IndexError, match="there is no face 6; the part has 6, from 0"):
        part.triangles_of([0, 6])


@needs_occ
def test_mesh_read_gives_the_same_mesh_every_time(files):
    part = cad.read(files / "rounded.step", tolerance=0.02)
    mesh = riffler.Mesh.read(files / "rounded.step", tolerance=0.02)
    assert mesh.vertices.tobytes() == part.mesh.vertices.tobytes()
    assert mesh.triangles.tobytes() == part.mesh.triangles.tobytes()
    assert len(riffler.Mesh.read(files / "rounded.step").triangles) > len(mesh.triangles)


# --- assemblies, units, names, colours --------------------------------------------------------------------------------


@needs_occ
def test_assembly_in_inches_is_placed_named_and_coloured(files):
    part = cad.read(files / "assembly.step")
    assert b"25.4" in (files / "assembly.step").read_bytes() or part.report.unit == "inch"
    assert [body.name for body in part.bodies] == ["Fixture/Plate", "Fixture/Gehäusestift", "Fixture/Gehäusestift"]
    assert np.allclose(part.mesh.bounds, [[0, 0, 0], [40, 20, 17]], atol=1e-9)
    assert part.report.unit == "inch" and part.report.closed
    assert part.report.volume == pytest.approx(4000 + 2 * np.pi * 9 * 12, rel=1e-9)
    (top,) = part.find("datum ?")
    assert part.faces[top].color == pytest.approx((0.8, 0.2, 0.1), abs=2e-3)
    assert np.allclose(part.mesh_of(top).bounds, [[0, 0, 5], [40, 20, 5]], atol=1e-9)
    assert {face.color for face in part.faces if face.body == 0} == {None, part.faces[top].color}
    pins = [face for face in part.faces if face.body in (1, 2)]
    assert len(pins) == 6 and all(face.color == pytest.approx((0.1, 0.2, 0.9), abs=2e-3) for face in pins)
    for body, x in ((1, 10), (2, 30)):
        numbers = [n for n, face in enumerate(part.faces) if face.body == body]
        assert np.allclose(part.mesh_of(numbers).bounds.mean(0), [x, 10, 11], atol=0.01)


@needs_occ
def test_unit_can_be_set_where_the_file_states_a_wrong_one(files):
    part = cad.read(files / "tiny.step")
    assert any("largest side is 0.03 mm" in note and "unit=" in note for note in part.report.notes)
    metres = cad.read(files / "tiny.step", unit="m", tolerance=0.01)
    assert np.allclose(metres.mesh.bounds, [[0, 0, 0], [30, 20, 10]], rtol=1e-12)
    assert metres.report.volume == pytest.approx(6000) and metres.report.area == pytest.approx(2200)
    assert "its numbers are taken in m, as asked; it states mm" in metres.report.notes


# --- broken files -----------------------------------------------------------------------------------------------------


@needs_occ
def test_faces_next_to_each_other_become_a_solid(files):
    part = cad.read(files / "loose.step")
    assert whole(part) and part.report.closed and part.report.solids == 1
    assert part.mesh.volume == pytest.approx(6000) and part.report.sewn == 12
    assert any("12 edges joined" in note for note in part.report.notes)


@needs_occ
@pytest.mark.parametrize("name", ["open_shell.step", "broken.step", "broken.brep"])
def test_shell_without_solid_is_read_and_reported(files, name):
    part = cad.read(files / name)
    assert part.report.solids == 0 and part.report.sheets == 1 and not part.report.closed
    assert part.mesh.audit().open_edges == part.bodies[0].open_edges == 4
    assert any("it has no solid: 1 sheet of 5 faces with 4 open edges" in note for note in part.report.notes)
    assert riffler.Volume.from_mesh(part.mesh, 0.5).volume == pytest.approx(6000, rel=0.01)


@needs_occ
def test_files_without_faces(files, tmp_path):
    with pytest.raises(riffler.FormatError, match=r"wire\.step: it has no faces; expected a solid or surfaces.*export"):
        cad.read(files / "wire.step")
    empty = tmp_path / "nothing.step"
    empty.write_bytes(HEADER + END)
    with pytest.raises(riffler.FormatError, match=r"nothing\.step: "):
        cad.read(empty)


def test_bad_files_are_refused_before_the_reader_starts(tmp_path, monkeypatch):
    monkeypatch.setattr(process, "run", None)
    cases = {
        "empty.step": (b"", "the file is empty"),
        "blank.stp": (b" \n\0\n", "the file is empty"),
        "mesh.step": (b"solid x\nendsolid x\n", "expected a STEP file .* begins with ISO-10303-21;"),
        "packed.stp": (b"PK\x03\x04 rest", "it is a packed archive; unpack it"),
        "text.iges": (b"no such columns\n", "expected an IGES file"),
        "text.brep": (b"something else\n", "expected OpenCASCADE's BREP"),
    }
    for name, (content, message) in cases.items():
        (tmp_path / name).write_bytes(content)
        with pytest.raises(riffler.FormatError, match=rf"{name}: .*{message}"):
            cad.read(tmp_path / name)
    with pytest.raises(riffler.FormatError, match=r"gone\.step: cannot be read: No such file"):
        cad.read(tmp_path / "gone.step")
    (tmp_path / "folder.step").mkdir()
    with pytest.raises(riffler.FormatError, match="a file expected, not a folder"):
        cad.read(tmp_path / "folder.step")


def test_more_faces_than_can_be_read(tmp_path, monkeypatch):
    monkeypatch.setattr(riffler.cad.reading, "MOST_FACES", 99)
    monkeypatch.setattr(process, "run", None)
    path = tmp_path / "many.step"
    row = b"#1=ADVANCED_FACE('',(#2),#3,.T.);\n"
    path.write_bytes(HEADER + 100 * row + END)
    with pytest.raises(riffler.FormatError, match=r"many\.step: more than 99 faces; export the bodies one at a time"):
        cad.read(path)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"path": "part.stl"}, r"part\.stl: a name that ends with \.step, \.stp, \.iges, \.igs, \.brep expected"),
        ({"tolerance": 0}, "tolerance must be a positive number of mm, not 0"),
        ({"tolerance": float("nan")}, "tolerance must be a positive number"),
        ({"tolerance": float("inf")}, "tolerance must be a positive number"),
        ({"unit": "furlong"}, "unit must be one of mm, cm, m, inch"),
        ({"timeout": 0}, "timeout must be a positive number of seconds"),
    ],
)
def test_wrong_arguments(arguments, message):
    with pytest.raises(ValueError, match=message):
        cad.read(**({"path": "part.step"} | arguments))


@needs_occ
def test_too_many_triangles_are_refused(files, monkeypatch):
    monkeypatch.setattr(riffler.cad.reading, "MOST_TRIANGLES", 100)
    with pytest.raises(
        riffler.FormatError, match=r"torus\.step: more than 100 triangles within 0\.1 mm.*larger tolerance"
    ):
        cad.read(files / "torus.step", tolerance=0.1)


# --- the reader's process ---------------------------------------------------------------------------------------------


@needs_occ
def test_opencascade_stays_out_of_the_callers_process(files):
    code = (
        "import os, sys, riffler\n"
        f"mesh = riffler.Mesh.read({str(files / 'box.step')!r})\n"
        "print(len(mesh.triangles), any(name.split('.')[0] == 'OCP' for name in sys.modules))\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["12", "False"] and done.stderr == ""


def fake(folder: Path, body: str) -> Path:
    """A substitute for the reader's Python that runs ``body``, to simulate what a file does to the reader."""
    program = folder / "python"
    program.write_text(f"#!{sys.executable}\nimport sys, os, time, signal\nfolder = sys.argv[2]\n{body}\n")
    program.chmod(0o755)
    return program


@pytest.fixture
def step_file(tmp_path) -> Path:
    path = tmp_path / "part.step"
    path.write_bytes(HEADER + END)
    return path


def left_folders() -> set[str]:
    import tempfile

    return {name for name in os.listdir(tempfile.gettempdir()) if name.startswith("riffler-cad-")}


def test_a_crash_of_the_reader_is_an_error(step_file, tmp_path):
    before = left_folders()
    program = fake(
        tmp_path, "print('bad pointer', file=sys.stderr); sys.stderr.flush(); os.kill(os.getpid(), signal.SIGSEGV)"
    )
    with pytest.raises(
        cad.CadReaderError, match=r"part\.step: the CAD reader stopped \(SIGSEGV, .*bad pointer\)\. Export the"
    ):
        cad.read(step_file, python=program)
    with pytest.raises(cad.CadReaderError, match="exit status 7"):
        cad.read(step_file, python=fake(tmp_path, "sys.exit(7)"))
    assert left_folders() <= before


def test_a_reader_that_hangs_is_ended(step_file, tmp_path):
    mark = tmp_path / "pid"
    program = fake(tmp_path, f"open({str(mark)!r}, 'w').write(str(os.getpid())); time.sleep(100)")
    start = time.monotonic()
    with pytest.raises(TimeoutError, match=r"part\.step: not read within 3 s \(stage: start\); a larger tolerance"):
        cad.read(step_file, python=program, timeout=3)
    assert time.monotonic() - start < 30
    with pytest.raises(ProcessLookupError):
        os.kill(int(mark.read_text()), 0)


def test_cancel_ends_the_reader(step_file, tmp_path):
    program = fake(tmp_path, "time.sleep(100)")
    with pytest.raises(riffler.Cancelled):
        cad.read(step_file, python=program, progress=lambda share: False)
    future = riffler.submit(cad.read, step_file, python=program)
    future.cancel()
    assert isinstance(future.exception(timeout=30), riffler.Cancelled)

    def broken(share):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        cad.read(step_file, python=program, progress=broken)


def test_missing_extra_names_the_command(step_file, tmp_path):
    program = fake(tmp_path, "import json; json.dump({'error': 'missing', 'message': 'No module named OCP', "
                             "'python': sys.executable}, open(folder + '/result.json', 'w'))")  # fmt: skip
    with pytest.raises(
        ValueError, match=r"cadquery-ocp-novtk in .*\(pip install 'riffler\[cad\]'\): No module named OCP"
    ):
        cad.read(step_file, python=program)


def test_reader_without_opencascade(step_file, monkeypatch):
    bare = subprocess.run([sys.executable, "-S", "-c", "import OCP"], capture_output=True)
    assert bare.returncode != 0
    monkeypatch.setenv(process.PYTHON, "/no/such/python")
    with pytest.raises(RuntimeError, match=r"/no/such/python: cannot be started .*RIFFLER_CAD_PYTHON names a Python"):
        cad.read(step_file)


@needs_occ
def test_progress_rises_to_the_end(files):
    shares: list[float] = []
    cad.read(files / "sphere.step", progress=shares.append)
    assert shares == sorted(shares) and shares[0] == 0 and 0.2 < shares[-1] <= 1


def damaged(content: bytes, chance: random.Random) -> bytes:
    """The file's content with random parts of its header or data overwritten, removed, doubled or swapped."""
    data = bytearray(content)
    for _ in range(chance.randint(1, 6)):
        at = chance.randrange(len(data)) if chance.random() < 0.5 else chance.randrange(min(len(data), 1500))
        kind = chance.randrange(5)
        if kind == 0:
            data[at : at + 8] = bytes(chance.randrange(256) for _ in range(8))
        elif kind == 1:
            del data[at : at + chance.randint(1, 200)]
        elif kind == 2:
            data[at:at] = data[at : at + chance.randint(1, 200)]
        elif kind == 3:
            data[at:at] = b"(" * 2000
        else:
            data[at : at + 1] = b"#" + str(chance.randrange(400)).encode()
    return b"ISO-10303-21;" + bytes(data[13:])


def hostile(content: bytes) -> dict[str, bytes]:
    """Files that a reader could hang at, or that could take all memory."""
    header, data = content.split(b"DATA;", 1)
    start = b"ISO-10303-21;\nHEADER;\n"
    spline = (
        b"#1=B_SPLINE_SURFACE_WITH_KNOTS('',2147483647,2147483647,((#2)),.UNSPECIFIED.,.F.,.F.,.F.,(2147483647),"
        b"(2147483647),(0.),(0.),.UNSPECIFIED.);\n#2=CARTESIAN_POINT('',(1.E308,-1.E308,NAN));\n"
    )
    return {
        "truncated": content[: len(header) // 2],
        "endless": header + b"DATA;" + data.replace(b"ENDSEC;", b"").replace(b"END-ISO-10303-21;", b""),
        "nested": start + b"FILE_DESCRIPTION(" + b"(" * 3_000_000,
        "nested data": header + b"DATA;\n#1=X(" + b"(" * 1_000_000 + b")" * 1_000_000 + b");\n" + END,
        "open string": start + b"FILE_NAME('" + b"x" * 3_000_000,
        "schema": content.replace(b"FILE_SCHEMA((", b"FILE_SCHEMA(('IFC4','" + b"A" * 100_000 + b"',", 1),
        "counts": content.replace(b"DATA;", b"DATA;\n" + spline, 1),
        "numbers": content.replace(b"#1", b"#99999999999999999999", 40),
        "loop": HEADER + b"#1=SHELL_BASED_SURFACE_MODEL('',(#1));\n#2=CLOSED_SHELL('',(#2,#1));\n" + END,
    }


def test_the_readers_memory_is_limited():
    code = (
        f"import sys, resource; sys.argv[:] = ['x']; sys.path.insert(0, {str(process.WORKER)!r})\n"
        "import __main__, runpy\n"
        f"own = runpy.run_path({str(process.WORKER / '__main__.py')!r}, run_name='worker')\n"
        "own['limit_memory'](); print(resource.getrlimit(resource.RLIMIT_AS)[0])\n"
        "try: bytearray(1 << 50)\n"
        "except MemoryError: print('refused')\n"
    )
    if sys.platform != "linux":
        pytest.skip("only Linux limits the address space")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    limit, refused = done.stdout.split()
    assert 4 << 30 <= int(limit) < 1 << 50 and refused == "refused"


@needs_occ
def test_damaged_and_hostile_files_neither_hang_nor_crash_the_caller(files, tmp_path):
    chance = random.Random(11)
    whole_file = (files / "assembly.step").read_bytes()
    paths = []
    for number in range(int(os.environ.get("RIFFLER_CAD_FUZZ", "4"))):
        paths.append(tmp_path / f"{number}.step")
        paths[-1].write_bytes(damaged(whole_file, chance))
    for name, content in hostile(whole_file).items():
        paths.append(tmp_path / f"{name}.step")
        paths[-1].write_bytes(content)

    def outcome(path: Path) -> str:
        try:
            part = cad.read(path, timeout=120)
        except (riffler.FormatError, cad.CadReaderError) as error:
            assert str(error).startswith(path.name + ": "), error
            return type(error).__name__
        assert np.isfinite(part.mesh.vertices).all() and len(part.face_of_triangle) == len(part.mesh.triangles)
        return "read"

    with ThreadPoolExecutor(2) as pool:
        outcomes = list(pool.map(outcome, paths))
    assert set(outcomes) <= {"read", "FormatError", "CadReaderError"}
    assert "FormatError" in outcomes or "read" in outcomes


# --- the command line -------------------------------------------------------------------------------------------------


@needs_occ
def test_convert_writes_a_mesh_of_a_step_file(files, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "part.step").write_bytes((files / "torus.step").read_bytes())
    for words in (
        ["convert", "part.step", "part.stl", "--tolerance", "0.1", "--json"],
        ["mesh", "convert", "part.step", "--out", "other.stl", "--tolerance", "0.1", "--json"],
    ):
        assert cli.main(words) == 0
    triangles = [json.loads(text)["triangles"] for text in capsys.readouterr().out.replace("}\n{", "}\0{").split("\0")]
    assert triangles[0] == triangles[1] > 100
    assert riffler.Mesh.read("part.stl").audit().open_edges == 0
    assert (tmp_path / "part.stl").read_bytes() == (tmp_path / "other.stl").read_bytes()


@needs_occ
def test_commands_take_step_files(files, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    box, sheet = str(files / "box.step"), str(files / "open_shell.step")
    assert cli.main(["mesh", "audit", box]) == 0
    assert cli.main(["mesh", "audit", sheet]) == 1
    assert "open_shell.step: it has no solid: 1 sheet" in capsys.readouterr().err
    assert cli.main(["volume", "from-mesh", box, "--pitch", "1", "--out", "box.rvol"]) == 0
    assert riffler.Volume.load("box.rvol").volume == pytest.approx(6000)
    finish = ["plan", "finish", box, "--tool", "ball:6", "--cusp", "0.3", "--pitch", "1", "--out", "box.ngc"]
    assert cli.main(finish) == 0 and "G1" in (tmp_path / "box.ngc").read_text()


def test_convert_refuses_options_of_the_other_kind(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=1).to_mesh().write("part.stl")
    (tmp_path / "part.step").write_bytes(HEADER + END)
    assert cli.main(["mesh", "convert", "part.stl", "out.stl", "--tolerance", "1"]) == 2
    assert "--tolerance is for CAD files" in capsys.readouterr().err
    assert cli.main(["mesh", "convert", "part.step", "out.stl", "--unit", "inch"]) == 2
    assert "--unit is for meshes; part.step states its own" in capsys.readouterr().err
    assert not (tmp_path / "out.stl").exists()
    assert cli.main(["convert", "part.stl", "--pitch", "1", "--out", "part.rvol"]) == 0  # the old name of the verb
