"""Long work in steps: a cut and a native task, with a fake clock, volume and task."""

import threading
from itertools import pairwise

import numpy as np
import pytest

from addon.common.job import (
    AfterJob,
    Cut,
    CutJob,
    DoneJob,
    PiecesJob,
    RefreshClock,
    TaskJob,
    ThreadTask,
    run_through,
    slice_budget,
)


class Clock:
    def __init__(self):
        self.now = 0.0

    def __call__(self):
        return self.now


class Volume:
    """Counts moves; each takes `cost` s; move `bad` fails."""

    def __init__(self, clock, cost=0.001, bad=None):
        self.clock, self.cost, self.bad = clock, cost, bad
        self.log = []

    def snapshot(self):
        return list(self.log)

    def restore(self, snapshot):
        self.log = list(snapshot)

    def carve(self, tool, poses, tolerance, mode):
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


def test_every_move_is_cut_once_and_in_order_for_any_slices():
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
    j.step(0.04)  # the first estimate is wrong once
    for _ in range(10):
        begin = clock.now
        j.step(0.04)
        assert clock.now - begin <= 4.0


def test_cancel_restores_the_volume():
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


def test_run_through_reports_progress_and_gives_the_same_result_as_slices():
    shares, volume = [], Volume(Clock(), cost=0.1)
    j = job(volume, cut(0, 200))
    run_through(j, shares.append)
    assert len(volume.log) == 200 and j.text == "Move 200 of 200"
    assert len(shares) > 3 and shares == sorted(shares) and shares[0] > 0 and shares[-1] < 1


def test_work_finished_at_once_needs_no_step():
    shares, j = [], DoneJob("made")
    run_through(j, shares.append)
    assert j.result == "made" and shares == [] and j.fraction == 1


class Task:
    """Has the interface of riffler.Future: done after `seconds` of its clock, then returns or raises `outcome`."""

    def __init__(self, clock, seconds, outcome):
        self.clock, self.seconds, self.outcome = clock, seconds, outcome
        self.cancelled = False

    def progress(self):
        return min(1.0, self.clock.now / self.seconds)

    def done(self):
        return self.cancelled or self.clock.now >= self.seconds

    def cancel(self):
        self.cancelled = True

    def result(self):
        if self.cancelled:
            raise RuntimeError("cancelled")
        if isinstance(self.outcome, Exception):
            raise self.outcome
        return self.outcome


def task_job(seconds, outcome, text=""):
    clock = Clock()

    def sleep(span):
        assert span > 0
        clock.now += span

    return clock, TaskJob(Task(clock, seconds, outcome), text, clock, sleep)


def test_a_task_is_waited_for_no_longer_than_the_budget():
    clock, j = task_job(1.0, "paths")
    assert not j.step(0.0) and clock.now == 0  # a window's tick only polls
    assert not j.step(0.25) and clock.now == pytest.approx(0.25) and j.fraction == pytest.approx(0.25)
    assert j.result is None
    assert j.step(10.0) and clock.now < 1.01 and j.result == "paths"


def test_run_through_waits_for_a_task_and_reports_its_progress():
    shares = []
    _, j = task_job(1.1, "paths", "Searching")
    run_through(j, shares.append)
    assert j.result == "paths" and shares == pytest.approx([0.25 / 1.1, 0.5 / 1.1, 0.75 / 1.1, 1.0 / 1.1])


def test_the_next_step_raises_the_error_of_a_task():
    _, j = task_job(0.1, ValueError("tool: none"))
    with pytest.raises(ValueError, match="tool: none"):
        run_through(j)
    assert j.result is None


def test_cancel_reaches_the_task():
    _, j = task_job(10.0, "paths")
    j.step(0.1)
    j.cancel()
    assert j._task.cancelled


class Making:
    """A task that is done at its n-th poll."""

    def __init__(self, asked):
        self.left, self.cancelled = asked, False

    def done(self):
        self.left -= 1
        return self.left < 0

    def progress(self):
        return 0.5

    def result(self):
        assert self.left < 0, "it was waited for"
        return "part"

    def cancel(self):
        self.cancelled = True


def test_a_job_begins_once_what_it_needs_is_made():
    after = AfterJob(Making(3), lambda made: DoneJob([made]), text="making")
    assert not after.step(0.0) and (after.fraction, after.text, after.in_background) == (0.25, "making", True)
    assert not after.step(0.0) and after.step(0.0)
    assert (after.result, after.fraction, after.text) == (["part"], 1.0, "")
    at_once = AfterJob(Making(0), lambda made: DoneJob(made))
    assert at_once.step(0.0) and at_once.result == "part"
    making = Making(9)
    waiting = AfterJob(making, DoneJob)
    waiting.cancel()
    assert making.cancelled
    volume = Volume(Clock())
    slices = AfterJob(Making(1), lambda _: job(volume, cut(0, 5)), in_background=False)
    run_through(slices)
    assert len(volume.log) == 5 and slices.removed == 5
    slices.cancel()
    assert volume.log == []


def test_a_call_on_a_thread_is_a_task():
    go = threading.Event()

    def call(progress):
        assert threading.current_thread() is not threading.main_thread()
        assert progress(0.25)
        go.wait(10)
        return "going" if progress(0.5) else "cancelled"

    for cancel, wanted in ((False, "going"), (True, "cancelled")):
        go.clear()
        task = TaskJob(ThreadTask(call))
        assert not task.step(0.01)
        if cancel:
            task.cancel()
        go.set()
        run_through(task)
        assert task.result == wanted and task.fraction == 0.5

    def fails(progress):
        raise ValueError("flat")

    with pytest.raises(ValueError, match="flat"):
        run_through(TaskJob(ThreadTask(fails)))


def test_work_in_pieces_continues_with_the_result_of_its_task():
    done, clock = [], Clock()

    def pieces():
        done.append("a")
        yield
        done.append("b")
        yield
        done.append((yield Task(clock, 1.0, "made")))
        return "all"

    work = PiecesJob(pieces(), 4, clock=clock)
    assert not work.step(0.0) and done == ["a"] and not work.in_background and work.fraction == 0.25
    assert not work.step(0.0) and done == ["a", "b"]
    assert (
        not work.step(0.0) and work.in_background and work.fraction == 0.75
    )  # a window's tick only polls from here on
    assert not work.step(0.0) and done == ["a", "b"]
    clock.now = 1.0
    assert work.step(0.0) and done == ["a", "b", "made"] and work.result == "all" and not work.in_background
    clock.now, done = 5.0, []
    whole = PiecesJob(pieces(), 4)
    run_through(whole)
    assert whole.result == "all" and done[-1] == "made"


def test_work_in_pieces_does_as_many_as_its_budget_has_time_for():
    clock, done = Clock(), []

    def pieces():
        for k in range(5):
            clock.now += 0.1
            done.append(k)
            yield

    work = PiecesJob(pieces(), 5, clock=clock)
    assert not work.step(0.25) and done == [0, 1, 2]
    assert work.step(1.0) and work.fraction == 1.0


def test_work_in_pieces_that_is_cancelled_ends_where_it_is():
    ended, task = [], Task(Clock(), 1.0, "made")

    def pieces():
        try:
            yield
            yield task
        finally:
            ended.append(True)

    work = PiecesJob(pieces(), 3)
    while not work.in_background:
        work.step(0.0)
    work.cancel()
    assert ended and task.cancelled
