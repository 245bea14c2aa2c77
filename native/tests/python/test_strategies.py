"""The table of strategies: each through the function, riffler.plan.find and the command line; curves from files."""

import json
from dataclasses import replace

import numpy as np
import pytest
import riffler
from riffler import Tool, plan
from riffler.cli import main

PROFILE = np.array([(0, 0), (40, 0), (40, 24), (20, 24), (20, 8), (0, 8)], float)  # y, z
BALL = Tool.ball(diameter=6, length=25)
GRAVER = Tool.ball(diameter=1, length=10).with_shank([(10, 2, 30, 2)])
CURVE = np.array([(5, 10, 8), (30, 12, 8), (55, 5, 8)], float)
TOOLS = {"part": "ball:6:25", "curves": "ball:1:10", "paths": "ball:6:25"}  # by what a strategy starts from


def step():
    """A part with one inner edge along x, at y = 20, z = 8."""
    ends = [np.column_stack([np.full(6, x), PROFILE]) for x in (0, 60)]
    caps = np.array([(0, 5, 4), (0, 4, 1), (1, 4, 3), (1, 3, 2)])
    sides = [(k, (k + 1) % 6, 6 + k) for k in range(6)] + [((k + 1) % 6, 6 + (k + 1) % 6, 6 + k) for k in range(6)]
    return riffler.Mesh(np.concatenate(ends), np.concatenate([caps, caps[:, ::-1] + 6, sides]))


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    step().write("step.stl")
    np.savetxt("curve.txt", CURVE)
    plan.save("paths.json", plan.find("pencil", riffler.Mesh.read("step.stl"), BALL).plan)
    return tmp_path


def given(strategy):
    found = {"curves": [CURVE], "paths": plan.load("paths.json").paths}
    return found.get(strategy.needs, ())


def command(strategy, *words):
    more = {"curves": ["--curves", "curve.txt"], "paths": ["--paths", "paths.json"]}.get(strategy.needs, [])
    return main(["plan", strategy.id, "step.stl", "--tool", TOOLS[strategy.needs], *more, "--out", "out.json", *words])


# ---- the table


def test_every_strategy_describes_itself():
    assert {"pencil", "engrave", "swarf"} <= set(plan.STRATEGIES)
    for name, strategy in plan.STRATEGIES.items():
        assert name == strategy.id and strategy.label and strategy.action and strategy.description and strategy.summary
        assert strategy.needs == "part" or strategy.missing, name
        for p in strategy.parameters:
            assert p.label and p.help and p.unit in ("mm", "rad", ""), (name, p.key)
            assert ("mm" in p.help) == (p.unit == "mm" and not p.choices), (name, p.key)
            assert p.choices or p.default is None or p.low <= p.default <= p.high, (name, p.key)
        keys = [p.key for p in strategy.parameters]
        assert len(set(keys)) == len(keys) and "tolerance" in keys


@pytest.mark.parametrize("name", plan.STRATEGIES)
def test_find_and_the_command_line_write_the_same_bytes(folder, capsys, name):
    strategy = plan.STRATEGIES[name]
    assert command(strategy) == 0
    part = riffler.Mesh.read("step.stl")
    tool = plan.load("out.json").tool
    shares = []
    found = plan.find(name, part, tool, given(strategy), name="step.stl", progress=shares.append)
    assert found.plan.paths and not found.reason and shares and shares == sorted(shares) and shares[-1] == 1
    assert plan.dumps(found.plan) == (folder / "out.json").read_bytes()
    capsys.readouterr()
    assert command(strategy, "--json") == 0
    data = json.loads(capsys.readouterr().out)
    assert (
        data["paths"] == len(found.plan.paths) and data["tolerance"] == found.plan.tolerance and name in data["seconds"]
    )


def test_the_functions_give_what_the_strategies_give(folder):
    part = riffler.Mesh.read("step.stl")
    (path,) = plan.pencil(part, BALL)
    (same,) = plan.find("pencil", part, BALL).plan.paths
    assert np.array_equal(path.centres, same.centres)
    (line,) = plan.engrave([CURVE], GRAVER, part, depth=0.3)
    found = plan.find("engrave", part, GRAVER, [CURVE])
    assert np.allclose(plan.poses_of(found.plan.paths[0]), line.poses, atol=1e-12) and found.plan.depths == {0: 0.3}
    wall = max((plan.swarf(path, BALL, part, side=side) for side in (0, 1)), key=lambda w: w.path.axes[:, 2].mean())
    (cut,) = plan.find("swarf", part, BALL, [path]).plan.paths
    assert np.array_equal(cut.axes, wall.path.axes) and np.allclose(cut.axes, (0, 0, 1), atol=1e-6)
    assert sorted(cut.keys) == list(range(len(cut)))


