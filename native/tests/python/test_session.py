"""Sessions: a device, a tool and a stock, journalled, replayed, made into NC code."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import textwrap
import time

import numpy as np
import pytest
import riffler

BALL = riffler.Tool.ball(6, 30)


def stock(pitch: float = 0.5, directions: str = "z") -> riffler.Volume:
    return riffler.Volume.block((-30, -30, -20), (30, 30, 0), pitch, directions)


def same(a: riffler.Volume, b: riffler.Volume) -> bool:
    return a.to_bytes() == b.to_bytes()


def frames(session: riffler.Session, seconds: float, done=lambda frame: False) -> list[riffler.SessionFrame]:
    """Thirty a second, until one of them is what was waited for."""
    out = []
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        out.append(session.frame())
        if done(out[-1]):
            break
        time.sleep(0.033)
    return out


def carve_with_the_simulated_pen(tmp_path, directions: str = "z"):
    volume = stock(0.5, directions)
    with riffler.pen.open("simulated") as pen:
        session = riffler.Session(
            volume, BALL, pen, at=(0, 0, 1, 0, 0, 1), scale=0.5, material=riffler.Material(removal_constant=0.005)
        )
        session.journal(tmp_path / "a.rjournal", notes={"who": "the tests"})
        with session:
            seen = frames(session, 20, lambda frame: frame.strokes >= 2)
    return volume, session, seen


@pytest.mark.parametrize("directions", ["z", "xyz"])
def test_the_simulated_pen_carves_and_the_replay_is_the_same_to_the_bit(tmp_path, directions):
    volume, session, seen = carve_with_the_simulated_pen(tmp_path, directions)
    assert volume.volume < stock().volume - 5
    assert not session.running
    assert same(volume, riffler.Session.replay(tmp_path / "a.rjournal"))
    journal = riffler.Journal.load(tmp_path / "a.rjournal")
    assert journal.notes["who"] == "the tests" and "waits" not in journal.notes
    assert sum(s.removed.sum() for s in journal.strokes) == pytest.approx(stock().volume - volume.volume, rel=1e-9)
    assert any(np.abs(s.forces).max() > 0.01 for s in journal.strokes)
    told = sum(frame.removed.sum() for frame in seen)
    assert 0 < told <= stock().volume - volume.volume + 1e-6


def test_a_session_reports_the_priority_of_its_thread():
    could = riffler.pen.real_time()
    # In the device's thread, and in one of the session's own.
    for pen in (riffler.pen.open("simulated"), riffler.pen.Pointer("tablet")):
        session = riffler.Session(stock(), BALL, pen, at=(0, 0, 5, 0, 0, 1))
        assert session.priority.level in (0, could.level)
        with session:
            frames(session, 20, lambda _, session=session: session.priority.level == could.level)
            assert (session.priority.level, session.priority.by) == (could.level, could.by)
            assert session.priority.text.startswith("real time" if could.level else "normal")
        pen.stop()


def test_the_values_of_a_frame_agree(tmp_path):
    _, _, seen = carve_with_the_simulated_pen(tmp_path)
    times = np.concatenate([frame.times for frame in seen])
    assert (np.diff(times) > 0).all()
    assert seen[-1].dropped_ticks == 0
    for frame in seen:
        n = len(frame)
        assert frame.poses.shape == frame.grips.shape == frame.forces.shape == frame.applied.shape == (n, 6)
        assert frame.tiles.shape[1] == 2
        for column in (frame.removed, frame.energy, frame.depth, frame.step_seconds, frame.dt, frame.missed):
            assert column.shape == (n,)
        assert np.allclose(np.linalg.norm(frame.poses[:, 3:], axis=1), 1)
        if n:
            assert (frame.tool == frame.poses[-1]).all()
            assert (frame.force == frame.forces[-1, :3]).all()
        assert frame.removed[frame.cutting == 0].sum() == 0
    assert {frame.state for frame in seen} <= {"off", "homing", "ready", "ramp", "active", "degraded", "tripped"}


def test_a_recording_becomes_nc_code_and_a_session_again(tmp_path):
    """Record → NC → replay: the same tool over the program's own poses leaves the same volume within the tolerance."""
    volume, _, _ = carve_with_the_simulated_pen(tmp_path)
    journal = riffler.Journal.load(tmp_path / "a.rjournal")
    program = journal.program(feed=600, spindle=10000)
    table = {"rot_point": [0, 0, 0]}
    program.write(tmp_path / "a.ngc", post="linuxcnc-xyzac", options=table | {"safe_start": False})
    back = riffler.Program.read(tmp_path / "a.ngc", machine="linuxcnc-xyzac", options=table)
    again = stock()
    for _, poses in back.cuts():
        again.carve(BALL, poses)
    removed = stock().volume - volume.volume
    assert again.volume == pytest.approx(volume.volume, abs=0.01 * removed)
    # Played as a device, where it was and as fast as it was, it carves nearly the same again.
    again = stock()
    with (
        riffler.pen.open(tmp_path / "a.rjournal") as pen,
        riffler.Session(again, BALL, pen, material=riffler.Material(removal_constant=1e-6)) as session,
    ):
        frames(session, 30, lambda frame: pen.health().state == "stopped")
    assert again.volume == pytest.approx(volume.volume, abs=0.1 * (stock().volume - volume.volume))


