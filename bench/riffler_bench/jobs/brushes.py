"""Brushes, hand tools and editable strokes: the time of a dab, a hand tool's time against its error, and the cost of an
edit among many strokes."""

from __future__ import annotations

import math
import statistics
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from riffler import History, Mesher, Tool, Volume

from .. import _bench as core
from .. import report
from ..measure import Progress, Settings, shares, steady, watched
from ..report import Column, Report

TOLERANCES = (0.1, 0.01, 0.001, 0.0001)  # mm
TARGET = 8.0  # times the ball's run
KINDS = ("clay", "inflate", "flatten", "grab", "snake_hook", "pinch", "crease", "twist")
RADII = (10, 20, 40)  # pitches
ENDS = 60  # judged for each tolerance
STEPS = 5  # of the reference in a tolerance: it is right within half a step
TOOLS = {
    "gouge 10 R6.5": Tool.gouge(10, 6.5, math.radians(25), 25),
    "V-tool 60°": Tool.v_tool(math.radians(60), 6, math.radians(25), 25),
    "chisel 12": Tool.chisel(12, 3, math.radians(25), 25),
    "knife 12": Tool.knife(12, 2, math.radians(20), 30),
}


def run(settings: Settings, progress: Progress = None) -> Report:
    out, share = Report("brushes", {"target": TARGET}), shares(progress)
    dabs(out, settings, share(0, 0.3))
    hand_tools(out, settings, share(0.3, 0.7))
    history(out, settings, share(0.7, 1))
    return out


def timed(call: Callable[..., Any], *args: Any, **options: Any) -> float:
    begin = time.thread_time()
    call(*args, **options)
    return time.thread_time() - begin


# ------------------------------------------------------------------ dabs
def dabs(out: Report, settings: Settings, progress: Progress) -> None:
    table = out.section(
        "dabs",
        "Processor time of a dab on a wavy block of 120 × 120 × 30 mm, h = 0.5, three directions, one thread",
        Column("brush", "kind"),
        Column("radius h", "radius"),
        Column("a dab", "dab_s", report.micro),
        Column("its mesh", "mesh_s", report.micro),
        Column("bricks", "bricks"),
        Column("closed", "closed"),
    )
    pitch, count = 0.5, 2 if settings.quick else 6
    block = waves(pitch)
    for kind in watched(KINDS[:3] if settings.quick else KINDS, progress):
        for radius in RADII[:1] if settings.quick else RADII:
            volume, mesher = block.copy(), Mesher(block)
            times, meshing, bricks = [], [], 0
            with steady():
                for k in range(count):
                    rows = [(30 + 9 * k, 60, 20, 0, 0, 1)]
                    if kind in ("grab", "snake_hook"):
                        rows.append((31 + 9 * k, 60, 21, 0, 0, 1))
                    amount = 0.3 if kind == "twist" else pitch
                    times.append(timed(volume.brush, kind, rows, radius * pitch, amount=amount))
                    begin = time.thread_time()
                    bricks += len(mesher.update(volume))
                    meshing.append(time.thread_time() - begin)
            audit = volume.to_mesh().audit()
            closed = not (audit.open_edges or audit.nonmanifold_edges)
            out.check(closed, f"{kind}, radius {radius} pitches: {audit}")
            table.row(
                kind=kind,
                radius=radius,
                dab_s=statistics.median(times),
                mesh_s=statistics.median(meshing),
                bricks=round(bricks / count),
                closed="yes" if closed else "no",
            )
    table.notes.append(f"Medians of {count} dabs. The mesh is that of `Mesher.update` after each dab.")


def waves(pitch: float) -> Volume:
    """A block whose top has grooves 12 mm apart."""
    volume = Volume.block((0, 0, 0), (120, 120, 30), pitch, "xyz")
    volume.carve(Tool.flat(400, 40), [(60, 60, 20, 0, 0, 1), (61, 60, 20, 0, 0, 1)])
    for y in range(6, 120, 12):
        volume.carve(Tool.ball(10, 30), [(-6, y, 18.5, 0, 0, 1), (126, y, 18.5, 0, 0, 1)])
    return volume


# ------------------------------------------------------------------ hand tools
def path(moves: int, lean: float) -> np.ndarray:
    """(n, 9): an arc that rolls the blade by 0.02 rad a move of 0.8 mm and rises and falls; the handle leans back."""
    turn = 0.02 * np.arange(moves + 1)
    along = np.c_[np.cos(turn), np.sin(turn), 0.05 * np.cos(9 * turn)]
    along /= np.linalg.norm(along, axis=1)[:, None]
    tips = np.array([30.0, 20, 18.8]) + np.vstack([np.zeros(3), np.cumsum(0.8 * along[:-1], axis=0)])
    up = np.cross(along, np.cross([0.0, 0, 1], along))
    up /= np.linalg.norm(up, axis=1)[:, None]
    c, s = math.cos(lean), math.sin(lean)
    return np.hstack([tips, c * up - s * along, s * up + c * along])