@pytest.mark.parametrize(
    ("name", "given", "more", "message"),
    [
        ("drill", (), {}, f"strategy must be one of {', '.join(plan.STRATEGIES)}, not 'drill'"),
        ("engrave", (), {}, "given: engrave needs curves, and there are none"),
        ("pencil", (), {"depth": 1}, "depth: pencil has tolerance, minimum_length, passes, stepover"),
        ("swarf", [0], {"side": "third"}, "side must be one of better, first, second, not 'third'"),
        ("engrave", [CURVE + 100], {}, "curve 0, point 0 is .* more than reach"),
    ],
)
def test_find_names_what_it_refuses(name, given, more, message):
    with pytest.raises(ValueError, match=message):
        plan.find(name, step(), BALL, given, **more)


# ---- swarf


def test_swarf_keeps_the_walls_that_the_flank_fits_with_a_note():
    part = step()
    (path,) = plan.pencil(part, BALL)
    path = path.divided(1)
    bent = np.array(path.centres)
    bent[:20, 1] -= 2.0  # there the ball stands away from the wall, and so does the flank
    bent = plan.PencilPath(3.0, bent, path.contacts, path.normals)
    wall = 0 if abs(path.normals[0, 0, 2]) < 0.5 else 1
    found = plan.find("swarf", part, BALL, [bent], side=("first", "second")[wall])
    (kept,) = found.plan.paths
    assert len(kept) == len(path) - 20 and kept.interpolation == "slerp"
    assert found.notes == [
        f"The flank fits the wall along {kept.length:.1f} of {bent.length:.1f} mm; the rest is left out"
    ]


def test_swarf_without_a_wall_gives_the_reason():
    part = step()
    (path,) = plan.pencil(part, BALL)
    away = plan.PencilPath(3.0, path.centres + np.array([0, -1, 1]), path.contacts, path.normals)
    found = plan.find("swarf", part, BALL, [away])
    assert found.plan.paths == [] and "fits no wall within 0.05 mm" in found.reason


def test_swarf_refuses_a_tool_without_the_paths_ball():
    part = step()
    paths = plan.pencil(part, BALL)
    with pytest.raises(ValueError, match='tip of a "flat" cutter is not a ball'):
        plan.find("swarf", part, Tool.flat(6, 25), paths)
    with pytest.raises(ValueError, match="the paths are those of a ball of 6 mm, not of 4 mm"):
        plan.find("swarf", part, Tool.ball(4, 25), paths)


# ---- engraved paths in a plan


def engraved(depth=0.3, tool=GRAVER):
    return plan.find("engrave", step(), tool, [CURVE], depth=depth).plan


@pytest.mark.parametrize("tool", [GRAVER, Tool.cone_end(0.2, 0.5, 0.1, 4, 20), Tool.flat(1, 10)])
def test_an_engraved_plan_reads_back_with_its_poses(tool):
    made = engraved(tool=tool)
    data = plan.dumps(made)
    read = plan.loads(data)
    assert plan.dumps(read) == data and read.depths == {0: 0.3} and b'"version": 2' in data
    (line,) = plan.engrave([CURVE], tool, step(), depth=0.3)
    assert np.allclose(plan.poses_of(read.paths[0]), line.poses, atol=1e-12)
    assert np.allclose(read.paths[0].contacts[:, 0], line.contacts) and read.deepest == 0.3
    assert replace(read, off=frozenset({0})).deepest == 0


def test_a_plan_without_depths_is_of_version_1():
    assert b'"version": 1' in plan.dumps(plan.find("pencil", step(), BALL).plan)


@pytest.mark.parametrize(
    ("depths", "message"),
    [({1: 0.1}, "depths: there is no path 1"), ({0: -1.0}, r"depths\[0\] must be finite and not negative")],
)
def test_meaningless_depths_are_refused(depths, message):
    with pytest.raises(ValueError, match=message):
        plan.dumps(replace(engraved(), depths=depths))
    bare = plan.find("pencil", step(), BALL).plan
    with pytest.raises(ValueError, match="depths: path 0 has no axes"):
        plan.dumps(replace(bare, depths={0: 0.1}))


