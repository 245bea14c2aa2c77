"""Shared by commands that plan one operation: part, tool, stock and fixtures, the check, and the program."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import asdict
from typing import Any

import numpy as np

from .. import Mesh, Tool, Volume, plan
from ..cad import CadPart
from ..formats import PARTS
from . import tools
from .arguments import A_PART, CODE, PROGRAMS, finite, input_file, is_solid, length, output_file
from .console import Console, number, times
from .parser import Parser
from .programs import machine_name
from .shapes import read_exact, read_part
from .stock import stock as read_stock
from .surroundings import add_fixtures, add_rods, fixture, rods, with_rods

RAYS = 400  # along the longest side of a stock of default pitch


def add_tool(parser: Parser) -> None:
    parser.add_input("part", f"the part: {A_PART}", PARTS, flags=("--mesh",))
    tools.add_tool(parser, "the cutter, as in ball:6 or 2=ball:6", required=True)


def add_lengths(parser: Parser, *lengths: tuple[str, str, str]) -> None:
    """Adds options of lengths: flag, default and help."""
    for flag, default, about in lengths:
        parser.add_argument(flag, metavar="MM", default=default, help=f"{about} (default {default})")


def add_lead(parser: Parser) -> None:
    parser.add_argument("--lead", metavar="MM", help="radius of arcs into and out of cuts (default half the tool's)")


def add_exact(parser: Parser) -> None:
    parser.add_argument("--exact", action="store_true", help="take contacts from the CAD file's exact faces")


def lead_of(arguments: argparse.Namespace) -> float | None:
    return None if arguments.lead is None else finite(arguments.lead, "--lead")


def add_scene(parser: Parser, feed: str, rules: str = "") -> None:
    """Adds options for feeds, stock, fixtures, machine and the program's file. ``rules``: what else than a direction
    ``--orientation`` takes."""
    add_lengths(parser, ("--clearance", "5", "height of rapids above everything"))
    parser.add_argument("--feed", metavar="F", default=feed, help=f"mm/min of cuts (default {feed})")
    parser.add_argument("--plunge", metavar="F", help="mm/min of plunges (default a third of the feed)")
    parser.add_argument("--spindle", metavar="S", default="12000", help="rev/min (default 12000)")
    parser.add_argument("--stock", metavar="STOCK", help="WxDxH, a mesh or .rvol (default the part's box)")
    parser.add_argument("--pitch", metavar="MM", help="distance between the stock's rays")
    parser.add_argument("--origin", metavar="X,Y,Z", help="lower corner of a stock of given sizes")
    parser.add_argument(
        "--orientation",
        metavar="AXIS" if rules else "X,Y,Z",
        help=f"direction x,y,z from tip to spindle (default 0,0,1){rules or ', with rotary axes'}",
    )
    parser.add_argument("--zero", metavar="X,Y,Z", help="zero point of the program (default 0,0,0)")
    add_fixtures(parser)
    add_rods(parser)
    parser.add_argument("--post", metavar="NAME", default="3-axis", help="the machine (default 3-axis)")
    parser.add_file("--out", "NC code (.ngc, .nc, …), or .rprog", CODE + PROGRAMS, required=True)


def feeds_of(arguments: argparse.Namespace) -> dict[str, Any]:
    return {
        "feed": length(arguments.feed, "--feed"),
        "plunge": None if arguments.plunge is None else length(arguments.plunge, "--plunge"),
        "spindle": finite(arguments.spindle, "--spindle"),
    }


def run_operation(
    arguments: argparse.Namespace,
    console: Console,
    doing: str,
    planned: Callable[[plan.Setup, Tool, Any], plan.Operation],
    counts: Callable[[dict[str, Any]], list[tuple[str, str]]],
    allowance: float,
    rules: bool = False,
) -> int:
    """Reads the scene, plans with ``planned(setup, tool, progress)``, checks and writes. ``counts`` makes rows of the
    result's table from its data. ``rules``: whether `rule_of` may have a rule."""
    path, out = input_file(arguments.part, PARTS), output_file(arguments.out, CODE + PROGRAMS)
    post = machine_name(arguments.post, "--post")
    asked = tools.parse(arguments.tool)
    with console.step("read"):
        whole = read_exact(path, console) if getattr(arguments, "exact", False) else read_part(path, console)
    part = whole.mesh if isinstance(whole, CadPart) else whole
    lower, upper = part.bounds
    tool = with_rods({1: asked.make(float(max(upper - lower)))}, [(what, None, c) for what, _, c in rods(arguments)])[1]
    stock = stock_of(arguments, part, allowance, console)
    setup = plan.Setup(
        whole,
        stock,
        [fixture(name, console, stock.pitch) for name in arguments.fixture],
        clearance=length(arguments.clearance, "--clearance"),
        machine=post,
        origin=np.zeros(3) if arguments.zero is None else point(arguments.zero, "--zero"),
    ).along(None if rules and is_rule(arguments.orientation) else _direction(arguments.orientation))
    with console.step(doing) as progress:
        op = planned(setup, tool, progress)
    if not len(op):
        raise ValueError(f"{path.name}: {op.reason}")
    with console.step("check") as progress:
        program = plan.program(setup, [op], progress=progress)
    with console.step("write"), console.writing(out) as beside:
        if out.suffix.lower() in PROGRAMS:
            program.save(beside)
        else:
            program.write(beside, post=post, tolerance=0.1 * op.tolerance)
    data = summary(op) | {"part": str(path), "out": str(out), "bytes": out.stat().st_size, "seconds": console.seconds}
    console.result(data, f"{out.name} written", [*counts(data), *rows(data)])
    return 0


