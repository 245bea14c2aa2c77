"""Measure run time, error and memory; exit status 1 if a result is wrong (never for being slow).

riffler bench                    every job: about half an hour
riffler bench b5x force          some of them
riffler bench --quick            all of them, coarser, within a minute

Writes JSON, Markdown and plots of each job into --out. Lists rivals that are not installed as left out.
Needs the package riffler-bench: in a checkout, pip install ./bench
"""

from __future__ import annotations

import argparse

from .. import __version__
from .console import Console
from .parser import Parser

HELP = "measure run time, error and memory"
MISSING = f"riffler bench: needs riffler-bench {__version__}: in a checkout of that version, pip install ./bench"
NAMES = (
    *("b200", "b5x", "s500k", "haptic", "force", "pitch", "mesh", "detail", "follow", "random", "stl", "decimate"),
    *("col", "pencil", "drop", "surfaces", "brushes", "gouge", "nc", "threads", "verify", "cluster", "blender"),
)


def add_arguments(parser: Parser) -> None:
    jobs = f"{', '.join(NAMES)}; all of them if none is named"
    parser.add_argument("jobs", nargs="*", metavar="JOB", help=jobs)
    parser.offer("jobs", NAMES)
    parser.add_argument("--quick", action="store_true", help="coarser and shorter, to check that everything works")
    parser.add_argument("--out", default="riffler-bench", metavar="DIR", help="default riffler-bench")
    parser.add_argument("--no-plots", action="store_true", help="figures only; plots need matplotlib")
    parser.add_argument("--redraw", action="store_true", help="measure nothing, draw the plots of --out again")
    parser.add_argument("--models", metavar="DIR", help=".stl files for the jobs stl, pencil, drop and gouge")
    what = "a Python with bpy or a Blender, to measure the add-on and Blender's own tools; may be repeated"
    parser.add_argument("--blender", metavar="PROGRAM", action="append", default=[], help=what)
    parser.add_argument("--rivals", metavar="PYTHON", help="a Python with the libraries of requirements/rivals.txt")
    parser.add_argument(
        "--programs", metavar="DIR", help="build folder of native/bench, with the rivals OpenVDB, FCL and Coal"
    )


def run(arguments: argparse.Namespace, console: Console) -> int:
    try:
        from riffler_bench import command
    except ImportError as error:
        if error.name != "riffler_bench":
            raise
        raise ValueError(MISSING if isinstance(error, ModuleNotFoundError) else str(error)) from None
    return command.run(arguments, console)
