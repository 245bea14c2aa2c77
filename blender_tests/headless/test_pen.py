"""Sculpting with a device: the simulated pen and recordings, in real time."""

from pathlib import Path

import bpy
import numpy as np
import riffler

import support

FAST = {"device": "simulated", "gap": 0.0, "scale": 1.0, "removal_constant": 0.001}


def sculpt():
    support.scale(1)
    return support.stock(size=(60, 60, 20), pitch=0.5, directions="z")


def sculpt_for(seconds, **more):
    return bpy.ops.riffler.pen_sculpt("EXEC_DEFAULT", True, seconds=seconds, tool=support.BALL, **{**FAST, **more})


def until_cut(**more):
    """A hand of its own needs some seconds, and a busy machine takes the force away now and then."""
    for _ in range(4):
        if sculpt_for(4.0, **more) == {"FINISHED"}:
            return
    raise AssertionError("the simulated hand has cut nothing four times")


def nothing_is_left():
    assert not bpy.context.window_manager.riffler.sculpting
    assert not [c for c in bpy.data.collections if support.part("bl.preview").MARK in c]
    left = [x.name for x in (*bpy.data.objects, *bpy.data.meshes, *bpy.data.materials) if x.name.startswith("Riffler")]
    assert not left, left
    assert support.part("operators.pen")._live is None


def matches_its_volume(ob):
    surface = support.content(ob).volume.to_mesh()
    assert np.array_equal(support.coordinates(ob.data), np.asarray(surface.vertices, np.float32))
    assert len(ob.data.polygons) == len(surface.triangles)


def journals(folder):
    return sorted(Path(folder).glob("*.rjournal"))


def empty_folder(name):
    folder = Path(support.out(name))
    folder.mkdir(exist_ok=True)
    for file in folder.iterdir():
        file.unlink()
    return str(folder)


def test_a_stroke_with_the_simulated_pen_is_in_volume_mesh_journal_and_cuts():
    ob = sculpt()
    before = support.content(ob).volume.volume
    folder = empty_folder("recorded")
    until_cut(record=True, folder=folder)
    content = support.content(ob)
    assert content.volume.volume < before - 1
    assert (bpy.context.object, ob.hide_get(), ob.select_get()) == (ob, False, True)
    matches_its_volume(ob)
    nothing_is_left()
    replayed = riffler.Session.replay(journals(folder)[-1])
    assert replayed.to_bytes() == content.volume.to_bytes()
    strokes = riffler.Journal.read(journals(folder)[-1]).strokes
    assert sum(c.moves for c in content.cuts) == sum(len(s) - 1 for s in strokes if len(s) > 1)
    assert content.cuts[0].tool["kind"] == "ball"


def test_a_session_is_one_undo_step():
    name = sculpt().name
    support.push("stock")
    before = support.shape(support.content(bpy.data.objects[name]).volume)
    until_cut()
    after = support.shape(support.content(bpy.data.objects[name]).volume)
    bpy.ops.ed.undo()
    assert support.same(before, support.shape(support.content(bpy.data.objects[name]).volume))
    matches_its_volume(bpy.data.objects[name])
    bpy.ops.ed.redo()
    assert support.same(after, support.shape(support.content(bpy.data.objects[name]).volume))
    matches_its_volume(bpy.data.objects[name])
    nothing_is_left()


def test_a_session_that_cuts_nothing_changes_nothing():
    ob = sculpt()
    key = support.part("bl.store").identity(ob.data)
    folder = empty_folder("air")
    assert sculpt_for(0.3, gap=500.0, record=True, folder=folder) == {"CANCELLED"}
    assert support.part("bl.store").identity(ob.data) == key
    assert len(journals(folder)) == 1
    matches_its_volume(ob)
    nothing_is_left()


def test_a_recording_is_a_device_and_ends_by_itself():
    import time

    ob = sculpt()
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
    low = np.min([c.poses[:, 2].min() for c in support.content(ob).cuts])
    assert 18.9 < low < 19.6, low
    matches_its_volume(ob)
    nothing_is_left()


class Session:
    """One that runs without a window, look by look."""

    def __init__(self, ob, **more):
        self.module = support.part("operators.pen")
        settings = bpy.context.scene.riffler.pen
        for key, value in {**FAST, **more}.items():
            setattr(settings, key, value)
        tool = {"kind": "ball", "diameter": 6.0, "length": 30.0}
        self.live = self.module._live = self.module.Live(bpy.context, ob, settings, tool)

    def look(self, done, seconds=30.0):
        import time

        end = time.monotonic() + seconds
        while time.monotonic() < end and not done(self.live):
            if not self.live.step(bpy.context):
                return False
            time.sleep(0.03)
        return True


def cutting(live):
    return live.run.removed > 5


