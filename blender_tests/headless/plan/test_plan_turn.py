"""Turning a plan's tool without a window: angles, keys, undo, collisions, going to points, drawing."""

import math
import time
from types import SimpleNamespace

import bpy
import numpy as np
import riffler

from support import common, plans
from support.keyframed_plan import close, curves, indices, insert, pair, paths, seen, state, update


def turn(**more):
    assert bpy.ops.riffler.plan_turn(**more) == {"FINISHED"}


def by_hand(path, index, inclination, tilt):
    """The axis by its formula, from the frame's rows."""
    x, y, z = path.frames[index]
    forward = math.sin(inclination) * x + math.cos(inclination) * z
    return math.cos(tilt) * forward + math.sin(tilt) * y


def test_the_angles_of_a_turn_are_the_key_s_own():
    ob = plans.on_timeline()
    bpy.context.scene.frame_set(73)
    for degrees in ((7.5, -37.5), (0, 0), (-75, 67.5), (12.345, 0.001)):
        inclination, tilt = np.radians(degrees)
        turn(inclination=inclination, tilt=tilt)
        path = paths(ob)[0]
        assert indices(ob)[0] == [0, 72, 144]
        assert close(path.keys[72], by_hand(path, 72, inclination, tilt), 1e-9)
        assert close(path.axes[72], path.keys[72], 1e-12) and not state(ob).problems
        assert close(seen(ob, 73)[1], path.axes[72])
    before = np.array(path.lean(72, path.keys[72]))
    turn(inclination=math.radians(10), tilt=math.radians(-5), relative=True)
    assert close(paths(ob)[0].lean(72, paths(ob)[0].keys[72]), before + np.radians((10, -5)), 1e-6)
    turn(inclination=0.2, tilt=0.1, path=2, point=10)
    assert close(paths(ob)[1].keys[10], by_hand(paths(ob)[1], 10, 0.2, 0.1), 1e-7)
    # The exact key survives updates from edits elsewhere, and a file.
    exact = paths(ob)[0].keys[72].copy()
    insert(pair(ob)[0], 100, (0, -0.5, 1))
    assert np.array_equal(paths(ob)[0].keys[72], exact) and 99 in indices(ob)[0]


def test_neighbours_are_oriented_again():
    ob = plans.on_timeline()
    before = paths(ob)[0].axes.copy()
    bpy.context.scene.frame_set(73)
    turn(inclination=0.4, tilt=0.0)
    path = paths(ob)[0]
    again = path.orient(dict(path.keys), interpolation=path.interpolation)
    assert close(path.axes, again.axes, 1e-12) and np.abs(path.axes[40] - before[40]).max() > 0.01
    assert close(path.axes[[0, 144]], before[[0, 144]], 1e-9)


def test_a_turn_is_one_step_of_undo():
    ob = plans.on_timeline()
    name = ob.name
    bpy.context.scene.frame_set(73)
    common.push("timeline")
    bpy.ops.riffler.plan_turn("EXEC_DEFAULT", True, inclination=math.radians(20), tilt=0.0)
    exact = paths(ob)[0].keys[72].copy()
    bpy.ops.ed.undo()
    update()
    assert indices(bpy.data.objects[name])[0] == [0, 144]
    bpy.ops.ed.redo()
    update()
    ob = bpy.data.objects[name]
    assert indices(ob)[0] == [0, 72, 144] and np.array_equal(paths(ob)[0].keys[72], exact)


