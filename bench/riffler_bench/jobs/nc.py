"""NC code: blocks read and written a second against LinuxCNC's interpreter, and how many blocks it takes for the tip to
stay within a tolerance between them."""

from __future__ import annotations

import statistics
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from riffler import Program, Tool

from .. import nc_judge, nc_programs, report
from ..measure import Progress, Settings, steady, watched
from ..report import Column, Report

TOOL = Tool.ball(6, 30)
AXIS_SHARE = 0.1  # rad of the axis for every mm of the tip, where both are asked for
PRINTED = 2e-5  # mm: what lengths of 5 decimals and angles of 6 leave of a tip 200 mm off the axes
TABLE = {"rot_point": nc_programs.ROT_POINT.tolist(), "offset": nc_programs.OFFSET.tolist()}
AS_ROWS = {"safe_start": False}  # without the blocks that bring the tool to its first row
KINEMATICS = {
    "linuxcnc-xyzac": nc_judge.tilting_table("A", **TABLE),
    "linuxcnc-xyzbc": nc_judge.tilting_table("B", **TABLE),
    "tcp": nc_judge.TIP_A_C,
}


def run(settings: Settings, progress: Progress = None) -> Report:
    count = 2_000 if settings.quick else 100_000
    out = Report("nc", {"blocks": count, "axis_share": AXIS_SHARE})
    share = progress and (lambda begin, end: lambda done: progress(begin + done * (end - begin)))
    with tempfile.TemporaryDirectory() as folder, steady():
        read(out, count, settings, Path(folder), share and share(0, 0.3))
        write(out, count, settings, Path(folder), share and share(0.3, 0.5))
        save(out, count, settings, Path(folder))
        divide(out, settings, Path(folder), share and share(0.5, 1))
    return out


def thousands(value: float) -> str:
    return f"{report.three(value / 1000)} k"


def median(work, settings: Settings) -> tuple[float, Any]:
    """Processor seconds and what the last run gave."""
    seconds = []
    for _ in range(1 if settings.quick else 5):
        start = time.process_time()
        result = work()
        seconds.append(time.process_time() - start)
    return statistics.median(seconds), result


def beside_interpreter(file: Path, work, settings: Settings) -> tuple[dict[str, Any], Any]:
    """Our seconds and rs274's on one file, in turn; medians."""
    mine, theirs, note, result = [], [], "", None
    for _ in range(1 if settings.quick else 5):
        start = time.process_time()
        result = work()
        mine.append(time.process_time() - start)
        if note:
            continue
        if nc_judge.interpreter() is None:
            note = "rs274: left out, no LinuxCNC here (make envs)"
            continue
        try:
            theirs.append(nc_judge.interpreted(file)[0])
        except RuntimeError as error:
            note = f"rs274: {error}"
    figures: dict[str, Any] = {"seconds": statistics.median(mine), "note": note}
    if theirs and not note:
        figures |= {"rs274_s": statistics.median(theirs)}
        figures |= {"ratio": figures["rs274_s"] / figures["seconds"]}
    return figures, result


# ---- the sections


def read(out: Report, count: int, settings: Settings, folder: Path, progress: Progress) -> None:
    table = out.section(
        "reader",
        "NC code to a program, one thread",
        Column("blocks", "kind"),
        Column("number", "blocks"),
        Column("file", "bytes", report.megabytes),
        Column("time", "seconds", report.micro),
        Column("blocks/s", "rate", thousands),
        Column("rs274", "rs274_s", report.micro),
        Column("rs274 ÷ Riffler", "ratio", report.ratio),
        Column("ends off mm", "off_mm", report.mm),
        Column("", "note"),
    )
    for kind, make in watched(list(nc_programs.CODE.items()), progress):
        text, joints = make(count)
        file = folder / "p.ngc"
        file.write_text(text)
        figures, program = beside_interpreter(file, lambda file=file: Program.read(file), settings)
        lines = np.asarray(program.line)
        last = np.flatnonzero(np.append(np.diff(lines) != 0, True))[-count:]  # the last row of every block
        off = float(abs(program.poses[last] - nc_judge.poses(joints, nc_judge.TIP_A_C)).max())
        out.check(len(last) == count and off < 1e-9, f"reader, {kind}: {off} mm off")
        table.row(
            kind=kind, blocks=count, bytes=len(text), rate=count / figures["seconds"], off_mm=off, rows=len(program),
            **figures,
        )  # fmt: skip
    table.notes.append(
        "Program.read from the file to rows, arcs as chords within 0.002 mm, and rs274 -g from its start to canonical "
        "moves in a file, in turn; medians of five. Ends off: tips and axes of the rows against what the blocks were "
        "made from."
    )


