"""Print a script that completes groups, verbs, options, their words and files in a shell.

riffler completion bash > ~/.local/share/bash-completion/completions/riffler
riffler completion zsh > ~/.zfunc/_riffler                        where fpath has ~/.zfunc
riffler completion fish > ~/.config/fish/completions/riffler.fish

The script is self-contained: pressing Tab starts no Python. Print it again after an update of riffler.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass

from . import completion_scripts, verbs
from .console import Console
from .parser import Offer, Parser, Renamed

HELP = "print a completion script for bash, zsh or fish"
SHELLS = {
    "bash": completion_scripts.bash,
    "zsh": completion_scripts.zsh,
    "fish": completion_scripts.fish,
}


@dataclass(frozen=True)
class Value:
    """The value of an option or a positional argument: its metavar and the completions offered for it."""

    name: str
    offer: Offer


@dataclass(frozen=True)
class Option:
    """One option; ``value`` is None for a switch."""

    flags: tuple[str, ...]
    about: str
    value: Value | None
    repeats: bool


@dataclass(frozen=True)
class Entry:
    """One verb as a shell completes it; ``path`` as in ``volume carve``."""

    path: str
    about: str
    options: tuple[Option, ...]
    values: tuple[Value, ...]  # positional arguments


def add_arguments(parser: Parser) -> None:
    parser.add_argument("shell", metavar="SHELL", choices=SHELLS, help=", ".join(SHELLS))


def run(arguments: argparse.Namespace, console: Console) -> int:
    script = SHELLS[arguments.shell](entries(), verbs.GROUPS)
    if console.json_output:
        console.result({"shell": arguments.shell, "script": script}, "", [])
    else:
        sys.stdout.write(script)
    return 0


def entries() -> list[Entry]:
    """Every verb with its options, read from the verbs' parsers."""
    return [entry(verb) for verb in verbs.VERBS]


def entry(verb: verbs.Verb) -> Entry:
    parser = verb.parser()
    options, values = [], []
    for action in parser._actions:
        if isinstance(action, Renamed):
            continue
        if action.option_strings:
            flags = tuple(flag for flag in action.option_strings if flag.startswith("--"))
            value = None if action.nargs == 0 else _value(parser, action)
            about = "show the options" if action.dest == "help" else action.help or ""
            if about is argparse.SUPPRESS:
                about = f"the same as {action.dest.upper()} alone"
            options.append(Option(flags, about, value, isinstance(action, argparse._AppendAction)))
        elif not action.option_strings:
            values.append(_value(parser, action))
    return Entry(verb.path, verb.load().HELP, tuple(options), tuple(values))


def _value(parser: Parser, action: argparse.Action) -> Value:
    offer = parser.offers.get(action.dest, Offer(words=tuple(action.choices or ())))
    name = action.metavar if isinstance(action.metavar, str) else action.dest.upper()
    return Value(name, offer)
