"""Colliding frames: computed clearances, runs, and their names."""

from itertools import pairwise

import numpy as np
import pytest

from addon.plan.pure import collisions


class Collider:
    """Clearance is the tip's height; counts its queries."""

    def __init__(self):
        self.asked = 0

    def clearance(self, tool, poses):
        self.asked += len(poses)
        return poses[:, 2]


def poses(heights):
    out = np.zeros((len(heights), 6))
    out[:, 0], out[:, 2], out[:, 5] = np.arange(len(heights)), heights, 1
    return out


def test_only_new_poses_are_checked():
    collider, known = Collider(), {}
    way = poses(np.linspace(-1, 1, 200))
    job = collisions.ClearanceJob(collider, None, way, known)
    while not job.step(0.0):
        assert 0 < job.fraction < 1 and job.text
    assert collider.asked == job.computed == 200 and np.array_equal(job.clearances, way[:, 2])
    way[50:60, 2] = -3
    again = collisions.ClearanceJob(collider, None, way, known)
    assert again.step() and collider.asked == 210 and np.array_equal(again.clearances, way[:, 2])
    assert collisions.ClearanceJob(collider, None, way, known).step(0.0) and collider.asked == 210


def test_a_repeated_pose_is_checked_once():
    collider = Collider()
    job = collisions.ClearanceJob(collider, None, np.vstack([poses([1.0, 2.0])] * 3), {})
    assert job.step() and collider.asked == 2 and job.clearances.tolist() == [1, 2] * 3
    nothing = collisions.ClearanceJob(collider, None, np.empty((0, 6)), {})
    assert nothing.fraction == 1 and nothing.step() and len(nothing.clearances) == 0


def test_adjacent_collisions_form_a_run_of_whole_frames():
    frames = np.array([1, 1.5, 2.2, 3, 4, 5.1, 6, 7])
    below = np.array([0, -1, -1, 0, 0, -1, 0, -1.0])
    assert collisions.runs(frames, below, -0.5) == [(1, 3), (5, 6), (7, 7)]
    assert collisions.runs(frames, 0 * below, -0.5) == []
    assert collisions.runs(frames, below - 1, -0.5) == [(1, 7)]


def test_runs_end_with_their_path():
    frames, below = np.array([1, 2, 3, 13, 14.0]), np.full(5, -1.0)
    assert collisions.runs(frames, below, 0) == [(1, 14)]
    assert collisions.runs(frames, below, 0, ends=[2, 4]) == [(1, 3), (13, 14)]


def test_runs_of_several_are_one_list_in_order():
    assert collisions.union([[(40, 50)], [], [(1, 3), (45, 60), (70, 70)], [(3, 4)]]) == [(1, 4), (40, 60), (70, 70)]
    assert collisions.union([]) == []


@pytest.mark.parametrize("most", [1, 2, 5, 64])
def test_too_many_runs_are_merged_over_the_smallest_gaps(most):
    rng = np.random.default_rng(4)
    edges = np.cumsum(rng.integers(1, 50, 400))
    found = [(int(a), int(b)) for a, b in edges.reshape(-1, 2)]
    out = collisions.merged(found, most)
    assert len(out) == most and out[0][0] == found[0][0] and out[-1][1] == found[-1][1]
    assert all(any(a <= x and y <= b for a, b in out) for x, y in found)  # nothing is lost
    left = sorted(b[0] - a[1] for a, b in pairwise(out))
    gaps = sorted(b[0] - a[1] for a, b in pairwise(found))
    assert left == gaps[len(gaps) - (most - 1) :]
    assert collisions.merged(found[:most], most) == found[:most]


def test_marks_are_distinguished_from_the_users_markers():
    for run in ((3, 3), (112, 130), (-5, 0)):
        assert collisions.is_label(collisions.label(run))
    assert collisions.label((112, 130)) == "collides 112–130"
    for other in ("collides", "collides soon", "F_01", "", "collides 1–2–3", "Collides 3"):
        assert not collisions.is_label(other)
