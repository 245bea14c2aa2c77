"""Strokes of mice and tablets: poses on surfaces in closed form, and what they carve."""

import numpy as np
import pytest
import riffler

from addon.sculpt.pure import symmetry
from addon.sculpt.pure.smooth_path import REACH
from addon.sculpt.pure.stroke_path import Hit, Sample, StrokeMaker, View, settings_for, support

VIEW = View(np.array([1.0, 0, 0]), np.array([0, 1.0, 0]), np.array([0, 0, 1.0]))
BALL = riffler.Tool.ball(diameter=6, length=30)
CORNER = riffler.Tool.fillet(diameter=6, corner_radius=1, length=30)
PIXEL = 0.1  # mm


def outline(tool):
    return np.vstack([line for _, line in tool.outline(tolerance=0.0005)])


def plane(x, y, half=20.0):
    """The view of a square from above."""
    p = np.array([x * PIXEL, y * PIXEL, 0.0])
    return Hit(p, np.array([0, 0, 1.0])) if np.abs(p[:2]).max() <= half else None


def sphere(x, y, radius=15.0):
    p = np.array([x * PIXEL, y * PIXEL])
    rest = radius**2 - p @ p
    if rest <= 0:
        return None
    point = np.array([*p, np.sqrt(rest)])
    return Hit(point, point / radius)


def maker(pick=plane, tool=BALL, pitch=0.25, **chosen):
    return StrokeMaker(settings_for(pitch, tool.diameter, **chosen), outline(tool), pick, VIEW)


def stroke(make, *samples):
    pieces = [piece for s in samples for piece in make.add(s)]
    return pieces + make.end()


def joined(pieces):
    """Rows without those that a piece repeats from the last."""
    return np.vstack([p.poses if p.new else p.poses[1:] for p in pieces])


@pytest.mark.parametrize("tool", [BALL, CORNER, riffler.Tool.taper(1.0, 0.2, 8, 30)])
def test_the_cutters_deepest_point_lies_the_depth_below_the_surface(tool):
    rng = np.random.default_rng(5)
    profile = outline(tool)
    turn = np.linspace(0, 2 * np.pi, 721)
    for _ in range(50):
        axis, normal = rng.normal(size=(2, 3))
        axis, normal = axis / np.linalg.norm(axis), normal / np.linalg.norm(normal)
        e1 = np.linalg.svd(axis[None])[2][1]
        e2 = np.cross(axis, e1)
        ring = np.cos(turn)[:, None] * e1 + np.sin(turn)[:, None] * e2
        solid = profile[:, 1, None, None] * axis + profile[:, 0, None, None] * ring
        lowest = (solid @ -normal).max()
        assert support(profile, axis, -normal) @ -normal == pytest.approx(lowest, abs=1e-3 * tool.diameter)


def test_a_click_makes_a_dent_of_the_requested_depth():
    pieces = stroke(maker(depth=0.8), Sample(3, 4))
    assert [p.new for p in pieces] == [True]
    assert np.allclose(pieces[0].poses[:, :3], [(0.3, 0.4, 0), (0.3, 0.4, -0.8)])
    assert (pieces[0].dt > 0).all()


@pytest.mark.parametrize("axis", ["NORMAL", "VIEW", "UP"])
def test_a_straight_drag_is_the_groove_of_the_closed_form(axis):
    make = maker(depth=0.5, axis=axis)
    pieces = stroke(make, Sample(-100, 0), Sample(-30, 0), Sample(100, 0))
    assert [p.new for p in pieces].count(True) == 1
    volume = riffler.Volume.block((-15, -10, -5), (15, 10, 0), 0.1, "xyz")
    removed = sum(volume.carve(BALL, p.poses, dt=p.dt).removed.sum() for p in pieces)
    radius, depth = 3.0, 0.5
    # a segment of the circle along 20 mm, and two halves of a cap of the ball
    half = np.arccos((radius - depth) / radius)
    segment = radius**2 * (half - np.sin(half) * np.cos(half))
    cap = np.pi * depth**2 * (3 * radius - depth) / 3
    assert removed == pytest.approx(20 * segment + cap, rel=0.003)


def test_on_a_sphere_the_ball_sinks_by_the_depth_wherever_it_leans():
    make = maker(sphere, depth=0.5, axis="TILT")
    rows = joined(stroke(make, Sample(-120, 0, tilt_x=0.3), Sample(120, 30, tilt_x=-0.4, tilt_y=0.2)))
    centres = rows[1:, :3] + 3.0 * rows[1:, 3:]
    assert np.allclose(np.linalg.norm(centres, axis=1), 15 - 0.5 + 3, atol=1e-3)
    assert np.allclose(np.linalg.norm(rows[:, 3:], axis=1), 1)


