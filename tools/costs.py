"""What each test cost at the last complete run of its suite, in processor time; what a quick run leaves out by that."""

from __future__ import annotations

import json
from pathlib import Path

from shell import ROOT, say

FOLDER = ROOT / "build" / "tests" / "costs"


def file_of(suite: str) -> Path:
    return FOLDER / f"{suite}.json"


def record(suite: str, seconds: dict[str, float]) -> None:
    FOLDER.mkdir(parents=True, exist_ok=True)
    file_of(suite).write_text(json.dumps(seconds, indent=0) + "\n")


def known(suite: str) -> dict[str, float]:
    """By name; empty before the first complete run, or if the file is damaged."""
    try:
        found = json.loads(file_of(suite).read_text())
        return {str(name): float(seconds) for name, seconds in found.items()}
    except (OSError, ValueError, AttributeError, TypeError):
        return {}


def costliest(seconds: dict[str, float], budget: float) -> list[str]:
    """The fewest tests without which the others cost at most `budget`."""
    total, left = sum(seconds.values()), []
    for name in sorted(seconds, key=seconds.__getitem__, reverse=True):
        if total <= budget:
            break
        left.append(name)
        total -= seconds[name]
    return left


def too_costly(suite: str, budget: float) -> list[str]:
    """The tests that a quick run of a suite leaves out, which it reports."""
    seconds = known(suite)
    names = costliest(seconds, budget)
    if not seconds:
        say(f"{suite}: no complete run yet, so every test runs")
    else:
        without, whole = sum(seconds[name] for name in names), sum(seconds.values())
        say(f"{suite}: {len(names)} of {len(seconds)} tests left out, which cost {without:.0f} of {whole:.0f} s")
    return names
