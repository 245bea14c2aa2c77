"""The command line as a shell runs it: for the tests of commands."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import riffler

RIFFLER = [sys.executable, "-m", "riffler"]
# The same riffler as this process has, wherever the commands run.
PATHS = [str(Path(riffler.__file__).parents[1]), os.environ.get("PYTHONPATH", "")]
ENVIRONMENT = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, PATHS))}


def riffle(*words: object, cwd: Path, **more: str) -> subprocess.CompletedProcess:
    """Runs a command; `more` are environment variables."""
    command, env = [*RIFFLER, *map(str, words)], ENVIRONMENT | more
    return subprocess.run(command, cwd=cwd, env=env, capture_output=True, text=True, timeout=300, check=False)


def result(*words: object, cwd: Path, status: int = 0) -> dict:
    """The JSON of a command that ends with `status`."""
    done = riffle(*words, "--json", cwd=cwd)
    assert done.returncode == status, done.stderr + done.stdout
    notes = [line for line in done.stderr.splitlines() if "option rapids" not in line]
    assert not notes, notes

    def refuse(name: str) -> None:
        raise AssertionError(f"{name} is not JSON")

    return json.loads(done.stdout, parse_constant=refuse)
