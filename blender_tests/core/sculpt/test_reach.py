"""How far a cutter sticks out of the stock's box, by its closed form and by points all around it."""

import numpy as np
import pytest
import riffler

from addon.sculpt.pure import reach

LOWER, UPPER = np.zeros(3), np.array([40.0, 30.0, 20.0])


def sticks_out(tool, *poses):
    return reach.past(reach.outline_of(tool), np.array(poses, float), LOWER, UPPER)


def test_a_ball_within_the_box_stands_nowhere_out_and_beside_a_side_by_its_own_radius():
    ball = riffler.Tool.ball(6, 4)
    assert sticks_out(ball, [20, 15, 10, 0, 0, 1], [25, 15, 10, 0, 0, 1]) == 0
    assert sticks_out(ball, [3, 15, 16, 0, 0, 1]) == 0
    assert sticks_out(ball, [2, 15, 10, 0, 0, 1]) == pytest.approx(1)
    assert sticks_out(ball, [20, 15, 10, 0, 0, 1], [20, 28, 10, 0, 0, 1]) == pytest.approx(1)
    assert sticks_out(ball, [20, 15, 18.5, 0, 0, 1]) == pytest.approx(2.5)
    assert sticks_out(ball, [20, 15, -2, 0, 0, 1]) == pytest.approx(2)
    assert sticks_out(ball, [1.5, 15, 10, 1, 0, 0]) == 0


def test_leaning_cutters_reach_as_far_as_points_on_them():
    rng = np.random.default_rng(3)
    for tool in (riffler.Tool.flat(6, 12), riffler.Tool.ball(4, 9), riffler.Tool.fillet(8, 2, 15)):
        outline = reach.outline_of(tool)
        around = np.linspace(0, 2 * np.pi, 720, endpoint=False)
        for _ in range(20):
            axis = rng.normal(size=3)
            axis /= np.linalg.norm(axis)
            side = np.cross(axis, [1, 0, 0] if abs(axis[0]) < 0.9 else [0, 1, 0])
            side /= np.linalg.norm(side)
            up = np.cross(axis, side)
            ring = np.cos(around)[:, None] * side + np.sin(around)[:, None] * up
            tip = rng.uniform(-5, 45, 3)
            points = tip + outline[:, None, 1:] * axis + outline[:, None, :1] * ring
            out = max((points - UPPER).max(), (LOWER - points).max(), 0)
            assert sticks_out(tool, [*tip, *axis]) == pytest.approx(out, abs=1e-3)