def is_rule(text: str | None) -> bool:
    """Whether a text of ``--orientation`` is a rule of `rule_of`, not a direction."""
    return text is not None and ("=" in text or text.count(",") != 2)


def rule_of(text: str | None) -> Any:
    """The rule of ``--orientation`` in the form of plan.finish: normal, least_tilt, LEAD,TILT in degrees,
    towards=X,Y,Z, away=X,Y,Z, or either with a file of a curve. None for a direction."""
    if text is None or not is_rule(text):
        return None
    if text in ("normal", "least_tilt"):
        return text
    kind, equals, target = text.partition("=")
    if equals and kind in ("towards", "away"):
        if target.lower().endswith(plan.curves.FORMATS):
            found = plan.read_curves(input_file(target, plan.curves.FORMATS))
            if len(found) != 1:
                raise ValueError(f"--orientation {text}: {len(found)} curves in the file; one expected")
            return {kind: found[0]}
        return {kind: point(target, f"--orientation {kind}")}
    numbers = text.split(",")
    if len(numbers) == 2:
        return tuple(np.radians([finite(one, "--orientation: angle") for one in numbers]))
    raise ValueError(
        f"--orientation {text}: a direction x,y,z expected, or normal, least_tilt, lead,tilt in degrees, towards=x,y,z "
        "or away=x,y,z"
    )


def _direction(text: str | None) -> np.ndarray | None:
    """The unit vector of ``--orientation``, which may have any length."""
    if text is None:
        return None
    vector = point(text, "--orientation")
    if not np.linalg.norm(vector) > 0:
        raise ValueError(f"--orientation {text}: a direction expected, as in 0,-1,1")
    return vector / np.linalg.norm(vector)


def point(text: str, flag: str) -> np.ndarray:
    values = [finite(part, f"{flag}: coordinate") for part in text.split(",")]
    if len(values) != 3:
        raise ValueError(f"{flag} {text}: x,y,z expected")
    return np.array(values)


def stock_of(arguments: argparse.Namespace, part: Mesh, allowance: float, console: Console) -> Volume:
    """The stock of ``--stock``, else the part's box with the allowance on top."""
    lower, upper = part.bounds
    upper = upper + np.array([0.0, 0.0, max(allowance, 0.0)])
    pitch = float(max(upper - lower)) / RAYS
    if arguments.stock is None:
        if arguments.pitch is not None:
            pitch = length(arguments.pitch, "--pitch")
        return Volume.block(lower, np.maximum(upper, lower + pitch), pitch, _directions(arguments))
    if is_solid(arguments.stock) and arguments.pitch is None:
        arguments.pitch = str(pitch)
    arguments.directions = None if arguments.stock.lower().endswith(".rvol") else _directions(arguments)
    return read_stock(arguments, console)


def _directions(arguments: argparse.Namespace) -> str:
    return "z" if arguments.orientation is None else "xyz"


def summary(op: plan.Operation) -> dict[str, Any]:
    report = op.report
    blocked = [{"reason": b.reason, "place": b.place.tolist(), "length": b.length} for b in report.blocked]
    return {
        "tool": op.tool.to_dict(),
        "poses": len(op),
        "time_s": report.time_s,
        "cut_mm": report.cut_mm,
        "air_mm": report.air_mm,
        "largest_engagement": report.largest_engagement,
        "blocked": blocked,
        "stats": dict(report.stats),
        "exact": None if report.exact is None else asdict(report.exact),
    }


def exact_rows(fit: dict[str, Any] | None) -> list[tuple[str, str]]:
    if fit is None:
        return []
    error = f"{number(fit['before'], 'mm')} off before, {number(fit['after'], 'mm')} after"
    rest = f"; {number(fit['raised'])} raised, {number(fit['kept'])} kept as on the triangles"
    return [("on exact faces", f"{number(fit['fitted'])} points, {error}{rest}")]


def _links(stats: dict[str, Any]) -> list[tuple[str, str]]:
    if "direct" not in stats:
        return []
    return [("links", f"{number(stats['direct'])} at feed, {number(stats['retracts'])} over the clearance plane")]


def rows(data: dict[str, Any]) -> list[tuple[str, str]]:
    return [
        ("points", number(data["poses"])),
        ("cut", f"{number(data['cut_mm'], 'mm')}, {number(data['air_mm'], 'mm')} at feed in air"),
        *_links(data["stats"]),
        *exact_rows(data["exact"]),
        ("time", number(data["time_s"] / 60, "min")),
        *(("blocked", f"{number(b['length'], 'mm')}: {b['reason']}") for b in data["blocked"]),
        ("file", number(data["bytes"], "bytes")),
        ("times", times(data["seconds"])),
    ]