def test_undo_and_redo_are_in_the_journal(tmp_path):
    volume = stock()
    pen = riffler.pen.Pointer("mouse")
    pen.set_frame(depth=1)
    session = riffler.Session(volume, BALL, pen, material=riffler.Material(removal_constant=1e-4))
    session.journal(tmp_path / "b.rjournal")
    clock = 0.0

    def stroke(y: float, number: int) -> bytes:
        nonlocal clock
        for x in np.linspace(-40, 40, 21):
            clock += 0.005
            pen.give(x, y, pressure=1.0, buttons=1, time=clock)
            time.sleep(0.005)
        clock += 0.005
        pen.give(40, y, time=clock)
        frames(session, 5, lambda frame: frame.strokes >= number and not frame.in_stroke)
        return volume.to_bytes()

    with session:
        pen.give(-40, -10, time=clock)
        time.sleep(0.02)
        first = stroke(-10, 1)
        second = stroke(0, 2)
        assert session.undo() == 1
        assert volume.to_bytes() == first
        assert session.redo() == 1
        assert volume.to_bytes() == second
        assert session.undo() == 1
        third = stroke(10, 3)
        assert session.redo() == 0
    assert volume.to_bytes() == third
    assert same(volume, riffler.Session.replay(tmp_path / "b.rjournal"))
    assert len(riffler.Journal.load(tmp_path / "b.rjournal").strokes) == 2


CHILD = """
import sys, time, riffler
volume = riffler.Volume.block((-30, -30, -20), (30, 30, 0), 0.5)
pen = riffler.pen.open("simulated")
session = riffler.Session(volume, riffler.Tool.ball(6, 30), pen, at=(0, 0, 1, 0, 0, 1), scale=0.5,
                          material=riffler.Material(removal_constant=0.005))
session.journal(sys.argv[1])
session.start()
while True:
    frame = session.frame()
    if frame.in_stroke:
        print(frame.times[-1] if len(frame) else 0, flush=True)
    time.sleep(0.02)
"""


def test_a_killed_session_loses_less_than_a_second(tmp_path):
    path = tmp_path / "killed.rjournal"
    child = subprocess.Popen(
        [sys.executable, "-c", textwrap.dedent(CHILD), str(path)],
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
    )
    try:
        last = 0.0
        for _ in range(30):
            last = float(child.stdout.readline())
    finally:
        child.send_signal(signal.SIGKILL)
        child.wait()
    journal = riffler.Journal.load(path)
    kept = journal.strokes[-1].times[-1]
    print(f"kill -9 at {last:.3f} s, journal up to {kept:.3f} s")
    assert kept > last - 1
    volume = riffler.Session.replay(path)
    assert volume.volume < stock().volume


