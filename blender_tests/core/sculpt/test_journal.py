"""When a live sculpt is packed, and the journal of its session, without Blender."""

import importlib.util
import json
import os
import sys
import types

import numpy as np
import pytest
import riffler

from addon.common import packing
from addon.common.contents import Content
from addon.common.job import Cut
from addon.common.poses import moving
from addon.sculpt.pure import journal

BALL = riffler.Tool.ball(6, 30)
BOX = ((0, 0, 0), (40, 30, 10), 0.5, "xyz")


def row(x, y=10.0, z=8.0):
    return [x, y, z, 0.0, 0.0, 1.0]


def lane(y, *xs):
    return np.array([row(x, y) for x in xs])


class Work:
    """Carves and records, like a live sculpt."""

    def __init__(self, root, cuts=(), shaped=False, **more):
        self.volume, self.mask = riffler.Volume.block(*BOX), None
        self.journal = journal.LiveJournal(root, Content(self.volume.copy(), list(cuts), shaped=shaped), "t0", **more)
        self.states = {"t0": self.volume.to_bytes()}

    def carve(self, poses, mode, token):
        if mode in ("mask", "unmask"):
            self.mask = self.mask or riffler.Volume.empty(*BOX)
            self.mask.carve(BALL, poses, mode="add" if mode == "mask" else "remove")
        elif mode == "soften":
            self.volume.smooth(poses[:, :3], 3.0, strength=0.8, protect=self.mask)
        else:
            self.volume.carve(BALL, poses, mode=mode, protect=self.mask)
        self.journal.carved(BALL.to_dict(), poses, mode, token, 0.8)

    def stroke(self, token, poses, mode="remove"):
        self.carve(poses, mode, token)
        self.journal.finish(token)
        self.states[token] = self.volume.to_bytes()


def test_every_state_is_replayed(tmp_path):
    work = Work(tmp_path)
    work.stroke("a", lane(10, 5, 20, 35))
    work.stroke("b", lane(14, 5, 35), "mask")
    work.stroke("c", lane(13, 5, 35))
    work.stroke("s", lane(12, 5, 20, 20, 35), "soften")
    assert work.states["s"] != work.states["c"]
    work.stroke("d", lane(10, 5, 35), "add")
    for token, expected in work.states.items():
        assert work.journal.state(token).volume.to_bytes() == expected
    assert work.journal.state("nowhere") is None
    assert work.journal.state("d").mask.to_bytes() == work.mask.to_bytes()
    assert [(c.mode, c.moves) for c in work.journal.state("d").cuts] == [("remove", 2), ("remove", 1), ("add", 1)]
    assert [c.masked for c in work.journal.state("d").cuts] == [False, True, True]
    assert [work.journal.state(token).shaped for token in ("c", "s", "d")] == [False, True, True]


def test_a_replay_knows_that_a_sculpt_was_shaped_by_other_means(tmp_path):
    work = Work(tmp_path, shaped=True)
    work.stroke("a", lane(10, 5, 20, 35))
    assert work.journal.state("a").shaped and len(work.journal.state("a").cuts) == 1


def test_undo_and_redo_are_written(tmp_path):
    work = Work(tmp_path)
    for k, token in enumerate("abc"):
        work.stroke(token, lane(5 + 5 * k, 5, 35))
    while not work.journal.settled():
        pass
    assert work.journal.go("a") and work.journal.token == "a"
    assert all(work.journal.state(t).volume.to_bytes() == expected for t, expected in work.states.items())
    assert journal.replay(work.journal.folder).volume.to_bytes() == work.states["a"]
    assert work.journal.go("b") and not work.journal.go("x")
    assert journal.replay(work.journal.folder).volume.to_bytes() == work.states["b"]
    work.volume = riffler.Volume.from_bytes(work.states["b"])
    work.stroke("d", lane(25, 5, 35))
    assert not work.journal.go("c") and work.journal.state("c") is None
    assert journal.replay(work.journal.folder).volume.to_bytes() == work.states["d"]
    work.carve(lane(28, 5, 35), "remove", "e")
    work.journal.cancel()
    assert journal.replay(work.journal.folder).volume.to_bytes() == work.states["d"]


def test_journals_of_dead_processes_are_found_and_those_of_living_ones_are_not(tmp_path):
    work = Work(tmp_path, about={"name": "Figure"})
    work.stroke("a", lane(10, 5, 35))
    assert journal.crashed(tmp_path) == [] and not journal.Lock(work.journal.folder).held
    assert work.journal.state("a")  # its stock is there
    work.journal._writer.close()  # as when the process has died
    (found,) = journal.crashed(tmp_path)
    assert found.name == "Figure" and found.folder == work.journal.folder and found.when > 0
    lock = journal.Lock(found.folder)
    assert lock.held and journal.crashed(tmp_path) == []
    lock.delete()
    assert not list(tmp_path.iterdir())
    assert journal.crashed(tmp_path / "missing") == []


