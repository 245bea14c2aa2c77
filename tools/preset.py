"""Configures and builds one CMake preset, and runs its C++ tests:

tools/preset.py PRESET [TARGET ...]
tools/preset.py PRESET --test
"""

from __future__ import annotations

import json
import sys

import compiler_cache
import costs
import gtest_batches
from shell import ROOT, StepError, cores, main, run, say

SLOWEST = 20


def build_preset(preset: str, *targets: str) -> None:
    """Incremental: configuring again costs a second, building what is up to date costs nothing."""
    run("cmake", "--preset", preset, "--log-level=NOTICE", *compiler_cache.arguments())
    run("cmake", "--build", "--preset", preset, *(["--target", *targets] if targets else []))


def test_preset(preset: str, budget: float | None = None) -> None:
    """Every C++ test, in a process for every few of them: to start and to end one takes longer than most tests.
    `budget`: without the costliest, so that the others take so many seconds of processor time."""
    build_preset(preset, "riffler_tests")
    program = ROOT / "build" / preset / "native" / "tests" / "riffler_tests"
    left = [] if budget is None else costs.too_costly(preset, budget)
    try:
        times = gtest_batches.run_tests(program, left_out(preset), left)
        print_slowest(preset, times)
        if budget is None:
            costs.record(preset, {name: seconds for seconds, name in times})
    finally:  # a program of its own, in a wrapper that CMake knows
        run("ctest", "--preset", preset, "--tests-regex", "^StockHidapi", "--parallel", str(cores()))


def left_out(preset: str) -> str:
    """The tests that a preset leaves out, as an expression."""
    presets = json.loads((ROOT / "CMakePresets.json").read_text())["testPresets"]
    of_it = next(entry for entry in presets if entry["name"] == preset)
    return of_it.get("filter", {}).get("exclude", {}).get("name", "")


def print_slowest(what: str, times: list[tuple[float, str]]) -> None:
    """The tests to look at first where the whole is too slow: seconds and name of each."""
    say(f"{what}: the costliest of {len(times)} tests, which took {sum(t for t, _ in times):.0f} s of processor time")
    for seconds, name in sorted(times, reverse=True)[:SLOWEST]:
        print(f"  {seconds:7.2f} s  {name}")


def entry() -> None:
    match sys.argv[1:]:
        case [preset, "--test"]:
            test_preset(preset)
        case [preset, *targets]:
            build_preset(preset, *targets)
        case _:
            raise StepError("usage: preset.py PRESET [TARGET ...] | PRESET --test")


if __name__ == "__main__":
    main(entry)
