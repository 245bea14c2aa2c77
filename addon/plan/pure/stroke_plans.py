"""Plans of recorded strokes, without Blender."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import riffler

from ...common import poses
from ...sculpt.pure.journal import add_again


def journal_of(cuts) -> riffler.Journal:
    """A recording of the cuts (common/job.py) of a sculpt."""
    journal, numbers = riffler.Journal(), {}
    for cut in cuts:
        text = json.dumps(cut.tool, sort_keys=True)
        if text not in numbers:
            numbers[text] = len(numbers) + 1
            journal.add_tool(numbers[text], cut.tool)
        journal.add_stroke(numbers[text], cut.poses)
    return journal


def placed(recording: riffler.Journal, to_world: np.ndarray) -> riffler.Journal:
    """The recording's strokes, moved by a rotation and a translation (4, 4)."""
    out = riffler.Journal()
    for number, tool in recording.tools.items():
        out.add_tool(number, tool)
    for stroke in recording.strokes:
        rows = stroke.poses
        directions = [poses.unit(rows[:, k : k + 3] @ to_world[:3, :3].T) for k in range(3, rows.shape[1], 3)]
        moved = np.hstack([poses.transform_points(to_world, rows[:, :3]), *directions])
        add_again(out, stroke, poses=moved, forces=None)  # forces have the old directions
    return out


class Making:
    """The plans of a journal, one for each tool: `run` takes as long as there are strokes, and touches no Blender."""

    def __init__(self, journal, to_world, part: riffler.Mesh, part_name: str, name: str, bounds: dict):
        self._journal, self._to_world, self._part = journal, to_world, part
        self._part_name, self._name, self._bounds = part_name, name, bounds

    def run(self, progress) -> list[riffler.plan.Recorded]:
        """ValueError if no stroke makes a path; tools of which none does are left out otherwise."""
        journal = placed(self._journal, self._to_world)
        part = riffler.plan.part_of(self._part, self._part_name)
        used = sorted({s.tool for s in journal.strokes if s.mode in riffler.plan.recorded.CUTS})
        found, error = [], None
        for k, tool in enumerate(used or [None]):
            try:
                one = riffler.plan.from_recording(
                    journal,
                    tool=tool,
                    name=self._name,
                    progress=lambda share, k=k: progress((k + share) / max(1, len(used))),
                    **self._bounds,
                )
            except riffler.plan.NoPathError as why:
                error = error or why
                continue
            others = [note for note in one.notes if "of another tool" not in note or len(used) < 2]
            found.append(replace(one, plan=replace(one.plan, part=part), notes=others))
        if not found:
            raise error
        return found
