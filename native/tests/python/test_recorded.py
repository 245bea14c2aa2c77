"""Plans from recordings: ``riffler.plan.from_recording``, ``path_of_stroke`` and ``riffler plan from-recording``.

The judge is the discrete Fréchet distance of two dense samplings, both made here: of the recorded motion and of the
path, whose axes are interpolated from its keys by formulas of this file.
"""

from itertools import pairwise

import numpy as np
import pytest
import riffler
from commands import result, riffle
from riffler import plan

BALL = riffler.Tool.ball(6, 30)
TILTED = (0.6, 0.0, 0.8)


def unit(v):
    v = np.asarray(v, float)
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def angles(a, b):
    return np.arctan2(np.linalg.norm(np.cross(a, b), axis=-1), np.sum(a * b, axis=-1))


def on_circle(a, b, share):
    """On the great circle from a to b, by rotating a about the circle's pole."""
    turn = angles(a, b)
    if turn < 1e-12:
        return np.repeat(a[None], len(share), axis=0)
    side = unit(b - np.dot(a, b) * a)
    at = (share * turn)[:, None]
    return np.cos(at) * a + np.sin(at) * side


def dense_motion(poses, radius, step):
    """Centres and axes of the recorded motion: straight tips, axes on great circles."""
    centres, axes = [], []
    for a, b in pairwise(poses):
        size = np.linalg.norm(b[:3] - a[:3]) + (radius + 1) * angles(a[3:], b[3:])
        share = np.linspace(0, 1, max(2, int(np.ceil(size / step)) + 1))
        axis = on_circle(a[3:], b[3:], share)
        centres.append(a[:3] + share[:, None] * (b[:3] - a[:3]) + radius * axis)
        axes.append(axis)
    return np.vstack(centres), np.vstack(axes)


def dense_path(path, step):
    """Points of the path, and axes from its keys alone, on great circles by arc length."""
    sizes = np.linalg.norm(np.diff(path.centres, axis=0), axis=1)
    at = np.concatenate([[0], np.cumsum(sizes)])
    keys = sorted(path.keys)
    assert keys[0] == 0 and keys[-1] == len(path) - 1
    points, axes = [], []
    for first, last in pairwise(keys):
        turn = angles(path.keys[first], path.keys[last])
        count = max(2, int(np.ceil((at[last] - at[first]) / step + turn / 0.002)) + 1)
        share = np.linspace(0, 1, count)
        here = at[first] + share * (at[last] - at[first])
        points.append(np.column_stack([np.interp(here, at, path.centres[:, k]) for k in range(3)]))
        axes.append(on_circle(path.keys[first], path.keys[last], share))
    return np.vstack(points), np.vstack(axes)


def follows(one, other, apart, turn):
    """Whether both can be walked from start to end, never back, always within both bounds (discrete Fréchet)."""
    (p, a), (q, b) = one, other
    first, reach = 0, np.ones(1, bool)  # which places of `other` are reached, from the first such place to the last
    for i in range(len(p)):
        seeds = reach if i == 0 else np.append(reach, False) | np.append(False, reach)
        size = len(seeds) + 32
        while True:  # only places not far behind the reached ones are looked at, and more if they all are free
            near = slice(first, min(first + size, len(q)))
            free = (np.linalg.norm(q[near] - p[i], axis=1) <= apart) & (angles(b[near], a[i]) <= turn)
            now = reached(free, seeds[: len(free)])
            if not now[-1] or near.stop == len(q):
                break
            size *= 2
        if not now.any():
            return False
        there = np.flatnonzero(now)
        first, reach = first + there[0], now[there[0] : there[-1] + 1]
    return first + len(reach) == len(q)


def reached(free, seeds):
    """Within a run of free places everything from its first seed on."""
    n = np.arange(len(free))
    begin = np.maximum.accumulate(np.where(~free, n + 1, 0))
    seed = np.maximum.accumulate(np.where(free & np.append(seeds, np.zeros(len(free) - len(seeds), bool)), n, -1))
    return free & (seed >= begin)


