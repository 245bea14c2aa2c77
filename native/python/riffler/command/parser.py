"""The argument parser of a verb. Inputs may stand alone or after their name; the error for an unknown option names the
nearest known one."""

from __future__ import annotations

import argparse
import difflib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, NoReturn

EPILOG = "lengths in mm, angles on the command line in degrees; exit status 0, 1 (a check failed) or 2 (bad input)"
SIGNED = ("--origin", "--axis", "--stock", "--at")  # options whose value may begin with a minus


class UsageError(ValueError):
    """The command line itself is wrong."""


@dataclass(frozen=True)
class Offer:
    """Completions that a shell offers for a value: files with one of these suffixes, folders, and words."""

    suffixes: tuple[str, ...] = ()
    words: tuple[str, ...] = ()


class Once(argparse.Action):
    """Stores a value that may stand alone or after an option, but only once."""

    def __call__(self, parser: argparse.ArgumentParser, namespace: argparse.Namespace, values: Any,
                 option_string: str | None = None) -> None:  # fmt: skip
        if values is None:
            return  # the positional argument is absent
        before = getattr(namespace, self.dest, None)
        if before is not None:
            parser.error(f"one {self.dest} expected, not both {before} and {values}")
        setattr(namespace, self.dest, values)


class Renamed(argparse.Action):
    """The old name of an option: does the same as the new name, and the parser remembers both names for a note."""

    def __init__(self, option_strings: Sequence[str], dest: str, today: argparse.Action, **more: Any) -> None:
        super().__init__(option_strings, dest, **more)
        self.today = today
        self.new = today.option_strings[0]

    def __call__(self, parser: argparse.ArgumentParser, namespace: argparse.Namespace, values: Any,
                 option_string: str | None = None) -> None:  # fmt: skip
        self.today(parser, namespace, values, option_string)
        if isinstance(parser, Parser) and option_string is not None:
            parser.renamed[option_string] = self.new


class Parser(argparse.ArgumentParser):
    """The arguments of one verb. Raises UsageError instead of printing usage and exiting."""

    def __init__(self, prog: str, description: str | None) -> None:
        super().__init__(
            prog=prog, description=description, epilog=EPILOG, allow_abbrev=False,
            formatter_class=partial(argparse.RawDescriptionHelpFormatter, max_help_position=28),
        )  # fmt: skip
        self.inputs: dict[str, bool] = {}  # name: whether it is required
        self.offers: dict[str, Offer] = {}  # the argument's dest: what to offer
        self.renamed: dict[str, str] = {}  # old names on the command line: new names

    def add_input(self, name: str, help: str, suffixes: Iterable[str] = (), *, flags: Sequence[str] = (),
                  required: bool = True, words: Iterable[str] = ()) -> None:  # fmt: skip
        """Adds a file or device that may stand alone, ``part.ngc``, or after its name, ``--program part.ngc``.
        ``flags`` are further names."""
        named = [f"--{name}", *flags]
        about = f"{help} (or after {', '.join(named)})"
        self.add_argument(name, nargs="?", metavar=name.upper(), action=Once, help=about)
        self.add_argument(*named, dest=name, metavar="FILE", action=Once, help=argparse.SUPPRESS)
        self.inputs[name] = required
        self.offers[name] = Offer(tuple(suffixes), tuple(words))

    def add_file(self, flag: str, help: str, suffixes: Iterable[str] = (), **more: Any) -> None:
        """Adds an option whose value is a file with one of the suffixes."""
        action = self.add_argument(flag, metavar="FILE", help=help, **more)
        self.offers[action.dest] = Offer(tuple(suffixes))

    def add_old_name(self, old: str, today: argparse.Action) -> None:
        """Adds the old name of an option with a value. It still works; neither help nor completion shows it."""
        self.add_argument(
            old, dest=today.dest, action=Renamed, today=today, metavar=today.metavar, default=argparse.SUPPRESS,
            help=argparse.SUPPRESS,
        )  # fmt: skip

    def offer(self, dest: str, words: Iterable[str] = (), suffixes: Iterable[str] = ()) -> None:
        """Sets what shell completion offers for the argument."""
        self.offers[dest] = Offer(tuple(suffixes), tuple(words))

    def parse(self, words: Sequence[str]) -> argparse.Namespace:
        """The arguments; UsageError for an unknown, missing or repeated argument."""
        options = words[: words.index("--")] if "--" in words else words
        for word in options:
            flag = word.partition("=")[0]
            if flag.startswith("--") and flag not in self._option_string_actions:
                self.refuse(flag)
        arguments, more = self.parse_known_intermixed_args(joined(words))
        if more:
            if more[0].startswith("-"):
                self.refuse(more[0])
            self.error(f"{more[0]!r} is one word too many")
        for name, required in self.inputs.items():
            if required and getattr(arguments, name) is None:
                self.error(f"{name.upper()} is missing: a file, alone or after --{name}")
        return arguments

    def refuse(self, flag: str) -> NoReturn:
        """Raises UsageError for an unknown option."""
        near = nearest(flag, self._option_string_actions)
        action = self._option_string_actions.get(near or "")
        near = action.new if isinstance(action, Renamed) else near
        self.error(f"no option {flag}{f'; did you mean {near}?' if near else ''}")

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        """Raises UsageError with the nearest choice if a value is not a choice; called by argparse."""
        if action.choices is not None and value not in action.choices:
            known = list(map(str, action.choices))
            name = action.option_strings[0] if action.option_strings else str(action.metavar)
            self.error(f"{name} {value}: {' or '.join(known)} expected{hint(value, known)}")

    def shorten_usage(self) -> None:
        """Reduces the usage to one line: required arguments, and ``[options]`` for the rest."""
        needed = [name.upper() if must else f"[{name.upper()}]" for name, must in self.inputs.items()]
        for action in self._actions:
            if not action.option_strings and action.dest not in self.inputs:
                needed.append(f"[{action.metavar} ...]")
            elif action.required and action.option_strings:
                needed.append(f"{action.option_strings[0]} {action.metavar}")
        self.usage = " ".join([self.prog, *needed, "[options]"])

    def error(self, message: str) -> NoReturn:
        raise UsageError(f"{message} (see {self.prog} --help)")


def joined(words: Iterable[str]) -> list[str]:
    """``--origin -5,0,0`` as ``--origin=-5,0,0``: argparse takes a value that begins with a minus for an option."""
    out: list[str] = []
    for word in words:
        if out and out[-1] in SIGNED and word[:1] == "-" and word[1:2] in "0123456789.":
            out[-1] += "=" + word
        else:
            out.append(word)
    return out


def hint(word: str, known: Iterable[str]) -> str:
    """``; did you mean …?`` with the nearest known word; empty if none is similar."""
    near = nearest(word, known)
    return f"; did you mean {near}?" if near else ""


def nearest(word: str, known: Iterable[str]) -> str | None:
    """The most similar known word, or None if none is similar."""
    return next(iter(difflib.get_close_matches(word, sorted(known), 1, 0.6)), None)
