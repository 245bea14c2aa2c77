"""Events of a live sculpt between strokes: every state in Blender's history is shown to the byte."""

import json

import bpy
import numpy as np
import riffler

from support import common
from support.sculpting import BALL, is_shown, live, matches_its_volume, nothing_is_left, sculpt, stroke, surface, work


def current(name):
    """The bytes of the displayed state, live or not."""
    return live().content(bpy.data.objects[name]).volume.to_bytes()


def whole(name):
    """The displayed state is the one recorded in memory, file and mesh."""
    if live().of(bpy.data.objects[name]):
        is_shown(name)
    else:
        matches_its_volume(name)


def rested(name):
    """As after a long rest of the hand: what the timer does in a window."""
    run = live().of(bpy.data.objects[name])
    run.persistence._packing._stroke -= 100
    run.persistence._packing._last -= 100
    for _ in range(200):
        run.rest(run.object)
        if run.persistence.packed == run.token:
            return run
        for task in run.persistence._task[1]:
            task.result()
    raise AssertionError("it was not packed")


def large(run):
    """Packed at rest only."""
    run.persistence._packing.nbytes = 1e9


def test_fifty_strokes_and_a_walk_through_them_among_other_steps():
    name = sculpt()
    large(work(name))
    rng = np.random.default_rng(11)
    states = [current(name)]
    for k in range(50):
        if k % 9 == 4:  # another operator, another object, an end of the session in between
            bpy.data.objects[name].location.x = 1 + k
            common.push("moved")
        elif k % 9 == 7:
            bpy.ops.mesh.primitive_cube_add(location=(100, 0, 0))
            common.push("cube")
        elif k % 19 == 12:
            live().end_all()
            common.push("ended")
        else:
            before, mode = current(name), ("remove", "add", "mask", "remove", "unmask")[k % 5]
            stroke(name, k - {"add": 1, "unmask": 2}.get(mode, 0), mode, may_be_none=True)
            if current(name) == before and mode not in ("mask", "unmask"):
                continue
            if k % 4 == 1:
                rested(name)
        states.append(current(name))
    at = len(states) - 1
    lowest = max(1, at - bpy.context.preferences.edit.undo_steps + 1)
    for step in range(60):
        if at == len(states) - 1 or (at > lowest and rng.random() < (0.75 if step < 30 else 0.35)):
            bpy.ops.ed.undo()
            at -= 1
        else:
            bpy.ops.ed.redo()
            at += 1
        assert current(name) == states[at], (step, at)
        whole(name)
        if step % 20 == 10 and live().of(bpy.data.objects[name]):
            rested(name)
    here = current(name)
    live().end_all()
    assert current(name) == here
    matches_its_volume(name)
    nothing_is_left()


def test_the_end_needs_no_step_of_its_own():
    """The artist chooses another tool: nothing is pushed, and an undo undoes the last stroke."""
    name = sculpt()
    large(work(name))
    states = [current(name)] + [stroke(name, k) for k in range(3)]
    for k in (2, 1):
        live().end_all()
        matches_its_volume(name)
        nothing_is_left()
        bpy.ops.ed.undo()
        assert current(name) == states[k]
        whole(name)
    bpy.ops.ed.redo()
    assert current(name) == states[2]
    whole(name)
    live().end_all()
    matches_its_volume(name)
    states[3:] = [stroke(name, 9)]
    bpy.ops.ed.undo()
    assert current(name) == states[2]
    whole(name)


def test_a_copy_made_meanwhile_has_the_shown_state():
    name = sculpt()
    first = stroke(name, 1)
    ob = bpy.data.objects[name]
    copy = ob.copy()
    copy.data = ob.data.copy()
    copy.location.x = 80
    bpy.context.collection.objects.link(copy)
    other = copy.name
    common.push("copied")
    assert live().of(bpy.data.objects[other]) is None
    run = live().of(bpy.data.objects[name])
    run._part_copies(run.object)
    common.push("parted")
    second = stroke(name, 2)
    assert current(other) == first and current(name) == second
    matches_its_volume(other)
    is_shown(name)
    third = stroke(other, 5)
    bpy.ops.ed.undo()
    assert current(other) == first and current(name) == second
    bpy.ops.ed.redo()
    live().end_all()
    assert (current(name), current(other)) == (second, third)
    for n in (name, other):
        matches_its_volume(n)
    nothing_is_left()


