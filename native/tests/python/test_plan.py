"""Planning: orientations, lifts, cutter locations, free orientations, plan files and the command that writes them."""

import itertools
import json
import os
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest
import riffler
from riffler import plan
from riffler.cli import main
from riffler.plan.strategies import pencil as pencil_strategy

MODELS = Path(__file__).resolve().parents[3].parent / "shared" / "models"
UP = np.array([0.0, 0.0, 1.0])


def box(lower, upper):
    corners = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=float)
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    triangles = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    lower, upper = np.asarray(lower, float), np.asarray(upper, float)
    return lower + corners * (upper - lower), triangles


def mesh(*boxes):
    vertices, triangles = [], []
    for v, t in boxes:
        triangles.append(t + sum(map(len, vertices)))
        vertices.append(v)
    return riffler.Mesh(np.vstack(vertices), np.vstack(triangles))


FLOOR, WALL = box((0, -20, -5), (30, 20, 0)), box((-10, -20, -5), (0, 20, 30))


def corner(points=9, radius=3.0, closed=False):
    """The ball's path where the floor z = 0 meets the wall x = 0."""
    y = np.linspace(-10, 10, points)
    ones = np.ones(points)
    centres = np.stack([radius * ones, y, radius * ones], axis=1)
    contacts = np.stack([centres - [0, 0, radius], centres - [radius, 0, 0]], axis=1)
    normals = np.broadcast_to([[[0.0, 0, 1], [1, 0, 0]]], (points, 2, 3))
    return plan.PencilPath(radius, centres, contacts, normals, closed=closed)


def leaning(angle):
    return np.array([np.sin(angle), 0, np.cos(angle)])


# ---- paths and their orientations


def test_a_path_keeps_the_arrays_that_it_was_made_from():
    path = corner(5, closed=True)
    assert len(path) == 5 and path.closed and path.radius == 3
    assert path.contacts.shape == (5, 2, 3) and np.array_equal(path.contacts[:, 0, 2], np.zeros(5))
    assert np.array_equal(path.normals[2], [[0, 0, 1], [1, 0, 0]])
    assert path.axes.shape == (0, 3) and path.keys == {} and path.interpolation == ""
    assert path.length == pytest.approx(40)


@pytest.mark.parametrize(("step", "points"), [(100.0, 2), (20.0, 2), (7.0, 4), (0.5, 41)])
def test_a_divided_path_has_points_to_set_keys_at(step, points):
    path = corner(2).divided(step)
    assert len(path) == points and path.length == pytest.approx(20, abs=1e-12)
    assert path.centres[:, 1] == pytest.approx(np.linspace(-10, 10, points), abs=1e-12)
    assert path.contacts[:, 0] == pytest.approx(path.centres - [0, 0, 3], abs=1e-12)
    assert np.linalg.norm(path.normals, axis=2) == pytest.approx(1, abs=1e-12)


def test_a_divided_loop_goes_round_and_keeps_its_points():
    loop = corner(9, closed=True)
    path = loop.divided(1.0)
    assert path.closed and path.length == pytest.approx(loop.length, abs=1e-12)
    assert np.linalg.norm(np.diff(path.centres, axis=0, append=path.centres[:1]), axis=1).max() <= 1 + 1e-12
    assert all((path.centres == c).all(1).any() for c in loop.centres)
    for step, message in ((0, "positive"), (float("nan"), "positive"), (1e-9, "ten million")):
        with pytest.raises(ValueError, match=message):
            loop.divided(step)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"radius": 0}, "radius must be positive"),
        ({"centres": np.zeros((0, 3))}, "centres: at least one"),
        ({"centres": np.zeros((5, 2))}, r"centres must have the shape \(n, 3\)"),
        ({"contacts": np.zeros((4, 2, 3))}, r"contacts must have the shape \(5, 2, 3\)"),
        ({"contacts": np.full((5, 2, 3), np.nan)}, "contacts, row 0: not finite"),
        ({"normals": np.zeros((5, 2, 3))}, "normals, row 0: not a unit vector"),
    ],
)
def test_a_path_refuses_bad_arrays(change, message):
    path = corner(5)
    given = {"radius": 3.0, "centres": path.centres, "contacts": path.contacts, "normals": path.normals} | change
    with pytest.raises(ValueError, match=message):
        plan.PencilPath(**given)


