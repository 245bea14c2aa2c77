"""Random volumes of both kinds → binary STL → read again → audit, and the volume beside that of the rays."""

from __future__ import annotations

import tempfile
from pathlib import Path

from ... import Mesh
from ..measure import Progress, Settings, watched
from ..report import Column, Report
from ..scenes import random_volume

COUNTS = ("open_edges", "nonmanifold_edges", "nonmanifold_vertices", "degenerate", "duplicates", "folds")


def run(settings: Settings, progress: Progress = None) -> Report:
    count = 30 if settings.quick else 1000
    out = Report("random", {"volumes": count})
    table = out.section(
        "meshes",
        f"{count} random volumes of each kind, meshed, written as binary STL, read again and audited",
        *(Column(name.replace("_", " "), name) for name in ("kind", "meshes", "empty", "triangles", *COUNTS)),
        Column("worst volume difference (share of area · h)", "worst", lambda v: f"{v:.3f}"),
    )
    totals = {
        kind: dict.fromkeys(("meshes", "empty", "triangles", *COUNTS), 0) | {"worst": 0.0} for kind in ("z", "xyz")
    }
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "volume.stl"
        for kind, seed in watched([(kind, seed) for kind in totals for seed in range(count)], progress):
            volume, total = random_volume(seed, kind), totals[kind]
            volume.to_mesh().write(path)
            if not volume.volume or path.stat().st_size <= 84:
                total["empty"] += 1
                continue
            mesh = Mesh.read(path)
            audit = mesh.audit()
            for name in COUNTS:
                total[name] += int(audit[name])
            total["meshes"] += 1
            total["triangles"] += len(mesh.triangles)
            total["worst"] = max(total["worst"], abs(mesh.volume - volume.volume) / (mesh.area * volume.pitch))
    for kind, total in totals.items():
        table.row(kind=kind, **total)
        out.check(not any(total[name] for name in COUNTS), f"{kind}: defects in meshes, {total}")
    return out