def test_keys_that_cannot_be_turned_are_reported_and_nothing_changes():
    bpy.context.view_layer.objects.active = None
    for call in ("plan_turn", "plan_point", "plan_point_key"):
        assert not getattr(bpy.ops.riffler, call).poll()
        common.refused(getattr(bpy.ops.riffler, call), "plan")
    ob = plans.on_timeline()
    keys = indices(ob)
    bpy.context.scene.frame_set(150)
    common.refused(bpy.ops.riffler.plan_turn, "Frame 150 is on no path", "1 and 145")
    common.refused(bpy.ops.riffler.plan_point_key, "Frame 150 is on no path")
    common.refused(lambda: bpy.ops.riffler.plan_turn(path=3), "the plan has 2")
    common.refused(lambda: bpy.ops.riffler.plan_point(path=1, point=145), "path 1 has 145")
    bpy.context.scene.frame_set(20)
    path = paths(ob)[0]
    inclination, tilt = path.lean(19, -path.keys[0])
    common.refused(lambda: bpy.ops.riffler.plan_turn(inclination=inclination, tilt=tilt), "opposite")
    assert indices(ob) == keys and len(curves(pair(ob)[0])[0].keyframe_points) == 5


def test_jumping_to_a_point_and_setting_a_free_key_work():
    part = plans.part_object()
    ob = plans.on_timeline()
    scene = bpy.context.scene
    assert bpy.ops.riffler.plan_point(path=1, point=72) == {"FINISHED"} and scene.frame_current == 73
    track = common.part("plan.replan").layout_of(ob, common.part("plan.plan_store").plan(ob)).tracks[1]
    bpy.ops.riffler.plan_point(path=2, point=30)
    assert track.nearest(scene.frame_current_final) == 30
    before = paths(ob)[0].axes[72].copy()
    bpy.ops.riffler.plan_point_key(path=1, point=72)  # no part: unchanged
    assert scene.frame_current == 73 and close(paths(ob)[0].keys[72], before, 1e-9)
    scene.riffler.plan.part = part
    bpy.ops.riffler.plan_point_key(path=1, point=72)
    # The part is constant along x: 45°, between floor and wall, is the least tilt.
    assert close(paths(ob)[0].keys[72], np.array((0, -1, 1)) / math.sqrt(2), 1e-9)


@common.core_bound
def test_where_nothing_is_free_no_key_is_set():
    """A plate over the step's whole floor, 5 mm above the ball's tip."""
    part = plans.part_object()
    ob = plans.on_timeline(chosen=plans.paths()[:1])
    settings = bpy.context.scene.riffler.plan
    settings.part, settings.fixtures = part, bpy.data.collections.new("Fixtures")
    bpy.context.scene.collection.children.link(settings.fixtures)
    mesh = bpy.data.meshes.new("Plate")
    x, y, z = np.meshgrid((-50, 110), (-50, 90), (13, 20), indexing="ij")
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    mesh.from_pydata(np.c_[x.ravel(), y.ravel(), z.ravel()].tolist(), [], faces)
    settings.fixtures.objects.link(bpy.data.objects.new("Plate", mesh))
    update()
    store = common.part("plan.plan_store")
    identity, frame = store.identity(ob), bpy.context.scene.frame_current
    call = lambda: bpy.ops.riffler.plan_point_key(path=1, point=72)  # noqa: E731
    common.refused(call, "No orientation is free here", "no key was set")
    assert store.identity(ob) == identity and bpy.context.scene.frame_current == frame
    assert len(curves(pair(ob)[0])[0].keyframe_points) == 2


def look(ob, axis):
    surroundings, looking, turning = (
        common.part(f"plan.{name}") for name in ("obstacles", "orientation_probe", "current_pose")
    )
    spot = turning.spot(bpy.context.scene, ob)
    return looking.state(bpy.context.scene, surroundings.now(bpy.context, ob), spot, np.asarray(axis, float))


def test_collisions_are_named_with_their_depth():
    part = plans.part_object()
    ob = plans.on_timeline(chosen=plans.paths()[:1])
    bpy.context.scene.riffler.plan.part = part
    bpy.context.scene.frame_set(73)
    free = look(ob, (0, -0.6, 0.8))
    assert free.free and free.other == "Step"
    upright = look(ob, (0, 0, 1))
    # The shank begins 25 mm above the tip, which is at z = 8, and extends as far out as the wall, whose top is at 24.
    assert upright.free and upright.piece == "shank" and abs(upright.distance - 9) < 1e-6
    leaning = look(ob, (0, 0.6, 0.8))
    assert not leaning.free and "hits Step by" in str(leaning)
    bpy.context.scene.riffler.plan.clearance = 10
    wanted = look(ob, (0, 0, 1))
    assert not wanted.free and "Shank is only 9 mm from Step" in str(wanted)


