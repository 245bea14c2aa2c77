"""riffler.Mesh: what the outward contract promises, against numpy and by hand."""

import copy
import os
import pickle
import struct
import subprocess
import sys

import numpy as np
import pytest
import riffler
from hypothesis import given, settings
from hypothesis import strategies as st

COUNTS = ("open_edges", "nonmanifold_edges", "nonmanifold_vertices", "degenerate", "duplicates", "folds")


def box(lower=(0, 0, 0), upper=(1, 2, 3)):
    corners = np.array([[(upper if i >> k & 1 else lower)[k] for k in range(3)] for i in range(8)], float)
    triangles = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4)]
    triangles += [(2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5)]
    return riffler.Mesh(corners, triangles)


def torus(around=120, across=60, major=10.0, minor=4.0):
    i, j = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    u, v = i * 2 * np.pi / around, j * 2 * np.pi / across
    radius = major + minor * np.cos(v)
    vertices = np.stack([radius * np.cos(u), radius * np.sin(u), minor * np.sin(v)], -1).reshape(-1, 3)
    a, b = i * across + j, (i + 1) % around * across + j
    c, d = (i + 1) % around * across + (j + 1) % across, i * across + (j + 1) % across
    triangles = np.concatenate([np.stack([a, b, c], -1), np.stack([a, c, d], -1)]).reshape(-1, 3)
    return riffler.Mesh(vertices, triangles)


def defects(mesh):
    audit = mesh.audit()
    return {name: getattr(audit, name) for name in COUNTS if getattr(audit, name)}


def normals_and_areas(mesh):
    p = mesh.vertices[mesh.triangles]
    cross = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    return cross, np.linalg.norm(cross, axis=1) / 2


def test_measures_agree_with_numpy():
    mesh = torus()
    p = mesh.vertices[mesh.triangles]
    _, areas = normals_and_areas(mesh)
    assert mesh.area == pytest.approx(areas.sum(), rel=1e-13)
    assert mesh.volume == pytest.approx(np.einsum("ij,ij->", p[:, 0], np.cross(p[:, 1], p[:, 2])) / 6, rel=1e-12)
    assert np.array_equal(mesh.bounds, [mesh.vertices.min(0), mesh.vertices.max(0)])
    assert mesh.bounds.shape == (2, 3)


def test_arrays_are_views_that_cannot_be_written_and_outlive_the_mesh():
    mesh = box()
    vertices, triangles = mesh.vertices, mesh.triangles
    assert (vertices.shape, vertices.dtype) == ((8, 3), np.float64)
    assert (triangles.shape, triangles.dtype) == ((12, 3), np.int32)
    assert np.shares_memory(vertices, mesh.vertices)
    with pytest.raises(ValueError, match="read-only"):
        vertices[0, 0] = 7
    del mesh
    assert vertices[7].tolist() == [1, 2, 3]


def test_a_mesh_takes_lists_and_other_dtypes_and_copies_them():
    given = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
    for dtype in (np.int8, np.uint16, np.int64, np.uint64):
        mesh = riffler.Mesh(given, np.array([[0, 1, 2]], dtype))
        assert mesh.triangles.tolist() == [[0, 1, 2]]
    given[0, 0] = 9
    assert mesh.vertices[0, 0] == 0
    strided = np.zeros((3, 6))[:, ::2]
    assert riffler.Mesh(strided, [[0, 1, 2]]).vertices.shape == (3, 3)
    for empty in ([], np.zeros((0, 3))):
        assert riffler.Mesh(empty, np.array(empty, int)).triangles.shape == (0, 3)


