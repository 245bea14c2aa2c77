"""Sculpting with a device: the simulated pen and recordings in real time, and a mouse as a device, stroke by stroke."""

import json
import time
from pathlib import Path

import bpy
import numpy as np
import riffler
import sculpting
from sculpting import is_shown, live, matches_its_volume, nothing_is_left

import support

FAST = {"device": "simulated", "gap": 0.0, "scale": 1.0, "removal_constant": 0.001}
NAME = "Stock"


def sculpt(directions="z"):
    return bpy.data.objects[sculpting.sculpt(directions=directions)]


def sculpt_for(seconds, **more):
    return bpy.ops.riffler.pen_sculpt("EXEC_DEFAULT", True, seconds=seconds, tool=support.BALL, **{**FAST, **more})


def until_cut(**more):
    """A hand of its own needs some seconds, and a busy machine takes the force away now and then."""
    for _ in range(4):
        if sculpt_for(4.0, **more) == {"FINISHED"}:
            return
    raise AssertionError("the simulated hand has cut nothing four times")


def sessions():
    return support.part("bl.pen_session")


def no_session():
    assert sessions().running is None and not bpy.context.window_manager.riffler.sculpting
    left = [ob.name for ob in bpy.data.objects if ob.name.startswith("Riffler Tool") and ob.visible_get()]
    assert not left, left


def work():
    return live().of(bpy.data.objects[NAME])


def now():
    return live().content(bpy.data.objects[NAME]).volume.to_bytes()


def folder(name):
    path = Path(support.out(name))
    path.mkdir(exist_ok=True)
    for file in path.iterdir():
        file.unlink()
    return path


def journals():
    keeping = support.part("bl.keeping")
    return [j for j in keeping._open if work() is not None and j is work().keeping.journal]


def lowered(directions="z"):
    """A sculpt with air above z = 16."""
    ob = sculpt(directions)
    run = live().begin(bpy.context, ob)
    run.begin_stroke()
    run.carve(riffler.Tool.flat(150, 40), np.array([[-80, 30, 16, 0, 0, 1], [140, 30, 16, 0, 0, 1.0]]))
    run.finish_stroke(bpy.context, "lowered")
    return ob


class Hand:
    """A session whose device is a mouse that a test moves: a stroke is a groove along x, 1 mm deep, or in mode "add" a
    ridge on what is `lowered`."""

    def __init__(self, ob, record=None, mode="remove"):
        tool = support.part("operators.pen").tool_for(mode, riffler.Tool.ball(6, 30), 0.5)
        self.pen, self._time = riffler.pen.Pointer("mouse"), 0.0
        self.pen.set_frame(origin=(0, 0, 17 if mode == "add" else 20), depth=1.0)
        self._give(-10, 0, 0)
        options = {"material": riffler.Material(removal_constant=1e-5), "stiffness": 5.0, "mode": mode}
        self.session = sessions().PenSession(bpy.context, ob, self.pen, tool, options, record)
        support.push("Sculpt with Pen")

    def _give(self, x, y, pressed):
        self._time += 0.004
        self.pen.give(x, y, pressure=float(pressed), buttons=int(pressed), time=self._time)
        time.sleep(0.004)

    def down(self, y, first=5, last=45):
        """The hand comes and cuts; it does not let go."""
        self._give(first, y, 0)
        time.sleep(0.02)
        for x in np.arange(first, last, 1.0):
            self._give(x, y, 1)

    def up(self, x=60, y=0):
        for _ in range(5):
            self._give(x, y, 0)

    def look(self, done, seconds=20.0):
        end = time.monotonic() + seconds
        while not done():
            assert time.monotonic() < end, "nothing came of it"
            if not self.session.look():
                return False
            time.sleep(0.005)
        return True

    def stroke(self, y):
        """The bytes of the volume after it."""
        self.session.look()
        before = self.session.count
        self.down(y)
        self.up(y=y)
        assert self.look(lambda: self.session.count > before and not self.session.run.in_stroke)
        return now()


