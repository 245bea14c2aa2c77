"""Splines against closed forms."""

from itertools import pairwise

import numpy as np
import pytest

from addon.common import splines
from addon.common.splines import Spline

RNG = np.random.default_rng(11)


def bezier(points, left, right, **more):
    points, left, right = (np.array(a, float) for a in (points, left, right))
    return Spline("BEZIER", points, left=left, right=right, **more)


def de_casteljau(b, t):
    while len(b) > 1:
        b = [p + (q - p) * t for p, q in pairwise(b)]
    return b[0]


def polyline_distance(points, line):
    a, d = line[:-1], np.diff(line, axis=0)
    t = np.clip(((points[:, None] - a) * d).sum(2) / np.maximum((d * d).sum(1), 1e-300), 0, 1)
    return np.linalg.norm(points[:, None] - (a + t[..., None] * d), axis=2).min(axis=1)


@pytest.mark.parametrize("tolerance", [1.0, 0.1, 0.01, 0.001])
def test_a_bezier_polyline_stays_within_the_tolerance(tolerance):
    for _ in range(20):
        p, left, right = (RNG.uniform(-20, 20, (3, 3)) for _ in range(3))
        line, _ = splines.evaluate(bezier(p, left, right), tolerance)
        for i in range(2):
            control = [p[i], right[i], left[i + 1], p[i + 1]]
            exact = de_casteljau(control, np.linspace(0, 1, 301)[:, None])
            assert polyline_distance(exact, line).max() <= tolerance


def test_the_number_of_points_follows_the_tolerance():
    p, left, right = (RNG.uniform(-20, 20, (2, 3)) for _ in range(3))
    coarse, fine = (len(splines.evaluate(bezier(p, left, right), t)[0]) for t in (0.1, 0.001))
    assert 9 < (fine - 1) / (coarse - 1) < 11  # square root of 100, rounded up


def test_a_straight_bezier_is_two_points():
    line, _ = splines.evaluate(
        bezier([[0, 0, 0], [30, 0, 0]], [[-10, 0, 0], [20, 0, 0]], [[10, 0, 0], [40, 0, 0]]), 0.01
    )
    assert np.array_equal(line, [[0, 0, 0], [30, 0, 0]])


def test_a_rational_nurbs_circle_is_a_circle():
    # nine points, order 3, the classic circle; Blender's clamped Bézier knots are its knots up to scale
    s = np.sqrt(0.5)
    points = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)]
    points = np.hstack([10 * np.array(points, float), np.zeros((9, 1))])
    spline = Spline("NURBS", points, weights=np.array([1, s, 1, s, 1, s, 1, s, 1]), order=3, endpoint=True, bezier=True)
    for tolerance in (0.1, 0.001):
        line, _ = splines.evaluate(spline, tolerance)
        middle = 0.5 * (line[:-1] + line[1:])
        assert np.allclose(np.linalg.norm(line, axis=1), 10, atol=1e-12)
        assert np.abs(np.linalg.norm(middle, axis=1) - 10).max() <= tolerance


def test_uniform_cubic_nurbs_is_the_b_spline():
    p = RNG.uniform(-5, 5, (6, 3))
    line, _ = splines.evaluate(Spline("NURBS", p, order=4), 1e-4)
    ends = [(p[k] + 4 * p[k + 1] + p[k + 2]) / 6 for k in (0, 3)]
    assert np.allclose(line[0], ends[0]) and np.allclose(line[-1], ends[1])


def test_cyclic_splines_end_where_they_begin():
    p, left, right = (RNG.uniform(-20, 20, (4, 3)) for _ in range(3))
    for spline in (
        bezier(p, left, right, cyclic=True),
        Spline("NURBS", p, cyclic=True, order=3),
        Spline("POLY", p, cyclic=True),
    ):
        line, _ = splines.evaluate(spline, 0.01)
        assert np.array_equal(line[0], line[-1])


def test_coinciding_points_are_merged():
    line, tilt = splines.evaluate(
        Spline("POLY", [(0, 0, 0), (0, 0, 0), (1, 0, 0), (1, 0, 0)], tilt=np.arange(4.0)), 0.01
    )
    assert np.array_equal(line, [(0, 0, 0), (1, 0, 0)]) and np.array_equal(tilt, [0, 2])


def test_refine_keeps_the_polyline_and_its_corners():
    p = np.array([(0, 0, 0), (1, 0, 0), (1, 2.5, 0)])
    line, tilt = splines.refine(p, np.array([0.0, 1, 2]), 0.5)
    assert np.linalg.norm(np.diff(line, axis=0), axis=1).max() <= 0.5 + 1e-12
    assert all((line == q).all(axis=1).any() for q in p)
    assert np.allclose(tilt, np.where(line[:, 1] > 0, 1 + line[:, 1] / 2.5, line[:, 0]))


@pytest.mark.parametrize(
    ("spline", "tolerance", "word"),
    [
        (Spline("POLY", [(0, 0, np.nan), (1, 0, 0)]), 0.01, "finite"),
        (Spline("POLY", [(0, 0, 0), (1, 0, 0)]), 0.0, "tolerance"),
        (Spline("POLY", [(0, 0, 0), (1, 0, 0)]), np.nan, "tolerance"),
        (Spline("NURBS", RNG.uniform(0, 1, (5, 3)), weights=np.array([1, 1, 0, 1, 1.0])), 0.01, "weight"),
        (bezier([[0, 0, 0], [1e9, 0, 0]], [[0, 9e9, 0]] * 2, [[0, 9e9, 0]] * 2), 1e-9, "tolerance"),
        (Spline("CARDINAL", [(0, 0, 0), (1, 0, 0)]), 0.01, "CARDINAL"),
    ],
)
def test_bad_splines_and_tolerances_are_refused(spline, tolerance, word):
    with pytest.raises(ValueError, match=word):
        splines.evaluate(spline, tolerance)
