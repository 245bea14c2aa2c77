"""NC code taken at its word: words to joints by a parser of its own, joints to tool poses by rotation matrices, and how
far what the axes do between blocks is off the moves that were asked for. Nothing of the core is used."""

from __future__ import annotations

import os
import re
import resource
import shutil
import subprocess
from pathlib import Path

import numpy as np

WORD = re.compile(r"([A-Z])\s*([-+]?[0-9.]+)")
BETWEEN = 16  # samples of every block


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


def turned(axis: int, degrees: np.ndarray) -> np.ndarray:
    """(n, 3, 3): right-handed about a coordinate axis."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    out = np.zeros((*degrees.shape, 3, 3))
    u, v = (axis + 1) % 3, (axis + 2) % 3
    out[..., axis, axis] = 1
    out[..., u, u] = out[..., v, v] = c
    out[..., u, v], out[..., v, u] = -s, s
    return out


def table_table(joints: np.ndarray, tilt: str, rot_point: np.ndarray, offset: np.ndarray) -> np.ndarray:
    """(n, 6) tip and axis in part coordinates: a table C stands on a table A or B whose axis passes ``offset`` from
    ``rot_point``; both turn the part right-handed."""
    axis = "AB".index(tilt)
    apart = np.array(offset, float)
    apart[axis] = 0
    part = turned(axis, joints[:, 3 + axis]) @ turned(2, joints[:, 5])
    # A point q of the part is at  p + apart + tilt (turn (q - p) - apart);  the tip is the q that is at X Y Z.
    held = turned(axis, joints[:, 3 + axis])
    behind = np.einsum("nji,nj->ni", held, joints[:, :3] - rot_point - apart) + apart
    tips = np.einsum("nji,nj->ni", turned(2, joints[:, 5]), behind) + rot_point
    return np.hstack([tips, part[:, 2, :]])


def tip_words(joints: np.ndarray) -> np.ndarray:
    """(n, 6): X Y Z are the tip, the axis is Rz(C) Rx(A) ez."""
    axes = (turned(2, joints[:, 5]) @ turned(0, joints[:, 3]))[:, :, 2]
    return np.hstack([joints[:, :3], axes])


def ends(at: np.ndarray, poses: np.ndarray) -> list[int]:
    """The block that ends at each pose, in order; ValueError where there is none."""
    found, start = [], 0
    for row, pose in enumerate(poses):
        near = (np.abs(at[start:, :3] - pose[:3]).max(1) < 1e-3) & (np.abs(at[start:, 3:] - pose[3:]).max(1) < 1e-5)
        if not near.any():
            raise ValueError(f"no block ends at row {row}")
        found.append(start + int(np.argmax(near)))
        start = found[-1] + 1
    return found


def between(joints: np.ndarray, poses: np.ndarray, kinematics) -> dict[str, float]:
    """How far blocks are off the poses at which they end (``at_mm``, ``at_rad``) and, with all axes moving evenly from
    block to block, off the lines and great circles between the poses (``tip_mm``, ``axis_rad``)."""
    at = kinematics(joints)
    found = ends(at, poses)
    off = at[found] - poses
    tip = axis = 0.0
    share = np.linspace(0, 1, BETWEEN, endpoint=False)[None, :, None]
    for first, last, a, b in zip(found, found[1:], poses, poses[1:], strict=False):
        begin, end = joints[first:last, None], joints[first + 1 : last + 1, None]
        dense = kinematics((begin + share * (end - begin)).reshape(-1, 6))
        way = b[:3] - a[:3]
        along = np.clip((dense[:, :3] - a[:3]) @ way / max(way @ way, 1e-300), 0, 1)[:, None]
        tip = max(tip, np.linalg.norm(dense[:, :3] - a[:3] - along * way, axis=1).max())
        pole = np.cross(a[3:], b[3:])
        length = np.linalg.norm(pole)
        if length > 1e-9:
            axis = max(axis, np.arcsin(np.clip(abs(dense[:, 3:] @ pole) / length, 0, 1)).max())
    return {
        "tip_mm": float(tip),
        "axis_rad": float(axis),
        "at_mm": float(np.linalg.norm(off[:, :3], axis=1).max()),
        "at_rad": float(np.linalg.norm(off[:, 3:], axis=1).max()),
    }


# ---- LinuxCNC's interpreter


def interpreter() -> Path | None:
    """rs274 of a developer's checkout (`make envs`), or that of the system."""
    own = Path(__file__).resolve().parents[4] / ".envs" / "linuxcnc" / "usr" / "bin" / "rs274"
    installed = shutil.which("rs274")
    return own if own.exists() else Path(installed) if installed else None


def child_seconds() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def interpreted(program: Path) -> float:
    """Processor seconds of rs274 from its start until all canonical moves are in a file; RuntimeError with what it
    says."""
    rs274 = interpreter()
    assert rs274 is not None
    table, out = program.with_suffix(".tbl"), program.with_suffix(".canon")
    table.write_text("T1 P1 Z0 D6\n")
    usr = rs274.parents[1]
    libraries = os.pathsep.join([f"{usr}/lib", f"{usr}/lib/x86_64-linux-gnu", os.environ.get("LD_LIBRARY_PATH", "")])
    start = child_seconds()
    done = subprocess.run(
        [rs274, "-t", table, "-g", program, out],
        env=os.environ | {"LD_LIBRARY_PATH": libraries}, capture_output=True, text=True, check=False,
    )  # fmt: skip
    seconds = child_seconds() - start
    if done.returncode != 0 or not out.exists() or "PROGRAM_END" not in out.read_text():
        raise RuntimeError((done.stderr.strip() or done.stdout.strip() or "no end of the program").splitlines()[-1])
    out.unlink()
    return seconds
