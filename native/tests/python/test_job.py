"""Jobs: the job file and its errors, tool tables, and the results of a job, checked with a height map in numpy."""

import json
import math
import shutil
import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import riffler
from commands import result as command
from commands import riffle
from riffler import job as jobs
from riffler.job import lines, running, tool_files
from riffler.job.running import setup_of

EXAMPLE = Path(__file__).parents[3] / "examples" / "job"
TEXT = """\
part = "hill.stl"

[stock]
sides = 2
top = 1
pitch = 0.4

[machine]
zero = "top-corner"

[[tool]]
number = 3
kind = "flat"
diameter = 6
length = 20

[[tool]]
number = 8
kind = "ball"
diameter = 6
length = 20

[[operation]]
kind = "rough"
tool = 3
stepdown = 4

[[operation]]
name = "rows"
kind = "finish"
tool = 8
cusp = 0.1
angle = 30
slopes = [0, 80]
"""


@pytest.fixture
def folder(tmp_path):
    riffler.shape.relief([[0.3, 1.0], [0.6, 0.3]], size=(20, 20), depth=10).write(tmp_path / "hill.stl")
    (tmp_path / "hill.toml").write_text(TEXT)
    return tmp_path


def changed(folder, *changes):
    text = TEXT
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    (folder / "hill.toml").write_text(text)
    return folder / "hill.toml"


def heights_after(program, size, top, cell=0.2):
    """Heights of the material after all moves at feed of upright flat and ball cutters, by brute force."""
    x, y = np.meshgrid(np.arange(cell / 2, size[0], cell), np.arange(cell / 2, size[1], cell), indexing="ij")
    z = np.full(x.shape, float(top))
    for k in range(1, len(program)):
        if program.rapid[k]:
            continue
        tool = program.tools[int(program.tool[k])]
        a, b, r = program.poses[k - 1, :3], program.poses[k, :3], tool.diameter / 2
        for share in np.linspace(0, 1, max(2, math.ceil(np.linalg.norm(b - a) / cell) + 1)):
            p = a + share * (b - a)
            i, j = (slice(max(0, int((c - r) / cell)), max(0, int((c + r) / cell) + 2)) for c in p[:2])
            square = (x[i, j] - p[0]) ** 2 + (y[i, j] - p[1]) ** 2
            low = np.zeros_like(square) if tool.kind == "flat" else r - np.sqrt(np.maximum(r * r - square, 0))
            z[i, j] = np.where(square <= r * r, np.minimum(z[i, j], p[2] + low), z[i, j])
    return x, y, z


def surface(x, y):
    """Heights of the part's top, by rays along z."""
    part = riffler.shape.relief([[0.3, 1.0], [0.6, 0.3]], size=(20, 20), depth=10)
    corners = part.vertices[part.triangles]
    out = np.full(x.shape, -np.inf)
    for a, b, c in corners:
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        if abs(area) < 1e-12:
            continue
        u = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / area
        v = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / area
        inside = (u >= 0) & (v >= 0) & (u + v <= 1)
        out = np.where(inside, np.maximum(out, a[2] + u * (b[2] - a[2]) + v * (c[2] - a[2])), out)
    return out


def test_a_job_writes_a_program_that_makes_the_part(folder):
    data = command("job", "hill.toml", "--no-sheet", cwd=folder)
    assert [op["kind"] for op in data["operations"]] == ["rough", "finish"] and data["warnings"] == []
    program = riffler.Program.read(folder / "hill.ngc", machine="3-axis")
    assert set(program.tool) - {0} == {3, 8}
    job = jobs.read(folder / "hill.toml")
    moved = np.eye(4)
    moved[:3, 3] = job.zero
    assert job.zero.tolist() == [-2, -2, 11]
    program = program.transformed(moved)
    program = riffler.Program(
        program.poses,
        program.feed,
        rapid=program.rapid,
        tool=program.tool,
        tools={3: job.tools[3].tool, 8: job.tools[8].tool},
    )
    x, y, z = heights_after(program, (20, 20), 11)
    part = surface(x, y)
    over = z - part
    # The ball does not touch at a cell's middle: steep faces rise within a cell.
    assert over.min() > -0.02
    flat = (x > 4) & (x < 16) & (y > 4) & (y < 16)
    assert np.quantile(over[flat], 0.9) < 0.2