def test_a_session_stops_if_its_volume_is_changed_elsewhere():
    volume = stock()
    with riffler.Session(volume, BALL) as session:
        volume.carve(BALL, [(0, 0, -1, 0, 0, 1), (5, 0, -1, 0, 0, 1)])
        with pytest.raises(RuntimeError, match="changed by something else"):
            session.frame()
        with pytest.raises(RuntimeError, match="changed by something else"):
            session.stop()


def test_without_a_device_a_mouse_is_given():
    volume = stock()
    with riffler.Session(volume, BALL, material=riffler.Material(removal_constant=1e-4)) as session:
        assert isinstance(session.pen, riffler.pen.Pointer) and session.pen.kind == "mouse"
        session.pen.set_frame(depth=1)
        for k in range(100):
            session.pen.give(-30 + 0.4 * k, 0, pressure=1.0, buttons=1, time=0.002 * k)
            time.sleep(0.002)
        frames(session, 0.1)
    assert volume.volume < stock().volume - 10


def test_bad_input_is_named(tmp_path):
    volume = stock()
    with pytest.raises(TypeError, match="there is no argument speed"):
        riffler.Session(volume, BALL, speed=3)
    for memory in (None, 0.2):
        riffler.Session(volume, BALL, memory=memory)
    with pytest.raises(ValueError, match="memory must be positive"):
        riffler.Session(volume, BALL, memory=0)
    with pytest.raises(ValueError, match="scale must be positive"):
        riffler.Session(volume, BALL, scale=0)
    with pytest.raises(TypeError, match="stiffness must be a number"):
        riffler.Session(volume, BALL, stiffness="hard")
    with pytest.raises(ValueError, match="at must be six numbers"):
        riffler.Session(volume, BALL, at=(1, 2, 3))
    with pytest.raises(ValueError, match="turn must have the shape"):
        riffler.Session(volume, BALL, turn=[1, 2])
    with pytest.raises(ValueError, match="turn must be orthonormal"):
        riffler.Session(volume, BALL, turn=np.eye(3) * 2)
    with pytest.raises(ValueError, match="removal_constant"):
        riffler.Material(removal_constant=-1)
    session = riffler.Session(volume, BALL)
    with pytest.raises(RuntimeError, match="is not running"):
        session.frame()
    (tmp_path / "there.rjournal").write_bytes(b"")
    with pytest.raises(ValueError, match="is there already"):
        session.journal(tmp_path / "there.rjournal")
    with pytest.raises(RuntimeError, match="cannot be written: No such file"):
        session.journal(tmp_path / "none" / "a.rjournal")
    session.start()
    with pytest.raises(RuntimeError, match="once"):
        session.start()
    with pytest.raises(RuntimeError, match="has started"):
        session.journal(tmp_path / "late.rjournal")
    session.stop()


def test_a_session_ends_with_its_object():
    for _ in range(20):
        pen = riffler.pen.open("simulated")
        session = riffler.Session(stock(1), BALL, pen)
        session.start()
        del session
        pen.stop()


def three_strokes_and_a_walk_back(session, pen, volume):
    """By a pointer, across the middle; each is undone and made again to the bit, and the last one stays undone. What
    was shown meanwhile."""
    at, states, seen = 0.0, [volume.to_bytes()], []

    def give(x, y, pressed):
        nonlocal at
        at += 0.004
        pen.give(x, y, pressure=float(pressed), buttons=int(pressed), time=at)
        time.sleep(0.004)

    give(-5, -40, 0)
    with session:
        for x in (-12.0, 0.0, 12.0):
            give(x, -20, 0)
            time.sleep(0.02)
            for y in np.arange(-20, 20, 1.0):
                give(x + 0.05 * y, y, 1)
            for _ in range(5):
                give(x, 20, 0)
            seen += frames(session, 10, lambda frame: frame.strokes >= len(states) and not frame.in_stroke)
            states.append(volume.to_bytes())
        assert session.undo() == 1 and volume.to_bytes() == states[2]
        assert session.redo() == 1 and volume.to_bytes() == states[3]
        assert session.undo() == 1
    assert volume.to_bytes() == states[2] and len(set(states)) == 4
    return seen


