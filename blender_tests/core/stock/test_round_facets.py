"""Coarse meshes made round."""

import numpy as np
import pytest
import riffler

from addon.stock.pure import round_facets

UP = np.array([0.0, 0, 1])


def closed(vertices, triangles):
    """As a mesh that is closed and two-manifold."""
    made = riffler.Mesh(vertices, triangles)
    audit = made.audit()
    assert np.isfinite(vertices).all() and audit.open_edges == 0 and audit.nonmanifold_edges == 0
    assert audit.folds == 0 and audit.components == 1
    return made


def sphere(segments=32, rings=16, radius=1.0):
    """Blender's UV sphere."""
    down = np.pi * np.arange(1, rings) / rings
    turn = 2 * np.pi * np.arange(segments) / segments
    body = np.stack(
        [np.outer(np.sin(down), np.cos(turn)), np.outer(np.sin(down), np.sin(turn)), np.outer(np.cos(down), turn**0)],
        axis=-1,
    )
    co = radius * np.concatenate([body.reshape(-1, 3), [[0, 0, 1], [0, 0, -1]]])
    top, bottom, tri = len(co) - 2, len(co) - 1, []
    for s in range(segments):
        t = (s + 1) % segments
        tri += [(top, s, t), (bottom, (rings - 2) * segments + t, (rings - 2) * segments + s)]
        for r in range(rings - 2):
            a, b, c, d = r * segments + s, (r + 1) * segments + s, (r + 1) * segments + t, r * segments + t
            tri += [(a, b, c), (a, c, d)]
    return co, np.array(tri)


def cylinder(n=32):
    turn = 2 * np.pi * np.arange(n) / n
    rim = np.column_stack([np.cos(turn), np.sin(turn), 0 * turn])
    co = np.concatenate([rim - UP, rim + UP, [-UP, UP]])
    tri = []
    for a in range(n):
        b = (a + 1) % n
        tri += [(a, b, n + b), (a, n + b, n + a), (2 * n, b, a), (2 * n + 1, n + a, n + b)]
    return co, np.array(tri)


def middles(vertices, triangles):
    return vertices[triangles].mean(axis=1)


def test_a_sphere_of_facets_is_round():
    co, tri = sphere()
    new, made = round_facets.rounded(co, tri, 2e-4)
    closed(new, made)
    before, after = (1 - np.linalg.norm(middles(*mesh), axis=1).min() for mesh in ((co, tri), (new, made)))
    assert before > 5e-3 and after < 1e-3, (before, after)
    assert np.linalg.norm(new, axis=1).max() < 1 + 5e-4


def test_a_cylinder_keeps_its_sharp_rims_and_flat_caps_and_its_rims_are_circles():
    co, tri = cylinder()
    new, made = round_facets.rounded(co, tri, 1e-4)
    assert closed(new, made).volume == pytest.approx(2 * np.pi, rel=2e-4)
    assert riffler.Mesh(co, tri).volume < 2 * np.pi * (1 - 5e-3)
    out = np.linalg.norm(new[:, :2], axis=1)
    caps = np.abs(np.abs(new[:, 2]) - 1) < 1e-9
    assert np.abs(new[:, 2]).max() < 1 + 1e-12 and np.abs(out[~caps] - 1).max() < 1e-4
    assert np.abs(out[caps & (out > 0.99)] - 1).max() < 1e-5


def test_a_cube_stays_as_it_is():
    mesh = riffler.Volume.block((0, 0, 0), (2, 3, 4), 1, "xyz").to_mesh(tolerance=0.01)
    new, made = round_facets.rounded(mesh.vertices, mesh.triangles, 1e-3)
    assert closed(new, made).volume == pytest.approx(mesh.volume) and len(made) == len(mesh.triangles)
    assert np.array_equal(np.unique(new, axis=0), np.unique(np.asarray(mesh.vertices), axis=0))


def test_the_same_comes_out_in_any_units_and_as_fine_as_was_asked():
    co, tri = sphere(12, 8)
    counts = [len(round_facets.rounded(size * co, tri, size * 1e-3)[1]) for size in (1e-3, 1, 1e3)]
    assert len(set(counts)) == 1 and counts[0] > 4 * len(tri)
    assert len(round_facets.rounded(co, tri, 1e-9)[1]) == round_facets.FINEST**2 * len(tri)


def test_vertices_apart_at_one_place_are_one():
    co, tri = sphere()
    apart, alone = co[tri].reshape(-1, 3), np.arange(tri.size).reshape(-1, 3)
    a, b = round_facets.rounded(co, tri, 1e-3), round_facets.rounded(apart, alone, 1e-3)
    assert len(a[0]) == len(b[0]) and closed(*b).volume == pytest.approx(closed(*a).volume, rel=1e-12)


@pytest.mark.parametrize(
    "tri",
    [
        np.zeros((0, 3), int),
        [(0, 0, 1)],  # no area
        [(0, 1, 2)],
        [(0, 1, 2), (0, 1, 3), (0, 1, 4)],  # three at one edge
        [(0, 1, 2), (0, 1, 3)],  # which do not agree about their outside
        [(0, 1, 2), (2, 1, 0)],  # no thickness
        [(0, 1, 5), (1, 0, 2)],  # corners on one line
    ],
)
def test_odd_triangles_do_no_harm(tri):
    co = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (0, -1, 0.1), (2, 0, 0)], float)
    new, made = round_facets.rounded(co, np.array(tri), 1e-3)
    assert np.isfinite(new).all() and made.dtype == np.int32 and (len(made) == 0 or made.max() < len(new))
