"""A mesh that follows strokes: the time of an update, and that of the whole mesh."""

from __future__ import annotations

import statistics
import time

import numpy as np
from riffler import Mesher, Tool, Volume

from .. import report, scenes
from ..measure import Progress, Settings, steady, watched
from ..report import Column, Report

TARGET = 1e-3  # s per brick
STROKES = {
    "in one tile, Ø1": (Tool.ball(1, 20), [[44, 12, 29.7], [44.2, 12, 29.7]]),
    "Ø6, 0.5 mm": (Tool.ball(6, 20), [[50, 15, 28.5], [50.5, 15, 28.5]]),
}


def run(settings: Settings, progress: Progress = None) -> Report:
    out = Report("follow", {"target_s": TARGET})
    table = out.section(
        "strokes",
        "Processor time of B200's mesh after another stroke, one thread",
        Column("directions", "directions"),
        Column("h mm", "pitch", report.pitch),
        Column("stroke", "stroke"),
        Column("bricks", "bricks"),
        Column("changed", "changed"),
        Column("triangles in these", "triangles", report.mega),
        Column("update", "update_s", report.micro),
        Column("update, a brick", "brick_s", report.micro),
        Column("their patches", "patches_s", report.micro),
        Column("whole mesh", "whole_s", report.micro),
    )
    pitches = (0.5,) if settings.quick else (0.5, 0.25, 0.1)
    for directions, pitch in watched([(d, h) for d in ("xyz", "z") for h in pitches], progress):
        volume = Volume.block(*scenes.BLOCK, pitch, directions)
        cutter = scenes.cutters()[0]
        volume.carve(cutter.tool, cutter.path(False))
        for name, (tool, tips) in STROKES.items():
            row = table.row(directions=directions, pitch=pitch, stroke=name, **timed(volume, tool, np.array(tips)))
            out.check(row["same"], f"{directions}, h = {pitch:g}, {name}: not the mesh of the whole volume")
    table.notes.append(
        "Medians over a stroke and its undo, in turn. A brick has 32 × 32 × 32 cells and some thousand triangles. "
        "Patches: float32 vertices and int32 triangles as numpy arrays. Target: 1 ms for a changed tile."
    )
    return out


def timed(volume: Volume, tool: Tool, tips: np.ndarray) -> dict[str, object]:
    before = volume.snapshot()
    updates, patches, wholes = [], [], []
    with steady():
        mesher = Mesher(volume)
        bricks = len(mesher.patches())
        for turn in range(21):
            if turn % 2:
                volume.restore(before)
            else:
                volume.carve(tool, scenes.upright(tips))
            start = time.thread_time()
            changed = mesher.update(volume)
            updated = time.thread_time()
            triangles = sum(len(mesher.patch(n).triangles) for n in changed)
            updates.append(updated - start), patches.append(time.thread_time() - updated)
        for _ in range(3):
            start = time.thread_time()
            whole = volume.to_mesh()
            wholes.append(time.thread_time() - start)
        followed = mesher.mesh()
        same = np.array_equal(followed.vertices, whole.vertices) and np.array_equal(followed.triangles, whole.triangles)
        volume.restore(before)
    update = statistics.median(updates)
    return {
        "bricks": bricks, "changed": len(changed), "triangles": triangles, "update_s": update,
        "brick_s": update / max(1, len(changed)), "patches_s": statistics.median(patches),
        "whole_s": statistics.median(wholes), "same": bool(same),
    }  # fmt: skip