def same_inside(mask, volume, before):
    """What lies in a mask is what it was, which is returned."""
    inside, was = volume.copy(), before.copy()
    inside.intersect(mask), was.intersect(mask)
    for direction in volume.directions:
        for a, b in zip(inside.intervals(direction), was.intervals(direction), strict=True):
            assert np.array_equal(a, b)
    return was


@pytest.mark.parametrize("directions", ["z", "xyz"])
def test_protected_material_stays_to_the_bit_also_in_the_replay(tmp_path, directions):
    mask = riffler.Volume.empty((-30, -30, -20), (30, 30, 0), 0.5, directions)
    mask.carve(BALL, np.array([[-20.0, 0, -2, 0, 0, 1], [20, 1, -2, 0, 0, 1]]), mode="add")
    volume = stock(0.5, directions)
    before = volume.copy()
    pen = riffler.pen.Pointer("mouse")
    pen.set_frame(depth=1.5)
    options = {"material": riffler.Material(removal_constant=1e-5), "stiffness": 5.0}
    session = riffler.Session(volume, BALL, pen, protect=mask, **options)
    session.journal(tmp_path / "a.rjournal")
    three_strokes_and_a_walk_back(session, pen, volume)
    assert same(volume, riffler.Session.replay(tmp_path / "a.rjournal"))
    was, beside = same_inside(mask, volume, before), volume.copy()
    beside.subtract(mask)
    assert beside.volume < before.volume - was.volume - 20
    journal = riffler.Journal.load(tmp_path / "a.rjournal")
    assert {s.mode for s in journal.strokes} == {"beside"} and journal.stock.mask == "a-mask.rvol"


@pytest.mark.parametrize("directions", ["z", "xyz"])
@pytest.mark.parametrize("masked", [False, True])
def test_added_material_is_not_felt_and_replays_to_the_bit(tmp_path, directions, masked):
    volume, mask = stock(0.5, directions), None
    volume.carve(riffler.Tool.flat(100, 40), np.array([[-60.0, 0, -4, 0, 0, 1], [60, 0, -4, 0, 0, 1]]))
    if masked:
        mask = riffler.Volume.empty((-30, -30, -20), (30, 30, 0), 0.5, directions)
        mask.carve(BALL, np.array([[-20.0, 0, -6, 0, 0, 1], [20, 1, -6, 0, 0, 1]]), mode="add")
    before = volume.copy()
    pen = riffler.pen.Pointer("mouse")
    pen.set_frame(depth=3)
    material = riffler.Material(removal_constant=0.01, damping=0.1)
    session = riffler.Session(volume, BALL, pen, protect=mask, mode="add", material=material, stiffness=5.0)
    session.journal(tmp_path / "a.rjournal")
    seen = three_strokes_and_a_walk_back(session, pen, volume)
    assert same(volume, riffler.Session.replay(tmp_path / "a.rjournal"))
    assert volume.volume > before.volume + 50
    if masked:
        same_inside(mask, volume, before)
    assert not np.concatenate([frame.tool_forces for frame in seen]).any()
    journal = riffler.Journal.load(tmp_path / "a.rjournal")
    assert {s.mode for s in journal.strokes} == {"build"} and journal.stock.mask == ("a-mask.rvol" if masked else "")
    put_on = sum(s.removed.sum() for s in journal.strokes)
    assert put_on == pytest.approx(volume.volume - before.volume, rel=1e-6)


def test_an_unknown_mode_is_named():
    with pytest.raises(ValueError, match=r'^mode must be "remove" or "add", not "smooth"$'):
        riffler.Session(stock(), BALL, mode="smooth")


