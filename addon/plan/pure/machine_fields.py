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
    return _with_unit(ABBREVIATIONS.get(fact.name, fact.name.replace("_", " ").title()), fact.unit)


def _with_unit(words: str, unit: str) -> str:
    return f"{words} ({unit})" if unit else words


def about(fact: dict) -> str:
    """The tooltip: Blender adds the full stop."""
    return _capital(fact.about)


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]


def value(fact: dict, found):
    """An option's value for riffler, from its field's value."""
    if fact.kind in ("flag", "word"):
        return found
    return [units.clean(x) for x in found] if fact.count > 1 else units.clean(found)


def translations() -> dict[str, dict[str, str]]:
    """By language code: shown texts to translations, from the machines' files."""
    found: dict[str, dict[str, str]] = {}
    for machine in riffler.machines():
        try:
            texts, listed = riffler.machine_texts(machine), facts(machine)
        except ValueError:
            continue  # a user's file that cannot be read; using that machine reports the error
        for language, own in texts.translations.items():
            table = found.setdefault(language, {})
            if texts.description in own:
                table[texts.description] = own[texts.description]
            for fact in listed:
                if fact.own and fact.name in own:
                    table[label(fact)] = _with_unit(own[fact.name], fact.unit)
                if fact.own and fact.about in own:
                    table[about(fact)] = _capital(own[fact.about])
    return found


def extension(machine: str) -> str:
    """The usual extension of a machine's files; ".ngc" for a file that cannot be read."""
    try:
        return riffler.machine_texts(machine).extension
    except ValueError:
        return ".ngc"


def file_filter(others: str) -> str:
    """Patterns of a file selector: files of all machines, and others."""
    return ";".join([*dict.fromkeys(f"*{extension(machine)}" for machine in riffler.machines()), others])


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
