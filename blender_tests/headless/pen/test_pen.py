"""A device sculpts: its strokes, their undo, what they leave unchanged, and their journal."""

import json
import os
from pathlib import Path

import bpy
import numpy as np
import riffler

from support import common, sculpting
from support.device_sessions import (
    NAME,
    Hand,
    folder,
    journals,
    lowered,
    no_session,
    nothing_is_left_but_redo,
    now,
    now_of,
    sculpt,
    sculpt_for,
    sessions,
    until_cut,
    work,
)
from support.sculpting import is_shown, live, matches_its_volume, nothing_is_left


@common.core_bound
def test_a_stroke_with_the_simulated_pen_is_in_volume_mesh_recording_and_cuts():
    ob = sculpt()
    before = common.content(ob).volume.volume
    place = folder("recorded")
    until_cut(record=True, folder=str(place))
    no_session()
    live().end_all()
    content = common.content(ob)
    assert content.volume.volume < before - 1
    assert (bpy.context.object, ob.hide_get()) == (ob, False)
    matches_its_volume(NAME)
    nothing_is_left()
    (path,) = place.glob("*.rjournal")
    assert riffler.Session.replay(path).to_bytes() == content.volume.to_bytes()
    strokes = riffler.Journal.load(path).strokes
    assert sum(c.moves for c in content.cuts) == sum((np.diff(s.poses, axis=0) != 0).any(axis=1).sum() for s in strokes)
    again = riffler.Volume.block((0, 0, 0), sculpting.SIZE, sculpting.PITCH, "z")
    for cut in content.cuts:
        again.carve(riffler.Tool.from_dict(cut.tool), cut.poses)
    assert again.to_bytes() == riffler.Session.replay(path).to_bytes()


def test_each_stroke_is_an_undo_step_and_a_walk_back_and_on_has_the_volumes_to_the_byte():
    states = [now_of(sculpt("xyz"))]
    hand = Hand(bpy.data.objects[NAME])
    states += [hand.stroke(5 + 8 * k) for k in range(5)]
    assert len(set(states)) == 6
    random, at = np.random.default_rng(3), 5
    for _ in range(24):
        to = int(np.clip(at + random.integers(-2, 3), 0, 5))
        for _ in range(abs(to - at)):
            (bpy.ops.ed.undo if to < at else bpy.ops.ed.redo)()
        at = to
        assert sessions().running is hand.session and now() == states[at]
        assert hand.session.run.session.volume.to_bytes() == states[at], "the session's own volume"
        is_shown(NAME)
        if random.random() < 0.3:
            hand.session.look()
    while at > 2:
        bpy.ops.ed.undo()
        at -= 1
    new = hand.stroke(50)  # the undone stroke is gone
    assert new not in states
    expected = riffler.Volume.from_bytes(states[2])
    for cut in live().content(bpy.data.objects[NAME]).cuts[-1:]:
        expected.carve(riffler.Tool.from_dict(cut.tool), cut.poses)
    assert expected.to_bytes() == new
    is_shown(NAME)
    bpy.ops.ed.undo()
    assert now() == states[2]
    hand.session.finish()
    no_session()
    for k in (1, 0):  # undo continues without it
        bpy.ops.ed.undo()
        assert now() == states[k]
        no_session()
        is_shown(NAME)
    bpy.ops.ed.undo()  # its beginning
    assert now() == states[0] and work() is None
    nothing_is_left_but_redo()
    bpy.ops.ed.redo()
    bpy.ops.ed.redo()
    assert now() == states[1]
    no_session()
    live().end_all()
    matches_its_volume(NAME)
    nothing_is_left()


def test_an_undo_during_a_stroke_undoes_that_stroke_and_the_session_continues():
    sculpt()
    hand = Hand(bpy.data.objects[NAME])
    first = hand.stroke(10)
    hand.down(30)
    assert hand.look(lambda: hand.session.run.in_stroke and now() != first)
    bpy.ops.ed.undo()
    assert now() == first
    is_shown(NAME)
    hand.up()
    third = hand.stroke(50)
    assert third != first and sessions().running is hand.session
    is_shown(NAME)
    (journal,) = journals()
    assert journal.state(work().token).volume.to_bytes() == third
    bpy.ops.ed.undo()
    assert now() == first
    bpy.ops.ed.redo()
    assert now() == third
    hand.session.finish()
    live().end_all()
    assert now() == third
    nothing_is_left()


def test_an_undo_to_before_the_session_ends_it_and_to_an_older_stroke_of_the_pointer_too():
    name = sculpt("xyz").name
    pointer = sculpting.stroke(name, 9)
    hand = Hand(bpy.data.objects[NAME])
    own = hand.stroke(10)
    bpy.ops.ed.undo()
    assert sessions().running is hand.session and now() == pointer
    bpy.ops.ed.undo()
    no_session()
    assert hand.session.ended and now() == pointer and hand.session.live.device is None
    bpy.ops.ed.undo()
    assert now() != pointer
    for _ in range(3):
        bpy.ops.ed.redo()
    no_session()
    assert now() == own
    is_shown(name)
    assert sculpting.stroke(name, 3) == now()
    live().end_all()
    nothing_is_left()


