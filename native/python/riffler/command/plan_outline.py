"""Cut a part out along its silhouette, or along curves, and write the program.

riffler plan outline part.stl --tool flat:4 --tabs 4 --out part.ngc
riffler plan outline part.stl --tool flat:3 --curves slot.obj --inside --depth 5 --out slot.ngc

The cutter keeps its radius from the outline. Holes that it does not fit into are left out, and listed. Without --stock
it is the part's box, in which there may be nothing to cut. The program is simulated on the stock before it is written.
"""

from __future__ import annotations

import argparse
import math
from typing import Any

from .. import plan
from .arguments import finite, input_file, length, whole
from .console import Console, number
from .parser import Parser
from .plan_operation import add_lead, add_lengths, add_scene, add_tool, feeds_of, lead_of, run_operation

HELP = "cut a part out along its silhouette, as NC code"


def add_arguments(parser: Parser) -> None:
    add_tool(parser)
    parser.add_file("--curves", "closed curves instead of the silhouette", plan.curves.FORMATS)
    parser.add_argument("--inside", action="store_true", help="keep the tool inside the curves")
    parser.add_argument("--depth", metavar="MM", help="depth of the tip below the top (default: through the stock)")
    parser.add_argument("--tabs", metavar="N", help="number of bridges that stay along each loop")
    add_lengths(
        parser,
        ("--stepdown", "2", "height of a layer"),
        ("--tab-height", "1", "height of a bridge"),
        ("--tab-width", "4", "length of a bridge along the loop"),
        ("--allowance", "0", "material to leave on the part"),
        ("--tolerance", "0.01", "largest error: more material may stay by this much"),
    )
    parser.add_argument("--slope", metavar="DEG", default="3", help="slope of ramps (default 3)")
    parser.add_argument(
        "--conventional", action="store_true", help="mill with the part to the left of the motion, not climb"
    )
    add_lead(parser)
    add_scene(parser, "1000")


def run(arguments: argparse.Namespace, console: Console) -> int:
    options = options_of(arguments)
    if arguments.curves:
        options["curves"] = plan.read_curves(input_file(arguments.curves, plan.curves.FORMATS))
    return run_operation(
        arguments,
        console,
        "outline",
        lambda setup, tool, progress: plan.outline(setup, tool, progress=progress, **options),
        rows,
        0.0,
    )


def options_of(arguments: argparse.Namespace) -> dict[str, Any]:
    return {
        "depth": None if arguments.depth is None else length(arguments.depth, "--depth"),
        "inside": arguments.inside,
        "stepdown": length(arguments.stepdown, "--stepdown"),
        "tabs": 0 if arguments.tabs is None else whole(arguments.tabs, "--tabs"),
        "tab_height": finite(arguments.tab_height, "--tab-height"),
        "tab_width": length(arguments.tab_width, "--tab-width"),
        "allowance": finite(arguments.allowance, "--allowance"),
        "tolerance": length(arguments.tolerance, "--tolerance"),
        "slope": math.radians(finite(arguments.slope, "--slope")),
        "climb": not arguments.conventional,
        "lead": lead_of(arguments),
        **feeds_of(arguments),
    }


def rows(data: dict[str, Any]) -> list[tuple[str, str]]:
    stats = data["stats"]
    return [("loops", f"{number(stats['loops'])} in {number(stats['levels'])} layers"), ("tabs", number(stats["tabs"]))]
