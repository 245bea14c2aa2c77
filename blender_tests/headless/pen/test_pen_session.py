"""Sessions of devices as a user has them: how they begin and end, their display, refusals."""

import tempfile
import time
from pathlib import Path

import bpy
import numpy as np
import riffler

from support import common, sculpting, spacemouse_run
from support.device_sessions import (
    FAST,
    NAME,
    Hand,
    folder,
    no_session,
    now,
    now_of,
    sculpt,
    sculpt_for,
    sessions,
    work,
)
from support.sculpting import is_shown, live, matches_its_volume, nothing_is_left


@common.core_bound
def test_a_session_that_cuts_nothing_changes_nothing():
    ob = sculpt()
    key, before = common.part("sculpt.sculpt_store").identity(ob.data), now()
    place = folder("air")
    assert sculpt_for(0.3, gap=500.0, record=True, folder=str(place)) == {"CANCELLED"}
    no_session()
    live().end_all()
    assert common.part("sculpt.sculpt_store").identity(ob.data) == key and now() == before
    assert not list(place.iterdir())
    matches_its_volume(NAME)
    nothing_is_left()


@common.core_bound
def test_a_session_reports_that_it_makes_no_copies():
    sculpt()
    settings = bpy.context.scene.riffler.sculpt
    for mirror, radial, said in ((set(), 1, False), ({"X"}, 1, True), (set(), 3, True)):
        settings.mirror, settings.radial = mirror, radial
        assert ("makes no copies" in common.printed(lambda: sculpt_for(0.1, gap=500.0))) == said
    no_session()


@common.core_bound
def test_a_recording_is_a_device_and_ends_by_itself():
    sculpt()
    x = np.linspace(0, 1, 500)
    journal = riffler.Journal()
    journal.add_tool(1, {"kind": "ball", "diameter": 6.0, "length": 30.0})
    poses = np.c_[10 + 40 * x, 30 + 0 * x, 19 + 0 * x, 0 * x, 0 * x, 1 + 0 * x]
    journal.add_stroke(1, poses, times=2 * x)
    path = common.out("hand.rjournal")
    journal.save(path)
    assert sculpt_for(60.0, device="recording", recording=path, stiffness=5.0) == {"FINISHED"}
    no_session()
    live().end_all()
    low = np.min([c.poses[:, 2].min() for c in common.content(bpy.data.objects[NAME]).cuts])
    assert 18.9 < low < 19.6, low
    matches_its_volume(NAME)
    nothing_is_left()


def test_the_shown_chunks_follow_and_may_be_removed():
    ob = sculpt()
    hand = Hand(ob)
    assert common.part("sculpt.chunks").is_hidden(ob) and bpy.context.object == ob
    hand.down(20)
    assert hand.look(lambda: hand.session.run.in_stroke)
    is_shown(NAME)
    tool = bpy.data.objects["Riffler Tool"]
    assert np.allclose(tool.matrix_world.translation, hand.session.run.pose[:3], atol=1e-4)
    pushed = hand.session.run.push
    assert pushed.shape == (2, 3) and np.isfinite(pushed).all()
    chunks = [c for c in common.part("sculpt.chunks").collection_of(ob.riffler.mark).objects if "riffler_chunk" in c]
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


@common.core_bound
def test_the_force_on_the_tool_is_the_materials_and_against_its_motion():
    """Removal force: the constant times the volume removed per second, against the motion (docs/methods.md)."""
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
    path = common.out("during.blend")
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
    common.push("removed")
    bpy.ops.ed.undo()
    assert now() == last
    no_session()
    is_shown(NAME)
    live().end_all()
    matches_its_volume(NAME)


def test_a_sculpt_that_is_changed_meanwhile_keeps_the_change():
    ob = sculpt()
    hand = Hand(ob)
    hand.stroke(10)
    volume = riffler.Volume.block((0, 0, 0), (60, 60, 10), 0.5, "z")
    common.part("sculpt.sculpts").commit(ob.data, common.part("common.contents").Content(volume), 1.0)
    assert not hand.session.look()
    no_session()
    assert common.content(ob).volume.volume == 36000
    nothing_is_left()


