"""Rough a part from one side in layers, and write the program.

riffler plan rough part.stl --tool flat:8 --stepdown 2 --out rough.ngc
riffler plan rough part.stl --tool 2=flat:6 --stock 100x80x30 --pitch 0.5 --engagement 0.2 --out rough.ngc

No cut is wider than --engagement, a share of the cutter's diameter. The default stock is the part's box with the
allowance on top. The program is simulated on the stock before it is written: rapids in material, collisions of shank
and holder, and gouges are errors that name the place.
"""

from __future__ import annotations

import argparse
import math
from typing import Any

from .. import plan
from .arguments import finite, length
from .console import Console, number
from .parser import Parser
from .plan_operation import add_lengths, add_scene, add_tool, feeds_of, run_operation

HELP = "rough a part in layers, as NC code"


def add_arguments(parser: Parser) -> None:
    add_tool(parser)
    add_lengths(
        parser,
        ("--stepdown", "2", "height of a layer"),
        ("--allowance", "0.3", "material to leave on the part"),
        ("--tolerance", "0.05", "largest error of curves"),
    )
    parser.add_argument("--depth", metavar="MM", help="depth of the lowest layer below the part's highest point")
    parser.add_argument("--engagement", metavar="SHARE", default="0.4", help="widest cut in diameters (default 0.4)")
    parser.add_argument("--slope", metavar="DEG", default="3", help="slope of helices and ramps (default 3)")
    parser.add_argument("--conventional", action="store_true", help="mill with the material to the left of the motion")
    add_scene(parser, "1200")


def run(arguments: argparse.Namespace, console: Console) -> int:
    options = options_of(arguments)
    return run_operation(
        arguments,
        console,
        "rough",
        lambda setup, tool, progress: plan.rough(setup, tool, progress=progress, **options),
        rows,
        options["allowance"],
    )


def options_of(arguments: argparse.Namespace) -> dict[str, Any]:
    return {
        "stepdown": length(arguments.stepdown, "--stepdown"),
        "depth": None if arguments.depth is None else length(arguments.depth, "--depth"),
        "engagement": finite(arguments.engagement, "--engagement"),
        "allowance": finite(arguments.allowance, "--allowance"),
        "tolerance": length(arguments.tolerance, "--tolerance"),
        "slope": math.radians(finite(arguments.slope, "--slope")),
        "climb": not arguments.conventional,
        **feeds_of(arguments),
    }


def rows(data: dict[str, Any]) -> list[tuple[str, str]]:
    stats = data["stats"]
    return [
        ("layers", f"{number(stats['levels'])} with {number(stats['rings'])} rings"),
        ("entered", f"{number(stats['helices'])} times by a helix, {number(stats['ramps'])} by a ramp"),
        ("widest cut", f"{number(100 * data['largest_engagement'], '% of the diameter')}"),
    ]