def test_masked_material_stays_to_the_byte_also_in_the_journal():
    for directions in common.fewer(("xyz", "z")):
        ob = sculpt(directions)
        run = live().begin(bpy.context, ob)
        run.begin_stroke()
        run.carve(sculpting.BALL, np.array([[30, 5, 18, 0, 0, 1], [31, 50, 17, 0, 0, 1.0]]), mode="mask")
        run.finish_stroke(bpy.context, "mask")
        before, mask = run.volume.copy(), run.mask.copy()
        hand = Hand(ob)
        states = [hand.stroke(y) for y in (10, 24, 40)]
        volume = work().volume
        inside, was = volume.copy(), before.copy()
        inside.intersect(mask), was.intersect(mask)
        assert inside.volume > 1 and common.same(common.shape(inside), common.shape(was))
        beside = volume.copy()
        beside.subtract(mask)
        assert beside.volume < before.volume - was.volume - 50
        (journal,) = journals()
        for token, expected in zip(journal._tokens[1:], states, strict=True):
            assert journal.state(token).volume.to_bytes() == expected
        bpy.ops.ed.undo()
        assert now() == states[1] and work().mask.to_bytes() == mask.to_bytes()
        hand.session.finish()
        live().end_all()
        ob = bpy.data.objects[NAME]
        assert common.content(ob).mask.to_bytes() == mask.to_bytes()
        nothing_is_left()
        bpy.data.objects.remove(ob)


def test_material_is_added_stroke_by_stroke_undone_and_replayed_by_the_journal():
    core = common.part("sculpt.pure.journal")
    for directions in common.fewer(("xyz", "z")):
        ob = lowered(directions)
        before = work().volume.copy()
        hand = Hand(ob, mode="add")
        states = [hand.stroke(y) for y in (10, 24, 40)]
        sizes = [before.volume, *(riffler.Volume.from_bytes(s).volume for s in states)]
        # A ridge: a half disc 6 mm wide, 40 mm long; 3 mm of its height are above the stock.
        assert (np.diff(sizes) > 0.8 * 40 * np.pi * 9 / 2).all(), sizes
        assert np.isclose(hand.session.changed, sizes[-1] - sizes[0])
        is_shown(NAME)
        (journal,) = journals()
        for token, expected in zip(journal._tokens[1:], states, strict=True):
            assert journal.state(token).volume.to_bytes() == expected
        for k in (1, 0):
            bpy.ops.ed.undo()
            assert sessions().running is hand.session and now() == states[k]
            is_shown(NAME)
        bpy.ops.ed.redo()
        assert now() == states[1]
        hand.session.look()
        assert hand.session.run.session.journal_written(20.0)
        told = core.replay(journal.folder)  # as in a recovery
        assert told.volume.to_bytes() == states[1]
        assert [c.mode for c in told.cuts] == ["remove", "add", "add"]
        hand.session.finish()
        live().end_all()
        content = common.content(bpy.data.objects[NAME])
        assert content.volume.to_bytes() == states[1] and [c.mode for c in content.cuts] == ["remove", "add", "add"]
        again = before.copy()
        for cut in content.cuts[1:]:
            again.carve(riffler.Tool.from_dict(cut.tool), cut.poses, mode="add")
        assert abs(again.volume - content.volume.volume) < 1e-6 * again.volume
        matches_its_volume(NAME)
        nothing_is_left()
        bpy.data.objects.remove(bpy.data.objects[NAME])


@common.core_bound
def test_no_material_is_added_under_a_mask():
    ob = lowered("xyz")
    run = live().of(ob)
    run.begin_stroke()
    run.carve(sculpting.BALL, np.array([[30, 5, 14, 0, 0, 1], [31, 50, 14, 0, 0, 1.0]]), mode="mask")
    run.finish_stroke(bpy.context, "mask")
    before, mask = run.volume.copy(), run.mask.copy()
    hand = Hand(ob, mode="add")
    made = hand.stroke(24)
    inside, was = work().volume.copy(), before.copy()
    inside.intersect(mask), was.intersect(mask)
    assert common.same(common.shape(inside), common.shape(was))
    assert work().volume.volume > before.volume + 100
    (journal,) = journals()
    assert journal.state(work().token).volume.to_bytes() == made
    hand.session.finish()
    live().end_all()
    nothing_is_left()