def test_a_failing_device_ends_the_session_and_finished_strokes_stay():
    sculpt()
    hand = Hand(bpy.data.objects[NAME])
    first = hand.stroke(10)
    work().volume.subtract(riffler.Volume.block((0, 0, 0), sculpting.SIZE, sculpting.PITCH, "z"))  # an error elsewhere
    try:
        hand.session.look()
    except RuntimeError as error:
        assert "something else" in str(error)
        hand.session.fail(error)
    no_session()
    common.push("spoiled")
    bpy.ops.ed.undo()
    assert now() == first
    is_shown(NAME)
    live().end_all()
    nothing_is_left()


def test_no_other_work_takes_the_sculpt_meanwhile_and_disabling_the_addon_ends_the_session():
    ob = sculpt()
    name = ob.name
    hand = Hand(ob)
    last = hand.stroke(10)
    assert not bpy.ops.riffler.cut_curve.poll() and not bpy.ops.riffler.new_stock.poll()
    assert not bpy.ops.riffler.stroke.poll()
    assert bpy.ops.riffler.pen_sculpt.poll() and bpy.ops.riffler.pen_stop.poll()
    assert bpy.ops.riffler.pen_stop() == {"FINISHED"} and hand.session.ended
    assert not bpy.ops.riffler.pen_stop.poll() and bpy.ops.riffler.new_stock.poll()
    no_session()
    hand = Hand(ob)
    bpy.ops.preferences.addon_disable(module=common.MODULE)
    assert hand.session.ended
    bpy.ops.preferences.addon_enable(module=common.MODULE)
    assert bpy.data.objects[name].visible_get() and now() == last
    no_session()
    nothing_is_left()


class InHand:
    """A simulated pen under another kind's name: a session does not clear the trip of such a device by itself."""

    kind = "riffler-pen"

    def __init__(self, pen):
        self._pen = pen

    def __getattr__(self, name):
        return getattr(self._pen, name)


def looked(session, done, seconds=20.0):
    end = time.monotonic() + seconds
    while not done():
        assert time.monotonic() < end and session.look(), (session.run.state, session.run.why)
        time.sleep(0.02)


@common.core_bound
def test_a_pen_that_has_lost_counts_gives_force_again_once_it_is_homed_and_its_trip_cleared():
    """Lost counts leave the pose in doubt, so neither of the two buttons is enough alone."""
    ob = sculpt()
    before, pen = now_of(ob), riffler.pen.open("simulated")
    pen.aim(pen.geometry.forward([pen.geometry.home])[0])  # held in place to be homed; no button is pressed
    tool, options = riffler.Tool.ball(6, 30), {"at": (30, 30, 40, 0, 0, 1)}
    session = sessions().PenSession(bpy.context, ob, pen, tool, options)
    run, run.device = session.run, InHand(pen)
    at_home = lambda: np.abs(pen.state().counts - pen.geometry.home).max() < 20  # noqa: E731
    looked(session, lambda: run.state == "ready" and at_home())
    lost = lambda: run.state == "tripped" and "lost counts" in run.why  # noqa: E731
    pen.lose(1, 100)
    looked(session, lost)
    trips = len(run.session.trips)
    assert bpy.ops.riffler.pen_reset() == {"FINISHED"}  # the problem persists
    looked(session, lambda: len(run.session.trips) > trips and lost())
    assert abs(pen.state().stretch) > 1
    assert bpy.ops.riffler.pen_home() == {"FINISHED"}
    looked(session, lambda: abs(pen.state().stretch) < 0.1)
    rested = time.monotonic() + 1  # twice the duration of a trip that clears by itself
    looked(session, lambda: time.monotonic() > rested)
    assert lost()
    assert bpy.ops.riffler.pen_reset() == {"FINISHED"}
    looked(session, lambda: run.state == "ready")
    assert at_home()
    session.finish()
    no_session()
    live().end_all()
    assert now_of(ob) == before
    nothing_is_left()


@common.core_bound
def test_devices_without_a_home_are_not_homed_and_session_buttons_need_a_session():
    hand = Hand(sculpt())
    common.refused(bpy.ops.riffler.pen_home, "mouse has nothing to home")
    assert sessions().running is hand.session
    assert bpy.ops.riffler.pen_reset() == {"FINISHED"}  # nothing is tripped, and nothing changes
    first = hand.stroke(10)
    hand.session.finish()
    no_session()
    for name in ("pen_home", "pen_reset", "pen_stop"):
        assert not getattr(bpy.ops.riffler, name).poll()
        common.refused(getattr(bpy.ops.riffler, name), "No pen session is running")
    live().end_all()
    assert now() == first
    nothing_is_left()


