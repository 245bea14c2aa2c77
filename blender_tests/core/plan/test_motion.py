"""The tool's pose at each frame."""

import numpy as np
import pytest

from addon.common import quaternions
from addon.plan.pure import key_orientations, motion


def axes(count, seed=1):
    v = np.random.default_rng(seed).normal(size=(count, 3)) * [0.3, 0.3, 0.1] + [0, 0, 1]
    return v / np.linalg.norm(v, axis=1, keepdims=True)


def located(count=30, closed=False, seed=1):
    """A track with the locations of its points."""
    a = np.linspace(0, 2 * np.pi, count + 1)[:count]
    centres = np.c_[20 * np.cos(a), 15 * np.sin(a), 2 * np.sin(2 * a)]
    turn = axes(count, seed)
    track = key_orientations.Track(centres, closed, 1, 3.0)
    start, points = np.hstack([centres - 3 * turn, turn]), np.arange(count)
    if closed:
        start, points = np.vstack([start, start[:1]]), np.append(points, 0)
    return track, start, points


@pytest.mark.parametrize("closed", [False, True])
def test_a_path_without_cutter_locations_is_at_its_points(closed):
    track, start, points = located(closed=closed)
    found = motion.along(track, start, points, None)
    assert np.array_equal(found.frames, track.frames) and np.array_equal(found.poses, start)
    assert found.frames[-1] == track.last
    lesser = motion.along(track, start[2:], points[2:], None)  # the tool has no location on the first two
    assert np.array_equal(lesser.frames, track.frames[2:])


@pytest.mark.parametrize("closed", [False, True])
def test_lifted_inserted_and_missing_rows_are_at_their_time(closed):
    track, start, points = located(closed=closed)
    lift = np.random.default_rng(2).uniform(0, 5, len(start))[:, None]
    lifted = np.hstack([start[:, :3] + lift * start[:, 3:], start[:, 3:]])
    found = motion.along(track, start, points, lifted)
    assert np.array_equal(found.frames, track.frames)
    middle = motion.between(lifted, np.array([6]), np.array([0.25]))
    middle[:, :3] += 0.5 * middle[:, 3:]
    rows = np.vstack([lifted[:3], lifted[5:7], middle, lifted[7:]])  # two blocked points, one row between
    found = motion.along(track, start, points, rows)
    assert np.array_equal(np.delete(found.frames, 5), np.delete(track.frames, [3, 4]))
    assert track.frames[6] < found.frames[5] < track.frames[7]


def test_rows_next_to_a_long_lift_have_their_own_keys():
    track = key_orientations.Track(np.c_[np.arange(3.0), np.zeros((3, 2))], False, 1, 2.0)
    start = np.hstack([np.c_[np.arange(3.0), np.zeros((3, 2))], np.tile([0.0, 0, 1], (3, 1))])
    high = np.c_[1 + np.linspace(0.1, 0.9, 9), np.zeros(9), np.full(9, 500.0), np.tile([0.0, 0, 1], (9, 1))]
    rows = np.vstack([start[:2], high, np.add(start[2:], [0, 0, 500, 0, 0, 0])])
    found = motion.along(track, start, np.arange(3), rows)
    assert np.array_equal(found.frames[[0, 1, -1]], track.frames)
    assert np.diff(found.frames).min() > motion.GAP and np.array_equal(motion.distinct(found).poses, rows)


def test_rows_without_room_are_thinned_and_the_last_one_stays():
    frames = np.array([1.0, 1.004, 1.008, 1.02, 1.025, 2.0, 2.005])
    poses = np.hstack([np.arange(21.0).reshape(7, 3), np.tile([0.0, 0, 1], (7, 1))])
    found = motion.distinct(motion.Motion(frames, poses))
    assert np.allclose(found.frames, [1, 1.02, 2.005]) and np.array_equal(found.poses, poses[[0, 3, 6]])
    alone = motion.distinct(motion.Motion(frames[:2], poses[:2]))
    assert np.array_equal(alone.poses, poses[:2])  # a path needs both its ends


def test_rows_with_a_constant_axis_are_distinguished_by_place():
    track = key_orientations.Track(np.c_[np.arange(50.0), np.zeros((50, 2))], False, 1, 2.0)
    start = np.hstack([np.c_[np.arange(50.0), np.zeros((50, 2))], np.tile([0.0, 0, 1], (50, 1))])
    rows = start[[0, 10, 11, 40, 49]] + [0, 0, 7, 0, 0, 0]
    assert np.array_equal(motion.along(track, start, np.arange(50), rows).frames, track.frames[[0, 10, 11, 40, 49]])


def test_rows_that_fit_no_point_are_spaced_by_the_tip_s_travel():
    track, start, points = located()
    other = np.array([(0, 0, 50, 0, 0, 1), (1, 0, 50, 0, 0, 1), (4, 0, 50, 0, 0, 1.0)])
    found = motion.along(track, start, points, other)
    assert np.allclose(found.frames, [track.first, track.first + (track.last - track.first) / 4, track.last])
    still = motion.along(track, start, points, np.repeat(other[:1], 3, axis=0))
    assert np.allclose(still.frames, [track.first, (track.first + track.last) / 2, track.last])


def test_no_turn_is_larger_than_a_step_and_no_row_is_lost():
    _, start, _ = located(12)
    coarse = motion.Motion(np.arange(12.0), start)
    found = motion.fine(coarse)
    assert quaternions.angle(found.poses[1:, 3:], found.poses[:-1, 3:]).max() <= motion.STEP * (1 + 1e-9)
    whole = np.searchsorted(found.frames, coarse.frames)
    assert np.array_equal(found.poses[whole], start) and np.array_equal(found.frames[whole], coarse.frames)
    slow = motion.Motion(np.arange(3.0), np.tile([1.0, 2, 3, 0, 0, 1], (3, 1)))
    assert len(motion.fine(slow)) == 3 and len(motion.fine(motion.Motion(slow.frames[:1], slow.poses[:1]))) == 1


def test_rows_equal_in_single_precision_merge_into_the_last():
    frames = np.array([1e6, 1e6 + 0.01, 1e6 + 0.02, 1e6 + 1])
    poses = np.hstack([np.arange(12.0).reshape(4, 3), np.tile([0.0, 0, 1], (4, 1))])
    found = motion.distinct(motion.Motion(frames, poses))
    assert np.array_equal(found.poses, poses[2:]) and np.all(np.diff(np.float32(found.frames)) > 0)


def test_paths_are_joined_with_jumps_between():
    _, start, _ = located(12)
    a, b = motion.Motion(np.arange(12.0), start), motion.Motion(40 + np.arange(12.0), start[::-1])
    frames, tips, quats, ends = motion.joined([motion.played(a), motion.played(b)])
    first = len(motion.fine(a))
    assert ends.tolist() == [first - 1, len(frames) - 1] and frames[first] == 40 and np.all(np.diff(frames) > 0)
    assert np.array_equal(tips[first], start[-1, :3]) and np.allclose(quaternions.axes_of(quats)[0], start[0, 3:])
    alone = motion.played(b).quats
    assert np.array_equal(quats[first:], alone) and np.all(np.einsum("ij,ij->i", alone[1:], alone[:-1]) > 0)
    nothing = motion.played(motion.Motion(np.empty(0), np.empty((0, 6))))
    assert np.array_equal(motion.joined([nothing, motion.played(a)])[0], frames[:first])
    assert [len(x) for x in motion.joined([])] == [0, 0, 0, 0]
