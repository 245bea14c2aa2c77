"""Verification: run time and memory against pitch, with the error of what is left; long programs on one and two
threads; after an edit; and in a stream."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from riffler import Program, Tool, Volume, verify

from .. import report, scenes, waves
from ..measure import Progress, Settings, Yardstick, child, cores, steady, threads, watched
from ..report import Column, Report
from ..rivals import b200, clock

LINES = 64  # of the programs that are judged: 1.6 mm apart, with cusps of 0.1 mm between them
DIP = 0.2  # mm that single rows go into the part
AXES = {False: "three axes", True: "five axes"}


def run(settings: Settings, progress: Progress = None) -> Report:
    out = Report("verify", {"lines": LINES, "radius": waves.RADIUS, "dip_mm": DIP})
    share = progress and (lambda begin, end: lambda done: progress(begin + done * (end - begin)))
    against_pitch(out, settings, share and share(0, 0.4))
    against_directions(out, settings)
    gouges(out, settings)
    speed(out, settings, share and share(0.4, 0.7))
    holder(out, settings)
    elsewhere(out, settings)
    edit(out, settings)
    memory(out, settings, share and share(0.85, 1))
    return out


def millionths(share: float) -> str:
    return report.three(1e6 * share)


def pitches(settings: Settings) -> tuple[float, ...]:
    return (0.8, 0.4) if settings.quick else (0.8, 0.4, 0.2, 0.1, 0.05)


def against_pitch(out: Report, settings: Settings, progress: Progress) -> None:
    rows, side = (3_000, 60) if settings.quick else (100_000, 500)
    table = out.section(
        "pitch",
        f"Waves of {report.grouped(rows)} rows against pitch, one thread",
        Column("program", "program"),
        Column("h mm", "pitch", report.pitch),
        Column("rays", "rays", report.mega),
        Column("time", "cpu_s", report.micro),
        Column("rows/s", "rate", report.grouped),
        Column("peak memory", "verify_bytes", report.megabytes),
        Column("at the rays: largest error mm", "at_rays_mm", report.mm),
        Column("between them: largest mm", "max_mm", report.mm),
        Column("RMS mm", "rms_mm", report.mm),
        Column("removed more than exact, ppm", "removed_over", millionths),
        Column("sure to", "uncertain", millionths),
    )
    cases = [(tilted, pitch) for tilted in AXES for pitch in pitches(settings)]
    exact: dict[bool, waves.Exact] = {}
    with tempfile.TemporaryDirectory() as folder:
        for tilted, pitch in watched(cases, progress):
            poses = waves.poses(rows, LINES, tilted)
            if tilted not in exact:
                exact[tilted] = waves.Exact.of(poses, side)
            true, file = exact[tilted], Path(folder) / "tops.npy"
            figures = child("verified", rows=rows, lines=LINES, tilted=tilted, pitch=pitch, tops=str(file),
                            repeats=1 if settings.quick else 3)  # fmt: skip
            tops = np.load(file)
            off = true.between(tops, pitch)
            row = table.row(
                program=AXES[tilted], pitch=pitch, rows=rows, rays=tops.size, rate=rows / figures["cpu_s"], **figures,
                at_rays_mm=at_rays(poses, tops, pitch, 500 if settings.quick else 20_000),
                max_mm=float(abs(off).max()), rms_mm=float(np.sqrt(np.mean(off**2))),
                removed_over=(figures["removed"] - true.removed) / true.removed,
                uncertain=true.uncertain / true.removed,
            )  # fmt: skip
            what = f"{AXES[tilted]}, h = {pitch:g}"
            out.check(row["passed"], f"{what}: something was found")
            out.check(row["at_rays_mm"] < (0.01 if tilted else 1e-8), f"{what}: {row['at_rays_mm']} mm off at the rays")
    table.notes.append(
        "A ball of 6 mm with shank and holder over waves, lines 1.6 mm apart, stock of 100 × 100 × 20 mm; tolerance "
        "0.01 mm, tilted by up to 30° on five axes. Reference: the lowest that swept balls reach, in closed form from "
        f"numpy, at {report.grouped(4 * side * side)} points and at random rays; errors are heights. Between the rays "
        "the surface is bilinear over their ends, and cusps are what it cuts off."
    )


def against_directions(out: Report, settings: Settings) -> None:
    rows = 3_000 if settings.quick else 200_000
    table = out.section(
        "directions",
        f"Waves of {report.grouped(rows)} rows with rays in one direction and in three, one thread",
        Column("program", "program"),
        Column("lines", "lines"),
        Column("h mm", "pitch", report.pitch),
        Column("z", "z_s", report.micro),
        Column("xyz", "xyz_s", report.micro),
        Column("xyz ÷ z", "ratio", report.ratio),
    )
    # Lines 1.6 mm apart, and, as a finishing cut has them, less than a ray.
    cases = [(tilted, lines, pitch) for tilted in AXES for lines in (LINES, 640) for pitch in (0.4, 0.2)]
    for tilted, lines, pitch in cases[:1] if settings.quick else cases:
        figures = child("verified_both", rows=rows, lines=lines, tilted=tilted, pitch=pitch,
                        turns=1 if settings.quick else 3)  # fmt: skip
        table.row(program=AXES[tilted], lines=lines, pitch=pitch, **figures)
        out.check(figures["same"] and figures["passed"], f"{AXES[tilted]}, h = {pitch:g}: z and xyz differ")
    table.notes.append("z and xyz take turns in one process; medians. Target: xyz at most 4 × z.")


def at_rays(poses: np.ndarray, tops: np.ndarray, pitch: float, count: int) -> float:
    """Largest error in mm of the ends of random rays."""
    some = np.random.default_rng(7).integers(0, len(tops), (count, 2))
    return float(abs(tops[tuple(some.T)] - waves.left(poses, (some + 0.5) * pitch)).max())


def gouges(out: Report, settings: Settings) -> None:
    table = out.section(
        "gouges",
        f"Gouges of {DIP:g} mm, as found",
        Column("h mm", "pitch", report.pitch),
        Column("directions", "directions"),
        Column("gouges", "gouges"),
        Column("found", "found"),
        Column("depth: largest error mm", "error_mm", report.mm),
        Column("h² ÷ 4 R", "sag_mm", report.mm),
        Column("time", "cpu_s", report.micro),
    )
    program, dips = dipping()
    part = scenes.box_mesh([0, 0, -10], [30, 30, -5])
    for directions in ("z", "xyz"):
        for pitch in pitches(settings):
            stock = Volume.block([0, 0, -10], [30, 30, 0], pitch, directions)
            with steady():
                found, times = clock.timed(lambda stock=stock: verify(program, stock, part), 3)
            hits = [f for f in found.findings if f.kind == "gouge"]
            rows = [f.row for f in hits]
            table.row(
                pitch=pitch, directions=directions, gouges=len(dips), found=len(hits),
                error_mm=max((abs(f.value - DIP) for f in hits), default=None), sag_mm=pitch**2 / (4 * waves.RADIUS),
                **times,
            )  # fmt: skip
            out.check(rows == dips, f"gouges, h = {pitch:g}: found at rows {rows} instead of {dips}")
    table.notes.append(
        "A ball of 6 mm on an oblique line over a flat part; every 20th row is too low. The deepest point lies up to "
        "h ÷ √2 from a ray, where the ball is h² ÷ 4 R higher; depths are reported to 1 %."
    )


def dipping() -> tuple[Program, list[int]]:
    """Rows 0.4 mm apart on the top of a flat part; and those that are DIP too low."""
    rows, dips = 60, [9, 29, 49]
    tips = np.linspace([2.03, 3.0, -5], [25.7, 26.9, -5], rows)
    tips[dips, 2] -= DIP
    tool = Tool.ball(2 * waves.RADIUS, 25)
    return Program(scenes.upright(tips), 1000.0, spindle=8000.0, tools={1: tool}), dips


def speed(out: Report, settings: Settings, progress: Progress) -> None:
    straight, turning, pitch = (20_000, 4_000, 0.5) if settings.quick else (1_000_000, 100_000, 0.1)
    cells = 50 if settings.quick else 500
    table = out.section(
        "speed",
        f"Long programs, h = {pitch:g} mm, stock of 100 × 100 mm",
        Column("program", "program"),
        Column("blocks", "rows", report.grouped),
        Column("threads", "threads"),
        Column("wall time", "wall_s", report.micro),
        Column("processor time", "cpu_s", report.micro),
        Column("cores free for two threads", "cores", report.three),
        Column("blocks/s of processor time", "rate", report.grouped),
        Column("peak memory", "verify_bytes", report.megabytes),
        Column("map on the mesh of what is left", "map_s", report.micro),
    )
    cases = [(tilted, part, count) for tilted in AXES for part in (0, cells) for count in (1, 2)]
    for tilted, part, count in watched(cases, progress):
        rows = turning if tilted else straight
        lines, free = round(rows**0.5), cores() if count > 1 else None
        figures = child("verified", count, rows=rows, lines=lines, tilted=tilted, pitch=pitch, cells=part)
        if part:
            name = f"{AXES[tilted]}, part of {report.mega(figures['triangles'])} triangles, gouges and rest"
        else:
            name = f"{AXES[tilted]}, shank and holder"
        table.row(program=name, rows=rows, lines=lines, threads=count, cores=free,
                  rate=rows / figures["cpu_s"], **figures)  # fmt: skip
        out.check(figures["passed"], f"speed, {name}: something was found")
    for figures in (carving(straight, pitch), stamping(straight, pitch, 500 if settings.quick else 3_000)):
        table.row(threads=1, rate=figures["rows"] / figures["cpu_s"], **figures)
    loop = Yardstick(pitch, settings.quick).alone()
    table.notes.append(
        "Lines are as far apart as moves are long: 0.1 mm on three axes, 0.3 mm on five. Memory is a whole process's, "
        "with Python, numpy and the program. Cores: processor time a second that two threads of hashing had just "
        "before. The last two rows calibrate: cutting alone, and the same capsules on a plain height map in numpy, "
        "which asks nothing about shank, holder or part. B200's yardstick took "
        f"{report.micro(loop / scenes.MOVES)} a move of 0.4 mm at h = {pitch:g} just then."
    )


def carving(rows: int, pitch: float) -> dict[str, Any]:
    poses, volume = waves.poses(rows, round(rows**0.5), False), waves.stock(pitch)
    with steady():
        _, times = clock.timed(lambda: volume.carve(waves.tool(), poses), 1)
    return {"program": "three axes, Volume.carve alone", "rows": rows, **times}


def stamping(rows: int, pitch: float, first: int) -> dict[str, Any]:
    """A part of the program from its middle on: the first lines are half outside."""
    at = rows // 2
    poses = waves.poses(rows, round(rows**0.5), False, at, at + first + 1)
    side = (np.arange(round(waves.SIZE / pitch)) + 0.5) * pitch
    centres, top = poses[:, :3] + [0, 0, waves.RADIUS], np.zeros((len(side), len(side)))
    with steady():
        _, times = clock.timed(lambda: b200.stamp(top, side, side, centres, waves.RADIUS), 1)
    return {"program": f"three axes, numpy height map, {report.grouped(first)} of the blocks", "rows": first, **times}


def holder(out: Report, settings: Settings) -> None:
    rows, pitch = (2_000, 0.5) if settings.quick else (50_000, 0.1)
    table = out.section(
        "holder",
        f"Holders next to walls, h = {pitch:g} mm, one thread",
        Column("holder", "holder"),
        Column("blocks", "rows", report.grouped),
        Column("hits found in", "hits", report.grouped),
        Column("time", "cpu_s", report.micro),
        Column("blocks/s", "rate", report.grouped),
        Column("tried with shank and holder", "probes", report.grouped),
        Column("ruled out by boxes", "skipped", report.grouped),
    )
    holders = {
        "above the walls": (31, 20, False),
        "0.1 mm from them": (15, 11.9, False),
        "in them": (15, 20, True),
    }
    poses, stock = waves.pit(rows, pitch)
    for name, (height, radius, hits) in holders.items():
        tool = Tool.ball(2 * waves.RADIUS, 10).with_shank([(10, 3, height, 3)])
        tool = tool.with_holder([(height, radius, 60, radius)])
        some = poses[: rows // 5] if hits else poses
        program = Program(some, 3000.0, spindle=12000.0, tools={1: tool})
        with steady():
            found, times = clock.timed(lambda program=program: verify(program, stock), 1)
        at = sum(f.last_row - f.row + 1 for f in found.findings if f.kind == "holder")
        table.row(holder=name, rows=len(some), hits=at, **times, rate=len(some) / times["cpu_s"], **found.stats)
        out.check(found.passed != hits, f"holder {name}: {at} hits")
    table.notes.append("A pit of 60 × 60 mm with walls of 23 mm, a ball of 6 mm on its floor 12 mm from the walls.")


def elsewhere(out: Report, settings: Settings) -> None:
    table = out.section(
        "elsewhere",
        "Beside figures that others reached elsewhere",
        Column("scene", "scene"),
        Column("moves", "rows", report.grouped),
        Column("threads", "threads"),
        Column("verified and meshed here, wall time", "wall_s", report.micro),
        Column("processor time", "cpu_s", report.micro),
        Column("triangles", "triangles", report.mega),
        Column("another", "another"),
        Column("its time", "their_s"),
    )
    moves = 5_000 if settings.quick else 500_000
    ball, flat = scenes.cutters()[0], Tool.flat(6, 30)
    b200_path, level, ramping = ball.path(turning=False), scenes.s500k(moves, False), scenes.s500k(moves, True)
    camotics, other = "CAMotics, with mesh", "the fastest open tri-dexel simulator, in Rust"
    cases: list[tuple] = [
        ("B200, h = 0.25", 2, ball.tool, b200_path, scenes.BLOCK, 0.25, camotics, "5-10 s"),
        ("B200, h = 0.15", 2, ball.tool, b200_path, scenes.BLOCK, 0.15, camotics, "23-27 s"),
        ("S500k, level, h = 0.5", 1, flat, level, scenes.S500K_BLOCK, 0.5, other, "111 s, 500 000 moves"),
        ("S500k, ramping, h = 0.5", 1, flat, ramping, scenes.S500K_BLOCK, 0.5, other, "303 s, 500 000 moves"),
    ]
    for name, count, tool, poses, box, pitch, another, their_s in cases[:: 2 if settings.quick else 1]:
        program, stock = Program(poses, 1000.0, spindle=8000.0, tools={1: tool}), Volume.block(*box, pitch, "xyz")
        with threads(count):
            left, times = clock.timed(lambda a=program, b=stock: verify(a, b).volume.to_mesh(), 1)
        table.row(scene=name, threads=count, rows=len(poses) - 1, triangles=len(left.triangles), another=another,
                  their_s=their_s, **times)  # fmt: skip
    table.notes.append(
        "The others were not run here: their times are from two-core machines of the same kind, at other moments, and "
        "tell an order of magnitude. Here: tri-dexel stock, the whole report, then the mesh of what is left."
    )


def edit(out: Report, settings: Settings) -> None:
    rows, pitch = (20_000, 0.5) if settings.quick else (1_000_000, 0.1)
    table = out.section(
        "edit",
        f"{report.grouped(rows)} blocks again after an edit of one of them, h = {pitch:g} mm, one thread",
        Column("edited", "edit"),
        Column("time", "cpu_s", report.micro),
        Column("share of the whole", "share", lambda x: f"{100 * x:.1f} %"),
        Column("runs of slabs", "slabs"),
        Column("slabs kept", "slabs_kept"),
        Column("snapshots used", "snapshots_used"),
        Column("moves cut", "moves", report.grouped),
        Column("the same bytes as a fresh run", "same", lambda good: "yes" if good else "NO"),
        Column("peak memory", "peak_bytes", report.megabytes),
    )
    figures = child("edited", rows=rows, lines=round(rows**0.5), pitch=pitch)
    whole = figures["whole_s"]
    table.row(edit="nothing yet", cpu_s=whole, share=1.0, slabs=figures["slabs"], slabs_kept=0, snapshots_used=0,
              moves=figures["moves"], peak_bytes=figures["whole_bytes"])  # fmt: skip
    for row in figures["edits"]:
        table.row(**row, share=row["cpu_s"] / whole)
        out.check(row["same"], f"edit of {row['edit']}: not what a fresh run gives")
    table.notes.append(
        "A slab is run in as many pieces as its program is fed in, and the whole run leaves up to twelve snapshots of "
        "it, whose memory is in the peak."
    )


def memory(out: Report, settings: Settings, progress: Progress) -> None:
    counts, pitch = ((2_000, 20_000), 1.0) if settings.quick else ((100_000, 1_000_000, 10_000_000), 0.5)
    table = out.section(
        "memory",
        f"Programs as a stream, 10 000 rows at a time, h = {pitch:g} mm, one thread",
        Column("blocks", "rows", report.grouped),
        Column("given", "given"),
        Column("time, making the rows included", "cpu_s", report.micro),
        Column("before", "before_bytes", report.megabytes),
        Column("peak memory", "verify_bytes", report.megabytes),
        Column("more, bytes a block", "per_row", report.three),
    )
    cases = [(rows, chunk) for chunk in (10_000, 0) for rows in counts if chunk or rows <= 1_000_000]
    for rows, chunk in watched(cases, progress):
        figures = child("verified_stream", rows=rows, lines=round(rows**0.5), pitch=pitch, chunk=chunk)
        given = "as a stream" if chunk else "in one piece"
        more = figures["verify_bytes"] - figures["before_bytes"]
        table.row(rows=rows, given=given, per_row=more / rows, **figures)
        what = f"{report.grouped(rows)} blocks {given}"
        out.check(figures["passed"], f"{what}: something was found")
        out.check(figures["off"] < 1e-9, f"{what}: removed is {figures['off']} off what the volume lost")
    table.notes.append(
        "A stream keeps its removed volumes and seconds, 16 bytes a block, and 8 more while one of the two "
        "arrays is moved to grow; the volume that is cut comes on top of that."
    )