def test_cuts_that_were_there_before_stay_and_pieces_are_put_together(tmp_path):
    before = Cut({"kind": "ball", "diameter": 4.0, "length": 20.0}, lane(5, 1, 2))
    work = Work(tmp_path, cuts=[before])
    for piece in (lane(10, 5, 6), lane(20, 5, 6), lane(10, 6, 7, 8), lane(20, 6, 7)):  # two copies in turn
        work.carve(piece, "remove", "a")
    work.journal.finish("a")
    work.stroke("b", lane(10, 8, 9))
    cuts = work.journal.state("b").cuts
    assert np.array_equal(cuts[0].poses, before.poses) and cuts[0].tool == before.tool
    assert [c.moves for c in cuts[1:]] == [3, 2, 1]


def test_strokes_that_no_journal_can_hold_make_it_incomplete(tmp_path):
    work = Work(tmp_path)
    work.journal.carved(BALL.to_dict(), lane(5, 1, 2), "melt", "a")
    work.journal.finish("a")
    assert not work.journal.whole and work.journal.state("a") is None


def test_folders_that_are_no_journals_are_left_alone(tmp_path):
    (tmp_path / "other").mkdir()
    (tmp_path / "file").write_text("x")
    assert journal.crashed(tmp_path) == []
    strange = tmp_path / "strange"
    strange.mkdir()
    (strange / journal.STROKES).write_bytes(b"not one")
    for text in ("{", "[1]", json.dumps({"name": 7})):
        (strange / journal.ABOUT).write_text(text)
        (found,) = journal.crashed(tmp_path)
        assert found.name in ("strange", "7")
    with pytest.raises(ValueError, match="RIFFLERJ"):
        journal.replay(strange)


def test_a_journal_that_cannot_begin_leaves_nothing(tmp_path):
    with pytest.raises(TypeError):
        journal.LiveJournal(tmp_path, Content(riffler.Volume.block(*BOX)), "t", about={"thing": object()})
    assert not list(tmp_path.iterdir())


def test_rows_without_motion_are_no_moves():
    a, b = row(1), row(2)
    poses, dt = moving(np.array([a, a, b, b, b, a]), np.arange(5.0))
    assert poses.tolist() == [a, b, a] and dt.tolist() == [1, 4]
    poses, dt = moving(np.array([a, a, a]), [1, 2])
    assert poses.tolist() == [a, a] and dt.tolist() == [1]
    assert moving(np.array([a]))[0].tolist() == [a]
    same = np.array([a, b])
    assert moving(same)[0] is same


def test_small_sculpts_are_packed_at_once_and_large_ones_at_rest():
    small = packing.Packing(1_000_000, 0.0)
    assert small.at_once and not small.due(0.5) and small.due(1.0)
    small.done(1_000_000, 0.02, 1.0)  # it can be felt: so it is packed at rest
    assert not small.at_once
    small.stroke(2.0)
    assert not small.due(2.9) and small.due(3.0)
    small.done(1_000_000, 0.002, 3.0)
    assert small.at_once
    large = packing.Packing(20_000_000, 0.0)
    assert not large.at_once and large.due(1.0)
    large.done(20_000_000, 0.001, 1.0)
    large.stroke(2.0)
    assert not large.at_once and not large.due(30.9) and large.due(31.0)


def test_windows_locks_journals_without_flock(tmp_path, monkeypatch):
    """That it can be imported there, and which function it calls; Windows' behaviour is not tested here."""
    calls, taken = [], []

    def locking(file, mode, nbytes):
        calls.append((os.lseek(file, 0, os.SEEK_CUR), mode, nbytes))
        if taken:
            raise PermissionError(13, "another process has it")

    windows = types.ModuleType("msvcrt")
    windows.locking, windows.LK_NBLCK = locking, 2
    monkeypatch.setitem(sys.modules, "fcntl", None)
    monkeypatch.setitem(sys.modules, "msvcrt", windows)
    spec = importlib.util.spec_from_file_location("addon.sculpt.pure.journal_elsewhere", journal.__file__)
    elsewhere = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, spec.name, elsewhere)  # dataclasses look it up
    spec.loader.exec_module(elsewhere)
    (tmp_path / journal.STROKES).write_bytes(b"strokes")
    lock = elsewhere.Lock(tmp_path)
    assert lock.held and calls == [(elsewhere.FAR, 2, 1)]  # far behind the end: the content can still be read
    lock.release()
    taken.append(True)
    assert not elsewhere.Lock(tmp_path).held and len(calls) == 2