def test_a_stroke_with_the_simulated_pen_is_in_volume_mesh_recording_and_cuts():
    ob = sculpt()
    before = support.content(ob).volume.volume
    place = folder("recorded")
    until_cut(record=True, folder=str(place))
    no_session()
    live().end_all()
    content = support.content(ob)
    assert content.volume.volume < before - 1
    assert (bpy.context.object, ob.hide_get()) == (ob, False)
    matches_its_volume(NAME)
    nothing_is_left()
    (path,) = place.glob("*.rjournal")
    assert riffler.Session.replay(path).to_bytes() == content.volume.to_bytes()
    strokes = riffler.Journal.read(path).strokes
    assert sum(c.moves for c in content.cuts) == sum((np.diff(s.poses, axis=0) != 0).any(axis=1).sum() for s in strokes)
    again = riffler.Volume.block((0, 0, 0), (60, 60, 20), 0.5, "z")
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
    new = hand.stroke(50)  # what was taken back is gone
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
    for k in (1, 0):  # undo goes on without it
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


def now_of(ob):
    return live().content(ob).volume.to_bytes()


def nothing_is_left_but_redo():
    assert not support.part("bl.chunks").shown() and bpy.data.objects[NAME].visible_get()


def test_an_undo_in_the_middle_of_a_stroke_takes_that_stroke_back_and_the_hand_goes_on():
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


def test_what_is_masked_stays_to_the_byte_and_the_journal_tells_the_same():
    for directions in ("z", "xyz"):
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
        assert inside.volume > 1 and support.same(support.shape(inside), support.shape(was))
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
        assert support.content(ob).mask.to_bytes() == mask.to_bytes()
        nothing_is_left()
        bpy.data.objects.remove(ob)


def test_material_is_put_on_stroke_by_stroke_undone_and_told_by_the_journal():
    core = support.part("core.journal")
    for directions in ("z", "xyz"):
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
        time.sleep(0.3)  # its keeper writes
        told = core.replay(journal.folder)  # as a recovery has it
        assert told.volume.to_bytes() == states[1]
        assert [c.mode for c in told.cuts] == ["remove", "add", "add"]
        hand.session.finish()
        live().end_all()
        content = support.content(bpy.data.objects[NAME])
        assert content.volume.to_bytes() == states[1] and [c.mode for c in content.cuts] == ["remove", "add", "add"]
        again = before.copy()
        for cut in content.cuts[1:]:
            again.carve(riffler.Tool.from_dict(cut.tool), cut.poses, mode="add")
        assert abs(again.volume - content.volume.volume) < 1e-6 * again.volume
        matches_its_volume(NAME)
        nothing_is_left()
        bpy.data.objects.remove(bpy.data.objects[NAME])


def test_what_is_masked_gets_no_material_put_on():
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
    assert support.same(support.shape(inside), support.shape(was))
    assert work().volume.volume > before.volume + 100
    (journal,) = journals()
    assert journal.state(work().token).volume.to_bytes() == made
    hand.session.finish()
    live().end_all()
    nothing_is_left()


