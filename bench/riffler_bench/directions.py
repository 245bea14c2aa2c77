"""A session's stroke with rays in one direction and in three: what a step costs, and the ratio."""

from __future__ import annotations

import numpy as np

from . import _bench as core
from . import report, scenes
from .measure import Progress, Settings, quantile, watched
from .report import Column, Report

PITCHES = 0.4, 0.2, 0.15, 0.1  # mm
SHOWN = 33  # steps from one look of the display to the next
STEP = 0.5  # mm
TURNS = 3


def strokes(out: Report, settings: Settings, progress: Progress = None) -> None:
    table = out.section(
        "directions",
        "Ø20 ball sunk to its centre, 0.5 mm a step, shown every 33 steps: processor time of one step",
        Column("h mm", "pitch", report.pitch),
        Column("axis", "axis"),
        Column("z, median", "z_s", report.micro),
        Column("xyz, median", "xyz_s", report.micro),
        Column("xyz ÷ z", "ratio", report.ratio),
        Column("rays changed, xyz ÷ z", "work", report.ratio),
        Column("xyz, 99 %", "p99_s", report.micro),
        Column("each step complete, xyz", "direct_s", report.micro),
    )
    pitches = (0.4,) if settings.quick else PITCHES
    steps = 60 if settings.quick else 400
    for pitch, turning in watched([(h, t) for h in pitches for t in (False, True)], progress):
        poses = scenes.spiral(steps, STEP, (40, 40), turning)
        runs = {"z": [], "xyz": [], "direct": []}
        for _ in range(TURNS):
            for name in runs:
                shown = 0 if name == "direct" else SHOWN
                directions = "z" if name == "z" else "xyz"
                runs[name].append(core.direction_run(poses, directions, pitch, shown))
        medians = {name: np.median([np.median(run["seconds"]) for run in runs[name]]) for name in runs}
        one, three = runs["z"][0], runs["xyz"][0]
        table.row(
            pitch=pitch, axis="turning" if turning else "upright", z_s=medians["z"], xyz_s=medians["xyz"],
            ratio=medians["xyz"] / medians["z"], work=three["changed"] / one["changed"],
            p99_s=float(np.median([quantile(np.sort(run["seconds"]), 0.99) for run in runs["xyz"]])),
            direct_s=medians["direct"],
        )  # fmt: skip
        out.check(abs(three["removed"] - one["removed"]) < 1e-9 * one["removed"], f"{pitch:g}: z and xyz differ")
        out.check(
            all(run["removed"] == three["removed"] for name in ("xyz", "direct") for run in runs[name]),
            f"{pitch:g}: tiles that stay open give another volume",
        )
    table.notes.append(
        "z and xyz take turns, three times; medians of the runs. Where the display looks, the next steps publish "
        "the tiles that changed, a part each. Targets: xyz at most 4 × z; 99 % within 0.5 ms at 0.2 mm and 1 ms at "
        "0.15 mm."
    )
