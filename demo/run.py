"""The whole workflow once, on real input: Suzanne, recorded pen strokes, STL, NC code, a replay elsewhere, a bust
milled from a block, pictures.

    python demo/run.py --out out/demo --blender-python .envs/bpy-4.5/bin/python

Suzanne becomes a tri-dexel stock, the strokes in demo/strokes.rjournal engrave her and the force along them is plotted.
The strokes are written as NC code for a tilting rotary table, LinuxCNC's interpreter and the benchmark's own forward
kinematics say where that takes the tool, and the code is read back and replayed on another stock with another tool.
Then a job mills Suzanne from a block (demo/milling.py): roughed, finished and pencilled from several sides, in one
program.
Exits with 1 if a mesh that was read back from its STL is not sound, or NC code takes the tool elsewhere.
"""

from __future__ import annotations

import argparse
import itertools
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))  # run as a script, not only as `python -m demo.run`

import riffler  # noqa: E402
from riffler_bench import nc_judge  # noqa: E402

from demo import egg, forces, milling, report  # noqa: E402

REPLAY_TOOL = riffler.Tool.ball(diameter=3.0, length=10.0)
POST = "linuxcnc-xyzac"
TABLE = {"rot_point": [0.0, 0.0, -90.0], "offset": [0.0, 0.0, 40.0]}  # the figure stands 24 mm over the rotary table
TOLERANCE = 0.01  # mm between blocks
DETAIL = 0.03  # mm that the triangles which are left out may move the surface
AWAY = 6.0  # mm from every stroke: the surface there is the figure's own


class Stages:
    """Wall time of what is done, in order."""

    def __init__(self) -> None:
        self.rows: list[tuple[str, float]] = []

    @contextmanager
    def __call__(self, name: str):
        """Yields a callable that shows the finished share, on a terminal."""
        print(f"{name} …", flush=True)
        start = time.perf_counter()
        yield (lambda share: print(f"  {share:4.0%}\r", end="", flush=True)) if sys.stdout.isatty() else None
        self.rows.append((name, time.perf_counter() - start))

    @property
    def last(self) -> float:
        return self.rows[-1][1]


def blender(python: Path, script: str, *arguments: object) -> None:
    """Runs one of our scripts in Blender's Python; its output appears only if it fails."""
    command = [str(python), str(ROOT / "demo" / script), *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600)
    if done.returncode:
        raise SystemExit(f"{script} failed ({done.returncode}):\n{done.stdout[-2000:]}\n{done.stderr[-4000:]}")


def ray_ends(volume: riffler.Volume) -> tuple[np.ndarray, int]:
    """Where material begins and ends on the rays, (n, 3), and the number of rays."""
    ends, rays = [], 0
    for name, (along, u, v) in {"x": (0, 1, 2), "y": (1, 2, 0), "z": (2, 0, 1)}.items():
        counts, spans = volume.intervals(name)
        i, j = np.divmod(np.repeat(np.arange(counts.size), counts.ravel()), counts.shape[1])
        points = np.empty((len(spans), 2, 3))
        points[:, :, along] = spans
        points[:, :, u] = (volume.lower[u] + (i + 0.5) * volume.pitch)[:, None]
        points[:, :, v] = (volume.lower[v] + (j + 0.5) * volume.pitch)[:, None]
        ends.append(points.reshape(-1, 3))
        rays += counts.size
    return np.concatenate(ends), rays


def distances(points: np.ndarray, mesh: riffler.Mesh) -> np.ndarray:
    """mm from each point to the mesh's surface."""
    return riffler.Mesh(points, np.zeros((0, 3), np.int32)).deviation(mesh)