def test_a_session_does_what_the_tool_at_hand_does():
    operators = support.part("operators.pen")
    at_hand = operators._at_hand
    try:
        for tool, mode in (
            ("riffler.add", "add"),
            ("riffler.carve", "remove"),
            ("riffler.plan", "remove"),
            ("", "remove"),
        ):
            operators._at_hand = lambda context, tool=tool: tool
            assert operators.mode_of(bpy.context, "TOOL") == mode
            assert operators.mode_of(bpy.context, "ADD") == "add"
        ob = lowered()
        live().end_all()
        before = now()
        for tool, word in (("riffler.smooth", "Smooth"), ("riffler.mask", "Mask")):
            operators._at_hand = lambda context, tool=tool: tool
            support.refused(lambda: sculpt_for(0.2), f"take Carve or Add instead of {word}")
            no_session()
        assert now_of(ob) == before
        operators._at_hand = lambda context: "riffler.add"
        place = folder("put-on")
        until_cut(record=True, folder=str(place))
    finally:
        operators._at_hand = at_hand
    no_session()
    live().end_all()
    content = support.content(bpy.data.objects[NAME])
    start = riffler.Volume.from_bytes(before)
    assert content.volume.volume > start.volume + 1
    assert {c.mode for c in content.cuts[1:]} == {"add"}
    assert all(riffler.Tool.from_dict(c.tool).length == 3.0 for c in content.cuts[1:]), "the tip, and no wall"
    path = sorted(place.glob("*.rjournal"))[-1]
    assert riffler.Session.replay(path).to_bytes() == content.volume.to_bytes()
    again = lowered()
    live().end_all()
    assert bpy.ops.riffler.cut_recording(filepath=str(path)) == {"FINISHED"}
    assert abs(support.content(again).volume.volume - content.volume.volume) < 1e-6 * start.volume
    nothing_is_left()


def test_putting_on_where_the_box_is_full_says_so():
    ob = sculpt()
    before = now()
    heard = []
    operators = support.part("operators.pen")
    said = operators._said
    operators._said = lambda operator, session: said(Heard(heard), session)
    try:
        assert sculpt_for(0.5, mode="ADD") == {"CANCELLED"}
    finally:
        operators._said = said
    assert "Nothing was put on" in heard[0], heard
    live().end_all()
    assert now_of(ob) == before
    nothing_is_left()


class Heard:
    """What an operator would report."""

    def __init__(self, texts):
        self._texts = texts

    def report(self, level, text):
        self._texts.append(text)


def test_there_is_one_journal_and_a_recovery_knows_its_states():
    sculpt()
    core = support.part("core.journal")
    hand = Hand(bpy.data.objects[NAME])
    states = [hand.stroke(y) for y in (10, 30, 50)]
    bpy.ops.ed.undo()
    (journal,) = journals()
    assert [p.name for p in journal.folder.parent.iterdir() if not core.Lock(p).held].count(journal.folder.name) == 1
    hand.session.look()
    time.sleep(0.3)  # its keeper writes
    found, _ = core.part_of(journal.folder)
    about = json.loads((journal.folder / core.ABOUT).read_text())
    known = core.states(journal.folder, about, found)
    assert known[-1] == work().token and known[0] == about["token"] and len(found.strokes) == len(known) - 1
    assert core.replay(journal.folder).volume.to_bytes() == states[1]
    assert support.part("bl.keeping").crashed(look=True) == [] or journal.folder not in [
        f.folder for f in support.part("bl.keeping").crashed()
    ]
    hand.session.finish()
    assert not core.Lock(journal.folder).held, "still ours"
    sculpting.stroke(NAME, 2)  # a pointer's stroke goes into a journal of its own
    assert work().keeping.journal is not journal
    while not work().keeping.journal.settled():
        pass
    live().end_all()
    bpy.ops.wm.save_as_mainfile(filepath=support.out("journals.blend"))
    assert not journal.folder.exists()
    nothing_is_left()


def test_a_state_that_memory_has_no_more_is_told_by_the_sessions_journal():
    sculpt()
    hand = Hand(bpy.data.objects[NAME])
    states = [hand.stroke(y) for y in (10, 30, 50)]
    time.sleep(0.3)
    snapshots = support.part("bl.working").snapshots
    token = work().keeping.journal._tokens[1]
    del snapshots._items[token]
    bpy.ops.ed.undo()
    bpy.ops.ed.undo()
    assert bpy.data.objects[NAME].riffler.token == token and now() == states[0]
    is_shown(NAME)
    assert hand.stroke(44) not in states
    hand.session.finish()
    live().end_all()
    nothing_is_left()


def test_a_session_that_cuts_nothing_changes_nothing():
    ob = sculpt()
    key, before = support.part("bl.store").identity(ob.data), now()
    place = folder("air")
    assert sculpt_for(0.3, gap=500.0, record=True, folder=str(place)) == {"CANCELLED"}
    no_session()
    live().end_all()
    assert support.part("bl.store").identity(ob.data) == key and now() == before
    assert not list(place.iterdir())
    matches_its_volume(NAME)
    nothing_is_left()