def test_surroundings_are_built_once_and_again_after_something_moved():
    part = plans.part_object()
    ob = plans.on_timeline(chosen=plans.paths()[:1])
    bpy.context.scene.riffler.plan.part = part
    surroundings = common.part("plan.obstacles")
    made = surroundings.made
    first = surroundings.now(bpy.context, ob)
    bpy.context.scene.frame_set(73)
    turn(inclination=0.1, tilt=0.1)
    bpy.ops.riffler.plan_check()
    part.data.update_tag()  # reports a change, as undo does, although nothing has changed
    update()
    assert surroundings.now(bpy.context, ob) is first and surroundings.made == made + 1
    part.location.z = 5
    update()
    assert surroundings.known(ob) is None
    assert surroundings.now(bpy.context, ob) is not first and surroundings.made == made + 2
    part.location.z = 6  # a script's change, which Blender has not reported yet
    assert surroundings.known(ob) is not None
    assert surroundings.now(bpy.context, ob).collider is not None and surroundings.made == made + 3


def test_adding_or_removing_a_fixture_outdates_the_results():
    """As + does to an existing collection: no known object reports a change."""
    ob = plans.on_timeline(chosen=plans.paths()[:1])
    settings, surroundings = bpy.context.scene.riffler.plan, common.part("plan.obstacles")
    settings.part = plans.part_object()
    bpy.context.scene.frame_set(73)
    assert look(ob, (0, -0.6, 0.8)).free
    version = surroundings.version(ob)
    clamp = bpy.data.objects.new("Clamp", plans.part_object().data)
    settings.fixtures = bpy.data.collections.new("Fixtures")
    bpy.context.scene.collection.children.link(settings.fixtures)
    for change in (settings.fixtures.objects.link, settings.fixtures.objects.unlink):
        known = surroundings.known(ob)
        assert known is not None
        change(clamp)
        assert surroundings.known(ob) is None and surroundings.version(ob) != version
        assert surroundings.now(bpy.context, ob) is not known
        version = surroundings.version(ob)
    settings.part = None
    assert surroundings.known(ob) is None and surroundings.version(ob) != version


def test_a_map_is_made_when_shown_and_again_only_for_another_point():
    part = plans.part_object()
    ob = plans.on_timeline(chosen=plans.paths()[:1])
    scene = bpy.context.scene
    scene.riffler.plan.part = part
    looking, turning = common.part("plan.orientation_probe"), common.part("plan.current_pose")
    scene.frame_set(73)

    def ask():
        spot = turning.spot(scene, ob)
        known = looking.ask(bpy.context, spot)
        for _ in range(2000):  # stands in for a window's timer
            if looking._look() is None:
                break
            time.sleep(0.002)
        return spot, known

    maps = looking.maps
    spot, known = ask()
    assert not known.old and looking.maps == maps + 1 and known.text.startswith("Free")
    part = riffler.Collider(riffler.Mesh(*plans.step()))
    same = riffler.plan.free_orientations(spot.line, plans.TOOL, part, index=72)
    assert np.array_equal(known.map.state, same.state) and known.map.state.shape == (21, 21)
    turn(inclination=float(known.map.inclinations[12]), tilt=float(known.map.tilts[3]))
    spot, known = ask()
    assert looking.maps == maps + 1 and not known.old, "turning made a map"
    assert close(spot.axis, known.map.axes[12, 3], 1e-9)
    assert known.free == bool(known.map.free[12, 3]) and not known.free
    scene.frame_set(90)
    assert looking.ask(bpy.context, turning.spot(scene, ob)).old and known.map is not None
    ask()
    assert looking.maps == maps + 2 and known.map.index == 89


def looked(ob):
    """The timer's result at the scene's frame."""
    looking, turning = common.part("plan.orientation_probe"), common.part("plan.current_pose")
    known = looking.ask(bpy.context, turning.spot(bpy.context.scene, ob))
    while looking._look() is not None:
        time.sleep(0.002)
    return known