@pytest.mark.parametrize("rule", ["linear", "slerp", "smooth"])
def test_keys_are_kept_to_the_bit_and_any_axis_can_become_a_key(rule):
    path = corner().orient({2: leaning(0.2), 6: leaning(1.0)}, interpolation=rule)
    assert np.array_equal(path.axes[:3], [leaning(0.2)] * 3) and np.array_equal(path.axes[6:], [leaning(1.0)] * 3)
    assert np.allclose(np.linalg.norm(path.axes, axis=1), 1, atol=1e-15)
    assert np.allclose(path.axes[4], leaning(0.6), atol=1e-12)
    adjusted = path.orient({**path.keys, 4: leaning(0.3)}, interpolation=rule)
    assert np.array_equal(adjusted.axes[4], leaning(0.3)) and sorted(adjusted.keys) == [2, 4, 6]
    assert sorted(path.keys) == [2, 6], "the path itself is unchanged"


@pytest.mark.parametrize(
    ("keys", "more", "message"),
    [
        ({}, {}, "at least one"),
        ({9: UP}, {}, "point 9: the path has 9 points"),
        ({-1: UP}, {}, "point -1: indices begin at 0"),
        ({"a": UP}, {}, "point a: the index must be a whole number"),
        ({1: (0, 0, 3)}, {}, "point 1: not a unit vector"),
        ({1: (0, 0, np.nan)}, {}, "point 1 must be finite"),
        ({1: UP, 4: -UP}, {}, "point 4: opposite to the key at point 1"),
        ({0: UP}, {"interpolation": "cubic"}, 'not "cubic"'),
        ({0: leaning(0.5)}, {"limit": (UP, 0.4)}, "limit, point 0"),
        ({0: UP}, {"limit": (UP, 4.0)}, "limit: the angle"),
        ({0: UP}, {"limit": 3}, "limit must be"),
        ([UP], {}, "must be a dict"),
    ],
)
def test_orient_names_what_it_refuses(keys, more, message):
    with pytest.raises(ValueError, match=message):
        corner().orient(keys, **more)


def test_a_limit_projects_axes_on_request():
    path = corner().orient({0: UP, 8: leaning(1.0)}, interpolation="slerp", limit=(UP, 0.5), project=True)
    assert np.allclose(path.axes[4:], leaning(0.5), atol=1e-12) and np.allclose(path.axes[2], leaning(0.25), atol=1e-12)


def test_frames_lean_and_axis_agree():
    path = corner()
    x, y, z = path.frames[4]
    assert np.allclose(x, [0, 1, 0]) and np.allclose(z, np.sqrt([0.5, 0, 0.5])) and np.allclose(y, np.cross(z, x))
    axis = path.axis(4, 0.3, -0.2)
    assert path.lean(4, axis) == pytest.approx((0.3, -0.2))
    assert np.allclose(axis, np.cos(-0.2) * (np.sin(0.3) * x + np.cos(0.3) * z) + np.sin(-0.2) * y)
    with pytest.raises(ValueError, match="the path has 9 points"):
        path.axis(9, 0, 0)


def test_nearest_finds_the_contact_for_a_point_and_for_a_ray():
    path = corner()
    picked = path.nearest((3.2, 0.1, -1))
    assert picked.index == 4 and picked.side == 0 and np.array_equal(picked.normal, UP)
    picked = path.nearest((20, 2.4, 3.1), direction=(-1, 0, 0))
    assert picked.index == 5 and picked.side == 1 and picked.distance == pytest.approx(np.hypot(0.1, 0.1))


# ---- contact to location, lift, drop


def test_contact_locations_of_a_fillet_follow_the_corrected_formula():
    axis, normal = leaning(0.3), UP
    pose = plan.contact_locations([[1, 2, 3]], [normal], [axis], riffler.Tool.fillet(8, 1, 30))[0]
    across = normal - (normal @ axis) * axis
    assert np.allclose(pose[:3], np.array([1, 2, 3]) + normal + 3 * across / np.linalg.norm(across) - axis, atol=1e-12)
    with pytest.raises(ValueError, match="contacts, row 1: only the cutter's upper end"):
        plan.contact_locations(np.zeros((2, 3)), [UP, UP], [UP, -UP], riffler.Tool.flat(6, 20))
    with pytest.raises(ValueError, match="axes must have 1 rows"):
        plan.contact_locations(np.zeros((1, 3)), [UP], [UP, UP], riffler.Tool.flat(6, 20))


