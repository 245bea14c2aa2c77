"""Simulate an NC program on its stock and report rapids in material, collisions of holder and fixtures, and gouges.

riffler nc verify part.ngc --stock 100x60x30 --pitch 0.25 --tool ball:6:30 --holder 30:20:60:20 --part part.stl

Exit status 0: passed, 1: something was found or could not be checked, 2: bad input.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from .. import Finding, VerifyReport, cluster, verify
from ..formats import MESHES, PARTS, VOLUMES
from . import tools
from .arguments import A_PART, input_file, length, machine_options, output_file
from .console import Console, number, times
from .detail import NOT_MESHED, add_detail, detail_of
from .deviation_map import LEGEND, write_map
from .parser import Parser
from .programs import add_machine, add_program, is_saved, machine_name, read_program
from .shapes import read_part, write_left
from .stock import add_stock, stock
from .surroundings import add_fixtures, add_rods, fixture, rods, with_rods

HELP = "check an NC program by simulation"
MAPS = (".ply",)
MOST = 30  # findings in the table


def add_arguments(parser: Parser) -> None:
    add_program(parser)
    add_stock(parser)
    tools.add_tools(parser)
    add_rods(parser)
    add_machine(parser, 'machine of the program, whose limits are checked (default "tcp": tip and axis)')
    parser.add_file("--part", f"the finished part: {A_PART}", PARTS)
    add_fixtures(parser)
    parser.add_argument(
        "--tolerance", default="0.01", metavar="MM", help="largest error of cutting and of contact (default 0.01)"
    )
    parser.add_argument(
        "--gouge", default="0.05", metavar="MM", help="depth in the part that counts as a gouge (default 0.05)"
    )
    parser.add_argument(
        "--rest", metavar="MM", help="height of rest material that counts as a finding (default: no height)"
    )
    parser.add_argument(
        "--rapid-feed", default="10000", metavar="MM/MIN", help="speed of rapids for the time (default 10000)"
    )
    parser.add_argument("--scheduler", metavar="ADDRESS", help="Dask scheduler to run on: tcp://host:8786")
    parser.add_file("--out", "the material that is left: .stl, .obj, .ply, .3mf or .rvol", MESHES + VOLUMES)
    add_detail(parser)
    parser.add_file("--map", f".ply of the material that is left, coloured: {LEGEND}", MAPS)
    parser.add_argument("--map-scale", default="0.5", metavar="MM", help="distance for full colours (default 0.5)")


def run(arguments: argparse.Namespace, console: Console) -> int:
    limits = {
        "tolerance": length(arguments.tolerance, "--tolerance"),
        "gouge_tolerance": length(arguments.gouge, "--gouge"),
        "rest_tolerance": None if arguments.rest is None else length(arguments.rest, "--rest"),
        "rapid_feed": length(arguments.rapid_feed, "--rapid-feed"),
    }
    detail = detail_of(arguments)
    scale = length(arguments.map_scale, "--map-scale")
    out = None if arguments.out is None else output_file(arguments.out, MESHES + VOLUMES)
    coloured = None if arguments.map is None else output_file(arguments.map, MAPS)
    for option, value in (("--map", arguments.map), ("--rest", arguments.rest)):
        if value is not None and arguments.part is None:
            raise ValueError(f"{option} needs --part")
    wanted = [tools.parse(text) for text in arguments.tool]
    around = rods(arguments)
    path = Path(arguments.program)
    how = machine_options(arguments.machine_option, "--machine-option")
    with console.step("program"):
        program = read_program(path, machine_name(arguments.machine or "tcp", "--machine"), how, console)
    volume = stock(arguments, console)
    reach = float(np.linalg.norm(volume.upper - volume.lower))
    by_number = with_rods(tools.assign(wanted, np.asarray(program.tool)[1:], reach), around)
    with console.step("read"):
        part = None if arguments.part is None else read_part(input_file(arguments.part, PARTS), console)
    fixtures = [fixture(name, console, volume.pitch) for name in arguments.fixture]
    with console.step("verify") as progress:
        machine = {"machine": arguments.machine, "machine_options": how} if arguments.machine else {}
        options = {"tools": by_number, "progress": progress, **limits, **machine}
        if arguments.scheduler is None:
            report = verify(program, volume, part, fixtures, **options)
        else:
            report = cluster.verify(program, volume, part, fixtures, scheduler=arguments.scheduler, **options)
    written = None if out is None else write_left(report.volume, out, console, detail)
    if coloured is not None and (found := report.stock_deviation()) is not None:
        with console.step("map"), console.writing(coloured) as beside:
            write_map(beside, *found, scale)

    blocks = [] if is_saved(path) else path.read_text(encoding="utf-8", errors="replace").splitlines()
    data = {
        "program": str(path),
        **report.to_dict(),
        "tools": {str(n): tool.to_dict() for n, tool in by_number.items()},
        "out": None if out is None else str(out),
        **(written.to_dict() if written else NOT_MESHED),
        "map": None if coloured is None else str(coloured),
        "seconds": console.seconds,
    }
    for entry in data["findings"]:
        entry["block"] = block_of(entry["line"], blocks)
    show(report, data, blocks, console)
    return 0 if report.passed else 1


def block_of(line: int, blocks: list[str]) -> str:
    return blocks[line - 1].strip() if 0 < line <= len(blocks) else ""


def lines_of(finding: Finding) -> str:
    if finding.line == 0:
        return "-"
    return str(finding.line) if finding.line == finding.last_line else f"{finding.line}-{finding.last_line}"


def show(report: VerifyReport, data: dict, blocks: list[str], console: Console) -> None:
    found = report.findings
    if found:
        heads = ("finding", "lines", "block", "how much", "at", "what to do")
        shown = (
            (
                f.kind,
                lines_of(f),
                block_of(f.line, blocks),
                number(round(f.value, 3), f.unit),
                ", ".join(f"{x:.2f}" for x in f.point),
                f.message,
            )
            for f in found[:MOST]
        )
        notes = [f"and {number(len(found) - MOST)} more: --json lists all"] if len(found) > MOST else []
        console.table(f"{len(found)} finding{'s' if len(found) > 1 else ''}", heads, shown, notes)
    minutes, seconds = divmod(round(data["time"]), 60)
    rows = [
        ("moves", number(max(0, data["rows"] - 1))),
        ("tools", ", ".join(f"T{n} {tool['name']}" for n, tool in data["tools"].items())),
        ("removed", number(data["removed"], "mm³")),
        ("left", number(data["volume"], "mm³")),
        ("machining", f"{number(minutes)} min {seconds:02d} s, without tool changes and acceleration"),
        *(("not checked", sentence) for sentence in report.not_checked),
    ]
    if data["map"] is not None:
        rows.append(("map", f"{data['map']}: {LEGEND}"))
    rows.append(("times", times(data["seconds"])))
    name = Path(data["program"]).name
    console.result(data, f"{name}: {'passed' if report.passed else 'NOT passed'}", rows)
