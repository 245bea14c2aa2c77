"""Runs the reader (``worker``) in a separate process, so that a crash or hang of the reader cannot harm the caller."""

from __future__ import annotations

import json
import os
import selectors
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from .._core import Cancelled, FormatError

WORKER = Path(__file__).resolve().parent / "worker"
PYTHON = "RIFFLER_CAD_PYTHON"  # environment variable: path of a Python with the extra installed
INSTALL = "pip install 'riffler[cad]'"
TICK = 0.05  # s between two calls of the caller's progress callback
CLOSING = 2000  # largest number of characters of the reader's last messages in an error

Listener = Callable[[float], bool | None]


class CadReaderError(RuntimeError):
    """The process that reads a CAD file ended without a result. The caller is unchanged.

    Examples
    --------
    >>> issubclass(riffler.cad.CadReaderError, RuntimeError)
    True
    """


def interpreter(python: str | os.PathLike[str] | None) -> str:
    """The Python that runs the reader: the argument, else the variable RIFFLER_CAD_PYTHON, else the caller's own."""
    return os.fspath(python) if python is not None else os.environ.get(PYTHON) or sys.executable


def run(
    request: dict[str, Any], name: str, timeout: float, progress: Listener | None, python: str
) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """Returns the reader's answer and its arrays. Raises the errors of `riffler.cad.read`."""
    with _folder() as folder:
        request = request | {"cpu_seconds": _cpu_limit(timeout)}
        (folder / "request.json").write_text(json.dumps(request), encoding="utf-8")
        with open(folder / "messages", "wb") as messages:
            process = _start(python, folder, messages)
            try:
                stage = _follow(process, name, timeout, progress)
                status = process.wait()
            finally:
                _end(process)
        result = _result(folder, name, status, stage)
        with np.load(folder / "arrays.npz", allow_pickle=False) as arrays:
            return result, dict(arrays)


@contextmanager
def _folder() -> Iterator[Path]:
    folder = Path(tempfile.mkdtemp(prefix="riffler-cad-"))
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _cpu_limit(timeout: float) -> int:
    return int(timeout * (os.cpu_count() or 1)) + 60


def _start(python: str, folder: Path, messages: Any) -> subprocess.Popen:
    # A separate process group, so that Ctrl-C reaches only the caller, which then ends the reader.
    try:
        return subprocess.Popen(
            [python, str(WORKER), str(folder), str(os.getpid())],
            env=_environment(python),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=messages,
            start_new_session=True,
            close_fds=True,
        )
    except OSError as error:
        raise RuntimeError(
            f"{python}: cannot be started to read CAD files ({error.strerror}); {PYTHON} names a Python that has the "
            "package cadquery-ocp-novtk"
        ) from error


def _environment(python: str) -> dict[str, str]:
    """The caller's environment. For another Python, without the variables that lead to the caller's packages."""
    own = {"PYTHONPATH", "PYTHONHOME"} if python != sys.executable else set()
    return {key: value for key, value in os.environ.items() if key not in own}


def _end(process: subprocess.Popen) -> None:
    if process.poll() is None:
        process.kill()
        process.wait()
    if process.stdout is not None:
        process.stdout.close()


def _follow(process: subprocess.Popen, name: str, timeout: float, progress: Listener | None) -> str:
    """Passes the reader's progress to ``progress`` until the reader ends, and returns its last stage. Raises Cancelled
    and TimeoutError."""
    assert process.stdout is not None
    stream = process.stdout.fileno()
    os.set_blocking(stream, False)
    end = time.monotonic() + timeout
    stage, share, rest = "start", 0.0, b""
    with selectors.DefaultSelector() as selector:
        selector.register(stream, selectors.EVENT_READ)
        while True:
            if progress is not None and progress(share) is False:
                raise Cancelled("cancelled")
            left = end - time.monotonic()
            if left <= 0:
                raise TimeoutError(
                    f"{name}: not read within {timeout:g} s (stage: {stage}); a larger tolerance or a larger timeout= "
                    "of riffler.cad.read helps, or export fewer bodies"
                )
            if not selector.select(min(TICK if progress is not None else 1.0, left)):
                continue
            try:
                data = os.read(stream, 65536)
            except BlockingIOError:
                continue
            if not data:
                return stage
            *lines, rest = (rest + data).split(b"\n")
            for line in lines:
                stage, share = _told(line, stage, share)


def _told(line: bytes, stage: str, share: float) -> tuple[str, float]:
    try:
        report = json.loads(line)
        return str(report["stage"]), max(share, min(0.97, float(report["share"])))
    except (ValueError, KeyError, TypeError):
        return stage, share


def _result(folder: Path, name: str, status: int, stage: str) -> dict[str, Any]:
    try:
        result = json.loads((folder / "result.json").read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise CadReaderError(_crash(folder, name, status, stage)) from None
    problem = result.get("error")
    if problem == "missing":
        raise ValueError(
            f"{name}: STEP, IGES and BREP files need the package cadquery-ocp-novtk in {result['python']} "
            f"({INSTALL}): {result['message']}"
        )
    if problem == "memory":
        raise MemoryError(f"{name}: out of memory; a larger tolerance needs less, or export fewer bodies")
    if problem:
        raise FormatError(f"{name}: {result['message']}")
    return result


def _crash(folder: Path, name: str, status: int, stage: str) -> str:
    how = f"exit status {status}"
    if status < 0:
        try:
            how = signal.Signals(-status).name
        except ValueError:
            how = f"signal {-status}"
    text = (folder / "messages").read_bytes()[-CLOSING:].decode("utf-8", "replace").strip()
    last = text.splitlines()[-1].strip() if text else ""
    return (
        f"{name}: the CAD reader stopped ({how}, stage: {stage}{'; ' + last if last else ''}). Export the part again, "
        "as STEP AP214 or AP242, or body by body to find the one that cannot be read"
    )