def far_from(points: np.ndarray, places: np.ndarray, distance: float) -> np.ndarray:
    """Which of the points are surely farther than `distance` from all places: by cells of that size."""
    lower = np.minimum(points.min(axis=0), places.min(axis=0)) - distance
    near = np.zeros(((np.maximum(points.max(axis=0), places.max(axis=0)) - lower) // distance + 2).astype(int), bool)
    i, j, k = ((places - lower) // distance).astype(int).T
    for a, b, c in itertools.product((-1, 0, 1), repeat=3):
        near[i + a, j + b, k + c] = True
    return ~near[tuple(((points - lower) // distance).astype(int).T)]


def skin_error(carved: riffler.Mesh, figure: riffler.Mesh, journal: riffler.Journal, piece: report.Piece) -> None:
    """How far the carved mesh is from the figure where no tool came."""
    tips = np.concatenate([stroke.poses[:, :3] for stroke in journal.strokes])
    error = distances(carved.vertices[far_from(carved.vertices, tips, AWAY)], figure)
    piece.note("untouched skin to figure, mean", f"{error.mean():.2g} mm")
    piece.note("untouched skin to figure, 99.9 %", f"{np.quantile(error, 0.999):.2g} mm")
    piece.note("untouched skin to figure, max", f"{error.max():.2g} mm")


def carve_strokes(volume, journal, piece) -> list[forces.Felt]:
    tools = {number: riffler.Tool.from_dict(tool) for number, tool in journal.tools.items()}
    felt, removed, moves = [], 0.0, 0
    for stroke in journal.strokes:
        cut = volume.carve(tools[stroke.tool], stroke.poses, tolerance=stroke.tolerance, dt=np.diff(stroke.times))
        felt.append(forces.Felt(stroke.name, stroke.times[1:], cut.force, cut.torque))
        removed += float(cut.removed.sum())
        moves += len(cut.removed)
    piece.note("strokes", f"{len(felt)}")
    piece.note("moves", f"{moves:,}")
    piece.note("removed", f"{removed:,.1f} mm³")
    piece.note("force, largest", f"{max(np.linalg.norm(stroke.force, axis=1).max() for stroke in felt):.1f} N")
    return felt


def judge(program: riffler.Program, code: Path, piece) -> None:
    """Where LinuxCNC takes the tool: at the rows, and between any two blocks with all axes moving evenly."""
    if nc_judge.interpreter() is None:
        piece.note("NC code judged", "left out: no LinuxCNC here")
        return
    _, joints = nc_judge.interpreted(code)
    off = nc_judge.between(joints, program.poses, nc_judge.tilting_table("A", **TABLE), ~program.rapid, program.tool)
    piece.note("by LinuxCNC: tip off at rows", f"{off['at_mm']:.2g} mm")
    piece.note("between blocks", f"{off['tip_mm']:.2g} mm, {np.degrees(off['axis_rad']):.2g}°")
    # The interpreter prints four decimals, of degrees too.
    piece.sound &= off["at_mm"] < 2e-3 and off["tip_mm"] < TOLERANCE + 2e-3 and off["axis_rad"] < 1.8e-3


def replay(volume, program, tool, piece) -> None:
    """Every row of the program with one tool; rapids are swept as well and must not touch the stock."""
    cut = volume.carve(tool, program.poses, tolerance=0.01)
    in_rapids = float(cut.removed[program.rapid[1:]].sum())
    piece.note("moves", f"{len(cut.removed):,}")
    piece.note("removed", f"{cut.removed.sum():,.1f} mm³")
    piece.note("removed in rapids", f"{in_rapids:,.1f} mm³")


def mesh_and_check(volume, path: Path, piece, stages) -> riffler.Mesh:
    """Meshes the volume, writes it, and judges what a reader of the file gets."""
    with stages(f"{piece.name}: volume to mesh"):
        made, surface = volume.to_mesh_with_report(tolerance=DETAIL / 2)
    piece.note("volume to mesh", f"{stages.last:.2f} s")
    with stages(f"{piece.name}: decimated"):
        made = made.decimate(tolerance=DETAIL / 2)
    piece.note("decimated", f"{stages.last:.2f} s")
    with stages(f"{piece.name}: STL written, read back, audited"):
        made.write(path)
        mesh = riffler.Mesh.read(path)
        audit = mesh.audit()
    piece.note("triangles", f"{len(mesh.triangles):,}, within {DETAIL:g} mm of all {surface.all_triangles:,}")
    piece.note("audit after reading", report.describe_audit(audit))
    piece.note("pieces", f"{audit.components}")
    piece.sound &= not any(report.defects(audit).values())
    with stages(f"{piece.name}: error of the mesh"):
        ends, rays = ray_ends(volume)
        error = distances(ends, mesh)
    piece.note("rays", f"{rays:,} at {volume.pitch} mm")
    piece.note("volume of rays", f"{volume.volume:,.0f} mm³")
    piece.note("volume of mesh", f"{mesh.volume:,.0f} mm³")
    piece.note("ray ends to mesh, mean", f"{error.mean():.2g} mm")
    piece.note("ray ends to mesh, 99.9 %", f"{np.quantile(error, 0.999):.2g} mm")
    piece.note("ray ends to mesh, max", f"{error.max():.2g} mm")
    return mesh


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "demo")
    parser.add_argument("--blender-python", type=Path, default=ROOT / ".envs" / "bpy-4.5" / "bin" / "python")
    parser.add_argument("--pitch", type=float, default=0.25, help="mm between rays")
    parser.add_argument("--samples", type=int, default=24, help="of the renderer, which stops after 80 s at the latest")
    options = parser.parse_args()
    if not options.blender_python.exists():
        parser.error(f"{options.blender_python} is not there: a Python with Blender's module bpy 4.5 is needed")
    out, stages = options.out, Stages()
    out.mkdir(parents=True, exist_ok=True)
    head, other = report.Piece("Suzanne", "recorded tools"), report.Piece("Egg", f"replayed, {REPLAY_TOOL.name}")
    bust = report.Piece("Bust", "milled from a block")

    with stages("Suzanne from Blender"):
        blender(options.blender_python, "suzanne.py", out / "suzanne.stl")
    figure = riffler.Mesh.read(out / "suzanne.stl")
    with stages("Suzanne: mesh to volume"):
        volume = riffler.Volume.from_mesh(figure, options.pitch, "xyz")
    journal = riffler.Journal.load(ROOT / "demo" / "strokes.rjournal")
    with stages("Suzanne: carved, with force"):
        felt = carve_strokes(volume, journal, head)
    head.note("carving", f"{stages.last:.2f} s")
    with stages("force plotted"):
        forces.plot(out / "force.png", felt, "Force on the tool while the strokes carve Suzanne")
    carved = mesh_and_check(volume, out / "suzanne-carved.stl", head, stages)
    with stages("Suzanne: error of the untouched skin"):
        skin_error(carved, figure, journal, head)

    with stages("strokes to NC code and back"):
        journal.save(out / "strokes.rjournal")
        recorded = journal.program(spindle=12000.0)
        written = recorded.write(out / "strokes.ngc", post=POST, tolerance=TOLERANCE, options=TABLE)
        program = riffler.Program.read(out / "strokes.ngc", machine=POST, options=TABLE)
    other.note("NC blocks", f"{written.blocks:,} for {len(recorded):,} rows")
    with stages("NC code judged by LinuxCNC's interpreter"):
        judge(recorded, out / "strokes.ngc", other)
    with stages("Egg: mesh to volume"):
        stock = riffler.Volume.from_mesh(riffler.Mesh(*egg.build()), options.pitch, "xyz")
    with stages("Egg: NC code replayed"):
        replay(stock, program, REPLAY_TOOL, other)
    other.note("carving", f"{stages.last:.2f} s")
    mesh_and_check(stock, out / "egg-carved.stl", other, stages)

    with stages("Blender scene and render"):
        scene = (out / "suzanne-carved.stl", out / "egg-carved.stl", out / "riffler.blend", out / "riffler.png")
        blender(options.blender_python, "scene.py", *scene, "--samples", options.samples)

    job, result = milling.run(figure, out, stages)
    with stages("Bust: NC code judged by LinuxCNC's interpreter"):
        milling.judge(job, result, bust)
    with stages("Bust: scene and render"):
        shown = (out / "suzanne-carved.stl", out / "bust-roughed.stl", out / "bust-milled.stl")
        blender(options.blender_python, "scene_milled.py", *shown, out / "milled.blend", out / "milled.png",
                "--samples", max(1, options.samples // 2))  # fmt: skip

    names = ("suzanne.stl", "suzanne-carved.stl", "egg-carved.stl", "strokes.rjournal", "strokes.ngc", "force.png")
    milled = ("bust-milled.stl", "bust.ngc", "bust.html", "milled.blend", "milled.png")
    files = [out / name for name in (*names, "riffler.blend", "riffler.png", *milled)]
    report.show_operations(result)
    report.show([head, other, bust], stages.rows, [(str(path), path.stat().st_size) for path in files])
    return 0 if head.sound and other.sound and bust.sound else 1


if __name__ == "__main__":
    sys.exit(main())
