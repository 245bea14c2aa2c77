"""Python environments with pinned packages: ./.venv for the work, ./.envs/bpy-X.Y for each Blender, ./.envs/rivals,
./.envs/docs for the documents' site, ./.envs/types for the type checker."""

from __future__ import annotations

import importlib.util
import os
import shutil
import sys
from pathlib import Path

import environment_cache
from shell import ROOT, StepError, digest, is_stamped, run, say, tool_environment, write_stamp

REQUIREMENTS = ROOT / "requirements"
# Blender publishes its module on its own index too; asked only where the default index lacks it.
BLENDER_INDEX = "https://download.blender.org/pypi/"
STAMP = ".riffler-packages"
UNFINISHED = ".riffler-unfinished"


def blender_versions() -> list[str]:
    """The Blender versions that have an environment, by requirements/bpy-X.Y.txt."""
    return sorted(path.stem.removeprefix("bpy-") for path in REQUIREMENTS.glob("bpy-*.txt"))


def blender_environment(version: str) -> Path:
    """./.envs/bpy-X.Y, made or brought up to date."""
    requirements = REQUIREMENTS / f"bpy-{version}.txt"
    if not requirements.is_file():
        raise StepError(f"no requirements for Blender {version}; there are {', '.join(blender_versions())}")
    if sys.version_info[:2] != (3, 11):
        found = ".".join(map(str, sys.version_info[:2]))
        raise StepError(
            f"Blender's Python module exists for Python 3.11 only, this is {found}: make PYTHON=python3.11 …"
        )
    path = ROOT / ".envs" / f"bpy-{version}"
    make_environment(path, requirements, fallback=["--extra-index-url", BLENDER_INDEX])
    return path


def rivals_environment() -> None:
    """./.envs/rivals, with the libraries that benchmarks compare with, as far as they can be had here."""
    try:
        make_environment(ROOT / ".envs" / "rivals", REQUIREMENTS / "rivals.txt")
    except StepError as failure:
        say(f"{failure}: the benchmarks will leave these rivals out")


def docs_environment() -> Path:
    """./.envs/docs, which makes the documents' site, made or brought up to date."""
    path = ROOT / ".envs" / "docs"
    make_environment(path, REQUIREMENTS / "docs.txt")
    return path


def types_environment() -> Path:
    """./.envs/types, which checks types, made or brought up to date."""
    path = ROOT / ".envs" / "types"
    make_environment(path, REQUIREMENTS / "types.txt")
    return path


def make_environment(path: Path, requirements: Path, fallback: list[str] | None = None) -> None:
    """An environment with exactly what `requirements` pins. Rebuilt if that changed or was not finished, so that what
    is pinned is what is there; packages that another checkout has installed are linked."""
    pip_requirements = REQUIREMENTS / "pip.txt"
    key = digest([requirements, pip_requirements], sys.version, sys.base_prefix)
    stamp, unfinished = path / STAMP, path / UNFINISHED
    if is_stamped(stamp, key):
        return
    if path.exists() and not (stamp.exists() or unfinished.exists()):
        raise StepError(f"{path.relative_to(ROOT)} was not made by `make setup`: move it away")
    say(f"{path.relative_to(ROOT)}: packages of {requirements.relative_to(ROOT)}")
    kept = environment_cache.entry(requirements.stem, key)
    start(path)
    if not (os.path.isdir(kept) and linked(path, kept)):
        start(path)
        bare_environment(path, pip_requirements)
        install = [*pip(path), "install", "--quiet", *network_options(), "-r", requirements]
        try:
            run(*install)
        except StepError:
            if fallback is None:
                raise
            run(*install, *fallback)
        environment_cache.keep(path, kept)
    unfinished.unlink()
    write_stamp(stamp, key)


def start(path: Path) -> None:
    """An empty folder that is marked as unfinished."""
    if path.exists():
        shutil.rmtree(path)
    path.mkdir(parents=True)
    (path / UNFINISHED).touch()


def linked(path: Path, kept: Path) -> bool:
    """Whether the environment is there now: an interpreter of its own, packages of the cache."""
    run(sys.executable, "-m", "venv", "--without-pip", path)
    return environment_cache.restore(path, kept)


def bare_environment(path: Path, pip_requirements: Path) -> None:
    """An environment with our pip. Debian keeps ensurepip in a package of its own: without it, the pip of the running
    interpreter reaches into the new one."""
    has_ensurepip = importlib.util.find_spec("ensurepip") is not None
    run(sys.executable, "-m", "venv", *([] if has_ensurepip else ["--without-pip"]), path)
    with_pip = pip(path) if has_ensurepip else [sys.executable, "-m", "pip", "--python", path / "bin" / "python"]
    run(*with_pip, "install", "--quiet", "--retries", "10", "--timeout", "60", "-r", pip_requirements)


def pip(path: Path) -> list[str | Path]:
    return [path / "bin" / "python", "-m", "pip", "--disable-pip-version-check"]


def network_options() -> list[str]:
    return ["--retries", "10", "--timeout", "60", "--resume-retries", "20", "--prefer-binary"]


def install_wheel(path: Path, wheel: Path, key: str) -> None:
    """One of our own wheels, without its dependencies: those are pinned."""
    package = wheel.name.split("-")[0]
    stamp = path / f".riffler-wheel-{package}"
    if is_stamped(stamp, key):
        return
    say(f"{path.relative_to(ROOT)}: {wheel.name}")
    stamp.unlink(missing_ok=True)
    run(*pip(path), "install", "--quiet", "--no-index", "--no-deps", "--force-reinstall", wheel)
    run(path / "bin" / "python", "-c", f"import {package}", cwd=Path(os.path.abspath(os.sep)), env=tool_environment())
    write_stamp(stamp, key)
