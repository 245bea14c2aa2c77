"""Meshes of random volumes from the degenerate limits: the meshing stress run (native/stress/mesh_scenes.hpp)."""

from __future__ import annotations

from .. import _bench as core
from ..measure import Progress, Settings
from ..report import Column, Report


def run(settings: Settings, progress: Progress = None) -> Report:
    count = 500 if settings.quick else 20_000
    out = Report("random", {"volumes": count})
    table = out.section(
        "meshes",
        f"{count} random volumes, meshed, rounded to float32, welded and audited",
        *(Column(name, name) for name in ("scene", "volumes", "empty", "triangles", "failures")),
    )
    result = core.mesh_stress(count, 1, progress)
    for scene in result["scenes"]:
        table.row(**scene)
    for failure in result["failures"]:
        out.check(False, failure)
    table.notes.append(f"{result['thread_checks']} of them were meshed with 1 and with 4 threads: the same bytes.")
    return out
