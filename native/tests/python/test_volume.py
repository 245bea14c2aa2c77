"""riffler.Volume through its public interface: block, from_mesh, carve, snapshot, to_mesh."""

import copy
import dataclasses
import pickle
import threading

import numpy as np
import pytest
import riffler
from hypothesis import given, settings
from hypothesis import strategies as st

UP = [0.0, 0, 1]
BALL = riffler.Tool.ball(6, 30)


def box_mesh(lower, upper):
    lower, upper = np.asarray(lower, float), np.asarray(upper, float)
    corners = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)], float)
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return riffler.Mesh(lower + corners * (upper - lower), triangles)


def clean(mesh):
    audit = mesh.audit()
    names = ("open_edges", "nonmanifold_edges", "nonmanifold_vertices", "degenerate", "duplicates")
    return not any(getattr(audit, n) for n in names)


def test_a_block_has_the_rays_and_spans_of_the_contract():
    v = riffler.Volume.block([1, 2, 3], [11, 6, 5.1], 0.5, "xyz")
    assert (v.pitch, v.directions) == (0.5, "xyz")
    assert v.volume == pytest.approx(10 * 4 * 2.1)
    for direction, shape, ends in (("x", (8, 4), (1, 11)), ("y", (4, 20), (2, 6)), ("z", (20, 8), (3, 5.1))):
        counts, spans = v.intervals(direction)
        assert counts.shape == shape
        assert counts.dtype == np.uint32
        assert np.all(counts == 1)
        assert np.array_equal(spans, np.tile(ends, (counts.size, 1)))


def test_rays_stand_at_the_documented_places():
    """A slanted plane's height identifies each ray by its place."""
    mesh = box_mesh([0, 0, 0], [4, 3, 2])
    vertices = np.array(mesh.vertices)
    vertices[:, 2] += 0.1 * vertices[:, 0] + 0.2 * vertices[:, 1]
    v = riffler.Volume.from_mesh(riffler.Mesh(vertices, mesh.triangles), 0.5, lower=[0, 0, -1], upper=[4, 3, 5])
    counts, spans = v.intervals("z")
    x, y = np.meshgrid((np.arange(8) + 0.5) * 0.5, (np.arange(6) + 0.5) * 0.5, indexing="ij")
    assert np.all(counts == 1)
    assert spans[:, 0] == pytest.approx((0.1 * x + 0.2 * y).ravel(), abs=1e-6)


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (([0, 0, 0], [1, 1, 1], 0), "pitch must be a positive length in mm, not 0"),
        (([0, 0, 0], [1, 1, 1], -1), "pitch must be a positive length in mm, not -1"),
        (([0, 0, 0], [1, 1, 1], np.nan), "pitch must be a positive length in mm, not nan"),
        (([0, 0, 0], [1, 1, 1], np.inf), "pitch must be a positive length in mm, not inf"),
        (
            ([0, 0, 0], [1, 1, 1], 1000),
            "pitch 1000 mm is longer than every side of the box, 1 × 1 × 1 mm: take a finer",
        ),
        (([0, 0, 0], [1, 1, 1], 1e-300), "take a coarser pitch"),
        (([0, 0, 0], [1, 0, 1], 0.1), "lower must be less than upper; along y they are 0 and 0 mm"),
        (([0, 0, 0], [-5, 1, 1], 0.1), "along x they are 0 and -5 mm"),
        (([-1e9, 0, 0], [1e9, 1, 1], 1e6), r"the box is 2e\+09 mm long along x, .* give its size in millimetres"),
        (([0, 0, np.inf], [1, 1, 1], 0.1), r"lower must be finite, not \(0, 0, inf\)"),
        (([0, 0], [1, 1, 1], 0.1), "lower must be three numbers"),
        (([0, 0, 0], [1, 1, 1], 0.1, "xy"), "directions"),
        (
            ([0, 0, 0], [1000, 1000, 10], 1e-4),
            r"pitch 0.0001 mm needs 2000 TB for .*, 1000 × 1000 × 10 mm, and .* GB are",
        ),
    ],
)
def test_every_constructor_of_volumes_refuses_absurd_boxes_and_pitches(arguments, word):
    lower, upper, pitch, *directions = arguments
    for make in (riffler.Volume.block, riffler.Volume.empty):
        with pytest.raises(ValueError, match=word):
            make(*arguments)
    mesh, sound = box_mesh([0, 0, 0], [1, 1, 1]), riffler.Volume.block([0, 0, 0], [1, 1, 1], 0.25)
    with pytest.raises(ValueError, match=word):
        riffler.Volume.from_mesh(mesh, pitch, *directions, lower=lower, upper=upper)
    with pytest.raises(ValueError, match=word):
        sound.resample(pitch, *directions, lower=lower, upper=upper)
    with pytest.raises(ValueError, match=word):
        riffler.submit(riffler.Volume.from_mesh, mesh, pitch, *directions, lower=lower, upper=upper).result()


