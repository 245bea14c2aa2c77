"""Configures and builds one CMake preset:  tools/preset.py PRESET [TARGET ...]"""

from __future__ import annotations

import sys

from shell import StepError, main, run


def build_preset(preset: str, *targets: str) -> None:
    """Incremental: configuring again costs a second, building what is up to date costs nothing."""
    run("cmake", "--preset", preset, "--log-level=NOTICE")
    run("cmake", "--build", "--preset", preset, *(["--target", *targets] if targets else []))


def entry() -> None:
    if len(sys.argv) < 2:
        raise StepError("usage: preset.py PRESET [TARGET ...]")
    build_preset(*sys.argv[1:])


if __name__ == "__main__":
    main(entry)