def test_a_linked_copy_shows_the_result_after_the_end():
    name = sculpt()
    stroke(name, 1)
    copy = bpy.data.objects[name].copy()
    bpy.context.collection.objects.link(copy)
    other = copy.name
    second = stroke(name, 2)
    live().end_all()
    assert current(name) == current(other) == second
    assert bpy.data.objects[name].data == bpy.data.objects[other].data
    matches_its_volume(name)
    nothing_is_left()
    third = stroke(other, 3)
    assert current(other) == third and live().of(bpy.data.objects[name]) is None
    live().end_all()
    assert current(name) == third


def test_a_sculpt_may_be_renamed_meanwhile():
    name = sculpt()
    first = stroke(name, 1)
    bpy.data.objects[name].name = "Renamed"
    common.push("renamed")
    second = stroke("Renamed", 2)
    assert work("Renamed").name == "Renamed" and len(live().lives) == 1
    bpy.ops.ed.undo()
    bpy.ops.ed.undo()
    assert current(name) == first
    is_shown(name)
    bpy.ops.ed.redo()
    bpy.ops.ed.redo()
    assert current("Renamed") == second
    live().end_all()
    matches_its_volume("Renamed")
    nothing_is_left()


def test_a_sculpt_deleted_meanwhile_is_restored_by_undo():
    name = sculpt()
    first = stroke(name, 1)
    bpy.data.objects.remove(bpy.data.objects[name])
    run = next(iter(live().lives.values()))
    run.look(0.0)
    nothing_is_left()
    common.push("deleted")
    bpy.ops.ed.undo()
    assert current(name) == first
    is_shown(name)
    second = stroke(name, 2)
    live().end_all()
    assert current(name) == second
    matches_its_volume(name)


def test_a_sculpt_may_be_changed_by_other_means_meanwhile():
    name = sculpt()
    stroke(name, 1)
    sculpts, cache = common.part("sculpt.sculpts"), common.part("common.contents")
    volume = riffler.Volume.block((0, 0, 0), (60, 60, 19), 0.5, "xyz")
    sculpts.commit(bpy.data.objects[name].data, cache.Content(volume), 1.0)
    assert live().of(bpy.data.objects[name]) is None
    assert work(name).volume.to_bytes() == volume.to_bytes()
    is_shown(name)
    last = stroke(name, 2)
    live().end_all()
    assert current(name) == last
    matches_its_volume(name)
    nothing_is_left()