def test_tilt_leans_the_axis_and_is_held_off_the_horizon():
    def axis(x, y):
        make = maker(axis="TILT")
        return stroke(make, Sample(0, 0, tilt_x=x, tilt_y=y))[0].poses[0, 3:]

    assert np.allclose(axis(0, 0), (0, 0, 1))
    assert np.allclose(axis(0.5, 0), (np.sin(np.pi / 4), 0, np.cos(np.pi / 4)))
    assert np.arccos(axis(1, 1)[2]) == pytest.approx(1.0)
    assert np.allclose(axis(float("nan"), 0.25), (0, np.sin(np.pi / 8), np.cos(np.pi / 8)))


def test_pressure_is_depth_or_feed():
    samples = [Sample(0, 0, 0.2), Sample(50, 0, 0.6), Sample(50, 0, 0.1)]
    rows = joined(stroke(maker(depth=1.0, pressure="DEPTH"), *samples))
    assert rows[1, 2] == pytest.approx(-0.2)
    assert rows[:, 2].min() == pytest.approx(-0.55, abs=0.05)
    assert rows[-1, 2] == pytest.approx(-0.1)
    deepest = int(rows[:, 2].argmin())
    assert (np.diff(rows[1:deepest, 2]) < 0).all()  # no steps: pressure grows along the path
    assert (np.diff(rows[deepest:, 2]) > 0).all()

    slow = stroke(maker(pressure="FEED", feed=10), Sample(0, 0, 0.5), Sample(50, 0, 0.5))
    assert sum(p.dt.sum() for p in slow[1:]) == pytest.approx(5 / (10 * 0.5))
    assert all(np.isfinite(p.dt).all() for p in stroke(maker(pressure="FEED"), Sample(0, 0, 0.0), Sample(9, 0, 0.0)))


def test_the_clock_gives_the_feed_where_events_have_times():
    pieces = stroke(maker(), Sample(0, 0, time=1.0), Sample(50, 0, time=1.5))
    assert sum(p.dt.sum() for p in pieces if not p.new) == pytest.approx(0.5)


def test_off_the_surface_a_stroke_ends_and_begins_again_behind_the_gap():
    def two(x, y):
        return plane(x, y) if abs(x) > 20 else None

    pieces = stroke(maker(two), Sample(-100, 0), Sample(100, 0))
    assert sum(p.new for p in pieces) == 2
    rows = joined(pieces)
    assert np.abs(rows[:, 0]).min() == pytest.approx(2.1, abs=0.5)  # up to the last pick on either side
    assert stroke(maker(lambda x, y: None), Sample(0, 0), Sample(9, 9)) == []


def test_the_horizon_is_no_bridge_to_what_lies_behind():
    def step(x, y):
        point = np.array([x * PIXEL, y * PIXEL, 0.0 if x < 0 else -40.0])
        return Hit(point, np.array([0, 0, 1.0]))

    pieces = stroke(maker(step), Sample(-50, 0), Sample(50, 0))
    assert sum(p.new for p in pieces) == 2
    for piece in pieces:
        assert np.ptp(piece.poses[:, 2]) <= 0.5 + 1e-12


def test_a_fast_hand_follows_the_surface_as_a_slow_one_does():
    fast = joined(stroke(maker(sphere), Sample(-100, 0), Sample(100, 0)))
    centres = fast[1:, :3] + 3 * fast[1:, 3:]
    assert np.linalg.norm(np.diff(centres, axis=0), axis=1).max() < 1.0
    slow = joined(stroke(maker(sphere), *[Sample(x, 0) for x in range(-100, 101, 4)]))
    ends = [np.linalg.norm(rows[-1, :3] + 3 * rows[-1, 3:]) for rows in (fast, slow)]
    assert ends[0] == pytest.approx(ends[1], abs=0.02)


def test_on_a_string_the_tool_lags_and_arrives_at_the_end():
    make = maker(string=20.0)
    along = make.add(Sample(0, 0)) + make.add(Sample(15, 0))
    assert len(along) == 1  # the string is slack
    moved = [piece for x in (60, 65) for piece in make.add(Sample(x, 0))]
    assert joined(moved)[-1, 0] == pytest.approx((60 - 20 - REACH) * PIXEL)
    assert joined(make.end())[-1, 0] == pytest.approx(6.5)
    zigzag = maker(string=20.0)
    path = joined(stroke(zigzag, *[Sample(2 * k, 6 * (-1) ** k) for k in range(80)]))
    assert np.ptp(path[20:-20, 1]) < 0.1  # a trembling of 1.2 mm


