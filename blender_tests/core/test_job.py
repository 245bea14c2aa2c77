"""The step function of a cut, on a clock and a volume of our own."""

from itertools import pairwise

import numpy as np
import pytest

from addon.core.job import Cut, CutJob, RefreshClock, slice_budget


class Clock:
    def __init__(self):
        self.now = 0.0

    def __call__(self):
        return self.now


class Volume:
    """Counts moves; each takes `cost` s; fails at move `bad`."""

    def __init__(self, clock, cost=0.001, bad=None):
        self.clock, self.cost, self.bad = clock, cost, bad
        self.log = []

    def snapshot(self):
        return list(self.log)

    def restore(self, snapshot):
        self.log = list(snapshot)

    def carve(self, tool, poses, tolerance):
        if self.bad is not None and any(p[0] == self.bad for p in poses):
            raise ValueError("bad row")
        self.clock.now += self.cost * (len(poses) - 1)
        self.log += [(tool, a[0], b[0], tolerance) for a, b in pairwise(poses)]
        return type("Result", (), {"removed": np.ones(len(poses) - 1)})


def cut(first, moves, tool="t", tolerance=0.01):
    poses = np.zeros((moves + 1, 6))
    poses[:, 0] = np.arange(first, first + moves + 1)
    return Cut(tool, poses, tolerance)


def job(volume, *cuts):
    return CutJob(volume, cuts, lambda tool: tool, clock=volume.clock)


def test_every_move_is_cut_once_and_in_order_whatever_the_slices():
    for budget in (1e-9, 0.0005, 0.01, 10.0):
        volume = Volume(Clock())
        j = job(volume, cut(0, 57, "a", 0.02), cut(100, 1), cut(200, 133))
        while not j.step(budget):
            assert 0 <= j.fraction < 1
        expected = [("a", k, k + 1, 0.02) for k in range(57)] + [("t", 100, 101, 0.01)]
        expected += [("t", k, k + 1, 0.01) for k in range(200, 333)]
        assert volume.log == expected and j.fraction == 1 and j.removed == 191


def test_a_step_takes_about_its_budget():
    clock = Clock()
    j = job(Volume(clock), cut(0, 5000))
    j.step(0.04)
    for _ in range(20):
        begin = clock.now
        j.step(0.04)
        assert 0.03 < clock.now - begin < 0.06


def test_a_slow_move_is_not_held_up_by_the_guess():
    clock = Clock()
    j = job(Volume(clock, cost=1.0), cut(0, 40))
    j.step(0.04)  # the first guess is wrong once
    for _ in range(10):
        begin = clock.now
        j.step(0.04)
        assert clock.now - begin <= 4.0


def test_cancel_restores():
    volume = Volume(Clock())
    volume.log = ["before"]
    j = job(volume, cut(0, 100))
    j.step(0.01)
    assert len(volume.log) > 1
    j.cancel()
    assert volume.log == ["before"] and j.fraction == 0


def test_an_error_restores_and_is_raised():
    volume = Volume(Clock(), bad=60)
    j = job(volume, cut(0, 100))
    with pytest.raises(ValueError, match="bad row"):
        while not j.step(0.005):
            pass
    assert volume.log == [] and j.removed == 0


def test_nothing_to_cut_is_refused():
    with pytest.raises(ValueError, match="two poses"):
        job(Volume(Clock()))
    with pytest.raises(ValueError, match="two poses"):
        job(Volume(Clock()), cut(0, 0))


def test_carving_gets_half_of_the_time_on_a_slow_display():
    assert [slice_budget(s) for s in (0.001, 0.2, 9.0)] == [0.04, 0.2, 0.5]


def test_the_picture_never_takes_more_than_its_share():
    clock = Clock()
    refresh = RefreshClock(share=0.25, least=0.25, clock=clock)
    shown = 0.0
    while clock.now < 60:
        clock.now += 0.04
        if refresh.due():
            clock.now += 2.0
            shown += 2.0
            refresh.spent(2.0)
    assert 0.15 < shown / clock.now < 0.27
