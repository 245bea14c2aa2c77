"""Force and torque of the removed material of moves that turn the tool, against the integral in
riffler_bench.removal_integral, which uses nothing of the core."""

import functools

import numpy as np
import pytest
from riffler_bench import removal_integral
from riffler_bench.jobs import force


@functools.cache
def truth(name, move):
    return removal_integral.integral(removal_integral.RADII[name], removal_integral.MOVES[move])


@pytest.mark.parametrize("directions", ["z", "xyz"])
@pytest.mark.parametrize("move", removal_integral.MOVES)
@pytest.mark.parametrize("name", removal_integral.RADII)
def test_a_turning_move_pushes_as_its_integral(name, move, directions):
    removed, pushes, turns = truth(name, move)
    # A step takes one direction for all that a ray loses in it, so smaller moves are closer to the integral.
    for parts, most in ((1, 0.12), (16, 0.05)):
        got = force.turning(name, removal_integral.MOVES[move], 0.2, parts, directions)
        assert got[0] == pytest.approx(removed, rel=0.02)
        assert np.linalg.norm(got[1] - pushes) < most * np.linalg.norm(pushes)
        assert np.linalg.norm(got[2] - turns) < most * np.linalg.norm(turns)
