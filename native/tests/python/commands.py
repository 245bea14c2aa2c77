"""The command line for the tests of commands: in the tests' process, or as a shell runs it."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from contextlib import chdir, redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path

import riffler
from riffler import cli

RIFFLER = [sys.executable, "-m", "riffler"]
# The same riffler as this process has, wherever the commands run.
PATHS = [str(Path(riffler.__file__).parents[1]), os.environ.get("PYTHONPATH", "")]
ENVIRONMENT = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, PATHS))}


def in_shell(*words: object, cwd: Path, **more: str) -> subprocess.CompletedProcess:
    """Runs a command in a process of its own; `more` are environment variables."""
    command, env = [*RIFFLER, *map(str, words)], ENVIRONMENT | more
    return subprocess.run(command, cwd=cwd, env=env, capture_output=True, text=True, timeout=300, check=False)


def riffle(*words: object, cwd: Path) -> subprocess.CompletedProcess:
    """Runs a command in this process, with the outputs and the status that `in_shell` gives: a process takes longer to
    start than most commands."""
    argv, out, err, stdin = list(map(str, words)), StringIO(), StringIO(), sys.stdin
    with chdir(cwd), redirect_stdout(out), redirect_stderr(err):
        sys.stdin = StringIO()
        try:
            status = cli.main(argv)
        except SystemExit as end:
            status = end.code
        finally:
            sys.stdin = stdin
    return subprocess.CompletedProcess(argv, status or 0, out.getvalue(), err.getvalue())


def result(*words: object, cwd: Path, status: int = 0, run=riffle) -> dict:
    """The JSON of a command that ends with `status`."""
    done = run(*words, "--json", cwd=cwd)
    assert done.returncode == status, done.stderr + done.stdout
    notes = [line for line in done.stderr.splitlines() if "option rapids" not in line]
    assert not notes, notes

    def refuse(name: str) -> None:
        raise AssertionError(f"{name} is not JSON")

    return json.loads(done.stdout, parse_constant=refuse)
