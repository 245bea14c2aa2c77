"""Mills a bust, half the size of the sculpted figure, from a block: a job from five sides (demo/bust.toml).

The figure stands on a pin on a base, which a vise holds; all three become one solid. The job plans its operations in
order, each on the stock that the one before leaves, and verifies its NC code as the machine will read it.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path

import numpy as np
import riffler
from riffler import job as jobs
from riffler_bench import nc_judge

from demo import report

JOB = Path(__file__).parent / "bust.toml"
SCALE = 0.5  # of the figure, which is 120 mm wide
PIN = (9.0, 3.0, -36.0, -6.0)  # mm: radius, y of its axis, and its ends
BASE = ((-33.0, -21.0, -46.0), (33.0, 21.0, -34.0))  # mm: lower and upper corner, as wide as the stock
PITCH, DETAIL = 0.15, 0.01  # mm between the rays that join the three, and error of the surface between them


def bust(figure: riffler.Mesh) -> riffler.Mesh:
    """The figure at half its size, on its pin and base, as one closed surface."""
    turn = np.linspace(0, 2 * np.pi, 97)[:-1]
    radius, y, low, high = PIN
    (x0, y0, z0), (x1, y1, z1) = BASE
    shells = [
        (figure.vertices * SCALE, figure.triangles),
        _prism(np.column_stack([radius * np.cos(turn), y + radius * np.sin(turn)]), low, high),
        _prism(np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)]), z0, z1),
    ]
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in shells)])
    together = riffler.Mesh(
        np.concatenate([vertices for vertices, _ in shells]),
        np.concatenate([triangles + k for (_, triangles), k in zip(shells, starts, strict=False)]),
    )
    return riffler.Volume.from_mesh(together, PITCH, "xyz").to_mesh(tolerance=DETAIL)


def _prism(outline: np.ndarray, low: float, high: float) -> tuple[np.ndarray, np.ndarray]:
    """A closed upright prism over a convex outline, (n, 2) counter-clockwise: vertices and triangles."""
    n = len(outline)
    middle = outline.mean(axis=0)
    vertices = np.concatenate([
        np.column_stack([outline, np.full(n, low)]), np.column_stack([outline, np.full(n, high)]),
        [(*middle, low), (*middle, high)],
    ])  # fmt: skip
    i = np.arange(n)
    j, bottom, top = (i + 1) % n, np.full(n, 2 * n), np.full(n, 2 * n + 1)
    faces = ((i, j, j + n), (i, j + n, i + n), (j, i, bottom), (i + n, j + n, top))
    return vertices, np.concatenate([np.column_stack(face) for face in faces])


def run(
    figure: riffler.Mesh, out: Path, stages: Callable[[str], AbstractContextManager]
) -> tuple[jobs.Job, jobs.Result]:
    """Makes the part, runs the job and writes its sheet and the stock that is left, all in the folder `out`."""
    with stages("Bust: figure, pin and base joined"):
        bust(figure).write(out / "bust.stl")
    shutil.copyfile(JOB, out / JOB.name)
    job = jobs.read(out / JOB.name)
    result = jobs.run(job, step=lambda name: stages(f"Bust: {name[0].lower()}{name[1:]}"))
    with stages("Bust: set-up sheet"):
        jobs.write_sheet(job, result)
    with stages("Bust: stock to mesh"):
        result.setup.stock.to_mesh(tolerance=DETAIL).write(out / "bust-milled.stl")
        first = next(done.operation for done in result.operations if done.job.kind == "finish")
        result.setup.stock_before(first).to_mesh(tolerance=DETAIL).write(out / "bust-roughed.stl")
    return job, result


def judge(job: jobs.Job, result: jobs.Result, piece: report.Piece) -> None:
    """What LinuxCNC's interpreter makes of the NC code, and how far the stock that is left is from the part."""
    mesh, distance = result.deviation
    area = _areas(mesh)
    for name, share in (("left over the part, 50 % of the area", 0.5), ("95 %", 0.95), ("99 %", 0.99)):
        order = np.argsort(distance)
        piece.note(name, f"{distance[order][np.searchsorted(np.cumsum(area[order]), share * area.sum())]:.2g} mm")
    piece.note("deepest below the part", f"{max(0.0, -float(distance.min())):.2g} mm")
    piece.note("time on the machine", f"{result.seconds / 60:.0f} min")
    if nc_judge.interpreter() is None:
        piece.note("NC code judged", "left out: no LinuxCNC here")
        return
    _, joints = nc_judge.interpreted(job.program)
    program = result.program.transformed(_shift(-job.zero))
    turning = np.append(0, np.cumsum((np.diff(program.poses[:, 3:], axis=0) != 0).any(axis=1)))
    axes = nc_judge.tilting_table("A", job.machine_options["rot_point"], job.machine_options["offset"])
    off = nc_judge.between(joints, program.poses, axes, ~program.rapid, 1000 * turning + program.tool)
    piece.note("by LinuxCNC: tip off at rows", f"{off['at_mm']:.2g} mm")
    piece.note("between blocks", f"{off['tip_mm']:.2g} mm")
    piece.sound &= (
        off["at_mm"] < 2e-3 and off["tip_mm"] < 0.1 * max(done.operation.tolerance for done in result.operations) + 2e-3
    )


def _shift(by: np.ndarray) -> np.ndarray:
    out = np.eye(4)
    out[:3, 3] = by
    return out


def _areas(mesh: riffler.Mesh) -> np.ndarray:
    """Area around each vertex, mm²."""
    corners = mesh.vertices[mesh.triangles]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 6
    return np.bincount(np.ravel(mesh.triangles), np.repeat(area, 3), minlength=len(mesh.vertices))