def test_the_sheet_is_one_page_with_pictures_and_everything_in_it(folder):
    pytest.importorskip("matplotlib")
    command("job", "hill.toml", cwd=folder)
    page = (folder / "hill.html").read_text()
    assert page.count("data:image/png;base64,") == 4 and "http" not in page and "<script" not in page
    for text in (
        "hill.stl",
        "T3",
        "T8",
        "flat Ø6",
        "rough with tool 3",
        "rows",
        "top-corner"[:3],
        "cusp = 0.1",
        "mm³ removed",
    ):
        assert text in page, text


def test_a_dry_run_checks_and_writes_nothing(folder):
    before = sorted(folder.iterdir())
    data = command("job", "hill.toml", "--dry-run", cwd=folder)
    assert [op["name"] for op in data["operations"]] == ["rough with tool 3", "rows"]
    assert sorted(folder.iterdir()) == before


def test_an_operation_that_reaches_nothing_is_a_warning_and_the_rest_is_done(folder):
    path = changed(folder, ("slopes = [0, 80]", "slopes = [88, 89]"))
    found = jobs.run(jobs.read(path))
    assert len(found.warnings) == 1 and found.warnings[0].startswith("rows: it cuts nothing: no face")
    assert len(found.operations[0].operation) and not len(found.operations[1].operation)
    assert (folder / "hill.ngc").exists()


def test_an_error_of_the_check_names_the_operation_and_writes_nothing(folder, monkeypatch):
    plain = running._run_one

    def deeper(setup, one, progress):
        done = plain(setup, one, progress)
        if one.name != "rows":
            return done
        poses = done.operation.poses - np.outer(done.operation.kind == 2, [0, 0, 1, 0, 0, 0])
        return replace(done, operation=replace(done.operation, poses=poses))

    monkeypatch.setattr(running, "_run_one", deeper)
    with pytest.raises(
        jobs.JobError, match=r"hill\.toml, line \d+, \[\[operation\]\] 2 \(rows\), row \d+, at \(.*deep"
    ):
        jobs.run(jobs.read(folder / "hill.toml"))
    assert not (folder / "hill.ngc").exists()


