"""Other programs and libraries, measured in the same run.

``isosurface.py``, ``rays.py``, ``simplify.py``, ``drop.py`` and ``blender_boolean.py`` run in the Python of an
environment that has these libraries (--rivals, --blender), not in riffler's: they import nothing of it. Every job names
the rivals that are missing.
"""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
from pathlib import Path
from typing import Any

from ..measure import Settings, how_many

HERE = Path(__file__).parent


class LeftOutError(Exception):
    """A rival that cannot be measured here; the text says why."""


def ask(settings: Settings, script: str, work: str, threads: int | None = 1, **arguments: Any) -> dict[str, Any]:
    """What the function `work` of a script gives in the rivals' Python, in a process of its own."""
    if settings.rivals is None or not settings.rivals.exists():
        raise LeftOutError("there is no Python with it (--rivals)")
    count = str(how_many(threads))
    environment = {k: v for k, v in os.environ.items() if not k.startswith("PYTHON")}
    environment |= {"OMP_NUM_THREADS": count, "VTK_SMP_MAX_THREADS": count, "TBB_NUM_THREADS": count}
    command = [settings.rivals, HERE / script, work, json.dumps(arguments | {"threads": int(count)})]
    return spoken(command, environment)


def program(settings: Settings, name: str, *arguments: Any) -> dict[str, Any]:
    """What a program of native/bench prints."""
    path = settings.programs / name if settings.programs else None
    if path is None or not path.exists():
        raise LeftOutError(f"{name} was not built (--programs)")
    return spoken([path, *map(str, arguments)], dict(os.environ))


def run(command: list[Any], environment: dict[str, str], seconds: float) -> subprocess.CompletedProcess[str]:
    """A process and those that it starts, none of which outlives the time."""
    process = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment, start_new_session=True
    )
    try:
        out, err = process.communicate(timeout=seconds)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        raise
    return subprocess.CompletedProcess(command, process.returncode, out, err)


def spoken(command: list[Any], environment: dict[str, str], seconds: float = 900) -> dict[str, Any]:
    """The last line of JSON that a process prints."""
    try:
        done = run(command, environment, seconds)
    except subprocess.TimeoutExpired:
        raise LeftOutError(f"not finished within {seconds / 60:.0f} min") from None
    lines = [line for line in done.stdout.splitlines() if line.startswith("{")]
    if lines:
        return json.loads(lines[-1])
    said = (done.stderr.strip().splitlines() or [f"it ended with {done.returncode}"])[-1]
    if missing := re.fullmatch(r"ModuleNotFoundError: No module named '(.+)'", said):
        said = f"the Python module {missing[1]} is not installed"
    raise LeftOutError(said)