def test_a_linked_sculpt_is_refused():
    name = sculpt()
    path = common.out("library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile()
    with bpy.data.libraries.load(path, link=True) as (_, into):
        into.objects = [name]
    bpy.context.collection.objects.link(into.objects[0])
    try:
        live().begin(bpy.context, into.objects[0])
    except ValueError as error:
        assert "Make Local" in str(error)
    else:
        raise AssertionError("a linked sculpt was taken")
    nothing_is_left()


def test_a_state_that_memory_lost_is_replayed_from_the_journal():
    name = sculpt()
    large(work(name))
    states = [current(name)]
    steps = ((0, "remove"), (0, "add"), (2, "mask"), (1, "remove"), (3, "remove"), (3, "add"))
    states += [stroke(name, k, mode) for k, mode in steps]
    work(name)
    common.part("sculpt.undo_states").snapshots.clear()
    bpy.ops.ed.undo()
    assert current(name) == states[5]
    assert "journal" in bpy.context.window_manager.riffler.notice
    is_shown(name)
    assert live().of(bpy.data.objects[name]).mask.volume > 0
    # and without a journal, the sculpt is the one in the file, which is reported
    common.part("sculpt.undo_states").snapshots.clear()
    for begun in (*common.part("sculpt.persistence")._open, *common.part("sculpt.persistence")._parked):
        begun.whole = False
    bpy.ops.ed.undo()
    assert current(name) == states[0]
    assert "as last saved" in bpy.context.window_manager.riffler.notice
    matches_its_volume(name)
    nothing_is_left()


def test_strokes_work_with_any_limits_of_undo():
    edit = bpy.context.preferences.edit
    before = edit.undo_steps, edit.undo_memory_limit, edit.use_global_undo
    try:
        for steps, memory, on in ((0, 0, True), (1, 0, True), (2, 0, True), (32, 1, True), (32, 0, False)):
            bpy.ops.wm.read_homefile(use_empty=False)
            edit.undo_steps, edit.undo_memory_limit, edit.use_global_undo = steps, memory, on
            name = sculpt()
            states = [current(name)] + [stroke(name, k) for k in range(5)]
            at = 5
            for way in (-1, -1, 1, -1, -1, -1, 1, 1):
                try:
                    done = (bpy.ops.ed.undo if way < 0 else bpy.ops.ed.redo)()
                except RuntimeError:  # there is no such step
                    continue
                if done == {"FINISHED"} and name in bpy.data.objects:
                    assert current(name) in states, (steps, memory, on)
                    whole(name)
            last = stroke(name, 7)
            live().end_all()
            assert current(name) == last
            matches_its_volume(name)
            nothing_is_left()
            assert at == 5
    finally:
        edit.undo_steps, edit.undo_memory_limit, edit.use_global_undo = before


def test_a_render_shows_the_last_stroke():
    name = sculpt()
    last = stroke(name, 4)
    for handler in bpy.app.handlers.render_init:
        if handler.__module__.endswith("sculpt.live_registry"):
            handler(bpy.context.scene)
    ob = bpy.data.objects[name]
    shown = surface(riffler.Volume.from_bytes(last))
    assert np.array_equal(common.coordinates(ob.data), np.asarray(shown.vertices, np.float32))
    assert not ob.hide_render and live().of(ob) is not None
    assert all(o.hide_render for o in bpy.data.objects if common.part("sculpt.chunks").NUMBER in o)
    second = stroke(name, 5)
    is_shown(name)
    live().end_all()
    assert current(name) == second
    matches_its_volume(name)


def test_a_stroke_of_a_removed_sculpt_is_refused():
    name = sculpt()
    run = work(name)
    bpy.data.objects.remove(bpy.data.objects[name])
    try:
        run.carve(BALL, np.array([[8.0, 5, 18, 0, 0, 1], [50, 5, 18, 0, 0, 1]]))
    except ValueError as error:
        assert "removed" in str(error)
    else:
        raise AssertionError("it was carved")
    live().end_all()
    nothing_is_left()


def test_a_stroke_that_does_nothing_does_not_break_undo():
    """Earlier, chunks that no undo step had made Blender crash in the next undo."""
    name = sculpt()
    common.push("before")
    bpy.data.objects[name].location.x = 1
    common.push("moved")
    view = {"matrix": [0.05, 0, 0, 0, 0, 0.05, 0, 0, 0, 0, -0.01, 0, 0, 0, 0, 1], "size": [200, 200]}
    past = json.dumps({"view": view, "rows": [[100_000, 100], [100_100, 100]]})
    for wrong, tool in ((past, ""), (past, "{"), ("{", "")):
        try:
            done = bpy.ops.riffler.stroke("EXEC_DEFAULT", True, stroke=wrong, tool=tool)
        except RuntimeError:
            done = {"CANCELLED"}
        assert done == {"CANCELLED"}
        nothing_is_left()
        bpy.ops.ed.undo()
        bpy.context.view_layer.update()
        assert bpy.data.objects[name].location.x == 0
        bpy.ops.ed.redo()
        matches_its_volume(name)
    first = stroke(name, 1)
    assert bpy.ops.riffler.stroke("EXEC_DEFAULT", True, stroke=past) == {"CANCELLED"}
    assert live().of(bpy.data.objects[name]) is not None, "a running session continues"
    assert current(name) == first
