"""The installed core: the example of docs/cpp.md is built against it and does what closed forms say, every public
header is there and in the document, and a compiler or a standard that is too old is named in one sentence."""

import math
import re
import shutil
import struct
import subprocess

import numpy as np
import pytest

from preset import build_preset
from shell import ROOT, VENV, tool_environment

CMAKE = VENV / "bin" / "cmake"
BUILD = ROOT / "build" / "release"
PUBLIC = ROOT / "native" / "include" / "riffler"
LIST = """cmake_minimum_required(VERSION 3.24)
project(asking LANGUAGES CXX)
include(before.cmake)
find_package(riffler {version} REQUIRED)
"""


def call(*command):
    return subprocess.run(command, capture_output=True, text=True, env=tool_environment(), check=False)


@pytest.fixture(scope="module")
def prefix(tmp_path_factory):
    """Installed, then moved to a folder whose name has a space: nothing in it names where it was made."""
    if not (BUILD / "CMakeCache.txt").is_file():
        pytest.skip("there is no release build: `make test-cpp` makes it")
    build_preset("release", "riffler_core")
    folder = tmp_path_factory.mktemp("installed")
    done = call(CMAKE, "--install", BUILD, "--prefix", folder / "first")
    assert done.returncode == 0, done.stderr
    return (folder / "first").rename(folder / "another place")


@pytest.fixture(scope="module")
def example(prefix, tmp_path_factory):
    """The folder in which the example has run, and its figures by name."""
    folder = tmp_path_factory.mktemp("example")
    shutil.copytree(ROOT / "examples" / "cpp", folder / "source")
    for command in (
        [CMAKE, "-S", folder / "source", "-B", folder / "build", "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={prefix}"],
        [CMAKE, "--build", folder / "build"],
    ):
        done = call(*command)
        assert done.returncode == 0, done.stdout + done.stderr
    done = subprocess.run(folder / "build" / "groove", capture_output=True, text=True, cwd=folder, check=False)
    assert done.returncode == 0, done.stderr
    return folder, {line.split()[0]: float(line.split()[1]) for line in done.stdout.splitlines()}


def test_the_example_removes_half_a_cylinder(example):
    _, figures = example
    """Depths under the ball at the rays, each for a square of a pitch."""
    pitch, radius, length = 0.25, 3, 60
    across = [(k + 0.5) * pitch for k in range(int(radius / pitch))]
    rays = 2 * sum(math.sqrt(radius**2 - y**2) for y in across) * pitch * length
    assert rays == pytest.approx(0.5 * math.pi * radius**2 * length, rel=3e-3)
    assert figures["removed"] == pytest.approx(rays, abs=1e-3)
    assert figures["verified"] == pytest.approx(rays, abs=1e-3)
    assert figures["findings"] == 0


def test_the_example_drops_a_smaller_ball_to_the_grooves_bottom(example):
    _, figures = example
    assert figures["rests"] == pytest.approx(17, abs=5e-3)


def test_the_example_writes_a_closed_surface_of_that_volume(example):
    folder, figures = example
    data = (folder / "groove.stl").read_bytes()
    (count,) = struct.unpack_from("<I", data, 80)
    assert count == figures["triangles"] and len(data) == 84 + 50 * count
    rows = np.frombuffer(data, [("normal", "<3f4"), ("corners", "<3f4", 3), ("rest", "<u2")], offset=84)
    corners = rows["corners"].astype(float)
    volume = np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
    points = corners.reshape(-1, 3)
    order = np.lexsort(points.T)
    vertices = np.empty(len(points), np.int64)
    vertices[order] = np.cumsum(np.any(np.diff(points[order], axis=0, prepend=np.nan) != 0, axis=1))
    start, end = vertices.reshape(-1, 3), np.roll(vertices.reshape(-1, 3), -1, axis=1)
    edges, backwards = (np.sort((a << 32 | b).ravel()) for a, b in ((start, end), (end, start)))
    assert np.all(np.diff(edges) > 0) and np.array_equal(edges, backwards)
    assert volume == pytest.approx(60 * 40 * 20 - 0.5 * math.pi * 3**2 * 60, rel=2e-4)