def check(poses, tool=BALL, radius=3.0, tolerance=0.01, angle=0.035):
    found = plan.path_of_stroke(poses, tool, tolerance=tolerance, angle=angle)
    assert found.error <= tolerance and found.turn <= angle and found.poses == len(poses)
    step = 0.2 * tolerance
    one, other = dense_motion(np.asarray(poses, float), radius, step), dense_path(found.path, step)
    assert follows(one, other, found.error + 0.75 * step, found.turn + 0.002)
    return found


def wave(n, noise=0.0, seed=3):
    rng = np.random.default_rng(seed)
    t = np.linspace(0, 4, n)
    tips = np.column_stack([4 * t, 2 * np.sin(2 * t), 0.5 * np.cos(3 * t)]) + noise * rng.standard_normal((n, 3))
    axes = unit(np.column_stack([0.4 * np.sin(2 * t), 0.3 * np.cos(t), np.ones(n)]))
    return np.hstack([tips, unit(axes + noise * rng.standard_normal((n, 3)))])


def test_a_trembling_stroke_becomes_few_points_and_keys_within_both_bounds():
    poses = wave(3000, noise=5e-4)
    found = check(poses)
    assert len(found.path) < 120 and len(found.path.keys) < 40
    assert found.path.interpolation == "slerp" and found.path.radius == 3
    finer = check(wave(600), tolerance=0.05, angle=0.01)
    assert len(finer.path.keys) > len(check(wave(600), tolerance=0.05, angle=0.1).path.keys)


def test_the_judge_detects_a_bound_that_is_too_small():
    """The bounds are not loose by more than a half, so that the comparison can fail."""
    poses = wave(600)
    found = plan.path_of_stroke(poses, BALL, tolerance=0.05, angle=0.035)
    one, other = dense_motion(poses, 3.0, 0.01), dense_path(found.path, 0.01)
    assert not follows(one, other, 0.4 * found.error, found.turn)
    assert not follows(one, other, found.error, 0.5 * found.turn)


def test_two_poses_with_a_wide_turn_give_the_arc_of_the_centre():
    found = check([(0, 0, 0, 0, 0, 1), (10, 0, 0, 1, 0, 0)], tolerance=0.02)
    assert len(found.path) > 4, "the ball's centre follows an arc while the tip goes straight"


@pytest.mark.parametrize("place", [0, 40, 80])
def test_turning_in_one_place_gets_room_within_the_tolerance(place):
    """At the start, in the middle and at the end: about the ball's centre, so that the centre stands."""
    turn = on_circle(np.array([0, 0, 1.0]), unit([0.9, 0.3, 0.5]), np.linspace(0, 1, 300))
    x = np.linspace(0, 8, 81)
    before, after = x[: place + 1], x[place:]
    centres = np.column_stack([np.concatenate([before, np.full(300, x[place]), after]), *np.zeros((2, 381 + 1))])
    axes = np.vstack([np.repeat(turn[:1], len(before), axis=0), turn, np.repeat(turn[-1:], len(after), axis=0)])
    found = check(np.hstack([centres - 3 * axes, axes]), tolerance=0.02)
    assert len(found.path.keys) < 9
    stations = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(found.path.centres, axis=0), axis=1))])
    assert np.diff(stations[sorted(found.path.keys)]).min() > 1e-4, "keys lie apart, so that a timeline has them all"


def test_a_stroke_to_and_fro_keeps_its_reversals():
    x = np.concatenate([np.linspace(0, 9, 200), np.linspace(9, 2, 200), np.linspace(2, 5, 100)])
    found = check(np.column_stack([x, 0 * x, 0 * x, 0 * x, 0 * x, 0 * x + 1]))
    assert np.allclose(found.path.centres[:, 0], [0, 9, 2, 5]) and found.error < 1e-9 and found.turn == 0


def test_an_axis_that_turns_by_more_than_half_a_circle_gets_three_keys():
    t = np.linspace(0, 1.5 * np.pi, 400)
    found = check(np.column_stack([4 * t, 0 * t, 0 * t, np.sin(t), 0 * t, np.cos(t)]), tolerance=0.05)
    assert len(found.path.keys) >= 3


