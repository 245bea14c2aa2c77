"""`riffler bench`: that a short run of everything works, that its figures are what they say, and that it can fail."""

import itertools
import json
import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import riffler
import riffler_bench
from riffler import cli
from riffler.command import bench as command
from riffler_bench import _bench as core
from riffler_bench import (
    baselines,
    curves,
    errors,
    exact,
    measure,
    nc_judge,
    nc_programs,
    parts,
    remesh,
    report,
    scenes,
    swept,
    valleys,
    waves,
)
from riffler_bench.jobs import JOBS, b5x, force, gouge, nc
from riffler_bench.jobs import pencil as pen
from riffler_bench.jobs import verify as verifying
from verify_reference import HeightMap

PATHS = [*(str(Path(p.__file__).parents[1]) for p in (riffler, riffler_bench)), os.environ.get("PYTHONPATH", "")]
ENVIRONMENT = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, PATHS))}
PLOTS = {
    *("b200", "b5x", "b5x-tolerance", "b5x-single", "haptic", "rendered", "session", "force", "pitch", "mesh"),
    *("col", "col-budgets", "col-slide", "pencil", "pencil-tolerance", "gouge", "nc", "verify", "surfaces"),
}
ROOT = Path(__file__).resolve().parents[3]
BPY = ROOT / ".envs" / "bpy-4.5" / "bin" / "python"


RUN = [sys.executable, "-m", "riffler", "bench"]
FORKING = [sys.executable, str(Path(__file__).with_name("bench_children.py"))] if hasattr(os, "fork") else RUN


def bench(*words: object, cwd: Path, run: list[str] = RUN, **more: str) -> subprocess.CompletedProcess:
    command = [*run, *map(str, words)]
    return subprocess.run(
        command, cwd=cwd, env=ENVIRONMENT | more, capture_output=True, text=True, timeout=3000, check=False
    )


@pytest.fixture(scope="module")
def quick(tmp_path_factory) -> Path:
    """The folder of one quick run of every job. Its measurements are forked, those of the run without matplotlib are
    started."""
    folder = tmp_path_factory.mktemp("bench")
    done = bench("--quick", "--no-plots", "--json", "--out", "out", cwd=folder, run=FORKING)
    jobs = json.loads(done.stdout)["jobs"]
    assert done.returncode == 0, {name: job["problems"] for name, job in jobs.items() if job["problems"]}
    assert set(jobs) == set(JOBS)
    return folder / "out"


def rows(folder: Path, job: str, section: str) -> list[dict]:
    return json.loads((folder / f"{job}.json").read_text())["sections"][section]["rows"]


def test_help_and_completion_know_every_job():
    assert list(command.NAMES) == list(JOBS)


def test_every_job_writes_its_figures(quick):
    for job in JOBS:
        data = json.loads((quick / f"{job}.json").read_text())
        assert data["quick"] and data["problems"] == [] and data["processor"] and data["cores"] >= 1
        for name, section in data["sections"].items():
            assert section["rows"] or section["notes"], f"{job}/{name}"
            text = (quick / f"{job}.md").read_text()
            assert f"<!-- bench {job}/{name} -->" in text
    assert "**Failed:**" not in "".join(path.read_text() for path in quick.glob("*.md"))


def test_five_axis_errors_are_measured_and_within_their_tolerance(quick):
    table = rows(quick, "b5x", "path")
    assert {row["cutter"] for row in table} == {cutter.name for cutter in scenes.cutters()}
    for row in table:
        assert 0 < row["rms_mm"] <= row["max_mm"] <= row["tolerance"]
        assert row["wrong"] == 0 and row["ends"] > 20
        assert row["move_s"] > 0 and row["ratio"] > 0
    assert all(row["max_mm"] < 1e-6 for row in rows(quick, "b5x", "single") if not row["angle"])


def test_rivals_that_are_missing_are_named(quick):
    engines = [row["engine"] for row in rows(quick, "b200", "rivals")]
    assert any(engine.startswith("OpenVDB: left out") for engine in engines)
    assert any(engine.startswith("numpy height map") for engine in engines)


def test_meshes_of_b200_are_clean_and_their_error_falls(quick):
    table = rows(quick, "mesh", "b200")
    mine = [row for row in table if row["engine"].startswith("Riffler")]
    assert {(row["engine"], row["pitch"]) for row in mine} == {
        (f"Riffler {mode}", pitch) for mode in ("tri-dexel", "z") for pitch in (1.0, 0.5)
    }
    assert all(row["bad"] == row["others"] == 0 and row["triangles"] > 1000 for row in mine)
    missing = {row["engine"] for row in table if "left out" in row["engine"]}
    assert len(missing) == 6 and any(name.startswith("OpenVDB volumeToMesh: left out") for name in missing)
    for directions, least in (("xyz", 1.0), ("z", 0.5)):
        fine = next(r for r in rows(quick, "mesh", "error") if r["directions"] == directions and r["pitch"] == 0.5)
        assert fine["rms_order"] > least
    boxes = {row["engine"]: row for row in rows(quick, "mesh", "edges")}
    assert 0 < boxes["Riffler tri-dexel"]["edges_largest_mm"] < 0.02 < boxes["Riffler z"]["edges_largest_mm"]
    assert all(row["peak_bytes"] > 1e6 for row in rows(quick, "mesh", "memory") if "mesh_s" in row)


