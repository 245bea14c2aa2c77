"""NC code as LinuxCNC's interpreter understands it."""

from __future__ import annotations

import os
import re
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

FOLDER = Path(__file__).parents[3] / ".envs" / "linuxcnc"
PROGRAM = FOLDER / "usr" / "bin" / "rs274"
CALL = re.compile(r"^\s*\d+ N\S+ (\w+)\((.*)\)$")

needed = pytest.mark.skipif(not PROGRAM.exists(), reason="no LinuxCNC interpreter: run `make envs`, or no apt-get here")


@dataclass
class Moves:
    """joints (n, 6): X Y Z A B C at the ends of moves, mm and degrees; rapid (n,); minutes (n,): how long each takes,
    NaN for rapids."""

    joints: np.ndarray
    rapid: np.ndarray
    minutes: np.ndarray


class RefusedError(Exception):
    """With what the interpreter says."""


def interpreted(path: Path) -> Moves:
    """The canonical moves of a program; tool 1 has the length 0, so that offsets say nothing."""
    table, out = path.with_suffix(".tbl"), path.with_suffix(".canon")
    table.write_text("T1 P1 Z0 D6\nT2 P2 Z0 D6\n")
    libraries = f"{FOLDER}/usr/lib:{FOLDER}/usr/lib/x86_64-linux-gnu"
    done = subprocess.run(
        [PROGRAM, "-t", table, "-g", path, out], env=os.environ | {"LD_LIBRARY_PATH": libraries},
        capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    text = out.read_text() if out.exists() else ""
    if done.returncode != 0 or "PROGRAM_END" not in text:
        raise RefusedError(done.stderr.strip() or done.stdout.strip())
    joints, rapid, minutes, feed, unit = [np.zeros(6)], [True], [np.nan], 0.0, 1.0
    for line in text.splitlines():
        found = CALL.match(line)
        if not found:
            continue
        call, words = found.groups()
        if call == "USE_LENGTH_UNITS":
            unit = {"CANON_UNITS_MM": 1.0, "CANON_UNITS_INCHES": 25.4}[words]
        elif call == "SET_FEED_RATE":
            feed = float(words) * unit
        elif call in ("STRAIGHT_FEED", "STRAIGHT_TRAVERSE"):
            to = np.array([float(word) for word in words.split(",")]) * np.repeat([unit, 1], 3)
            way = to - joints[-1]
            # LinuxCNC's rule: the feed is that of X Y Z where one of them moves, otherwise that of the rotary axes.
            length = np.linalg.norm(way[:3]) or np.linalg.norm(way[3:])
            joints.append(to)
            rapid.append(call == "STRAIGHT_TRAVERSE")
            minutes.append(np.nan if rapid[-1] else length / feed if feed > 0 else np.inf)
    return Moves(np.array(joints), np.array(rapid), np.array(minutes))


def between(joints: np.ndarray, parts: int) -> np.ndarray:
    """(n − 1, parts + 1, 6): all axes move evenly from one row to the next."""
    share = np.linspace(0, 1, parts + 1)[None, :, None]
    return joints[:-1, None] + share * (joints[1:, None] - joints[:-1, None])
