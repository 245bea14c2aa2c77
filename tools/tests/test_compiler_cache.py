"""The compiler cache: what another checkout has compiled is found, and a cache that cannot be used is done without."""

import os
import subprocess
from pathlib import Path

import pytest

import compiler_cache

HAS_CCACHE = pytest.mark.skipif(bool(compiler_cache.problem()), reason=compiler_cache.problem())


@pytest.fixture
def fresh(monkeypatch):
    """The functions forget what they found before and after."""
    compiler_cache.problem.cache_clear()
    yield monkeypatch
    compiler_cache.problem.cache_clear()


def test_the_folder_is_the_users_unless_the_user_chose_one(fresh, tmp_path):
    fresh.delenv("CCACHE_DIR", raising=False)
    fresh.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert compiler_cache.folder() == tmp_path / "riffler" / "ccache"
    fresh.delenv("XDG_CACHE_HOME")
    assert compiler_cache.folder() == Path.home() / ".cache" / "riffler" / "ccache"
    fresh.setenv("CCACHE_DIR", str(tmp_path / "mine"))
    assert compiler_cache.folder() == tmp_path / "mine"


@HAS_CCACHE
def test_our_folder_has_our_size_and_the_users_folder_the_users(fresh, tmp_path):
    fresh.setenv("XDG_CACHE_HOME", str(tmp_path))
    fresh.delenv("CCACHE_DIR", raising=False)
    assert compiler_cache.environment()["CCACHE_MAXSIZE"] == compiler_cache.SIZE
    fresh.setenv("CCACHE_DIR", str(tmp_path / "mine"))
    assert "CCACHE_MAXSIZE" not in compiler_cache.environment()


def test_a_folder_that_cannot_be_created_is_not_used_and_named(fresh, tmp_path):
    (tmp_path / "file").touch()
    fresh.setenv("CCACHE_DIR", str(tmp_path / "file" / "cache"))
    if not HAS_CCACHE.args[0]:
        assert str(tmp_path / "file" / "cache") in compiler_cache.problem()
        assert "CCACHE_DIR chooses another" in compiler_cache.problem()
    assert compiler_cache.environment() == {"CCACHE_DISABLE": "1"}
    assert compiler_cache.report().startswith("compiler cache: none, ")


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="this system has no /dev/full")
def test_a_full_disk_switches_the_cache_off(fresh, tmp_path):
    class Full:
        def __init__(self, dir):
            self.file = open("/dev/full", "wb", buffering=0)  # noqa: SIM115 (closed below)

        def __enter__(self):
            return self.file

        def __exit__(self, *_):
            self.file.close()

    fresh.setenv("CCACHE_DIR", str(tmp_path))
    fresh.setattr(compiler_cache.tempfile, "TemporaryFile", Full)
    fresh.setattr(compiler_cache.shutil, "which", lambda name: f"/usr/bin/{name}")
    assert "No space left on device" in compiler_cache.problem()


def test_a_missing_program_is_named_with_its_package(fresh):
    fresh.setattr(compiler_cache.shutil, "which", lambda name: None if name == "ccache" else f"/usr/bin/{name}")
    assert compiler_cache.problem() == "there is no `ccache` (Debian: ccache)"
    assert compiler_cache.environment() == {"CCACHE_DISABLE": "1"}
    assert compiler_cache.arguments() == ["-DCMAKE_C_COMPILER_LAUNCHER=", "-DCMAKE_CXX_COMPILER_LAUNCHER="]


def test_hits_and_misses_are_read():
    text = "Cacheable calls:    12 /  14 (85.71%)\n  Hits:              9 /  12\n    Direct:          4 /  9\n"
    text += "  Misses:            3 /  12\nUncacheable calls:   2 /  14\nLocal storage:\n  Hits:             99\n"
    assert compiler_cache.counts(text) == (9, 14)
    assert compiler_cache.counts("") == (0, 0)


@HAS_CCACHE
def test_a_second_checkout_finds_what_the_first_one_compiled(fresh, tmp_path):
    """One source, its own header and a batch of it, in two folders, one of them with a space in its path."""
    fresh.setenv("CCACHE_DIR", str(tmp_path / "cache"))
    for name, found in (("first", 0), ("second one", 2)):
        root = tmp_path / name
        (root / "native").mkdir(parents=True)
        (root / "build").mkdir()
        (root / "native" / "a.hpp").write_text("inline int a() { return 1; }\n")
        (root / "native" / "a.cpp").write_text('#include "a.hpp"\nint b() { return a(); }\n')
        (root / "build" / "batch.cpp").write_text('#include "a.cpp"\n')
        fresh.setattr(compiler_cache, "ROOT", root)
        fresh.setattr(compiler_cache, "STATISTICS", root / "statistics.log")
        environment = os.environ | compiler_cache.environment()
        for source in (root / "native" / "a.cpp", root / "build" / "batch.cpp"):
            command = ["ccache", "c++", "-g1", f"-I{root / 'native'}", "-c", str(source), "-o", f"{source.stem}.o"]
            subprocess.run(command, cwd=root / "build", env=environment, check=True)
        assert compiler_cache.report().startswith(f"compiler cache: {found} of 2 compilations found")
        assert compiler_cache.report() == "compiler cache: nothing was compiled"
