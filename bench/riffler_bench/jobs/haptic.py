"""Haptic step: a Ø20 ball, 0.5 mm a step, one call a step with force and torque, as a pen makes it; the whole step with
coupling, cut, contact and fixtures; its force against that of very small steps and of interpolation; minutes of a
session; and a session on a busy machine, with and without real-time priority."""

from __future__ import annotations

import statistics
import time

import numpy as np
from riffler import Tool, Volume

from .. import busy, directions, rendering, report, scenes, sculpting
from ..measure import Progress, Settings, quantile, steady, watched
from ..report import Column, Report

PITCH, STEP, DT = 0.1, 0.5, 0.001
TARGET = 0.5e-3  # s, 99 % of the steps
COUNTERS = ("steps", "tiles_visited", "rays_tested", "rays_changed", "bytes_copied")


def run(settings: Settings, progress: Progress = None) -> Report:
    sides, steps = ((1024, 1280), 60) if settings.quick else ((1024, 4096), 600)
    out = Report("haptic", {"steps": steps, "target_s": TARGET})
    table = out.section(
        "steps",
        "Ø20 ball, steps of 0.5 mm at h = 0.1, force and torque: processor time of one step",
        Column("rays", "side", lambda n: f"{n}²"),
        Column("axis", "axis"),
        Column("steps", "count"),
        Column("median", "p50_s", report.micro),
        Column("99 %", "p99_s", report.micro),
        Column("largest", "max_s", report.micro),
        Column("rays tested", "rays_tested", report.three),
        Column("rays changed", "rays_changed", report.three),
        Column("tiles visited", "tiles_visited", report.three),
        Column("kB copied", "bytes_copied", lambda n: report.three(n / 1e3)),
    )
    work = {}
    for side, turning in watched([(s, t) for s in sides for t in (False, True)], progress):
        axis = "turning" if turning else "upright"
        try:
            times, counters, force = stroke(side, steps, turning)
        except ValueError as error:  # says how much memory the grid would need
            table.notes.append(f"{side}², {axis}: left out, {error}.")
            continue
        table.row(
            side=side, axis=axis, count=steps,
            p50_s=statistics.median(times), p99_s=quantile(times, 0.99), max_s=max(times), times_s=times, **counters,
        )  # fmt: skip
        out.check(force > 0, f"{side}², {axis}: no force was felt")
        first = work.setdefault(axis, counters)
        grown = any(counters[name] > 1.1 * first[name] for name in ("rays_tested", "rays_changed", "bytes_copied"))
        out.check(not grown, f"{axis}: the work grew with the grid, {first} and {counters}")
    table.notes.append(
        "Counters are means over the steps and must not grow with the grid (by more than a tenth). The ball is sunk to "
        "its centre along an inward spiral whose turns overlap. Target: 99 % of the steps within 0.5 ms."
    )
    rendering.times(out, settings)
    rendering.errors(out, settings)
    directions.strokes(out, settings, progress)
    sculpting.sessions(out, settings)
    busy.sessions(out, settings)
    return out


def stroke(side: int, steps: int, turning: bool) -> tuple[list[float], dict[str, float], float]:
    """Seconds of every step, mean counters of a step, mean force in N."""
    extent, depth = side * PITCH, 30.0
    volume = Volume.block([0, 0, -depth], [extent, extent, 0], PITCH)
    poses = scenes.spiral(steps, STEP, (51.2, 51.2), turning)
    tool = Tool.ball(20, 60)
    above = poses[:2] + np.array([0, 0, 50, 0, 0, 0])
    times, felt = [], 0.0
    with steady():
        for _ in range(20):
            volume.carve(tool, above, dt=DT)
        volume.take_counters()
        for k in range(steps):
            start = time.thread_time()
            cut = volume.carve(tool, poses[k : k + 2], dt=DT)
            force, _ = cut.force, cut.torque
            times.append(time.thread_time() - start)
            felt += float((force**2).sum() ** 0.5)
    counted = volume.take_counters()
    return times, {name: getattr(counted, name) / steps for name in COUNTERS}, felt / steps
