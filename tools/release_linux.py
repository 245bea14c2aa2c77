"""Riffler's wheel for every Linux on x86-64 that Blender supports: glibc 2.28, built by tools/zig.py on a newer Linux.

    python tools/release_linux.py        the wheel, checked, in dist/linux

Everything that the core links is inside: libc++, Highway, hidapi, OpenMesh and zlib. Only glibc is the system's.
"""

from __future__ import annotations

import json
import sys
import sysconfig
from pathlib import Path

import pybind11

import libraries
import same_bytes
import symbol_versions
import wheel
import zig
from shell import PYTHON, ROOT, StepError, digest, is_stamped, main, run, say, write_stamp

DIST = ROOT / "dist" / "linux"
GLIBC = (2, 28)
# What the wheel may take from the system: parts of glibc, which are libraries of their own before 2.34.
FROM_SYSTEM = frozenset(
    {"libc.so.6", "libm.so.6", "libpthread.so.0", "libdl.so.2", "librt.so.1", "ld-linux-x86-64.so.2"}
)
TAG = f"manylinux_{GLIBC[0]}_{GLIBC[1]}_x86_64"
# The PEP 517 hook that pip would call, in a build folder of its own.
HOOK = """
import json, sys
from scikit_build_core.build import build_wheel
build_wheel(sys.argv[1], json.loads(sys.argv[2]))
"""


def release_linux() -> Path:
    """The wheel for the Python of .venv."""
    target = zig.LINUX
    zig.prepare(target)
    key = digest([*wheel.sources(), target.toolchain, zig.MATH], sys.version, libraries.build_libraries(target))
    stamp = target.folder / ".wheel"
    made = list(DIST.glob("riffler-*.whl"))
    if is_stamped(stamp, key) and len(made) == 1:
        return made[0]
    say(f"riffler's wheel for {target.triple}")
    folder = target.folder / "dist"
    for old in folder.glob("*.whl"):
        old.unlink()
    DIST.mkdir(parents=True, exist_ok=True)
    folder.mkdir(parents=True, exist_ok=True)
    settings = {"build-dir": str(target.folder / "wheel"), "wheel.platlib": "true"}
    python = [f"-DPython_INCLUDE_DIR={sysconfig.get_path('include')}", f"-Dpybind11_DIR={pybind11.get_cmake_dir()}"]
    definitions = [*zig.arguments(target), "-DRIFFLER_WERROR=OFF", *python]
    environment = zig.environment(target) | {"CMAKE_ARGS": " ".join(definitions)}
    run(PYTHON, "-c", HOOK, folder, json.dumps(settings), env=environment)
    (built,) = folder.glob("riffler-*.whl")
    for old in made:
        old.unlink()
    run(PYTHON, "-m", "auditwheel", "repair", "--plat", TAG, "--wheel-dir", DIST, built)
    (made,) = DIST.glob("riffler-*.whl")
    if faults := symbol_versions.faults(made, GLIBC, FROM_SYSTEM):
        made.unlink()
        raise StepError(f"{made.name}:\n" + "\n".join(faults))
    try:
        agreeing = same_bytes.compare(made)
    except StepError:
        made.unlink()
        raise
    say(f"{made.name}: {agreeing} results agree to the byte with those of .venv's riffler")
    write_stamp(stamp, key)
    return made


def entry() -> None:
    if len(sys.argv) != 1:
        raise StepError("usage: release_linux.py")
    made = release_linux()
    print(f"{made.stat().st_size:>12,} bytes  {made.relative_to(ROOT)}")


if __name__ == "__main__":
    main(entry)
