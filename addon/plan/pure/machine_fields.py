"""What riffler.machine_options says of a machine, as fields of a panel: their names, and values that go either way."""

from __future__ import annotations

import json
import re
from functools import lru_cache

import riffler

from ...common import units

ABBREVIATIONS = {"tcp": "TCP"}


def identifier(name: str) -> str:
    """What Blender can call an option of that name."""
    return re.sub(r"\W", "_", name, flags=re.ASCII)


def machine_identifier(name: str) -> str:
    """What Blender can call a machine of that name: “tcp-bc” is another one than “tcp_bc”."""
    return identifier(name.replace("_", "__"))


def label(fact: dict) -> str:
    """“Max Rotary (deg/min)”."""
    words = ABBREVIATIONS.get(fact["name"], fact["name"].replace("_", " ").title())
    return f"{words} ({fact['unit']})" if fact["unit"] else words


def about(fact: dict) -> str:
    """As a tooltip: Blender puts the stop."""
    text = fact["about"]
    return text[:1].upper() + text[1:]


def value(fact: dict, found):
    """Of an option, as it is given to riffler, from what a field has."""
    if fact["kind"] in ("flag", "word"):
        return found
    return [units.clean(x) for x in found] if fact["count"] > 1 else units.clean(found)


@lru_cache(maxsize=64)
def _facts(machine: str, given: str) -> tuple[dict, ...]:
    return tuple(riffler.machine_options(machine, json.loads(given)))


def facts(machine: str, given: dict | None = None) -> tuple[dict, ...]:
    """riffler.machine_options, kept: panels ask whenever they are drawn. ValueError for options that are wrong."""
    return _facts(machine, json.dumps(given or {}, sort_keys=True))


def missing(machine: str, given: dict) -> list[dict]:
    """Options that must be given, and are not."""
    return [fact for fact in facts(machine, given) if fact["needed"] and fact["name"] not in given]


def check(machine: str, given: dict) -> None:
    """ValueError that names what must be given, and where."""
    for fact in missing(machine, given):
        place = ", or take the place of the 3D cursor there" if fact["count"] == 3 else ""
        raise ValueError(f"{machine}: {label(fact)} is not set, {fact['about']}: set it in the panel Machine{place}")
