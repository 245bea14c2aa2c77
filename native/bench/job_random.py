"""1 000 random volumes of both kinds → binary STL → read again → audit, and the volume beside that of the rays."""

from __future__ import annotations

import tempfile
from pathlib import Path

import riffler
from report import Table
from scenes import random_volume

COUNTS = ("open_edges", "nonmanifold_edges", "nonmanifold_vertices", "degenerate", "duplicates", "folds")


def run(count: int = 1000):
    table = Table(
        f"{count} random volumes, meshed, written as binary STL, read again",
        *("kind", "meshes", "empty", "triangles", *COUNTS, "worst volume difference (share of area · h)"),
    )
    ok = True
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "volume.stl"
        for kind in ("z", "xyz"):
            totals, triangles, empty, worst = dict.fromkeys(COUNTS, 0), 0, 0, 0.0
            for seed in range(count):
                volume = random_volume(seed, kind)
                volume.to_mesh().write(path)
                if not volume.volume or path.stat().st_size <= 84:
                    empty += 1
                    continue
                mesh = riffler.Mesh.read(path)
                audit = mesh.audit()
                for name in COUNTS:
                    totals[name] += audit[name]
                triangles += len(mesh.triangles)
                worst = max(worst, abs(mesh.volume - volume.volume) / (mesh.area * volume.pitch))
            table.row(kind, count - empty, empty, triangles, *totals.values(), f"{worst:.3f}")
            ok &= not any(totals.values())
    return table, ok
