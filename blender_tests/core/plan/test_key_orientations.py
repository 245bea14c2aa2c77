"""The point of each frame on its path, and the keyframes' effect on a plan's keys."""

from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
import pytest

from addon.common import quaternions
from addon.plan.pure import key_orientations


@dataclass
class Path:
    centres: np.ndarray
    closed: bool = False
    keys: dict = field(default_factory=dict)


def line(*xs):
    return Path(np.array([(x, 0.0, 0.0) for x in xs]))


def circle(count, radius=10.0):
    a = 2 * np.pi * np.arange(count) / count
    return Path(radius * np.c_[np.cos(a), np.sin(a), 0 * a], True)


def quats(*axes):
    return quaternions.transported(np.array([np.array(a, float) / np.linalg.norm(a) for a in axes]))


X, Y, Z = (1.0, 0, 0), (0, 1.0, 0), (0, 0, 1.0)


def test_time_follows_the_feed():
    assert key_orientations.frames_per_mm(600, 24) == pytest.approx(2.4)  # 10 mm a second
    for feed, fps in ((0, 24), (-1, 24), (np.nan, 24), (600, 0), (np.inf, 24)):
        with pytest.raises(ValueError, match="positive"):
            key_orientations.frames_per_mm(feed, fps)
    for rate in (0, -1, np.nan, np.inf):
        with pytest.raises(ValueError, match="frames per mm"):
            key_orientations.Layout([line(0, 1)], rate)


def test_paths_lie_one_after_the_other_from_whole_frame_to_whole_frame():
    layout = key_orientations.Layout([line(0, 10.1), line(0, 3, 4), circle(4)], 2.0, first=5)
    a, b, c = layout.tracks
    assert (a.first, a.last) == (5, 26) and a.frames.tolist() == [5, 26]  # 20.2 frames, and one whole
    assert b.first == 26 + key_orientations.GAP and b.frames.tolist() == [36, 42, 44]
    assert c.frames[-1] == c.last == layout.last and len(c.frames) == 5  # the seam once more
    assert c.stations[-1] == pytest.approx(4 * 10 * np.sqrt(2))


def test_a_frame_belongs_to_the_nearest_point_of_its_path():
    layout = key_orientations.Layout([line(0, 10), line(0, 4, 5)], 1.0, first=1)
    assert layout.place(1) == (0, 0, 0.0) and layout.place(11) == (0, 1, 10.0)
    assert layout.place(6)[:2] == (0, 0)  # halfway: the earlier
    assert layout.place(6.01)[:2] == (0, 1) and layout.place(6.01)[2] == pytest.approx(5.01)
    assert layout.place(0.5)[:2] == (0, 0) and layout.place(11.5)[:2] == (0, 1)
    for outside in (0.4, 11.6, 16, 20.4, 27, -100, 1e9):
        assert layout.place(outside) is None
    assert layout.place(25.25)[:2] == (1, 1) and layout.place(25.5 + 1e-9)[:2] == (1, 2)


def test_the_seam_of_a_loop_is_its_first_point():
    track = key_orientations.Layout([circle(8)], 1.0).tracks[0]
    assert track.nearest(track.last) == 0 and track.nearest(track.first) == 0
    assert track.nearest(track.last - 0.4 * (track.frames[1] - 1)) == 0
    assert track.nearest(track.last - 0.6 * (track.frames[1] - 1)) == 7


def test_paths_without_length_have_places_too():
    single, still = key_orientations.Layout([line(3), line(2, 2, 2)], 1.0).tracks
    assert single.first == single.last == 1 and single.nearest(1) == 0 and single.frames.tolist() == [1]
    assert still.frames.tolist() == [11, 11.5, 12] and still.nearest(11.6) == 1
    assert key_orientations.Layout([], 1.0).place(1) is None and key_orientations.Layout([], 1.0).last == 0


@pytest.mark.parametrize("rate", [0.3, 1.0, 2.4, 17.0])
def test_every_point_has_its_own_keyframe_whole_if_possible(rate):
    rng = np.random.default_rng(3)
    layout = key_orientations.Layout([line(*np.cumsum(rng.uniform(0.01, 2, 60))), circle(50)], rate)
    for track in layout.tracks:
        for index in range(track.points):
            frame = track.frame_of(index)
            assert track.nearest(frame) == index and track.first <= frame <= track.last
            if frame != round(frame):  # then the whole frame is another point's
                assert track.nearest(min(max(round(frame), track.first), track.last)) != index
        assert track.frame_of(0) == track.first


