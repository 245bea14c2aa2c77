"""Finish a part in rows, and write the program.

riffler plan finish part.step --tool ball:6 --cusp 0.02 --exact --out part.ngc
riffler plan finish part.stl --tool ball:6 --orientation normal --post tcp --out five-axes.ngc
riffler plan finish part.stl --tool 2=flat:8 --stock 100x80x30 --pitch 0.25 --slopes 0,5 --out flats.ngc

The default stock is the part's box with the allowance on top. The program is simulated on the stock before it is
written: rapids in material, collisions of shank and holder, and gouges are errors that name the place.
"""

from __future__ import annotations

import argparse
import math
from typing import Any

from .. import plan
from .arguments import finite, input_file, length
from .console import Console, number
from .parser import Parser
from .plan_operation import (
    add_exact,
    add_lead,
    add_lengths,
    add_scene,
    add_tool,
    feeds_of,
    lead_of,
    point,
    rule_of,
    run_operation,
)

HELP = "finish a part in rows, as NC code"


def add_arguments(parser: Parser) -> None:
    add_tool(parser)
    parser.add_argument(
        "--pattern",
        choices=plan.PATTERNS,
        default="parallel",
        metavar="PATTERN",
        help=f"{', '.join(plan.PATTERNS[:-1])} or {plan.PATTERNS[-1]} (default parallel)",
    )
    add_lengths(
        parser,
        ("--cusp", "0.01", "largest height of ridges between rows"),
        ("--tolerance", "0.005", "largest error of the rows, above and below"),
        ("--allowance", "0", "material to leave on the part"),
    )
    parser.add_argument("--angle", metavar="DEG", default="0", help="angle of the rows (default 0)")
    parser.add_argument(
        "--slopes", metavar="DEG,DEG", default="0,90", help="slopes of faces to finish, from level (default 0,90)"
    )
    parser.add_argument(
        "--centre", metavar="X,Y,Z", help="centre of a spiral or of rays (default the middle of the part)"
    )
    parser.add_argument(
        "--conventional", action="store_true", help="waterlines with the part to the left of the motion, not climb"
    )
    parser.add_file("--region", "closed curves; only faces inside them are finished", plan.curves.FORMATS)
    add_lead(parser)
    add_exact(parser)
    parser.add_argument("--rest", metavar="MM", help="finish only where more material than this stands")
    add_scene(
        parser,
        "1000",
        ", or a rule: normal, least_tilt, lead,tilt, towards=x,y,z, away=x,y,z",
    )
    parser.add_argument(
        "--max-tilt",
        metavar="DEG",
        default="60",
        help="largest angle of a rule's axes from the direction 0,0,1 (default 60)",
    )
    parser.add_argument(
        "--max-turn", metavar="DEG", help="largest change of a rule's axes in a mm of a row (default 5.7)"
    )


def run(arguments: argparse.Namespace, console: Console) -> int:
    options = options_of(arguments)
    if arguments.region:
        options["region"] = plan.read_curves(input_file(arguments.region, plan.curves.FORMATS))
    return run_operation(
        arguments,
        console,
        "finish",
        lambda setup, tool, progress: plan.finish(setup, tool, arguments.pattern, progress=progress, **options),
        rows,
        options["allowance"],
        rules=True,
    )


def options_of(arguments: argparse.Namespace) -> dict[str, Any]:
    slopes = [math.radians(finite(x, "--slopes: angle")) for x in arguments.slopes.split(",")]
    if len(slopes) != 2:
        raise ValueError(f"--slopes {arguments.slopes}: two angles expected, as in 0,45")
    return {
        "cusp": length(arguments.cusp, "--cusp"),
        "tolerance": length(arguments.tolerance, "--tolerance"),
        "allowance": finite(arguments.allowance, "--allowance"),
        "angle": math.radians(finite(arguments.angle, "--angle")),
        "slopes": (slopes[0], min(slopes[1], math.pi / 2) if slopes[1] <= 90 else slopes[1]),
        "centre": None if arguments.centre is None else point(arguments.centre, "--centre"),
        "rest": None if arguments.rest is None else length(arguments.rest, "--rest"),
        "orientation": rule_of(arguments.orientation),
        "max_tilt": math.radians(finite(arguments.max_tilt, "--max-tilt")),
        **({} if arguments.max_turn is None else {"max_turn": math.radians(length(arguments.max_turn, "--max-turn"))}),
        "climb": not arguments.conventional,
        "lead": lead_of(arguments),
        **feeds_of(arguments),
    }


def rows(data: dict[str, Any]) -> list[tuple[str, str]]:
    stats = data["stats"]
    return [("rows", f"{number(stats['rows'])}, {number(stats['added'])} more on steep faces")]