def hand_tools(out: Report, settings: Settings, progress: Progress) -> None:
    table = out.section(
        "hand_tools",
        "Hand tools along an arc of 0.8 mm and 0.02 rad a move, h = 0.25, three directions, one thread",
        Column("tool", "tool"),
        Column("tolerance mm", "tolerance", report.pitch),
        Column("a move", "move_s", report.micro),
        Column("÷ a ball of the same width", "ratio", report.ratio),
        Column("largest error mm", "error_mm", report.mm),
        Column("ends judged", "ends"),
    )
    moves = 10 if settings.quick else 60
    for name in watched(list(TOOLS)[:1] if settings.quick else list(TOOLS), progress):
        tool = TOOLS[name]
        lean = 0.35 if name.startswith("knife") else 1.05
        poses = path(moves, lean)
        width = float(np.ptp(np.vstack(tool.hulls)[:, 1]))
        ball = Tool.ball(max(width, 2.0), 25)
        for tolerance in TOLERANCES[:2] if settings.quick else TOLERANCES:
            with steady():
                blade, round_one = (
                    statistics.median(timed(stock().carve, t, p, tolerance=tolerance) for _ in range(3))
                    for t, p in ((tool, poses), (ball, poses[:, :6]))
                )
            worst, count = judged(tool, path(2, lean), tolerance)
            out.check(worst <= (1 + 1 / STEPS) * tolerance, f"{name}: {worst:g} mm off, tolerance {tolerance:g}")
            table.row(
                tool=name,
                tolerance=tolerance,
                move_s=blade / moves,
                ratio=blade / round_one,
                error_mm=worst,
                ends=count,
            )
    table.notes.append(
        "Errors are distances of interval ends, after two such moves, from the blade at poses that lie densely in time "
        "(native/reference/hull_path.hpp, a fifth of the tolerance apart), which shares no code with the carving."
    )


def stock() -> Volume:
    return Volume.block((0, 0, 0), (80, 80, 20), 0.25, "xyz")


def judged(tool: Tool, poses: np.ndarray, tolerance: float) -> tuple[float, int]:
    """Largest distance (mm) of interval ends that the blade has made from it, and how many were judged."""
    before, after = stock(), stock()
    after.carve(tool, poses, tolerance=tolerance)
    found = []
    for k, direction in enumerate("xyz"):
        counts, spans = after.intervals(direction)
        ray = np.repeat(np.arange(counts.size), counts.ravel())
        u, v = np.unravel_index(ray, counts.shape)
        size = before.upper[k]
        for end in (0, 1):
            made = (spans[:, end] > 1e-9) & (spans[:, end] < size - 1e-9)
            points = np.empty((int(made.sum()), 3))
            points[:, k] = spans[made, end]
            points[:, (k + 1) % 3], points[:, (k + 2) % 3] = 0.25 * (u[made] + 0.5), 0.25 * (v[made] + 0.5)
            found.append(points)
    points = np.vstack(found)
    chosen = np.random.default_rng(5).permutation(len(points))[:ENDS]
    distance = core.hull_distances(tool, poses, tolerance / STEPS, points[chosen])
    return float(np.abs(distance).max()), len(chosen)


# ------------------------------------------------------------------ history
def history(out: Report, settings: Settings, progress: Progress) -> None:
    pitch = 1.0 if settings.quick else 0.25
    table = out.section(
        "history",
        f"An edit of one of many strokes of 35 mm, Ø6 on a block of 120 × 120 × 30 mm, h = {pitch:g}, one thread",
        Column("strokes", "strokes"),
        Column("replay of all", "replay_s", report.micro),
        Column("edit of the first", "first_s", report.micro),
        Column("of any", "any_s", report.micro),
        Column("of the last", "last_s", report.micro),
        Column("strokes run for any", "run"),
        Column("÷ replay", "share", report.ratio),
    )
    base, ball = Volume.block((0, 0, 0), (120, 120, 30), pitch, "xyz"), Tool.ball(6, 40)
    for count in watched((10, 100) if settings.quick else (10, 100, 1000), progress):
        rng = np.random.default_rng(count)
        strokes = [bent(rng) for _ in range(count)]
        with steady():
            made, replayed = History(base), base.copy()
            ids = [made.add(ball, poses) for poses in strokes]
            replay = sum(timed(replayed.carve, ball, poses) for poses in strokes)
            out.check(made.volume.to_bytes() == replayed.to_bytes(), f"{count} strokes: the bytes differ from a replay")
            times, run = {}, 0
            for k in dict.fromkeys([0, count - 1, *rng.integers(0, count, 10).tolist()]):
                other = strokes[k] + np.r_[0.7, -0.7, 0.1, 0, 0, 0] * np.exp(-((np.arange(24) - 12) ** 2) / 20)[:, None]
                times[k] = timed(made.replace, ids[k], poses=other)
                run += made.stats().strokes_run
                made.replace(ids[k], poses=strokes[k])
            out.check(made.volume.to_bytes() == replayed.to_bytes(), f"{count} strokes: edits leave other bytes")
        table.row(
            strokes=count,
            replay_s=replay,
            first_s=times[0],
            last_s=times[count - 1],
            any_s=statistics.mean(times.values()),
            run=round(run / len(times), 1),
            share=statistics.mean(times.values()) / replay,
        )
    table.notes.append(
        "Each edit bends the middle of the stroke by 1 mm. The bytes equal those of a replay afterwards."
    )


def bent(rng: np.random.Generator) -> np.ndarray:
    """(24, 6): a random bent groove, 1 to 2 mm deep."""
    heading = rng.uniform(0, 6.28) + np.cumsum(rng.uniform(-0.2, 0.2, 24))
    steps = 1.5 * np.c_[np.cos(heading), np.sin(heading), 0 * heading]
    tips = np.r_[rng.uniform(0, 120, 2), 30 - rng.uniform(1, 2)] + np.cumsum(steps, axis=0)
    return np.hstack([tips, np.tile([0.0, 0, 1], (24, 1))])
