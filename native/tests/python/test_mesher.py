"""riffler.Mesher: the mesh that follows a volume, as patches and as a whole."""

import dataclasses

import numpy as np
import pytest
import riffler

UP = [0.0, 0, 1]


def carved():
    return riffler.Volume.block([0, 0, 0], [30, 24, 12], 0.25, "xyz")


def stroke(volume, x, y):
    volume.carve(riffler.Tool.ball(3, 20), np.array([[x, y, 11, *UP], [x + 1.5, y, 10.8, *UP]]))


def test_a_mesher_follows_a_stroke_and_its_undo():
    volume = carved()
    mesher = riffler.Mesher(volume)
    before = volume.snapshot()
    assert mesher.triangles == len(volume.to_mesh().triangles)
    stroke(volume, 8, 7)
    changed = mesher.update(volume)
    assert 0 < len(changed) < len(mesher.patches()) / 2
    whole = volume.to_mesh()
    assert np.array_equal(mesher.mesh().vertices, whole.vertices)
    assert np.array_equal(mesher.mesh().triangles, whole.triangles)
    volume.restore(before)
    assert set(mesher.update(volume)) <= set(changed)
    assert np.array_equal(mesher.mesh().vertices, volume.to_mesh().vertices)
    assert mesher.update(volume) == []


def test_all_patches_together_are_the_mesh():
    volume = carved()
    mesher = riffler.Mesher(volume)
    patches = {n: mesher.patch(n) for n in mesher.patches()}
    for x in (5, 9, 20):
        stroke(volume, x, 12)
        for n in mesher.update(volume):
            patches[n] = mesher.patch(n)
    corners = np.concatenate([p.vertices[p.triangles].reshape(-1, 9) for p in patches.values() if len(p.triangles)])
    whole = volume.to_mesh()
    expected = whole.vertices[whole.triangles].reshape(-1, 9).astype(np.float32)
    assert corners.dtype == np.float32
    assert np.array_equal(corners[np.lexsort(corners.T)], expected[np.lexsort(expected.T)])


def test_a_mesher_with_a_tolerance_agrees_with_to_mesh():
    volume = carved()
    mesher = riffler.Mesher(volume, tolerance=0.02)
    full = riffler.Mesher(volume)
    assert mesher.triangles < full.triangles / 20
    assert mesher.all_triangles == full.all_triangles == full.triangles
    assert mesher.tolerance == 0.02 and full.tolerance is None
    patches = {n: mesher.patch(n) for n in mesher.patches()}
    for x in (8, 12):
        stroke(volume, x, 7)
        changed = mesher.update(volume)
        assert 0 < len(changed) < 20
        for n in changed:
            patches[n] = mesher.patch(n)
    full.update(volume)
    whole = volume.to_mesh(tolerance=0.02)
    assert np.array_equal(mesher.mesh().vertices, whole.vertices)
    assert np.array_equal(mesher.mesh().triangles, whole.triangles)
    assert mesher.triangles == len(whole.triangles)
    corners = np.concatenate([p.vertices[p.triangles].reshape(-1, 9) for p in patches.values()])
    assert np.array_equal(corners[np.lexsort(corners.T)], sorted_corners(whole.vertices, whole.triangles))
    together = mesher.patch(mesher.patches(), edges=True, normals=0.5)
    assert len(together.vertices) == len(whole.vertices)
    assert together.normals.shape == (3 * len(together.triangles), 3)
    assert mesher.pick([8, 7, 30], [0, 0, -1]).point.tolist() == full.pick([8, 7, 30], [0, 0, -1]).point.tolist()


def test_an_unusable_tolerance_keeps_all_triangles_and_a_bad_one_is_an_error():
    volume = carved()
    for tolerance in (None, 0, 1e-7):
        assert riffler.Mesher(volume, tolerance=tolerance).triangles == len(volume.to_mesh().triangles)
    for tolerance in (-1, float("nan"), float("inf")):
        with pytest.raises(ValueError, match="tolerance must be finite and not negative"):
            riffler.Mesher(volume, tolerance=tolerance)
    with pytest.raises(riffler.Cancelled):
        riffler.Mesher(volume, tolerance=0.02, progress=lambda share: share < 0.7)


def sorted_corners(vertices, triangles):
    corners = vertices[triangles].reshape(-1, 9).astype(np.float32)
    return corners[np.lexsort(corners.T)]