def test_a_plan_of_version_1_has_no_depths():
    data = plan.dumps(engraved()).replace(b'"version": 2', b'"version": 1').replace(b'"depth": 0.3', b'"depth": "any"')
    assert plan.loads(data).depths == {}  # as an unknown member


@pytest.mark.parametrize(("text", "message"), [("-0.3", "not negative"), ('"deep"', "a number")])
def test_the_error_of_a_broken_depth_names_the_place(text, message):
    data = plan.dumps(engraved()).replace(b'"depth": 0.3', f'"depth": {text}'.encode())
    with pytest.raises(riffler.FormatError, match=rf"paths\[0\]\.depth: {message}"):
        plan.loads(data)


def test_kept_locations_are_the_poses_and_find_what_a_shank_meets():
    made, collider = engraved(), riffler.Collider(step())
    rows, report = plan.kept_locations(made.paths[0], GRAVER, collider, depth=0.3)
    assert report.ok and np.array_equal(rows, plan.poses_of(made.paths[0])) and not report.lift.any()
    shallow = plan.kept_locations(made.paths[0], GRAVER, collider, depth=0.2)[1]
    assert len(shallow.blocked) == len(made.paths[0]) and "cutter meets the part" in shallow.blocked[0][1]
    wide = GRAVER.with_holder([(12, 15, 40, 15)])  # the wall is 8 to 15 mm away, and 16 mm high
    report = plan.kept_locations(made.paths[0], wide, collider, depth=0.3)[1]
    assert not report.ok and "holder meets the part" in report.blocked[0][1]


def test_chords_over_a_round_part_are_within_twice_the_tolerance():
    ball = riffler.Volume.sphere((0, 0, 0), 20.0, 0.5, "xyz").to_mesh()
    a = np.linspace(0, 2 * np.pi, 80)
    ring = np.column_stack([9 * np.cos(a), 9 * np.sin(a), np.full(80, 18.0)])
    for tolerance in (0.01, 0.05):
        found = plan.find("engrave", ball, GRAVER, [ring], tolerance=tolerance).plan
        report = plan.kept_locations(found.paths[0], GRAVER, riffler.Collider(ball), depth=0.3, tolerance=tolerance)[1]
        assert report.ok and report.bound >= -0.3 - 2 * tolerance


def test_locations_of_poses_are_those_of_the_path():
    part, collider = step(), riffler.Collider(step())
    (path,) = plan.pencil(part, BALL)
    path = path.divided(5).orient({0: (0, -0.6, 0.8)})
    rows, report = plan.cutter_locations(path, BALL, collider)
    same, other = plan.cutter_locations(plan.poses_of(path), BALL, collider)
    assert np.allclose(rows, same, atol=1e-12) and np.array_equal(report.points, other.points)
    task = riffler.submit(riffler.plan.cutter_locations, plan.poses_of(path), BALL, collider)
    assert np.array_equal(task.result()[0], same)
    with pytest.raises(ValueError, match="path: has no poses"):
        plan.cutter_locations(np.empty((0, 6)), BALL, collider)
    with pytest.raises(ValueError, match="poses, row 0: the axis"):
        plan.cutter_locations([[0, 0, 0, 0, 0, 2]], BALL, collider)


def test_an_engraved_plan_becomes_code_that_cuts_to_its_depth(folder, capsys):
    assert command(plan.STRATEGIES["engrave"]) == 0
    assert main(["nc", "post", "out.json", "--post", "tcp", "--out", "plain.ngc", "--json"]) == 0
    assert (
        main(["nc", "post", "out.json", "--part", "step.stl", "--post", "tcp", "--out", "a.ngc", "--spindle", "9000"])
        == 0
    )
    assert "enters step.stl by up to 0.3 mm" in " ".join(capsys.readouterr().out.split())
    read = riffler.Program.read("a.ngc")
    cut = read.poses[(read.poses[:, 2] < 8)]
    (line,) = plan.engrave([CURVE], Tool.ball(1, 10), riffler.Mesh.read("step.stl"), depth=0.3)
    for row in line.poses:
        assert np.linalg.norm(cut[:, :3] - row[:3], axis=1).min() < 1e-3
    words = [
        "verify",
        "a.ngc",
        "--stock",
        "step.stl",
        "--pitch",
        "0.2",
        "--tool",
        "ball:1:10",
        "--part",
        "step.stl",
        "--json",
    ]
    capsys.readouterr()
    assert main([*words, "--gouge", "0.35"]) == 0
    capsys.readouterr()
    assert main(words) == 1
    assert "gouge" in capsys.readouterr().out


