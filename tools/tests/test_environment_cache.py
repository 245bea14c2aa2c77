"""The environment cache: what one checkout has installed another one links, none writes into another's files, and a
cache that cannot be used is done without."""

import errno
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

import environment_cache
import environments
import shell

PACKAGE = "lib/python3.11/site-packages/thing.py"
PROGRAM = "#!{python}\nimport sys\nsys.path.insert(0, '')\nimport thing\nprint(thing.VALUE, sys.prefix)\n"


class Checkouts:
    """Several checkouts, with a pip that installs one module and one program, and counts."""

    def __init__(self, folder, monkeypatch):
        self.folder, self.monkeypatch, self.installed = folder, monkeypatch, 0

    def environment(self, name):
        """./.envs/thing of the checkout `name`."""
        root = self.folder / name
        (root / "requirements").mkdir(parents=True, exist_ok=True)
        for file in ("thing.txt", "pip.txt"):
            (root / "requirements" / file).write_text("thing==1\n")
        for module in (environments, environment_cache, shell):
            self.monkeypatch.setattr(module, "ROOT", root)
        self.monkeypatch.setattr(environments, "REQUIREMENTS", root / "requirements")
        self.monkeypatch.setattr(environments, "run", self.run)
        self.monkeypatch.setattr(environments.importlib.util, "find_spec", lambda name: None)
        path = root / ".envs" / "thing"
        environments.make_environment(path, root / "requirements" / "thing.txt")
        return path

    def run(self, *command):
        words = [str(word) for word in command]
        if "install" not in words:
            subprocess.run(words, check=True)
        elif words[-1].endswith("thing.txt"):
            path = Path(words[0]).parents[1]
            package = path / PACKAGE
            package.parent.mkdir(parents=True, exist_ok=True)
            package.write_text("VALUE = 7\n")
            (package.parent / "link").symlink_to("thing.py")
            program = path / "bin" / "thing"
            program.write_text(PROGRAM.format(python=path / "bin" / "python"))
            program.chmod(0o755)
            (path / "bin" / "tool").write_text("#!/bin/sh\necho tool\n")
            (path / "bin" / "__pycache__").mkdir()
            (path / "bin" / "__pycache__" / "tool.pyc").write_text("")
            self.installed += 1


@pytest.fixture
def checkouts(tmp_path, monkeypatch):
    monkeypatch.setenv("RIFFLER_ENVIRONMENTS", str(tmp_path / "cache"))
    return Checkouts(tmp_path, monkeypatch)


def output(path):
    return subprocess.run(
        [path / "bin" / "thing"], cwd=(path / PACKAGE).parent, capture_output=True, text=True, check=True
    ).stdout.split(maxsplit=1)


def entries(tmp_path):
    return sorted((tmp_path / "cache").iterdir())