def write(out: Report, count: int, settings: Settings, folder: Path, progress: Progress) -> None:
    table = out.section(
        "writer",
        "Programs to NC code, tolerance 0.01 mm, one thread",
        Column("post", "post"),
        Column("rows", "rows"),
        Column("blocks", "blocks"),
        Column("file", "bytes", report.megabytes),
        Column("time", "seconds", report.micro),
        Column("blocks/s", "rate", thousands),
        Column("rs274 reads them in", "rs274_s", report.micro),
        Column("", "note"),
    )
    upright, tilted = nc_programs.sheet(count, False), nc_programs.sheet(count, True)
    cases: list[tuple[str, np.ndarray, dict]] = [
        ("3-axis", upright, {}),
        ("tcp", tilted, {"tool_length": "G43"}),  # LinuxCNC has no G43.4
        ("linuxcnc-xyzac", tilted, TABLE),
        ("linuxcnc-xyzbc", tilted, TABLE),
    ]
    for post, poses, options in watched(cases, progress):
        program = Program.from_cl([poses], tools=[TOOL], feed=1200, spindle=8000)
        file = folder / "w.ngc"

        def work(program=program, file=file, post=post, options=options) -> dict:
            return program.write(file, post=post, options=options | AS_ROWS)

        figures, wrote = beside_interpreter(file, work, settings)
        figures.pop("ratio", None)
        table.row(
            post=post, rows=len(program), blocks=wrote.blocks, bytes=file.stat().st_size,
            rate=wrote.blocks / figures["seconds"], **figures,
        )  # fmt: skip
    table.notes.append("Lines over a sheet of 100 × 100 mm; on five axes the tool swings by ± 17°.")


def save(out: Report, count: int, settings: Settings, folder: Path) -> None:
    table = out.section(
        "file",
        "Programs as .rprog files, one thread",
        Column("program", "program"),
        Column("rows", "rows"),
        Column("bytes a row", "row_bytes", report.three),
        Column("save", "save_s", report.micro),
        Column("rows/s", "save_rate", thousands),
        Column("load", "load_s", report.micro),
        Column("rows/s", "load_rate", thousands),
    )
    for name, tilted in (("upright", False), ("tilted", True)):
        program = Program.from_cl([nc_programs.sheet(count, tilted)], tools=[TOOL], feed=1200, spindle=8000)
        file = folder / "p.rprog"
        saving, _ = median(lambda program=program, file=file: program.save(file), settings)
        loading, back = median(lambda file=file: Program.load(file), settings)
        rows = len(program)
        table.row(
            program=name, rows=rows, row_bytes=file.stat().st_size / rows, save_s=saving, save_rate=rows / saving,
            load_s=loading, load_rate=rows / loading,
        )  # fmt: skip
        same = back.poses.tobytes() == program.poses.tobytes() and back.to_bytes() == program.to_bytes()
        out.check(same, f".rprog, {name}: not the same to the bit")


def divide(out: Report, settings: Settings, folder: Path, progress: Progress) -> None:
    table = out.section(
        "between",
        "Blocks that it takes, and the worst that happens between them",
        Column("post", "post"),
        Column("path", "path"),
        Column("rows", "rows"),
        Column("tolerance mm", "tolerance", report.pitch),
        Column("axis mrad", "axis_tolerance", lambda x: report.pitch(1e3 * x)),
        Column("blocks", "blocks"),
        Column("time", "seconds", report.micro),
        Column("tip off its line mm", "tip_mm", report.mm),
        Column("axis off its circle mrad", "axis_rad", lambda x: report.mm(1e3 * x)),
        Column("at the rows mm", "at_mm", report.mm),
    )
    count = 60 if settings.quick else 200
    tolerances = (0.1, 0.001) if settings.quick else (1.0, 0.1, 0.01, 0.001, 1e-4)
    ways = nc_programs.paths(count)
    cases = [(post, path, tolerance) for post in KINEMATICS for path in ways for tolerance in tolerances]
    for post, path, tolerance in watched(cases, progress):
        row = divided(post, ways[path], tolerance, settings, folder)
        table.row(post=post, path=path, rows=count, tolerance=tolerance, **row)
        what = f"{post}, {path}, {tolerance:g} mm"
        out.check(row["tip_mm"] <= tolerance + PRINTED, f"{what}: the tip is {row['tip_mm']} mm off")
        out.check(row["axis_rad"] <= row["axis_tolerance"] + 1e-7, f"{what}: the axis is {row['axis_rad']} rad off")
        out.check(row["at_mm"] <= PRINTED and row["at_rad"] <= 1e-7, f"{what}: {row['at_mm']} mm off at the rows")
    table.notes.append(
        f"The axis's tolerance is {AXIS_SHARE:g} rad for every mm of the tip's. Errors are those of the file: its "
        f"words by a parser of the benchmark's own, {nc_judge.BETWEEN} places between any two blocks, forward "
        "kinematics by rotation matrices. Times and blocks are those of the whole file with approach and retract."
    )


def divided(post: str, poses: np.ndarray, tolerance: float, settings: Settings, folder: Path) -> dict[str, Any]:
    program = Program.from_cl([poses], tools=[TOOL], feed=800)
    file, axis_tolerance = folder / "d.ngc", AXIS_SHARE * tolerance
    options = AS_ROWS if post == "tcp" else TABLE | AS_ROWS

    def work() -> dict:
        return program.write(file, post=post, tolerance=tolerance, axis_tolerance=axis_tolerance, options=options)

    seconds, wrote = median(work, settings)
    found = nc_judge.between(nc_judge.joints_of(file.read_text()), poses, KINEMATICS[post])
    return {"axis_tolerance": axis_tolerance, "blocks": wrote.blocks, "seconds": seconds, **found}
