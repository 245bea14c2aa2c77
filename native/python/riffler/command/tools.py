"""Tools as the command line names them: ``ball:6``, ``3=fillet:10:1.5:40``, or a file."""

from __future__ import annotations

import json
import math
import tomllib
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .. import Tool
from .arguments import finite
from .parser import Parser, hint

# Sizes in the order of the command line. The length comes last and may be left out; flags are false.
SIZES = {
    shape.name.replace("_", "-"): [size for size in shape.sizes if size.unit != "bool" and size.name != "length"]
    for shape in Tool.shapes()
}


def _form(kind: str) -> str:
    return f"{kind}:{':'.join(size.name for size in SIZES[kind])}[:length]"


FORMS = {kind: _form(kind) for kind in SIZES} | {"file": "tool.json or tool.toml"}


def add_tool(parser: Parser, about: str, **more: Any) -> None:
    parser.add_argument("--tool", metavar="TOOL", help=f"{about}; riffler nc tools lists the forms", **more)
    parser.offer("tool", (f"{kind}:" for kind in SIZES), (".json", ".toml"))


def add_tools(parser: Parser, required: bool = True) -> None:
    """Adds the option for a tool of each number that a program calls."""
    about = "as in ball:6, or 2=flat:10:30 for the tool called 2; may be repeated"
    add_tool(parser, about, required=required, action="append", default=None if required else [])


@dataclass(frozen=True)
class ToolArgument:
    """One ``--tool``: the program's number for it, or None for every number, and how to make it."""

    text: str
    number: int | None
    make: Callable[[float], Tool]  # argument: length of a tool that is given without one


def parse(text: str) -> ToolArgument:
    number, equals, form = text.partition("=")
    if not equals:
        return ToolArgument(text, None, _maker(text, text))
    if not number.isdecimal():
        raise ValueError(f"--tool {text}: the number before = must be a tool number")
    return ToolArgument(text, int(number), _maker(form, text))


def _maker(form: str, text: str) -> Callable[[float], Tool]:
    if form.lower().endswith((".json", ".toml")):
        tool = Tool.from_dict(_read(Path(form)))
        if tool.hulls:
            raise ValueError(
                f'--tool {text}: "{tool.name}" is a hand tool, and commands cut with tools of revolution;'
                " use Volume.carve in Python, or a ball, a flat or another tool with a profile"
            )
        return lambda _: tool
    kind, *numbers = form.split(":")
    sizes = SIZES.get(kind)
    if sizes is None:
        raise ValueError(f"--tool {text}: {', '.join(SIZES)} or a .json or .toml file expected{hint(kind, SIZES)}")
    if len(numbers) not in (len(sizes), len(sizes) + 1):
        raise ValueError(f"--tool {text}: {_form(kind)} expected")
    entry: dict[str, Any] = {"kind": kind.replace("-", "_"), "name": form}
    units = {size.name: size.unit for size in sizes} | {"length": "mm"}
    for (name, unit), value in zip(units.items(), numbers, strict=False):
        size = finite(value, f"--tool {text}: {name}")
        entry[name] = math.radians(size) if unit == "rad" else size

    def make(reach: float) -> Tool:
        try:
            return Tool.from_dict({"length": max(5 * entry["diameter"], reach), **entry})
        except ValueError as error:
            raise ValueError(f"--tool {text}: {error}") from None

    make(1e3 * max(1.0, abs(entry["diameter"])))  # reports wrong sizes before any work
    return make


def _read(path: Path) -> dict[str, Any]:
    data = path.read_bytes()
    try:
        entry = tomllib.loads(data.decode()) if path.suffix.lower() == ".toml" else json.loads(data)
    except ValueError as error:  # of encoding, JSON and TOML alike
        raise ValueError(f"{path.name}: {error}") from None
    if not isinstance(entry, dict):
        raise ValueError(f"{path.name}: one tool, a table of its sizes, expected")
    return entry


def assign(arguments: Iterable[ToolArgument], called: Iterable[int], reach: float) -> dict[int, Tool]:
    """The tool of each number that the program calls.

    0 stands for moves before any call: they get the only tool if the program never calls one, otherwise no tool.
    """
    arguments, numbers = list(arguments), {int(n) for n in called}
    if len(numbers) > 1:
        numbers.discard(0)
    given = [a.number for a in arguments]
    for number in given:
        if given.count(number) > 1:
            which = "every number" if number is None else f"number {number}"
            raise ValueError(f"--tool: two tools for {which}; several tools need N=… with different N")
    made = {a.number: a.make(reach) for a in arguments}
    if len(made) == 1 and (None in made or numbers == {0}):
        if len(numbers) > 1:
            raise ValueError(f"the program changes between tools {_list(numbers)}: give --tool N=… for each")
        return dict.fromkeys(numbers, next(iter(made.values())))
    if None in made:
        raise ValueError("--tool: give every tool its number, N=…, or one tool for all")
    missing = numbers - made.keys()
    if missing == {0}:
        raise ValueError("the program calls no tool: give one --tool only")
    if missing:
        raise ValueError(f"the program calls tool {_list(missing)}: give --tool N=… for it")
    return {n: made[n] for n in numbers}


def _list(numbers: Iterable[int]) -> str:
    return ", ".join(map(str, sorted(numbers)))


def runs(tool: np.ndarray) -> list[tuple[int, int, int]]:
    """(first, last, number) of every run of moves [first, last) with one tool; move i goes from row i to row i + 1."""
    numbers = np.asarray(tool)[1:]
    ends = [*(np.flatnonzero(np.diff(numbers)) + 1).tolist(), len(numbers)]
    return [(a, b, int(numbers[a])) for a, b in zip([0, *ends], ends, strict=False) if b > a]