def test_keyframes_become_keys_of_their_points():
    layout = key_orientations.Layout([line(0, 10), circle(12)], 1.0)
    ring = layout.tracks[1]
    frames = np.array([1, 15, ring.first, ring.frames[3] + 0.2])
    reading = key_orientations.read(layout, frames, quats(X, Y, Z, (1, 1, 1)))
    assert list(reading.keys[0]) == [0] and list(reading.keys[1]) == [0, 3]
    assert np.allclose(reading.keys[0][0], X) and np.allclose(reading.keys[1][3], np.ones(3) / np.sqrt(3))
    assert reading.outside == [15] and reading.frames[1, 3] == frames[3]
    assert reading.problems == ["key at frame 15 outside every path: ignored"]


def test_signs_lengths_and_twists_do_not_matter():
    layout = key_orientations.Layout([line(0, 10)], 1.0)
    q = quats((1, 2, 3))
    twist = quaternions.multiply(q, np.array([[np.cos(0.7), 0, 0, np.sin(0.7)]]))  # about the tool's own axis
    for same in (q, -q, 0.05 * q, 7 * q, twist):
        axis = key_orientations.read(layout, np.array([1.0]), same).keys[0][0]
        assert np.allclose(axis, np.array([1, 2, 3]) / np.sqrt(14), atol=1e-12)
    for none in ([0, 0, 0, 0], [np.nan, 0, 0, 1]):
        reading = key_orientations.read(layout, np.array([1.0]), np.array([none]))
        assert reading.keys == [{}] and "without an orientation" in reading.problems[0]


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_the_nearer_of_two_keys_at_a_point_counts(order):
    layout = key_orientations.Layout([line(0, 10, 20)], 1.0)
    frames, q = np.array([10.0, 11.5]), quats(X, Y)
    reading = key_orientations.read(layout, frames[list(order)], q[list(order)])
    assert np.allclose(reading.keys[0][1], Y) and reading.frames[0, 1] == 11.5 and reading.doubled == [10.0]
    assert "nearer" in reading.problems[0]


def test_both_ends_of_a_loop_are_one_key():
    layout = key_orientations.Layout([circle(8)], 1.0)
    reading = key_orientations.read(layout, np.array([1.0, layout.last]), quats(X, Y))
    assert list(reading.keys[0]) == [0] and np.allclose(reading.keys[0][0], X) and reading.doubled == [layout.last]


def unit(*v):
    return np.array(v) / np.linalg.norm(v)


def test_changes_are_distinguished():
    before = {0: unit(0, 0, 1), 5: unit(1, 0, 1), 9: unit(0, 1, 1)}
    assert not key_orientations.change(before, {k: a + 3e-8 * np.eye(3)[0] for k, a in before.items()})
    added = key_orientations.change(before, {**before, 3: unit(1, 1, 1)})
    assert added and (added.added, added.moved, added.deleted, added.turned) == ([3], [], [], [])
    moved = key_orientations.change(before, {0: before[0], 6: before[5] + 3e-8 * np.eye(3)[1], 9: before[9]})
    assert moved.moved == [(5, 6)] and not (moved.added or moved.deleted or moved.turned)
    assert moved.keys[6] is before[5]  # the plan's exact number, not its single-precision copy
    deleted = key_orientations.change(before, {0: before[0]})
    assert deleted.deleted == [5, 9] and deleted.keys == {0: before[0]}
    turned = key_orientations.change(before, {**before, 5: unit(1, 0, 1.00001)})
    assert turned.turned == [5] and np.array_equal(turned.keys[0], before[0])
    assert key_orientations.change({}, {}).keys == {} and not key_orientations.change({}, {})


def test_keys_that_change_places_are_turned_keys():
    a, b = unit(0, 0, 1), unit(1, 0, 1)
    found = key_orientations.change({1: a, 2: b}, {1: b, 2: a})
    assert sorted(found.turned) == [1, 2] and not (found.moved or found.added or found.deleted)


def test_written_keys_are_read_back_over_antipodal_and_upside_down_axes():
    layout = key_orientations.Layout([line(0, 10, 20, 30), circle(20)], 1.7)
    wanted = [
        {0: unit(0, 0, 1), 1: unit(0, 0, -1), 2: unit(0, 1e-9, -1), 3: unit(0, 0, 1)},
        {0: unit(1, 0, 0), 7: unit(-1, 0, 0), 13: unit(0.1, 0.2, -0.3)},
    ]
    frames, q = key_orientations.written(layout, wanted)
    assert np.all(np.diff(frames) > 0) and np.allclose(np.linalg.norm(q, axis=1), 1)
    assert np.all(np.einsum("ij,ij->i", q[1:], q[:-1]) >= -1e-12)
    reading = key_orientations.read(layout, frames.astype(np.float32), q.astype(np.float32))
    assert not reading.problems
    for path, found in zip(wanted, reading.keys, strict=True):
        assert list(found) == list(path) and not key_orientations.change(path, found)


