"""Plan the recorded strokes of a hand: a path for each stroke, with keys where its axis bends. The plan can be edited
as any other.

riffler plan from-recording session.rjournal --tolerance 0.02 --out plan.json
"""

from __future__ import annotations

import argparse
import math

from .. import Journal, plan
from ..plan.recorded import ANGLE
from .arguments import JOURNALS, PLANS, input_file, length, output_file, whole
from .console import Console, number, times
from .parser import Parser

HELP = "plan the strokes of a recording"


def add_arguments(parser: Parser) -> None:
    parser.add_input("journal", ".rjournal", JOURNALS)
    parser.add_argument("--tool-number", metavar="N", help="plan the strokes of this tool, if there are several")
    parser.add_argument(
        "--tolerance",
        metavar="MM",
        default="0.01",
        help="largest error of the ball's centre, or of the tip (default 0.01)",
    )
    parser.add_argument(
        "--angle",
        metavar="DEG",
        help=f"largest angle between recorded and planned axes (default {math.degrees(ANGLE):g})",
    )
    parser.add_file("--out", ".json", PLANS, required=True)


def run(arguments: argparse.Namespace, console: Console) -> int:
    path = input_file(arguments.journal, JOURNALS)
    out = output_file(arguments.out, PLANS)
    tool = None if arguments.tool_number is None else whole(arguments.tool_number, "--tool-number")
    tolerance = length(arguments.tolerance, "--tolerance")
    angle = ANGLE if arguments.angle is None else math.radians(length(arguments.angle, "--angle"))
    if angle > plan.recorded.LARGEST:
        raise ValueError(f"--angle must be at most {math.degrees(plan.recorded.LARGEST):.0f}, not {arguments.angle}")
    with console.step("read"):
        journal = Journal.load(path)
    numbers = {stroke.tool for stroke in journal.strokes if stroke.mode in plan.recorded.CUTS}
    if tool is None and len(numbers) > 1:
        listed = ", ".join(map(str, sorted(numbers)))
        raise ValueError(f"{path.name}: it has strokes of the tools {listed}, and a plan has one: give --tool-number")
    with console.step("plan") as progress:
        found = plan.from_recording(
            journal, tool=tool, tolerance=tolerance, angle=angle, name=path.name, progress=progress
        )
    with console.step("write"), console.writing(out) as beside:
        plan.save(beside, found.plan)
    data = {
        "out": str(out),
        "recording": str(path),
        "tool": found.plan.tool.to_dict(),
        "strokes": found.strokes,
        "paths": len(found.paths),
        "poses": sum(each.poses for each in found.paths),
        "points": sum(map(len, found.plan.paths)),
        "keys": sum(len(each.keys) for each in found.plan.paths),
        "length": float(sum(each.length for each in found.plan.paths)),
        "error": found.error,
        "turn": found.turn,
        "notes": found.notes,
        "bytes": out.stat().st_size,
        "seconds": console.seconds,
    }
    console.result(data, f"{out.name} written", rows(data))
    return 0


def rows(data: dict) -> list[tuple[str, str]]:
    return [
        ("paths", number(data["paths"])),
        ("points", f"{number(data['points'])} of {number(data['poses'])} poses, {number(data['keys'])} keys"),
        ("length", number(data["length"], "mm")),
        ("within", f"{data['error']:.3g} mm, {math.degrees(data['turn']):.3g}°"),
        ("tool", str(data["tool"]["name"])),
        *(("note", note) for note in data["notes"]),
        ("file", number(data["bytes"], "bytes")),
        ("times", times(data["seconds"])),
    ]
