"""Random dabs of brushes (brush_stress.py), some seconds of them; `make stress` runs 100 000."""

import numpy as np
import pytest
import riffler
from brush_stress import Session, beyond, ends_of


@pytest.mark.filterwarnings("ignore:.*thinner than the pitch")
@pytest.mark.parametrize("number", range(4))
def test_random_dabs_keep_everything_beyond_their_radius_and_close_the_mesh(number):
    session = Session(number, 34).run(20)
    assert session.dabs == 20 and not session.faults, "\n".join(session.faults)


def test_the_judge_finds_an_end_that_moved_by_a_bit():
    volume = riffler.Volume.block((0, 0, 0), (8, 6, 4), 0.5, "xyz")
    before = ends_of(volume)
    moved = {d: (points.copy(), kinds) for d, (points, kinds) in before.items()}
    moved["y"][0][5, 1] = np.nextafter(moved["y"][0][5, 1], 9)
    at = before["y"][0][5]
    near, far = at + 0.1 * np.eye(3)[1], at + 3.0 * np.eye(3)[0]
    for start, same in ((near, True), (far, False)):
        old, new = (beyond(ends["y"], start, start, 1.0) for ends in (before, moved))
        assert np.array_equal(old[0], new[0]) == same
