"""NC code taken at its word: words to joints by a parser of its own, joints to tool poses by rotation matrices, and how
far what the axes do between blocks is off the moves that were asked for. Nothing of the core is used."""

from __future__ import annotations

import os
import re
import resource
import shutil
import subprocess
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

WORD = re.compile(r"([A-Z])\s*([-+]?[0-9.]+)")
BETWEEN = 16  # samples of every block
SOON = 256  # blocks in which the next row most often ends


def joints_of(text: str) -> np.ndarray:
    """(n, 6): X Y Z A B C at the end of every block that names one of them; absolute, mm and degrees, as all our posts
    for LinuxCNC write."""
    now, out = [0.0] * 6, []
    for line in text.splitlines():
        moved = False
        for letter, number in WORD.findall(re.sub(r"\(.*?\)", "", line)):
            if letter in "XYZABC":
                now["XYZABC".index(letter)] = float(number)
                moved = True
        if moved:
            out.append(list(now))
    return np.array(out).reshape(-1, 6)


@dataclass
class Axes:
    """A machine by its rotary axes: (letter, direction, point), tables from the part to the bed, heads from the bed to
    the tool; directions about which a positive angle turns what the axis carries, right-handed; points of tables in
    part coordinates, of heads from the tip, all at 0. tip: X Y Z are the tip's place in part coordinates."""

    tables: list = field(default_factory=list)
    heads: list = field(default_factory=list)
    tip: bool = False


def about(direction, point, degrees: np.ndarray) -> np.ndarray:
    """(n, 4, 4): turns about a line, by the matrix exponential of the cross product."""
    k = np.asarray(direction, float) / np.linalg.norm(direction)
    cross = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
    angle = np.radians(degrees)[:, None, None]
    out = np.tile(np.eye(4), (len(degrees), 1, 1))
    out[:, :3, :3] += np.sin(angle) * cross + (1 - np.cos(angle)) * (cross @ cross)
    out[:, :3, 3] = np.asarray(point, float) - out[:, :3, :3] @ np.asarray(point, float)
    return out


def poses(joints: np.ndarray, axes: Axes) -> np.ndarray:
    """(n, 6) tool poses in part coordinates of joints (n, 6), X Y Z A B C: with matrices from the part over the bed to
    the tool, not by LinuxCNC's formulas nor ours."""
    part = tool = np.tile(np.eye(4), (len(joints), 1, 1))
    for letter, direction, point in axes.tables:
        part = about(direction, point, joints[:, 3 + "ABC".index(letter)]) @ part
    for letter, direction, point in axes.heads:
        tool = tool @ about(direction, point, joints[:, 3 + "ABC".index(letter)])
    linear = np.tile(np.eye(4), (len(joints), 1, 1))
    linear[:, :3, 3] = joints[:, :3]
    stands = np.linalg.inv(part) @ linear @ tool
    return np.hstack([joints[:, :3] if axes.tip else stands[:, :3, 3], stands[:, :3, 2]])


def tilting_table(letter: str, rot_point, offset) -> Axes:
    """LinuxCNC's xyzac-trt and xyzbc-trt: a rotary table C on a table A or B whose axis passes ``offset`` from
    ``rot_point``, across its own direction; both turn the part right-handed."""
    axis = np.eye(3)["AB".index(letter)]
    point = np.asarray(rot_point, float)
    apart = np.where(axis, 0.0, np.asarray(offset, float))
    return Axes(tables=[("C", [0, 0, 1], point), (letter, axis, point + apart)])


#: X Y Z are the tip, the axis is Rz(C) Rx(A) ez.
TIP_A_C = Axes(heads=[("C", [0, 0, 1], [0, 0, 0]), ("A", [1, 0, 0], [0, 0, 0])], tip=True)


def ends(at: np.ndarray, wanted: np.ndarray) -> list[int]:
    """The block that ends at each pose, in order; ValueError where there is none."""
    found, start = [], 0
    for row, pose in enumerate(wanted):
        for following in (at[start : start + SOON], at[start + SOON :]):
            off = np.abs(following - pose)
            near = (off[:, :3].max(1, initial=0) < 1e-3) & (off[:, 3:].max(1, initial=0) < 1e-5)
            if near.any():
                found.append(start + int(np.argmax(near)))
                break
            start += len(following)
        else:
            raise ValueError(f"no block ends at row {row}")
        start = found[-1] + 1
    return found