def test_a_lift_leaves_free_poses_and_blocked_ones_alone():
    collider = riffler.Collider(mesh(FLOOR))
    poses = [[15, 0, 1, *UP], [15, 0, -2, *UP], [15, 0, -2, *leaning(0.5)]]
    lifted, report = plan.lift(poses, riffler.Tool.ball(6, 30), collider)
    expected = (3 - (-2 + 3 * np.cos(0.5))) / np.cos(0.5)
    assert report.lift == pytest.approx([0, 2, expected], abs=1e-8) and report.free.all()
    assert np.allclose(lifted[2, :3], [15, 0, -2] + expected * leaning(0.5))
    assert report.before[1] == pytest.approx(-2) and report.pieces == ["cutter"] * 3
    same, report = plan.lift(poses, riffler.Tool.ball(6, 30), collider, max_lift=1)
    assert report.free.tolist() == [True, False, False] and np.array_equal(same, poses)


def test_drop_lands_where_opencamlib_does():
    ocl = pytest.importorskip("opencamlib")
    if not MODELS.is_dir():
        pytest.skip("no models to drop on")
    for name in ("fandisk", "ktoolcav", "ktoolcor"):
        part = riffler.Mesh.read(MODELS / f"{name}.stl")
        lower, upper = part.bounds
        size = float(max(upper - lower))
        points = np.random.default_rng(1).uniform(lower, upper, (300, 3))
        surface = ocl.STLSurf()
        for triangle in part.vertices[part.triangles]:
            surface.addTriangle(ocl.Triangle(*(ocl.Point(*map(float, v)) for v in triangle)))
        d, length, low = size / 12, 10 * size, float(lower[2]) - 5 * size
        for theirs, ours in (
            (ocl.BallCutter(d, length), riffler.Tool.ball(d, length)),
            (ocl.CylCutter(d, length), riffler.Tool.flat(d, length)),
            (ocl.BullCutter(d, d / 5, length), riffler.Tool.fillet(d, d / 5, length)),
            (ocl.ConeCutter(d, 0.6, length), riffler.Tool.taper(0.0, 0.6, d, length)),
        ):
            batch = ocl.BatchDropCutter()
            batch.setSTL(surface)
            batch.setCutter(theirs)
            for x, y, _ in points:
                batch.appendPoint(ocl.CLPoint(float(x), float(y), low))
            batch.run()
            z = np.array([p.z for p in batch.getCLPoints()])
            heights, contacts = plan.drop(points, ours, part)
            met = ~np.isnan(heights)
            assert np.array_equal(met, z > low + 1e-9)
            off = heights[met] - z[met]
            if ours.kind != "taper":
                assert np.abs(off).max() < 1e-6, (name, ours.kind)
                continue
            # OpenCAMLib's cone sinks into some edges: never above ours, and where below, our contact is inside of it.
            assert off.min() > -1e-6
            at, contact = points[met][off > 1e-6], contacts[met][off > 1e-6]
            rho = np.linalg.norm((contact - at)[:, :2], axis=1)
            up = contact[:, 2] - z[met][off > 1e-6]
            assert (rho < d / 2 + 1e-9).all() and (up > rho / np.tan(0.6)).all()


def test_drop_gives_nan_next_to_the_part():
    heights, contacts = plan.drop([[15, 0, 0], [100, 0, 0]], riffler.Tool.ball(6, 30), mesh(FLOOR))
    assert heights[0] == 0 and np.isnan(heights[1]) and np.isnan(contacts[1]).all()
    sideways, _ = plan.drop([[0, 0, -2]], riffler.Tool.ball(6, 30), mesh(FLOOR), axis=(1, 0, 0))
    assert sideways[0] == 30


# ---- cutter locations


def test_cutter_locations_go_into_a_program():
    tool = riffler.Tool.ball(6, 30)
    path = corner().orient({0: leaning(0.6), 8: leaning(0.9)})
    cl, report = plan.cutter_locations(path, tool, riffler.Collider(mesh(FLOOR, WALL)))
    assert cl.shape == (9, 6) and report.ok and not len(report.lifted) and not len(report.inserted)
    assert np.allclose(cl[:, :3], path.centres - 3 * path.axes, atol=1e-12)
    assert report.points.tolist() == list(range(9)) and report.bound >= -0.01
    program = riffler.Program.from_cl([cl], tools=[tool], feed=600, spindle=8000)
    assert np.allclose(program.poses[1:-1], cl)


