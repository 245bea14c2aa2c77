"""Force and torque of the removed material of moves that turn the tool, against an integral in numpy: each point of a
lattice is removed at the first time at which the tool, from its profile alone, contains it."""

import functools

import numpy as np
import pytest
from riffler import Tool, Volume

CONSTANT, DT = 0.05, 0.02  # N·s/mm³, s
BOX = np.array([[-12.0, -10, -8], [14, 10, 0]])
SPACING, TIMES = 0.32, 120


def ball(z):
    return np.where(z < 3, np.sqrt(np.clip(9 - (3 - z) ** 2, 0, None)), 3.0)


def flat(z):
    return np.full_like(z, 3.0)


def cone(z):
    return np.minimum(0.5 + 0.25 * z, 4.0)


TOOLS = {
    "ball": (Tool.ball(6, 30), ball),
    "flat": (Tool.flat(6, 30), flat),
    "cone": (Tool.profile([(0.5, 0), (4, 14)], length=30), cone),
}


def unit(*v):
    return np.asarray(v, float) / np.linalg.norm(v)


MOVES = {
    "forward, by 20 degrees": ([-4, 0, -3], unit(-0.17, 0, 1), [3, 1, -3.5], unit(0.17, 0.1, 1)),
    "in one place": ([0, 0, -4], unit(-0.5, 0, 1), [0, 0, -4], unit(0.5, 0.2, 1)),
    "upwards, sideways": ([-3, -2, -5], unit(0, -0.6, 1), [2, 2, -2], unit(0.3, 0.4, 1)),
}


@functools.cache
def truth(name, move):
    """(removed mm³, force N, torque N·mm about the last tip)."""
    radius, (from_tip, from_axis, to_tip, to_axis) = TOOLS[name][1], MOVES[move]
    from_tip, to_tip = np.asarray(from_tip, float), np.asarray(to_tip, float)
    sides = [np.arange(low + SPACING / 2, high, SPACING) for low, high in BOX.T]
    points = np.stack(np.meshgrid(*sides, indexing="ij"), -1).reshape(-1, 3)
    angle = np.arccos(np.clip(from_axis @ to_axis, -1, 1))
    normal = np.cross(from_axis, to_axis) / np.linalg.norm(np.cross(from_axis, to_axis))
    side, spin, way = np.cross(normal, from_axis), angle * normal, to_tip - from_tip
    force, torque, removed = np.zeros(3), np.zeros(3), 0.0
    cell = SPACING**3
    for t in (np.arange(TIMES + 1)) / TIMES:
        axis, tip = np.cos(t * angle) * from_axis + np.sin(t * angle) * side, from_tip + t * way
        z = (points - tip) @ axis
        aside = np.linalg.norm(points - tip - z[:, None] * axis, axis=1)
        inside = (z >= 0) & (z <= 30) & (aside <= radius(z))
        gone, points = points[inside], points[~inside]
        if t == 0:  # what the tool stands in before it moves has been removed before
            continue
        velocity = way + np.cross(spin, gone - tip)
        pushes = -CONSTANT * cell / DT * velocity / np.linalg.norm(velocity, axis=1)[:, None]
        force += pushes.sum(0)
        torque += np.cross(gone - to_tip, pushes).sum(0)
        removed += cell * len(gone)
    return removed, force, torque


def carved(name, move, parts, directions):
    """The same from Volume.carve, in so many moves of equal duration."""
    from_tip, from_axis, to_tip, to_axis = MOVES[move]
    volume = Volume.block(BOX[0], BOX[1], 0.2, directions=directions)
    share = np.linspace(0, 1, parts + 1)[:, None]
    angle = np.arccos(from_axis @ to_axis)
    axes = (np.sin((1 - share) * angle) * from_axis + np.sin(share * angle) * to_axis) / np.sin(angle)
    poses = np.hstack([(1 - share) * from_tip + share * to_tip, axes])
    volume.carve(TOOLS[name][0], poses[[0, 0]])
    cut = volume.carve(TOOLS[name][0], poses, dt=DT / parts, removal_constant=CONSTANT)
    force = cut.force / parts  # of a part of the time
    torque = cut.torque / parts + np.cross(poses[1:, :3] - to_tip, force)
    return cut.removed.sum(), force.sum(0), torque.sum(0)


@pytest.mark.parametrize("directions", ["z", "xyz"])
@pytest.mark.parametrize("move", MOVES)
@pytest.mark.parametrize("name", TOOLS)
def test_a_turning_move_pushes_as_its_integral(name, move, directions):
    removed, force, torque = truth(name, move)
    # A step takes one direction for all that a ray loses in it, so smaller moves are closer to the integral.
    for parts, most in ((1, 0.12), (16, 0.05)):
        got, pushes, turns = carved(name, move, parts, directions)
        assert got == pytest.approx(removed, rel=0.02)
        assert np.linalg.norm(pushes - force) < most * np.linalg.norm(force)
        assert np.linalg.norm(turns - torque) < most * np.linalg.norm(torque)
