"""Options from riffler.machine_options as fields of a panel: names, and conversions of values in both directions."""

from __future__ import annotations

import json
import re
from functools import lru_cache

import riffler

from ...common import units

ABBREVIATIONS = {"tcp": "TCP"}


def identifier(name: str) -> str:
    """A valid Blender identifier for an option of that name."""
    return re.sub(r"\W", "_", name, flags=re.ASCII)


def machine_identifier(name: str) -> str:
    """A valid Blender identifier for a machine of that name: “tcp-bc” and “tcp_bc” differ."""
    return identifier(name.replace("_", "__"))


def label(fact: dict) -> str:
    """“Max Rotary (deg/min)”."""
    words = ABBREVIATIONS.get(fact.name, fact.name.replace("_", " ").title())
    return f"{words} ({fact.unit})" if fact.unit else words


def about(fact: dict) -> str:
    """The tooltip: Blender adds the full stop."""
    text = fact.about
    return text[:1].upper() + text[1:]


def value(fact: dict, found):
    """An option's value for riffler, from its field's value."""
    if fact.kind in ("flag", "word"):
        return found
    return [units.clean(x) for x in found] if fact.count > 1 else units.clean(found)


@lru_cache(maxsize=64)
def _facts(machine: str, given: str) -> tuple[dict, ...]:
    return tuple(riffler.machine_options(machine, options=json.loads(given)))


def facts(machine: str, given: dict | None = None) -> tuple[dict, ...]:
    """riffler.machine_options, cached, since panels call it at every drawing. ValueError for wrong options."""
    return _facts(machine, json.dumps(given or {}, sort_keys=True))


def missing(machine: str, given: dict) -> list[dict]:
    """Required options that are not set."""
    return [fact for fact in facts(machine, given) if fact.needed and fact.name not in given]


def check(machine: str, given: dict) -> None:
    """ValueError that names the missing option, and where to set it."""
    for fact in missing(machine, given):
        place = ", or take the place of the 3D cursor there" if fact.count == 3 else ""
        raise ValueError(f"{machine}: {label(fact)} is not set, {fact.about}: set it in the panel Machine{place}")