def test_parts_become_volumes_and_fewer_triangles(quick):
    table = rows(quick, "stl", "rays")
    mine = {row["part"]: row for row in table if row["engine"] == "Riffler"}
    assert len(mine) == 2 and all(abs(row["difference"]) < 0.02 and row["rate"] > 0 for row in mine.values())
    assert sum("left out" in row["engine"] for row in table) == 3 * len(mine)
    table = rows(quick, "decimate", "parts")
    mine = {row["part"]: row for row in table if row["engine"] == "Riffler"}
    assert set(mine) == {"organic", "sharp"} and all(row["bad"] == 0 for row in mine.values())
    assert 0.05 < mine["organic"]["max_mm"] < 5 and mine["sharp"]["max_mm"] < 1e-6
    assert sum("left out" in row["engine"] for row in table) == 6


def test_meshes_with_a_tolerance_keep_it_and_need_few_triangles(quick):
    table = rows(quick, "detail", "tolerances")
    mine = [row for row in table if "there_mm" in row]
    assert {row["directions"] for row in mine} == {"xyz", "z"} and len(mine) == 6
    for row in mine:
        assert max(row["there_mm"], row["back_mm"]) <= row["tolerance"] * (1 + 1e-9)
        assert row["bad"] == row["others"] == 0 and row["fewer"] > 5
    fine = rows(quick, "detail", "growth")[1]
    assert fine["full_order"] > 1.9 > fine["order"]
    assert sum("left out" in row["engine"] for row in rows(quick, "detail", "rivals")) == 4
    assert [row["part"] for row in rows(quick, "detail", "parts")] == ["S500k, first 20 000 moves"]


def test_pencil_curves_are_found_where_they_are_known_and_nowhere_else(quick):
    table = rows(quick, "pencil", "valleys")
    mine = {row["part"]: row for row in table if row["engine"] == "Riffler"}
    assert mine["90° groove"]["paths"] == "1 (1)" and mine["90° groove"]["hausdorff_mm"] < 0.01
    assert mine["175° groove"]["paths"] == mine["box"]["paths"] == "0 (0)"
    assert mine["T-slot"]["missed"] == 0 and mine["pocket"]["paths"] == "8 (8)"
    # The map of heights sees nothing below an overhang.
    blind = next(row for row in table if row["part"] == "T-slot" and row["engine"].startswith("second difference"))
    assert blind["missed"] == 1
    for row in rows(quick, "pencil", "tolerance"):
        assert row["hausdorff_mm"] < row["tolerance"] + 1e-3
    for row in rows(quick, "pencil", "scale"):
        assert row["part"] != "sphere" or row["steps"] == 0


def test_the_drop_job_names_a_missing_oracle(quick):
    table = rows(quick, "drop", "points")
    assert {row["cutter"] for row in table} == {"cylindrical", "ball", "bull nose", "cone"}
    assert all(row["rate"] > 100 and "OpenCAMLib: left out" in row["note"] for row in table)


