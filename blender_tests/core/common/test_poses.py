"""Tool axes along paths."""

import numpy as np
import pytest

from addon.common import poses

ANGLE = np.linspace(0, 2 * np.pi, 73)
CIRCLE = np.c_[10 * np.cos(ANGLE), 10 * np.sin(ANGLE), 0 * ANGLE]
CIRCLE[-1] = CIRCLE[0]


def test_without_tilt_a_level_path_has_an_upright_tool():
    assert np.allclose(poses.tilted_axes(CIRCLE, 0 * ANGLE), (0, 0, 1))


def test_tilt_turns_about_the_tangent():
    axes = poses.tilted_axes(CIRCLE, np.full(len(ANGLE), np.radians(25)))
    # right hand about the direction of travel (counter-clockwise): the top leans outwards
    outward = CIRCLE / 10
    expected = np.cos(np.radians(25)) * np.array([0, 0, 1]) + np.sin(np.radians(25)) * outward
    assert np.allclose(axes, expected, atol=1e-12)


def test_a_tool_on_a_ramp_stays_perpendicular_to_the_path():
    p = np.array([(0, 0, 0), (1, 0, -1.0), (2, 0, -2)])
    axes = poses.tilted_axes(p, np.zeros(3))
    assert np.allclose(axes, np.array([1, 0, 1]) / np.sqrt(2))


@pytest.mark.parametrize(
    "p", [[(0, 0, 0), (0, 0, -5)], [(0, 0, 0), (0, 0, -5), (3, 0, -5)], [(0, 0, 0), (3, 0, 0), (3, 0, -5)]]
)
def test_an_upright_path_has_unit_axes_perpendicular_to_it(p):
    p = np.array(p, float)
    axes = poses.tilted_axes(p, np.zeros(len(p)))
    assert np.allclose(np.linalg.norm(axes, axis=1), 1)
    assert np.abs((axes * poses.tangents(p)).sum(axis=1)).max() < 1e-9


def test_turning_straight_back_has_a_tangent():
    assert np.isfinite(poses.tangents(np.array([(0, 0, 0), (1, 0, 0), (0, 0, 0.0)]))).all()


def test_depth_goes_against_the_axis():
    axes = np.array([(0, 0.6, 0.8)])
    row = poses.make_poses(np.array([(1.0, 2, 3)]), axes, 2.0)[0]
    assert np.allclose(row, (1, 2 - 1.2, 3 - 1.6, 0, 0.6, 0.8))


def brute_mean(p, axes, window, k):
    """Dense sampling of the polyline's axes within the window: the reference."""
    s = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(p, axis=0), axis=1))])
    half = 0.5 * min(window, s[-1])
    x = np.linspace(s[k] - half, s[k] + half, 20001)
    closed = np.array_equal(p[0], p[-1])
    x = np.mod(x, s[-1]) if closed else x[(x >= 0) & (x <= s[-1])]
    mean = np.array([np.interp(x, s, axes[:, d]).mean() for d in range(3)])
    return mean / np.linalg.norm(mean)


@pytest.mark.parametrize("closed", [False, True])
def test_smoothing_is_the_mean_over_the_window(closed):
    rng = np.random.default_rng(5)
    p = np.cumsum(rng.uniform(0.05, 1.5, (30, 3)), axis=0)
    if closed:
        p = CIRCLE[np.sort(rng.choice(np.arange(1, 72), 30, replace=False))]
        p = np.vstack([p, p[:1]])
    axes = poses.unit(np.array([0, 0, 1]) + 0.5 * rng.normal(size=p.shape))
    if closed:
        axes[-1] = axes[0]
    smooth = poses.smooth_axes(p, axes, 4.0)
    for k in range(len(p)):
        assert np.allclose(smooth[k], brute_mean(p, axes, 4.0, k), atol=2e-3), k
    if closed:
        assert np.allclose(smooth[0], smooth[-1])


def test_smoothing_constant_axes_changes_nothing():
    axes = np.tile([0, 0.6, 0.8], (len(CIRCLE), 1))
    assert np.allclose(poses.smooth_axes(CIRCLE, axes, 3), axes)
