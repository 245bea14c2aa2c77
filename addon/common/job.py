"""Long work in steps: the work of a modal operator, without the operator."""

from __future__ import annotations

import threading
import time
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from . import units


class Job(Protocol):
    """The interface of work that blender/long_work.py runs. `step` raises errors, and leaves nothing half done."""

    in_background: bool  # the work has a thread of its own, and `step` only waits for it
    fraction: float  # share of the work done, 0 … 1
    text: str  # progress in words, or ""

    def step(self, budget: float) -> bool:
        """Works, or waits, for about `budget` seconds; True when all is done."""

    def cancel(self) -> None:
        """Restores the state before the work; may be called at any time."""


def run_through(job: Job, report=None) -> None:
    """Runs the whole job, in steps, so that `report(fraction)` is called."""
    while not job.step(0.25):
        if report:
            report(job.fraction)


class DoneJob:
    """A finished result as a job, where other jobs of its kind take long."""

    in_background, fraction, text = False, 1.0, ""

    def __init__(self, result):
        self.result = result

    def step(self, budget: float = 0.0) -> bool:
        return True

    def cancel(self) -> None:
        """Does nothing: nothing was changed."""


class TaskJob:
    """A riffler.Future as a job: once `step` has returned True, `result` is what the call made."""

    in_background = True

    def __init__(self, task, text="", clock=time.perf_counter, sleep=time.sleep):
        self.text, self.result = text, None
        self._task, self._clock, self._sleep = task, clock, sleep

    @property
    def fraction(self) -> float:
        return self._task.progress()

    def step(self, budget: float = 0.0) -> bool:
        begin = self._clock()
        while not self._task.done():
            spent = self._clock() - begin
            if spent >= budget:
                return False
            self._sleep(min(budget - spent, max(2e-4, 0.05 * spent), 0.005))  # so that short tasks are not delayed
        self.result = self._task.result()  # raises the error of the task's call
        return True

    def cancel(self) -> None:
        self._task.cancel()


class ChainJob:
    """Native tasks in sequence: `steps` are functions that start a task with the previous one's result; the first gets
    None. All have equal shares of the progress."""

    in_background = True

    def __init__(self, *steps, text=""):
        self.text, self.result = text, None
        self._steps, self._done, self._job = list(steps), 0, None

    @property
    def fraction(self) -> float:
        now = 0.0 if self._job is None else self._job.fraction
        return min(1.0, (self._done + now) / len(self._steps))

    def step(self, budget: float = 0.0) -> bool:
        if self._job is None:
            self._job = TaskJob(self._steps[self._done](self.result))
        if not self._job.step(budget):
            return False
        self.result, self._job = self._job.result, None
        self._done += 1
        return self._done == len(self._steps)

    def cancel(self) -> None:
        if self._job is not None:
            self._job.cancel()


class AfterJob:
    """The job that `make` returns for a task's result, once the task is done. Attributes of that job can be read from
    this one. `in_background`: that of the job."""

    def __init__(self, task, make, in_background=True, text=""):
        self.in_background, self._text = in_background, text
        self._wait, self._make, self._job = TaskJob(task), make, None
        self._begin = 0.0 if task.done() else 0.5  # start of the job's share of the whole

    @property
    def fraction(self) -> float:
        if self._job is None:
            return self._begin * self._wait.fraction
        return self._begin + (1 - self._begin) * self._job.fraction

    @property
    def text(self) -> str:
        return self._text if self._job is None else self._job.text

    def step(self, budget: float = 0.0) -> bool:
        if self._job is None:
            if not self._wait.step(budget if self.in_background else min(budget, 0.01)):  # waiting costs no time slice
                return False
            self._job = self._make(self._wait.result)
        return self._job.step(budget)

    def cancel(self) -> None:
        (self._job or self._wait).cancel()

    def __getattr__(self, name):
        return getattr(self._job, name)


class ThreadTask:
    """Counterpart of riffler.Future that keeps Python alive: `call(progress)` on a Python thread. The call must
    not touch Blender, and must release Python's lock while it works, as long calls of riffler do."""

    def __init__(self, call):
        self._share, self._cancelled = 0.0, False
        self._result, self._error = None, None
        self._thread = threading.Thread(target=self._run, args=(call,))
        self._thread.start()

    def _run(self, call) -> None:
        try:
            self._result = call(self._report)
        except BaseException as error:  # `result` raises it
            self._error = error

    def _report(self, share: float) -> bool:
        self._share = share
        return not self._cancelled

    def progress(self) -> float:
        return self._share

    def done(self) -> bool:
        return not self._thread.is_alive()

    def result(self):
        self._thread.join()
        if self._error is not None:
            raise self._error
        return self._result

    def cancel(self) -> None:
        self._cancelled = True