def test_cutter_locations_lift_over_a_fixture_and_report_it():
    tool = riffler.Tool.ball(6, 30)
    clamp = riffler.Volume.block((1, -2, 0), (20, 2, 6), 0.5)
    collider = riffler.Collider(mesh(FLOOR), fixtures=[clamp])
    path = corner(5).orient({0: leaning(0.6)})
    cl, report = plan.cutter_locations(path, tool, collider, tolerance=0.1)
    assert report.ok and report.bound >= -0.1
    assert report.depth_before.max() > 1 and "fixture" in [report.pieces[k] for k in report.lifted]
    assert len(report.inserted) > 0 and set(report.points) == {-1, 0, 1, 2, 3, 4}
    for a, b in itertools.pairwise(cl):
        for t in np.linspace(0, 1, 9):
            pose = np.array([*((1 - t) * a[:3] + t * b[:3]), *leaning(0.6)])
            assert collider.query(tool, pose).depth <= 0.1 + 1e-9
    again, _ = plan.cutter_locations(path, tool, collider, tolerance=0.1)
    assert np.array_equal(cl, again)


def test_cutter_locations_are_the_same_for_any_number_of_threads(monkeypatch):
    path = corner(5).orient({0: leaning(0.3), 4: leaning(-0.2)})
    collider = riffler.Collider(mesh(FLOOR, WALL))
    results = []
    for threads in ("1", "3"):
        monkeypatch.setenv("RIFFLER_THREADS", threads)
        results.append(plan.cutter_locations(path, riffler.Tool.fillet(8, 1, 30), collider, tolerance=0.1)[0])
    assert results[0].tobytes() == results[1].tobytes()


def test_blocked_points_are_reported_and_left_out():
    lid = box((-10, -3, 5), (30, 20, 300))
    path = corner(5).orient({0: UP})
    cl, report = plan.cutter_locations(path, riffler.Tool.ball(6, 20), riffler.Collider(mesh(FLOOR, lid)), max_lift=5)
    assert not report.ok and [k for k, _ in report.blocked] == [1, 2, 3, 4] and len(cl) == 1
    assert "the cutter meets the part" in report.blocked[0][1] and "not free within 5 mm" in report.blocked[0][1]
    assert "a lift only pushes the tool into the material" in report.blocked[1][1]


def test_cutter_locations_can_be_cancelled_and_refuse_a_path_without_axes():
    collider = riffler.Collider(mesh(FLOOR, WALL))
    with pytest.raises(riffler.Cancelled):
        plan.cutter_locations(
            corner().orient({0: UP}), riffler.Tool.ball(6, 30), collider, progress=lambda share: False
        )
    with pytest.raises(ValueError, match="has no axes"):
        plan.cutter_locations(corner(), riffler.Tool.ball(6, 30), collider)
    with pytest.raises(ValueError, match="tolerance must be a positive length"):
        plan.cutter_locations(corner().orient({0: UP}), riffler.Tool.ball(6, 30), collider, tolerance=0)


# ---- free orientations


def test_the_map_in_a_corner_is_free_between_the_walls():
    collider = riffler.Collider(mesh(FLOOR, WALL))
    found = plan.free_orientations(corner(), riffler.Tool.ball(6, 20), collider, index=4)
    assert found.clearance.shape == found.free.shape == (21, 21) and found.axes.shape == (21, 21, 3)
    inside = (found.axes[..., 0] >= 0) & (found.axes[..., 2] >= 0)
    assert found.free[inside].all() and not found.free[found.axes[..., 0] < -0.05].any()
    assert np.allclose(found.suggestion, np.sqrt([0.5, 0, 0.5])) and found.reason == ""
    several = plan.free_orientations(corner(), riffler.Tool.ball(6, 20), collider, index=[0, 4], limit=(UP, 0.5))
    assert [m.index for m in several] == [0, 4]
    beyond = np.arccos(np.clip(several[1].axes @ UP, -1, 1)) > 0.5 + 1e-9
    assert np.isnan(several[1].clearance[beyond]).all() and not several[1].free[beyond].any()


def test_no_free_orientation_is_an_answer_with_its_reason():
    collider = riffler.Collider(mesh(FLOOR, WALL, box((-10, -20, 5), (30, 20, 12))))
    found = plan.free_orientations(corner(), riffler.Tool.ball(6, 20), collider, index=4)
    assert found.suggestion is None and not found.free.any()
    assert found.reason.startswith("the cutter enters the part with every axis, at best by ")
    path, report = plan.min_tilt(corner(), riffler.Tool.ball(6, 20), collider)
    assert path is None and report.point == 0 and "no orientation is free" in report.reason


