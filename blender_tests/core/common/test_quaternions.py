"""Quaternions of tool axes, against scipy's rotations."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation, Slerp

from addon.common import quaternions


def rotation(q):
    return Rotation.from_quat(np.roll(np.atleast_2d(q), -1, axis=1))  # scipy has w last


def random_axes(count, seed):
    v = np.random.default_rng(seed).normal(size=(count, 3))
    return v / np.linalg.norm(v, axis=1, keepdims=True)


def test_products_and_axes_are_those_of_rotations():
    rng = np.random.default_rng(1)
    a, b = rng.normal(size=(2, 200, 4))
    product = rotation(a) * rotation(b)
    assert np.allclose(rotation(quaternions.multiply(a, b)).as_matrix(), product.as_matrix(), atol=1e-14)
    assert np.allclose(quaternions.axes_of(a), rotation(a).apply([0, 0, 1]), atol=1e-14)


@pytest.mark.parametrize("off", [0.0, 1e-12, 1e-9, 1e-6, 1e-3, 1.0, np.pi - 1e-3, np.pi - 1e-6])
def test_the_shortest_turn_hits_the_axis_and_is_no_longer_than_the_angle(off):
    a = random_axes(50, 2)
    side = np.cross(a, random_axes(50, 3))
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    b = np.cos(off) * a + np.sin(off) * side
    turn = rotation(quaternions.between(a, b))
    assert np.allclose(turn.apply(a), b, atol=1e-9)
    assert np.allclose(turn.magnitude(), off, atol=1e-7)


def test_opposite_axes_are_joined_by_a_half_turn():
    a = np.vstack([random_axes(20, 4), np.eye(3), -np.eye(3)])
    turn = rotation(quaternions.between(a, -a))
    assert np.allclose(turn.apply(a), -a, atol=1e-12) and np.allclose(turn.magnitude(), np.pi)


def test_transport_twists_nowhere():
    """Each quaternion gives its axis, and the rotation axis from one to the next is perpendicular to both axes."""
    t = np.linspace(0, 1, 333)
    axes = np.c_[np.sin(3 * t) * np.cos(9 * t), np.sin(3 * t) * np.sin(9 * t), np.cos(3 * t)]  # from pole to pole
    q = quaternions.transported(axes)
    assert np.allclose(rotation(q).apply([0, 0, 1]), axes, atol=1e-12)
    turns = (rotation(q[1:]) * rotation(q[:-1]).inv()).as_rotvec()
    assert np.abs(np.einsum("ij,ij->i", turns, axes[1:])).max() < 1e-12
    assert np.allclose(np.linalg.norm(turns, axis=1), quaternions.angle(axes[1:], axes[:-1]), atol=1e-12)
    assert np.all(np.einsum("ij,ij->i", q[1:], q[:-1]) > 0.99)


@pytest.mark.parametrize("count", [1, 2, 3, 4, 5, 1000])
def test_transport_is_the_chain_of_shortest_turns_for_any_length(count):
    axes = random_axes(count, 5)
    before = np.array([0.5, -0.5, 0.5, 0.5])
    q = before
    for axis, found in zip(axes, quaternions.transported(axes, before), strict=True):
        q = quaternions.multiply(quaternions.between(quaternions.axes_of(q), axis), q)
        assert min(np.abs(found - q).max(), np.abs(found + q).max()) < 1e-10


def test_signs_are_aligned_and_orientations_stay():
    q = quaternions.transported(random_axes(40, 6))
    q = np.repeat(q, 2, axis=0) * np.random.default_rng(7).choice([-1.0, 1.0], 80)[:, None]
    found = quaternions.aligned(q)
    assert np.all(np.einsum("ij,ij->i", found[1:], found[:-1]) >= 0)
    assert np.array_equal(np.abs(found), np.abs(q)) and np.array_equal(found[0], q[0])
    assert len(quaternions.aligned(np.empty((0, 4)))) == 0


def test_angles_too_small_for_a_cosine_are_exact():
    a = np.array([0.0, 0, 1])
    for small in (1e-9, 1e-12):
        assert quaternions.angle(a, np.array([np.sin(small), 0, np.cos(small)])) == pytest.approx(small, rel=1e-6)
    assert quaternions.angle(a, -a) == pytest.approx(np.pi)


def test_great_circles_are_those_of_slerp():
    a, b = random_axes(30, 8), random_axes(30, 9)
    b[0] = a[0]
    for k in range(30):
        turn = rotation(quaternions.between(a[k], b[k]))
        ways = Slerp([0, 1], Rotation.concatenate([Rotation.identity(1), turn]))
        share = np.linspace(0, 1, 7)
        found = quaternions.slerp(np.tile(a[k], (7, 1)), np.tile(b[k], (7, 1)), share)
        assert np.allclose(found, ways(share).apply(a[k]), atol=1e-12)