def test_what_is_refused_changes_nothing():
    ob = sculpt()
    key, co = common.part("sculpt.sculpt_store").identity(ob.data), common.coordinates(ob.data)
    for settings, word in (
        ({"device": "riffler-pen"}, "plugged in"),
        ({"device": "spacemouse", "which": "2"}, "no spacemouse is plugged in"),
        ({"device": "recording", "recording": ""}, "recording"),
        ({"device": "recording", "recording": "/nowhere/x.rjournal"}, "x.rjournal"),
        ({"record": True, "folder": "//"}, "save the .blend"),
        ({"record": True, "folder": "/nowhere"}, "/nowhere"),
        ({"stiffness": 1e-3, "start": "CURSOR", "tool": '{"kind": "spoon"}'}, "spoon"),
    ):
        common.refused(lambda s=settings: bpy.ops.riffler.pen_sculpt(seconds=0.2, **{**FAST, **s}), word)
        no_session()
        nothing_is_left()
    common.refused(lambda: bpy.ops.riffler.pen_sculpt(tool=common.BALL), "seconds")
    assert common.part("sculpt.sculpt_store").identity(ob.data) == key
    assert np.array_equal(common.coordinates(ob.data), co)


@common.core_bound
def test_fixtures_keep_the_tool_of_a_device_out():
    """A clamp lies on the stock in the path of a groove: the hand goes through it, the tool does not."""
    ob = sculpt()
    clamps = bpy.data.collections.new("Clamps")
    bpy.context.scene.collection.children.link(clamps)
    bpy.ops.mesh.primitive_cube_add(size=8, location=(25, 10, 24))  # x 21 to 29, on the top
    clamps.objects.link(bpy.context.object)
    bpy.context.view_layer.objects.active = ob
    obstacles = common.part("pen.operators").obstacles
    assert obstacles(bpy.context, ob) is None
    bpy.context.scene.riffler.sculpt.fixtures = clamps
    hand = Hand(ob, obstacles=obstacles(bpy.context, ob))

    def height(y, x):
        """Smallest and largest height (mm) of the top along a groove, 3 mm to either side of x."""
        counts, spans = live().content(ob).volume.intervals("z")
        top = spans[np.cumsum(counts.ravel()) - 1, 1].reshape(counts.shape)
        row, places = top[:, int(y / 60 * top.shape[1])], (np.arange(top.shape[0]) + 0.5) * 60 / top.shape[0]
        near = row[abs(places - x) < 3]
        return near.min(), near.max()

    for y, places in ((10, (12,)), (30, (12, 25))):
        for _ in range(8):  # a late step stops the tool: the part left out is cut the next time
            hand.stroke(y)
            if all(height(y, x)[1] < 19.8 for x in places):
                break
        else:
            raise AssertionError(f"no groove at {y} in eight strokes: {[height(y, x) for x in places]}")
    hand.session.finish()
    assert height(10, 25)[0] == 20, "it went through the clamp"


@common.core_bound
def test_a_puck_carves_where_it_is_pushed_at_the_speed_of_its_curve():
    """A SpaceMouse of umockdev, in a Blender of its own: it must exist when Blender starts."""
    with tempfile.TemporaryDirectory() as name:
        place = Path(name)
        removed = spacemouse_run.reported(place, "sculpted")["removed"]
        assert removed > 10, removed
        (path,) = place.glob("*.rjournal")
        strokes, replayed = riffler.Journal.load(path).strokes, riffler.Session.replay(path)
    assert len(strokes) > 1, "the button was let go, and held again"
    rows = np.vstack([s.poses for s in strokes])
    assert np.abs(rows[:, 1:] - (*spacemouse_run.START[1:], 0, 0, 1)).max() < 0.01, (
        "it goes to the right, and nowhere else"
    )
    longest = max(strokes, key=len)
    way, seconds = (x[-1] - x[0] for x in (longest.poses[:, 0], longest.times))
    speed = (
        60 * ((spacemouse_run.PUSH / spacemouse_run.FULL - 0.08) / (1 - 0.08)) ** 2
    )  # bubble, exponent: defaults of riffler.pen.open
    assert seconds > 0.5 and abs(way / seconds / speed - 1) < 0.05, (way, seconds, speed)
    assert np.isclose(removed, 60 * 60 * 20 - replayed.volume)


