"""List the named cutters and the form in which --tool takes each: lengths in mm, angles in degrees.

riffler nc tools

The length may be left out: the default reaches out of the stock. N= before the form gives the tool's number in
the program, as in 3=fillet:10:1.5:40. A file has the form of Tool.to_dict, with angles in rad.
"""

from __future__ import annotations

import argparse

from .console import Console
from .parser import Parser
from .tools import FORMS, SIZES

HELP = "list the named cutters, as --tool takes them"


def add_arguments(parser: Parser) -> None:
    pass


def run(arguments: argparse.Namespace, console: Console) -> int:
    tools = {
        kind: {"form": FORMS[kind], "sizes": [{"name": size.name, "unit": size.unit} for size in sizes]}
        for kind, sizes in SIZES.items()
    }
    console.result({"tools": tools}, "tools", list(FORMS.items()))
    return 0
