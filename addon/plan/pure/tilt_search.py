"""Finds few keys along a path with which the tool is collision-free at each of its points: the orientations of least
tilt from the middle between the two walls, from the maps of free orientations (riffler.plan.min_tilt), and more keys
only where points between them collide.

Moves between points are not checked here: on a curved path they dip into the part by the chord error, and only
resolving, which may lift the tool and insert rows, decides whether that matters.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

import numpy as np
import riffler

from ...common import units
from ...common.job import TaskJob

# weight of the turn from key to key against the tilt: of two equivalent orientations both keys take the same
SMOOTH = 0.1
ROUNDS = 8  # rounds of adding keys where the tool collides between them
AT_ONCE = 8  # paths searched at the same time: native tasks are polled only now and then


@dataclass(frozen=True)
class Rule:
    """`tool`: enlarged by the clearance of shank and holder; `count`: smallest number of keys on each path; `limit`:
    (axis, angle), the machine's cone, or None."""

    tool: object
    collider: object
    tolerance: float
    count: int = 2
    limit: tuple | None = None


@dataclass
class Answer:
    """Result of one path: `path` with orientations, or None and then the `point` without a solution, and the reason."""

    path: object = None
    point: int = 0
    reason: str = ""


def begun(path, count: int) -> list[int]:
    """The first keys' points: evenly spaced by length, with the ends of an open path; a single one is in the middle."""
    count = min(count, len(path))
    ring = np.vstack([path.centres, path.centres[:1]]) if path.closed else path.centres
    stations = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(ring, axis=0), axis=1))])
    alone = [0.0 if path.closed else 0.5]
    shares = np.linspace(0, 1, count, endpoint=not path.closed) if count > 1 else alone
    near = [int(np.abs(stations[: len(path)] - share * stations[-1]).argmin()) for share in shares]
    return sorted(set(near))


def further(points: list[int], blocked: list[int]) -> list[int]:
    """Adds a key in the middle of each run of blocked points, unless all its points are keys."""
    rows = np.array(sorted(set(blocked)), int)
    if not len(rows):
        return points
    runs = np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1)
    return sorted({*points, *(_nearest_free(run, points) for run in runs)} - {None})


def _nearest_free(run: np.ndarray, points: list[int]):
    """The point of a run that is nearest to its middle and not a key; None if all are."""
    free = np.setdiff1d(run, points)
    return int(free[np.abs(free - run.mean()).argmin()]) if len(free) else None


class Search:
    """The search on one path, step by step: `step` waits for about so many seconds for a native task; True when
    `answer` is ready."""

    def __init__(self, path, rule: Rule):
        self._path, self._rule = path, rule
        self._points, self._rounds = begun(path, rule.count), 0
        self._keyed, self._job, self._taken = None, None, None
        self.answer: Answer | None = None

    def step(self, budget: float) -> bool:
        if self._job is None:
            self._choose()
        if self.answer is None and self._job.step(budget):
            self._taken(self._job.result)
        return self.answer is not None

    def cancel(self) -> None:
        if self._job is not None:
            self._job.cancel()

    def _choose(self) -> None:
        """Axes at the keys' points, which form a path of their own for that."""
        rule, some, path = self._rule, self._points, self._path
        closed = path.closed and len(some) > 2
        few = riffler.plan.PencilPath(
            path.radius, path.centres[some], path.contacts[some], path.normals[some], closed=closed
        )
        sizes = {"tolerance": rule.tolerance, "limit": rule.limit, "max_change": math.pi, "smoothness": SMOOTH}
        self._job = TaskJob(riffler.submit(riffler.plan.min_tilt, few, rule.tool, rule.collider, **sizes))
        self._taken = self._check

    def _check(self, found) -> None:
        """Checks whether the points between them are free as well."""
        oriented, report = found
        if oriented is None:
            self.answer = Answer(None, self._points[report.point], report.reason.partition(": ")[2])
            return
        keys = dict(zip(self._points, oriented.axes, strict=True))
        try:
            self._keyed = self._path.orient(
                keys, interpolation=self._path.interpolation or "smooth", limit=self._rule.limit
            )
        except ValueError as error:
            self.answer = Answer(None, self._points[0], str(error))
            return
        sizes = {"tolerance": self._rule.tolerance, "max_lift": 0.0, "max_inserted": 0}
        locate = riffler.plan.cutter_locations
        self._job = TaskJob(riffler.submit(locate, self._keyed, self._rule.tool, self._rule.collider, **sizes))
        self._taken = self._judge

    def _judge(self, found) -> None:
        blocked = found[1].blocked
        if not blocked:
            self.answer = Answer(self._keyed)
            return
        more = further(self._points, [point for point, _ in blocked])
        self._rounds += 1
        if more == self._points or self._rounds > ROUNDS:
            self.answer = Answer(None, *blocked[0])
        else:
            self._points, self._job = more, None


class Given:
    """Like Search, with one axis, whether or not it collides."""

    def __init__(self, path, axis):
        (point,) = begun(path, 1)
        self.answer = Answer(
            path.orient({point: np.asarray(axis, float)}, interpolation=path.interpolation or "smooth")
        )

    def step(self, budget: float) -> bool:
        return True

    def cancel(self) -> None:
        """Nothing to undo."""


class SearchesJob:
    """Searches as a job for blender/long_work.py; `answers`: theirs, in order, once all are ready."""

    in_background = True

    def __init__(self, searches, clock=time.perf_counter, sleep=time.sleep):
        self._waiting, self._total, self._clock, self._sleep = list(enumerate(searches)), len(searches), clock, sleep
        self._running, self._found = [], {}

    @property
    def fraction(self) -> float:
        return len(self._found) / self._total if self._total else 1.0

    @property
    def text(self) -> str:
        return f"Path {units.format_count(len(self._found))} of {units.format_count(self._total)}"

    @property
    def answers(self) -> list[Answer]:
        return [self._found[k] for k in range(self._total)]

    def step(self, budget: float = 0.0) -> bool:
        end = self._clock() + budget
        while not self._look():
            left = end - self._clock()
            if left <= 0:
                return False
            self._sleep(min(left, 0.002))
        return True

    def cancel(self) -> None:
        for _, search in self._running:
            search.cancel()

    def _look(self) -> bool:
        while self._waiting and len(self._running) < AT_ONCE:
            self._running.append(self._waiting.pop(0))
        self._found.update((k, search.answer) for k, search in self._running if search.step(0.0))
        self._running = [(k, search) for k, search in self._running if k not in self._found]
        return len(self._found) == self._total
