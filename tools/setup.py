"""Makes this checkout ready to work in: system libraries, ./.venv with pinned packages, riffler built and installed.

    python3 tools/setup.py             what `make setup` does
    python3 tools/setup.py demo        and one Blender as a Python module, and LinuxCNC's interpreter, in ./.envs
    python3 tools/setup.py test        and every Blender, and what the tests need from the system
    python3 tools/setup.py bench       and what the benchmarks need from the system, and the rivals' libraries

Every step is done again only if what it depends on changed or if it was interrupted.
"""

from __future__ import annotations

import fcntl
import sys
from concurrent.futures import ThreadPoolExecutor

import system
from environments import (
    blender_environment,
    blender_versions,
    docs_environment,
    install_wheel,
    make_environment,
    rivals_environment,
)
from linuxcnc import linuxcnc
from shell import ROOT, VENV, StepError, main, run, say
from wheel import BENCH, build_wheel

DEMO_BLENDER = "4.5"
EXTRA_NEEDS = {
    "build": [],
    "demo": system.BLENDER_MODULE + system.LINUXCNC,
    "test": system.CPP_TESTS + system.BLENDER_MODULE + system.BLENDER_WINDOW + system.LINUXCNC,
    "cpp-tests": system.CPP_TESTS,
    "bench": system.BENCH,
}


def setup(purpose: str) -> None:
    if sys.version_info < (3, 11):  # noqa: UP036 (an older one may well be what runs this)
        raise StepError(f"Python 3.11 or later is needed, this is {sys.version.split()[0]}")
    system.require(system.BUILD + EXTRA_NEEDS[purpose])
    make_environment(VENV, ROOT / "requirements" / "dev.txt")
    versions = {"demo": [DEMO_BLENDER], "test": blender_versions()}.get(purpose, [])
    with ThreadPoolExecutor(1) as background:
        # Packages are unpacked while the compiler is busy.
        others = background.submit(other_environments, purpose, versions)
        wheel, key = build_wheel()
        install_wheel(VENV, wheel, key)
        install_wheel(VENV, *build_wheel(BENCH))
        others.result()
    for version in versions:
        install_wheel(blender_environment(version), wheel, key)


def other_environments(purpose: str, versions: list[str]) -> None:
    """What is in .envs, as far as it does not depend on our own wheel."""
    for version in versions:
        blender_environment(version)
    if purpose == "test":
        docs_environment()
    if purpose in ("test", "demo"):
        linuxcnc()
    if purpose == "bench":
        rivals_environment()


def entry() -> None:
    purpose = sys.argv[1] if len(sys.argv) > 1 else "build"
    if len(sys.argv) > 2 or purpose not in EXTRA_NEEDS:
        raise StepError(f"usage: setup.py [{'|'.join(EXTRA_NEEDS)}]")
    lock = ROOT / "build" / ".setup-lock"
    lock.parent.mkdir(exist_ok=True)
    with lock.open("w") as handle:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            say("waiting for another setup of this checkout")
            fcntl.flock(handle, fcntl.LOCK_EX)
        setup(purpose)
    if purpose == "build":
        run(VENV / "bin" / "python", "-c", "import riffler; print('riffler', riffler.__version__, 'is ready in .venv')")


if __name__ == "__main__":
    main(entry)