def test_unturned_keys_stay_as_the_user_set_them():
    layout = key_orientations.Layout([line(*np.linspace(0, 20, 41))], 1.0)
    twist = quaternions.multiply(quats((1, 1, 1)), np.array([[np.cos(0.7), 0, 0, np.sin(0.7)]]))[0]
    frames, table = np.array([1.0, 8.1]), np.array([[1.0, 0, 0, 0], twist])
    known = key_orientations.read(layout, frames, table)
    of_path = {**known.keys[0], 40: unit(1, 0, 1)}
    found, q = key_orientations.written(layout, [of_path], known, dict(zip(frames, table, strict=True)))
    assert found.tolist() == [1.0, 8.1, 21.0] and np.allclose(q[1], twist)
    of_path[14] = unit(1, 0, 2)  # turned: set again, at the point's own frame
    found, q = key_orientations.written(layout, [of_path], known, dict(zip(frames, table, strict=True)))
    assert found.tolist() == [1.0, 8.0, 21.0]
    assert np.allclose(quaternions.axes_of(q[1]), unit(1, 0, 2))


def test_fingerprints_see_what_single_precision_keeps():
    a, b = np.array([1.0, 2.0]), np.array([[0.1, 0.2]])
    assert key_orientations.fingerprint(a, b) == key_orientations.fingerprint(a + 1e-12, b)
    assert (
        len({key_orientations.fingerprint(*x) for x in [(a, b), (a + 1e-5, b), (a, b.T), (b, a), (a,), (a[:1], b)]})
        == 6
    )


class Divided:
    """A path with the interface of the core's, on a line: the result of `divided` has more points and no axes."""

    def __init__(self, xs, axes=(), of=None, rule=""):
        self.centres = np.array([(x, 0.0, 0.0) for x in xs])
        self.axes, self.keys, self.interpolation = np.array(axes), of or {}, rule
        self.length = float(np.ptp(xs))

    def __len__(self):
        return len(self.centres)

    def divided(self, step):
        xs = self.centres[:, 0]
        parts = [np.linspace(a, b, max(1, int(np.ceil((b - a) / step))) + 1)[:-1] for a, b in pairwise(xs)]
        return Divided(np.append(np.concatenate(parts), xs[-1]))

    def orient(self, of, *, interpolation):
        return Divided(self.centres[:, 0], np.zeros((len(self), 3)), dict(of), interpolation)


def test_a_divided_path_has_its_keys_where_they_were():
    path = Divided([0, 4, 4, 10], np.zeros((4, 3)), {0: X, 2: Y, 3: Z}, "smooth")
    fine = key_orientations.divided(path, 1.0)
    assert len(fine) == 12 and fine.interpolation == "smooth"
    assert {k: fine.centres[k, 0] for k in fine.keys} == {0: 0, 5: 4, 11: 10}
    assert list(fine.keys.values()) == [X, Y, Z]


def test_given_axes_become_keys_and_paths_without_axes_get_none():
    path = Divided([0, 4, 10], [X, Y, Z])
    fine = key_orientations.divided(path, 1.0)
    assert fine.interpolation == "slerp" and list(fine.keys) == [0, 4, 10]
    assert not len(key_orientations.divided(Divided([0, 10]), 1.0).axes)
    assert key_orientations.divided(path, 0.1) is path


def test_a_following_layout_lays_out_only_changed_or_moved_paths():
    first, second, third = line(0, 10), line(0, 20), line(0, 5)
    before = key_orientations.Layout([first, second, third], 1.0)
    same = line(0, 20)  # of the same length, and another object
    after = key_orientations.Layout([first, same, third], 1.0, 1, before)
    assert after.made == 1 and after.tracks[0] is before.tracks[0] and after.tracks[2] is before.tracks[2]
    longer = key_orientations.Layout([first, line(0, 30), third], 1.0, 1, before)
    assert longer.made == 2 and longer.tracks[2].first == before.tracks[2].first + 10
    for other in (
        key_orientations.Layout(before.paths, 2.0, 1, before),
        key_orientations.Layout(before.paths, 1.0, 5, before),
    ):
        assert other.made == 3
    assert before.of(before.paths, 1.0, 1) and not before.of(after.paths, 1.0, 1) and not before.of([first], 1.0, 1)
    for layout in (after, longer):
        fresh = key_orientations.Layout(layout.paths, 1.0)
        assert all(np.array_equal(a.frames, b.frames) for a, b in zip(layout.tracks, fresh.tracks, strict=True))


def test_replacing_keyframes_keeps_those_outside_the_paths():
    layout = key_orientations.Layout([line(0, 10), line(0, 10)], 1.0)
    up, east = np.array([0.0, 0, 1]), unit(1, 0, 1)
    frames, table = np.array([3.0, 14.0]), quats(up, east)  # on the first path, and between the two
    got, axes = key_orientations.replaced(layout, [{0: east}, {1: east}], frames, table)
    assert got.tolist() == [1.0, 14.0, layout.tracks[1].last]
    assert np.allclose(quaternions.axes_of(axes), east)
