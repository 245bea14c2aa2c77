"""Find the pencil cuts of a part: valleys that a ball touches on both sides. They are written as a plan.

riffler pencil part.stl --tool ball:6 --out pencil.json [--tolerance 0.01]
"""

from __future__ import annotations

import argparse

from .. import plan
from . import tools
from .arguments import MESHES, input_file, length, output_file, whole
from .console import Console, number, times
from .shapes import read_part

HELP = "find the pencil cuts of a part"
PLANS = (".json",)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("mesh", metavar="FILE", help=".stl, .obj, .ply or .3mf")
    parser.add_argument("--tool", required=True, metavar="TOOL", help="whose ball rolls, as in ball:6, or a file")
    parser.add_argument("--tolerance", metavar="MM", default="0.01", help="of the paths, mm (default 0.01)")
    parser.add_argument("--minimum-length", metavar="MM", help="leave out paths that are shorter")
    parser.add_argument("--passes", metavar="N", default="1", help="1 and so many less one on either side")
    parser.add_argument(
        "--stepover", metavar="MM", help="between passes; by default what leaves ridges of the tolerance"
    )
    parser.add_argument("--out", required=True, metavar="FILE", help=".json")


def run(arguments: argparse.Namespace, console: Console) -> int:
    tolerance = length(arguments.tolerance, "--tolerance")
    shortest = 0.0 if arguments.minimum_length is None else length(arguments.minimum_length, "--minimum-length")
    passes = whole(arguments.passes, "--passes")
    stepover = None if arguments.stepover is None else length(arguments.stepover, "--stepover")
    given = tools.parse(arguments.tool)
    path = input_file(arguments.mesh, MESHES)
    out = output_file(arguments.out, PLANS)
    with console.step("read"):
        mesh = read_part(path, console, hollow=True)
    lower, upper = mesh.bounds
    tool = given.make(float(max(upper - lower)))
    with console.step("pencil") as progress:
        try:
            paths = plan.pencil(
                mesh,
                tool,
                tolerance=tolerance,
                passes=passes,
                progress=progress,
                minimum_length=shortest,
                stepover=stepover,
            )
        except ValueError as error:
            raise ValueError(f"{path.name}: {error}") from None
    with console.step("write"), console.writing(out) as beside:
        plan.save(beside, plan.Plan(list(paths), tool, part=plan.part_of(mesh, path.name), tolerance=tolerance))
    data = {
        "out": str(out),
        "part": str(path),
        "tool": tool.to_dict(),
        "tolerance": tolerance,
        "paths": len(paths),
        "points": sum(map(len, paths)),
        "closed": sum(p.closed for p in paths),
        "length": float(sum(p.length for p in paths)),
        "reason": getattr(paths, "reason", ""),
        "bytes": out.stat().st_size,
        "seconds": console.seconds,
    }
    console.result(data, f"{out.name} written", rows(data))
    return 0


def rows(data: dict) -> list[tuple[str, str]]:
    loops = f", {number(data['closed'])} of them loops" if data["closed"] else ""
    return [
        ("paths", f"{number(data['paths'])}{loops}" + (f": {data['reason']}" if data["reason"] else "")),
        ("points", number(data["points"])),
        ("length", number(data["length"], "mm")),
        ("tool", f"{data['tool']['name']}, paths to {data['tolerance']:g} mm"),
        ("file", number(data["bytes"], "bytes")),
        ("times", times(data["seconds"])),
    ]
