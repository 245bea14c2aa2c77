"""Compute a job: part, stock, machine, tools and operations of one TOML file, into NC code and a set-up sheet.

riffler job part.toml
riffler job part.toml --dry-run

Operations are planned in order, each on the stock that the one before leaves. The program is simulated, written, read
again and verified; with a collision, a rapid in material or a gouge nothing is written. Keys of the file: docs/jobs.md.
"""

from __future__ import annotations

import argparse
import importlib.util
from typing import Any

from .. import job as jobs
from ..job.running import setup_of
from .arguments import input_file
from .console import Console, number, times
from .parser import Parser

HELP = "a part from its stock, by the operations of a job file"
FORMATS = (".toml",)


def add_arguments(parser: Parser) -> None:
    parser.add_input("job", "the job file", FORMATS)
    parser.add_argument("--dry-run", action="store_true", help="only check the file and what it names")
    parser.add_argument("--no-sheet", action="store_true", help="no set-up sheet")


def run(arguments: argparse.Namespace, console: Console) -> int:
    path = input_file(arguments.job, FORMATS)
    with console.step("read"):
        job = jobs.read(path)
        setup = setup_of(job)
    if arguments.dry_run:
        data = summary(job)
        console.result(data, f"{path.name} is in order", [*_head(job), *_planned(job)])
        for note in job.notes:
            console.warning(f"{path.name}: {note}")
        return 0
    del setup
    result = jobs.run(job, step=console.step)
    console.written = job.program.name
    if not arguments.no_sheet:
        if importlib.util.find_spec("matplotlib") is None:
            result.warnings.append("the sheet has no pictures: they need matplotlib (pip install matplotlib)")
        with console.step("sheet"):
            jobs.write_sheet(job, result)
    for warning in result.warnings:
        console.warning(warning)
    sheet = None if arguments.no_sheet else job.sheet
    data = summary(job) | _results(result) | {"sheet": sheet and str(sheet), "seconds": console.seconds}
    table = [*_head(job), *_rows(result), ("sheet", sheet.name if sheet else "none"), ("times", times(console.seconds))]
    console.result(data, f"{job.program.name} written", table)
    return 0


def summary(job: jobs.Job) -> dict[str, Any]:
    """The job for JSON."""
    return {
        "job": job.name,
        "part": str(job.part_file),
        "stock": {"lower": job.stock.lower.tolist(), "upper": job.stock.upper.tolist(), "pitch": job.stock.pitch},
        "machine": job.machine,
        "zero": job.zero.tolist(),
        "tools": {str(n): tool.tool.to_dict() | {"name": tool.name} for n, tool in sorted(job.tools.items())},
        "operations": [{"name": op.name, "kind": op.kind, "tool": op.tool.number} for op in job.operations],
        "program": str(job.program),
        "warnings": list(job.notes),
    }


def _results(result: jobs.Result) -> dict[str, Any]:
    return {
        "operations": [
            {
                "name": done.job.name,
                "kind": done.job.kind,
                "tool": done.job.tool.number,
                "poses": len(done.operation),
                "time_s": done.operation.report.time_s,
                "cut_mm": done.operation.report.cut_mm,
                "air_mm": done.operation.report.air_mm,
                "removed": done.removed,
                "reason": done.operation.reason,
                "blocked": [
                    {"reason": one.reason, "place": one.place.tolist(), "length": one.length}
                    for one in done.operation.report.blocked
                ],
            }
            for done in result.operations
        ],
        "time_s": result.seconds,
        "rows": len(result.program),
        "left": result.setup.stock.volume,
        "not_checked": result.report.not_checked,
        "warnings": list(result.warnings),
    }


def _head(job: jobs.Job) -> list[tuple[str, str]]:
    size = " × ".join(number(float(x)) for x in job.stock.upper - job.stock.lower)
    return [
        ("part", job.part_file.name),
        ("stock", f"{size} mm, rays {number(job.stock.pitch, 'mm')} apart"),
        ("machine", job.machine),
    ]


def _planned(job: jobs.Job) -> list[tuple[str, str]]:
    return [
        (f"{k}. {op.name}", f"{op.kind}, T{op.tool.number} {op.tool.name}") for k, op in enumerate(job.operations, 1)
    ]


def _rows(result: jobs.Result) -> list[tuple[str, str]]:
    out = []
    for k, done in enumerate(result.operations, 1):
        report = done.operation.report
        told = (
            f"{number(report.time_s / 60, 'min')}, {number(report.cut_mm, 'mm')} cut, "
            f"{number(report.air_mm, 'mm')} in air, {number(done.removed, 'mm³')} removed"
        )
        out.append((f"{k}. {done.job.name}", told if len(done.operation) else f"nothing: {done.operation.reason}"))
    return [*out, ("time", number(result.seconds / 60, "min")), ("left", number(result.setup.stock.volume, "mm³"))]
