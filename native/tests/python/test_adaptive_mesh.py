"""Volume.to_mesh(tolerance=): fewer triangles, as near as asked for, and the full mesh without it."""

import numpy as np
import pytest
import riffler

UP = [0.0, 0, 1]


@pytest.fixture(scope="module", params=["xyz", "z"])
def volume(request):
    volume = riffler.Volume.block([0, 0, 0], [20, 16, 8], 0.2, request.param)
    volume.carve(riffler.Tool.ball(5, 30), np.array([[3, 4, 6.5, *UP], [15, 11, 6, *UP]]))
    return volume


def same(a, b):
    return np.array_equal(a.vertices, b.vertices) and np.array_equal(a.triangles, b.triangles)


def test_an_adaptive_mesh_is_closed_and_near_the_full_mesh(volume):
    full = volume.to_mesh()
    mesh = volume.to_mesh(tolerance=0.02)
    audit = mesh.audit()
    assert audit.open_edges == audit.nonmanifold_edges == audit.nonmanifold_vertices == audit.folds == 0
    assert audit.volume == pytest.approx(full.audit().volume, abs=0.02 * full.area)
    assert 5 * len(mesh.triangles) < len(full.triangles)
    # Its vertices are some of the full mesh's.
    assert {tuple(v) for v in mesh.vertices} <= {tuple(v) for v in full.vertices}


def test_an_adaptive_mesh_survives_a_binary_stl(volume, tmp_path):
    volume.to_mesh(tolerance=0.02).write(tmp_path / "part.stl")
    audit = riffler.Mesh.read(tmp_path / "part.stl").audit()
    assert audit.open_edges == audit.nonmanifold_edges == audit.duplicates == audit.degenerate == 0


def test_a_mesh_without_a_tolerance_has_all_triangles(volume):
    full = volume.to_mesh()
    for none in (None, 0, 1e-7):
        assert same(volume.to_mesh(tolerance=none), full)


def test_a_larger_tolerance_needs_no_more_triangles(volume):
    counts = [len(volume.to_mesh(tolerance=t).triangles) for t in (0.001, 0.02, 0.2, 100)]
    assert counts == sorted(counts, reverse=True)
    assert counts[-1] >= 4


@pytest.mark.parametrize("bad", [-1e-9, float("nan"), float("inf")])
def test_tolerances_that_are_no_distance_are_refused(volume, bad):
    with pytest.raises(ValueError, match="tolerance must be finite and not negative"):
        volume.to_mesh(tolerance=bad)


def test_the_report_names_lost_material(volume):
    mesh, report = volume.to_mesh_with_report(tolerance=0.02)
    assert same(mesh, volume.to_mesh(tolerance=0.02))
    assert report.lost == 0