def test_the_example_writes_nc_code_of_the_groove(example):
    folder, figures = example
    text = (folder / "groove.ngc").read_text()
    assert re.search(r"F600\b", text) and re.search(r"\bS12000\b", text)
    words = {(letter, float(number)) for letter, number in re.findall(r"\b([XYZ])(-?[\d.]+)", text)}
    assert {("X", -5), ("X", 65), ("Y", 20), ("Z", 17)} <= words
    assert figures["rows"] >= 4


def test_every_public_header_is_installed_and_no_other(prefix):
    installed = {p.relative_to(prefix / "include" / "riffler") for p in (prefix / "include").rglob("*.*")}
    assert installed == {p.relative_to(PUBLIC) for p in PUBLIC.rglob("*.hpp")}
    assert (prefix / "share" / "licenses" / "riffler" / "LICENSE").is_file()


def test_the_document_has_every_public_header():
    text = (ROOT / "docs" / "cpp.md").read_text()
    table = text[text.index("## Headers") :]
    found = []
    for topic, headers in re.findall(r"^\| `(\w+)` \| .*?\| (.*) \|$", table, re.M):
        found += [f"{topic}/{name}.hpp" for name in re.findall(r"`([\w/]+)`", headers)]
    assert sorted(found) == sorted(p.relative_to(PUBLIC).as_posix() for p in PUBLIC.rglob("*.hpp"))


@pytest.fixture(scope="module")
def ask(prefix, tmp_path_factory):
    """Configures a project that looks for a version of riffler after some settings. CMake finds out what the compiler
    can do at the first call only."""
    folder = tmp_path_factory.mktemp("asking")

    def configure(before="", version=""):
        (folder / "before.cmake").write_text(before)
        (folder / "CMakeLists.txt").write_text(LIST.format(version=version))
        return call(CMAKE, "-S", folder, "-B", folder / "build", "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={prefix}")

    return configure


@pytest.mark.parametrize(
    ("before", "sentence"),
    [
        ("set(CMAKE_CXX_STANDARD 14)", r"riffler \S+ needs C\+\+20 or later, but CMAKE_CXX_STANDARD is 14\."),
        ("set(CMAKE_CXX_STANDARD 98)", r"riffler \S+ needs C\+\+20 or later, but CMAKE_CXX_STANDARD is 98\."),
        ("set(CMAKE_CXX_STANDARD 17)", r"riffler \S+ needs C\+\+20 or later, but CMAKE_CXX_STANDARD is 17\."),
        (
            "set(CMAKE_CXX_COMPILER_ID GNU)\nset(CMAKE_CXX_COMPILER_VERSION 9.4.0)",
            r"riffler \S+ needs GCC \d+ or later, but the C\+\+ compiler is GCC 9\.4\.0 \(\S+\)\.",
        ),
        (
            "set(CMAKE_CXX_COMPILER_ID Clang)\nset(CMAKE_CXX_COMPILER_VERSION 7.0.1)\n"
            "list(REMOVE_ITEM CMAKE_CXX_COMPILE_FEATURES cxx_std_20)",
            r"riffler \S+ needs a compiler with C\+\+20, which Clang 7\.0\.1 \(\S+\) is not\.",
        ),
    ],
    ids=["C++14", "C++98", "C++17", "GCC 9", "Clang 7"],
)
def test_a_standard_or_version_that_is_too_old_is_named_in_one_sentence(ask, before, sentence):
    done = ask(before)
    assert done.returncode != 0
    assert re.search(sentence, " ".join(done.stderr.split())), done.stderr


@pytest.mark.parametrize("before", ["", "set(CMAKE_CXX_STANDARD 20)", "set(CMAKE_CXX_STANDARD 23)"])
def test_a_newer_standard_is_accepted(ask, before):
    done = ask(before)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize(("version", "fits"), [("0.1", True), ("0.2", False), ("1.0", False)])
def test_another_minor_version_is_another_interface(ask, version, fits):
    done = ask(version=version)
    assert (done.returncode == 0) == fits, done.stderr


def test_the_core_is_configured_without_tools_of_developers(tmp_path):
    """The preset of docs/cpp.md: no Python, no tests."""
    done = call(CMAKE, "-S", ROOT, "--preset", "core", "-B", tmp_path / "build")
    assert done.returncode == 0, done.stderr
    cache = (tmp_path / "build" / "CMakeCache.txt").read_text()
    assert "GTest_DIR" not in cache and "pybind11_DIR" not in cache
