"""riffler.History: strokes that stay editable."""

import inspect
import threading

import numpy as np
import pytest
import riffler

UP = [0.0, 0, 1]
BALL = riffler.Tool.ball(6, 40)
FLAT = riffler.Tool.flat(8, 40)


def block(directions="xyz"):
    return riffler.Volume.block([0, 0, 0], [60, 45, 15], 0.5, directions)


def line(*tips):
    return np.array([[*tip, *UP] for tip in tips], float)


def replayed(history):
    volume = history.base
    for k in history.ids:
        s = history.stroke(k)
        if s.enabled:
            volume.carve(s.tool, s.poses, mode=s.mode, tolerance=s.tolerance, protect=s.protect)
    return volume.to_bytes()


@pytest.mark.parametrize("directions", ["z", "xyz"])
def test_every_edit_gives_the_bytes_of_a_replay(directions):
    history = riffler.History(block(directions))
    turning = [[10, 10, 12, *UP], [50, 30, 11, 0.6, 0, 0.8]]
    first = history.add(BALL, line((5, 5, 12), (55, 40, 11)))
    second = history.add(FLAT, turning, mode="add", tolerance=0.005)
    third = history.insert(FLAT, turning, before=second)
    assert history.ids == [first, third, second] and len(history) == 3
    edits = [
        lambda: history.replace(first, poses=line((5, 8, 12), (30, 30, 9), (55, 40, 11))),
        lambda: history.replace(third, tool=BALL, mode="remove", tolerance=0.02),
        lambda: history.move(second, before=first),
        lambda: history.enable(third, False),
        lambda: history.move(second, before=None),
        lambda: history.enable(third),
        lambda: history.remove(first),
    ]
    for edit in edits:
        edit()
        assert history.volume.to_bytes() == replayed(history)
    assert history.ids == [third, second] and history.stats().edits == 3 + len(edits)


def test_a_stroke_reads_back():
    history = riffler.History(block())
    mask = riffler.Volume.empty([0, 0, 0], [60, 45, 15], 0.5, "xyz")
    mask.carve(FLAT, line((20, 20, 5), (40, 20, 5)), mode="add")
    poses = line((5, 20, 12), (55, 20, 11))
    k = history.add(FLAT, poses, mode="add", tolerance=0.02, protect=mask)
    before = mask.to_bytes()
    mask.carve(BALL, poses)
    stroke = history.stroke(k)
    assert (stroke.id, stroke.mode, stroke.tolerance, stroke.enabled) == (k, "add", 0.02, True)
    assert np.array_equal(stroke.poses, poses) and stroke.tool == FLAT
    assert stroke.protect.to_bytes() == before
    assert history.stroke(history.add(BALL, poses)).protect is None


def test_volumes_are_snapshots():
    base = block()
    history = riffler.History(base)
    history.add(BALL, line((5, 20, 12), (55, 20, 11)))
    before = history.volume.to_bytes()
    history.volume.carve(BALL, line((5, 30, 12), (55, 30, 11)))
    history.base.carve(BALL, line((5, 30, 12), (55, 30, 11)))
    base.carve(BALL, line((5, 30, 12), (55, 30, 11)))
    assert history.volume.to_bytes() == before
    mesher = riffler.Mesher(history.volume)
    history.add(BALL, line((200, 20, 12), (250, 20, 11)))
    assert mesher.update(history.volume) == []


ERRORS = {
    "stroke 9 is not in the history; its strokes are 1": lambda h: h.remove(9),
    "poses: a stroke needs at least one pose": lambda h: h.add(BALL, np.empty((0, 6))),
    "poses, row 1: the axis is exactly opposite": lambda h: h.replace(1, poses=[[0, 0, 0, *UP], [1, 0, 0, 0, 0, -1]]),
    "poses, row 1": lambda h: h.insert(BALL, [[0, 0, 0, *UP], [1, 0, 0, 0, 0, 2]], before=1),
    "tolerance must be": lambda h: h.replace(1, tolerance=0),
    "mode must be": lambda h: h.add(BALL, line((0, 0, 0)), mode="mask"),
    "protect must have the same grid": lambda h: h.add(BALL, line((0, 0, 0)), protect=block("z")),
}


@pytest.mark.parametrize("message", ERRORS)
def test_errors_leave_the_history_unchanged(message):
    history = riffler.History(block())
    history.add(BALL, line((5, 20, 12), (55, 20, 11)))
    before = history.volume.to_bytes()
    with pytest.raises(ValueError, match=message):
        ERRORS[message](history)
    assert history.ids == [1] and history.volume.to_bytes() == before == replayed(history)


def zigzag(rows):
    tips = [(5 + 50 * (k % 2), 5 + 35 * k / rows, 12 - 0.002 * k) for k in range(rows)]
    return line(*tips)


def test_a_cancelled_edit_changes_nothing_and_progress_rises():
    history = riffler.History(block())
    k = history.add(BALL, zigzag(40))
    shares = []
    history.replace(k, poses=zigzag(60), progress=shares.append)
    assert shares == sorted(shares) and shares[-1] == 1 and len(shares) > 1
    before = history.volume.to_bytes()
    for cancels_at in (0, 0.1, 1):  # the first report, carving, the last report
        with pytest.raises(riffler.Cancelled):
            history.replace(k, poses=zigzag(61), progress=lambda share, at=cancels_at: share < at)
    assert history.volume.to_bytes() == before
    with pytest.raises(ZeroDivisionError):
        history.remove(k, progress=lambda share: 1 / 0)
    assert history.ids == [k] and history.volume.to_bytes() == before


def test_edits_release_the_lock_and_allow_one_thread():
    history = riffler.History(block())
    entered, leave = threading.Event(), threading.Event()

    def wait(share):
        entered.set()
        leave.wait(20)

    thread = threading.Thread(target=lambda: history.add(BALL, zigzag(40), progress=wait))
    thread.start()
    assert entered.wait(20)
    for call in (lambda: history.volume, lambda: history.ids, lambda: history.stats(), lambda: history.remove(1)):
        with pytest.raises(RuntimeError, match="the history is in use by another thread"):
            call()
    leave.set()
    thread.join()
    assert history.ids == [1] and history.volume.to_bytes() == replayed(history)


def test_a_lower_memory_limit_reruns_more_strokes_and_gives_the_same_bytes():
    few, many = riffler.History(block(), memory_limit=0), riffler.History(block())
    for history in (few, many):
        for k in range(20):
            history.add(BALL, line((10, 10 + k, 13), (50, 12 + k, 12)))
        history.remove(18)
    assert many.stats().strokes_run == 2 < few.stats().strokes_run
    assert few.stats().version_bytes < many.stats().version_bytes / 3
    assert few.volume.to_bytes() == many.volume.to_bytes() == replayed(many)


def test_every_edit_documents_that_it_can_be_cancelled():
    for name in ("add", "insert", "replace", "remove", "move", "enable"):
        assert "Cancelled" in inspect.getdoc(getattr(riffler.History, name))
