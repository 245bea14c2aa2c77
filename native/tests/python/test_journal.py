"""Journals from Python: to the bit and back, cut anywhere, replayed."""

import json

import numpy as np
import pytest
import riffler

BALL = riffler.Tool.ball(6, 30).named("ball é")


def stroke(n, seed=0):
    rng = np.random.default_rng(seed)
    t = np.linspace(0, 1, n)
    axis = np.column_stack([0.2 * np.sin(t), 0.1 * np.cos(t), np.ones(n)])
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    tips = np.column_stack([10 + 30 * t, 20 + 5 * np.sin(9 * t), 28 - t]) + rng.normal(size=(n, 3)) * 1e-3
    return np.column_stack([tips, axis]), np.cumsum(rng.uniform(1e-3, 2e-3, n))


@pytest.fixture
def journal():
    j = riffler.Journal()
    j.set_stock((0, 0, 0), (50, 40, 30), 0.5, directions="xyz", snapshot="stock.rvol")
    j.add_tool(1, BALL)
    j.add_tool(2, riffler.Tool.flat(4, 20).to_dict())
    j.add_note("artist", "Ünal")
    for k in range(3):
        poses, times = stroke(50 + k, k)
        j.add_stroke(1 + k % 2, poses, times=times, tolerance=0.02, name=f"stroke {k}")
    return j


def test_a_file_keeps_everything_to_the_bit(journal, tmp_path):
    file = tmp_path / "a.rjournal"
    journal.save(file)
    j = riffler.Journal.load(file)
    assert j.cut_at is None and repr(j) == "<riffler.Journal: 3 strokes>"
    assert j.notes == {"artist": "Ünal"}
    assert j.tools == {1: BALL.to_dict(), 2: riffler.Tool.flat(4, 20).to_dict()}
    assert j.stock.pitch == 0.5 and j.stock.directions == "xyz" and j.stock.snapshot == "stock.rvol"
    assert j.stock.lower.tolist() == [0, 0, 0] and j.stock.upper.tolist() == [50, 40, 30]
    for k, s in enumerate(j.strokes):
        poses, times = stroke(50 + k, k)
        assert (s.tool, s.tolerance, s.name, len(s)) == (1 + k % 2, 0.02, f"stroke {k}", 50 + k)
        assert s.poses.tobytes() == poses.tobytes() and s.times.tobytes() == times.tobytes()
    first = file.read_bytes()
    j.save(file)
    assert file.read_bytes() == first


def test_forces_and_cuts_come_back_to_the_bit(tmp_path):
    file = tmp_path / "a.rjournal"
    poses, times = stroke(40)
    rng = np.random.default_rng(3)
    forces, removed = rng.normal(size=(40, 6)), rng.uniform(size=40)
    with riffler.JournalWriter(file, keep=False) as w:
        w.add_tool(1, BALL)
        w.add_stroke(1, poses[:10], times=times[:10], forces=forces[:10], removed=removed[:10])
        w.extend_stroke(poses[10:], times=times[10:], forces=forces[10:], removed=removed[10:])
        with pytest.raises(ValueError, match="forces must be as many as poses"):
            w.extend_stroke(poses, times=times + 9, removed=removed)
        w.add_stroke(1, poses, removed=removed)
        with pytest.raises(ValueError, match="forces for a stroke that has none"):
            w.extend_stroke(poses, removed=removed, forces=forces)
        with pytest.raises(RuntimeError, match="does not keep"):
            _ = w.journal
    felt, cut = riffler.Journal.load(file).strokes
    assert felt.forces.tobytes() == forces.tobytes() and felt.removed.tobytes() == removed.tobytes()
    assert cut.forces is None and cut.times is None and cut.removed.tobytes() == removed.tobytes()


def test_strokes_are_undone_and_redone(journal, tmp_path):
    last = journal.strokes[2]
    journal.undo(2)
    assert [s.name for s in journal.strokes] == ["stroke 0"]
    with pytest.raises(IndexError, match="taken back"):
        _ = last.poses
    assert len(journal.program()) == 52
    journal.save(tmp_path / "a.rjournal")
    read = riffler.Journal.load(tmp_path / "a.rjournal")
    read.redo()
    assert [s.name for s in read.strokes] == ["stroke 0", "stroke 1"]
    with riffler.JournalWriter(tmp_path / "a.rjournal") as w:
        w.redo(2)
        w.undo()
        w.add_stroke(1, stroke(3)[0], name="last")
    assert [s.name for s in riffler.Journal.load(tmp_path / "a.rjournal").strokes] == ["stroke 0", "stroke 1", "last"]