@common.core_bound
def test_a_session_takes_the_mode_of_the_active_tool():
    operators = common.part("pen.operators")
    at_hand = operators._active_tool
    try:
        for tool, mode in (
            ("riffler.add", "add"),
            ("riffler.carve", "remove"),
            ("riffler.plan", "remove"),
            ("", "remove"),
        ):
            operators._active_tool = lambda context, tool=tool: tool
            assert operators.brush_of(bpy.context, "TOOL").id == mode
            assert operators.brush_of(bpy.context, "ADD").id == "add"
        ob = lowered()
        live().end_all()
        before = now()
        for tool, word in (("riffler.smooth", "Smooth"), ("riffler.mask", "Mask")):
            operators._active_tool = lambda context, tool=tool: tool
            common.refused(lambda: sculpt_for(0.2), f"use Carve or Add instead of {word}")
            no_session()
        assert now_of(ob) == before
        operators._active_tool = lambda context: "riffler.add"
        place = folder("put-on")
        until_cut(record=True, folder=str(place))
    finally:
        operators._active_tool = at_hand
    no_session()
    live().end_all()
    content = common.content(bpy.data.objects[NAME])
    start = riffler.Volume.from_bytes(before)
    assert content.volume.volume > start.volume + 1
    assert {c.mode for c in content.cuts[1:]} == {"add"}
    assert all(riffler.Tool.from_dict(c.tool).length == 3.0 for c in content.cuts[1:]), "the tip, and no wall"
    path = sorted(place.glob("*.rjournal"))[-1]
    assert riffler.Session.replay(path).to_bytes() == content.volume.to_bytes()
    again = lowered()
    live().end_all()
    assert bpy.ops.riffler.cut_recording(filepath=str(path)) == {"FINISHED"}
    assert abs(common.content(again).volume.volume - content.volume.volume) < 1e-6 * start.volume
    nothing_is_left()


@common.core_bound
def test_adding_material_where_the_box_is_full_is_reported():
    ob = sculpt()
    before = now()
    heard = []
    operators = common.part("pen.operators")
    said = operators.tell
    operators.tell = lambda operator, session: said(Heard(heard), session)
    try:
        assert sculpt_for(0.5, mode="ADD") == {"CANCELLED"}
    finally:
        operators.tell = said
    assert "Nothing was added" in heard[0], heard
    live().end_all()
    assert now_of(ob) == before
    nothing_is_left()


class Heard:
    """An operator's reports."""

    def __init__(self, texts):
        self._texts = texts

    def report(self, level, text):
        self._texts.append(text)


def test_there_is_one_journal_and_a_recovery_knows_its_states():
    sculpt()
    core = common.part("sculpt.pure.journal")
    hand = Hand(bpy.data.objects[NAME])
    states = [hand.stroke(y) for y in (10, 30, 50)]
    bpy.ops.ed.undo()
    (journal,) = journals()
    assert [p.name for p in journal.folder.parent.iterdir() if not core.Lock(p).held].count(journal.folder.name) == 1
    hand.session.look()
    assert hand.session.run.session.journal_written(20.0)
    found, _ = core.part_of(journal.folder)
    about = json.loads((journal.folder / core.ABOUT).read_text())
    known = core.states(journal.folder, about, found)
    assert known[-1] == work().token and known[0] == about["token"] and len(found.strokes) == len(known) - 1
    assert core.replay(journal.folder).volume.to_bytes() == states[1]
    assert common.part("sculpt.persistence").crashed(look=True) == [] or journal.folder not in [
        f.folder for f in common.part("sculpt.persistence").crashed()
    ]
    hand.session.finish()
    assert not core.Lock(journal.folder).held, "still ours"
    sculpting.stroke(NAME, 2)  # a pointer's stroke has a journal of its own
    assert work().persistence.journal is not journal
    while not work().persistence.journal.settled():
        pass
    live().end_all()
    bpy.ops.wm.save_as_mainfile(filepath=common.out("journals.blend"))
    assert not journal.folder.exists()
    nothing_is_left()


def test_a_state_dropped_from_memory_is_restored_from_the_sessions_journal():
    sculpt()
    hand = Hand(bpy.data.objects[NAME])
    states = [hand.stroke(y) for y in (10, 30, 50)]
    assert hand.session.run.session.journal_written(20.0)
    snapshots = common.part("sculpt.undo_states").snapshots
    token = work().persistence.journal._tokens[1]
    del snapshots._items[token]
    bpy.ops.ed.undo()
    bpy.ops.ed.undo()
    assert bpy.data.objects[NAME].riffler.token == token and now() == states[0]
    is_shown(NAME)
    assert hand.stroke(44) not in states
    hand.session.finish()
    live().end_all()
    nothing_is_left()


def test_a_makers_library_is_loaded_by_a_program_of_the_installed_extension():
    """The C library stands for one of another version. Blender's unpacking may take the permission to execute."""
    libc = next(line.split()[-1] for line in Path("/proc/self/maps").read_text().splitlines() if "/libc.so" in line)
    os.environ["RIFFLER_LIBHD"] = libc
    try:
        riffler.pen.open("touch")
    except riffler.pen.PenError as error:
        assert "it has no function hdInitDevice" in str(error), error
    else:
        raise AssertionError("the C library drives no arm")
    finally:
        del os.environ["RIFFLER_LIBHD"]
