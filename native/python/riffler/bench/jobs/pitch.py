"""Time and memory against pitch: B200's ball, block, carve and mesh, each pitch in a process of its own."""

from __future__ import annotations

from .. import report, scenes
from ..measure import Progress, Settings, Yardstick, child, watched
from ..report import Column, Report

TARGETS = {"bytes_per_ray": 24, "peak_bytes_at_0.15": 100e6}


def run(settings: Settings, progress: Progress = None) -> Report:
    pitches = (1.0, 0.5) if settings.quick else (1.0, 0.5, 0.25, 0.15, 0.1, 0.05)
    out = Report("pitch", {"targets": TARGETS})
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
        Column("bytes a ray, block", "fresh_per_ray", lambda b: f"{b:.1f}"),
        Column("carved", "carved_per_ray", lambda b: f"{b:.1f}"),
        Column("volume", "carved_bytes", report.megabytes),
        Column("whole process, mesh included", "peak_bytes", report.megabytes),
        Column("carved only", "peak_bytes_carve", report.megabytes),
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
            fresh_per_ray=whole["fresh_bytes"] / whole["rays"], carved_per_ray=whole["carved_bytes"] / whole["rays"],
            carved_bytes=whole["carved_bytes"], peak_bytes=whole["peak_bytes"], peak_bytes_carve=bare["peak_bytes"],
            removed_short=(removed - whole["removed"]) / removed,
        )  # fmt: skip
    table.notes.append("Targets: at most 24 bytes a ray of one span; below 100 MB in all at h = 0.15.")
    return out
