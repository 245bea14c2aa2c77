"""Batches of sources: each source in one, none that must stand alone, and the same text wherever the checkout lies."""

import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
CMAKE = shutil.which("cmake") or ROOT / ".venv" / "bin" / "cmake"
LISTS = """cmake_minimum_required(VERSION 3.24)
project(batches LANGUAGES CXX)
set(RIFFLER_BATCHES {on})
set(RIFFLER_NATIVE ${{PROJECT_SOURCE_DIR}}/native)
include({root}/cmake/batches.cmake)
file(GLOB sources native/a/*.cpp native/b/*.cpp)
add_library(core STATIC ${{sources}} outside.cpp)
set_source_files_properties(native/a/defined.cpp PROPERTIES COMPILE_DEFINITIONS VALUE=1)
target_include_directories(core PRIVATE native)
batch_sources(core 3)
get_target_property(left core SOURCES)
file(WRITE ${{PROJECT_BINARY_DIR}}/sources "${{left}}")
"""


def configured(folder, on="ON"):
    for name in ("a/1", "a/2", "a/3", "a/4", "a/5", "b/1"):
        path = folder / "native" / f"{name}.cpp"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"int {name.replace('/', '_')}() {{ return 0; }}\n")
    (folder / "native" / "a" / "defined.cpp").write_text("int defined() { return VALUE; }\n")
    (folder / "native" / "b" / "lanes.cpp").write_text('#define HWY_TARGET_INCLUDE "b/lanes.cpp"\n')
    (folder / "outside.cpp").write_text("int outside() { return 0; }\n")
    (folder / "CMakeLists.txt").write_text(LISTS.format(root=ROOT.as_posix().replace(" ", "\\ "), on=on))
    command = [CMAKE, "-S", folder, "-B", folder / "build"]
    subprocess.run(command, check=True, capture_output=True)
    return (folder / "build" / "sources").read_text().split(";")


def texts(folder):
    return {p.name: p.read_text() for p in (folder / "build" / "batches" / "core").iterdir()}


@pytest.fixture(scope="module")
def checkouts(tmp_path_factory):
    folders = [tmp_path_factory.mktemp("one"), tmp_path_factory.mktemp("another one")]
    return folders, [configured(folder) for folder in folders]


def test_every_source_is_compiled_once(checkouts):
    (folder, _), (left, _) = checkouts
    included = [line for text in texts(folder).values() for line in text.splitlines() if line.startswith("#include")]
    assert sorted(included) == [f'#include "{name}.cpp"' for name in ("a/1", "a/2", "a/3", "a/4", "a/5", "b/1")]
    alone = sorted(Path(path).name for path in left if "/batches/" not in path)
    assert alone == ["defined.cpp", "lanes.cpp", "outside.cpp"]


def test_batches_are_of_one_folder_and_of_like_length(checkouts):
    (folder, _), _ = checkouts
    lengths = {name: text.count("#include") for name, text in texts(folder).items()}
    assert lengths == {"a_0.cpp": 3, "a_3.cpp": 2, "b_0.cpp": 1}


def test_batches_contain_no_path_of_the_checkout(checkouts):
    (one, other), _ = checkouts
    assert texts(one) == texts(other)


def test_without_batches_nothing_changes(tmp_path):
    left = configured(tmp_path, on="OFF")
    assert len(left) == 9 and not (tmp_path / "build" / "batches").exists()
