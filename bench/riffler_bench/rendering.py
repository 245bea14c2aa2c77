"""The whole haptic step: how long it takes, and how far the force is from that of very small steps."""

from __future__ import annotations

import statistics

import numpy as np

from . import _bench as core
from . import report
from .measure import Settings, quantile, steady
from .report import Column, Report

# s, 99 % of the steps
TARGETS = {"cut": 0.5e-3, "wave": 0.5e-3, "trace": 0.35e-3, "fixture": 0.35e-3, "bore": 0.35e-3, "box": 0.35e-3}
STOCKS = ("cut", "wave", "fixture")  # scenes with dexels
MODEL, MODEL_TARGET = "ktoolcav", 0.35e-3
LONG = ("bore", "box", MODEL)  # scenes whose slow places come late: four times as many steps
# With a wall rows of rays must be finer than what small steps remember.
EXACT = {"wave": {"pitch": 0.1, "parts": 64, "memory": 0.01}, "groove": {"pitch": 0.025, "parts": 16, "memory": 0.02}}
MS = 1e-3


def times(out: Report, settings: Settings) -> None:
    table = out.section(
        "rendered",
        "The whole step, coupling included: processor time",
        Column("scene", "scene"),
        Column("pitch", "pitch"),
        Column("steps", "count"),
        Column("median", "p50_s", report.micro),
        Column("99 %", "p99_s", report.micro),
        Column("99.9 %", "p999_s", report.micro),
        Column("target for 99 %", "target_s", report.micro),
        Column("in contact", "touching", lambda share: f"{100 * share:.0f} %"),
    )
    steps = 100 if settings.quick else 1000
    scenes = [(scene, scene, goal) for scene, goal in TARGETS.items()]
    if settings.models is not None and (file := settings.models / f"{MODEL}.stl").exists():
        scenes.append((MODEL, str(file), MODEL_TARGET))
    else:
        table.notes.append(f"{MODEL}: left out, --models has no {MODEL}.stl.")
    for scene, source, goal in scenes:
        pitches = (0.4, 0.2, 0.1) if scene in STOCKS else (0.1,)
        for pitch in pitches[:1] if settings.quick else pitches:
            with steady():
                run = core.haptic_run(source, pitch, 4 * steps if scene in LONG else steps)
            seconds = list(run["seconds"])
            table.row(
                scene=scene, pitch=pitch if scene in STOCKS else None, count=len(seconds),
                p50_s=statistics.median(seconds), p99_s=quantile(seconds, 0.99), p999_s=quantile(seconds, 0.999),
                target_s=goal, touching=run["touching"],
            )  # fmt: skip
            force = np.linalg.norm(run["force"], axis=1)
            out.check(bool(np.isfinite(force).all() and force.max() > 0), f"{scene}: no force was felt")
    table.notes.append(
        "Cut: a Ø20 ball sunk to its centre, 0.5 mm a step. Wave: a Ø8 ball in and out of a block. Trace: COL's "
        "ball over 199 712 triangles, pressed 1 mm below them. Fixture: the same, past dexels of that pitch. "
        "Bore: the ball round in a bore R20 of 720 triangles, 60 mm long each. Box: along the edges of a box of 12. "
        "ktoolcav: along its pencil paths. In these, too, it is pressed 1 mm deep."
    )


def errors(out: Report, settings: Settings) -> None:
    table = out.section(
        "force_error",
        "Force on the hand against that of very small steps",
        Column("scene", "scene"),
        Column("scheme", "scheme"),
        Column("mean of a step", "mean_s", report.micro),
        Column("error, RMS", "rms", lambda x: f"{100 * x:.2f} %"),
        Column("largest", "largest", lambda x: f"{100 * x:.1f} %"),
        Column("late by", "late_s", lambda x: f"{1e3 * x:.1f} ms"),
        Column("work taken from the hand", "work", lambda x: f"{x:.3f} N·mm"),
        Column("too little", "work_missing", lambda x: f"{x:+.3f} N·mm"),
    )
    pitch, steps = (0.4, 200) if settings.quick else (0.1, 800)
    parts = [(f"1000 Hz, {n} part{'s' if n > 1 else ''}", {"parts": n}) for n in (1, 2, 4, 8, 16)]
    budgets = [(f"16 parts, budget {1e6 * b:.0f} µs", {"parts": 16, "budget": b}) for b in (25e-6, 100e-6, 400e-6)]
    rates = [(f"{1000 // n} Hz, interpolated", {"period": n}) for n in (2, 5, 10)]
    if settings.quick:
        parts, budgets, rates = parts[::4], budgets[-1:], rates[-1:]
    for scene, options in EXACT.items():
        small = {**options, "pitch": pitch} if settings.quick else options
        dense = core.haptic_run(scene, steps=steps, **small)
        name = f"{small['parts']} parts, {small['pitch']:g} mm: what is compared with"
        table.row(scene=scene, scheme=name, mean_s=float(np.mean(dense["seconds"])), **compared(dense, dense))
        for name, scheme in parts + budgets + rates if scene == "wave" else parts + rates:
            run = core.haptic_run(scene, pitch, steps, **scheme)
            table.row(scene=scene, scheme=name, mean_s=float(np.mean(run["seconds"])), **compared(run, dense))
        rms = {row["scheme"]: row["rms"] for row in table.rows if row["scene"] == scene}
        out.check(
            rms["1000 Hz, 1 part"] < rms["100 Hz, interpolated"],
            f"{scene}: 1000 Hz is no better than 100 Hz, interpolated",
        )
    table.notes.append(
        f"Stock of {pitch:g} mm. In shares of the largest force. Late by: the shift of the small steps' force that "
        "comes nearest. Groove: a Ø6 bull nose sideways into a block, 1 to 3 mm deep, leaning to and fro. The area "
        "that the cutter meets is learnt over a third of the pitch (memory_for, "
        "native/include/riffler/haptics/resistance.hpp), by small steps over 0.01 mm (wave) and 0.02 mm (groove). "
        "That third was chosen by wave and by slots of a flat end; groove checks it, and native/tests/haptics compares "
        "with closed forms."
    )


def compared(run: dict, dense: dict) -> dict[str, float]:
    felt, exact, grip = run["force"], dense["force"], run["grip"]
    largest = float(np.linalg.norm(exact, axis=1).max())
    off = np.linalg.norm(felt - exact, axis=1)
    ticks = np.arange(len(felt))

    def shifted(lag: float) -> float:
        moved = np.stack([np.interp(ticks - lag, ticks, exact[:, k]) for k in range(3)], axis=1)
        return float(((felt - moved) ** 2).sum())

    lags = np.arange(-2, 50, 0.1)
    way = np.diff(grip, axis=0)
    # Held from one tick to the next.
    work, true = (-float((f[:-1] * way).sum()) for f in (felt, exact))
    return {
        "rms": float(np.sqrt((off**2).mean())) / largest,
        "largest": float(off.max()) / largest,
        "late_s": MS * float(lags[np.argmin([shifted(lag) for lag in lags])]),
        "work": work,
        "work_missing": true - work,
    }
