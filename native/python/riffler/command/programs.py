"""Programs on the command line: the file, and the machine that it was written for."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from .. import Program, machines
from .arguments import CODE, PROGRAMS, add_machine_option
from .console import Console
from .parser import Parser, hint


def add_program(parser: Parser) -> None:
    parser.add_input("program", "NC program, RS-274, or .rprog", CODE + PROGRAMS)


def add_machine(parser: Parser, about: str = 'machine of the program (default "tcp": tip and axis)') -> None:
    parser.add_argument("--machine", metavar="NAME", help=about)
    parser.offer("machine", machines())
    add_machine_option(parser)


def machine_name(text: str, flag: str) -> str:
    """A machine's name, or the path of a file that describes one; ValueError names the nearest known machine."""
    known = machines()
    if text not in known and not text.lower().endswith(".toml"):
        instead = "riffler nc machines lists all, or give the path of a .toml file that describes yours"
        raise ValueError(f"{flag} {text}: no such machine; {instead}{hint(text, known)}")
    return text


def is_saved(path: Path) -> bool:
    return path.suffix.lower() in PROGRAMS


def read_program(path: Path, machine: str, options: dict[str, Any] | None, console: Console) -> Program:
    """Loads a saved program or reads NC code for the machine; prints the notes of its reader on stderr."""
    program = Program.load(path) if is_saved(path) else Program.read(path, machine=machine, options=options)
    for note in program.notes:
        console.warning(f"{path.name}, line {note.line}: {note.message}")
    return program
