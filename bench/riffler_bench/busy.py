"""A session on a busy machine: how long its steps take by the clock on the wall, and how late they begin, with and
without real-time priority, in turns."""

from __future__ import annotations

import os

import numpy as np

from . import _bench as core
from . import report
from .measure import Settings, quantile
from .report import Column, Report

PERIOD = 1e-3  # s
ROUNDS, SECONDS = 5, 12.0
PER_PROCESSOR = 2  # threads that compute


def sessions(out: Report, settings: Settings) -> None:
    rounds, seconds = (1, 0.5) if settings.quick else (ROUNDS, SECONDS)
    load = PER_PROCESSOR * len(os.sched_getaffinity(0))
    table = out.section(
        "busy",
        f"A session while {load} threads compute: each step by the clock on the wall, and how late it begins",
        Column("thread", "thread"),
        Column("steps", "count"),
        Column("step, median", "p50_s", report.micro),
        Column("99 %", "p99_s", report.micro),
        Column("99.9 %", "p999_s", report.micro),
        Column("largest", "max_s", report.micro),
        Column("late, median", "late_p50_s", report.micro),
        Column("late, 99 %", "late_p99_s", report.micro),
        Column("late, 99.9 %", "late_p999_s", report.micro),
        Column("late, largest", "late_max_s", report.micro),
    )
    runs: dict[bool, list[dict]] = {False: [], True: []}
    before = os.getloadavg()[0]
    for _ in range(rounds):
        for real_time, mine in runs.items():
            mine.append(core.busy_session(seconds, load, real_time))
    for real_time, mine in runs.items():
        step = np.concatenate([run["step"] for run in mine])
        late = np.maximum(0, np.concatenate([run["period"] for run in mine]) - PERIOD)
        name = mine[0]["priority"] if real_time else "normal"
        table.row(
            thread=name, level=mine[0]["level"], count=len(step),
            **{f"{key}_s": quantile(list(step), q) for key, q in (("p50", 0.5), ("p99", 0.99), ("p999", 0.999))},
            **{f"late_{key}_s": quantile(list(late), q) for key, q in (("p50", 0.5), ("p99", 0.99), ("p999", 0.999))},
            max_s=float(step.max()), late_max_s=float(late.max()),
        )  # fmt: skip
        out.check(len(step) > 10 * seconds, f"{name}: only {len(step)} steps in {rounds * seconds:g} s")
    table.notes.append(
        f"{rounds} times {seconds:g} s each, in turns; load average before it: {before:.1f}. Late: the time since the "
        "start of the step before, less 1 ms. The hand carves with a Ø6 ball at a pitch of 0.25."
    )
