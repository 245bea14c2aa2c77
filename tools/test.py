"""Runs the test suites one after the other, all of them even if one fails; closes with a table of results and times.

tools/test.py [cpp python docs blender]      (all without arguments)
"""

from __future__ import annotations

import os
import sys
import time

import package
from preset import test_preset
from shell import PYTHON, StepError, main, run, say


def cpp() -> None:
    test_preset("release")


def python() -> None:
    processes = min(4, len(os.sched_getaffinity(0)))  # many of them use all cores themselves
    run(PYTHON, "-m", "pytest", "-n", str(processes), "--dist", "loadfile", "native/tests/python")


def docs() -> None:
    run(PYTHON, "tools/check_docs.py")
    run(PYTHON, "tools/docs.py")


def blender() -> None:
    """What is tested is what goes out: the zips with the repaired wheel."""
    made = package.package()
    wheel = next(path for path in made if path.suffix == ".whl" and package.of_this_python(path))
    run(PYTHON, "blender_tests/run.py", "--wheel", wheel, "--zips", package.DIST)


SUITES = {"cpp": cpp, "python": python, "docs": docs, "blender": blender}


def entry() -> None:
    names = sys.argv[1:] or list(SUITES)
    if unknown := set(names) - set(SUITES):
        raise StepError(f"unknown suite {sorted(unknown)[0]!r}; there are {', '.join(SUITES)}")
    rows = []
    for name in names:
        say(f"tests: {name}")
        start = time.monotonic()
        try:
            SUITES[name]()
            result = "passed"
        except StepError as failure:
            print(failure, file=sys.stderr, flush=True)
            result = "FAILED"
        rows.append((name, result, time.monotonic() - start))
    say("tests: results")
    for name, result, seconds in rows:
        print(f"{name:<10} {result:<8} {seconds:7.1f} s")
    print(f"{'total':<19} {sum(row[2] for row in rows):7.1f} s", flush=True)
    if any(result == "FAILED" for _, result, _ in rows):
        sys.exit(1)


if __name__ == "__main__":
    main(entry)
