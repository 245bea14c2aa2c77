"""Drill holes along z, and write the program.

riffler plan drill part.stl --tool flat:3 --at 10,20,6 --at 30,20,6 --depth 6 --peck 2 --out holes.ngc
riffler plan drill part.stl --tool drill.toml --points holes.csv --depth 6 --out holes.ngc

A hole where the drill would enter the part, or its holder or a fixture is met, is left out, and listed. The program is
simulated on the stock before it is written.
"""

from __future__ import annotations

import argparse
from typing import Any

import numpy as np

from .. import plan
from .arguments import input_file, length
from .console import Console, number
from .parser import Parser
from .plan_operation import add_lengths, add_scene, add_tool, feeds_of, point, run_operation

HELP = "drill holes, as NC code"


def add_arguments(parser: Parser) -> None:
    add_tool(parser)
    parser.add_argument("--at", metavar="X,Y,Z", action="append", default=[], help="mouth of a hole; may be repeated")
    parser.add_file("--points", "file of mouths of holes", plan.curves.FORMATS)
    parser.add_argument("--depth", metavar="MM", required=True, help="depth of the tip below the mouth")
    parser.add_argument("--peck", metavar="MM", help="depth of a peck, after which the drill leaves the hole")
    add_lengths(parser, ("--tolerance", "0.05", "depth to which the drill may enter the part"))
    add_scene(parser, "200")


def run(arguments: argparse.Namespace, console: Console) -> int:
    points = [point(text, "--at") for text in arguments.at]
    if arguments.points:
        points += list(np.concatenate(plan.read_curves(input_file(arguments.points, plan.curves.FORMATS))))
    if not points:
        raise ValueError("no hole: give --at X,Y,Z or --points FILE")
    depth = length(arguments.depth, "--depth")
    options: dict[str, Any] = {
        "peck": None if arguments.peck is None else length(arguments.peck, "--peck"),
        "tolerance": length(arguments.tolerance, "--tolerance"),
        **feeds_of(arguments),
    }
    del options["plunge"]
    return run_operation(
        arguments,
        console,
        "drill",
        lambda setup, tool, progress: plan.drill(setup, tool, points, depth, progress=progress, **options),
        rows,
        0.0,
    )


def rows(data: dict[str, Any]) -> list[tuple[str, str]]:
    stats = data["stats"]
    return [("holes", f"{number(stats['holes'])} in {number(stats['pecks'])} pecks")]