class PiecesJob:
    """Python work in pieces: a generator that yields after each of its `count` pieces. If it yields a native task, it
    is sent that task's result. Its return value is the `result`."""

    def __init__(self, pieces, count: int, text="", clock=time.perf_counter):
        self.text, self.result = text, None
        self._pieces, self._count, self._clock = pieces, count, clock
        self._done, self._task, self._made = 0, None, None

    @property
    def in_background(self) -> bool:
        return self._task is not None

    @property
    def fraction(self) -> float:
        now = 0.0 if self._task is None else self._task.fraction
        return min(1.0, (self._done + now) / self._count)

    def step(self, budget: float = 0.0) -> bool:
        end = self._clock() + budget
        while True:
            if self._task is not None:
                if not self._task.step(budget):
                    return False
                self._made, self._task = self._task.result, None
            try:
                wanted = self._pieces.send(self._made)
            except StopIteration as end_of_all:
                self.result = end_of_all.value
                return True
            self._done, self._made = self._done + 1, None
            self._task = None if wanted is None else TaskJob(wanted)
            if self._task is not None or self._clock() >= end:
                return False

    def cancel(self) -> None:
        if self._task is not None:
            self._task.cancel()
        self._pieces.close()


@dataclass
class Cut:
    """One uninterrupted motion of one tool: the argument of carving, stored with the sculpt, and written as NC code."""

    tool: dict  # in the form of riffler.Tool.to_dict
    poses: np.ndarray  # (n, 6) tip and axis, mm, stock's frame
    tolerance: float = 0.01  # mm, the tolerance of carve
    mode: str = "remove"  # the mode of carve
    masked: bool = False  # made with a mask: without it, the cut also removes what the mask protected

    @property
    def moves(self) -> int:
        return len(self.poses) - 1


def cuts_of(strokes, masked: bool) -> list[Cut]:
    """The cuts of a live sculpt's strokes, (copy, tool, mode, pieces of poses), except strokes without cuts."""
    return [Cut(tool, np.vstack(rows), mode=mode, masked=masked) for _, tool, mode, rows in strokes if rows]


class CutJob:
    """Carves `cuts` from `volume` in slices. Call `step` until it returns True. `cancel` before that, and any error,
    restore the volume."""

    in_background = False

    def __init__(self, volume, cuts, make_tool, protect=None, clock=time.perf_counter):
        if not cuts or not all(c.moves > 0 for c in cuts):
            raise ValueError("nothing to cut: a cut needs two poses")
        self.volume = volume
        self.cuts = list(cuts)
        self.total = sum(c.moves for c in self.cuts)
        self.done = 0
        self.removed = 0.0
        self._tools = [make_tool(c.tool) for c in self.cuts]
        self._clock = clock
        # carve gets optional arguments only where they are needed
        self._more = {} if protect is None else {"protect": protect}
        self._snapshot = volume.snapshot()
        self._cut = self._move = 0
        self._rate = 200.0  # moves per second; measured from the first slice on

    @property
    def fraction(self) -> float:
        return self.done / self.total

    @property
    def text(self) -> str:
        return f"Move {units.format_count(self.done)} of {units.format_count(self.total)}"

    @property
    def finished(self) -> bool:
        return self.done == self.total

    def step(self, budget: float = 0.04) -> bool:
        """Carves for about `budget` seconds (at least one slice of moves); True when all is cut."""
        end = self._clock() + budget
        while not self.finished:
            left = end - self._clock()
            if left <= 0:
                break
            self._slice(max(1, int(self._rate * min(left, budget))))
        return self.finished

    def cancel(self) -> None:
        self.volume.restore(self._snapshot)
        self.done = self._cut = self._move = 0
        self.removed = 0.0

    def _slice(self, moves: int) -> None:
        cut = self.cuts[self._cut]
        last = min(self._move + moves, cut.moves)
        begin = self._clock()
        try:
            poses = cut.poses[self._move : last + 1]
            result = self.volume.carve(
                self._tools[self._cut], poses, tolerance=cut.tolerance, mode=cut.mode, **self._more
            )
        except Exception:
            self.cancel()
            raise
        spent = max(self._clock() - begin, 1e-6)
        self.removed += float(result.removed.sum())
        count = last - self._move
        self._rate = 0.5 * self._rate + 0.5 * count / spent
        self.done += count
        self._move = last
        if last == cut.moves:
            self._cut, self._move = self._cut + 1, 0


def slice_budget(outside: float, least: float = 0.04, most: float = 0.5) -> float:
    """Seconds of carving for the next tick, after `outside` seconds since the last one: as long as drawing the window
    took. So a slow display gives half of the time to the cut, and a fast one shows no lag."""
    return min(max(outside, least), most)


class RefreshClock:
    """When to redraw a running cut: never more than a `share` of the time, so that showing a cut cannot slow it down
    much."""

    def __init__(self, share: float = 0.25, least: float = 0.25, clock=time.perf_counter):
        self._share, self._least, self._clock = share, least, clock
        self._next = clock() + least

    def due(self) -> bool:
        return self._clock() >= self._next

    def spent(self, seconds: float) -> None:
        self._next = self._clock() + max(self._least, seconds / self._share - seconds)
