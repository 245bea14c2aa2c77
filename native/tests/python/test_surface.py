"""riffler.Surface: what Python adds to the core's tests (native/tests/nurbs)."""

import copy

import numpy as np
import pytest
import riffler

R = 0.5**0.5
CIRCLE = np.array([[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]], float)
WEIGHTS = np.array([1, R, 1, R, 1, R, 1, R, 1])
KNOTS = [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4]


def torus(ring=10.0, tube=3.0):
    profile = np.array([ring, 0]) + tube * CIRCLE
    points = np.empty((9, 9, 3))
    points[..., :2] = CIRCLE[:, None] * profile[None, :, :1]
    points[..., 2] = profile[None, :, 1]
    return riffler.Surface.nurbs(points, np.outer(WEIGHTS, WEIGHTS), KNOTS, KNOTS, 2, 2)


TORUS = torus()
POINTS = np.random.default_rng(8).uniform(-15, 15, (400, 3))


def distance_to_torus(points):
    return np.abs(np.hypot(np.hypot(points[:, 0], points[:, 1]) - 10, points[:, 2]) - 3)


def test_points_normals_and_distances_are_those_of_a_torus():
    uv = np.random.default_rng(9).uniform(0, 4, (300, 2))
    points, normals = TORUS.evaluate(uv)
    assert distance_to_torus(points).max() < 1e-12
    ring = points * [1, 1, 0]
    ring *= 10 / np.linalg.norm(ring, axis=1, keepdims=True)
    assert np.abs(normals - (points - ring) / 3).max() < 1e-12
    feet, normals, distance = TORUS.closest(POINTS)
    assert np.abs(distance - distance_to_torus(POINTS)).max() < 1e-9
    assert np.abs(np.linalg.norm(feet - POINTS, axis=1) - distance).max() < 1e-12
    assert np.abs(np.linalg.norm(normals, axis=1) - 1).max() < 1e-12


def bits():
    mesh = TORUS.to_mesh(0.01)
    arrays = [*TORUS.evaluate(POINTS[:, :2] / 15 + 2), *TORUS.closest(POINTS), mesh.vertices, mesh.triangles]
    return [a.tobytes() for a in arrays]


def test_any_number_of_threads_gives_the_same_bytes():
    found = []
    try:
        for threads in (1, 2, 5):
            riffler.set_threads(threads)
            found.append(bits())
    finally:
        riffler.set_threads(None)
    assert found[0] == found[1] == found[2]


@pytest.mark.parametrize(
    "call",
    [
        lambda progress: TORUS.evaluate(np.full((5000, 2), 1.5), progress=progress),
        lambda progress: TORUS.closest(POINTS, progress=progress),
        lambda progress: TORUS.to_mesh(0.01, progress=progress),
    ],
)
def test_long_calls_report_progress_and_are_cancelled(call):
    shares = []
    call(shares.append)
    assert shares == sorted(shares)
    assert shares[-1] == 1
    with pytest.raises(riffler.Cancelled):
        call(lambda share: False)


def test_calls_can_be_submitted():
    mesh = riffler.submit(TORUS.to_mesh, 0.05).result()
    assert mesh.triangles.tobytes() == TORUS.to_mesh(0.05).triangles.tobytes()
    assert riffler.submit(TORUS.closest, POINTS).result()[2].tobytes() == TORUS.closest(POINTS)[2].tobytes()


def test_patches_are_joined_and_counted():
    both = riffler.Surface([TORUS, torus(10, 1)])
    assert both.patch_count == 2
    assert both.domain(1).tolist() == [[0, 0], [4, 4]]
    assert both.bounds.tolist() == [[-13, -13, -3], [13, 13, 3]]
    assert np.hypot(*(both.evaluate([[0, 1]], patch=1)[0][0, [0, 2]] - [10, 0])) == pytest.approx(1)
    assert copy.deepcopy(both) is both
    assert both.closest([[10, 0, 0]])[2][0] == pytest.approx(1)


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"points": np.zeros((2, 2, 4))}, "shape \\(nu, nv, 3\\), not \\(2, 2, 4\\); weights are"),
        ({"points": np.zeros((2, 3))}, "points must be numbers of the shape"),
        ({"points": "abc"}, "points must be numbers"),
        ({"weights": np.ones((2, 3))}, "weights must have the shape \\(2, 2\\)"),
        ({"weights": [[1, 1], [0, 1]]}, "weights, row \\(1, 0\\): 0 is not positive"),
        ({"knots_u": [[0, 0], [1, 1]]}, "knots_u must be a list of numbers"),
        ({"knots_v": [0, 1]}, "knots_v has 2 knots, but 2 points of degree 1 need 4 .*repeat them"),
        ({"degree_u": 0}, "degree_u must be from 1 to 15, not 0"),
    ],
)
def test_wrong_arguments_are_named(change, text):
    good = {
        "points": [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]],
        "weights": [[1, 1], [1, 1]],
        "knots_u": [0, 0, 1, 1],
        "knots_v": [0, 0, 1, 1],
        "degree_u": 1,
        "degree_v": 1,
    }
    assert riffler.Surface.nurbs(**good).patch_count == 1
    with pytest.raises(ValueError, match=text):
        riffler.Surface.nurbs(**(good | change))


def test_patches_that_do_not_exist_are_refused():
    for call in (TORUS.domain, lambda patch: TORUS.evaluate([[0, 0]], patch=patch)):
        for patch in (-1, 1):
            with pytest.raises(ValueError, match=f"patch {patch} does not exist"):
                call(patch)
    with pytest.raises(ValueError, match="at least one patch"):
        riffler.Surface([])
    with pytest.raises(ValueError, match="row 1"):
        TORUS.evaluate([[0, 0], [5, 0]])