def test_min_tilt_leans_the_tool_round_a_post():
    collider = riffler.Collider(mesh(FLOOR, WALL, box((10, -1, 8), (40, 1, 40))))
    tool = riffler.Tool.ball(6, 30)
    grid = np.linspace(-1, 1, 11)
    path, report = plan.min_tilt(corner(), tool, collider, inclinations=grid, tilts=grid, max_change=0.5)
    assert report.found and report.angles[4] > 0.1
    changes = np.arccos(np.clip(np.sum(path.axes[1:] * path.axes[:-1], axis=1), -1, 1))
    assert changes.max() <= 0.5 + 1e-9
    for centre, axis in zip(path.centres, path.axes, strict=True):
        assert collider.query(tool, [*(centre - 3 * axis), *axis]).depth <= 0.01


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"inclinations": []}, "inclinations: at least one"),
        ({"tilts": [0.1, 0.1]}, "tilts, row 1: not more than"),
        ({"tilts": [2.0]}, "tilts, row 0: not within"),
        ({"tolerance": -1}, "tolerance must be finite"),
    ],
)
def test_maps_refuse_meaningless_grids(more, message):
    with pytest.raises(ValueError, match=message):
        plan.free_orientations(corner(), riffler.Tool.ball(6, 20), riffler.Collider(mesh(FLOOR)), index=4, **more)


def test_a_map_is_drawn(tmp_path):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    found = plan.free_orientations(
        corner(), riffler.Tool.ball(6, 20), riffler.Collider(mesh(FLOOR, WALL)), index=4, limit=(UP, 1.0)
    )
    plan.draw_map(found).figure.savefig(tmp_path / "map.png")
    assert (tmp_path / "map.png").stat().st_size > 5000


# ---- plan files


def some_plan():
    part = mesh(FLOOR, WALL)
    tool = riffler.Tool.ball(6, 30).with_holder([(40, 10, 60, 10)]).named("six")
    path = corner().orient({0: leaning(0.6), 8: leaning(0.9)}, limit=(UP, 0.8), project=True)
    cl, _ = plan.cutter_locations(path, tool, riffler.Collider(part))
    return plan.Plan(
        [path, corner(4, closed=True)],
        tool,
        cl=[cl, None],
        part=plan.part_of(part, "part.stl"),
        tolerance=0.01,
        provenance={"by": "a test"},
    )


def test_a_plan_reads_back_to_the_bit(tmp_path):
    before = some_plan()
    plan.save(tmp_path / "a.json", before)
    assert os.listdir(tmp_path) == ["a.json"]
    after = plan.load(tmp_path / "a.json")
    assert after.tool == before.tool and after.part == before.part and after.tolerance == 0.01
    assert after.provenance == {"riffler": riffler.__version__, "by": "a test"}
    for a, b in zip(before.paths, after.paths, strict=True):
        for name in ("centres", "contacts", "normals", "axes"):
            assert getattr(a, name).tobytes() == getattr(b, name).tobytes()
        assert a.closed == b.closed and a.radius == b.radius and a.interpolation == b.interpolation
        assert list(a.keys) == list(b.keys) and all(np.array_equal(a.keys[k], b.keys[k]) for k in a.keys)
    assert np.array_equal(before.cl[0], after.cl[0]) and after.cl[1] is None
    plan.save(tmp_path / "b.json", after)
    assert (tmp_path / "a.json").read_bytes() == (tmp_path / "b.json").read_bytes()