def test_a_missing_part_is_reported_instead_of_a_map():
    part = plans.part_object()
    ob = plans.on_timeline(chosen=plans.paths()[:1])
    bpy.context.scene.riffler.plan.part = part
    bpy.context.scene.frame_set(73)
    homes = list(part.users_collection)
    for collection in homes:
        collection.objects.unlink(part)
    update()
    known = looked(ob)
    assert known.map is None and not known.free and "was deleted from this scene" in known.text
    homes[0].objects.link(part)
    update()
    known = looked(ob)
    assert known.map is not None and not known.old and known.free


def test_an_undo_to_the_same_state_makes_no_new_map():
    part = plans.part_object()
    ob = plans.on_timeline(chosen=plans.paths()[:1])
    name = ob.name
    bpy.context.scene.riffler.plan.part = part
    bpy.context.scene.frame_set(73)
    common.push("plan")
    maps, made = common.part("plan.orientation_probe").maps, common.part("plan.obstacles").made
    assert not looked(ob).old
    bpy.ops.riffler.plan_turn("EXEC_DEFAULT", True, inclination=0.3, tilt=0.1)
    bpy.ops.ed.undo()
    update()
    known = looked(bpy.data.objects[name])
    assert (
        not known.old
        and common.part("plan.orientation_probe").maps == maps + 1
        and common.part("plan.obstacles").made == made + 1
    )


def test_a_map_requested_before_an_undo_is_made_after_it():
    """The plan's object is then another one in memory."""
    ob = plans.on_timeline()
    bpy.context.scene.riffler.plan.part = plans.part_object()
    looking, turning = common.part("plan.orientation_probe"), common.part("plan.current_pose")
    common.push("plan")
    bpy.context.scene.frame_set(60)
    ob["touched"] = 1
    common.push("touched")
    looking.ask(bpy.context, turning.spot(bpy.context.scene, ob))
    bpy.ops.ed.undo()
    while looking._look() is not None:  # the timer comes before the view is drawn, and the drawing asks again
        time.sleep(0.002)
    assert looking._known.map is not None and looking._known.free


def test_pointing_selects_the_nearest_visible_contact():
    """Compared with every contact of all paths, projected one by one."""
    drawn, sight = common.part("plan.path_view"), common.part("sculpt.pure.view_rays")
    plan = riffler.plan.Plan([p.divided(0.5) for p in plans.paths()], plans.TOOL)
    rng = np.random.default_rng(7)
    found = 0
    for _ in range(40):
        back = rng.normal(size=3)
        back /= np.linalg.norm(back)
        right = np.cross(rng.normal(size=3), back)
        right /= np.linalg.norm(right)
        matrix = np.eye(4)
        matrix[:3, :3] = np.stack([right, np.cross(back, right), -back]) / 60
        matrix[:3, 3] = -matrix[:3, :3] @ (20, 10, 5)
        view = sight.ViewRays(matrix, (800, 800))  # parallel
        at = rng.uniform(200, 600, 2)
        every = [(k, p, *np.hypot(*(view.project(p.contacts[:, s]) - at).T)) for k, p in enumerate(plan.paths)
                 for s in (0, 1)]  # fmt: skip
        gap, path = min((min(gaps), k) for k, _, *gaps in every)
        got = drawn.nearest(plan, view, at)
        assert (got is None) == (gap > drawn.NEAR)
        if got is not None:
            found += 1
            assert abs(np.hypot(*(view.project([got.point])[0] - at)) - gap) < 1e-6 and got.path == path
    assert found > 5


def from_above(scale=30.0):
    """A parallel view along -z, `scale` pixels per millimetre, centred on the step."""
    matrix = np.diag([scale / 400, scale / 400, -1 / 1000, 1.0])
    matrix[:2, 3] = -matrix[0, 0] * np.array((30, 20))
    return common.part("sculpt.pure.view_rays").ViewRays(matrix, (800, 800))


