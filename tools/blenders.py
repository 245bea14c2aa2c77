"""Blenders newer than the system's, in a window and without: Debian's own in chroots (tools/chroot.py), each with a
wheel built there for its Python.

    python tools/blenders.py                 makes the chroots, the wheels, one zip of all, and runs the tests in each
    python tools/blenders.py trixie          in this one only
    python tools/blenders.py --wheels        only the wheels: build/wheels/<suite>
"""

from __future__ import annotations

import argparse
import os
import shutil
import sys
import sysconfig
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import package
import system
import wheel
from chroot import Chroot, impossible
from new_glibc import teach
from shell import ROOT, VENV, StepError, digest, is_stamped, main, say, write_stamp

# Everything that builds riffler, Blender, and what its window and its extensions need: Debian does not insist on all
# that Blender's own Python code imports.
PACKAGES = (
    *sorted({need.package for need in (*system.BUILD, *system.BLENDER_WINDOW)}),
    *("cmake", "ninja-build", "patchelf", "python3-requests", "python3-zstandard"),
)
CHROOTS = [
    Chroot("trixie", PACKAGES),
    # It moves on every day; a copy of it stands still, and Blender 5 has one more package that it does not insist on.
    Chroot("sid", (*PACKAGES, "python3-cattr"), frozen_release=True),
]
# Rolling releases may stop working any day: the run prints the reason and continues with the others.
BEST_EFFORT = {"sid"}
# Tools without machine code, of the versions that .venv has: no index is asked from within.
LENT = ("auditwheel", "elftools", "pyelftools", "packaging", "pathspec", "pybind11", "scikit_build_core")


@dataclass
class Row:
    """What became of one chroot: a result for each step, with its seconds."""

    place: Chroot
    steps: dict[str, float] = field(default_factory=dict)
    result: str = ""
    reason: str = ""

    @contextmanager
    def step(self, what: str) -> Iterator[None]:
        """One step, with the chroot held. What goes wrong in it is the row's result."""
        begin = time.monotonic()
        try:
            with self.place.held():
                yield
        except StepError as failure:
            gentle = self.place.suite in BEST_EFFORT and what != "tests"
            self.result, self.reason = "skipped" if gentle else "FAILED", f"{what}: {failure}"
            print(failure, file=sys.stderr, flush=True)
        self.steps[what] = time.monotonic() - begin

    def print(self) -> None:
        times = ", ".join(f"{what} {seconds:.0f} s" for what, seconds in self.steps.items())
        print(
            f"{self.place.suite:<10} {self.result:<8} {times}" + (f"\n           {self.reason}" if self.reason else "")
        )


def files() -> list[Path]:
    """What goes into a chroot: all that the wheel, the zips and the tests are made of, and what the tests read."""
    listed = [*wheel.sources(), *(ROOT / "tools").glob("*.py"), *(ROOT / "requirements").glob("*.txt")]
    listed += (ROOT / "docs").glob("*.md")
    for folder in ("addon", "blender_tests"):
        listed += (f for f in (ROOT / folder).rglob("*") if f.is_file() and f.suffix != ".pyc")
    return listed


def build(place: Chroot) -> None:
    """The wheel for the Python in there: build/wheels/<suite>."""
    out = package.OTHERS / place.suite
    key, made_in = package.key(), digest([], place.identity())
    if is_stamped(out / package.STAMP, key) and is_stamped(out / ".place", made_in):
        return
    say(f"{place.suite}: riffler's wheel")
    shutil.rmtree(out, ignore_errors=True)
    place.put(files())
    lend(place)
    # Warnings of compilers that the project has not been built with before are not errors.
    settings = {"CMAKE_ARGS": "-DRIFFLER_WERROR=OFF"}
    settings |= {k: os.environ[k] for k in ("CMAKE_BUILD_PARALLEL_LEVEL",) if k in os.environ}
    place.run(".venv/bin/python", "tools/wheel.py", "build/repaired", **settings)
    out.mkdir(parents=True)
    for path in (place.project / "build" / "repaired").glob("riffler-*.whl"):
        shutil.copy(path, out)
    write_stamp(out / ".place", made_in)
    write_stamp(out / package.STAMP, key)


def lend(place: Chroot) -> None:
    """A .venv in there as the tools expect it, with the build tools of ours in it."""
    place.run("python3", "-m", "venv", "--system-site-packages", "--without-pip", "--clear", ".venv")
    packages = Path(next((place.project / ".venv" / "lib").glob("python3*/site-packages")))
    ours = VENV / Path(sysconfig.get_path("purelib")).relative_to(sys.prefix)
    for path in ours.iterdir():
        if path.name.partition("-")[0].lower() in LENT:
            shutil.copytree(path, packages / path.name, ignore=shutil.ignore_patterns("__pycache__"))
    if name := teach(packages / "auditwheel", place.root / "usr" / "lib" / "x86_64-linux-gnu"):
        say(f"{place.suite}: its glibc is newer than auditwheel knows: {name}")


def test(place: Chroot, more: list[str]) -> None:
    """The Blender tests in there, with the zips of ./dist; pictures and what the tests wrote: out/blender/<suite>."""
    place.put(files())
    dist, pictures = place.project / "dist", place.project / "out" / "blender"
    for folder in (dist, pictures):
        shutil.rmtree(folder, ignore_errors=True)
    dist.mkdir()
    for path in [*package.DIST.glob("riffler-*.zip"), *(package.OTHERS / place.suite).glob("riffler-*.whl")]:
        shutil.copy(path, dist)
    own = next(dist.glob("*.whl")).relative_to(place.project)
    words = ["--blender", "blender", "--wheel", own, "--zips", dist.relative_to(place.project), *more]
    try:
        place.run("python3", "blender_tests/run.py", *words)
    finally:
        target = ROOT / "out" / "blender" / place.suite
        shutil.rmtree(target, ignore_errors=True)
        if pictures.exists():
            shutil.copytree(pictures, target)


def entry() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("suites", nargs="*", help="of " + ", ".join(c.suite for c in CHROOTS))
    parser.add_argument("--wheels", action="store_true", help="build, test nothing")
    arguments, more = parser.parse_known_args()
    if unknown := set(arguments.suites) - {c.suite for c in CHROOTS}:
        raise StepError(f"unknown release {sorted(unknown)[0]!r}; there are {', '.join(c.suite for c in CHROOTS)}")
    if not impossible():
        system.require(system.CHROOTS)
    rows = [Row(place) for place in CHROOTS if not arguments.suites or place.suite in arguments.suites]
    for row in rows:
        if reason := impossible():
            row.result, row.reason = "skipped", reason
            continue
        with row.step("chroot"):
            row.place.make()
        if not row.result:
            with row.step("wheel"):
                build(row.place)
    left = [row for row in rows if not row.result]
    if left:
        package.package()
    for row in left:
        if not arguments.wheels:
            say(f"{row.place.suite}: tests in its Blender")
            with row.step("tests"):
                test(row.place, more)
        row.result = row.result or ("built" if arguments.wheels else "passed")
    say("newer Blenders: results")
    for row in rows:
        row.print()
    if any(row.result == "FAILED" for row in rows):
        sys.exit(1)


if __name__ == "__main__":
    main(entry)