def test_a_recording_is_a_device_and_ends_by_itself():
    sculpt()
    x = np.linspace(0, 1, 500)
    journal = riffler.Journal()
    journal.add_tool(1, {"kind": "ball", "diameter": 6.0, "length": 30.0})
    poses = np.c_[10 + 40 * x, 30 + 0 * x, 19 + 0 * x, 0 * x, 0 * x, 1 + 0 * x]
    journal.add_stroke(1, poses, times=2 * x)
    path = support.out("hand.rjournal")
    journal.write(path)
    begin = time.monotonic()
    assert sculpt_for(60.0, device="recording", recording=path, stiffness=5.0) == {"FINISHED"}
    assert time.monotonic() - begin < 30
    no_session()
    live().end_all()
    low = np.min([c.poses[:, 2].min() for c in support.content(bpy.data.objects[NAME]).cuts])
    assert 18.9 < low < 19.6, low
    matches_its_volume(NAME)
    nothing_is_left()


def test_what_is_shown_follows_and_somebody_who_removes_it_spoils_nothing():
    ob = sculpt()
    hand = Hand(ob)
    assert ob.hide_get() and bpy.context.object == ob
    hand.down(20)
    assert hand.look(lambda: hand.session.run.in_stroke)
    is_shown(NAME)
    tool = bpy.data.objects["Riffler Tool"]
    assert np.allclose(tool.matrix_world.translation, hand.session.run.pose[:3], atol=1e-4)
    pushed = hand.session.run.push
    assert pushed.shape == (2, 3) and np.isfinite(pushed).all()
    chunks = [c for c in support.part("bl.chunks").collection_of(ob.riffler.mark).objects if "riffler_chunk" in c]
    for thing in (tool, *chunks[::2]):
        bpy.data.objects.remove(thing)
    hand.up()
    assert hand.look(lambda: hand.session.count == 1)
    last = hand.stroke(40)
    hand.session.finish()
    no_session()
    live().end_all()
    assert now() == last
    matches_its_volume(NAME)
    nothing_is_left()


def test_the_force_on_the_tool_is_against_its_way_and_the_materials():
    """Removal force: the constant times what is taken in a second, against the motion (docs/methods.md)."""
    sculpt()
    hand, pushes = Hand(bpy.data.objects[NAME]), []
    run = hand.session.run
    take = run._take
    columns = ("tool_forces", "poses", "starts", "removed", "dt")
    run._take = lambda frame: (take(frame), pushes.append([getattr(frame, column) for column in columns]))
    hand.down(20)
    hand.up()
    assert hand.look(lambda: hand.session.count == 1)
    force, ends, starts, removed, dt = (np.concatenate([p[k] for p in pushes]) for k in range(5))
    cut = removed > 1e-3
    assert cut.sum() > 10
    way = (ends - starts)[:, :3]
    along = np.einsum("ij,ij->i", force[cut][:, :3], way[cut])
    assert (along[1:] < 0).all()
    sizes = np.linalg.norm(force[cut][1:, :3], axis=1)
    assert np.allclose(sizes, 1e-5 * removed[cut][1:] / dt[cut][1:], rtol=0.2)
    hand.session.finish()
    live().end_all()


