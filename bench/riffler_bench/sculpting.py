"""Ten minutes of a session with the simulated pen: what a step costs, what grows, whether energy is made."""

from __future__ import annotations

import numpy as np

from . import _bench as core
from . import report
from .measure import Settings, quantile
from .report import Column, Report

CASES = (
    {"pitch": 0.25, "directions": "z"},
    {"pitch": 0.15, "directions": "z"},
    {"pitch": 0.4, "directions": "xyz"},
    {"pitch": 0.2, "directions": "xyz"},
    {"pitch": 0.25, "directions": "z", "stiffness": 10.0, "jitter_us": 1500},
)
MINUTES = 600.0, 60.0, 60.0, 60.0, 60.0


def sessions(out: Report, settings: Settings) -> None:
    table = out.section(
        "session",
        "Sculpting with the simulated pen: processor time of a step, memory, energy",
        Column("stock", "directions"),
        Column("pitch", "pitch"),
        Column("coupling", "stiffness", lambda k: f"{k:g} N/mm"),
        Column("jitter", "jitter_us", lambda us: f"{us / 1e3:g} ms"),
        Column("of the hand", "simulated_s", lambda s: f"{s:.0f} s"),
        Column("median", "p50_s", report.micro),
        Column("99 %", "p99_s", report.micro),
        Column("99.9 %", "p999_s", report.micro),
        Column("largest", "max_s", report.micro),
        Column("cut", "removed", lambda v: f"{1e-3 * v:.1f} cm³"),
        Column("memory, 1st and last tenth", "memory", str),
        Column("taken from the hand", "given", lambda e: f"{e:.0f} N·mm"),
        Column("most that it was given", "gained", lambda e: f"{e:.3f} N·mm"),
    )
    for case, seconds in zip(CASES, MINUTES, strict=True):
        simulated = 1.0 if settings.quick else seconds
        run = core.sculpting(simulated, **case)
        times = np.sort(run["seconds"].astype(float))
        memory = run["resident_mb"]
        table.row(
            **{"stiffness": 1.0, "jitter_us": 200} | case, simulated_s=simulated,
            p50_s=quantile(times, 0.5), p99_s=quantile(times, 0.99), p999_s=quantile(times, 0.999),
            max_s=float(times[-1]), removed=run["removed"], memory=f"{memory[1]:.0f}, {memory[-1]:.0f} MB",
            resident_mb=memory, given=run["given"], gained=run["gained"],
            slowest_s=[float(x) for x in times[-max(1, len(times) // 50) :: 20]],
        )  # fmt: skip
        what = f"{case}"
        out.check(run["replayed"], f"{what}: the moves made again leave other bytes")
        out.check(run["missed"] == 0, f"{what}: {run['missed']} steps were missed")
        out.check(run["from_system"] == 0, f"{what}: steps asked the system for {run['from_system']} blocks")
        out.check(run["gained"] < 1.1, f"{what}: the hand gained {run['gained']:.2f} N·mm")
    table.notes.append(
        "A Ø6 ball wanders through 80 × 80 × 30 mm on a virtual clock, with firmware, cable and the driver's loop; a "
        "mesh follows thirty times a second. Memory is the process's, mesh and Python included."
    )
