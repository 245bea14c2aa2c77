"""Clocks: processor time against the yardstick, and whole processes of their own where memory counts."""

from __future__ import annotations

import gc
import hashlib
import json
import os
import statistics
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from . import _bench as core

T = TypeVar("T")
Progress = Callable[[float], None] | None


@dataclass(frozen=True)
class Settings:
    """What the command line asked for."""

    quick: bool = False
    models: Path | None = None
    blenders: tuple[Path, ...] = ()
    rivals: Path | None = None
    programs: Path | None = None


@contextmanager
def threads(count: int | None) -> Iterator[None]:
    """RIFFLER_THREADS for the while; None is as many as there are."""
    before = os.environ.pop("RIFFLER_THREADS", None)
    try:
        if count is not None:
            os.environ["RIFFLER_THREADS"] = str(count)
        yield
    finally:
        os.environ.pop("RIFFLER_THREADS", None)
        if before is not None:
            os.environ["RIFFLER_THREADS"] = before


def how_many(threads: int | None) -> int:
    """The number itself; for None as many as this process may run on."""
    return threads or len(os.sched_getaffinity(0))


def watched(items: Sequence[T], progress: Progress) -> Iterator[T]:
    """The items, with the finished share reported."""
    for done, item in enumerate(items):
        if progress:
            progress(done / len(items))
        yield item


def shares(progress: Progress) -> Callable[[float, float], Progress]:
    """Progress of a part that goes from share a to share b of the whole."""
    return (lambda a, b: lambda x: progress(a + (b - a) * x)) if progress else (lambda a, b: None)


def cores() -> float:
    """How many processors two busy threads get at the moment; they hash, which needs no lock of Python's."""
    block = bytes(1 << 25)

    def work() -> None:
        for _ in range(4):
            hashlib.sha256(block).digest()

    wall, cpu = time.perf_counter(), time.process_time()
    busy = [threading.Thread(target=work) for _ in range(2)]
    for thread in busy:
        thread.start()
    for thread in busy:
        thread.join()
    return (time.process_time() - cpu) / (time.perf_counter() - wall)


@contextmanager
def steady() -> Iterator[None]:
    """One thread, and no garbage collection in the middle of a measurement."""
    enabled = gc.isenabled()
    gc.disable()
    try:
        with threads(1):
            yield
    finally:
        if enabled:
            gc.enable()


@dataclass(frozen=True)
class Timing:
    """Medians over repetitions: seconds of one run, and its ratio to the yardstick's run just before it."""

    seconds: float
    ratio: float
    loop: float
    repeats: int


class Yardstick:
    """The capsule loop of one pitch, and the work that is timed in turn with it."""

    def __init__(self, pitch: float, quick: bool) -> None:
        self._loop = core.CapsuleLoop(pitch)
        self._budget, self._most = (0.2, 3) if quick else (2.0, 9)

    def _loop_seconds(self) -> float:
        self._loop.reset()
        start = time.thread_time()
        self._loop.run()
        return time.thread_time() - start

    def alone(self) -> float:
        """Median seconds of the loop by itself."""
        with steady():
            return statistics.median(self._loop_seconds() for _ in range(self._most))

    def beside(self, prepare: Callable[[], T], work: Callable[[T], Any]) -> tuple[Timing, T]:
        """Runs the loop and work(prepare()) in turn until the budget is used; one run at least, after a warm-up unless
        a run takes the whole budget. Returns the prepared thing of the last run too."""
        seconds, loops = [], []
        with steady():
            self._loop_seconds()
            begun = time.thread_time()
            while not seconds or (len(seconds) <= self._most and time.thread_time() - begun < self._budget):
                loops.append(self._loop_seconds())
                thing = prepare()
                start = time.thread_time()
                work(thing)
                seconds.append(time.thread_time() - start)
        if len(seconds) > 1:
            del seconds[0], loops[0]
        ratios = [a / b for a, b in zip(seconds, loops, strict=True)]
        timing = Timing(statistics.median(seconds), statistics.median(ratios), statistics.median(loops), len(seconds))
        return timing, thing


def started(command: list[str], environment: dict[str, str]) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, env=environment, capture_output=True, text=True, check=False)


def child(work: str, threads: int | None = 1, **arguments: Any) -> dict[str, Any]:
    """What the function `work` of ``children`` returns in a process of its own, and that process's ``peak_bytes``."""
    root = str(Path(__file__).resolve().parents[2])
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, [root, os.environ.get("PYTHONPATH")]))}
    environment.pop("RIFFLER_THREADS", None)
    environment["OPENBLAS_NUM_THREADS"] = "1"  # numpy's threads spin for a while, and count as processor time
    if threads is not None:
        environment["RIFFLER_THREADS"] = str(threads)
    command = [sys.executable, "-m", "riffler_bench.children", work, json.dumps(arguments)]
    done = started(command, environment)
    if done.returncode != 0:
        last = done.stderr.strip().splitlines()[-1:] or ["no message"]
        raise RuntimeError(f"bench {work} {arguments}: {last[0]}")
    return json.loads(done.stdout.splitlines()[-1])


def quantile(values: Iterable[float], share: float) -> float:
    """The value that `share` of them do not exceed."""
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))]
