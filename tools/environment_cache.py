"""The environment cache that all checkouts of a user share: the packages that one checkout has installed with pip, the
next one links.

An entry holds the files of one finished environment without riffler's own wheel. A checkout makes its own interpreter
and links the rest, so one environment takes its space once; across file systems the files are copied. Programs name
their interpreter by its path and are written for each checkout. Linked files are read-only, since all checkouts share
them: pip and Python replace files and never write into them. An entry of which a file has changed is dropped.

The entries lie in the user's cache folder; RIFFLER_ENVIRONMENTS chooses another one. One that no checkout has asked for
in a month goes. Where the folder cannot be used, pip installs everything.
"""

from __future__ import annotations

import contextlib
import json
import os
import platform
import shutil
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from compiler_cache import user_caches
from shell import ROOT, say

KEPT = 30 * 86400  # s without use
LIST = "files.json"  # size and time of each file, by its path below FILES
FILES = "files"
SHELL_HEADER = b"#!/bin/sh\n'''exec' "


def folder() -> Path:
    """Where finished environments are kept."""
    chosen = os.environ.get("RIFFLER_ENVIRONMENTS")
    return Path(chosen) if chosen else user_caches() / "riffler" / "environments"


def entry(name: str, key: str) -> Path:
    """The folder of the environment `name` with the packages that `key` stands for."""
    return folder() / f"{name}-{platform.machine()}-{key[:24]}"


def restore(path: Path, kept: Path) -> bool:
    """Links the entry's files into `path`, which holds an interpreter and no packages yet. False where the entry cannot
    be used; `path` then holds a part of it."""
    try:
        listed = json.loads((kept / LIST).read_text())
        for name, told in listed.items():
            source, target = kept / FILES / name, path / name
            if _state(source) != told:
                say(f"{kept}: {name} has changed, dropped")
                shutil.rmtree(kept, ignore_errors=True)
                return False
            target.parent.mkdir(parents=True, exist_ok=True)
            if target.parent == path / "bin" and (body := _body(source)) is not None:
                _write_program(target, path / "bin" / "python", body, source)
            else:
                _link(source, target)
    except (FileNotFoundError, ValueError):  # a removal that was interrupted
        say(f"{kept}: incomplete, dropped")
        shutil.rmtree(kept, ignore_errors=True)
        return False
    except OSError as error:
        say(f"{kept}: {error.strerror}; installing with pip")
        return False
    with contextlib.suppress(OSError):  # a folder that cannot be written serves all the same
        os.utime(kept)
    say(f"{path.relative_to(ROOT)}: linked from {kept}")
    return True


def keep(path: Path, kept: Path) -> None:
    """Makes an entry of the finished environment at `path`, or says why there is none."""
    try:
        folder().mkdir(parents=True, exist_ok=True)
        _prune()
        part = Path(tempfile.mkdtemp(prefix=f"{kept.name}.part-", dir=folder()))
    except OSError as error:
        say(f"environment cache: none, {folder()}: {error.strerror}; RIFFLER_ENVIRONMENTS chooses another folder")
        return
    try:
        listed = {}
        for source in _packages(path):
            name = str(source.relative_to(path))
            target = part / FILES / name
            target.parent.mkdir(parents=True, exist_ok=True)
            _link(source, target)
            if not target.is_symlink():
                target.chmod(target.stat().st_mode & ~0o222)
            listed[name] = _state(target)
        (part / LIST).write_text(json.dumps(listed))
        part.chmod(0o755)
        if not kept.exists():  # another checkout may have been quicker
            part.rename(kept)
    except OSError as error:
        say(f"environment cache: {folder()}: {error.strerror}; {path.relative_to(ROOT)} is not shared")
    finally:
        shutil.rmtree(part, ignore_errors=True)


def _packages(path: Path) -> Iterator[Path]:
    """Every file and link of an environment but those that belong to its interpreter and to this checkout."""
    for found in sorted(path.iterdir()):
        if found.name.startswith(".riffler-") or found.name in {"pyvenv.cfg", "lib64"}:
            continue
        if found.name == "bin":
            for program in sorted(found.iterdir()):
                if not program.name.lower().startswith(("python", "activate")):
                    yield from _files(program)
        else:
            yield from _files(found)


def _files(path: Path) -> Iterator[Path]:
    if path.is_dir() and not path.is_symlink():
        for found in sorted(path.iterdir()):
            yield from _files(found)
    else:
        yield path


def _state(path: Path) -> list[int | str]:
    """What changes with a file's content."""
    if path.is_symlink():
        return [os.readlink(path)]
    status = path.stat()
    return [status.st_size, status.st_mtime_ns]


def _link(source: Path, target: Path) -> None:
    if source.is_symlink():
        target.symlink_to(os.readlink(source))
        return
    try:
        os.link(source, target)
    except FileExistsError:
        raise
    except OSError:  # another file system, or one without links
        shutil.copy2(source, target)


def _body(program: Path) -> bytes | None:
    """A Python program without the lines that start its interpreter; None of anything else. pip writes one line, or
    three where the path is long or has a space."""
    with program.open("rb") as file:
        if file.read(2) != b"#!":
            return None
    text = program.read_bytes()
    if text.startswith(SHELL_HEADER):
        return text.split(b"\n", 3)[3]
    first, _, rest = text.partition(b"\n")
    return rest if b"python" in first else None


def _write_program(target: Path, interpreter: Path, body: bytes, like: Path) -> None:
    """With the three lines, which serve any path."""
    target.write_bytes(SHELL_HEADER + f'"{interpreter}" "$0" "$@"\n'.encode() + b"' '''\n" + body)
    target.chmod(like.stat().st_mode | 0o200)


def _prune() -> None:
    """Removes entries, and parts of one, that nothing has used for long."""
    for found in folder().iterdir():
        try:
            if time.time() - found.stat().st_mtime > KEPT:
                shutil.rmtree(found, ignore_errors=True)
        except FileNotFoundError:
            continue