@pytest.mark.parametrize("part", valleys.parts(), ids=lambda part: part.name)
def test_a_ball_on_a_known_curve_touches_every_mesh_of_its_part_at_both_contacts(part):
    for k, way in enumerate(remesh.WAYS):
        case = pen.case(part, way, 40 + k, moved=10.0 * k)
        audit = case.mesh.audit()
        assert audit.components == 1 and audit.volume > 0
        assert not any(
            getattr(audit, name) for name in ("open_edges", "nonmanifold_edges", "nonmanifold_vertices", "folds")
        )
        for curve in case.true:
            every = slice(None, None, max(1, len(curve.centres) // 200))
            centres, contacts = curve.centres[every], curve.contacts[every]
            np.testing.assert_allclose(np.linalg.norm(contacts - centres[:, None], axis=2), valleys.R, atol=1e-11)
            off = core.mesh_distances(np.ascontiguousarray(contacts.reshape(-1, 3)), case.mesh)
            room = core.mesh_distances(np.ascontiguousarray(centres), case.mesh)
            assert off.max() <= case.facets + 1e-9
            assert abs(room - valleys.R).max() <= case.facets + 1e-9


def test_distances_of_curves_are_those_of_every_point_from_every_segment():
    rng = np.random.default_rng(3)
    walk = np.cumsum(rng.normal(size=(300, 3)), axis=0)
    segments = curves.Segments.of([walk, walk[:40] + 5], [False, True])
    points = rng.normal(size=(2000, 3)) * 8
    distance, which, share = segments.nearest(points)
    way = segments.end - segments.begin
    every = curves.apart(points, segments.begin, segments.end)[0]
    np.testing.assert_allclose(distance, every.min(1), rtol=1e-12)
    at = segments.begin[which] + share[:, None] * way[which]
    np.testing.assert_allclose(np.linalg.norm(points - at, axis=1), distance, rtol=1e-9)
    # A line against one next to it that is longer at one end, and against nothing.
    line = curves.Segments(np.array([[0.0, 0, 0]]), np.array([[10.0, 0, 0]]))
    longer = curves.Segments(np.array([[0.0, 0, 0.01]]), np.array([[12.0, 0, 0.01]]))
    result = curves.compare(longer, line, 0.02)
    assert result.hausdorff == pytest.approx(np.hypot(2, 0.01), rel=1e-12)
    assert result.missed == 0 and result.false == pytest.approx(2, abs=0.02)
    nothing = curves.compare(curves.Segments.of([], []), line, 0.02)
    assert nothing.hausdorff is None and nothing.missed == pytest.approx(10)


def test_baselines_find_the_valleys_within_their_power():
    case = pen.case(valleys.groove(90), "fine", 1, upright=True)
    sharp, chains = baselines.Creases.of(case.mesh, valleys.R).sharper(30)
    assert chains == 1 and curves.compare(sharp, case.lines, 0.01, 0.02).hausdorff < 1e-9
    bent, chains = baselines.HeightMap.of(case.mesh, valleys.R).bent(0.03)
    found = curves.compare(bent, case.lines, 0.01 + baselines.PIXEL, 0.02)
    assert chains == 1 and found.missed == found.false == 0


def test_parts_made_in_code_are_closed_and_have_the_volume_of_their_shape():
    star = parts.sharp(5_000)
    outline = [(34 if k % 2 else 50) * np.exp(2j * np.pi * k / 16) for k in range(17)]
    area = sum((a.conjugate() * b).imag for a, b in itertools.pairwise(outline)) / 2
    layers = round((len(star.triangles) / 12) ** 0.5)
    heights = [(layers // 3), (2 * layers // 3 - layers // 3 - 1), (layers - 2 * layers // 3 - 1)]
    stacked = sum(h * s * s for h, s in zip(heights, (1, 0.8, 0.55), strict=True)) * 60 / (layers - 2)
    assert star.volume == pytest.approx(area * stacked, rel=1e-12)
    for part in (star, parts.organic(5_000)):
        audit = part.audit()
        assert audit.components == 1 and audit.volume > 0
        assert not any(
            getattr(audit, name) for name in ("open_edges", "nonmanifold_edges", "nonmanifold_vertices", "folds")
        )


def test_the_exact_part_matches_its_description():
    rng = np.random.default_rng(7)
    # Known places: faces, an edge and a corner of the block, the groove's bottom and its end, deep inside.
    mid = exact.centres()[100]
    points = {
        (-0.5, 20, 10): 0.5,
        (50, 61, 30.75): 1.25,
        (-0.3, -0.4, 31.2): 1.3,
        tuple(mid - [0, 0, 2.9]): 0.1,
        (50, 5, 29.5): 0.5,
    }
    np.testing.assert_allclose(exact.from_surface(np.array(list(points))), list(points.values()), atol=2e-3)
    # Near the groove, compared with a search for the nearest of the points that are inside or outside by the cutter's
    # definition alone: balls and cylinders above them at very many places of the path.
    t = np.linspace(0, scenes.MOVES, 40 * scenes.MOVES + 1)
    path = np.stack([np.interp(t, np.arange(scenes.MOVES + 1), exact.centres()[:, k]) for k in range(3)], 1)

    def solid(p: np.ndarray) -> bool:
        near = path[abs(path[:, 0] - p[0]) < 3.01]
        low = near[:, 2] - np.sqrt(np.maximum(9 - ((near[:, :2] - p[:2]) ** 2).sum(1), 0))
        beside = ((near[:, :2] - p[:2]) ** 2).sum(1) >= 9
        return bool(np.all((p >= 0) & (p <= exact.UPPER)) and np.all(beside | (low > p[2])))

    at = path[rng.integers(0, len(path), 60)] + rng.uniform([-4, -4, -4], [4, 4, 1.5], (60, 3))
    distance, signed = exact.from_surface(at), exact.bound(at)
    for p, d, side in zip(at, distance, signed, strict=True):
        if d > 1.5:
            continue
        assert solid(p) == (side < 0) or d < 1e-4
        directions = rng.normal(size=(300, 3))
        directions /= np.linalg.norm(directions, axis=1)[:, None]
        assert all(solid(q) == (side < 0) for q in p + 0.995 * d * directions)
        # Something of the other kind is hardly further away than that.
        step = 1e-4
        gradient = [(exact.from_surface(np.array([p + e, p - e])) @ [1, -1]) / (2 * step) for e in step * np.eye(3)]
        foot = p - (d + 2e-3) * np.array(gradient) / np.linalg.norm(gradient)
        assert solid(foot) != (side < 0)
    field, origin = exact.field(1.0)
    lattice = np.stack(np.meshgrid(*(np.arange(n) for n in field.shape), indexing="ij"), -1)
    bound = exact.bound((origin + lattice).reshape(-1, 3)).reshape(field.shape)
    close = abs(bound) < 1.9
    np.testing.assert_allclose(field[close], bound[close], atol=1e-6)
    assert np.array_equal(np.sign(field), np.sign(bound))


def test_contact_is_measured_judged_and_compared(quick):
    table = rows(quick, "col", "times")
    mine = [row for row in table if row["engine"] == "Riffler"]
    assert {(row["tool"], row["what"]) for row in mine} == {
        (tool, what) for tool in ("long", "short") for what in ("depth, force and torque", "signed distance")
    }
    assert all(0 < row["median_s"] <= row["p99_s"] and row["disagree"] == 0 for row in mine)
    assert {row["engine"].split(":")[0] for row in table if "left out" in row["engine"]} == {"FCL", "Coal"}
    for row in rows(quick, "col", "errors"):
        assert row["points"] >= 20_000 and row["outside"] == 0
        assert -1e-9 <= row["sampled_min_mm"] <= row["sampled_max_mm"] <= row["spacing_mm"]
    assert all(row["violated"] == 0 for row in rows(quick, "col", "budgets"))
    parts = rows(quick, "col", "parts")
    assert {row["part"] for row in parts} >= {"bore", "wall", "box", "prism", "needles"}
    assert all(row["in_doubt"] < 1 and row["mean_s"] > 0 and row["away_s"] > 0 for row in parts)
    budgets = rows(quick, "col", "part-budgets")
    assert {row["part"] for row in budgets} == {row["part"] for row in parts}
    assert all(row["violated"] == 0 and row["missed_max_mm"] <= row["bound_max_mm"] + 1e-9 for row in budgets)
    steps = rows(quick, "col", "slide")
    assert [round(row["step_mm"], 3) for row in steps] == [0.4, 0.2]
    assert max(steps[0]["reference_z_N"]) > 0 and max(steps[0]["reference_x_N"]) > 0


def test_paths_in_a_vise_are_free_of_gouges_between_their_rows(quick):
    table = rows(quick, "gouge", "paths")
    assert [row["part"] for row in table[:3]] == [f"{name}: left out, --quick" for name in gouge.MODELS]
    assert {row["rule"] for row in table[3:]} == set(gouge.RULES)
    for row in table[3:]:
        assert row["after_mm"] <= row["proven_mm"] <= gouge.TOLERANCE + 2e-5
        assert row["after_mm"] <= row["bound_mm"] + 1e-9 and row["judged"] > 1000
    bad = table[-1]
    assert bad["lifted"] > 10 and bad["inserted"] > 10 and bad["before_mm"] > 1
    assert all(0 < row["look_s"] < 1 for row in rows(quick, "gouge", "times"))
    touching = rows(quick, "gouge", "touching")
    assert len(touching) == 7
    assert all(0 < row[key] <= 1e-9 for row in touching for key in ("plane_mm", "ball_mm", "rod_mm", "contact_mm"))


def test_a_tool_that_gouges_between_its_rows_is_detected():
    part = parts.sharp(800)
    tool, jaw = gouge.the_tool(), swept.Box(np.array([60.0, -10, 0]), np.array([70.0, 10, 20]))
    judge = swept.Judge(part, [jaw], tool, 70)
    rows = np.array([[55.0, 0, 10, 0, 0, 1], [75.0, 0, 10, 0, 0, 1]])
    poses, moves = swept.dense(rows, 0.05, 0.01)
    assert len(poses) == 401 and set(moves) == {0}
    entry = judge.entries(poses)
    # In the middle of the move the jaw's top, 10 mm up the cutter, reaches its axis.
    assert judge.entries(rows)[:, 0].max() == 0
    assert entry[:, 0].max() == pytest.approx(3, abs=2e-3) and np.all(entry[:, 1] >= entry[:, 0])
    assert swept.surface([jaw]).volume == pytest.approx(10 * 20 * 20)
    turned = np.array([[0, 0, 90, 1, 0, 0], [0, 0, 90, 0, 0, -1.0]])
    between, _ = swept.dense(turned, 1, np.radians(1))
    np.testing.assert_allclose(between[45, 3:], [0.5**0.5, 0, -(0.5**0.5)], atol=1e-12)
    within = np.array([[65.0, 0, 5 - 70, 0, 0, 1]])
    assert judge.holds_top(within).all() and not judge.holds_top(rows).any()


def test_code_is_read_written_and_true_between_its_blocks(quick):
    assert {row["kind"] for row in rows(quick, "nc", "reader")} == set(nc_programs.CODE)
    for row in rows(quick, "nc", "reader") + rows(quick, "nc", "writer"):
        assert row["rate"] > 0 and (row["note"].startswith("rs274: ") or row["rs274_s"] > 0)
        assert row.get("off_mm", 0) < 1e-9
    for row in rows(quick, "nc", "between"):
        assert 0 < row["axis_rad"] <= row["axis_tolerance"] and 0 < row["tip_mm"] <= row["tolerance"] + 2e-5
        assert row["blocks"] >= row["rows"] + 2
    assert all(5 < row["row_bytes"] < 60 for row in rows(quick, "nc", "file"))


@pytest.mark.parametrize("post", nc.KINEMATICS)
def test_the_judge_of_code_detects_wrong_blocks(tmp_path, post):
    poses, file = nc_programs.paths(60)["smooth"], tmp_path / "p.ngc"
    program = riffler.Program.from_cl([poses], tools=[nc.TOOL], feed=800)
    options = nc.AS_ROWS if post == "tcp" else nc.TABLE | nc.AS_ROWS
    program.write(file, post=post, tolerance=1e-3, axis_tolerance=1e-4, options=options)
    joints = nc_judge.joints_of(file.read_text())
    found = nc_judge.between(joints, poses, nc.KINEMATICS[post])
    assert found["at_mm"] < 2e-5 and found["tip_mm"] <= 1.02e-3 and found["axis_rad"] <= 1.001e-4
    # Blocks between the rows left out.
    rows = nc_judge.ends(nc_judge.poses(joints, nc.KINEMATICS[post]), poses)
    bare = nc_judge.between(joints[rows], poses, nc.KINEMATICS[post])
    assert bare["axis_rad"] > 4e-4 and (bare["tip_mm"] > 4e-3 or post == "tcp")
    # Signs and axes exchanged.
    for change in ([1, 1, 1, -1, -1, 1], [1, 1, 1, 1, 1, -1]):
        with pytest.raises(ValueError, match="no block ends at row"):
            nc_judge.between(joints * change, poses, nc.KINEMATICS[post])
    other = {"linuxcnc-xyzac": "linuxcnc-xyzbc", "linuxcnc-xyzbc": "tcp", "tcp": "linuxcnc-xyzac"}[post]
    with pytest.raises(ValueError, match="no block ends at row"):
        nc_judge.between(joints, poses, nc.KINEMATICS[other])


def test_verification_is_timed_together_with_its_error(quick):
    for program in ("three axes", "five axes"):
        coarse, fine = (row for row in rows(quick, "verify", "pitch") if row["program"] == program)
        assert coarse["pitch"] == 2 * fine["pitch"] and 0 < coarse["verify_bytes"] < fine["verify_bytes"]
        assert 0 < fine["rms_mm"] < coarse["rms_mm"] / 2 and fine["max_mm"] < coarse["max_mm"]
        for row in (coarse, fine):
            assert row["at_rays_mm"] < (0.01 if program == "five axes" else 1e-8) and row["cpu_s"] > 0
            assert abs(row["removed_over"]) < 1e-3 and 0 < row["uncertain"] < 1e-3
    for row in rows(quick, "verify", "gouges"):
        assert row["found"] == row["gouges"] == 3 and row["error_mm"] < row["sag_mm"] + 0.01 * verifying.DIP
    table = rows(quick, "verify", "speed")
    assert [row["threads"] for row in table] == [1, 2] * 4 + [1, 1] and all(row["rate"] > 100 for row in table)
    held = rows(quick, "verify", "holder")
    assert [row["hits"] > 0 for row in held] == [False, False, True] and held[2]["hits"] >= held[2]["rows"] - 1
    edits = rows(quick, "verify", "edit")
    assert len(edits) == 4 and all(row["same"] and row["moves"] < edits[0]["moves"] / 5 for row in edits[1:])
    short, long = (row for row in rows(quick, "verify", "memory") if row["given"] == "as a stream")
    # 16 bytes a block, and the volume that is cut in both.
    assert long["verify_bytes"] - short["verify_bytes"] < 60 * (long["rows"] - short["rows"]) + 4e6


def test_material_left_by_a_ball_agrees_with_a_height_map():
    rng = np.random.default_rng(2)
    tips = np.column_stack([rng.uniform(-4, 34, (40, 2)), rng.uniform(-9, 1, 40)])
    tips[10:14, :2] = tips[10, :2]  # plunges and retracts
    heights = HeightMap([0, 0, -waves.DEEP], [30, 20, 0], 0.5)
    for a, b in itertools.pairwise(tips):
        heights.cut((waves.RADIUS, waves.RADIUS), a, b)
    points = np.stack(np.broadcast_arrays(heights.x, heights.y), -1).reshape(-1, 2)
    left = waves.left(scenes.upright(tips), points).reshape(heights.z.shape)
    np.testing.assert_allclose(left, heights.z, atol=1e-7)
    # Turning about a tip that moves: balls at very many places of the path.
    turning = np.array([[10.0, 8, -4, *scenes.unit([0.5, -0.2, 1])], [14.0, 11, -5, 0, 0, 1]])
    centres = (poses := swept.dense(turning, 1e-3, 1e-3)[0])[:, :3] + waves.RADIUS * poses[:, 3:]
    near = points[np.linalg.norm(points - [12, 9.5], axis=1) < 4]
    square = waves.RADIUS**2 - ((near[:, None] - centres[:, :2]) ** 2).sum(-1)
    low = np.where(square >= 0, centres[:, 2] - np.sqrt(np.maximum(square, 0)), 0).min(1)
    np.testing.assert_allclose(waves.left(turning, near), np.minimum(low, 0), atol=3e-3)
    deep = square.max(1) > 1  # where the ball is not steep
    np.testing.assert_allclose(waves.left(turning, near)[deep], low[deep], atol=2e-6)


def test_the_volume_above_a_surface_cut_by_a_ball_is_known():
    groove = scenes.upright(np.array([[-9.0, 50.3, -3], [109.0, 50.3, -3]]))
    exact = waves.Exact.of(groove, 150)
    assert exact.removed == pytest.approx(np.pi * 9 / 2 * waves.SIZE, abs=4 * exact.uncertain)
    assert 0 < exact.uncertain < 2
    # A surface that is bilinear already has no error; one that is too high has that.
    flat = waves.Exact(exact.points, exact.points @ [0.1, -0.2], 0, 0)
    at = (np.arange(50) + 0.5) * 2
    plane = 0.1 * at[:, None] - 0.2 * at[None] + 0.25
    np.testing.assert_allclose(flat.between(plane, 2.0), 0.25, atol=1e-12)


def test_waves_are_the_same_in_pieces_and_their_part_is_closed():
    whole = waves.poses(700, 20, True)
    pieces = [program.poses for program in waves.chunks(700, 20, True, 100)]
    assert all(np.array_equal(a[-1], b[0]) for a, b in itertools.pairwise(pieces))
    np.testing.assert_array_equal(np.concatenate([pieces[0], *(p[1:] for p in pieces[1:])]), whole)
    np.testing.assert_allclose(
        whole[:, :3] + waves.RADIUS * whole[:, 3:],
        waves.poses(700, 20, False)[:, :3] + [0, 0, waves.RADIUS],
        atol=1e-12,
    )
    audit = waves.part(40).audit()
    assert audit.components == 1 and audit.volume > 0
    assert not any(
        getattr(audit, name) for name in ("open_edges", "nonmanifold_edges", "nonmanifold_vertices", "folds")
    )


@pytest.mark.skipif(not BPY.exists(), reason="no .envs/bpy-4.5 (make envs)")
def test_the_add_on_is_measured_in_blender(tmp_path):
    out = tmp_path / "out"
    done = bench("blender", "--quick", "--json", "--out", out, "--blender", BPY, cwd=ROOT)  # the add-on is there
    assert done.returncode == 0, done.stderr
    stroke, full = rows(out, "blender", "stroke")
    assert full["shown"] == full["triangles"] == stroke["triangles"] > 50 * stroke["shown"]
    assert full["bytes"] > 5 * stroke["bytes"]
    # 1.2 mm of a ball's path touch as many tiles in sculpts of any size, counting those whose borders it passed.
    assert stroke["events"] == 30 and 1 <= stroke["bricks"] < 12 and stroke["moved"] > 0
    assert 0 < full["moved"] < full["triangles"] / 3
    assert abs(stroke["removed_over"]) < 0.01 and 0 < stroke["p50_s"] <= stroke["p95_s"]
    (undo,) = rows(out, "blender", "undo")
    assert all(undo[f"{name}_s"] > 0 for name in ("undo", "undo_second", "undo_first", "undo_other"))
    brushes = rows(out, "blender", "sculpt")
    assert [row["brush"] for row in brushes] == ["draw brush", "draw brush, dyntopo"]
    assert all(row["reached_mm"] > 10 and row["ratio"] > 0 for row in brushes)
    mine, *solvers = rows(out, "blender", "boolean")
    assert mine["engine"] == "Riffler" and abs(mine["removed_over"]) < 0.01
    assert len(solvers) >= 2 and all(abs(row["removed_over"]) < 0.01 for row in solvers)
    ours, theirs = rows(out, "blender", "export")
    assert ours["bytes"] == theirs["bytes"] == 84 + 50 * ours["triangles"]
    assert (out / "blender.png").stat().st_size > 10_000


def test_the_job_reports_a_missing_blender(quick):
    assert "none was named" in rows(quick, "blender", "stroke")[0]["where"]


def test_haptic_work_does_not_grow_with_the_grid(quick):
    table = rows(quick, "haptic", "steps")
    small, large = (next(r for r in table if r["side"] == side and r["axis"] == "upright") for side in (1024, 1280))
    assert small["rays_tested"] == large["rays_tested"] >= small["rays_changed"] > 5_000
    assert len(small["times_s"]) == small["count"]


def test_haptic_scenes_touch_parts_of_long_triangles(quick):
    touching = {row["scene"]: row["touching"] for row in rows(quick, "haptic", "rendered")}
    assert touching["bore"] == touching["box"] == 1


def test_three_directions_are_compared_with_one(quick):
    for row in rows(quick, "haptic", "directions"):
        assert row["ratio"] == pytest.approx(row["xyz_s"] / row["z_s"]) and 0 < row["xyz_s"] <= row["p99_s"]
        assert 1 < row["work"] < 10


def test_a_busy_machine_is_measured_with_and_without_real_time(quick):
    normal, asked = rows(quick, "haptic", "busy")
    assert normal["level"] == 0 and asked["level"] == riffler.pen.real_time().level
    for row in (normal, asked):
        assert row["count"] > 10
        assert row["p50_s"] <= row["p99_s"] <= row["p999_s"] <= row["max_s"]
        assert row["late_p50_s"] <= row["late_p99_s"] <= row["late_p999_s"] <= row["late_max_s"]


def test_exact_surfaces_are_compared_with_tessellations(quick):
    exact, *flat = rows(quick, "surfaces", "torus")
    assert exact["depth_mm"] < 1e-6 and exact["cl_mm"] < 1e-6 and exact["ripple"] < 1e-3
    assert [row["depth_mm"] <= row["tolerance"] for row in flat] == [True] * len(flat) and len(flat) >= 2
    assert all(row["ripple"] > 10 * exact["ripple"] for row in flat)


def test_plots_are_drawn_from_the_figures(quick):
    pytest.importorskip("matplotlib")
    done = bench("--redraw", "--out", quick, "--json", cwd=quick)
    assert done.returncode == 0, done.stderr
    drawn = {Path(name).stem for names in json.loads(done.stdout)["plots"].values() for name in names}
    assert drawn == PLOTS
    for name in PLOTS:
        data = (quick / f"{name}.png").read_bytes()
        assert data.startswith(b"\x89PNG") and len(data) > 10_000


def test_jobs_run_without_matplotlib_and_report_it(tmp_path):
    (tmp_path / "matplotlib.py").write_text("raise ModuleNotFoundError('no matplotlib', name='matplotlib')\n")
    hidden = os.pathsep.join([str(tmp_path), ENVIRONMENT["PYTHONPATH"]])
    done = bench("threads", "--quick", "--out", "out", cwd=tmp_path, PYTHONPATH=hidden)
    assert done.returncode == 0
    assert "no plots: matplotlib is not installed" in done.stderr
    assert (tmp_path / "out" / "threads.json").exists()
    assert bench("--redraw", "--out", "out", cwd=tmp_path, PYTHONPATH=hidden).returncode == 2


@pytest.mark.parametrize(
    "package, said",
    [
        (None, f"needs riffler-bench {riffler.__version__}: in a checkout of that version, pip install ./bench"),
        ("9.9", f"riffler-bench 9.9 needs riffler 9.9, not {riffler.__version__}: install both from the same source"),
    ],
)
def test_the_command_names_a_package_that_is_missing_or_of_another_version(package, said, tmp_path):
    """`package`: the version of a riffler_bench that is found first; None: as if there were none."""
    (tmp_path / "riffler_bench").mkdir()
    begin = tmp_path / "riffler_bench" / "__init__.py"
    if package is None:
        begin.write_text("raise ModuleNotFoundError('none', name='riffler_bench')\n")
    else:
        begin.write_bytes(Path(riffler_bench.__file__).read_bytes())
        (tmp_path / "riffler_bench" / "_bench.py").write_text(f"__version__ = {package!r}\n")
    found_first = os.pathsep.join([str(tmp_path), ENVIRONMENT["PYTHONPATH"]])
    done = bench("b5x", "--out", "out", cwd=tmp_path, PYTHONPATH=found_first)
    assert done.returncode == 2
    assert said in done.stderr
    assert not (tmp_path / "out").exists()


def test_the_old_name_of_the_package_warns_and_works():
    code = "import warnings; warnings.simplefilter('error'); import riffler.bench"
    done = subprocess.run([sys.executable, "-c", code], env=ENVIRONMENT, capture_output=True, text=True, check=False)
    assert "DeprecationWarning: riffler.bench is riffler_bench now" in done.stderr
    with pytest.warns(DeprecationWarning, match="riffler_bench"):
        from riffler.bench import nc_judge
    assert nc_judge.Axes


def test_an_unknown_job_is_bad_input(tmp_path):
    done = bench("b2000", cwd=tmp_path)
    assert done.returncode == 2
    assert "b2000" in done.stderr and "b5x" in done.stderr
    assert not list(tmp_path.iterdir())


def test_a_wrong_result_is_exit_status_1(tmp_path, monkeypatch, capsys):
    class Wrong:
        @staticmethod
        def run(settings, progress):
            out = report.Report("wrong")
            out.section("table", "A table", report.Column("x", "x")).row(x=1)
            out.check(False, "the bytes differ")
            return out

    monkeypatch.setitem(JOBS, "wrong", Wrong)
    assert cli.main(["bench", "wrong", "--no-plots", "--out", str(tmp_path)]) == 1
    assert "the bytes differ" in capsys.readouterr().err
    assert "**Failed:** the bytes differ" in (tmp_path / "wrong.md").read_text()


def test_a_coarser_carve_is_detected_as_an_error():
    cutter = scenes.cutters()[0]
    poses = cutter.path(turning=True)
    volume = riffler.Volume.block(*scenes.BLOCK, 1.0)
    volume.carve(cutter.tool, poses, tolerance=1.0)
    out = report.Report("b5x")
    figures = b5x.compare(out, "coarse", volume, cutter.tool, poses, 1e-4, 100)
    assert figures["max_mm"] > 1e-4 and len(out.problems) == 1
    assert errors.measured(volume, cutter.tool, poses, 1.0, 100)["max_mm"] <= 1.0


def test_scenes_match_their_descriptions():
    path = scenes.cutters()[0].path(turning=False)
    a = np.linspace(0, 1, 201)
    centres = np.stack([10 + 80 * a, 30 + 15 * np.sin(12 * a), 30 - 2 * a], 1)
    np.testing.assert_allclose(path[:, :3] + [0, 0, 3], centres, atol=1e-12)
    for cutter in scenes.cutters():
        turning = cutter.path(turning=True)
        np.testing.assert_allclose(turning[:, :3] + cutter.centre_height * turning[:, 3:], centres, atol=1e-12)
        np.testing.assert_allclose(np.linalg.norm(turning[:, 3:], axis=1), 1, atol=1e-12)
        assert math.degrees(np.arccos(turning[:, 5].min())) == pytest.approx(30, abs=1)
    for ramping in (False, True):
        tips = scenes.s500k(500_000, ramping)[:, :3]
        way = np.linalg.norm(np.diff(tips[:, :2], axis=0), axis=1)
        assert np.count_nonzero(abs(way - 0.4) > 1e-9) == 13  # the plunges from layer to layer
        assert tips.min() > 0 - 1e-9 and np.all(tips <= np.array([100, 60, 20]) + 1e-9)
    for motion in scenes.motions():
        before, after = motion.poses[:, 3:]
        turned = math.atan2(float(np.linalg.norm(np.cross(before, after))), float(before @ after))
        assert math.degrees(turned) == pytest.approx(motion.angle, abs=1e-9)


def test_the_yardstick_is_timed_together_with_the_work():
    yardstick = measure.Yardstick(1.0, quick=True)
    loop = core.CapsuleLoop(1.0)

    def ten_loops(_):
        for _ in range(10):
            loop.run()

    timing, _ = yardstick.beside(loop.reset, ten_loops)
    assert timing.repeats >= 1
    assert 4 < timing.ratio < 25  # ten; the machine is shared


def test_the_force_of_a_groove_has_its_closed_form():
    times, felt = force.stroke(riffler.Tool.ball(6, 30), 0.1, 200)
    steady = felt[times > 0.15]
    assert steady.mean() == pytest.approx(force.CONSTANT * force.SPEED * force.section("ball"), rel=2e-3)


def test_figures_are_written_in_units_that_suit_them():
    assert [report.micro(s) for s in (2.5, 0.0123, 45.6e-6, 7e-9)] == ["2.5 s", "12.3 ms", "45.6 µs", "7 ns"]
    assert measure.quantile([3, 1, 2, 4], 0.99) == 4
    assert b5x.slope([{"tolerance": t, "e": 3 * t**1.5} for t in (0.1, 0.01, 0.001)], "e") == pytest.approx(1.5)
    table = report.Section("t", "T", [report.Column("a", "a"), report.Column("b", "b", report.ratio)])
    table.row(a="x", b=np.float64(3.14159))
    table.row(a="y")
    assert table.markdown() == "| a | b |\n|---|---|\n| x | 3.14 × |\n| y |  |\n"
    assert command.HELP
