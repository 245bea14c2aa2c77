"""Configures and builds one CMake preset, and runs its C++ tests:

tools/preset.py PRESET [TARGET ...]
tools/preset.py PRESET --test
"""

from __future__ import annotations

import os
import sys

from shell import StepError, main, run


def build_preset(preset: str, *targets: str) -> None:
    """Incremental: configuring again costs a second, building what is up to date costs nothing."""
    run("cmake", "--preset", preset, "--log-level=NOTICE")
    run("cmake", "--build", "--preset", preset, *(["--target", *targets] if targets else []))


def test_preset(preset: str) -> None:
    """Every C++ test in a process of its own, as many at once as there are cores."""
    build_preset(preset, "riffler_tests")
    run("ctest", "--preset", preset, "--parallel", str(len(os.sched_getaffinity(0))))


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
