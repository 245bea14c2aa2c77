"""Time, memory and the mesh's error against pitch. B200's ball in a process of its own for each pitch; and a groove
whose exact surface is known, for what lies between the rays."""

from __future__ import annotations

from typing import Any

import numpy as np
from riffler import Mesh, Tool, Volume

from .. import report, scenes
from ..measure import Progress, Settings, Yardstick, child, watched
from ..report import Column, Report

TARGETS = {"bytes_per_ray": 24, "peak_bytes_at_0.15": 100e6}
RADIUS = 3.0  # mm, of the groove's ball
GROOVE = np.array([[8.0, 8.0, 9.0], [30.0, 20.0, 8.5]])  # from where to where its centre goes
SLOPES = {"gentle": (0, 20), "middling": (20, 45), "steep": (45, 60)}  # degrees against the level


def run(settings: Settings, progress: Progress = None) -> Report:
    pitches = (1.0, 0.5) if settings.quick else (1.0, 0.5, 0.25, 0.15, 0.1, 0.05)
    out = Report("pitch", {"targets": TARGETS, "radius": RADIUS})
    b200(out, settings, pitches, progress)
    surface(out, pitches)
    return out


def b200(out: Report, settings: Settings, pitches: tuple[float, ...], progress: Progress) -> None:
    table = out.section(
        "b200",
        "B200 with a Ø6 ball against pitch, one thread",
        Column("directions", "directions"),
        Column("h mm", "pitch", report.pitch),
        Column("rays", "rays", report.mega),
        Column("one move", "move_s", report.micro),
        Column("loop", "loop_s", report.micro),
        Column("mesh", "mesh_s", report.micro),
        Column("triangles", "triangles", report.mega),
        Column("bytes a ray", "per_ray", lambda b: f"{b:.1f}"),
        Column("memory of B200", "carved_bytes", report.megabytes),
        Column("of the process, carving", "peak_bytes_carve", report.megabytes),
        Column("and meshing", "peak_bytes", report.megabytes),
        Column("removed less than exact", "removed_short", report.percent),
    )
    for directions, pitch in watched([(d, h) for d in ("z", "xyz") for h in pitches], progress):
        if directions == "xyz" and pitch < 0.1:
            table.notes.append(f"xyz, h = {pitch:g}: left out, its mesh would have more than 10 M triangles.")
            continue
        whole = child("b200", pitch=pitch, directions=directions)
        bare = child("b200", pitch=pitch, directions=directions, mesh=False)
        loop = Yardstick(pitch, settings.quick).alone()
        removed = scenes.B200_REMOVED
        table.row(
            directions=directions, pitch=pitch, move_s=bare["carve_s"] / scenes.MOVES, mesh_s=whole["mesh_s"],
            loop_s=loop / scenes.MOVES, rays=whole["rays"], triangles=whole["triangles"],
            per_ray=whole["skimmed_bytes"] / whole["rays"],
            carved_bytes=whole["carved_bytes"], peak_bytes=whole["peak_bytes"], peak_bytes_carve=bare["peak_bytes"],
            removed_short=(removed - whole["removed"]) / removed,
        )  # fmt: skip
    table.notes.append(
        "Bytes a ray: after cuts that write every ray and leave one span on each; tiles that were never written are "
        "shared, so B200 needs less. Targets: at most 24 bytes a ray in one direction; below 100 MB in all at h = 0.15."
    )


def surface(out: Report, pitches: tuple[float, ...]) -> None:
    table = out.section(
        "surface",
        "How far the mesh is from the exact surface of a groove, ball Ø6, oblique",
        Column("directions", "directions"),
        Column("h mm", "pitch", report.pitch),
        *(
            Column(f"{text}{low}° to {high}°", f"{name}_{which}_mm", report.mm)
            for which, text in (("max", "largest mm, "), ("rms", "RMS, "))
            for name, (low, high) in SLOPES.items()
        ),
        Column("h² ÷ 4 R", "sag_mm", report.mm),
        Column("h ÷ 2", "half_mm", report.mm),
    )
    for directions in ("z", "xyz"):
        for pitch in (h for h in pitches if h >= 0.1):
            volume = Volume.block([0, 0, 0], [40, 30, 10], pitch, directions)
            volume.carve(Tool.ball(2 * RADIUS, 30), scenes.upright(GROOVE - [0, 0, RADIUS]))
            sag = pitch**2 / (4 * RADIUS)
            table.row(
                directions=directions, pitch=pitch, sag_mm=sag, half_mm=pitch / 2, **mesh_errors(volume.to_mesh())
            )
    table.notes.append("Vertices, middles of edges and of triangles; slope of the surface against the level.")


def mesh_errors(mesh: Mesh) -> dict[str, Any]:
    """Distances of the mesh's points from the groove, a capsule's wall, by slope."""
    corners = np.asarray(mesh.vertices)[np.asarray(mesh.triangles)]
    middles = [(corners[:, a] + corners[:, b]) / 2 for a, b in ((0, 1), (1, 2), (2, 0))]
    points = np.concatenate([np.asarray(mesh.vertices), corners.mean(1), *middles])
    start, way = GROOVE[0], GROOVE[1] - GROOVE[0]
    along = np.clip((points - start) @ way / (way @ way), 0, 1)
    off = points - start - along[:, None] * way
    distance = np.linalg.norm(off, axis=1)
    # Not the block's other faces, and not the groove's upper rim, which is an edge.
    groove = (abs(distance - RADIUS) < RADIUS / 4) & (points[:, 2] > 1) & (points[:, 2] < 9)
    slope = np.degrees(np.arccos(np.clip(-off[:, 2] / distance, -1, 1)))
    out = {}
    for name, (low, high) in SLOPES.items():
        error = abs(distance - RADIUS)[groove & (slope >= low) & (slope < high)]
        out[f"{name}_max_mm"], out[f"{name}_rms_mm"] = float(error.max()), float(np.sqrt(np.mean(error**2)))
    return out