@pytest.mark.parametrize("directions", ["z", "xyz"])
def test_a_plate_thinner_than_the_pitch_is_a_volume_and_a_mesh(directions):
    """No ray stands within it; the lone one next to it stands for it. Walls between rays are found within half a pitch,
    those that rays end at exactly."""
    low, high = [0, 0, 0], [0.4, 10, 10]
    mesh = box_mesh(low, high)
    for made in (riffler.Volume.block(low, high, 1, directions), riffler.Volume.from_mesh(mesh, 1, directions)):
        assert made.volume == pytest.approx(40)
        surface, found = made.to_mesh_with_report()
        assert len(surface.triangles) and not found.lost_note
        assert surface.bounds == pytest.approx(np.array([low, high]), abs=1e-5 if directions == "xyz" else 0.5 + 1e-5)


def test_removed_is_the_loss_of_volume_and_force_needs_dt():
    v = riffler.Volume.block([0, 0, 0], [40, 20, 10], 0.25)
    poses = np.array([[5 + k, 10, 8 - 0.1 * k, *UP] for k in range(30)])
    before = v.volume
    cut = v.carve(BALL, poses)
    assert cut.removed.shape == (29,)
    assert cut.force.shape == cut.torque.shape == (29, 3)
    assert cut.removed.sum() == pytest.approx(before - v.volume, rel=1e-12)
    assert not cut.force.any()
    cut = v.carve(BALL, poses - [0, 0, 1, 0, 0, 0], dt=0.01)
    assert np.all(np.linalg.norm(cut.force, axis=1)[cut.removed > 0] > 0)
    assert cut.force[10, 0] < 0  # against the motion


def test_one_pose_or_none_moves_nothing():
    v = riffler.Volume.block([0, 0, 0], [10, 10, 10], 0.5)
    assert len(v.carve(BALL, np.empty((0, 6))).removed) == 0
    assert len(v.carve(BALL, [[5, 5, 5, *UP]]).removed) == 0
    assert v.volume == 1000


@pytest.mark.parametrize(
    ("poses", "options", "word"),
    [
        ([[0, 0, 0, 0, 0, 1], [0, 0, np.nan, 0, 0, 1]], {}, "row 1"),
        ([[0, 0, 0, 0, 0, 1], [0, 0, 0, 0, 0, 0]], {}, "row 1"),
        ([[0, 0, 0, 0, 0, 2]], {}, "row 0"),
        ([[0, 0, 0, 0, 0, 1], [0, 0, 0, 0, 0, -1]], {}, "row 1"),
        ([[0, 0, 0]], {}, "shape"),
        ([[0, 0, 0, 0, 0, 1]] * 2, {"tolerance": 0}, "tolerance"),
        ([[0, 0, 0, 0, 0, 1]] * 2, {"dt": 0}, "dt"),
        ([[0, 0, 0, 0, 0, 1]] * 2, {"dt": [1, 2]}, "dt"),
    ],
)
def test_bad_poses_are_refused_and_change_nothing(poses, options, word):
    v = riffler.Volume.block([0, 0, 0], [10, 10, 10], 0.5)
    revision = v.revision
    with pytest.raises(ValueError, match=word):
        v.carve(BALL, poses, **options)
    assert (v.revision, v.volume) == (revision, 1000)


def test_axes_slightly_off_unit_length_are_normalised():
    v = riffler.Volume.block([0, 0, 0], [10, 10, 10], 0.5)
    v.carve(BALL, [[5, 5, 12, 0, 0, 1 + 5e-7], [5, 5, 5, 0, 0, 1 - 5e-7]])
    assert v.volume < 1000


