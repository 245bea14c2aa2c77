"""Writes files whole or not at all, for Python code. The library's own writers do the same."""

from __future__ import annotations

import fcntl
import os
import shutil
import signal
import tempfile
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO

from . import _core


def read(path: str | os.PathLike[str]) -> bytes:
    """A file's bytes. FormatError if it cannot be read, and for a folder, a pipe or a device."""
    return _core.read_file(path)


@contextmanager
def writing(path: str | os.PathLike[str]) -> Iterator[IO[bytes]]:
    """A stream whose bytes become the file ``path`` at the end; after an error nothing is written.

    Follows links; an existing file keeps its permissions and owner. OSError or RuntimeError with the
    system's reason; RuntimeError if it is not a regular file.
    """
    draft = _core.AtomicFileWriter(path)
    with os.fdopen(os.dup(draft.fileno()), "wb") as stream:
        yield stream
    draft.commit()


def write(path: str | os.PathLike[str], data: bytes) -> None:
    """Writes the bytes as the file ``path``, whole or not at all."""
    with writing(path) as stream:
        stream.write(data)


@contextmanager
def drafting(path: str | os.PathLike[str], done: Callable[[], None] = lambda: None) -> Iterator[Path]:
    """Yields a path to write to, for writers that need one: the same name in a temporary folder. The file there
    replaces ``path`` at the end; then ``done`` is called, while Ctrl-C is still ignored.

    The folder is locked, so that the next draft can remove the folder of a killed process.
    """
    try:
        target = Path(_core.replaceable(path))
        _core.clear_drafts(target)
        prefix = Path(_core.draft_prefix(target))
        folder = Path(tempfile.mkdtemp(dir=prefix.parent, prefix=prefix.name))
    except OSError as error:
        raise RuntimeError(f"{Path(path).name}: cannot be written: {error.strerror}") from error
    lock = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield folder / Path(path).name
        with uninterrupted():
            _core.replace_file(folder / Path(path).name, target)
            done()
    finally:
        shutil.rmtree(folder, ignore_errors=True)
        os.close(lock)


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Ignores Ctrl-C; use it for moments only."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