def test_a_mask_on_another_grid_is_refused():
    mask = riffler.Volume.empty((-30, -30, -20), (30, 30, 0), 0.4, "z")
    with pytest.raises(ValueError, match="protect"):
        riffler.Session(stock(), BALL, protect=mask)


def test_the_force_on_the_tool_is_the_materials(tmp_path):
    _, _, seen = carve_with_the_simulated_pen(tmp_path)
    force, ends, starts, removed, dt = (
        np.concatenate([getattr(frame, name) for frame in seen])
        for name in ("tool_forces", "poses", "starts", "removed", "dt")
    )
    assert force.shape == ends.shape == starts.shape
    assert np.array_equal(starts[1:], ends[:-1])  # placed once
    assert not force[removed == 0].any()
    cut = np.flatnonzero((removed > 1e-3) & (force[:, :3] != 0).any(axis=1))
    assert len(cut) > 20
    assert np.allclose(np.linalg.norm(force[cut, :3], axis=1), 0.005 * removed[cut] / dt[cut], rtol=0.5)
    assert (np.einsum("ij,ij->i", force[cut, :3], (ends - starts)[cut, :3]) < 0).mean() > 0.95


def at_rest(session):
    """The tool's pose once it stands still."""
    last, end = None, time.monotonic() + 20
    while time.monotonic() < end:
        time.sleep(0.15)
        frame = session.frame()
        if len(frame) and last is not None and np.abs(frame.tool - last).max() < 0.01:
            return frame.tool
        last = frame.tool if len(frame) else last
    raise AssertionError("the tool does not come to rest")


@pytest.mark.parametrize("pivot", [0.0, 30.0])
def test_a_hand_that_turns_turns_the_tool_about_the_pivot(pivot):
    with riffler.pen.open("simulated") as pen:
        at = (0, 0, 30, 0, 0, 1)
        with riffler.Session(stock(1.0), BALL, pen, at=at, pivot=pivot, turn_stiffness=2e4) as session:
            end = time.monotonic() + 20
            while not pen.state().homed and time.monotonic() < end:
                time.sleep(0.01)
            pen.aim(pen.state().pose)
            before, held = at_rest(session), pen.state().pose
            pen.aim([*held[:3], np.sin(0.3), 0, np.cos(0.3)])
            after, turned = at_rest(session), pen.state().pose
    angle = np.arccos(np.clip(before[3:] @ after[3:], -1, 1))
    assert angle > 0.15, "the hand has turned"
    point = after[:3] + pivot * after[3:] - (before[:3] + pivot * before[3:])
    assert np.abs(point - (np.subtract(turned, held))[:3]).max() < 0.5, "the pivot goes where the grip's point goes"
    if pivot:
        assert np.linalg.norm(after[:3] - before[:3]) > 0.5 * pivot * angle, "and the tip swings about it"


def test_a_bad_pivot_is_named():
    with pytest.raises(ValueError, match="pivot must be at most 1000 mm"):
        riffler.Session(stock(1.0), BALL, pivot=float("nan"))


def test_a_tool_that_waits_for_a_query_is_reported_in_frames_and_journal(tmp_path):
    part = riffler.Volume.block((-30, -30, -20), (30, 30, -0.01), 1.0).to_mesh()
    with riffler.pen.open("simulated") as pen:
        options = {"at": (0, 0, 0, 0, 0, 1), "obstacles": riffler.Collider(part), "budget": 0.0}  # no time for queries
        session = riffler.Session(stock(), BALL, pen, **options)
        session.journal(tmp_path / "held.rjournal")
        with session:
            seen = frames(session, 20, lambda frame: len(frame) and frame.held[-1])
    waits = [frame for frame in seen if len(frame) and frame.held[-1]]
    assert waits and all("the tool waits" in frame.problem for frame in waits)
    note = riffler.Journal.load(tmp_path / "held.rjournal").notes["waits"]
    assert int(note.split()[0]) >= sum(frame.held.sum() for frame in seen) > 0 and "the tool waits" in note
