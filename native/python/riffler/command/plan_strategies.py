"""A verb for each strategy of riffler.plan, which writes the strategy's paths as a plan."""

from __future__ import annotations

import argparse
import math
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

from .. import Mesh, Surface, plan
from ..formats import PARTS
from ..plan import curves
from ..plan.exact_path import fit_path, total_fit
from ..plan.setups import deviation_of
from . import tools
from .arguments import A_PART, PLANS, finite, input_file, length, output_file, whole
from .console import Console, number, times
from .parser import Parser
from .plan_operation import add_exact, exact_rows
from .shapes import read_exact, read_part

GIVEN = {  # further input of a strategy, in addition to part and tool: help, file suffixes and names of its option
    "curves": (
        "curves on the part: polylines of .obj, points of .txt, .xyz, .csv or .json",
        curves.FORMATS,
        ("--curves",),
    ),
    "paths": ("plan with the paths to start from; paths that are off are left out", PLANS, ("--plan", "--paths")),
}


class StrategyCommand:
    """The command of one strategy, with the same members as a command's module."""

    def __init__(self, strategy: plan.Strategy) -> None:
        self.strategy = strategy
        self.__name__ = f"plan_{strategy.id}"
        self.HELP = strategy.summary
        more = f" --{strategy.needs} FILE" if strategy.needs in GIVEN else ""
        self.__doc__ = (
            f"{strategy.description}. Writes the paths as a plan.\n\n"
            f"riffler plan {strategy.id} part.stl --tool ball:6{more} --out plan.json"
        )

    def add_arguments(self, parser: Parser) -> None:
        needs = self.strategy.needs
        parser.add_input("part", f"the part: {A_PART}", PARTS, flags=("--mesh",))
        whose = "; by default the plan's" if needs == "paths" else ""
        tools.add_tool(parser, f"the cutter, as in ball:6, or a file{whose}", required=not whose)
        if needs in GIVEN:
            about, suffixes, flags = GIVEN[needs]
            parser.add_argument(*flags, dest=needs, required=True, metavar="FILE", help=about)
            parser.offer(needs, (), suffixes)
        for parameter in self.strategy.parameters:
            add_option(parser, parameter)
        if strategy_is_exact(self.strategy):
            add_exact(parser)
        parser.add_file("--out", ".json", PLANS, required=True)

    def run(self, arguments: argparse.Namespace, console: Console) -> int:
        strategy = self.strategy
        options = {p.key: value_of(p, getattr(arguments, p.key)) for p in strategy.parameters}
        asked = None if arguments.tool is None else tools.parse(arguments.tool)
        path = input_file(arguments.part, PARTS)
        source = (
            input_file(getattr(arguments, strategy.needs), GIVEN[strategy.needs][1])
            if strategy.needs in GIVEN
            else None
        )
        out = output_file(arguments.out, PLANS)
        with console.step("read"):
            whole = read_exact(path, console) if getattr(arguments, "exact", False) else None
            mesh = read_part(path, console, hollow=True) if whole is None else whole.mesh
            given, tool = read_given(strategy.needs, source)
        if asked is not None:
            lower, upper = mesh.bounds
            tool = asked.make(float(max(upper - lower)))
        with console.step(strategy.id) as progress:
            try:
                found = plan.find(strategy.id, mesh, tool, given, name=path.name, progress=progress, **options)
            except ValueError as error:
                raise ValueError(f"{path.name}: {error}") from None
        fit = None
        if whole is not None and whole.surface is not None:
            with console.step("exact faces"):
                found, fit = fitted(found, mesh, whole.surface)
        with console.step("write"), console.writing(out) as beside:
            plan.save(beside, found.plan)
        data = summary(found, path, out, source) | {"exact": fit, "seconds": console.seconds}
        console.result(data, f"{out.name} written", rows(data))
        return 0


