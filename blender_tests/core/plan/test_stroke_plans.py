"""Recordings that are moved before they become plans."""

import numpy as np
import riffler

from addon.plan.pure.stroke_plans import placed

TURN = np.array([[0, -1, 0, 5], [1, 0, 0, -2], [0, 0, 1, 7], [0, 0, 0, 1]], float)  # 90° about z
FIELDS = ("times", "tolerance", "name", "removed", "mode", "strength", "amount", "falloff")


def test_a_moved_stroke_keeps_everything_but_its_forces():
    recording = riffler.Journal()
    recording.add_tool(3, riffler.Tool.ball(6, 30))
    rows = [(0, 10, 8, 1, 0, 0), (20, 10, 8, 0, 0, 1)]
    recording.add_stroke(
        3, rows, times=(0, 1.5), tolerance=0.02, name="first", forces=np.ones((2, 6)), removed=(0, 4.0), strength=0.3
    )
    recording.add_stroke(3, rows, mode="inflate", amount=1.5, falloff="sharp")
    moved = placed(recording, TURN)
    assert list(moved.tools) == [3]
    for before, after in zip(recording.strokes, moved.strokes, strict=True):
        assert np.allclose(after.poses, [(-5, -2, 15, 0, 1, 0), (-5, 18, 15, 0, 0, 1)], atol=1e-12)
        for field in FIELDS:
            assert np.array_equal(getattr(before, field), getattr(after, field)), field
        assert after.forces is None or not len(after.forces)