def test_samples_that_go_nowhere_cut_nothing():
    make = maker()
    make.add(Sample(5, 5))
    assert make.add(Sample(5, 5, time=1.0)) == []
    assert make.end() == []


def test_the_same_samples_give_the_same_bytes():
    samples = [Sample(3 * k, 20 * np.sin(k / 5), 0.5, 0.1, 0.2, 0.01 * k) for k in range(30)]
    first, second = (joined(stroke(maker(sphere, axis="TILT"), *samples)) for _ in range(2))
    assert first.tobytes() == second.tobytes()


def test_the_tool_is_some_pixels_behind_and_comes_to_where_the_hand_let_go():
    make = maker()
    rows = joined([piece for x in range(0, 190, 3) for piece in make.add(Sample(x, 0))])
    assert rows[-1, 0] / PIXEL == pytest.approx(186 - REACH, abs=5)  # half a spacing, and a sample
    assert joined(make.end())[-1, 0] / PIXEL == pytest.approx(189)


@pytest.mark.parametrize("degrees", [20, 90, 150])
def test_a_corner_is_kept_except_for_a_few_pixels(degrees):
    turn = np.radians(degrees)
    legs = [np.array([1.0, 0]), np.array([np.cos(turn), np.sin(turn)])]
    told = [legs[0] * k for k in range(-60, 0, 3)] + [legs[1] * k for k in range(0, 61, 3)]
    rows = joined(stroke(maker(), *[Sample(*p) for p in told]))[1:, :2] / PIXEL
    gone = np.linalg.norm(rows, axis=1).min()
    # a mean over a reach before and behind: three eighths of it along each leg, half of the weight each
    expected = 3 / 8 * REACH * np.sin(turn / 2)
    assert gone == pytest.approx(expected, abs=1.0)
    assert np.allclose(rows[0], told[0], atol=1e-9) and np.allclose(rows[-1], told[-1], atol=1e-9)


@pytest.mark.parametrize("radius", [30.0, 100.0])
@pytest.mark.parametrize("step", [1.5, 12.0])
def test_a_curve_stays_where_it_is(radius, step):
    turns = np.arange(0, 1.8 * np.pi, step / radius)
    told = [Sample(radius * np.cos(t), radius * np.sin(t), time=t) for t in turns]
    rows = joined(stroke(maker(depth=0.0), *told))[:, :2] / PIXEL
    inwards = radius - np.linalg.norm(rows, axis=1)
    assert inwards.max() < REACH**2 / (10 * radius) + 0.2 and inwards.min() > -0.1


# ---------------------------------------------------------------------- symmetry
def test_mirrors_and_turns_make_a_group():
    assert len(symmetry.maps()) == 1
    assert len(symmetry.maps("XYZ")) == 8
    assert len(symmetry.maps("", "Z", 5)) == 5
    assert len(symmetry.maps("X", "Z", 5)) == 10
    assert len(symmetry.maps("XY", "Z", 4)) == 8  # y's mirror is x's after a quarter turn
    found = symmetry.maps("X", "Y", 6)
    for a in found:
        assert np.allclose(a @ a.T, np.eye(3))
        for b in found:
            assert any(np.allclose(a @ b, c) for c in found)
    with pytest.raises(ValueError, match="count"):
        symmetry.maps("X", "Z", 0)
    with pytest.raises(ValueError, match="mirror"):
        symmetry.maps("W")


def test_a_stroke_along_the_mirrors_plane_is_cut_once():
    poses = np.array([[1.0, 5, 0, 0, 0, 1], [1, 8, 0, 0, 0, 1]])
    assert len(symmetry.copies(poses, symmetry.maps("X"), (1, 0, 0))) == 1
    both = symmetry.copies(poses, symmetry.maps("X"), (0, 0, 0))
    assert np.allclose(both[1][0][:, 0], -1) and [mirrors for _, mirrors in both] == [False, True]


def test_copies_carve_a_symmetric_volume():
    volume = riffler.Volume.block((-10, -10, -5), (10, 10, 0), 0.25, "z")
    for poses, _ in symmetry.copies(
        np.array([[2, 3, -1, 0.28, 0, 0.96], [7, 6, -1, 0, 0.28, 0.96]]), symmetry.maps("XY"), (0, 0, 0)
    ):
        volume.carve(BALL, poses)
    counts, spans = volume.intervals("z")
    heights = spans[:, 1].reshape(counts.shape)
    assert np.allclose(heights, heights[::-1], atol=1e-9)
    assert np.allclose(heights, heights[:, ::-1], atol=1e-9)
