"""The table of verbs: their groups, their modules, and their old names from before there were groups."""

from __future__ import annotations

import argparse
import importlib
import textwrap
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, NoReturn, Protocol

from ..formats import MESHES, PARTS, VOLUMES
from ..plan import STRATEGIES
from .console import Console
from .parser import EPILOG, Parser, UsageError, nearest

GROUPS = {
    "mesh": "triangle meshes: files of .stl, .obj, .ply and .3mf, and CAD files",
    "volume": "dexel volumes: make stock, carve it, mesh it",
    "plan": "tool paths on a part, by a strategy, an operation or a recording",
    "nc": "NC programs: write and check them; list machines and tools",
    "pen": "pens and other devices",
}
HELP = ("-h", "--help")


class Command(Protocol):
    """Members of a verb's module."""

    HELP: str  # one line
    __doc__: str | None

    def add_arguments(self, parser: Parser) -> None: ...

    def run(self, arguments: argparse.Namespace, console: Console) -> int: ...


@dataclass(frozen=True)
class Verb:
    """One verb. ``group`` is empty for one that stands alone; ``old``: its name before there were groups."""

    group: str
    name: str
    load: Callable[[], Any]  # a Command
    old: str = ""

    @property
    def path(self) -> str:
        """``volume carve``."""
        return f"{self.group} {self.name}".strip()

    def parser(self) -> Parser:
        command: Command = self.load()
        parser = Parser(f"riffler {self.path}", command.__doc__)
        command.add_arguments(parser)
        parser.add_argument("--json", action="store_true", help="print the result, or the error, as JSON")
        parser.shorten_usage()
        return parser

    def run(self, words: list[str], console: Console) -> int:
        """Runs the verb with the words after its name; returns its exit status. Notes old option names on stderr."""
        parser = self.parser()
        arguments = parser.parse(words)
        for old, new in parser.renamed.items():
            console.warning(f"riffler {self.path} {old} is an old name of {new}")
        return self.load().run(arguments, console)


def _module(name: str) -> Callable[[], Any]:
    return partial(importlib.import_module, f"{__package__}.{name}")


def _strategy(name: str) -> Any:
    from .plan_strategies import StrategyCommand

    return StrategyCommand(STRATEGIES[name])


VERBS = (
    Verb("mesh", "audit", _module("mesh_audit"), "audit"),
    Verb("mesh", "convert", _module("mesh_convert")),
    Verb("mesh", "decimate", _module("mesh_decimate")),
    Verb("volume", "from-mesh", _module("volume_from_mesh"), "convert"),
    Verb("volume", "carve", _module("volume_carve"), "carve"),
    Verb("volume", "replay", _module("volume_replay"), "replay"),
    Verb("volume", "to-mesh", _module("volume_to_mesh"), "mesh"),
    *(Verb("plan", name, partial(_strategy, name), "pencil" if name == "pencil" else "") for name in STRATEGIES),
    Verb("plan", "rough", _module("plan_rough")),
    Verb("plan", "finish", _module("plan_finish")),
    Verb("plan", "outline", _module("plan_outline")),
    Verb("plan", "drill", _module("plan_drill")),
    Verb("plan", "from-recording", _module("plan_from_recording")),
    Verb("nc", "post", _module("nc_post"), "post"),
    Verb("nc", "verify", _module("nc_verify"), "verify"),
    Verb("nc", "machines", _module("nc_machines"), "machines"),
    Verb("nc", "tools", _module("nc_tools")),
    Verb("pen", "list", _module("pen_list")),
    Verb("pen", "monitor", _module("pen_monitor")),
    Verb("pen", "calibrate", _module("pen_calibrate")),
    Verb("pen", "identify", _module("pen_identify")),
    Verb("pen", "simulate", _module("pen_simulate")),
    Verb("", "job", _module("job")),
    Verb("", "doctor", _module("doctor")),
    Verb("", "bench", _module("bench")),
    Verb("", "completion", _module("completion")),
)
ALONE = {verb.name: verb for verb in VERBS if not verb.group}
OLD = {verb.old: verb for verb in VERBS if verb.old}


def of(group: str) -> dict[str, Verb]:
    """The verbs of a group, by name."""
    return {verb.name: verb for verb in VERBS if verb.group == group}


