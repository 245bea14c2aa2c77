"""Half a million triangles to a tenth: time, distance of the surfaces from each other, defects, against others."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from riffler import Mesh

from .. import _bench as core
from .. import parts, report
from ..measure import Progress, Settings, child, threads, watched
from ..report import Column, Report
from ..rivals import LeftOutError, ask
from .mesh import BAD, DEFECT_COLUMNS, OTHER

RIVALS = {"fast-simplification": "fast_simplification", "meshoptimizer": "meshoptimizer", "VTK quadric": "vtk"}


def run(settings: Settings, progress: Progress = None) -> Report:
    count = 20_000 if settings.quick else 500_000
    out = Report("decimate", {"triangles": count})
    table = out.section(
        "parts",
        f"{count:,} triangles to a tenth, one thread, parts of 100 mm".replace(",", "\u2009"),
        Column("part", "part"),
        Column("engine", "engine"),
        Column("processor time", "cpu_s", report.micro),
        Column("wall time", "wall_s", report.micro),
        Column("triangles", "triangles"),
        Column("largest distance mm", "max_mm", report.mm),
        Column("RMS", "rms_mm", report.mm),
        *DEFECT_COLUMNS,
    )
    with tempfile.TemporaryDirectory() as folder:
        path = str(Path(folder) / "part")
        cases = [(make, engine) for make in (parts.organic, parts.sharp) for engine in ("Riffler", *RIVALS)]
        for make, engine in watched(cases, progress):
            part = make(count)
            np.save(f"{path}.vertices.npy", part.vertices)
            np.save(f"{path}.triangles.npy", part.triangles)
            given = {"wanted": count // 10, "repeats": 1 if engine.startswith("VTK") else 3}
            try:
                if engine == "Riffler":
                    figures = {"engine": engine, **child("decimate", path=path, **given)}
                else:
                    figures = ask(settings, "simplify.py", RIVALS[engine], 1, mesh=path, **given)
            except LeftOutError as why:
                table.row(part=make.__name__, engine=f"{engine}: left out, {why}")
                continue
            less = Mesh(np.load(f"{path}.out.vertices.npy"), np.load(f"{path}.out.triangles.npy"))
            figures |= judged(part, less, 20_000 if settings.quick else 500_000)
            table.row(part=make.__name__, **figures)
            if engine == "Riffler":
                out.check(not figures["bad"] + figures["others"], f"{make.__name__}: {figures}")
    table.notes.append(
        "Distances from each surface to the other, at points drawn evenly over both and at all vertices, found by a "
        "search of its own (native/bench/mesh_distance.hpp); the largest is the Hausdorff distance as far as these "
        "points see it."
    )
    return out


def judged(part: Mesh, less: Mesh, points: int) -> dict[str, Any]:
    with threads(None):
        there = core.mesh_distances(drawn(less, points), part)
        back = core.mesh_distances(drawn(part, points), less)
    audit = less.audit()
    return {
        "max_mm": float(max(there.max(), back.max())),
        "rms_mm": float(np.sqrt(max(np.mean(there**2), np.mean(back**2)))),
        "bad": sum(int(getattr(audit, name)) for name in BAD),
        "others": sum(int(getattr(audit, name)) for name in OTHER),
    }


def drawn(mesh: Mesh, count: int) -> np.ndarray:
    """Points evenly over a mesh's surface, and its vertices."""
    rng = np.random.default_rng(1)
    corners = np.asarray(mesh.vertices)[np.asarray(mesh.triangles)]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    upto = np.cumsum(areas)
    face = np.searchsorted(upto, upto[-1] * (np.arange(count) + rng.random(count)) / count)
    a, b = rng.random((2, count, 1))
    a, b = np.where(a + b > 1, 1 - a, a), np.where(a + b > 1, 1 - b, b)
    c = corners[np.minimum(face, len(corners) - 1)]
    return np.concatenate([mesh.vertices, c[:, 0] + a * (c[:, 1] - c[:, 0]) + b * (c[:, 2] - c[:, 0])])
