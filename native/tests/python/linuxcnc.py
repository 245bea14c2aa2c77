"""NC code as LinuxCNC's interpreter understands it."""

from __future__ import annotations

import os
import re
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
import riffler

FOLDER = Path(__file__).parents[3] / ".envs" / "linuxcnc"
PROGRAM = FOLDER / "usr" / "bin" / "rs274"
EXAMPLES = FOLDER / "usr" / "share" / "doc" / "linuxcnc" / "examples"
DEMOS = EXAMPLES / "sample-configs" / "sim" / "axis" / "vismach" / "5axis" / "table-rotary-tilting"
FIVE_AXES = {
    "boat-xyzac": "linuxcnc-xyzac",
    "impeller-7bl-xyzac": "linuxcnc-xyzac",
    "boat-xyzbc": "linuxcnc-xyzbc",
    "xyzac_switchkins": "linuxcnc-xyzac",
    "xyzbc_switchkins": "linuxcnc-xyzbc",
    "xyzac_switchkins_test_1": "linuxcnc-xyzac",
    "xyzac_switchkins_test_2": "linuxcnc-xyzac",
    "xyzac_switchkins_test_3": "linuxcnc-xyzac",
}
CALL = re.compile(r"^\s*\d+ N\S+\s+(\w+)\((.*)\)$")

needed = pytest.mark.skipif(not PROGRAM.exists(), reason="no LinuxCNC interpreter: run `make envs`, or no apt-get here")


@dataclass
class Moves:
    """joints (n, 6): X Y Z A B C at the ends of moves, mm and degrees; rapid (n,); minutes (n,): how long each takes,
    NaN for rapids."""

    joints: np.ndarray
    rapid: np.ndarray
    minutes: np.ndarray


def demonstration_file(name: str) -> Path:
    found = sorted(DEMOS.rglob(f"{name}.ngc"))
    assert found, "the package has moved its demonstrations"
    return found[0]


def demonstration(name: str) -> riffler.Program:
    """One of FIVE_AXES as riffler reads it."""
    options = {"subroutines": str(DEMOS / "remap_subs"), "rot_point": [0, 0, 0]}
    return riffler.Program.read(demonstration_file(name), machine=FIVE_AXES[name], options=options)


class RefusedError(Exception):
    """With what the interpreter says."""


def output(path: Path, *options: str) -> str:
    """The canonical calls of a program as rs274 prints them; tools have the length 0, so that offsets say nothing."""
    table, out = path.with_suffix(".tbl"), path.with_suffix(".canon")
    table.write_text("".join(f"T{n} P{n} Z0 D6\n" for n in range(1, 9)))
    out.unlink(missing_ok=True)
    libraries = f"{FOLDER}/usr/lib:{FOLDER}/usr/lib/x86_64-linux-gnu"
    done = subprocess.run(
        [PROGRAM, *options, "-t", table, "-g", path, out],
        # It keeps its tools in a file of the home directory: one for each run, or runs at the same time mix them up.
        env=os.environ | {"LD_LIBRARY_PATH": libraries, "HOME": str(path.parent)},
        capture_output=True, text=True, timeout=120, check=False, cwd=path.parent,
    )  # fmt: skip
    text = out.read_text() if out.exists() else ""
    if done.returncode != 0 or not ("PROGRAM_END" in text or "%" in path.read_text()):
        raise RefusedError(done.stderr.strip() or done.stdout.strip())
    return text


def interpreted(path: Path) -> Moves:
    """The canonical moves of a program."""
    text = output(path)
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


@dataclass
class Call:
    """A canonical move in machine coordinates, mm and degrees: its ends (6,); feed in mm/min, NaN for rapids; the
    printed digits' error, mm. For arcs: the axes (u, v) of the plane, the centre in it, and the signed sweep (rad)."""

    start: np.ndarray
    end: np.ndarray
    feed: float
    error: float
    spindle: float
    tool: int
    plane: tuple[int, int] | None = None
    centre: np.ndarray | None = None
    sweep: float = 0.0