def turned_view(angle):
    """Turns the 3D view about the world's z; returns its axes."""
    from mathutils import Quaternion

    views = common.part("blender.views")
    for _, _, space in views.views():
        space.region_3d.view_rotation = Quaternion((0, 0, 1), angle)
        space.region_3d.view_perspective = "PERSP"
    return views.facing()


@common.core_bound
def test_a_hand_that_touches_the_stock_stays_on_it_and_cuts_nothing():
    ob = sculpt("xyz")
    before = common.content(ob).volume.volume
    operators = common.part("pen.operators")
    brushes = common.part("sculpt.brushes")
    settings = bpy.context.scene.riffler.pen
    settings.device = "simulated"
    settings.touch, settings.gap = True, 1.0
    try:
        options = operators.session_options(bpy.context, ob, settings, brushes.of("remove"))
        assert options["touch"] is True
        assert not operators.session_options(bpy.context, ob, settings, brushes.of("add"))["touch"]
        device = operators.open_device(settings)
        session = sessions().PenSession(bpy.context, ob, device, riffler.Tool.ball(6, 30), options)
    finally:
        settings.property_unset("touch")
        settings.property_unset("gap")
        settings.property_unset("device")
    try:
        until(lambda: session.look() and device.state().homed and session.run.pose is not None)
        device.aim(device.state().pose)
        time.sleep(0.3)
        home = device.state().pose
        device.aim(home + np.array([0, 0, -4.0, 0, 0, 0]))
        until(lambda: session.look() and session.run.force > 0.5)
        for _ in range(20):
            time.sleep(0.02)
            assert session.look() and session.run.pose[2] > 19.5, "the top is at 20"
        assert session.run.thread.startswith("Thread: ")
        operators._tell(session)
        assert bpy.context.window_manager.riffler.thread == session.run.thread
    finally:
        session.finish()
    assert common.content(ob).volume.volume == before
    assert bpy.context.window_manager.riffler.thread == ""
    no_session()


def test_the_pen_s_axes_follow_the_view_between_strokes():
    ob = sculpt()
    ob.rotation_euler = (0, 0, 0.5)
    bpy.context.view_layer.update()
    begun = turned_view(0.0)
    assert begun is not None and np.allclose(begun, np.eye(3), atol=1e-6), "the view from the top"
    device = riffler.pen.open("simulated")
    tool = riffler.Tool.ball(6, 30)
    at = [30, 30, 40, 0, 0, 1]
    session = sessions().PenSession(bpy.context, ob, device, tool, {"at": at, "scale": 0.5}, view=True)
    pure = common.part("pen.pure.view_turn")
    to_frame = common.part("sculpt.sculpts").from_world(ob)[:3, :3]
    try:
        assert np.allclose(session.run.axes.turn, pure.turn_of("simulated", begun, to_frame), atol=1e-6)
        home = device.state().pose
        device.aim(home, buttons=1)
        until(lambda: device.state().buttons == 1)
        view = turned_view(1.0)
        before = session.run.axes.turn
        for _ in range(5):
            assert session.look()
        assert session.run.axes.turn is before, "not while the button is held"
        device.aim(home, buttons=0)
        until(lambda: device.state().buttons == 0)
        tool = session.run.pose
        assert session.look()
        assert np.allclose(session.run.axes.turn, pure.turn_of("simulated", view, to_frame), atol=1e-6)
        until(lambda: session.look() and np.abs(session.run.pose[:3] - tool[:3]).max() < 1.0)
    finally:
        session.finish()
    assert sculpt_for(0.2, gap=500.0, axes="VIEW") == {"CANCELLED"}
    camera = bpy.data.objects.new("Eye", bpy.data.cameras.new("Eye"))
    bpy.context.collection.objects.link(camera)
    camera.rotation_euler = (np.pi / 2, 0, 0)
    bpy.context.view_layer.update()
    for _, _, space in common.part("blender.views").views():
        space.camera, space.region_3d.view_perspective = camera, "CAMERA"
    assert np.allclose(common.part("blender.views").facing(), [(1, 0, 0), (0, 0, 1), (0, -1, 0)], atol=1e-6), "its own"
    no_session()


def until(done, seconds=20.0):
    end = time.monotonic() + seconds
    while not done():
        assert time.monotonic() < end, "nothing came of it"
        time.sleep(0.02)


def test_a_pointer_and_a_recording_keep_their_own_frame():
    ob = sculpt()
    hand = Hand(ob)
    hand.session.run.turns_with(True, {})
    assert hand.session.run.axes is None
    hand.session.finish()
