"""The compiler cache that all checkouts of a user share: what the wheel, the tests and the benchmarks have in common is
compiled once, and a second checkout compiles nothing that the first one has compiled.

It lies in the user's cache folder, at most 2 GB large; CCACHE_DIR and CCACHE_MAXSIZE choose another folder and size.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import tempfile
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
STATISTICS = ROOT / "build" / "ccache-statistics.log"
SIZE = "2G"


def user_caches() -> Path:
    """The user's folder for caches."""
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")


def folder() -> Path:
    """Where compiled objects are kept."""
    chosen = os.environ.get("CCACHE_DIR")
    return Path(chosen) if chosen else user_caches() / "riffler" / "ccache"


@cache
def problem() -> str:
    """Why nothing is cached on this machine, or nothing."""
    for program, package in (("ccache", "ccache"), ("c++", "g++"), ("cc", "gcc")):
        if not shutil.which(program):
            return f"there is no `{program}` (Debian: {package})"
    try:
        folder().mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder()) as file:
            file.write(bytes(1 << 20))  # as large as the larger objects
            file.flush()
    except OSError as error:
        return f"{folder()}: {error.strerror}; CCACHE_DIR chooses another folder"
    return ""


def environment() -> dict[str, str]:
    """Variables for CMake and ccache. ccache takes one compiler under two names for two: CMake looks for c++,
    scikit-build-core for the name that Python was built with. Paths under the checkout count as relative ones, so that
    the checkout's own path is in no key."""
    if problem():
        return {"CCACHE_DISABLE": "1"}
    return ({} if os.environ.get("CCACHE_DIR") else {"CCACHE_MAXSIZE": SIZE}) | {
        "CC": "cc",
        "CXX": "c++",
        "CCACHE_DIR": str(folder()),
        "CCACHE_BASEDIR": str(ROOT),
        "CCACHE_NOHASHDIR": "1",
        # What ccache asks for before it follows precompiled headers, which the bindings have.
        "CCACHE_SLOPPINESS": "pch_defines,time_macros",
        "CCACHE_STATSLOG": str(STATISTICS),
    }


def arguments() -> list[str]:
    """For CMake: what starts the compiler. Said each time, for a build folder remembers a ccache that has gone."""
    launcher = "" if problem() else "ccache"
    return [f"-DCMAKE_{language}_COMPILER_LAUNCHER={launcher}" for language in ("C", "CXX")]


def report() -> str:
    """Hits and misses since the last report, one line."""
    if problem():
        return f"compiler cache: none, {problem()}"
    if not STATISTICS.is_file():
        return "compiler cache: nothing was compiled"
    text = subprocess.run(
        ["ccache", "--show-log-stats"], env=os.environ | environment(), capture_output=True, text=True, check=False
    ).stdout
    STATISTICS.unlink()
    hits, calls = counts(text)
    return f"compiler cache: {hits} of {calls} compilations found ({hits / max(calls, 1):.1%}), {folder()}"


def counts(text: str) -> tuple[int, int]:
    """Hits, and all calls that could be cached or could not, of what ccache prints."""
    numbers = {}
    for name in ("Hits", "Misses", "Uncacheable calls"):
        found = re.search(rf"^\s*{name}:\s+(\d+)", text, re.MULTILINE)
        numbers[name] = int(found[1]) if found else 0
    return numbers["Hits"], sum(numbers.values())