def whole_normals(vertices, triangles, sharp):
    """Normals of all corners (3 k, 3), from the whole mesh: pairs of corners at one vertex, all at once."""
    p = vertices[triangles].astype(float)
    normals = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    to_next, to_last = np.roll(p, -1, axis=1) - p, np.roll(p, 1, axis=1) - p
    cosines = (to_next * to_last).sum(axis=2) / np.linalg.norm(to_next, axis=2) / np.linalg.norm(to_last, axis=2)
    weighted = np.arccos(cosines)[:, :, None] * normals[:, None]
    corner = np.argsort(triangles.ravel(), kind="stable")
    sizes = np.bincount(triangles.ravel(), minlength=len(vertices))
    first = np.concatenate([[0], np.cumsum(sizes)])[:-1]
    around = sizes[triangles.ravel()]
    own = np.repeat(np.arange(3 * len(triangles)), around)
    other = corner[np.repeat(first[triangles.ravel()] - np.cumsum(around) + around, around) + np.arange(len(own))]
    near = (normals[own // 3] * normals[other // 3]).sum(axis=1) >= np.cos(sharp)
    out = np.zeros((3 * len(triangles), 3))
    np.add.at(out, own[near], weighted.reshape(-1, 3)[other[near]])
    return out / np.linalg.norm(out, axis=1)[:, None]


@pytest.mark.parametrize("degrees", [20, 180])
def test_a_patch_has_the_normals_of_the_whole_mesh(degrees):
    volume = carved()
    for x in (5, 7.3, 9, 20):
        stroke(volume, x, 8)  # across the border between bricks at 8 mm
    mesher = riffler.Mesher(volume)
    whole = volume.to_mesh()
    sharp = np.radians(degrees)
    vertices = np.asarray(whole.vertices).astype(np.float32)
    expected = whole_normals(vertices, np.asarray(whole.triangles), sharp)
    place = {
        v.tobytes() + n.tobytes(): k for k, (v, n) in enumerate(zip(*keys(vertices, whole.triangles), strict=True))
    }
    bricks = mesher.patches()
    seen = 0
    for some in (bricks[:1], bricks[3:5], bricks):
        patch = mesher.patch(some, normals=sharp)
        v, t, normals = patch.vertices, patch.triangles, patch.normals
        k = [place[a.tobytes() + b.tobytes()] for a, b in zip(*keys(v, t), strict=True)]
        cosines = (normals * expected[k]).sum(axis=1)
        off = np.degrees(np.arccos(np.clip(cosines, -1, 1)))
        # a triangle at the very angle may count in one and not in the other
        assert np.percentile(off, 99.9) < 0.05 and (off > 0.05).sum() <= 6, off.max()
        seen += len(normals)
    assert seen > 3 * len(whole.triangles)
    with pytest.raises(ValueError, match="normals"):
        mesher.patch(0, normals=-1.0)


def keys(vertices, triangles):
    """For all corners: the vertex's place, and the places of the triangle's others."""
    corners = vertices[triangles]
    return corners.reshape(-1, 3), np.repeat(corners.reshape(-1, 1, 9), 3, axis=1).reshape(-1, 9)


def test_bricks_in_one_patch_have_no_seams():
    volume = carved()
    stroke(volume, 8, 7)
    mesher = riffler.Mesher(volume)
    assert mesher.shape == (4, 4, 2)  # 122, 98 and 50 points
    whole = volume.to_mesh()
    patch = mesher.patch(mesher.patches())
    vertices, triangles = patch.vertices, patch.triangles
    assert vertices.dtype == np.float32 and triangles.dtype == np.int32
    assert len(vertices) == len(whole.vertices)
    assert np.array_equal(sorted_corners(vertices, triangles), sorted_corners(whole.vertices, whole.triangles))
    some = np.array(mesher.patches())[::2]
    patch = mesher.patch(some)
    vertices, triangles = patch.vertices, patch.triangles
    singly = [mesher.patch(n) for n in some]
    assert np.array_equal(
        sorted_corners(vertices, triangles),
        sorted_corners(np.concatenate([p.vertices[p.triangles] for p in singly]), slice(None)),
    )
    assert len(np.unique(vertices, axis=0)) == len(vertices) < sum(len(p.vertices) for p in singly)
    none = mesher.patch([], edges=True)
    assert [a.shape for a in (none.vertices, none.triangles, none.edges, none.corner_edges)] == [
        (0, 3),
        (0, 3),
        (0, 2),
        (0, 3),
    ]


@pytest.mark.parametrize("bricks", [lambda all: all[0], lambda all: all[:3], lambda all: all])
def test_edges_are_those_of_the_triangles(bricks):
    mesher = riffler.Mesher(carved())
    bricks = bricks(mesher.patches())
    patch = mesher.patch(bricks, edges=True)
    triangles, edges, corner_edge = patch.triangles, patch.edges, patch.corner_edges
    assert np.array_equal(triangles, mesher.patch(bricks).triangles)
    assert edges.dtype == corner_edge.dtype == np.int32
    sides = np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2), axis=2)
    assert np.array_equal(np.sort(edges, axis=1)[corner_edge], sides)
    assert len(edges) == len(np.unique(np.sort(edges, axis=1), axis=0)) == len(np.unique(sides.reshape(-1, 2), axis=0))


