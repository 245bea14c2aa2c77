"""What the wheels of Zig's are made of: sources that are exactly the pinned ones, and nothing of this machine."""

import io
import re
import tarfile

import pytest

import libraries
import same_bytes
import zig
from shell import ROOT, StepError


@pytest.fixture
def archive(tmp_path):
    """An upstream archive as Debian has it: one folder with everything in it."""
    path = tmp_path / "zlib_1.2.13.dfsg.orig.tar.gz"
    with tarfile.open(path, "w:gz") as file:
        info = tarfile.TarInfo("zlib-1.2.13/zlib.h")
        info.size = 3
        file.addfile(info, io.BytesIO(b"/**"))
    return path


def test_an_archive_is_unpacked_without_its_own_folder(archive, tmp_path):
    sha256 = libraries.hashlib.sha256(archive.read_bytes()).hexdigest()
    libraries.unpack(tmp_path, libraries.Archive("zlib", archive.name, sha256), tmp_path / "out" / "zlib")
    assert (tmp_path / "out" / "zlib" / "zlib.h").read_text() == "/**"


def test_an_archive_with_other_bytes_is_refused(archive, tmp_path):
    with pytest.raises(StepError, match=r"not the one that tools/libraries\.py pins"):
        libraries.unpack(tmp_path, libraries.Archive("zlib", archive.name, "0" * 64), tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_another_version_in_debian_is_reported_with_the_file_that_is_pinned(tmp_path):
    with pytest.raises(StepError, match=r"another version of highway than highway_1\.0\.3"):
        libraries.unpack(tmp_path, libraries.ARCHIVES["highway"], tmp_path / "out")


def test_the_toolchain_looks_for_libraries_of_the_target_alone():
    text = zig.toolchain(zig.LINUX)
    modes = r"foreach\(kind LIBRARY INCLUDE PACKAGE\)\s+set\(CMAKE_FIND_ROOT_PATH_MODE_\$\{kind\} ONLY\)"
    assert re.search(modes, text)
    paths = re.findall(r"(?<=[\s(])/[^\s)]+", text)
    assert paths and all(path.startswith(str(ROOT)) for path in paths)


def test_zig_is_pinned_and_in_the_key_of_the_compiler_cache():
    assert re.fullmatch(r"ziglang==[\d.]+", zig.version())
    assert zig.environment(zig.LINUX)["CCACHE_COMPILERCHECK"] == f"string:{zig.version()} {zig.LINUX.triple}"


def test_results_that_differ_or_are_missing_are_named():
    assert same_bytes.differences({"a": "1", "b": "2", "c": "3"}, {"a": "1", "b": "9", "d": "4"}) == ["b", "c", "d"]
    assert same_bytes.differences({"a": "1"}, {"a": "1"}) == []