def test_a_truncated_file_gives_its_whole_strokes_and_the_place_of_the_cut(journal, tmp_path):
    file = tmp_path / "a.rjournal"
    journal.save(file)
    whole = file.read_bytes()
    for size in range(len(whole) - 1, 16, -37):
        file.write_bytes(whole[:size])
        j = riffler.Journal.load(file)
        assert len(j.strokes) < 3
        assert j.cut_at is None or j.cut_at < size
        for s, t in zip(j.strokes, journal.strokes, strict=False):
            assert s.poses.tobytes() == t.poses.tobytes()
    damaged = bytearray(whole)
    damaged[40] ^= 1
    file.write_bytes(damaged)
    with pytest.raises(riffler.FormatError, match=r"^a\.rjournal, byte 16: "):
        riffler.Journal.load(file)
    file.write_bytes(b"not a journal at all")
    with pytest.raises(riffler.FormatError, match="byte 0"):
        riffler.Journal.load(file)


def test_a_writer_continues_where_a_crash_truncated_the_file(tmp_path):
    file = tmp_path / "a.rjournal"
    poses, times = stroke(30)
    with riffler.JournalWriter(file) as w:
        w.set_stock((0, 0, 0), (50, 40, 30), 0.5)
        w.add_tool(1, json.dumps(BALL.to_dict()))
        w.add_stroke(1, poses[:10], times=times[:10])
        w.extend_stroke(poses[10:], times=times[10:])
        w.sync()
        assert len(riffler.Journal.load(file).strokes[0]) == 30, "there before the writer is closed"
        with pytest.raises(RuntimeError):
            riffler.JournalWriter(file)
    with pytest.raises(RuntimeError, match="closed"):
        w.add_note("a", "b")
    file.write_bytes(file.read_bytes()[:-5])
    with riffler.JournalWriter(file) as w:
        assert len(w.journal.strokes[0]) == 10
        w.add_stroke(1, poses)
    j = riffler.Journal.load(file)
    assert j.cut_at is None and [len(s) for s in j.strokes] == [10, 30] and j.strokes[1].times is None


def same(a, b):
    return all(
        x.tobytes() == y.tobytes()
        for direction in "xyz"
        for x, y in zip(a.intervals(direction), b.intervals(direction), strict=True)
    )


def test_replay_reproduces_the_session(journal, tmp_path):
    session = riffler.Volume.block((0, 0, 0), (50, 40, 30), 0.5, directions="xyz")
    session.save(tmp_path / "stock.rvol")
    for s in journal.strokes:
        session.carve(riffler.Tool.from_dict(journal.tools[s.tool]), s.poses, tolerance=s.tolerance)
    journal.save(tmp_path / "a.rjournal")
    shares = []
    left = riffler.Journal.load(tmp_path / "a.rjournal").replay(tmp_path, progress=shares.append)
    assert left.volume < 50 * 40 * 30 and same(left, session)
    assert same(riffler.Session.replay(tmp_path / "a.rjournal"), session)
    assert shares == sorted(shares) and shares[-1] == 1
    with pytest.raises(riffler.Cancelled):
        journal.replay(tmp_path, progress=lambda share: share < 0.5)
    with pytest.raises(ValueError, match="name its folder"):
        journal.replay()
    with pytest.raises(riffler.FormatError, match=r"stock\.rvol"):
        journal.replay(tmp_path / "nowhere")