@dataclass
class Frame:
    """From program to machine coordinates, as LinuxCNC's documents have it: G92, the turn, the work offset."""

    work: np.ndarray
    shift: np.ndarray
    degrees: float

    def machine(self, point: np.ndarray) -> np.ndarray:
        out = point + self.shift
        c, s = np.cos(np.radians(self.degrees)), np.sin(np.radians(self.degrees))
        out[:2] = c * out[0] - s * out[1], s * out[0] + c * out[1]
        return out + self.work

    def program(self, point: np.ndarray) -> np.ndarray:
        out = point - self.work
        c, s = np.cos(np.radians(self.degrees)), np.sin(np.radians(self.degrees))
        out[:2] = c * out[0] + s * out[1], -s * out[0] + c * out[1]
        return out - self.shift


PLANES = {"XY": (0, 1), "XZ": (2, 0), "YZ": (1, 2)}


def calls(text: str) -> tuple[list[Call], Frame]:
    """The moves of rs274's output, all offsets applied, and the frame in which the first of them was programmed."""
    out: list[Call] = []
    frame = first = Frame(np.zeros(6), np.zeros(6), 0.0)
    printed = {"SET_G5X_OFFSET": 1.0, "SET_G92_OFFSET": 1.0}  # units in which offsets were printed, with 4 decimals
    at, unit, feed, per_turn, speed, turning, tool, plane = np.zeros(6), 1.0, 0.0, False, 0.0, 0, 0, (0, 1)

    def lengths(words):
        return np.array([float(word) for word in words]) * np.repeat([unit, 1], 3)

    def move(end, **arc):
        nonlocal at, first
        if not out:
            first = frame
        rapid = np.nan if call == "STRAIGHT_TRAVERSE" else feed * (speed if per_turn else 1)
        out.append(Call(at, end, rapid, 1e-4 * (unit + sum(printed.values())), turning * speed, tool, **arc))
        at = end

    for line in text.splitlines():
        found = CALL.match(line)
        if not found:
            continue
        call, inside = found.groups()
        words = inside.split(",")
        if call in printed:
            printed[call] = unit
        if call == "USE_LENGTH_UNITS":
            unit = {"CANON_UNITS_MM": 1.0, "CANON_UNITS_INCHES": 25.4}[inside]
        elif call == "SET_FEED_RATE":
            feed = float(inside) * unit
        elif call == "SET_FEED_MODE":
            per_turn = int(words[1]) == 1
        elif call == "SET_SPINDLE_SPEED":
            speed = float(words[1])
        elif call.startswith("START_SPINDLE"):
            turning = 1 if call == "START_SPINDLE_CLOCKWISE" else -1
        elif call == "STOP_SPINDLE_TURNING":
            turning = 0
        elif call == "CHANGE_TOOL":
            tool = int(inside)
        elif call == "SELECT_PLANE":
            plane = PLANES[inside[-2:]]
        elif call == "SET_G5X_OFFSET":
            frame = Frame(lengths(words[1:]), frame.shift, frame.degrees)
        elif call == "SET_G92_OFFSET":
            frame = Frame(frame.work, lengths(words), frame.degrees)
        elif call == "SET_XY_ROTATION":
            frame = Frame(frame.work, frame.shift, float(inside))
        elif call in ("STRAIGHT_FEED", "STRAIGHT_TRAVERSE"):
            move(frame.machine(lengths(words)))
        elif call == "ARC_FEED":
            numbers = np.array([float(word) for word in words])
            u, v = plane
            end, centre = frame.program(at), frame.program(at)
            end[u], end[v], end[3 - u - v] = [*numbers[:2].tolist(), numbers[5]]
            end[[u, v, 3 - u - v]] *= unit
            end[3:] = numbers[6:9]
            centre[[u, v]] = numbers[2:4] * unit
            centre = frame.machine(centre)[[u, v]]
            end, turns = frame.machine(end), int(numbers[4])
            (a, b), (c, d) = at[[u, v]] - centre, end[[u, v]] - centre
            sweep = np.arctan2(a * d - b * c, a * c + b * d) * np.sign(turns) % (2 * np.pi)
            if np.hypot(c - a, d - b) < 0.02:  # what was printed in inches is no better
                sweep = 2 * np.pi
            sweep = np.sign(turns) * (sweep + 2 * np.pi * (abs(turns) - 1))
            move(end, plane=plane, centre=centre, sweep=sweep)
    return out, first