def test_what_a_short_tool_leaves_out_is_a_warning(folder):
    head, _, finish = TEXT.split("[[operation]]")
    head = head.replace("top = 1", "top = 4")
    at = head.rindex("length = 20")
    head = head[:at] + "length = 7\nholder = [[7, 12, 30, 12]]\n"
    path = folder / "hill.toml"
    path.write_text(head + "[[operation]]" + finish)
    found = jobs.run(jobs.read(path))
    assert any("the holder meets the stock" in one for one in found.warnings)
    assert found.report.passed


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("sides = 2", "side = 2"), r"line 4, \[stock\] side: unknown key; did you mean sides\?"),
        (("top = 1", "top = -1"), r"line 5, \[stock\] top: must be at least 0, not -1"),
        (("pitch = 0.4", "pitch = 0"), r"line 6, \[stock\] pitch: must be more than 0, not 0"),
        (("pitch = 0.4", 'pitch = "x"'), r"line 6, \[stock\] pitch: a number expected, not 'x'"),
        (("pitch = 0.4", "pitch = nan"), r"line 6, \[stock\] pitch: a number expected, not nan"),
        (('"top-corner"', '"topcorner"'), r"line 9, \[machine\] zero: .*did you mean top-corner"),
        (('zero = "top-corner"', 'name = "3axis"'), r"line 9, \[machine\] name: .*did you mean 3-axis"),
        (('zero = "top-corner"', "zero = [0, 0]"), r"line 9, \[machine\] zero: 3 numbers expected"),
        (('zero = "top-corner"', "options = {lin_numbers = true}"), r"line_numbers"),
        (("number = 8", "number = 3"), r"line 18, \[\[tool\]\] 2 number: tool 3 is there twice"),
        (('kind = "ball"', 'kind = "bal"'), r"line 19, \[\[tool\]\] 2 kind: .*did you mean ball"),
        (
            ('kind = "ball"', 'kind = "fillet"'),
            r"line 17, \[\[tool\]\] 2: corner_radius is missing; add a line such as",
        ),
        (("diameter = 6\n", ""), r"line 11, \[\[tool\]\] 1: diameter is missing; add a line such as diameter = 6"),
        (('kind = "rough"', 'kind = "ruogh"'), r"line 24, \[\[operation\]\] 1 kind: .*did you mean rough"),
        (("tool = 3", "tool = 4"), r"line 25, \[\[operation\]\] 1 tool: no tool 4; known are 3, 8; add \[\[tool\]\]"),
        (("stepdown = 4", "step_down = 4"), r"line 26, .*step_down: unknown key; did you mean stepdown"),
        (('"hill.stl"', '"hil.stl"'), r"line 1, part: no such file"),
        (('"hill.stl"', '"hill.toml"'), r"line 1, part: hill.toml: a file that ends with .stl"),
        (('"hill.stl"', "3"), r"line 1, part: a text in quotes expected, not 3"),
        (("part =", "prat ="), r"hill.toml: part is missing"),
        (("sides = 2", "sides = 2\nsides = 3"), r"hill.toml: .*line 5"),
        (("sides = 2", 'kind = "mesh"'), r"line 3, \[stock\]: file is missing"),
    ],
)
def test_errors_name_line_table_key_and_remedy(folder, change, message):
    with pytest.raises(jobs.JobError, match=message):
        jobs.read(changed(folder, change))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("stepdown = 4", "stepdown = 70"), r"line 26, \[\[operation\]\] 1 stepdown: .*more than the cutter's length"),
        (("cusp = 0.1", "cusp = 3.5"), r"line 32, \[\[operation\]\] 2 cusp: .*less than the tool's radius"),
    ],
)
def test_errors_of_planners_name_the_key_with_its_line(folder, change, message):
    with pytest.raises(jobs.JobError, match=message):
        jobs.run(jobs.read(changed(folder, change)))


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ("lower = [5, 5, 0]", "stock: smaller than the part"),
        ("lower = [100, 100, 0]\nupper = [120, 120, 9]", "part: outside of the stock, x from 0 to 20 mm"),
    ],
)
def test_a_stock_that_does_not_fit_is_reported_by_a_dry_run(folder, more, message):
    changed(folder, ("sides = 2", more))
    done = riffle("job", "hill.toml", "--dry-run", cwd=folder)
    assert done.returncode == 2 and message in done.stderr and len(done.stderr.splitlines()) == 1


def test_an_empty_file_and_no_operation(tmp_path):
    (tmp_path / "a.toml").write_text("")
    with pytest.raises(jobs.JobError, match="part is missing; add a line such as part ="):
        jobs.read(tmp_path / "a.toml")
    riffler.shape.relief([[0.3, 1.0], [0.6, 0.3]], size=(20, 20), depth=10).write(tmp_path / "hill.stl")
    (tmp_path / "a.toml").write_text('part = "hill.stl"\n')
    with pytest.raises(jobs.JobError, match=r"no operation; add a line \[\[operation\]\]"):
        jobs.read(tmp_path / "a.toml")


@pytest.mark.parametrize("kind", ["cylinder", "mesh", "volume"])
def test_a_job_takes_every_kind_of_stock(folder, kind):
    block = riffler.Volume.block((-1, -1, 0), (21, 21, 12), 0.5)
    block.to_mesh().write(folder / "blank.stl")
    block.save(folder / "blank.rvol")
    more = {"cylinder": "sides = 2", "mesh": 'file = "blank.stl"', "volume": 'file = "blank.rvol"'}[kind]
    rest = "" if kind == "volume" else "pitch = 0.5"
    top = "top = 2" if kind == "cylinder" else ""
    path = changed(folder, ("sides = 2\ntop = 1\npitch = 0.4", f'kind = "{kind}"\n{more}\n{rest}\n{top}'))
    stock = jobs.read(path).stock
    expected = math.pi * (math.hypot(10, 10) + 2) ** 2 * 12 if kind == "cylinder" else 22 * 22 * 12
    assert stock.volume == pytest.approx(expected, rel=0.01)
    assert len(setup_of(jobs.read(path)).obstacles) == 0