def between(
    joints: np.ndarray,
    wanted: np.ndarray,
    axes: Axes,
    tied: np.ndarray | None = None,
    tools: np.ndarray | None = None,
) -> dict[str, float]:
    """How far blocks are off the poses ``wanted`` at which they end (``at_mm``, ``at_rad``) and, with all axes moving
    evenly from block to block, off the lines and great circles between them (``tip_mm``, ``axis_rad``). ``tied`` (n,):
    poses that the tool must reach along the great circle; None: all. ``tools`` (n,): the tool of each pose;
    the move after a tool change begins at an unknown place and is not judged."""
    at = poses(joints, axes)
    found = ends(at, wanted)
    off = at[found] - wanted
    tip = axis = 0.0
    share = np.linspace(0, 1, BETWEEN, endpoint=False)[None, :, None]
    must = np.ones(len(wanted), bool) if tied is None else tied
    known = np.ones(len(wanted), bool) if tools is None else np.append(True, np.diff(tools) == 0)
    ways = zip(found, found[1:], wanted, wanted[1:], must[1:], known[1:], strict=False)
    for first, last, a, b, held, judged in ways:
        if not judged:
            continue
        begin, end = joints[first:last, None], joints[first + 1 : last + 1, None]
        dense = poses((begin + share * (end - begin)).reshape(-1, 6), axes)
        way = b[:3] - a[:3]
        along = np.clip((dense[:, :3] - a[:3]) @ way / max(way @ way, 1e-300), 0, 1)[:, None]
        tip = max(tip, np.linalg.norm(dense[:, :3] - a[:3] - along * way, axis=1).max())
        pole = np.cross(a[3:], b[3:])
        length = np.linalg.norm(pole)
        if held and length > 1e-9:
            axis = max(axis, np.arcsin(np.clip(abs(dense[:, 3:] @ pole) / length, 0, 1)).max())
    return {
        "tip_mm": float(tip),
        "axis_rad": float(axis),
        "at_mm": float(np.linalg.norm(off[:, :3], axis=1).max()),
        "at_rad": float(np.linalg.norm(off[:, 3:], axis=1).max()),
    }


# ---- LinuxCNC's interpreter


def interpreter() -> Path | None:
    """rs274 of the checkout that this lies in (`make envs`), installed there or not, or that of the system."""
    own = (folder / ".envs" / "linuxcnc" / "usr" / "bin" / "rs274" for folder in Path(__file__).resolve().parents)
    installed = shutil.which("rs274")
    return next((path for path in own if path.exists()), Path(installed) if installed else None)


def child_seconds() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def interpreted(program: Path) -> tuple[float, np.ndarray]:
    """Processor seconds of rs274 from its start until all canonical moves are in a file, and the joints (n, 6) at
    their ends, mm and degrees with the 4 decimals that it prints; RuntimeError with what it says."""
    rs274 = interpreter()
    assert rs274 is not None
    usr = rs274.parents[1]
    libraries = os.pathsep.join([f"{usr}/lib", f"{usr}/lib/x86_64-linux-gnu", os.environ.get("LD_LIBRARY_PATH", "")])
    with tempfile.TemporaryDirectory() as folder:
        table, out = Path(folder) / "tools.tbl", Path(folder) / "calls"
        table.write_text("".join(f"T{n} P{n} Z0 D6\n" for n in range(1, 100)))
        start = child_seconds()
        done = subprocess.run(
            [rs274, "-t", table, "-g", program.resolve(), out],
            # It keeps its tools in a file of the home directory: runs at the same time must not share one.
            env=os.environ | {"LD_LIBRARY_PATH": libraries, "HOME": folder},
            capture_output=True, text=True, check=False,
        )  # fmt: skip
        seconds = child_seconds() - start
        if done.returncode != 0 or not out.exists() or "PROGRAM_END" not in (text := out.read_text()):
            raise RuntimeError((done.stderr.strip() or done.stdout.strip() or "no end of the program").splitlines()[-1])
    moves = re.findall(r"STRAIGHT_(?:FEED|TRAVERSE)\((.*)\)$", text, re.M)
    return seconds, np.array([[float(word) for word in move.split(",")] for move in moves]).reshape(-1, 6)