def test_saving_ends_it_first_and_a_file_has_no_picture_of_it():
    sculpt()
    hand = Hand(bpy.data.objects[NAME])
    hand.stroke(10)
    hand.down(30)  # in the middle of a stroke
    assert hand.look(lambda: hand.session.run.in_stroke)
    path = support.out("during.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    assert hand.session.ended and hand.session.count == 2
    made = now()
    bpy.ops.wm.open_mainfile(filepath=path)
    no_session()
    nothing_is_left()
    assert now() == made
    matches_its_volume(NAME)


def test_another_file_ends_it():
    hand = Hand(sculpt())
    hand.down(10)
    assert hand.session.look()
    bpy.ops.wm.read_homefile()
    assert hand.session.ended
    no_session()
    nothing_is_left()


def test_a_sculpt_that_is_removed_ends_it_and_an_undo_brings_both_back_but_the_session():
    ob = sculpt()
    hand = Hand(ob)
    last = hand.stroke(10)
    bpy.data.objects.remove(ob)
    assert not hand.session.look() and hand.session.ended
    no_session()
    nothing_is_left()
    support.push("removed")
    bpy.ops.ed.undo()
    assert now() == last
    no_session()
    is_shown(NAME)
    live().end_all()
    matches_its_volume(NAME)


def test_a_sculpt_that_is_changed_meanwhile_keeps_that():
    ob = sculpt()
    hand = Hand(ob)
    hand.stroke(10)
    volume = riffler.Volume.block((0, 0, 0), (60, 60, 10), 0.5, "z")
    support.part("bl.sculpts").commit(ob.data, support.part("core.cache").Content(volume), 1.0)
    assert not hand.session.look()
    no_session()
    assert support.content(ob).volume.volume == 36000
    nothing_is_left()


def test_a_device_that_fails_ends_it_and_what_was_made_stays():
    sculpt()
    hand = Hand(bpy.data.objects[NAME])
    first = hand.stroke(10)
    work().volume.subtract(riffler.Volume.block((0, 0, 0), (60, 60, 20), 0.5, "z"))  # somebody spoils it
    try:
        hand.session.look()
    except RuntimeError as error:
        assert "somebody else" in str(error)
        hand.session.fail(error)
    no_session()
    support.push("spoiled")
    bpy.ops.ed.undo()
    assert now() == first
    is_shown(NAME)
    live().end_all()
    nothing_is_left()


def test_nothing_else_takes_the_sculpt_meanwhile_and_disabling_the_addon_ends_it():
    ob = sculpt()
    name = ob.name
    hand = Hand(ob)
    last = hand.stroke(10)
    assert not bpy.ops.riffler.cut_curve.poll() and not bpy.ops.riffler.new_stock.poll()
    assert not bpy.ops.riffler.stroke.poll()
    assert bpy.ops.riffler.pen_sculpt.poll() and bpy.ops.riffler.pen_stop.poll()
    assert bpy.ops.riffler.pen_stop() == {"FINISHED"} and hand.session.ended
    assert not bpy.ops.riffler.pen_stop.poll() and bpy.ops.riffler.cut_curve.poll() is not None
    no_session()
    hand = Hand(ob)
    bpy.ops.preferences.addon_disable(module=support.MODULE)
    assert hand.session.ended
    bpy.ops.preferences.addon_enable(module=support.MODULE)
    assert bpy.data.objects[name].visible_get() and now() == last
    no_session()
    nothing_is_left()


def test_what_is_refused_changes_nothing():
    ob = sculpt()
    key, co = support.part("bl.store").identity(ob.data), support.coordinates(ob.data)
    for settings, word in (
        ({"device": "riffler-pen"}, "plugged in"),
        ({"device": "recording", "recording": ""}, "recording"),
        ({"device": "recording", "recording": "/nowhere/x.rjournal"}, "x.rjournal"),
        ({"record": True, "folder": "//"}, "save the .blend"),
        ({"record": True, "folder": "/nowhere"}, "/nowhere"),
        ({"stiffness": 1e-3, "start": "CURSOR", "tool": '{"kind": "spoon"}'}, "spoon"),
    ):
        support.refused(lambda s=settings: bpy.ops.riffler.pen_sculpt(seconds=0.2, **{**FAST, **s}), word)
        no_session()
        nothing_is_left()
    support.refused(lambda: bpy.ops.riffler.pen_sculpt(tool=support.BALL), "seconds")
    assert support.part("bl.store").identity(ob.data) == key
    assert np.array_equal(support.coordinates(ob.data), co)