@dataclass(frozen=True)
class Found:
    """The verb of a command line, the words after it, and its old name if the command line used that. Without a verb,
    ``help`` is the requested help text."""

    verb: Verb | None
    rest: list[str]
    old: str = ""
    help: str = ""


def find(words: list[str]) -> Found:
    """Splits the verb from a command line. UsageError names the nearest verb for an unknown one."""
    if words[:1] == ["help"]:
        words = [*words[1:], "--help"]
    if not words:
        raise UsageError(f"a command expected: {', '.join([*GROUPS, *ALONE])} (see riffler --help)")
    first, rest = words[0], words[1:]
    if first in HELP:
        return Found(None, [], help=overview())
    if first in ALONE:
        return Found(ALONE[first], rest)
    if first == "convert" and _is_mesh_conversion(rest):
        return Found(of("mesh")["convert"], rest)
    if first in OLD and (first not in GROUPS or _is_old_mesh(rest)):
        return Found(OLD[first], rest, first)
    if first not in GROUPS:
        _refuse(first, "")
    if not rest:
        raise UsageError(f"a verb expected: {', '.join(of(first))} (see riffler {first} --help)")
    if rest[0] in HELP:
        return Found(None, [], help=overview_of(first))
    if rest[0] not in of(first):
        _refuse(rest[0], first)
    return Found(of(first)[rest[0]], rest[1:])


def _is_mesh_conversion(rest: list[str]) -> bool:
    """Whether ``riffler convert part.step part.stl`` is meant, not the old ``riffler convert part.stl --out x.rvol``:
    whether the last file is a mesh."""
    files = [word for word in rest if word.lower().endswith(PARTS + VOLUMES)]
    return len(files) > 1 and files[-1].lower().endswith(MESHES)


def _is_old_mesh(rest: list[str]) -> bool:
    """Whether the words after ``mesh`` have the old form, ``riffler mesh part.rvol --out part.stl``: a file or an
    option comes first, not a verb."""
    if not rest or rest[0] in of("mesh") or rest[0] in HELP:
        return False
    return rest[0].startswith("-") or rest[0].lower().endswith(PARTS + VOLUMES) or "." in rest[0]


def _refuse(word: str, group: str) -> NoReturn:
    """Raises UsageError for an unknown verb, with the nearest one of the group, or else of all."""
    where = f"riffler {group}".strip()
    if word.startswith("-"):
        raise UsageError(
            f"{word}: the command comes first, then its options, as in riffler doctor --json (see {where} --help)"
        )
    paths = {verb.path: verb for verb in VERBS}
    near = nearest(word, of(group)) if group else nearest(word, [*GROUPS, *ALONE])
    if near is not None:
        near = f"{group} {near}".strip()
    else:
        names = {verb.name: path for path, verb in paths.items()} | {verb.old: verb.path for verb in OLD.values()}
        near = names.get(nearest(word, names) or "")
    more = f"; did you mean riffler {near}?" if near else ""
    raise UsageError(f"{where} has no {'verb' if group else 'command'} {word!r}{more} (see {where} --help)")


def overview() -> str:
    """The help of ``riffler`` itself."""
    lines: list[str] = [
        "usage: riffler GROUP VERB [options]",
        "",
        "Dexel volumes, carving, five-axis programs and pens.",
        "",
    ]
    for group, about in GROUPS.items():
        lines += [
            f"  {group:<12}{about}",
            *(f"  {'':<12}{line}" for line in textwrap.wrap(", ".join(of(group)), 66, break_on_hyphens=False)),
        ]
    lines += [f"  {name:<12}{verb.load().HELP}" for name, verb in ALONE.items()]
    lines += ["", "riffler GROUP --help and riffler GROUP VERB --help show more.", *_epilog()]
    return "\n".join(lines)


def overview_of(group: str) -> str:
    """The help of a group."""
    lines: list[str] = [
        f"usage: riffler {group} VERB [options]",
        "",
        f"{GROUPS[group][:1].upper()}{GROUPS[group][1:]}.",
        "",
    ]
    width = max(12, *(len(name) + 2 for name in of(group)))
    lines += [f"  {name:<{width}}{verb.load().HELP}" for name, verb in of(group).items()]
    return "\n".join([*lines, "", f"riffler {group} VERB --help shows the options.", *_epilog()])


def _epilog() -> list[str]:
    lengths, _, statuses = EPILOG.partition("; ")
    return [f"{lengths};", statuses]
