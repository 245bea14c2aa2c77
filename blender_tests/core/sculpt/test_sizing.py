import numpy as np
import pytest

from addon.sculpt.pure import sizing, symmetry


def test_the_pointer_begins_on_the_circle_and_twice_as_far_is_twice_as_large():
    drag = sizing.Drag(3.0, 20.0, (500, 300))
    assert drag.middle == (440, 300) and drag.radius == 60
    assert drag.to((560, 300)) == pytest.approx(6)
    assert drag.to((440, 330)) == pytest.approx(1.5)
    assert drag.first == 3


def test_fine_goes_a_tenth_of_the_way_and_round_numbers_are_round():
    drag = sizing.Drag(3.0, 20.0, (500, 300))
    assert drag.to((520, 300), fine=True) == pytest.approx(3.1)
    drag = sizing.Drag(3.0, 20.0, (500, 300))
    assert drag.to((517, 300), rounded=True) == 4.0
    assert drag.to((440, 300), rounded=True) == 0.5, "never nothing"


def test_typed_digits_are_applied_and_deleted():
    drag = sizing.Drag(3.0, 20.0, (500, 300))
    assert [drag.typed(key) for key in "12.5"] == [1, 12, 12, 12.5]
    assert drag.typed(".") == 12.5 and drag.text == "12.5"
    assert [drag.typed("\b") for _ in range(4)] == [12, 12, 1, 3.0]
    assert drag.to((560, 300)) == pytest.approx(6) and drag.text == ""


@pytest.mark.parametrize(("first", "scale"), [(3.0, 1e-4), (0.001, 1.0), (500.0, 50.0), (0.0, 10.0)])
def test_any_size_can_be_held(first, scale):
    drag = sizing.Drag(first, scale, (500, 300))
    assert np.isfinite(drag.radius)
    if first:
        assert sizing.LEAST * 0.999 <= drag.radius <= 400.001
    assert np.isfinite(drag.to((600, 300)))


class Box:
    lower, upper = (0, 0, 0), (10, 20, 30)


def test_planes_of_mirrors_and_the_axis_of_turns_lie_in_the_box():
    found = symmetry.outlines({"X", "Z"}, 3, "Y", Box, (5, 10, 12))
    assert [(letter, closed) for _, letter, closed in found] == [("X", True), ("Z", True), ("Y", False)]
    assert np.ptp(found[0][0], axis=0).tolist() == [0, 20, 30] and (found[0][0][:, 0] == 5).all()
    assert (found[1][0][:, 2] == 12).all() and np.ptp(found[1][0], axis=0).tolist() == [10, 20, 0]
    assert found[2][0].tolist() == [[5, 0, 12], [5, 20, 12]]
    assert symmetry.outlines(set(), 1, "Z", Box, (5, 10, 15)) == []