@pytest.mark.parametrize(
    ("where", "value", "message"),
    [
        (("format",), "other", 'format: "riffler-plan" expected'),
        (("version",), 7, "version: 1 or 2 expected, not 7: a newer Riffler"),
        (("version",), "1", "version: 1 or 2 expected, not '1'$"),
        (("units",), {"length": "inch"}, "units: "),
        (("tool",), {"kind": "spoon"}, "tool: kind must be"),
        (("tool",), 3, "tool: "),
        (("tolerance",), "fine", "tolerance: a number expected"),
        (("part",), [], "part: an object expected"),
        (("paths",), {}, "paths: a list expected"),
        (("paths", 0), None, r"paths\[0\]: an object expected"),
        (("paths", 1, "radius"), -1, r"paths\[1\]: radius must be positive"),
        (("paths", 1, "closed"), 1, r"paths\[1\].closed: true or false"),
        (("paths", 1, "off"), "no", r"paths\[1\].off: true or false"),
        (("paths", 0, "centres"), [[1, 2], [3]], r"paths\[0\].centres: an array \(n, 3\) of numbers"),
        (("paths", 0, "centres", 2, 1), None, r"paths\[0\].centres"),
        (("paths", 0, "contacts"), [], r"paths\[0\].contacts: the shape \(9, 2, 3\) expected"),
        (("paths", 0, "axes", 3), [0, 0, 2], r"paths\[0\]: axes, row 3: not a unit vector"),
        (("paths", 0, "interpolation"), "cubic", r"paths\[0\].interpolation"),
        (("paths", 0, "keys", 1, "index"), 99, r"paths\[0\]: keys, point 99"),
        (("paths", 0, "keys", 1, "index"), 1.5, r"paths\[0\].keys\[1\].index: a whole number"),
        (("paths", 0, "cl"), [[1, 2, 3]], r"paths\[0\].cl: the shape \(n, 6\)"),
    ],
)
def test_the_error_of_a_broken_plan_names_the_place(tmp_path, where, value, message):
    plan.save(tmp_path / "a.json", some_plan())
    data = json.loads((tmp_path / "a.json").read_text())
    *way, last = where
    entry = data
    for key in way:
        entry = entry[key]
    entry[last] = value
    (tmp_path / "a.json").write_text(json.dumps(data))
    with pytest.raises(riffler.FormatError, match=r"^a\.json: .*" + message):
        plan.load(tmp_path / "a.json")


@pytest.mark.parametrize("text", [b"", b"{", b"[]", b'{"format": NaN}', b"\xff\xfe", b"[" * 100000])
def test_objects_that_are_no_plans_are_refused(tmp_path, text):
    (tmp_path / "a.json").write_bytes(text)
    with pytest.raises(riffler.FormatError, match=r"^a\.json: "):
        plan.load(tmp_path / "a.json")


def test_a_plan_is_the_same_as_bytes_and_as_a_file(tmp_path):
    before = some_plan()
    data = plan.dumps(before)
    plan.save(tmp_path / "a.json", before)
    assert isinstance(data, bytes) and (tmp_path / "a.json").read_bytes() == data
    for form in (data, bytearray(data), memoryview(data)):
        assert plan.dumps(plan.loads(form)) == data


@pytest.mark.parametrize(("data", "message"), [(b"{", "line 1"), (b"\xff\xfe", ""), (b"[]", "an object expected")])
def test_errors_of_bytes_that_are_no_plan_name_them(data, message):
    with pytest.raises(riffler.FormatError, match=f"^the plan in Block: .*{message}"):
        plan.loads(data, name="the plan in Block")
    with pytest.raises(riffler.FormatError, match=r"^plan: "):
        plan.loads(data)


def test_a_plan_has_a_line_for_each_path():
    lines = plan.dumps(some_plan()).decode().splitlines()
    assert [line[:13] for line in lines].count('  {"radius": ') == 2 and len(lines) == 13
    empty = plan.Plan([], riffler.Tool.ball(6, 30))
    assert plan.loads(plan.dumps(empty)).paths == [] and json.loads(plan.dumps(empty))["paths"] == []


def test_successive_plans_format_only_changed_paths():
    texts, before = plan.Texts(), some_plan()
    assert plan.dumps(before, texts=texts) == plan.dumps(before) and texts.made == 2
    turned = before.paths[1].orient({0: before.paths[1].axis(0, 0.1, 0)})
    after = plan.Plan([before.paths[0], turned], before.tool, cl=[before.cl[0], None])
    assert plan.dumps(after, texts=texts) == plan.dumps(after) and texts.made == 3
    rows = np.array(before.cl[0]) + 1.0
    moved = plan.Plan([turned, before.paths[0]], before.tool, cl=[None, rows])  # another order, other locations
    assert plan.dumps(moved, texts=texts) == plan.dumps(moved) and texts.made == 4
    assert plan.dumps(before, texts=texts) == plan.dumps(before) and texts.made == 6  # only the last is kept