@pytest.mark.parametrize(
    ("vertices", "triangles", "message"),
    [
        ([[0, 0]], [[0, 0, 0]], r"vertices must have the shape \(n, 3\), not \(1, 2\)"),
        ([0, 0, 0], [[0, 0, 0]], r"vertices must have the shape \(n, 3\), not \(3,\)"),
        ("text", [[0, 0, 0]], "vertices must be numbers"),
        ([[0, 0, 0], [0, np.nan, 0]], [[0, 0, 0]], "vertices, row 1: not finite"),
        ([[0, 0, 0], [0, 0, -np.inf]], [[0, 0, 0]], "vertices, row 1: not finite"),
        ([[0, 2e30, 0]], [[0, 0, 0]], "vertices, row 0: beyond 1e30"),
        ([[0, 0, 0]], [0, 0, 0], r"triangles must have the shape \(k, 3\), not \(3,\)"),
        ([[0, 0, 0]], [[0, 0, 0, 0]], r"triangles must have the shape \(k, 3\), not \(1, 4\)"),
        ([[0, 0, 0]], [[0, 0, 0], [0, 1, 0]], "triangles, row 1: no vertex 1: there are 1"),
        ([[0, 0, 0]], [[0, 0, -1]], "triangles, row 0: no vertex has the index -1"),
        ([[0, 0, 0]], [[0, 0, 2**32]], "triangles, row 0: no vertex has the index 4294967296"),
        ([[0, 0, 0]], np.array([[0, 0, 2**63]], np.uint64), "triangles, row 0: no vertex has the index"),
        ([[0, 0, 0]], [[0.0, 0.0, 0.0]], "triangles must be integers, not float64"),
        ([[0, 0, 0]], [["a", "b", "c"]], "triangles must be integers"),
        ([[0, 0, 0]], [[0, 0], [0]], "triangles must be"),
    ],
)
def test_bad_arguments_are_named(vertices, triangles, message):
    with pytest.raises(ValueError, match=message):
        riffler.Mesh(vertices, triangles)


@pytest.mark.parametrize("extension", ["stl", "obj", "ply", "STL", "Ply"])
def test_files_round_trip(tmp_path, extension):
    mesh = torus()
    path = tmp_path / f"part.{extension}"
    mesh.write(path)
    back = riffler.Mesh.read(str(path))
    exact = mesh.vertices.astype(np.float32).astype(float) if extension.lower() == "stl" else mesh.vertices
    assert np.array_equal(back.vertices[back.triangles], exact[mesh.triangles])
    assert len(back.vertices) == len(mesh.vertices)
    assert defects(back) == {}
    assert os.listdir(tmp_path) == [path.name]


def test_stl_has_the_normals_of_its_triangles(tmp_path):
    mesh = torus()
    mesh.write(tmp_path / "part.stl")
    data = (tmp_path / "part.stl").read_bytes()
    assert not data.startswith(b"solid")
    assert struct.unpack_from("<I", data, 80) == (len(mesh.triangles),)
    records = np.frombuffer(data, [("floats", "<f4", 12), ("attribute", "<u2")], offset=84)
    p = records["floats"][:, 3:].reshape(-1, 3, 3).astype(float)
    cross = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    expected = cross / np.linalg.norm(cross, axis=1, keepdims=True)
    assert np.abs(records["floats"][:, :3] - expected).max() < 1e-7
    assert not records["attribute"].any()


def test_an_empty_mesh_writes_a_valid_empty_stl(tmp_path):
    riffler.Mesh([], []).write(tmp_path / "empty.stl")
    data = (tmp_path / "empty.stl").read_bytes()
    assert len(data) == 84 and data[80:] == bytes(4)
    with pytest.raises(riffler.FormatError, match=r"empty\.stl, byte 80: zero triangles"):
        riffler.Mesh.read(tmp_path / "empty.stl")


def test_files_that_cannot_be_read_or_written_are_named(tmp_path):
    with pytest.raises(ValueError, match=r"ends in \.stl, \.obj or \.ply \(from Python also \.3mf\), not in '\.amf'"):
        riffler.Mesh.read(tmp_path / "part.amf")
    with pytest.raises(ValueError, match=r"ends in \.stl, \.obj or \.ply"):
        box().write(tmp_path / "part")
    with pytest.raises(riffler.FormatError, match=r"none\.stl"):
        riffler.Mesh.read(tmp_path / "none.stl")
    (tmp_path / "bad.obj").write_text("v 0 0 0\nf 1 2 3\n")
    with pytest.raises(riffler.FormatError, match=r"bad\.obj, line 2: no vertex 2: 1 are defined"):
        riffler.Mesh.read(tmp_path / "bad.obj")
    assert issubclass(riffler.FormatError, ValueError)


