"""The command line: ``riffler``, or ``python -m riffler``.

Exit status: 0, or 1 where a check failed, or 2 for bad input, or 130 after Ctrl-C. An error is one line on stderr, or,
with ``--json``, ``{"error": …}`` on stdout; nothing is written then.
"""

from __future__ import annotations

import argparse
import os
import sys
import traceback
from typing import Any, NoReturn

from . import Cancelled, __version__
from .command import audit, bench, carve, convert, doctor, machines, mesh, pen, pencil, plan, post, replay, verify
from .command.console import Console

COMMANDS = (carve, replay, verify, convert, mesh, plan, pencil, post, machines, audit, pen, doctor, bench)
LISTS = ("--origin", "--axis")
EPILOG = "lengths in mm, angles on the command line in degrees; exit status 0, 1 (a check failed) or 2 (bad input)"


class UsageError(ValueError):
    """The command line itself is wrong."""


class Parser(argparse.ArgumentParser):
    """Raises what is wrong instead of printing usage and exiting."""

    def error(self, message: str) -> NoReturn:
        raise UsageError(f"{message} (see {self.prog} --help)")


def parser() -> Parser:
    top = Parser(prog="riffler", description="Dexel volumes, carving and meshes.", epilog=EPILOG, allow_abbrev=False)
    top.add_argument("--version", action="version", version=f"riffler {__version__}")
    commands = top.add_subparsers(dest="command", required=True, metavar="command")
    for module in COMMANDS:
        add_command(commands, module, module.__name__.rpartition(".")[2])
    return top


def add_command(commands: Any, module: Any, name: str) -> None:
    """One command, or with PARTS the commands that it consists of: ``riffler pen list``."""
    sub = commands.add_parser(
        name, help=module.HELP, description=module.__doc__, epilog=EPILOG, allow_abbrev=False,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )  # fmt: skip
    if hasattr(module, "PARTS"):
        parts = sub.add_subparsers(dest="part", required=True, metavar="command")
        for part in module.PARTS:
            add_command(parts, part, part.__name__.rpartition("_")[2])
        return
    module.add_arguments(sub)
    sub.add_argument("--json", action="store_true", help="print the result, or the error, as JSON")
    sub.set_defaults(run=module.run)


def joined(argv: list[str]) -> list[str]:
    """``--origin -5,0,0`` as ``--origin=-5,0,0``: argparse takes a list that begins with a minus for an option."""
    out: list[str] = []
    for word in argv:
        if out and out[-1] in LISTS and word[:1] == "-" and word[1:2] in "0123456789.":
            out[-1] += "=" + word
        else:
            out.append(word)
    return out


def main(argv: list[str] | None = None) -> int:
    """Runs one command; returns the exit status."""
    argv = sys.argv[1:] if argv is None else list(argv)
    console = Console(json_output="--json" in argv)
    try:
        arguments = parser().parse_args(joined(argv))
        status = arguments.run(arguments, console)
        sys.stdout.flush()
        return status
    except (KeyboardInterrupt, Cancelled):
        done = f"after {console.written} was written" if console.written else "nothing was written"
        console.error(f"interrupted, {done}")
        return 130
    except BrokenPipeError:
        # Whoever read our output has seen enough; keep the interpreter from complaining about it at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except Exception as error:
        if os.environ.get("RIFFLER_TRACEBACK"):
            traceback.print_exc()
        console.error(explain(error))
        return 2


def explain(error: Exception) -> str:
    """One line that says what is wrong."""
    if isinstance(error, MemoryError):
        return "out of memory; take a coarser pitch or a smaller part"
    if isinstance(error, OSError) and error.strerror:
        return f"{os.path.basename(error.filename)}: {error.strerror}" if error.filename else error.strerror
    if isinstance(error, ValueError | RuntimeError | OSError):
        return str(error)
    return f"{type(error).__name__}: {error} (a defect of riffler: RIFFLER_TRACEBACK=1 shows where)"