def test_a_rest_with_a_trembling_hand_needs_no_keys():
    rng = np.random.default_rng(5)
    axes = unit(np.column_stack([2e-3 * rng.standard_normal((2000, 2)), np.ones(2000)]))
    x = np.concatenate([np.linspace(0, 5, 500), np.full(1000, 5.0), np.linspace(5, 9, 500)])
    found = check(np.column_stack([x, 0 * x, 0 * x, axes]), tolerance=0.05)
    assert len(found.path.keys) == 2


def test_contacts_are_the_bottom_of_the_groove():
    found = plan.path_of_stroke([(0, 0, 0, *TILTED), (10, 0, 0, *TILTED)], BALL)
    assert np.allclose(found.path.contacts[0], found.path.centres[0] - [0, 0, 3])
    plunge = plan.path_of_stroke([(0, 0, 9, 0, 0, 1), (0, 0, 0, 0, 0, 1)], BALL)
    assert np.allclose(plunge.path.normals, [0, 0, 1]), "along its axis: the axis"


def test_a_tool_without_a_ball_keeps_its_poses():
    flat, poses = riffler.Tool.flat(6, 30), wave(600)
    found = plan.path_of_stroke(poses, flat, tolerance=0.02, angle=0.035)
    assert not found.turns and not found.path.keys
    kept = plan.poses_of(found.path)
    full = riffler.plan.PencilPath(1.0, kept[:, :3], np.stack([kept[:, :3]] * 2, 1), np.stack([kept[:, 3:]] * 2, 1))
    keyed = full.orient(dict(enumerate(kept[:, 3:])), interpolation="slerp")
    one, other = dense_motion(poses, 0.0, 0.004), dense_path(keyed, 0.004)
    assert follows(one, other, found.error + 0.003, found.turn + 0.002) and len(kept) < 100


@pytest.mark.parametrize(
    ("poses", "message"),
    [
        ([], "shape"),
        ([(0, 0, 0, 0, 0, 1)], "two or more are needed for a path, not 1"),
        (np.zeros((4, 5)), r"shape \(n, 6\), not \(4, 5\)"),
        ([(0, 0, 0, 0, 0, 1)] * 3, "stands still"),
        ([(-3 * np.sin(t), 0, -3 * np.cos(t), np.sin(t), 0, np.cos(t)) for t in np.linspace(0, 1, 50)], "stands still"),
        ([(0, 0, 0, 0, 0, 1), (1, np.nan, 0, 0, 0, 1)], "row 1: not finite"),
        ([(0, 0, 0, 0, 0, 1), (1, 0, 0, 0, 0, 2)], "row 1: the axis is not a unit vector"),
        ([(0, 0, 0, 0, 0, 1), (1, 0, 0, 0, 0, 1), (2, 0, 0, 0, 0, -1)], "row 2: the axis is opposite"),
    ],
)
def test_bad_poses_are_named(poses, message):
    with pytest.raises(ValueError, match=message):
        plan.path_of_stroke(poses, BALL)


@pytest.mark.parametrize("bad", [{"tolerance": 0}, {"tolerance": np.nan}, {"angle": 0}, {"angle": 0.6}])
def test_bad_bounds_are_named(bad):
    with pytest.raises(ValueError, match=next(iter(bad))):
        plan.path_of_stroke(wave(9), BALL, **bad)


def recording(*strokes, tools=(BALL,)):
    journal = riffler.Journal()
    journal.set_stock((-20, -20, -20), (40, 20, 5), 1.0)
    for k, tool in enumerate(tools):
        journal.add_tool(k + 1, tool)
    for tool, poses, mode in strokes:
        journal.add_stroke(tool, poses, mode=mode)
    return journal


STILL = [(0, 0, 0, 0, 0, 1)] * 4