def test_the_bricks_that_are_shown_are_the_mesh_of_the_volume():
    ob = sculpt()
    session = Session(ob)
    assert ob.hide_get() and bpy.context.object == ob and bpy.data.objects["Riffler Tool"]
    assert session.look(cutting), "no cut within 30 s"
    live = session.live
    shown = sum(len(ob.data.polygons) for ob in live._preview.bricks.values())
    assert shown == len(live.run.volume.to_mesh().triangles)
    tip = np.array(bpy.data.objects["Riffler Tool"].matrix_world.translation)
    assert np.allclose(tip, live.run.tool[:3], atol=1e-4)
    # somebody who removes what is shown spoils nothing
    for shown in (bpy.data.objects["Riffler Tool"], *list(live._preview.bricks.values())[::2]):
        bpy.data.objects.remove(shown)
    removed = live.run.removed
    assert session.look(lambda live: live.run.removed > removed + 1)
    live.finish(bpy.context)
    assert live.pending and "Removed" in live.message
    matches_its_volume(ob)
    nothing_is_left()


def test_an_undo_meanwhile_ends_it_and_takes_it_back_and_a_redo_brings_it():
    name = sculpt().name
    support.push("stock")
    before = support.content(bpy.data.objects[name]).volume.volume
    session = Session(bpy.data.objects[name])
    assert session.look(cutting)
    support.push("something else, with the picture of the session in it")
    bpy.ops.ed.undo()
    assert session.live.done and not session.live.step(bpy.context)
    nothing_is_left()
    bpy.ops.ed.redo()
    nothing_is_left()
    ob = bpy.data.objects[name]
    assert support.content(ob).volume.volume < before and not ob.hide_get()
    matches_its_volume(ob)
    bpy.ops.ed.undo()
    bpy.ops.ed.undo()
    ob = bpy.data.objects[name]
    assert support.content(ob).volume.volume == before and not ob.hide_get()
    matches_its_volume(ob)
    nothing_is_left()


def test_saving_ends_it_first_and_a_file_has_no_picture_of_it():
    ob = sculpt()
    name = ob.name
    session = Session(ob)
    assert session.look(cutting)
    path = support.out("during.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    assert session.live.done
    made = support.shape(support.content(ob).volume)
    bpy.ops.wm.open_mainfile(filepath=path)
    nothing_is_left()
    assert support.same(made, support.shape(support.content(bpy.data.objects[name]).volume))
    matches_its_volume(bpy.data.objects[name])


def test_another_file_ends_it():
    session = Session(sculpt())
    bpy.ops.wm.read_homefile()
    assert session.live.done
    nothing_is_left()


def test_a_sculpt_that_is_removed_meanwhile_loses_nothing():
    ob = sculpt()
    session = Session(ob)
    assert session.look(cutting)
    bpy.data.objects.remove(ob)
    assert not session.live.step(bpy.context)
    session.live.finish(bpy.context)
    assert "removed meanwhile" in session.live.message
    new = bpy.context.object
    assert new.name == "Stock Pen" and support.content(new).volume.volume < 72000
    matches_its_volume(new)
    nothing_is_left()


def test_a_sculpt_that_is_cut_meanwhile_keeps_that_cut():
    ob = sculpt()
    session = Session(ob)
    assert session.look(cutting)
    volume = riffler.Volume.block((0, 0, 0), (60, 60, 10), 0.5, "z")
    support.part("bl.sculpts").commit(ob.data, volume, [], 1.0)
    assert not session.live.step(bpy.context)
    session.live.finish(bpy.context)
    assert support.content(ob).volume.volume == 36000
    assert bpy.context.object != ob and support.content(bpy.context.object).volume.volume < 72000
    nothing_is_left()


def test_nothing_else_takes_the_sculpt_meanwhile_and_disabling_the_addon_ends_it():
    ob = sculpt()
    name = ob.name
    session = Session(ob)
    assert not bpy.ops.riffler.cut_curve.poll() and not bpy.ops.riffler.new_stock.poll()
    assert bpy.ops.riffler.pen_sculpt.poll()
    assert bpy.ops.riffler.pen_sculpt() == {"CANCELLED"} and session.live.asked
    assert not session.live.step(bpy.context)
    bpy.ops.preferences.addon_disable(module=support.MODULE)
    assert session.live.done
    bpy.ops.preferences.addon_enable(module=support.MODULE)
    assert bpy.data.objects[name].visible_get()
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
    ):
        support.refused(lambda s=settings: sculpt_for(0.2, **s), word)
        nothing_is_left()
    support.refused(lambda: bpy.ops.riffler.pen_sculpt(tool=support.BALL), "seconds")
    support.refused(lambda: bpy.ops.riffler.pen_sculpt(seconds=1.0, tool='{"kind": "spoon"}'), "spoon")
    assert support.part("bl.store").identity(ob.data) == key
    assert np.array_equal(support.coordinates(ob.data), co)
    nothing_is_left()
