"""B5X: five-axis motion, time against measured error for every named cutter and tolerance."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from riffler import Volume

from .. import errors, report, scenes
from ..measure import Progress, Settings, Yardstick, shares, watched
from ..report import Column, Report

TOLERANCES = (0.1, 0.01, 0.001, 0.0001)
# Targets: seconds a move at h = 0.25 and tolerance 0.01; of a single move of 60° to 120°.
TARGETS = {"ball_s": 20e-6, "other_s": 75e-6, "single_s": 0.5e-3}
ERROR_COLUMNS = (
    Column("largest error mm", "max_mm", report.mm),
    Column("RMS error mm", "rms_mm", report.mm),
    Column("largest ÷ tolerance", "share", report.mm),
    Column("ends (grazing)", "ends_text"),
    Column("wrong points", "wrong_text"),
)

THREE_COLUMNS = (
    Column("xyz", "three_s", report.micro),
    Column("xyz ÷ z", "three_ratio", report.ratio),
    Column("xyz: largest ÷ tolerance", "three_share", report.mm),
)


def run(settings: Settings, progress: Progress = None) -> Report:
    out = Report("b5x", {"tolerances": TOLERANCES, "targets": TARGETS})
    share = shares(progress)
    path(out, settings, share(0, 0.6))
    single(out, settings, share(0.6, 1))
    summary(out)
    order(out)
    return out


def compare(out: Report, what: str, volume: Volume, tool, poses: np.ndarray, tolerance: float, rays: int) -> dict:
    error = errors.measured(volume, tool, poses, tolerance, rays)
    out.check(error["max_mm"] <= tolerance and error["wrong"] == 0, f"{what}, tolerance {tolerance:g}: {error}")
    return error | {
        "share": error["max_mm"] / tolerance,
        "ends_text": f"{error['ends']} ({error['grazing']})",
        "wrong_text": f"{error['wrong']} of {error['points']}",
    }


def path(out: Report, settings: Settings, progress: Progress) -> None:
    table = out.section(
        "path",
        "B5X, processor time of one move, and error",
        Column("cutter", "cutter"),
        Column("h mm", "pitch", report.pitch),
        Column("tolerance mm", "tolerance", report.pitch),
        Column("one move", "move_s", report.micro),
        Column("÷ loop", "ratio", report.ratio),
        *THREE_COLUMNS,
        Column("steps a move", "steps", report.three),
        *ERROR_COLUMNS,
    )
    pitches, tolerances, rays = ((0.5,), TOLERANCES[:2], 40) if settings.quick else ((0.25, 0.1), TOLERANCES, 2000)
    cases = [(c, h, t) for h in pitches for c in scenes.cutters() for t in tolerances]
    for cutter, pitch, tolerance in watched(cases, progress):
        poses, yardstick = cutter.path(turning=True), Yardstick(pitch, settings.quick)

        def carve(volume: Volume, tool=cutter.tool, poses=poses, tolerance=tolerance) -> None:
            volume.carve(tool, poses, tolerance=tolerance)

        timing, volume = yardstick.beside(Volume.block(*scenes.BLOCK, pitch).copy, carve)
        three, all_rays = yardstick.beside(Volume.block(*scenes.BLOCK, pitch, "xyz").copy, carve)
        what = f"{cutter.name} on B5X, h = {pitch:g}"
        table.row(
            cutter=cutter.name,
            pitch=pitch,
            tolerance=tolerance,
            move_s=timing.seconds / scenes.MOVES,
            ratio=timing.ratio,
            three_s=three.seconds / scenes.MOVES,
            three_ratio=three.ratio / timing.ratio,
            three_share=compare(out, f"{what}, xyz", all_rays, cutter.tool, poses, tolerance, rays)["share"],
            steps=volume.take_counters().steps / scenes.MOVES,
            **compare(out, what, volume, cutter.tool, poses, tolerance, rays),
        )
    table.notes.append(
        "Loop: the yardstick, the same moves without turning, ball only. Errors over random rays, three quarters of "
        "them cut: along the ray, or in space where the ray grazes the surface. Targets at h = 0.25, tolerance 0.01: "
        "20 µs for the ball, 75 µs for others; xyz at most 4 × z."
    )


def single(out: Report, settings: Settings, progress: Progress) -> None:
    table = out.section(
        "single",
        "Single moves, processor time, and error in three directions",
        Column("cutter", "cutter"),
        Column("motion", "motion"),
        Column("h mm", "pitch", report.pitch),
        Column("tolerance mm", "tolerance", report.pitch),
        Column("time", "move_s", report.micro),
        *THREE_COLUMNS[:2],
        *ERROR_COLUMNS,
    )
    pitch, rays = (1.0, 8) if settings.quick else (0.25, 200)
    # Straight moves do not depend on the tolerance; it only says how finely the comparison looks.
    turning, straight = ((0.01,), (0.01,)) if settings.quick else (TOLERANCES, (1e-4,))
    cases = [
        (c, m, t)
        for c in scenes.cutters()
        for m in scenes.motions()
        for t in (turning if m.angle else straight)
        if not settings.quick or m.angle in (0, 10, 60)
    ]
    yardstick = Yardstick(pitch, quick=True)
    blocks = {directions: Volume.block(*scenes.BLOCK, pitch, directions) for directions in ("z", "xyz")}
    for cutter, motion, tolerance in watched(cases, progress):

        def carve(volume: Volume, tool=cutter.tool, poses=motion.poses, tolerance=tolerance) -> None:
            volume.carve(tool, poses, tolerance=tolerance)

        timing, _ = yardstick.beside(blocks["z"].copy, carve)
        three, volume = yardstick.beside(blocks["xyz"].copy, carve)
        table.row(
            cutter=cutter.name,
            motion=motion.name,
            angle=motion.angle,
            about=motion.about,
            pitch=pitch,
            tolerance=tolerance,
            move_s=timing.seconds,
            three_s=three.seconds,
            three_ratio=three.ratio / timing.ratio,
            **compare(out, f"{cutter.name}, {motion.name}", volume, cutter.tool, motion.poses, tolerance, rays),
        )
    table.notes.append(
        "Time: rays along z, then with three directions, one thread. Target: at most 0.5 ms for a move of 60° to 120°."
    )


def summary(out: Report) -> None:
    """The single moves in a line for each cutter."""
    table = out.section(
        "summary",
        "Single moves, the worst of each cutter",
        Column("cutter", "cutter"),
        Column("slowest of 60° to 120°, tolerance 0.01", "slowest_s", report.micro),
        Column("turning: largest error ÷ tolerance", "share", report.mm),
        Column("straight: largest error mm", "straight_mm", report.mm),
        Column("ends compared", "ends"),
        Column("points compared", "points"),
        Column("wrong points", "wrong"),
    )
    rows = next(s for s in out.sections if s.name == "single").rows
    for cutter in dict.fromkeys(r["cutter"] for r in rows):
        mine = [r for r in rows if r["cutter"] == cutter]
        table.row(
            cutter=cutter,
            slowest_s=max(r["move_s"] for r in mine if r["angle"] >= 60 and r["tolerance"] == 0.01),
            share=max(r["share"] for r in mine if r["angle"]),
            straight_mm=max(r["max_mm"] for r in mine if not r["angle"]),
            **{key: sum(r[key] for r in mine) for key in ("ends", "points", "wrong")},
        )
    table.notes.append("Target: at most 0.5 ms for a move of 60° to 120°.")


def order(out: Report) -> None:
    """How time and error follow the tolerance: exponents of the power laws that fit B5X best."""
    table = out.section(
        "order",
        "B5X, measured orders",
        Column("cutter", "cutter"),
        Column("h mm", "pitch", report.pitch),
        Column("largest error ~ tolerance^p, p", "error_by_tolerance", exponent),
        Column("RMS error ~ tolerance^p, p", "rms_by_tolerance", exponent),
        Column("time ~ tolerance^−p, p", "time_by_tolerance", lambda p: exponent(-p)),
        Column("0.001 costs … times 0.01", "tenfold", report.ratio),
    )
    rows = next(s for s in out.sections if s.name == "path").rows
    for pitch in dict.fromkeys(r["pitch"] for r in rows):
        for cutter in dict.fromkeys(r["cutter"] for r in rows):
            mine = [r for r in rows if r["cutter"] == cutter and r["pitch"] == pitch]
            time = {r["tolerance"]: r["move_s"] for r in mine}
            table.row(
                cutter=cutter,
                pitch=pitch,
                error_by_tolerance=slope(mine, "max_mm"),
                rms_by_tolerance=slope(mine, "rms_mm"),
                time_by_tolerance=slope(mine, "move_s"),
                tenfold=time[0.001] / time[0.01] if {0.001, 0.01} <= time.keys() else None,
            )
    table.notes.append("Least squares over all tolerances. Target for 0.001 against 0.01: at most 1.4 ×.")


def slope(rows: list[dict[str, Any]], key: str) -> float | None:
    """Exponent p of key ~ tolerance^p."""
    points = [(math.log(r["tolerance"]), math.log(r[key])) for r in rows if r[key] > 0]
    return float(np.polyfit(*zip(*points, strict=True), 1)[0]) if len(points) > 1 else None


def exponent(value: float) -> str:
    return f"{value:.2f}"
