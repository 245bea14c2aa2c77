"""A build folder whose compiler cache has gone since compiles without it."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

MODULE = Path(__file__).parents[2] / "cmake" / "compiler_cache.cmake"
PROJECT = f"""cmake_minimum_required(VERSION 3.24)
project(small LANGUAGES C)
include({MODULE})
add_library(small STATIC small.c)
"""


def configured(folder: Path, *given: str) -> str:
    done = subprocess.run(
        ["cmake", "-G", "Ninja", "-S", folder, "-B", folder / "build", *given],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    return done.stdout


@pytest.fixture
def project(tmp_path):
    (tmp_path / "CMakeLists.txt").write_text(PROJECT)
    (tmp_path / "small.c").write_text("int small(void) { return 1; }\n")
    return tmp_path


def test_a_missing_launcher_is_dropped_and_named(project):
    launcher = project / "cache"
    launcher.write_text('#!/bin/sh\nexec "$@"\n')
    launcher.chmod(0o755)
    assert "compiler cache" not in configured(project, f"-DCMAKE_C_COMPILER_LAUNCHER={launcher}")
    assert str(launcher) in (project / "build" / "build.ninja").read_text()
    launcher.unlink()
    assert f"There is no {launcher}: builds without a compiler cache" in configured(project)
    assert str(launcher) not in (project / "build" / "build.ninja").read_text()
    subprocess.run(["cmake", "--build", project / "build"], capture_output=True, check=True)


def test_without_a_launcher_nothing_is_reported(project):
    assert "compiler cache" not in configured(project)