def strategy_is_exact(strategy: plan.Strategy) -> bool:
    """Whether its paths can be moved onto exact faces: those of balls that touch two of them."""
    return strategy.id == "pencil"


def fitted(found: plan.Found, mesh: Mesh, exact: Surface) -> tuple[plan.Found, dict[str, Any]]:
    """The paths with their centres one radius from both exact faces, and what `ExactFit` says of that."""
    deviation, tolerance = deviation_of(mesh, exact), found.plan.tolerance or 0.0
    made = [fit_path(path, exact, deviation, tolerance) for path in found.plan.paths]
    paths = replace(found.plan, paths=[path for path, _ in made])
    return replace(found, plan=paths), asdict(total_fit([fit for _, fit in made]))


def add_option(parser: Parser, parameter: plan.Parameter) -> None:
    flag, about = f"--{parameter.key.replace('_', '-')}", parameter.help[:1].lower() + parameter.help[1:]
    about = about.replace("; 0: ", "; by default ")  # a panel shows 0 for a value that is left out
    if parameter.choices:
        words = [value for value, _, _ in parameter.choices]
        meanings = "; ".join(f"{value}: {help[:1].lower()}{help[1:]}" for value, _, help in parameter.choices)
        parser.add_argument(
            flag, choices=words, default=parameter.default, help=f"{about} (default {parameter.default}); {meanings}"
        )
        return
    if isinstance(parameter.default, int | float):
        about += f" (default {shown(parameter.default, parameter.unit):g})"
    metavar = {"mm": "MM", "rad": "DEG"}.get(parameter.unit, "N")
    parser.add_argument(flag, metavar=metavar, help=about.replace("%", "%%"))


def shown(value: float, unit: str) -> float:
    """A parameter's value as the command line has it: angles in degrees."""
    return math.degrees(value) if unit == "rad" else value


def value_of(parameter: plan.Parameter, text: str | None) -> Any:
    """The value of an option, or the parameter's default."""
    if text is None or parameter.choices:
        return parameter.default if text is None else text
    flag = f"--{parameter.key.replace('_', '-')}"
    if not parameter.unit:
        return whole(text, flag)
    value = length(text, flag) if parameter.low >= 0 else finite(text, flag)
    return math.radians(value) if parameter.unit == "rad" else value


def read_given(needs: str, source: Path | None) -> tuple[list, Any]:
    """The curves or paths of the file, and the tool of a plan."""
    if source is None:
        return [], None
    if needs == "curves":
        return curves.read_curves(source), None
    planned = plan.load(source)
    if not planned.sources:
        raise ValueError(f"{source.name}: every path is off, or has no ball at its walls")
    return planned.sources, planned.tool


def summary(found: plan.Found, path: Path, out: Path, source: Path | None) -> dict[str, Any]:
    made = found.plan
    data = {
        "out": str(out),
        "part": str(path),
        "tool": made.tool.to_dict(),
        "tolerance": made.tolerance,
        "paths": len(made.paths),
        "points": sum(map(len, made.paths)),
        "closed": sum(p.closed for p in made.paths),
        "length": float(sum(p.length for p in made.paths)),
        "reason": found.reason,
        "bytes": out.stat().st_size,
    }
    return data | ({} if source is None else {"from": str(source), "notes": found.notes})


def rows(data: dict[str, Any]) -> list[tuple[str, str]]:
    loops = f", {number(data['closed'])} of them loops" if data["closed"] else ""
    return [
        ("paths", f"{number(data['paths'])}{loops}" + (f": {data['reason']}" if data["reason"] else "")),
        ("points", number(data["points"])),
        ("length", number(data["length"], "mm")),
        *exact_rows(data.get("exact")),
        ("tool", f"{data['tool']['name']}, paths to {data['tolerance']:g} mm"),
        *(("note", note) for note in data.get("notes", ())),
        ("file", number(data["bytes"], "bytes")),
        ("times", times(data["seconds"])),
    ]
