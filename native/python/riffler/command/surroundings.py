"""Shank, holder and fixtures on the command line."""

from __future__ import annotations

import argparse

from .. import Collider, Mesh, Tool, Volume, plan
from ..formats import PARTS, VOLUMES
from .arguments import finite, input_file
from .console import Console
from .parser import Parser
from .shapes import from_mesh

RODS = ("shank", "holder")


def add_rods(parser: Parser) -> None:
    for what in RODS:
        parser.add_argument(
            f"--{what}",
            action="append",
            default=[],
            metavar="CONES",
            help=f"{what}, of tool N or all: [N=]Z0:R0:Z1:R1[,…], heights and radii",
        )


def add_fixtures(parser: Parser) -> None:
    about = "fixture: a mesh, CAD file or .rvol; repeatable"
    parser.add_file("--fixture", about, PARTS + VOLUMES, action="append", default=[])


def rods(arguments: argparse.Namespace) -> list[tuple]:
    """Every ``--shank`` and ``--holder``: which of the two, the tool's number (None: all), and its truncated cones."""
    return [(what, *cones(text, what)) for what in RODS for text in getattr(arguments, what)]


def cones(text: str, what: str) -> tuple[int | None, list[tuple[float, ...]]]:
    """``N=Z0:R0:Z1:R1,…`` as a tool number, or None for all, and truncated cones."""
    before, equals, form = text.rpartition("=")
    if equals and not before.isdecimal():
        raise ValueError(f"--{what} {text}: the number before = must be a tool number")
    out = [tuple(finite(x, f"--{what} {text}: size") for x in cone.split(":")) for cone in form.split(",")]
    if any(len(cone) != 4 for cone in out):
        raise ValueError(f"--{what} {text}: Z0:R0:Z1:R1 expected, heights from the tip and radii")
    return (int(before) if equals else None), out


def with_rods(by_number: dict[int, Tool], wanted: list[tuple]) -> dict[int, Tool]:
    out = dict(by_number)
    for what, number, pieces in wanted:
        if number is not None and number not in out:
            raise ValueError(f"--{what} {number}=…: the program does not call tool {number}")
        for tool in out if number is None else [number]:
            out[tool] = out[tool].with_shank(pieces) if what == "shank" else out[tool].with_holder(pieces)
    return out


def fixtures_alone(fixtures: list[Volume]) -> Collider | None:
    """A collider of the fixtures alone, for tools that may enter the part; None without fixtures."""
    far = Mesh([(1e6, 0, 0), (1e6 + 1, 0, 0), (1e6, 1, 0)], [(0, 1, 2)])  # a part that no machine reaches
    return Collider(far, fixtures=fixtures) if fixtures else None


def fixture(name: str, console: Console, pitch: float | None = None) -> Volume:
    """A fixture's volume. A mesh gets rays along z, at the stock's pitch as in `verify`, or at a pitch that follows
    from its size."""
    path = input_file(name, PARTS + VOLUMES)
    if path.suffix.lower() in VOLUMES:
        return Volume.load(path)
    return from_mesh(path, plan.fixture_pitch if pitch is None else pitch, "z", console, "fixtures")[0]