def test_the_folder_is_the_users_unless_the_user_chose_one(monkeypatch, tmp_path):
    monkeypatch.delenv("RIFFLER_ENVIRONMENTS", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert environment_cache.folder() == tmp_path / "riffler" / "environments"
    monkeypatch.delenv("XDG_CACHE_HOME")
    assert environment_cache.folder() == Path.home() / ".cache" / "riffler" / "environments"
    monkeypatch.setenv("RIFFLER_ENVIRONMENTS", str(tmp_path / "mine"))
    assert environment_cache.folder() == tmp_path / "mine"


def test_a_second_checkout_links_and_its_programs_start_its_own_interpreter(checkouts):
    first = checkouts.environment("first")
    second = checkouts.environment("second one")
    third = checkouts.environment("third")  # of what a checkout has linked
    assert checkouts.installed == 1
    assert (first / PACKAGE).samefile(second / PACKAGE) and (first / "bin/tool").samefile(second / "bin/tool")
    assert os.readlink((second / PACKAGE).with_name("link")) == "thing.py"
    for path in (first, second, third):
        assert output(path) == ["7", f"{path}\n"]
        assert (path / environments.STAMP).read_text() == (first / environments.STAMP).read_text()
        assert not (path / environments.UNFINISHED).exists()
        assert str(path) in (path / "pyvenv.cfg").read_text()


def test_other_requirements_are_another_entry(checkouts, tmp_path):
    first = checkouts.environment("first")
    key = (first / environments.STAMP).read_text()
    assert entries(tmp_path) == [environment_cache.entry("thing", key)]
    assert environment_cache.entry("thing", key) != environment_cache.entry("thing", "0" * 64)


def test_a_checkout_that_replaces_a_file_changes_no_other(checkouts):
    first, second = (checkouts.environment(name) for name in ("first", "second"))
    for path in (first / PACKAGE, second / PACKAGE):
        assert not path.stat().st_mode & 0o222, "an editor would write into the files of all checkouts"
    (second / "part").write_text("VALUE = 8\n")
    (second / "part").replace(second / PACKAGE)
    (second / PACKAGE).with_name("more.py").write_text("")
    assert output(second)[0] == "8" and output(first)[0] == "7"
    third = checkouts.environment("third")
    assert output(third)[0] == "7" and not (third / PACKAGE).with_name("more.py").exists()
    assert checkouts.installed == 1


@pytest.mark.parametrize("harm", ["changed", "gone", "list"])
def test_an_incomplete_entry_is_replaced(checkouts, tmp_path, harm):
    """A file that root has written into, and a removal that was interrupted."""
    checkouts.environment("first")
    (kept,) = entries(tmp_path)
    file = kept / environment_cache.FILES / PACKAGE
    if harm == "gone":
        file.unlink()
    elif harm == "changed":
        file.chmod(0o644)
        file.write_text("VALUE = 9\n")
    else:
        (kept / environment_cache.LIST).write_text("{")
    second = checkouts.environment("second")
    assert checkouts.installed == 2 and output(second)[0] == "7"
    assert (second / PACKAGE).samefile(file) and entries(tmp_path) == [kept]


def no_link(source, target):
    raise OSError(errno.EXDEV, os.strerror(errno.EXDEV))


def test_across_file_systems_the_files_are_copied(checkouts, monkeypatch):
    monkeypatch.setattr(environment_cache.os, "link", no_link)
    first, second = (checkouts.environment(name) for name in ("first", "second"))
    assert checkouts.installed == 1 and output(second)[0] == "7"
    assert not (first / PACKAGE).samefile(second / PACKAGE)


def test_a_full_disk_switches_the_cache_off_and_is_named(checkouts, monkeypatch, tmp_path, capsys):
    def full(source, target):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(environment_cache.os, "link", no_link)
    monkeypatch.setattr(environment_cache.shutil, "copy2", full)
    for count, name in enumerate(("first", "second"), 1):
        assert output(checkouts.environment(name))[0] == "7"
        assert checkouts.installed == count and entries(tmp_path) == []
        assert ".envs/thing is not shared" in (said := capsys.readouterr().out) and "No space left on device" in said


def test_an_entry_that_cannot_be_linked_is_not_used(checkouts, monkeypatch, capsys):
    checkouts.environment("first")

    def refused(source, target):
        raise OSError(errno.EACCES, os.strerror(errno.EACCES))

    monkeypatch.setattr(environment_cache, "_link", refused)
    assert output(checkouts.environment("second"))[0] == "7"
    assert checkouts.installed == 2
    assert "Permission denied; installing with pip" in capsys.readouterr().out


def test_a_folder_that_cannot_be_created_is_not_used_and_named(checkouts, monkeypatch, tmp_path, capsys):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("RIFFLER_ENVIRONMENTS", str(tmp_path / "file" / "below"))
    assert output(checkouts.environment("first"))[0] == "7"
    said = capsys.readouterr().out
    assert "environment cache: none, " in said and "RIFFLER_ENVIRONMENTS chooses another folder" in said


def test_a_read_only_folder_is_still_read(checkouts, monkeypatch):
    checkouts.environment("first")

    def read_only(*arguments, **more):
        raise OSError(errno.EROFS, os.strerror(errno.EROFS))

    monkeypatch.setattr(environment_cache.os, "utime", read_only)
    assert output(checkouts.environment("second"))[0] == "7"
    assert checkouts.installed == 1


def test_entries_and_parts_unused_for_a_month_are_removed(checkouts, tmp_path):
    checkouts.environment("first")
    (kept,) = entries(tmp_path)
    for name in ("old", "old.part-1", "young"):
        (tmp_path / "cache" / name).mkdir()
    before = time.time() - environment_cache.KEPT - 60
    for path in (kept, tmp_path / "cache" / "old", tmp_path / "cache" / "old.part-1"):
        os.utime(path, (before, before))
    second = checkouts.environment("second")  # asks for it
    assert checkouts.installed == 1
    environment_cache.keep(second, environment_cache.entry("other", "1" * 64))
    names = {path.name for path in entries(tmp_path)}
    assert names == {kept.name, "young", environment_cache.entry("other", "1" * 64).name}


def test_two_checkouts_at_once_leave_one_entry(checkouts, tmp_path, monkeypatch):
    """The second one to end finds the entry of the first."""
    first = checkouts.environment("first")
    (kept,) = entries(tmp_path)
    before = (kept / environment_cache.LIST).stat().st_mtime_ns
    environment_cache.keep(first, kept)
    assert entries(tmp_path) == [kept] and (kept / environment_cache.LIST).stat().st_mtime_ns == before


@pytest.mark.parametrize(
    "header, rest",
    [
        ("#!/a/python3\n", "print(1)\n"),
        ("#!/bin/sh\n'''exec' \"/a b/python\" \"$0\" \"$@\"\n' '''\n", "print(1)\n"),
        ("#!/bin/sh\necho\n", None),
        ("\x7fELF", None),
        ("", None),
    ],
)
def test_scripts_of_an_environment_are_distinguished_from_other_programs(tmp_path, header, rest):
    program = tmp_path / "program"
    program.write_text(header + (rest or ""))
    assert environment_cache._body(program) == (None if rest is None else rest.encode())
    if rest:
        target = tmp_path / "own"
        environment_cache._write_program(target, Path(sys.executable), rest.encode(), program)
        target.chmod(0o755)
        assert subprocess.run([target], capture_output=True, text=True, check=True).stdout == "1\n"