def test_cancelling_leaves_the_volume_and_reports_shares():
    v = riffler.Volume.block([0, 0, 0], [60, 60, 10], 0.1, "xyz")
    poses = np.array([[5 + 0.05 * k, 5 + 0.05 * k, 5, *UP] for k in range(900)])
    seen, revision = [], v.revision

    def stop(share):
        seen.append(share)
        return share < 0.3

    with pytest.raises(riffler.Cancelled):
        v.carve(BALL, poses, progress=stop)
    assert seen == sorted(seen)
    assert v.revision == revision
    assert v.volume == pytest.approx(36000)


def test_snapshots_restore_volume_and_revision_and_copies_are_independent():
    v = riffler.Volume.block([0, 0, 0], [20, 20, 10], 0.5, "xyz")
    s, revision = v.snapshot(), v.revision
    other = copy.copy(v)
    v.carve(BALL, [[0, 10, 5, *UP], [20, 10, 5, *UP]])
    assert v.volume < 4000
    assert v.revision != revision
    assert s.volume == other.volume == 4000
    v.restore(s)
    assert (v.volume, v.revision) == (4000, revision)
    with pytest.raises(ValueError, match="another grid"):
        v.restore(riffler.Volume.block([0, 0, 0], [20, 20, 11], 0.5, "xyz").snapshot())


def test_a_volume_survives_bytes_and_pickle():
    v = riffler.Volume.block([0, 0, 0], [20, 20, 10], 0.5, "xyz")
    v.carve(BALL, [[0, 10, 5, *UP], [20, 10, 5, *UP]])
    for again in (riffler.Volume.from_bytes(v.to_bytes()), pickle.loads(pickle.dumps(v))):
        for direction in "xyz":
            assert all(
                np.array_equal(a, b) for a, b in zip(v.intervals(direction), again.intervals(direction), strict=True)
            )
            assert np.array_equal(v.normals(direction), again.normals(direction))


@pytest.mark.parametrize("directions", ["z", "xyz"])
def test_the_mesh_of_a_block_is_the_block(directions):
    lower, upper = np.array([1.0, -2, 3]), np.array([11.0, 4.13, 8.2])
    mesh = riffler.Volume.block(lower, upper, 0.25, directions).to_mesh()
    assert clean(mesh)
    if directions == "xyz":
        assert np.abs(np.array(mesh.bounds) - [lower, upper]).max() < 0.01
        assert mesh.volume == pytest.approx(np.prod(upper - lower), rel=1e-3)


def test_an_empty_volume_has_an_empty_mesh_that_can_be_written(tmp_path):
    v = riffler.Volume.block([0, 0, 0], [5, 5, 5], 0.5)
    v.carve(riffler.Tool.flat(30, 30), [[2.5, 2.5, 10, *UP], [2.5, 2.5, -1, *UP]])
    mesh = v.to_mesh()
    assert (v.volume, len(mesh.triangles)) == (0, 0)
    mesh.write(tmp_path / "empty.stl")
    assert (tmp_path / "empty.stl").stat().st_size == 84


@settings(max_examples=25, deadline=None, derandomize=True)
@given(
    st.lists(st.tuples(*[st.floats(-3, 13)] * 3, *[st.floats(-1, 1)] * 2, st.floats(0.2, 1)), min_size=2, max_size=5),
    st.sampled_from(["z", "xyz"]),
    st.sampled_from([0.0, 1000.0, -1e5]),
)
def test_any_carved_volume_makes_a_clean_stl(tmp_path_factory, rows, directions, offset):
    poses = np.array(rows)
    poses[:, :3] += offset
    poses[:, 3:] /= np.linalg.norm(poses[:, 3:], axis=1)[:, None]
    v = riffler.Volume.block([offset] * 3, [offset + 10] * 3, 0.5, directions)
    v.carve(riffler.Tool.fillet(3, 0.5, 20), poses, tolerance=0.05)
    path = tmp_path_factory.mktemp("stl") / "v.stl"
    v.to_mesh().write(path)
    if path.stat().st_size > 84:
        mesh = riffler.Mesh.read(path)
        assert clean(mesh)
        assert abs(mesh.volume - v.volume) < 0.3 * mesh.area * v.pitch