def test_each_stroke_becomes_a_path_and_motion_in_air_none():
    far = wave(200) + np.array([0, 10, 0, 0, 0, 0])
    journal = recording(
        (1, wave(200), "remove"),
        (1, wave(99), "add"),
        (1, STILL, "remove"),
        (1, far, "beside"),
        (1, STILL[:1], "remove"),
    )
    found = plan.from_recording(journal, name="hand")
    assert found.strokes == [0, 3] and len(found.plan.paths) == 2
    assert found.error == max(p.error for p in found.paths) <= 0.01
    assert [path.closed for path in found.plan.paths] == [False, False]
    gap = np.linalg.norm(found.plan.paths[0].centres[-1] - found.plan.paths[1].centres[0])
    assert gap > 5, "what lies between two strokes is in neither"
    assert found.notes == [
        "1 stroke that removed nothing: left out",
        "2 strokes that stayed in one place: left out",
        "1 stroke made next to protected material: the paths do not know that it was protected",
    ]
    again = plan.loads(plan.dumps(found.plan))
    assert again.provenance["recording"] == "hand" and [len(p.keys) for p in again.paths] == [
        len(p.keys) for p in found.plan.paths
    ]


def test_a_plan_has_one_tool():
    flat = riffler.Tool.flat(6, 30)
    journal = recording((1, wave(50), "remove"), (2, wave(60), "remove"), tools=(BALL, flat))
    with pytest.raises(ValueError, match="tools 1, 2, and a plan has one"):
        plan.from_recording(journal)
    with pytest.raises(ValueError, match="no stroke of tool 3"):
        plan.from_recording(journal, tool=3)
    found = plan.from_recording(journal, tool=2)
    assert found.plan.depths == {0: 0.0} and any("not a ball" in note for note in found.notes)
    assert plan.loads(plan.dumps(found.plan)).depths == {0: 0.0}


@pytest.mark.parametrize("strokes", [[], [(1, STILL, "remove")], [(1, wave(9), "add")]])
def test_a_recording_without_a_path_is_an_error(strokes):
    with pytest.raises(ValueError, match=r"empty: (it has no stroke|no stroke moves by more than)"):
        plan.from_recording(recording(*strokes), name="empty")


def test_progress_cancels():
    with pytest.raises(riffler.Cancelled):
        plan.from_recording(recording((1, wave(50), "remove")), progress=lambda _: False)


def test_a_plan_cuts_what_the_hand_cut():
    """To the sum of both bounds: volumes of recorded motion and of the planned rows differ in a thin skin only."""
    poses = wave(400)
    found = plan.from_recording(recording((1, poses, "remove")), tolerance=0.02)
    stock = riffler.Volume.block((-8, -8, -8), (24, 8, 3), 0.25)
    by_hand, planned = stock.copy(), stock.copy()
    by_hand.carve(BALL, poses)
    path = found.plan.paths[0]
    planned.carve(BALL, plan.poses_of(path))
    removed = stock.volume - by_hand.volume
    assert removed > 100
    assert abs(planned.volume - by_hand.volume) < 2e-3 * removed


def test_the_command_writes_a_plan(tmp_path):
    journal = recording((1, wave(200), "remove"), (2, wave(50), "remove"), tools=(BALL, riffler.Tool.flat(4, 20)))
    journal.save(tmp_path / "hand.rjournal")
    words = ("plan", "from-recording", "hand.rjournal", "--out", "plan.json")
    data = result(*words, "--tool-number", "1", "--tolerance", "0.05", "--angle", "3", cwd=tmp_path)
    assert (data["paths"], data["poses"]) == (1, 200) and data["points"] == len(
        plan.load(tmp_path / "plan.json").paths[0]
    )
    assert data["error"] <= 0.05 and data["turn"] <= np.radians(3)
    done = riffle(*words, cwd=tmp_path)
    assert done.returncode == 2 and "--tool-number" in done.stderr and len(done.stderr.splitlines()) == 1
    for wrong, what in (
        (("--angle", "0"), "--angle"),
        (("--tolerance", "x"), "--tolerance"),
        (("--tool-number", "9"), "9"),
    ):
        done = riffle(*words, *wrong, cwd=tmp_path)
        assert done.returncode == 2 and what in done.stderr, done.stderr
