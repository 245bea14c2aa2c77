"""Names of journals, the displayed shape of the tool, and a device's session with its journal."""

import time
from datetime import datetime

import numpy as np
import pytest
import riffler

from addon.common.contents import Content
from addon.pen.pure import pen_run
from addon.sculpt.pure import journal

BALL = riffler.Tool.ball(6, 30)
WHEN = datetime(2026, 1, 2, 3, 4, 5)


@pytest.mark.parametrize(
    ("name", "expected"),
    [("Stock.001", "Stock.001"), ("a/b\\c:d", "a_b_c_d"), ("..", "sculpt"), ("", "sculpt"), ("Größe 6", "Größe 6")],
)
def test_a_journal_is_named_after_sculpt_and_date(name, expected):
    assert pen_run.journal_name(name, WHEN) == f"{expected} 2026-01-02 03-04-05.rjournal"


class Mouse:
    """A device that a test moves; strokes along x, 1 mm deep."""

    def __init__(self):
        self.pen, self._time = riffler.pen.Pointer("mouse"), 0.0
        self.pen.set_frame(origin=(0, 0, 10), depth=1.0)
        self.give(-10, 0, 0)

    def give(self, x, y, pressed):
        self._time += 0.004
        self.pen.give(x, y, pressure=float(pressed), buttons=int(pressed), time=self._time)
        time.sleep(0.004)

    def stroke(self, y):
        self.give(5, y, 0)
        time.sleep(0.02)
        for x in np.arange(5.0, 25):
            self.give(x, y, 1)
        for _ in range(5):
            self.give(40, y, 0)


@pytest.mark.parametrize("masked", [False, True])
def test_the_rows_of_a_run_agree_with_its_journal_and_states_survive_a_crash(tmp_path, masked):
    box = ((0, 0, 0), (30, 30, 10), 0.5, "z")
    volume, mask = riffler.Volume.block(*box), riffler.Volume.empty(*box)
    mask.carve(BALL, np.array([[10.0, 10, 8, 0, 0, 1], [20, 20, 8, 0, 0, 1]]), mode="add")
    mouse = Mouse()
    options = {"material": riffler.Material(removal_constant=1e-5), "stiffness": 5.0}
    run = pen_run.PenRun(mouse.pen, BALL, options)
    session = run.prepare(volume, mask if masked else None)
    kept = journal.SessionJournal(session, tmp_path, Content(volume.copy(), [], mask if masked else None), "t0")
    run.start()
    states, rows, seen = {"t0": volume.to_bytes()}, [], 0
    for k, token in enumerate(("t1", "t2", "t3")):
        mouse.stroke(8 + 6 * k)
        end = time.monotonic() + 10
        while run.strokes == seen or run.in_stroke:
            assert time.monotonic() < end
            run.look()
        kept.made(run.strokes - seen)
        kept.finish(token)
        seen = run.strokes
        rows += run.taken_rows()
        states[token] = volume.to_bytes()
    assert session.undo() == 1 and kept.go("t2") and kept.token == "t2" and not kept.go("x")
    assert run.halt() == "" and not run.running
    assert journal.crashed(tmp_path)  # no process holds it, as after a crash
    kept.stopped()
    assert journal.crashed(tmp_path) == []
    for token, expected in states.items():
        assert kept.state(token).volume.to_bytes() == expected
    found, cuts = journal.part_of(kept.folder)
    assert len(cuts) == 2 and {c.mode for c in cuts} == {"remove"}
    assert journal.states(kept.folder, {"token": "t0"}, found) == ["t0", "t1", "t2"]
    for stroke, ours in zip(found.strokes, rows[:2], strict=True):
        moved = np.r_[True, (np.diff(stroke.poses, axis=0) != 0).any(axis=1)]
        assert np.array_equal(stroke.poses[moved], ours)
    path = tmp_path / "recording.rjournal"
    journal.write_recording(kept.folder, path, {"sculpt": "Stock"})
    assert riffler.Session.replay(path).to_bytes() == states["t2"]
    kept.delete()
    run.close()
    assert not kept.folder.exists()


def test_the_priority_of_a_thread_without_motors_is_not_reported():
    run = pen_run.PenRun(riffler.pen.Pointer("mouse"), BALL, {})
    assert run.thread == "", "no session yet"
    run.prepare(riffler.Volume.block((0, 0, 0), (10, 10, 10), 1.0))
    run.start()
    assert run.running and run.thread == ""
    run.halt()
    run.close()


def test_an_unplugged_pen_has_no_force_and_a_reason_and_gets_its_force_again():
    device = riffler.pen.open("simulated")
    box = ((-40, -40, -40), (40, 40, 0), 1.0, "z")
    run = pen_run.PenRun(device, BALL, {"at": [0, 0, 1, 0, 0, 1], "ramp": 0.05})
    run.prepare(riffler.Volume.block(*box))
    run.start()

    def looks_until(what):
        end = time.monotonic() + 20
        while not what() and time.monotonic() < end:
            time.sleep(0.02)
            run.look()
        assert what(), (run.state, run.force, run.why)

    try:
        looks_until(lambda: run.state in ("ready", "ramp", "active") and run.pose is not None)
        run.force = 1.0  # as of a frame in contact
        device.unplug()
        looks_until(lambda: run.why == "the simulated pen is unplugged; plug it in again")
        assert run.gone and run.state == "off" and run.force == 0 and not run.push.any()
        device.plug()
        looks_until(lambda: run.state in ("ready", "ramp", "active") and run.why == "")
        assert not run.gone
        granted = run.session.priority
        assert run.thread.startswith(f"Thread: {granted.text}") and granted.remedy in run.thread
    finally:
        run.halt()
        run.close()


def test_a_tool_that_waits_for_a_query_says_so():
    part = riffler.Volume.block((-30, -30, -20), (30, 30, -0.01), 1.0).to_mesh()
    options = {"at": (0, 0, 0, 0, 0, 1), "obstacles": riffler.Collider(part), "budget": 0.0}  # no time for queries
    run = pen_run.PenRun(riffler.pen.open("simulated"), BALL, options)
    run.prepare(riffler.Volume.block((-30, -30, -20), (30, 30, 0), 1.0))
    run.start()
    end = time.monotonic() + 20
    while "the tool waits" not in run.why and time.monotonic() < end:
        run.look()
        time.sleep(0.02)
    run.halt()
    run.close()
    assert "the tool waits" in run.why