def test_a_program_has_the_strokes_with_their_tools_and_feeds(journal):
    p = journal.program(spindle=9000)
    assert p.tools == {1: BALL, 2: riffler.Tool.flat(4, 20)} and p.provenance == {"artist": "Ünal"}
    assert len(p) == sum(len(s) + 2 for s in journal.strokes)
    assert (p.spindle == 9000).all() and [number for number, _ in p.cuts()] == [1, 2, 1]
    poses, times = stroke(50)
    np.testing.assert_allclose(p.poses[1:51], poses, rtol=0, atol=1e-15)
    wanted = np.linalg.norm(np.diff(poses[:, :3], axis=0), axis=1) / np.diff(times) * 60
    np.testing.assert_allclose(p.feed[2:51], wanted, rtol=1e-9)
    assert p.poses[0, 2] >= 40, "above the stock"
    assert set(journal.program(feed=500).feed) == {0, 500}


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda j: j.set_stock((0, 0, 0), (1, 1, 1), 1), "stock"),
        (lambda j: j.add_tool(1, "{}"), "tool 1 is another tool already"),
        (lambda j: j.add_tool(3, "no json"), "Expecting value"),
        (lambda j: j.add_tool(3, 5), "tool must be"),
        (lambda j: j.add_stroke(9, stroke(3)[0]), "tool 9 is not in the journal"),
        (lambda j: j.add_stroke(1, np.zeros((0, 6))), "at least one pose"),
        (lambda j: j.add_stroke(1, np.zeros((2, 5))), "poses must have the shape"),
        (lambda j: j.add_stroke(1, np.zeros((2, 6))), "poses, row 0"),
        (lambda j: j.add_stroke(1, stroke(3)[0], times=[1, 2]), "times must be as many"),
        (lambda j: j.add_stroke(1, stroke(3)[0], times=[]), "times must be as many"),
        (lambda j: j.add_stroke(1, stroke(3)[0], times=[1, 2, np.nan]), "times, row 2"),
        (lambda j: j.add_stroke(1, stroke(3)[0], times=[1, 3, 2]), "times, row 2"),
        (lambda j: j.add_stroke(1, stroke(3)[0], tolerance=0), "tolerance"),
        (lambda j: j.add_stroke(1, stroke(3)[0], forces=np.zeros((2, 6))), "forces must be as many"),
        (lambda j: j.add_stroke(1, stroke(3)[0], forces=np.zeros((3, 3))), "forces must have the shape"),
        (lambda j: j.add_stroke(1, stroke(3)[0], forces=np.full((3, 6), np.inf)), "forces, row 0"),
        (lambda j: j.add_stroke(1, stroke(3)[0], removed=[1, 2]), "removed must be as many"),
        (lambda j: j.add_stroke(1, stroke(3)[0], removed=[1, -2, 0]), "removed, row 1"),
        (lambda j: j.extend_stroke(stroke(3)[0]), "times must be as many"),
        (lambda j: j.undo(4), "from 1 to 3"),
        (lambda j: j.undo(0), "from 1 to 3"),
        (lambda j: j.redo(), "no stroke to redo"),
    ],
)
def test_errors_are_named_and_change_nothing(journal, tmp_path, call, message):
    journal.save(tmp_path / "before")
    with pytest.raises(ValueError, match=message):
        call(journal)
    journal.save(tmp_path / "after")
    assert (tmp_path / "before").read_bytes() == (tmp_path / "after").read_bytes()


def test_modes_and_masks_are_kept_and_replayed(tmp_path):
    lower, upper = (0, 0, 0), (50, 40, 30)
    stock = riffler.Volume.block(lower, upper, 0.5, "xyz")
    mask = riffler.Volume.empty(lower, upper, 0.5, "xyz")
    tool = riffler.Tool.ball(6, 30)
    lanes = {
        m: np.array([[5.0, y, 27, 0, 0, 1], [45, y, 27, 0, 0, 1]])
        for m, y in (("mask", 10), ("unmask", 12), ("remove", 11), ("add", 14))
    }
    mask.carve(tool, lanes["mask"] + [0, 20, 0, 0, 0, 0], mode="add")
    riffler.submit(riffler.Volume.save, stock, tmp_path / "stock.rvol").result()
    mask.save(tmp_path / "mask.rvol")
    file = tmp_path / "a.rjournal"
    with riffler.JournalWriter(file, keep=False) as w:
        w.set_stock(lower, upper, 0.5, "xyz", snapshot="stock.rvol", mask="mask.rvol")
        w.add_tool(1, tool)
        for mode, poses in lanes.items():
            w.add_stroke(1, poses, mode=mode, name=mode)
        with pytest.raises(ValueError, match='mode must be "remove"'):
            w.add_stroke(1, poses, mode="Add")
    mask.carve(tool, lanes["mask"], mode="add")
    mask.carve(tool, lanes["unmask"])
    stock.carve(tool, lanes["remove"], protect=mask)
    stock.carve(tool, lanes["add"], protect=mask, mode="add")
    j = riffler.Journal.load(file)
    assert [s.mode for s in j.strokes] == list(lanes) and j.stock.mask == "mask.rvol"
    for volume, kept in (
        j.replay_with_mask(tmp_path),
        riffler.submit(riffler.Journal.replay_with_mask, j, tmp_path).result(),
    ):
        assert volume.to_bytes() == stock.to_bytes() and kept.to_bytes() == mask.to_bytes()
    assert j.replay(tmp_path).to_bytes() == stock.to_bytes()
    assert riffler.Journal.load(file).replay_with_mask(tmp_path)[1].volume > 0
    j.undo(4)
    assert j.replay_with_mask(tmp_path)[1].to_bytes() != mask.to_bytes()