def test_fixtures_are_kept_clear_of(folder):
    riffler.Volume.block((0, 0, 0), (4, 4, 14), 1, "xyz").to_mesh().write(folder / "clamp.stl")
    clamp = '[[fixture]]\nfile = "clamp.stl"\nmove = [8, 17, 0]\n\n[machine]'
    job = jobs.read(changed(folder, ("[machine]", clamp)))
    found = jobs.run(job, write=False)
    assert found.report.passed and any("the tool meets a fixture" in one for one in found.warnings)
    assert not (folder / "hill.ngc").exists()


def test_lines_of_keys_in_every_form():
    text = (
        'a = 1\n"b c" = """\n[no]\nd = 1\n"""\n[t]\nx = [\n  1, # ]\n  [2]]\ny = "[" # [\n'
        "[[u]]\nk = 1\n[[u]]\nk = {q = 1}\n[u.sub]\nz.w = 2\n"
    )
    found = lines.lines_of(text)
    assert found == {
        ("a",): 1, ("b c",): 2, ("t",): 6, ("t", "x"): 7, ("t", "y"): 10, ("u", 0): 11, ("u", 0, "k"): 12,
        ("u", 1): 13, ("u", 1, "k"): 14, ("u", 1, "sub"): 15, ("u", 1, "sub", "z"): 16, ("u", 1, "sub", "z", "w"): 16,
    }  # fmt: skip


def test_a_tool_table_of_linuxcnc(tmp_path):
    path = tmp_path / "tool.tbl"
    path.write_text(
        "T1 P2 Z-5.5 D8 ;flat\n\n; words only\nt12 p3 d.25 z1 ; Ball nose\nT99999 P4 D3 ;thing\nT5 ;drill\n"
    )
    one, two, three, four = tool_files.read(path, "inch")
    assert one.sizes == {"diameter": pytest.approx(203.2), "kind": "flat"} and one.number == 1 and not one.problem
    assert two.sizes == {"diameter": pytest.approx(6.35), "kind": "ball"} and two.number == 12
    assert three.problem and three.where == "tool.tbl, line 5" and four.sizes == {"kind": "drill", "point": 118}
    assert tool_files.read(path)[0].sizes["diameter"] == 8
    for wrong, message in (("P1 D3", "line 1: a tool number expected"), ("T1 Dx", "line 1: Dx: a number expected"),
                           ("T1.5", "T1.5 is no tool number")):  # fmt: skip
        path.write_text(wrong)
        with pytest.raises(ValueError, match=message):
            tool_files.read(path)


def fusion_tool(number, kind, unit="millimeters", **geometry):
    return {
        "type": kind,
        "unit": unit,
        "description": f"{kind} {number}",
        "geometry": {"DC": 6, "LCF": 18, "SFDM": 6, "LB": 30, "NOF": 3, **geometry},
        "post-process": {"number": number},
        "start-values": {"presets": [{"name": "wood", "n": 18000, "v_f": 2400, "v_f_plunge": 800}]},
        "holder": {
            "unit": "millimeters",
            "segments": [
                {"height": 10, "lower-diameter": 20, "upper-diameter": 30},
                {"height": 5, "lower-diameter": 40, "upper-diameter": 40},
            ],
        },
    }


