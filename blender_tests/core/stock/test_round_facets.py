"""Coarse meshes made round."""

import itertools

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


def test_a_cube_stays_unchanged():
    mesh = riffler.Volume.block((0, 0, 0), (2, 3, 4), 1, "xyz").to_mesh(tolerance=0.01)
    new, made = round_facets.rounded(mesh.vertices, mesh.triangles, 1e-3)
    assert closed(new, made).volume == pytest.approx(mesh.volume) and len(made) == len(mesh.triangles)
    assert np.array_equal(np.unique(new, axis=0), np.unique(np.asarray(mesh.vertices), axis=0))


def bevelled(segments=4, half=10.0, width=2.5):
    """A square bar with rounded edges, as the modifier Bevel makes it, and its exact volume."""
    turn = np.radians(90) * np.arange(segments + 1) / segments
    quarter = np.column_stack([np.cos(turn), np.sin(turn)]) * width + (half - width)
    rim = np.concatenate([quarter @ np.array([[c, s], [-s, c]]) for c, s in ((1, 0), (0, 1), (-1, 0), (0, -1))])
    n = len(rim)
    co = np.concatenate([np.column_stack([rim, 0 * rim[:, 0] + z]) for z in (-half, half)] + [[-half * UP, half * UP]])
    tri = []
    for a in range(n):
        b = (a + 1) % n
        tri += [(a, b, n + b), (a, n + b, n + a), (2 * n, b, a), (2 * n + 1, n + a, n + b)]
    return co, np.array(tri), 2 * half * (4 * half**2 - (4 - np.pi) * width**2)


def test_flat_faces_next_to_round_edges_stay_flat():
    co, tri, exact = bevelled()
    new, made = round_facets.rounded(co, tri, 1e-3)
    assert np.abs(new).max() < 10 + 1e-9
    assert closed(co, tri).volume < exact * (1 - 6e-4)
    assert closed(new, made).volume == pytest.approx(exact, rel=1e-4)


def chamfered(half=10.0, inner=6.0):
    """A cube with all edges cut off at 45°, which leaves a triangle of 35° to them at each corner."""
    signs, polygons = (-1, 1), []
    at = lambda axis, sign: np.roll([half * sign[0], inner * sign[1], inner * sign[2]], axis)  # noqa: E731
    for k in range(3):
        for a in signs:
            polygons.append([at(k, (a, b, c)) for b, c in ((-1, -1), (-1, 1), (1, 1), (1, -1))])
            for b in signs:  # between the faces of axis k and of the next one
                ends = [(at(k, (a, b, c)), at(k + 1, (b, c, a))) for c in signs]
                polygons.append([ends[0][0], ends[0][1], ends[1][1], ends[1][0]])
    for a in signs:
        for b in signs:
            polygons += [[at(0, (a, b, c)), at(1, (b, c, a)), at(2, (c, a, b))] for c in signs]
    triangles = [(p[0], *pair) for p in polygons for pair in itertools.pairwise(p[1:])]
    co = np.array([t if np.linalg.det(t) > 0 else t[::-1] for t in triangles]).reshape(-1, 3)
    return co, np.arange(len(co)).reshape(-1, 3)


def test_chamfers_stay_flat():
    co, tri = chamfered()
    new, made = round_facets.rounded(co, tri, 1e-3)
    assert closed(new, made).volume == pytest.approx(6421 + 1 / 3) and np.abs(new).max() == 10


def test_a_ring_whose_facets_differ_by_thirty_degrees_is_round():
    turn, around = 2 * np.pi * np.arange(48) / 48, 2 * np.pi * np.arange(12) / 12
    out = 20 + 6 * np.cos(around)
    co = np.stack([np.outer(np.cos(turn), out), np.outer(np.sin(turn), out), np.outer(turn**0, 6 * np.sin(around))], -1)
    at = np.arange(48 * 12).reshape(48, 12)
    a, b = at.ravel(), np.roll(at, -1, 0).ravel()
    c, d = np.roll(at, (-1, -1), (0, 1)).ravel(), np.roll(at, -1, 1).ravel()
    tri, exact = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])]), 2 * np.pi**2 * 20 * 36
    new, made = round_facets.rounded(co.reshape(-1, 3), tri, 1e-2)
    assert closed(co.reshape(-1, 3), tri).volume < 0.96 * exact
    assert closed(new, made).volume == pytest.approx(exact, rel=5e-3)


def test_the_result_is_the_same_in_any_units_and_as_fine_as_requested():
    co, tri = sphere(12, 8)
    counts = [len(round_facets.rounded(size * co, tri, size * 1e-3)[1]) for size in (1e-3, 1, 1e3)]
    assert len(set(counts)) == 1 and counts[0] > 4 * len(tri)
    assert len(round_facets.rounded(co, tri, 1e-9)[1]) == round_facets.FINEST**2 * len(tri)


def test_separate_vertices_at_one_place_are_merged():
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
