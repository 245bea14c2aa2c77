"""The timeline's animation compared with the program: the reference is scipy's slerp."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation, Slerp

from addon.common import quaternions
from addon.plan.pure import motion, playback


def program(count=40, seed=3):
    rng = np.random.default_rng(seed)
    v = np.cumsum(rng.normal(size=(count, 3)) * 0.2, axis=0) + np.array([0, 0, 1])
    axes = v / np.linalg.norm(v, axis=1, keepdims=True)
    tips = np.cumsum(rng.uniform(-2, 2, (count, 3)), axis=0) + 90
    return motion.Motion(np.cumsum(rng.uniform(0.2, 3, count)), np.hstack([tips, axes]))


def player(frames, tips, quats):
    """F-curves as in Blender: single precision, linear between keys, by component."""
    frames, tips, quats = (np.float32(x).astype(float) for x in (frames, tips, quats))

    def play(at):
        rows = np.hstack([tips, quats])
        out = np.stack([np.interp(at, frames, column) for column in rows.T], axis=1)
        return out[:, :3], out[:, 3:]

    return play


def baked(way):
    frames, tips, quats, _ = motion.joined([motion.played(way)])
    return player(frames, tips, quats)


def test_a_baked_program_plays_as_it_cuts():
    way = program()
    found = playback.compare(way, baked(way))
    assert found.small and found.tip < 2e-4 and found.axis < 1e-5
    assert found.samples == 10 * (len(way) - 1) + 1
    assert str(found) == "Plays within 0.0001 mm and 0.001° of the program"


def test_the_axis_moves_on_the_great_circle_between_rows():
    """The reference for the animation is independent code."""
    way = program()
    for k in range(len(way) - 1):
        a, b = way.poses[k, 3:], way.poses[k + 1, 3:]
        turn = Rotation.from_rotvec(np.cross(a, b) / np.linalg.norm(np.cross(a, b)) * np.arccos(np.dot(a, b)))
        share = np.linspace(0, 1, 5)
        wanted = Slerp([0, 1], Rotation.concatenate([Rotation.identity(), turn]))(share).apply(a)
        found = motion.between(way.poses, np.full(5, k), share)
        assert np.allclose(found[:, 3:], wanted, atol=1e-9)
        assert np.allclose(found[:, :3], np.linspace(way.poses[k, :3], way.poses[k + 1, :3], 5))


def test_keys_far_apart_are_reported_with_the_place():
    """Two keys 100° apart: at a quarter of the turn normalised lerp lags 1.66° behind, by the closed form."""
    a = np.radians(100)
    poses = np.array([(0, 0, 0, 0, 0, 1), (0, 0, 0, np.sin(a), 0, np.cos(a))])
    way = motion.Motion(np.array([1.0, 11.0]), poses)
    play = player(way.frames, poses[:, :3], quaternions.transported(poses[:, 3:]))
    found = playback.compare(way, play, samples=1000)
    share = np.linspace(0, 1, 100_001)
    half = a / 2
    angle = 2 * np.arctan2(share * np.sin(half), (1 - share) + share * np.cos(half))
    assert found.axis == pytest.approx(np.abs(angle - share * a).max(), rel=1e-4)
    assert not found.small and "off the program, at frame" in str(found)
    assert found.axis_frame == pytest.approx(1 + 10 * share[np.abs(angle - share * a).argmax()], abs=0.02) or (
        found.axis_frame == pytest.approx(11 - 10 * share[np.abs(angle - share * a).argmax()], abs=0.02)
    )


def test_a_jumping_sign_is_detected():
    way = program()
    frames, tips, quats, _ = motion.joined([motion.played(way)])
    quats[len(quats) // 2 :] *= -1
    found = playback.compare(way, player(frames, tips, quats))
    assert found.axis > 0.01 and not found.small  # half the turn between the two, at the middle
    k = len(quats) // 2
    assert frames[k - 1] - 1 <= found.axis_frame <= frames[k] + 1


def test_a_displaced_tip_is_detected_with_its_place():
    way = program()
    frames, tips, quats, _ = motion.joined([motion.played(way)])
    k = int(np.abs(frames - way.frames[20]).argmin())
    tips[k] += [0, 0.02, 0]
    found = playback.compare(way, player(frames, tips, quats))
    assert found.tip == pytest.approx(0.02, rel=1e-2) and found.tip_frame == pytest.approx(way.frames[20])
    assert "at frame" in str(found)


def test_rows_that_cannot_be_distinguished_are_not_hidden():
    """Frames beyond what single precision resolves: rows vanish from the animation, and the difference says so."""
    way = program()
    late = motion.Motion(4e6 + 0.05 * way.frames, way.poses)
    assert playback.compare(late, baked(late)).tip > 0.5


def test_a_zero_quaternion_counts_as_the_opposite_axis():
    way = program()
    play = baked(way)
    found = playback.compare(way, lambda frames: (play(frames)[0], 0 * play(frames)[1]))
    assert found.axis == np.pi and found.tip < 2e-4


def test_empty_programs_and_single_poses_are_compared():
    assert playback.compare(motion.Motion(np.empty(0), np.empty((0, 6))), None) == playback.Difference()
    one = motion.Motion(np.array([3.0]), np.array([[1.0, 2, 3, 0, 0, 1]]))
    play = player(one.frames, one.poses[:, :3] + [1, 0, 0], np.array([[1.0, 0, 0, 0]]))
    found = playback.compare(one, play)
    assert found.tip == pytest.approx(1) and found.tip_frame == 3 and found.axis == 0


def test_the_worse_of_two_results_takes_the_larger_of_each_error():
    a, b = playback.Difference(1.0, 5, 0.1, 6, 10), playback.Difference(0.5, 7, 0.2, 8, 20)
    assert a.worse(b) == b.worse(a) == playback.Difference(1.0, 5, 0.2, 8, 30)
