"""Our own wheels, built in place by scikit-build-core in kept directories: a second build compiles only what changed.

python tools/wheel.py FOLDER        riffler's wheel with the shared libraries it needs inside, alone in FOLDER
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import zipfile
from dataclasses import dataclass
from pathlib import Path

import compiler_cache
from shell import PYTHON, ROOT, StepError, digest, is_stamped, main, run, say, tool_environment, write_stamp


@dataclass(frozen=True)
class Distribution:
    """One of our wheels: `project` has its pyproject.toml, `parts` are the folders of native/ that go into it, in
    addition to the core's topics."""

    name: str
    project: Path
    parts: frozenset[str]

    @property
    def folder(self) -> Path:
        return ROOT / "build" / "wheel" / self.name

    @property
    def pattern(self) -> str:
        return f"{self.name.replace('-', '_')}-*.whl"


RIFFLER = Distribution("riffler", ROOT, frozenset({"python", "bindings", "arm_program"}))
BENCH = Distribution("riffler-bench", ROOT / "bench", frozenset({"bindings", "bench", "stress", "reference"}))
# Folders of native/ that are no topics of the core.
BESIDE = frozenset({"arm_program", "tests", "fuzz", "python", "bindings", "bench", "stress", "reference"})
# Every Linux has these; anything else that the module links must lie inside the wheel.
SYSTEM_LIBRARIES = ("linux-vdso.so", "libstdc++.so", "libgcc_s.so", "libc.so", "libm.so", "libz.so", "/lib64/ld-linux",
                    "libpthread.so", "libdl.so", "librt.so")  # fmt: skip


def sources(distribution: Distribution = RIFFLER) -> list[Path]:
    """Every file that the wheel depends on."""
    files = [ROOT / name for name in ("CMakeLists.txt", "pyproject.toml", "README.md", "LICENSE")]
    files += (ROOT / "cmake").rglob("*.cmake*")
    files += (ROOT / "device" / "geometry").glob("*.toml")
    files += (ROOT / "device").rglob("CMakeLists.txt")
    files += (ROOT / "device").rglob("*.[ch]")
    folders = [f for f in (ROOT / "native").iterdir() if f.is_dir() and f.name not in BESIDE - distribution.parts]
    if distribution.project != ROOT:
        folders.append(distribution.project)
    for folder in folders:
        files += (f for f in folder.rglob("*") if f.is_file() and f.suffix not in {".so", ".pyc"})
    return files


def build_wheel(distribution: Distribution = RIFFLER) -> tuple[Path, str]:
    """The wheel of the present sources and the digest that names them."""
    names = ("CC", "CFLAGS", "CXX", "CXXFLAGS", "LDFLAGS", "CMAKE_ARGS")
    flags = [f"{name}={os.environ.get(name, '')}" for name in names]
    requirements = ROOT / "requirements" / "dev.txt"
    key = digest([*sources(distribution), requirements], sys.version, *flags)
    folder = distribution.folder
    stamp = folder / ".stamp"
    wheels = list(folder.glob(distribution.pattern))
    if is_stamped(stamp, key) and len(wheels) == 1:
        return wheels[0], key
    say(f"building {distribution.name}'s wheel")
    stamp.unlink(missing_ok=True)
    for old in wheels:
        old.unlink()
    folder.mkdir(parents=True, exist_ok=True)
    # The PEP 517 hook that pip would call, called directly: the compiler's progress stays visible.
    hook = "import sys; from scikit_build_core.build import build_wheel; build_wheel(sys.argv[1])"
    arguments = " ".join([os.environ.get("CMAKE_ARGS", ""), *compiler_cache.arguments()])
    environment = tool_environment(CMAKE_GENERATOR="Ninja") | {"CMAKE_ARGS": arguments}
    run(PYTHON, "-c", hook, folder, env=environment, cwd=distribution.project)
    wheels = list(folder.glob(distribution.pattern))
    if len(wheels) != 1:
        raise StepError(f"expected one wheel in {folder.relative_to(ROOT)}, found {len(wheels)}")
    write_stamp(stamp, key)
    return wheels[0], key


def repaired_wheel(wheel: Path, folder: Path) -> Path:
    """The wheel as auditwheel leaves it, alone in `folder`: libraries that a system may lack are inside."""
    with tempfile.TemporaryDirectory(dir=wheel.parent) as place:
        run(PYTHON, "-m", "auditwheel", "repair", "--wheel-dir", place, wheel)
        repaired = next(Path(place).glob("riffler-*.whl"))
        check_self_contained(repaired)
        folder.mkdir(parents=True, exist_ok=True)
        for old in folder.glob("riffler-*.whl"):
            old.unlink()
        return repaired.rename(folder / repaired.name)


def check_self_contained(wheel: Path) -> None:
    """StepError if a module or program in the wheel takes a library from outside that a system may lack."""
    with tempfile.TemporaryDirectory() as folder:
        zipfile.ZipFile(wheel).extractall(folder)
        for module in [*Path(folder).rglob("*.so*"), *Path(folder).rglob("riffler-arm")]:
            listing = subprocess.run(["ldd", module], capture_output=True, text=True, check=True).stdout
            for line in listing.splitlines():
                name, _, found = (part.strip() for part in line.partition("=>"))
                if not (name.startswith(SYSTEM_LIBRARIES) or found.startswith(str(Path(folder).resolve()))):
                    raise StepError(f"{wheel.name}: {module.name} needs {name}, which is not inside ({found})")


def entry() -> None:
    if len(sys.argv) != 2:
        raise StepError("usage: wheel.py FOLDER")
    print(repaired_wheel(build_wheel()[0], Path(sys.argv[1])))


if __name__ == "__main__":
    main(entry)
