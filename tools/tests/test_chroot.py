"""What goes into a chroot and comes out of it, in a folder that plays one."""

import os
from pathlib import Path

import pytest

import chroot
import shell


@pytest.fixture
def place(tmp_path, monkeypatch):
    monkeypatch.setattr(chroot, "ROOT", tmp_path)
    (tmp_path / "src").mkdir()
    for name in ("a.py", "b.py"):
        (tmp_path / "src" / name).write_text(name)
    found = chroot.Chroot("trixie", ("blender",))
    found.root.mkdir(parents=True)
    return found


def put(place):
    place.put((chroot.ROOT / "src").glob("*.py"))
    return {p.name: p for p in (place.project / "src").iterdir()}


def test_unchanged_files_keep_their_time_and_changed_ones_get_a_newer_one(place):
    before = {name: path.stat().st_mtime_ns for name, path in put(place).items()}
    source = chroot.ROOT / "src" / "b.py"
    source.write_text("changed")
    os.utime(source, (1, 1))  # as of a checkout that is older than what was built
    after = put(place)
    assert after["a.py"].stat().st_mtime_ns == before["a.py"]
    assert after["b.py"].read_text() == "changed" and after["b.py"].stat().st_mtime_ns > before["b.py"]


def test_deleted_files_are_deleted_in_the_chroot_and_built_ones_stay(place):
    (put(place)["a.py"].parent / "built.o").write_text("object")
    (chroot.ROOT / "src" / "a.py").unlink()
    assert put(place).keys() == {"b.py", "built.o"}


def test_a_folder_with_a_mount_inside_is_not_deleted(place, monkeypatch):
    inside = place.root / "proc"
    inside.mkdir()
    original = Path.read_text
    mounts = f"proc {inside} proc rw 0 0\n"
    monkeypatch.setattr(Path, "read_text", lambda p, *a: mounts if str(p) == "/proc/self/mounts" else original(p, *a))
    with pytest.raises(shell.StepError, match="is mounted"):
        chroot.remove(place.root)
    assert inside.exists()
    mounts = "proc /elsewhere proc rw 0 0\n"
    chroot.remove(place.root)
    assert not place.root.exists()


def test_a_command_in_the_chroot_sees_only_the_given_variables(place, monkeypatch):
    monkeypatch.setattr(chroot, "isolation", lambda network: [])
    monkeypatch.setenv("SECRET", "x")
    monkeypatch.setenv("https_proxy", "http://proxy:1")
    words = place.command("true", CMAKE_ARGS="-Dx")
    assert words[:4] == ["chroot", str(place.root), "env", "-i"] and words[-2:] == ["/riffler", "true"]
    assert "CMAKE_ARGS=-Dx" in words and not any("SECRET" in w or "proxy" in w for w in words)
    assert "https_proxy=http://proxy:1" in place.command("true", network=True)