def test_paths_that_are_off_read_back_as_off():
    texts, before = plan.Texts(), some_plan()
    plan.dumps(before, texts=texts)
    after = replace(before, off=frozenset({1}))
    data = plan.dumps(after, texts=texts)
    assert texts.made == 3 and plan.loads(data).off == {1} and data == plan.dumps(plan.loads(data))
    assert plan.loads(plan.dumps(before)).off == frozenset() and b'"off"' not in plan.dumps(before)
    with pytest.raises(ValueError, match="off: there is no path 2: the plan has 2, from 0"):
        plan.dumps(replace(before, off=frozenset({0, 2})))


def test_a_newer_plan_is_refused_as_newer():
    data = plan.dumps(some_plan()).replace(b'"version": 1', b'"version": 3')
    with pytest.raises(riffler.FormatError, match=r"^plan: version: 1 or 2 expected, not 3: a newer Riffler wrote it$"):
        plan.loads(data)


def test_a_plan_that_cannot_be_saved_leaves_nothing(tmp_path):
    with pytest.raises(ValueError, match=r"cl\[0\]"):
        plan.save(tmp_path / "a.json", replace(some_plan(), cl=[np.full((2, 6), np.nan), None]))
    with pytest.raises(ValueError, match="cl: 2 expected"):
        plan.save(tmp_path / "a.json", replace(some_plan(), cl=[None]))
    assert os.listdir(tmp_path) == []


# ---- the command


def run(*words):
    return main(list(words))


def test_pencil_writes_a_plan(tmp_path, monkeypatch, capsys):
    given = {}

    def find(part, tool, **options):
        given.update(options, tool=tool)
        areas = {"rest_area": 0.0, "rest_areas": [], "reference_area": 0.0, "reference_areas": []}
        stats = plan.PencilStats(*[0] * len(fields(plan.PencilStats)))
        return plan.PencilPaths([corner(), corner(4, closed=True)], ends=[], stats=stats, reason="", **areas)

    monkeypatch.setattr(pencil_strategy, "pencil", find)
    mesh(FLOOR, WALL).write(tmp_path / "part.stl")
    monkeypatch.chdir(tmp_path)
    assert (
        run("plan", "pencil", "part.stl", "--tool", "ball:6", "--out", "p.json", "--tolerance", "0.02", "--json") == 0
    )
    data = json.loads(capsys.readouterr().out)
    assert data["paths"] == 2 and data["points"] == 13 and data["closed"] == 1 and data["tolerance"] == 0.02
    assert given["tolerance"] == 0.02 and given["tool"].diameter == 6
    read = plan.load("p.json")
    assert len(read.paths) == 2 and read.part["name"] == "part.stl" and read.tolerance == 0.02
    assert read.part == plan.part_of(riffler.Mesh.read("part.stl"), "part.stl")
    assert run("plan", "pencil", "part.stl", "--tool", "ball:6", "--out", "p.json") == 0
    assert "paths" in capsys.readouterr().out


def test_pencil_finds_the_corner(tmp_path, monkeypatch, capsys):
    mesh(FLOOR, WALL).write(tmp_path / "part.stl")
    monkeypatch.chdir(tmp_path)
    assert run("plan", "pencil", "part.stl", "--tool", "ball:6", "--out", "p.json", "--json") == 0
    data = json.loads(capsys.readouterr().out)
    assert data["paths"] >= 1 and data["length"] == pytest.approx(40, abs=0.5)
    passes = ["--passes", "3", "--stepover", "0.5"]
    assert run("plan", "pencil", "part.stl", "--tool", "ball:6", "--out", "p.json", "--json", *passes) == 0
    assert json.loads(capsys.readouterr().out)["paths"] == 5 * data["paths"]


@pytest.mark.parametrize(
    "words",
    [
        ["nowhere.stl", "--tool", "ball:6", "--out", "p.json"],
        ["part.stl", "--tool", "spoon:6", "--out", "p.json"],
        ["part.stl", "--tool", "ball:6", "--out", "p.txt"],
        ["part.stl", "--tool", "ball:6", "--out", "p.json", "--tolerance", "0"],
        ["part.stl", "--tool", "ball:6", "--out", "p.json", "--passes", "two"],
    ],
)
def test_pencil_refuses_bad_input(tmp_path, monkeypatch, capsys, words):
    mesh(FLOOR, WALL).write(tmp_path / "part.stl")
    monkeypatch.chdir(tmp_path)
    assert run("plan", "pencil", *words, "--json") == 2
    assert "error" in json.loads(capsys.readouterr().out)
    assert os.listdir(tmp_path) == ["part.stl"]
