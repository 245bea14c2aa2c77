"""Arrows, rings, lines and scales: closed, correctly oriented, of the size of the closed form."""

import numpy as np
import pytest
import riffler

from addon.common import glyphs, scale


def audited(triangles):
    corners, index = np.unique(triangles.reshape(-1, 3).round(9), axis=0, return_inverse=True)
    return riffler.Mesh(corners, index.reshape(-1, 3).astype(np.int32)).audit()


def polygon(radius):
    """Area of the polygon that represents a circle."""
    return 0.5 * glyphs.SIDES * radius**2 * np.sin(2 * np.pi / glyphs.SIDES)


@pytest.mark.parametrize("way", [(0, 0, 10), (10, 0, 0), (3, -7, 2), (0, 1e-3, 0)])
def test_an_arrow_is_closed_and_points_in_its_direction(way):
    start, width = np.array([5.0, -2, 1]), 0.4
    triangles = glyphs.arrow(start, start + way, width)
    audit = audited(triangles) if np.linalg.norm(way) > 0.1 else None
    length = np.linalg.norm(way)
    unit = np.array(way) / length
    along = (triangles.reshape(-1, 3) - start) @ unit
    assert along.min() == pytest.approx(0, abs=1e-9) and along.max() == pytest.approx(length)
    if audit:
        assert audit.open_edges == 0 and audit.nonmanifold_edges == 0
        head = 1.5 * glyphs.HEAD * width
        expected = polygon(width / 2) * (length - head) + polygon(glyphs.HEAD * width / 2) * head / 3
        assert audit.volume == pytest.approx(expected, rel=1e-6)


def test_a_short_arrow_has_a_smaller_head_and_an_empty_one_nothing():
    tiny = glyphs.arrow((0, 0, 0), (0, 0, 0.01), 1.0)
    assert np.abs(tiny[..., :2]).max() < 0.01
    assert glyphs.arrow((1, 2, 3), (1, 2, 3), 1.0).shape == (0, 3, 3)
    assert glyphs.arc_arrow((0, 0, 0), (0, 0, 1), 5, 0.0, 0.2).shape == (0, 3, 3)
    bent = glyphs.arc_arrow((0, 0, 0), (0, 0, 1), 5, 0.002, 1.0).reshape(-1, 3)
    assert np.ptp(bent, axis=0).max() < 0.03  # length 0.01


@pytest.mark.parametrize("angle", [0.05, 0.5, 2.0, 5.5])
def test_a_bent_arrow_turns_as_the_right_hand_does(angle):
    axis = np.array([1.0, 2, -0.5])
    axis /= np.linalg.norm(axis)
    centre = np.array([4.0, 0, 1])
    triangles = glyphs.arc_arrow(centre, axis, 5.0, angle, 0.2)
    first, second, _ = glyphs.frame(axis)
    away = triangles.reshape(-1, 3) - centre
    tip = 5 * (np.cos(angle) * first + np.sin(angle) * second)
    assert np.linalg.norm(away - tip, axis=1).min() < 1e-9
    assert np.abs(np.linalg.norm(away - np.outer(away @ axis, axis), axis=1) - 5).max() < 0.5
    if angle > 0.3:  # the shaft is closed except for its tail, which is a ring
        assert audited(triangles).open_edges == 2 * glyphs.SIDES


def test_a_ring_is_perpendicular_to_its_axis():
    points = glyphs.ring((1, 2, 3), (0, 0, 2), 4.0)
    assert np.allclose(points[:, 2], 3) and np.allclose(np.linalg.norm(points[:, :2] - (1, 2), axis=1), 4)


def area(triangles):
    a, b = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    return 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


def test_a_line_has_its_width_and_breaks_at_missing_points():
    line = np.array([(0, 0), (10, 0), (10, 10)])
    assert area(glyphs.ribbon(line, 2.0)).sum() == pytest.approx(2 * 12 * 2)  # a half width longer at every end
    assert (area(glyphs.ribbon(line, 2.0)) > 0).all() and (area(glyphs.box(1, 2, 3, 4)) == 6).all()
    assert len(glyphs.ribbon(line, 2.0, closed=True)) == 6
    assert len(glyphs.ribbon([(0, 0), (1, 0), (np.nan, np.nan), (3, 0), (4, 0)], 1.0)) == 4
    assert len(glyphs.ribbon([(0, 0), (0, 0)], 1.0)) == 0


def test_a_tools_outline_has_both_its_sides():
    tool = riffler.Tool.ball(diameter=6, length=30)
    points = glyphs.meridian(tool.outline(tolerance=0.01))
    assert points[:, 0].min() == -3 and points[:, 0].max() == 3
    assert (points[:, 1].min(), points[:, 1].max()) == (0, 30)
    cone = riffler.Tool.taper(tip_radius=1.0, half_angle=0.2, diameter=20, length=60)
    part = glyphs.meridian(cone.outline(tolerance=0.01), 12.0)
    assert part[:, 1].max() == pytest.approx(12)
    # the tangent point lies cos 0.2 off the axis, 1 - sin 0.2 above the tip
    assert part[:, 0].max() == pytest.approx(np.cos(0.2) + (12 - 1 + np.sin(0.2)) * np.tan(0.2))


@pytest.mark.parametrize(
    "low, high, most, expected",
    [
        (0, 10, 6, [0, 2, 4, 6, 8, 10]),
        (0, 1, 6, [0, 0.2, 0.4, 0.6, 0.8, 1.0]),
        (-0.05, 0.05, 5, [-0.04, -0.02, 0, 0.02, 0.04]),
        (3, 4.9, 3, [3, 4]),
        (0, 7e5, 6, [0, 2e5, 4e5, 6e5]),
    ],
)
def test_scales_have_round_numbers(low, high, most, expected):
    assert scale.ticks(low, high, most) == expected


def test_scales_never_have_more_marks_than_requested():
    rng = np.random.default_rng(2)
    for _ in range(2000):
        low = rng.normal() * 10 ** rng.uniform(-6, 6)
        high = low + 10 ** rng.uniform(-6, 6)
        most = int(rng.integers(2, 12))
        marks = scale.ticks(low, high, most)
        slack = 1e-6 * (high - low) + 1e-12 * abs(low)
        assert len(marks) <= most and all(low - slack <= m <= high + slack for m in marks)


def test_scales_end_at_round_numbers_and_refuse_bad_ranges():
    assert [scale.ceiling(x) for x in (0.0011, 1.0, 2.0, 2.1, 7, 13)] == [0.002, 1, 2, 5, 10, 20]
    assert [scale.share(x, 2, 4) for x in (1, 2, 3, 4, 9)] == [0, 0, 0.5, 1, 1]
    for bad in ((1, 1), (0, float("inf")), (float("nan"), 2)):
        with pytest.raises(ValueError, match="scale"):
            scale.ticks(*bad)
    with pytest.raises(ValueError, match="scale"):
        scale.ceiling(0)
