"""Continuity of the force: one straight stroke, sampled at different rates and pitches, against its closed form."""

from __future__ import annotations

import math

import numpy as np
from riffler import Tool, Volume

from .. import report
from ..measure import Progress, Settings, watched
from ..report import Column, Report

RATES = (100, 500, 1000, 4000)  # Hz
SPEED, WAY, DEPTH, RADIUS = 40.0, 30.0, 2.0, 3.0  # mm/s, mm
CONSTANT = 0.05  # N·s/mm³, the default of carve


def run(settings: Settings, progress: Progress = None) -> Report:
    out = Report("force", {"rates": RATES, "speed": SPEED, "depth": DEPTH})
    table = out.section(
        "stroke",
        "Force of a straight stroke of 40 mm/s, 2 mm deep, Ø6, oblique to the grid",
        Column("cutter", "cutter"),
        Column("h mm", "pitch", report.pitch),
        Column("rate Hz", "rate"),
        Column("step ÷ h", "step_share", report.mm),
        Column("mean N", "mean_N", lambda f: f"{f:.4f}"),
        Column("closed form N", "exact_N", lambda f: f"{f:.4f}"),
        Column("difference", "off", report.percent),
        Column("ripple, RMS", "ripple", lambda r: f"{100 * r:.2f} %"),
        Column("largest jump between steps", "jump", lambda r: f"{100 * r:.1f} %"),
    )
    rates, pitches = ((100, 1000), (0.4, 0.2)) if settings.quick else (RATES, (0.2, 0.1, 0.05))
    cutters = {"ball Ø6": Tool.ball(6, 30), "flat Ø6": Tool.flat(6, 30)}
    cases = [(name, h, rate) for name in cutters for h in pitches for rate in rates]
    for name, pitch, rate in watched(cases, progress):
        times, force = stroke(cutters[name], pitch, rate)
        # The tool is in full engagement one radius after the entry; the rest of the stroke is steady.
        steady = force[times > 2 * RADIUS / SPEED]
        exact = CONSTANT * SPEED * section(name)
        mean = float(steady.mean())
        table.row(
            cutter=name, pitch=pitch, rate=rate, step_share=SPEED / rate / pitch, mean_N=mean, exact_N=exact,
            off=mean / exact - 1, ripple=float(steady.std() / mean), jump=float(np.abs(np.diff(steady)).max() / mean),
            times_s=times.tolist(), force_N=force.tolist(),
        )  # fmt: skip
        out.check(abs(mean / exact - 1) < 0.05, f"{name}, h = {pitch:g}, {rate} Hz: {mean} N, not {exact}")
    table.notes.append(
        "Closed form: k · section · speed. Ripple and jump are shares of the mean over the steady part, unfiltered, as "
        "the tool's force comes out of single calls."
    )
    return out


def section(name: str) -> float:
    """Area of the groove across the stroke, mm²."""
    if name.startswith("flat"):
        return 2 * RADIUS * DEPTH
    r, d = RADIUS, DEPTH
    return r * r * math.acos((r - d) / r) - (r - d) * math.sqrt(2 * r * d - d * d)


def stroke(tool: Tool, pitch: float, rate: int) -> tuple[np.ndarray, np.ndarray]:
    """Times (n,) and forces (n,) against the motion, one call a step; the entry is part of it."""
    direction = np.array([math.cos(0.4), math.sin(0.4), 0.0])
    dt = 1 / rate
    count = round(WAY / SPEED * rate)
    tips = np.array([6.0, 6.0, 10 - DEPTH]) + direction * (SPEED * dt * np.arange(count + 1))[:, None]
    poses = np.concatenate([tips, np.tile([0.0, 0, 1], (count + 1, 1))], 1)
    volume = Volume.block([0, 0, 0], [40, 24, 10], pitch)
    volume.carve(tool, np.array([[6.0, 6, 20, 0, 0, 1], poses[0]]))  # the plunge to the stroke's beginning is not felt
    force = [-(volume.carve(tool, poses[k : k + 2], dt=dt).force[0] @ direction) for k in range(count)]
    return dt * np.arange(1, count + 1), np.array(force)