def line(y, z, n=200):
    """A path along x with both contacts 3 mm from it; contacts above z = 20 are in front."""
    centres = np.c_[np.linspace(0, 60, n), np.full(n, y), np.full(n, z)]
    aside = np.array((0, 3.0, 0))
    contacts = np.stack([centres - aside, centres + aside], axis=1)
    return riffler.plan.PencilPath(3.0, centres, contacts, np.tile((0, 0, 1.0), (n, 2, 1)), closed=False)


def test_hidden_contacts_cannot_be_selected():
    drawn, view = common.part("plan.path_view"), from_above(3.0)
    plan = riffler.plan.Plan([line(20, 0), line(20.5, 30)], plans.TOOL)
    at, asked = view.project([(30, 17.1, 0)])[0], []

    def below(place):
        asked.append(place)
        return place[2] < 20

    assert drawn.nearest(plan, view, at).path == 0
    found = drawn.nearest(plan, view, at, hidden=below)
    assert found.path == 1 and abs(found.point[0] - 30) < 0.2 and abs(found.point[1] - 17.5) < 1e-9
    assert len(asked) < 40, "every contact was asked for"
    # On a path that is hidden here and visible 4 mm further, that is 12 pixels, the visible contact is found.
    found = drawn.nearest(riffler.plan.Plan([line(20, 0)], plans.TOOL), view, at, hidden=lambda place: place[0] < 34)
    assert 34 <= found.point[0] < 36
    asked.clear()
    plan = riffler.plan.Plan([line(20 + 0.01 * k, 0) for k in range(300)], plans.TOOL)
    assert drawn.nearest(plan, view, at, hidden=below) is None and len(asked) <= drawn.ASKED


def test_only_visible_objects_hide_contacts():
    common.scale(1.0)
    part = plans.part_object()
    ob = plans.on_timeline(chosen=plans.paths()[:1])
    space = SimpleNamespace(shading=SimpleNamespace(type="SOLID", show_xray=False))
    context = SimpleNamespace(scene=bpy.context.scene, view_layer=bpy.context.view_layer, space_data=space)
    view = from_above()

    def hidden(place):
        update()
        return common.part("plan.occlusion").hider(context, view)(np.array(place, float))

    seen, below = (30, 10, 8.06), (30, 10, -0.06)  # over the step's floor, and under it
    assert not hidden(seen) and hidden(below)
    bpy.context.scene.frame_set(73)  # over the middle of the path
    assert not hidden(paths(ob)[0].centres[72]), "the plan's own tool hides the part"
    roof = bpy.data.objects.new("Roof", part.data)
    bpy.context.scene.collection.objects.link(roof)
    roof.location.z = 40
    assert hidden(seen)
    roof.display_type = "WIRE"
    assert not hidden(seen) and hidden(below)
    roof.display_type = "TEXTURED"
    roof.hide_set(True)
    assert not hidden(seen)
    roof.hide_set(False)
    space.shading.show_xray = True
    assert not hidden(seen) and not hidden(below)


def test_a_path_is_drawn_with_contacts_and_keys():
    drawn = common.part("plan.path_view")
    valley, loop = plans.paths()
    n = len(loop)
    assert drawn.contacts(loop).shape == (4 * n, 3) and drawn.contacts(valley).shape == (4 * (len(valley) - 1), 3)
    off = drawn.contacts(loop)[0] - loop.contacts[0, 0]
    assert close(off, drawn.OFF * 3 * loop.normals[0, 0], 1e-12)
    ends = drawn.normals(loop).reshape(-1, 2, 3)
    assert close(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1), drawn.NORMAL * 3, 1e-9)
    assert len(drawn.axes(loop, list(loop.keys))) == 6 and len(drawn.axes(plans.ring())) == 0
    _, kind, arrays = drawn.drawn("AXES", riffler.plan.Plan([valley, loop], plans.TOOL), 1000.0)
    assert kind == "LINES" and len(arrays["pos"]) == 2 * (len(valley) + n)
    assert close(arrays["pos"][0] * 1000, valley.centres[0], 1e-9)