def test_pick_finds_the_first_triangle_that_a_ray_meets():
    volume = carved()
    mesher = riffler.Mesher(volume)
    distance, point, normal, brick = mesher.pick([8, 7, 20], [0, 0, -3])
    assert distance == pytest.approx(8, abs=1e-6)
    assert point == pytest.approx([8, 7, 12], abs=1e-6)
    assert normal.tolist() == [0, 0, 1]
    vertices = mesher.patch(brick).vertices
    assert (vertices.min(axis=0) <= point + 1e-6).all() and (point <= vertices.max(axis=0) + 1e-6).all()
    assert mesher.pick([8, 7, 20], [0, 0, 1]) is None
    stroke(volume, 8, 7)
    mesher.update(volume)
    # The ball's centre runs down from z = 12.5 with slope 0.2 / 1.5: a cylinder's lowest line.
    depth = 20 - (12.5 - 1.5 * np.hypot(1, 0.2 / 1.5))
    assert mesher.pick([8, 7, 20], [0, 0, -1])[0] == pytest.approx(depth, abs=1e-3)


def test_many_rays_at_once_give_the_same_hits_as_one_by_one():
    mesher = riffler.Mesher(carved())
    rng = np.random.default_rng(3)
    origins = rng.uniform(-10, 40, (500, 3))
    directions = rng.normal(size=(500, 3))
    distances, points, normals, bricks = mesher.pick(origins, directions)
    assert distances.shape == bricks.shape == (500,) and points.shape == normals.shape == (500, 3)
    hits = 0
    for n in range(500):
        hit = mesher.pick(origins[n], directions[n])
        if hit is None:
            assert distances[n] == np.inf and bricks[n] == -1
            assert np.isnan(points[n]).all() and np.isnan(normals[n]).all()
            continue
        hits += 1
        assert hit[0] == distances[n] and hit[3] == bricks[n]
        assert np.array_equal(hit[1], points[n]) and np.array_equal(hit[2], normals[n])
    assert 50 < hits < 450
    assert [len(a) for a in mesher.pick(np.empty((0, 3)), np.empty((0, 3)))] == [0, 0, 0, 0]


def test_a_frozen_surface_does_not_change():
    volume = carved()
    mesher = riffler.Mesher(volume)
    frozen = mesher.freeze()
    assert frozen.triangles == mesher.triangles
    assert frozen.nbytes < 40 * frozen.triangles
    mesher.take_counters()
    stroke(volume, 8, 7)
    changed = mesher.update(volume)
    down = [8, 7, 20], [0, 0, -1]
    assert frozen.pick(*down)[0] == pytest.approx(8, abs=1e-6)
    assert mesher.pick(*down)[0] > 8.9
    again = mesher.freeze()
    assert again.pick(*down)[0] == mesher.pick(*down)[0]
    assert mesher.take_counters().bricks_prepared == len(changed)
    del mesher
    assert frozen.pick(*down)[0] == pytest.approx(8, abs=1e-6)
    counts = frozen.take_counters()
    assert counts.rays == 2 and counts.bricks_prepared == 0
    assert 0 < counts.triangles_tested < frozen.triangles / 20
    assert set(dataclasses.astuple(frozen.take_counters())) == {0}


def test_wrong_rays_are_refused():
    mesher = riffler.Mesher(carved())
    for surface in (mesher, mesher.freeze()):
        with pytest.raises(ValueError, match=r"^direction: zero"):
            surface.pick([0, 0, 0], [0, 0, 0])
        with pytest.raises(ValueError, match=r"^direction, row 1: zero"):
            surface.pick(np.zeros((2, 3)), [[0, 0, 1], [0, 0, 0]])
        with pytest.raises(ValueError, match=r"^origin, row 1: not finite"):
            surface.pick([[0, 0, 0], [0, np.nan, 0]], np.ones((2, 3)))
        with pytest.raises(ValueError, match=r"^origin must be finite"):
            surface.pick([0, 0, np.inf], [0, 0, 1])
        with pytest.raises(ValueError, match=r"^direction must have as many rows as origin, 2, not 3"):
            surface.pick(np.zeros((2, 3)), np.ones((3, 3)))
        with pytest.raises(ValueError, match=r"^direction must have the shape \(n, 3\), not \(3,\)"):
            surface.pick(np.zeros((2, 3)), [0, 0, 1])
        with pytest.raises(ValueError, match=r"^origin must be three numbers"):
            surface.pick([0, 0], [0, 0, 1])


def test_wrong_bricks_are_refused():
    mesher = riffler.Mesher(carved())
    with pytest.raises(ValueError, match=r"^bricks: 1 is listed twice"):
        mesher.patch([1, 0, 1])
    with pytest.raises(IndexError, match="no brick 1000000"):
        mesher.patch([0, 1_000_000])
    with pytest.raises(TypeError):
        mesher.patch(-1)


def test_wrong_calls_are_refused():
    mesher = riffler.Mesher(carved())
    with pytest.raises(ValueError, match="box, pitch and directions"):
        mesher.update(riffler.Volume.block([0, 0, 0], [30, 24, 12], 0.5, "xyz"))
    with pytest.raises(IndexError, match="no brick 1000000"):
        mesher.patch(1_000_000)
    with pytest.raises(riffler.Cancelled):
        riffler.Mesher(carved(), progress=lambda share: False)
