import math

import pytest

from addon.common import fitting

BALL = {"kind": "ball", "diameter": 6.0, "length": 30.0, "name": "Ball 6"}


def test_an_object_gets_a_round_unit_that_makes_it_handy():
    assert [fitting.unit(side) for side in (2, 2.73, 1, 0.02, 4000)] == [50, 50, 100, 5000, 0.025]
    for side in (1e-4, 0.0007, 3.3, 49, 1e4):
        assert fitting.is_handy(side * fitting.unit(side)), side


@pytest.mark.parametrize(("longest", "pitch"), [(100, 0.25), (2000, 5), (40, 0.1), (1, 0.0025)])
def test_a_pitch_is_round(longest, pitch):
    assert fitting.pitch(longest, 400) == pitch


def test_a_cutter_that_suits_the_size_stays_and_any_other_keeps_its_shape():
    assert fitting.tool(BALL, 60) is BALL
    small = fitting.tool(BALL, 2.7)
    assert small == {"kind": "ball", "diameter": 0.3, "length": 1.5}
    taper = {"kind": "taper", "diameter": 6, "tip_radius": 0.5, "half_angle": 0.1, "length": 30, "flat_tip": False}
    large = fitting.tool(taper, 2000)
    share = large["diameter"] / 6
    assert large["half_angle"] == 0.1 and large["flat_tip"] is False and share > 15
    assert math.isclose(large["tip_radius"], 0.5 * share, rel_tol=1e-6) and math.isclose(
        large["length"], 30 * share, rel_tol=1e-6
    )


def test_a_depth_suits_its_cutter():
    for diameter in (0.15, 6, 120):
        assert fitting.depth_suits(fitting.depth(diameter), diameter)
    assert not fitting.depth_suits(0.5, 120) and not fitting.depth_suits(0.5, 0.15)


@pytest.mark.parametrize("side", [0, -1, math.nan, math.inf])
def test_invalid_sizes_are_refused(side):
    for call in (fitting.unit, fitting.pitch):
        with pytest.raises(ValueError, match="size"):
            call(side)