def test_from_mesh_refuses_meshes_without_volume():
    flat = riffler.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    tilted = riffler.Mesh([[0, 0, 0], [1, 0, 0.3], [0, 1, 0.2]], [[0, 1, 2]])
    for mesh in (flat, tilted):
        with pytest.raises(ValueError, match="volume"):
            riffler.Volume.from_mesh(mesh, 0.1)


def test_from_mesh_reports_the_defects():
    v = riffler.Volume.block([0, 0, 0], [4, 3, 2], 0.5, "xyz")
    mesh = v.to_mesh()
    _, report = riffler.Volume.from_mesh_with_report(mesh, 0.5, "xyz")
    facts = dataclasses.asdict(report)
    assert facts.pop("triangles") == len(mesh.triangles)
    assert len(facts) == 17 and not any(facts.values())

    cut = riffler.Mesh(mesh.vertices, mesh.triangles[1:])
    _, report = riffler.Volume.from_mesh_with_report(cut, 0.5)
    assert (report.open_edges, report.openings, report.flipped_shells) == (3, 1, 0)
    inside_out = riffler.Mesh(mesh.vertices, mesh.triangles[:, ::-1])
    _, report = riffler.Volume.from_mesh_with_report(inside_out, 0.5)
    assert (report.open_edges, report.openings, report.flipped_shells) == (0, 0, 1)
    assert report.inside_out == 1


def test_a_dict_for_the_report_is_still_filled():
    mesh = riffler.Volume.block([0, 0, 0], [4, 3, 2], 0.5, "xyz").to_mesh()
    report = {"old": 1}
    riffler.deprecated.forget()
    with pytest.warns(DeprecationWarning, match="from_mesh_with_report"):
        riffler.Volume.from_mesh(mesh, 0.5, "xyz", report=report)
    assert len(report) == 19 and report["old"] == 1 and report["triangles"] == len(mesh.triangles)
    riffler.Volume.from_mesh(mesh, 0.5, report=None)
    with pytest.raises(TypeError):
        riffler.Volume.from_mesh(mesh, 0.5, report=[])


def test_from_mesh_refuses_bad_meshes_by_name():
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    for vertices, triangles, message in [
        (np.empty((0, 3)), np.empty((0, 3), int), "no triangles"),
        (corners, [[0, 1, 2], [0, 1, 8]], "row 1"),
        (corners, [[0, 1, -1]], "row 0"),
        (np.where(corners == 1, np.nan, corners), [[0, 1, 2]], "row"),
        (corners, [[0, 1, 2], [1, 3, 2]], "flat"),
    ]:
        with pytest.raises(ValueError, match=message):
            riffler.Volume.from_mesh(riffler.Mesh(vertices, triangles), 0.1)


def test_a_volume_in_use_by_another_thread_refuses_calls():
    v = riffler.Volume.block([0, 0, 0], [60, 60, 10], 0.1, "xyz")
    poses = np.array([[5 + 0.05 * k, 5 + 0.05 * k, 5, *UP] for k in range(900)])
    started, go_on, errors = threading.Event(), threading.Event(), []

    def hold(_share):
        started.set()
        go_on.wait(20)

    worker = threading.Thread(target=lambda: v.carve(BALL, poses, progress=hold))
    worker.start()
    assert started.wait(20)
    for call in (v.to_mesh, lambda: v.volume, lambda: v.carve(BALL, poses[:2])):
        with pytest.raises(RuntimeError, match="another thread") as caught:
            call()
        errors.append(caught)
    go_on.set()
    worker.join()
    assert len(errors) == 3
    assert v.volume < 36000


def test_counters_are_cleared_when_they_are_taken():
    v = riffler.Volume.block([0, 0, 0], [20, 20, 10], 0.5)
    v.carve(BALL, [[0, 10, 5, *UP], [20, 10, 5, *UP]])
    counters = v.counters
    assert counters.moves == 1
    assert 0 < counters.rays_changed <= counters.rays_tested
    assert v.take_counters() == counters
    assert not any(dataclasses.astuple(v.counters))
    v.carve(BALL, [[0, 10, 4, *UP], [20, 10, 4, *UP]])
    riffler.deprecated.forget()
    with pytest.warns(DeprecationWarning, match=r"Volume.stats is deprecated, use Volume.take_counters"):
        assert v.stats().moves == 1