def test_a_shank_that_would_hit_is_refused_and_nothing_is_lifted(folder, capsys):
    assert command(plan.STRATEGIES["engrave"]) == 0
    words = [
        "nc", "post", "out.json", "--part", "step.stl", "--holder", "12:15:40:15", "--post", "tcp", "--out", "a.ngc",
    ]  # fmt: skip
    capsys.readouterr()
    assert main([*words, "--json"]) == 2
    said = json.loads(capsys.readouterr().out)["error"]
    assert "places that no lift frees" in said and "another depth or tilt" in said
    assert not (folder / "a.ngc").exists()


def test_a_fixture_that_the_cutter_enters_less_deep_than_the_part_is_refused(folder, capsys):
    assert command(plan.STRATEGIES["engrave"]) == 0
    words = [
        "nc", "post", "out.json", "--part", "step.stl", "--fixture", "block.rvol", "--post", "tcp", "--out", "a.ngc",
    ]  # fmt: skip
    for y, status in ((12.6, 0), (12.4, 2)):  # the groove's edge is at 12.5
        riffler.Volume.block([28, y, 8], [32, 16, 12], 0.1, "xyz").save("block.rvol")
        capsys.readouterr()
        assert main([*words, "--json"]) == status
    assert "places that no lift frees" in json.loads(capsys.readouterr().out)["error"]


# ---- curves from files


def write(tmp_path, name, text):
    (tmp_path / name).write_text(text)
    return tmp_path / name


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.txt", "# two curves\n0 0 0\n1 0 0 # a corner\n1 1 0\n\n\n5 5 5\n6 5 5\n"),
        ("a.csv", "0,0,0\n1,0,0\n1;1;0\n\n5, 5, 5\n6, 5, 5"),
        ("a.json", "[[[0, 0, 0], [1, 0, 0], [1, 1, 0]], [[5, 5, 5], [6, 5, 5]]]"),
        ("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2 3\nv 5 5 5\nv 6 5 5\nl -2 -1\n"),
        ("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 5 5 5\nv 6 5 5\nl 2 3\nl 4/4 5/5\nl 2 1\n"),
    ],
)
def test_curves_are_read(tmp_path, name, text):
    curves = plan.read_curves(write(tmp_path, name, text))
    wanted = [[(0, 0, 0), (1, 0, 0), (1, 1, 0)], [(5, 5, 5), (6, 5, 5)]]
    assert [sorted(map(tuple, curve)) for curve in curves] == wanted
    assert all(np.abs(np.diff(curve, axis=0)).sum(axis=1).max() == 1 for curve in curves)


def test_a_ring_of_edges_is_one_curve_that_ends_where_it_begins(tmp_path):
    text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nl 1 2\nl 3 4\nl 2 3\nl 4 1\n"
    (ring,) = plan.read_curves(write(tmp_path, "ring.obj", text))
    assert len(ring) == 5 and np.array_equal(ring[0], ring[-1])


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.txt", "0 0 0\n1 0\n", "a.txt: line 2: three numbers expected"),
        ("a.txt", "0 0 0\n1 0 nan\n", "a.txt: line 2: three numbers expected"),
        ("a.txt", "", "a.txt: no curve"),
        ("a.txt", "1 2 3\n", "a.txt: curve 0 has one point only"),
        ("a.json", "{}", "a.json: a list of curves expected"),
        ("a.json", "[[[0, 0, 0], [1, 0]]]", "a.json: curve 0, point 1: three numbers expected"),
        ("a.json", "[", "a.json: .*line 1"),
        ("a.obj", "v 0 0 0\nv 1 0 0\nf 1 2 2\n", "a.obj: no polyline"),
        ("a.obj", "v 0 0 0\nl 1 2\n", "a.obj: line 2: 2 is not a vertex above it"),
        ("a.obj", "v 0 0 0\nl 1\n", "a.obj: line 2: two vertices or more expected"),
    ],
)
def test_the_error_of_a_file_without_curves_names_the_place(tmp_path, name, text, message):
    with pytest.raises(riffler.FormatError, match=message):
        plan.read_curves(write(tmp_path, name, text))


def test_another_kind_of_file_is_refused(tmp_path):
    with pytest.raises(ValueError, match=r"a\.dxf: \.obj or"):
        plan.read_curves(write(tmp_path, "a.dxf", ""))
