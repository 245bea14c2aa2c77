"""The same job with 1, 2 and 4 threads, each in a process of its own: the files must have the same bytes."""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from report import Table

JOB = """
import sys, numpy as np, riffler
sys.path.insert(0, sys.argv[1])
from scenes import BLOCK, b200_poses
poses = b200_poses()
k = np.arange(len(poses))
axes = np.stack([.3 * np.sin(.05 * k), .2 * np.cos(.03 * k), np.ones(len(k))], 1)
poses[:, 3:] = axes / np.linalg.norm(axes, axis=1)[:, None]
v = riffler.Volume.block(*BLOCK, 0.4, "xyz")
cut = v.carve(riffler.Tool.fillet(8, 1, 30), poses, tolerance=0.01, dt=0.001)
np.concatenate([cut.removed[:, None], cut.force, cut.torque], 1).tofile(sys.argv[2] + "/forces.bin")
v.save(sys.argv[2] + "/volume.rvol")
v.to_mesh().write(sys.argv[2] + "/mesh.stl")
w = riffler.Volume.from_mesh(v.to_mesh(), 0.5, "xyz")
w.save(sys.argv[2] + "/again.rvol")
"""


def run():
    files = ("forces.bin", "volume.rvol", "mesh.stl", "again.rvol")
    table = Table("The same bytes for any number of threads (SHA-256, first 12 digits)", "threads", *files)
    seen = set()
    for threads in ("1", "2", "4"):
        with tempfile.TemporaryDirectory() as folder:
            here = str(Path(__file__).resolve().parent)
            subprocess.run(
                [sys.executable, "-c", JOB, here, folder], check=True, env={**os.environ, "RIFFLER_THREADS": threads}
            )
            digests = tuple(hashlib.sha256((Path(folder) / f).read_bytes()).hexdigest()[:12] for f in files)
        table.row(threads, *digests)
        seen.add(digests)
    return table, len(seen) == 1
