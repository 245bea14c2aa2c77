"""List the machines that programs are written for and read from.

riffler nc machines
"""

from __future__ import annotations

import argparse

from .. import machines
from .console import Console
from .parser import Parser

HELP = "list the machines that programs are written for"


def add_arguments(parser: Parser) -> None:
    pass


def run(arguments: argparse.Namespace, console: Console) -> int:
    known = machines()
    console.result({"machines": known}, "machines and posts", list(known.items()))
    return 0