@settings(max_examples=300, deadline=None, derandomize=True)
@given(st.data())
def test_damaged_stl_is_a_format_error_or_a_valid_mesh(tmp_path_factory, data):
    folder = tmp_path_factory.getbasetemp()
    box().write(folder / "good.stl")
    content = bytearray((folder / "good.stl").read_bytes())
    for _ in range(data.draw(st.integers(1, 4))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
    content = content[: data.draw(st.sampled_from([len(content), len(content) - 1, 84, 83, 10]))]
    (folder / "bad.stl").write_bytes(content)
    try:
        mesh = riffler.Mesh.read(folder / "bad.stl")
    except riffler.FormatError as error:
        assert "bad.stl, byte " in str(error) or "bad.stl, line " in str(error)
    else:
        assert len(mesh.triangles) == 12 and np.isfinite(mesh.vertices).all()


def test_audit_names_defects():
    mesh = torus(20, 12)
    audit = mesh.audit()
    assert set(vars(audit)) == {*COUNTS, "components", "volume"}
    assert defects(mesh) == {} and audit.components == 1 and audit.volume == mesh.volume
    assert defects(riffler.Mesh(mesh.vertices, mesh.triangles[1:])) == {"open_edges": 3}
    turned = mesh.triangles.copy()
    turned[5] = turned[5, ::-1]
    assert defects(riffler.Mesh(mesh.vertices, turned)) == {"nonmanifold_edges": 3}
    soup = riffler.Mesh(mesh.vertices[mesh.triangles].reshape(-1, 3), np.arange(3 * len(mesh.triangles)).reshape(-1, 3))
    assert soup.audit().components == len(mesh.triangles)
    assert defects(soup) == {"open_edges": 3 * len(mesh.triangles)}


def brute_deviation(points, mesh):
    """Distance to the nearest triangle: foot of the perpendicular where it is inside, else the nearest edge."""
    best = np.full(len(points), np.inf)
    for a, b, c in mesh.vertices[mesh.triangles]:
        frame, *_ = np.linalg.lstsq(np.stack([b - a, c - a], 1), (points - a).T, rcond=None)
        inside = (frame >= 0).all(0) & (frame.sum(0) <= 1)
        foot = a + frame.T @ np.stack([b - a, c - a])
        best = np.where(inside, np.minimum(best, np.linalg.norm(points - foot, axis=1)), best)
        for p, q in ((a, b), (b, c), (c, a)):
            t = np.clip((points - p) @ (q - p) / ((q - p) @ (q - p)), 0, 1)
            best = np.minimum(best, np.linalg.norm(points - p - t[:, None] * (q - p), axis=1))
    return best


def test_deviation_is_the_distance_to_the_nearest_triangle():
    mesh, other = torus(12, 8), torus(10, 7, minor=3.0)
    distance = mesh.deviation(other)
    assert distance.shape == (len(mesh.vertices),)
    assert np.abs(distance - brute_deviation(mesh.vertices, other)).max() < 1e-12
    signed = mesh.deviation(other, signed=True)
    assert np.array_equal(np.abs(signed), distance)
    assert (signed > 0).sum() > 70  # a wider tube
    with pytest.raises(ValueError, match="other"):
        mesh.deviation(riffler.Mesh([], []))


def test_decimate_keeps_to_its_limits():
    mesh = torus()
    for tolerance in (0.01, 0.1):
        result = mesh.decimate(tolerance=tolerance)
        assert len(result.triangles) < len(mesh.triangles) / 1.5
        assert mesh.deviation(result).max() <= tolerance
        assert defects(result) == {}
    result = mesh.decimate(triangles=1000)
    assert 998 <= len(result.triangles) <= 1000
    assert len(mesh.decimate(triangles=2000, tolerance=0.5).triangles) == 2000
    assert len(mesh.triangles) == 14400  # unchanged
    for arguments in ({}, {"triangles": -1}, {"tolerance": -1.0}, {"tolerance": float("nan")}):
        with pytest.raises(ValueError, match=r"triangles|tolerance"):
            mesh.decimate(**arguments)


def test_a_sharp_box_becomes_twelve_triangles(tmp_path):
    n = 20
    faces = []
    grid = np.arange(n + 1) * 2.5
    for k in range(3):
        for side in (0, 1):
            u, v = np.meshgrid(grid, grid, indexing="ij")
            p = np.empty((n + 1, n + 1, 3))
            p[..., k], p[..., (k + 1) % 3], p[..., (k + 2) % 3] = side * grid[-1], u, v
            a, b, c, d = p[:-1, :-1], p[1:, :-1], p[1:, 1:], p[:-1, 1:]
            quads = (a, b, c, a, c, d) if side else (a, c, b, a, d, c)
            faces.append(np.stack(quads, 2).reshape(-1, 3))
    corners, triangles = np.unique(np.concatenate(faces), axis=0, return_inverse=True)
    mesh = riffler.Mesh(corners, triangles.reshape(-1, 3))
    assert defects(mesh) == {} and mesh.volume == pytest.approx(50**3)
    result = mesh.decimate(tolerance=1e-6)
    assert (len(result.triangles), result.volume) == (12, 50**3)
    result.write(tmp_path / "box.stl")
    assert defects(riffler.Mesh.read(tmp_path / "box.stl")) == {}


def test_smooth_moves_vertices_by_at_most_the_tolerance():
    mesh = torus()
    rough = riffler.Mesh(
        mesh.vertices + np.random.default_rng(1).uniform(-0.02, 0.02, mesh.vertices.shape), mesh.triangles
    )
    result = rough.smooth(iterations=10, tolerance=0.015)
    moved = np.linalg.norm(result.vertices - rough.vertices, axis=1)
    assert 0.0149 < moved.max() <= 0.015 + 1e-12
    assert np.array_equal(result.triangles, rough.triangles)
    # At least a third of the roughness across the surface is gone.
    assert np.abs(rough.smooth().deviation(mesh)).mean() < np.abs(rough.deviation(mesh)).mean() / 1.5
    with pytest.raises(ValueError, match="iterations"):
        rough.smooth(iterations=-1)
    with pytest.raises(ValueError, match="tolerance"):
        rough.smooth(iterations=1, tolerance=-1.0)


def test_decimate_keeps_to_a_count_and_a_tolerance_at_once():
    mesh = torus(240, 120)
    result = mesh.decimate(triangles=5760, tolerance=0.03)
    assert len(result.triangles) == 5760
    assert defects(result) == {}
    weights = np.array([(i, j, 4 - i - j) for i in range(5) for j in range(5 - i)]) / 4
    dense = riffler.Mesh(np.einsum("wk,tkd->twd", weights, result.vertices[result.triangles]).reshape(-1, 3), [])
    assert max(mesh.deviation(result).max(), dense.deviation(mesh).max()) <= 0.03
    assert result.volume == pytest.approx(mesh.volume, rel=2e-3)


def test_smooth_keeps_sharp_edges_and_the_volume():
    mesh = riffler.Volume.block((0, 0, 0), (8, 8, 8), 0.5, "xyz").to_mesh()
    rough = riffler.Mesh(
        mesh.vertices + np.random.default_rng(2).uniform(-0.02, 0.02, mesh.vertices.shape), mesh.triangles
    )
    result = rough.smooth(iterations=16)
    assert result.volume == pytest.approx(rough.volume, rel=1e-6)
    inset = 4 - np.abs(result.vertices - 4).max(axis=1)  # of every vertex, from the cube's surface
    assert np.abs(inset).max() < 0.03
    rounded = rough.smooth(iterations=16, feature_angle=3.1)
    assert (4 - np.abs(rounded.vertices - 4).max(axis=1)).max() > 0.05
    with pytest.raises(ValueError, match="feature_angle"):
        rough.smooth(iterations=1, feature_angle=0)


def test_progress_is_reported_and_cancels():
    mesh = torus(400, 200)
    for call in (
        lambda progress: mesh.decimate(triangles=1000, progress=progress),
        lambda progress: mesh.smooth(iterations=30, progress=progress),
        lambda progress: mesh.deviation(mesh, progress=progress),
        lambda progress: mesh.audit(progress=progress),
    ):
        shares = []
        call(lambda share, shares=shares: shares.append(share))
        assert shares and all(0 <= share <= 1 for share in shares) and shares == sorted(shares)
        with pytest.raises(riffler.Cancelled):
            call(lambda share: False)
        with pytest.raises(ZeroDivisionError):
            call(lambda share: 1 / 0)


def test_copies_pickles_and_repr():
    mesh = box()
    for other in (copy.copy(mesh), copy.deepcopy(mesh), pickle.loads(pickle.dumps(mesh))):
        assert np.array_equal(other.vertices, mesh.vertices)
        assert np.array_equal(other.triangles, mesh.triangles)
        assert other.triangles.dtype == np.int32
    assert repr(mesh) == "<riffler.Mesh: 8 vertices, 12 triangles>"
    empty = pickle.loads(pickle.dumps(riffler.Mesh([], [])))
    assert empty.audit().components == 0 and empty.volume == 0
    with pytest.raises(ValueError, match="no bounds"):
        empty.bounds  # noqa: B018


def test_results_are_the_same_for_any_number_of_threads():
    program = (
        "import sys, hashlib; sys.path.insert(0, sys.argv[1]); import test_mesh as t\n"
        "m = t.torus(150, 80); r = m.decimate(tolerance=0.02); s = m.smooth(tolerance=0.01)\n"
        "d = m.deviation(r, signed=True)\n"
        "print(hashlib.sha256(r.vertices.tobytes() + r.triangles.tobytes() + s.vertices.tobytes() + d.tobytes()"
        " + repr((m.audit(), m.area)).encode()).hexdigest())"
    )
    outputs = set()
    for threads in ("1", "2", "7"):
        env = {**os.environ, "RIFFLER_THREADS": threads}
        run = subprocess.run(
            [sys.executable, "-c", program, os.path.dirname(__file__)],
            env=env,
            capture_output=True,
            text=True,
            check=True,
        )
        outputs.add(run.stdout)
    assert len(outputs) == 1


MODELS = os.path.join(os.path.dirname(__file__), *[".."] * 4, "shared", "models")


@pytest.mark.skipif(not os.path.isdir(MODELS), reason="the test parts in ../shared/models are not there")
@pytest.mark.parametrize("name", ["fandisk", "rocker-arm", "ktoolcav"])
def test_parts_are_decimated_within_the_tolerance(name):
    mesh = riffler.Mesh.read(os.path.join(MODELS, f"{name}.stl"))
    assert defects(mesh) == {}
    tolerance = float(np.linalg.norm(mesh.bounds[1] - mesh.bounds[0])) / 1000
    result = mesh.decimate(tolerance=tolerance)
    assert defects(result) == {}
    assert len(result.triangles) < len(mesh.triangles) / 2

    def dense(m):  # 28 points on every triangle
        weights = np.array([(i, j, 6 - i - j) for i in range(7) for j in range(7 - i)]) / 6
        return riffler.Mesh(np.einsum("wk,tkd->twd", weights, m.vertices[m.triangles]).reshape(-1, 3), [])

    assert dense(mesh).deviation(result).max() <= tolerance
    assert dense(result).deviation(mesh).max() <= tolerance
