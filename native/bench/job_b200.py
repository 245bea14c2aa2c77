"""B200: time a move, triangles per second and memory, beside Manifold and Blender's booleans in the same run."""

from __future__ import annotations

import itertools
import json
import os
import statistics
import subprocess
import sys
import time
from pathlib import Path

from report import Table
from scenes import b200_centres

HERE = Path(__file__).resolve().parent
BLENDER = Path(os.environ.get("RIFFLER_BLENDER_PYTHON", ".envs/bpy-4.5/bin/python"))

OURS = """
import json, resource, sys, time
sys.path.insert(0, sys.argv[1])
import riffler
from scenes import BLOCK, b200_poses
pitch, directions, poses, tool = float(sys.argv[2]), sys.argv[3], b200_poses(), riffler.Tool.ball(6, 30)
carve, mesh = [], []
for _ in range(3):
    v = riffler.Volume.block(*BLOCK, pitch, directions)
    t = time.perf_counter(); cut = v.carve(tool, poses); carve.append(time.perf_counter() - t)
    t = time.perf_counter(); m = v.to_mesh(); mesh.append(time.perf_counter() - t)
print(json.dumps({"carve": sorted(carve)[1], "mesh": sorted(mesh)[1], "triangles": len(m.triangles),
                  "removed": float(cut.removed.sum()),
                  "memory": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024}))
"""

EXACT = 180000 - 177055.25  # mm³ removed by a ball end mill that reaches out of the block


def ours(table: Table, pitch: float, directions: str, threads: str) -> None:
    env = {**os.environ, "RIFFLER_THREADS": threads}
    out = subprocess.run(
        [sys.executable, "-c", OURS, str(HERE), str(pitch), directions], check=True, capture_output=True, env=env
    )
    r = json.loads(out.stdout)
    table.row(
        f"Riffler {directions}, h = {pitch}, {threads} thread(s)",
        f"{r['carve'] / 200 * 1e6:.1f} µs",
        f"{r['triangles'] / r['mesh'] / 1e6:.2f} M tri/s ({r['triangles']})",
        f"{100 * (1 - r['removed'] / EXACT):+.3f} %",
        f"{r['memory']:.0f} MB",
    )


def manifold(table: Table, segments: int = 64) -> None:
    try:
        import manifold3d
    except ImportError:
        table.row("Manifold (manifold3d is not installed: left out)", "", "", "", "")
        return
    c = b200_centres()
    ball = manifold3d.Manifold.sphere(3, segments)
    solid = manifold3d.Manifold.cube([100, 60, 30])
    times = []
    for a, b in itertools.pairwise(c):
        start = time.perf_counter()
        swept = manifold3d.Manifold.batch_hull([ball.translate(a), ball.translate(b)])
        solid = solid - swept
        solid.num_tri()
        times.append(time.perf_counter() - start)
    removed = 180000 - solid.volume()
    # A bare capsule leaves 177 091.43 mm³: its own limit.
    limit = 180000 - 177091.43
    table.row(
        f"Manifold {segments} segments, hull of two balls",
        f"{statistics.median(times) * 1e6:.0f} µs",
        f"inherent ({solid.num_tri()})",
        f"{100 * (limit - removed) / limit:+.2f} %",
        "",
    )


def blender(table: Table, solver: str, moves: int) -> None:
    if not BLENDER.exists():
        table.row(f"Blender {solver} ({BLENDER} is missing: left out)", "", "", "", "")
        return
    out = subprocess.run(
        [str(BLENDER), str(HERE / "blender_boolean.py"), solver, str(moves)],
        capture_output=True,
        text=True,
        timeout=900,
    )
    lines = [x for x in out.stdout.splitlines() if x.startswith("{")]
    if not lines:
        table.row(f"Blender {solver} (failed: left out)", "", "", "", "")
        return
    r = json.loads(lines[-1])
    table.row(
        f"Blender {r['version']} boolean {solver}, first {moves} static balls",
        f"{r['median'] * 1e6:.0f} µs",
        f"inherent ({r['triangles']})",
        f"volume left {r['volume']:.0f} mm³ of 180 000",
        "",
    )


def run():
    table = Table("B200", "engine", "time a move (median)", "mesh", "removed volume less than exact", "peak memory")
    for pitch in (0.5, 0.25, 0.15):
        ours(table, pitch, "z", "1")
    for pitch in (0.25, 0.15):
        ours(table, pitch, "xyz", "1")
    ours(table, 0.15, "xyz", "2")
    manifold(table)
    for solver, moves in (("FLOAT", 60), ("MANIFOLD", 60), ("EXACT", 20)):
        blender(table, solver, moves)
    return table, True