@pytest.mark.parametrize("packed", [False, True])
def test_a_tool_library_of_fusion(folder, packed):
    tools = [
        fusion_tool(3, "flat end mill"),
        fusion_tool(8, "ball end mill", "inches", DC=0.25, LCF=0.75, LB=1.5, SFDM=0.25),
        fusion_tool(9, "bull nose end mill", RE=1),
        fusion_tool(10, "drill", SIG=118),
        fusion_tool(11, "thread mill"),
        {"type": "holder", "description": "no tool"},
    ]
    data = json.dumps({"data": tools, "version": 20})
    name = "shop.tools" if packed else "shop.json"
    if packed:
        with zipfile.ZipFile(folder / name, "w") as archive:
            archive.writestr("tools.json", data)
    else:
        (folder / name).write_text(data)
    found = tool_files.read(folder / name)
    assert (
        [one.number for one in found] == [3, 8, 9, 10, 11] and found[4].problem and found[2].sizes["corner_radius"] == 1
    )
    assert found[0].sizes["holder"] == [[30, 10, 40, 15], [40, 20, 45, 20]] and found[0].spindle == 18000
    table = f'[[tool_table]]\nfile = "{name}"\n'
    head, _, rest = TEXT.partition("[[tool]]")
    tail = rest[rest.index("[[operation]]") :]
    (folder / "hill.toml").write_text(head + table + "\n[[tool]]\nnumber = 3\nlength = 19\n\n" + tail)
    job = jobs.read(folder / "hill.toml")
    assert job.tools[3].tool.length == 19 and job.tools[3].feed == 2400 and job.tools[3].flutes == 3
    assert job.tools[8].tool.diameter == pytest.approx(6.35) and job.tools[8].feed == pytest.approx(2400 * 25.4)
    assert job.tools[8].tool.holder[0][0] == pytest.approx(1.5 * 25.4) and job.operations[0].options["plunge"] == 800
    (folder / "hill.toml").write_text((head + table + tail).replace("tool = 8", "tool = 11"))
    with pytest.raises(
        jobs.JobError, match=r"tool 11 of shop.*: its type 'thread mill' is none of .*; add \[\[tool\]\]"
    ):
        jobs.read(folder / "hill.toml")


@pytest.mark.parametrize("text", ["", "[1]", '{"data": 3}', "\x00\x01"])
@pytest.mark.parametrize("suffix", [".json", ".tools"])
def test_a_file_that_is_no_library_is_reported(tmp_path, suffix, text):
    path = tmp_path / f"a{suffix}"
    path.write_text(text)
    with pytest.raises(ValueError, match=f"a{suffix}: no tool library of Fusion"):
        tool_files.read(path)


def test_the_example_runs(tmp_path):
    folder = tmp_path / "job"
    shutil.copytree(EXAMPLE, folder)
    done = riffle("job", "plate.toml", "--no-sheet", "--json", cwd=folder)
    assert done.returncode == 0, done.stderr
    data = json.loads(done.stdout)
    assert all(op["poses"] for op in data["operations"])
    # The warnings are about the holes, which are drilled later.
    assert all("narrower than the tool and allowance" in text for text in data["warnings"])
    part = riffler.Mesh.read(folder / "plate.stl")
    assert part.volume < data["left"] < data["stock"]["upper"][2] * 78 * 48
    called = [line.split()[0] for line in (folder / "plate.ngc").read_text().splitlines() if "M6" in line]
    assert called == ["T1", "T4", "T7", "T1"]


def test_a_job_may_have_operations_from_several_sides(folder):
    path = changed(
        folder,
        ("pitch = 0.4", 'pitch = 0.5\ndirections = "xyz"'),
        ("[machine]", '[machine]\nname = "tcp"'),
        ("stepdown = 4", "stepdown = 4\ndepth = 5"),
        ("cusp = 0.1", "cusp = 0.2\nrest = 0.1\norientation = [0, -3, 4]"),
    )
    data = command("job", "hill.toml", cwd=folder)
    assert [op["poses"] > 0 for op in data["operations"]] == [True, True]
    program = riffler.Program.read(folder / "hill.ngc", machine="tcp")
    first, second = (program.poses[program.tool == number, 3:] for number in (3, 8))
    assert np.allclose(first[0], [0, 0, 1], atol=1e-6) and np.allclose(second, [0, -0.6, 0.8], atol=1e-5)
    assert np.allclose(first[-1], [0, -0.6, 0.8], atol=1e-5)  # the turn ends before the tool change
    sheet = (folder / "hill.html").read_text()
    assert "tool axis" in sheet and "(0, -0.6, 0.8)" in sheet
    text = path.read_text().replace("[0, -3, 4]", "[0, 0, 0]")
    path.write_text(text)
    with pytest.raises(jobs.JobError, match=r"line \d+, \[\[operation\]\] 2 orientation: a direction expected"):
        jobs.read(path)
    path.write_text(text.replace("[0, 0, 0]", "[0, -1, 0]").replace('name = "tcp"', 'name = "3-axis"'))
    with pytest.raises(jobs.JobError, match=r"orientation \[0.0, -1.0, 0.0\]: machine 3-axis holds the tool along z"):
        jobs.run(jobs.read(path), write=False)
