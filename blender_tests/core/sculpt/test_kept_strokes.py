"""Strokes as curves: the fit's distance, the poses of a curve, and a history that follows any list to the byte."""

import itertools

import numpy as np
import pytest
import riffler
import scipy.spatial

from addon.common import poses, splines
from addon.common.contents import Content
from addon.sculpt.pure.stroke_curves import Chain, Stroke, chains, fit, sampled_axes
from addon.sculpt.pure.stroke_history import StrokeHistory, Wanted

BALL = {"kind": "ball", "diameter": 4.0, "length": 20.0}


def wave(count=200):
    t = np.linspace(0, 1, count)
    return np.c_[30 * t, 4 * np.sin(9 * t), np.cos(5 * t)]


@pytest.mark.parametrize("tolerance", [0.1, 0.01, 0.001])
def test_a_fitted_curve_is_within_the_tolerance_with_few_points(tolerance):
    points = wave()
    spline, error = fit(points, tolerance)
    assert (
        spline.kind == "NURBS" and error <= tolerance and len(spline.points) < {0.1: 13, 0.01: 25, 0.001: 45}[tolerance]
    )
    line, _ = splines.evaluate(spline, 1e-5)
    dense = np.vstack([a + np.linspace(0, 1, 50)[:, None] * (b - a) for a, b in itertools.pairwise(line)])
    far, _ = scipy.spatial.KDTree(dense).query(points)
    assert far.max() <= tolerance * 1.02 and np.array_equal(line[0], points[0])


def test_a_path_of_two_places_and_one_that_stands_stay_as_they_are():
    assert fit(np.array([[0.0, 0, 1], [0, 0, 0]]), 0.1)[0].points.tolist() == [[0, 0, 1], [0, 0, 0]]
    with pytest.raises(ValueError, match="no spline with two points"):
        chains(Stroke(BALL), [splines.Spline("POLY", np.zeros((1, 3)))], 0.5, 0.01)


def test_axes_keep_their_shares_of_the_length():
    points = wave()
    axes = poses.unit(np.c_[np.sin(points[:, 0] / 20), 0 * points[:, 0], np.ones(len(points))])
    path = poses.make_poses(points, axes)
    stroke = Stroke(BALL, axes=(sampled_axes(path),))
    (chain,) = chains(Stroke.of_text(stroke.text()), [fit(points, 0.005)[0]], 0.5, 0.005)
    expected = np.sin(chain.poses[:, 0] / 20) / np.sqrt(1 + np.sin(chain.poses[:, 0] / 20) ** 2)
    assert np.abs(chain.poses[:, 3] - expected).max() < 0.01
    with pytest.raises(ValueError, match="the stroke"):
        Stroke.of_text('{"tool": {}, "axes": 3}')


def test_a_history_that_follows_random_lists_is_a_replay_of_each_to_the_byte():
    random, base = np.random.default_rng(34), riffler.Volume.block((0, 0, 0), (20, 20, 8), 0.5, "xyz")
    history, rows, count = StrokeHistory(Content(base)), [], 0

    def chain():
        points = np.c_[random.uniform(2, 18, (3, 2)), random.uniform(6, 8, 3)]
        tool = {"kind": "ball", "diameter": float(random.uniform(2, 5)), "length": 20.0}
        return Chain(tool, poses.make_poses(points, poses.fixed_axes(3)), str(random.choice(["remove", "add"])))

    for _ in range(40):
        for _ in range(random.integers(1, 4)):  # several changes between two calls
            kind = random.integers(0, 5)
            if kind == 0 or len(rows) < 3:
                count += 1
                rows.insert(random.integers(0, len(rows) + 1), Wanted((count, 0), str(count), chain()))
                continue
            k = random.integers(0, len(rows))
            if kind == 1:
                rows.pop(k)
            elif kind == 2:
                rows.insert(random.integers(0, len(rows)), rows.pop(k))
            elif kind == 3:
                rows[k] = rows[k]._replace(on=not rows[k].on)
            else:
                count += 1
                rows[k] = rows[k]._replace(mark=str(count), chain=chain())
        history.follow(rows)
        replay = base.copy()
        for row in rows:
            if row.on:
                replay.carve(riffler.Tool.from_dict(row.chain.tool), row.chain.poses, mode=row.chain.mode)
        assert history.volume.to_bytes() == replay.to_bytes()
        assert [c.mode for c in history.content().cuts] == [row.chain.mode for row in rows if row.on]
    assert not history.follow(rows), "nothing to do"
