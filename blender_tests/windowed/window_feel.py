"""Orient by Pen in a window. The simulated pen is led along a path and into the wall: the tool follows and stops, map
and clearance follow it, colliding stretches are red; the buttons set and delete keys, Ctrl Z; the cable is pulled out
and put in again; the plan is deleted meanwhile. Then mouse and tablet do the same without force."""

from pathlib import Path
from types import SimpleNamespace

import bpy
import numpy as np
from mathutils import Vector

from support import common, harness, plans

HERE = Path(__file__)
lessons = harness.load(HERE.with_name("lessons.py"))
gizmo = harness.load(HERE.with_name("window_gizmo.py"))
line = gizmo.line
module = common.part
ENDS = [0, 144]
A_MM = 2.4  # points of the path, and frames, for each mm
_home = []  # pose of the simulated pen as the session began, device's frame


def session():
    return module("pen.session").running


def tool():
    """The tool's axis as of the last look."""
    return session().run.pose[3:]


def state():
    return bpy.context.window_manager.riffler


def leaning(angle):
    """An axis that leans towards the wall."""
    return np.array([0, np.sin(angle), np.cos(angle)])


def lead(along, angle, buttons=0):
    """Aims the simulated hand: mm along the path, and the pen's angle to the wall, from where it began."""
    place = np.add(_home[0][:3], (along, 0, 0))
    session().run.device.aim([*place, *leaning(angle)], buttons=buttons)


def led(along, angle):
    """Steps: until tool and hand are there, as far as the wall lets them: the tool rests in ten looks."""
    lead(along, angle)
    run, seen = session().run, []

    def settled():
        if not seen or run.pose is not seen[-1]:  # each look has a pose of its own
            seen.append(run.pose)
        return len(seen) > 10 and np.ptp(seen[-10:], axis=0).max() < 0.02

    yield 1.5
    yield settled


def pressed(along, angle, button, count):
    """Steps: a button of the pen, until the path has so many keys."""
    lead(along, angle, button)
    yield lambda: len(line.indices()) == count
    lead(along, angle)
    yield 0.3
    yield line.settled


def contact(screen, point):
    """Pixels of a point's contact with the plate, where a user points at the path."""
    return gizmo.pixel(screen, line.paths()[0].contacts[point, 0])


def steps(screen):
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    with screen.override():
        bpy.ops.riffler.millimetres()
    part = plans.part_object()
    plans.on_timeline(chosen=plans.paths()[:1])
    settings = bpy.context.scene.riffler.plan
    settings.part = part
    bpy.context.scene.frame_set(73)
    line.look_at_the_part(screen)
    view = line.area(screen, "VIEW_3D").spaces.active.region_3d
    view.view_rotation = Vector((0.7, -0.8, 0.7)).to_track_quat("Z", "Y")
    lessons.only_open("RIFFLER_PT_timeline")
    yield from lessons.cut.open_tab(screen, "RIFFLER_PT_timeline")
    bpy.ops.ed.undo_push(message="Timeline")
    screen.to_view()
    yield 1.0
    yield from begun(screen, "riffler.plan_pen")
    yield from felt(screen)
    yield from keyed(screen)
    yield from unplugged(screen)
    yield from deleted(screen)
    yield from by_mouse(screen)
    yield from by_tablet(screen)


def begun(screen, button):
    """Steps: a session, begun by its button in the panel; the hand stays where it is."""
    begun_at = bpy.context.scene.frame_current - 1
    yield from lessons.press(screen, button)
    yield lambda: session() is not None
    assert state().sculpting and gizmo.module("plan.current_pose").tool_active(bpy.context)
    if session().run.pushes:
        yield lambda: session().run.device.state().homed
        _home[:] = [session().run.device.state().pose]
        lead(0, 0)
    screen.to_view()
    yield lambda: session().run.pose is not None
    yield 0.5
    if session().run.pushes:
        # On a busy computer the hand was still moving when its pose was read: the tool may have begun elsewhere.
        yield from led(0, 0)
        _home[0] = np.subtract(_home[0], [(session().run.point - begun_at) / A_MM, 0, 0, 0, 0, 0])
        yield from led(0, 0)


def felt(screen):
    """The tool follows the hand, and at the wall the hand feels a torque."""
    begun_at = tool().copy()
    yield from led(12, -0.3)
    yield lambda: abs(session().run.point - 72 - 12 * A_MM) < 4 and np.abs(tool() - begun_at).max() > 0.2
    yield lambda: session().state().free and abs(bpy.context.scene.frame_current - session().run.point - 1) <= 1
    assert not gizmo.module("plan.orientation_gizmo").RIFFLER_GGT_orientation.poll(bpy.context)
    free = tool().copy()
    yield from led(12, 0.9)
    run = session().run
    yield lambda: run.torque > 100 and run.touching == "cutter" and not session().state().free
    hand, stopped = 0.9 + np.arcsin(-free[1]) - 0.3, np.arcsin(tool()[1])
    assert stopped < 0.2, (hand, stopped)
    found = module("plan.orientation_probe")
    said = None

    def shown():
        """The panel, the sentence next to the tool and the map are of the wall."""
        nonlocal said
        said = module("plan.current_pose").said
        known = found._known
        mapped = not known.old and known.map is not None and known.map.index == run.point
        pushed = run.torque > 100 and state().force.startswith("Hand: active")
        return mapped and pushed and said[0].startswith("Cutter hits Step by") and not said[1]

    yield shown
    look, session().look = session().look, lambda: True  # the picture is of this moment
    yield 0.6
    assert said[0] in state().text and state().force.startswith("Hand: active"), (state().text, state().force)
    yield from screen.picture("feel-1-wall")
    session().look = look


def keyed(screen):
    """Keys at the wall and off it; the stretch between them and the ends is checked; Ctrl Z; the second button."""
    drawn = module("program.line_view")._drawn
    yield from pressed(12, 0.9, 1, 3)
    yield lambda: "collides" in drawn[1]
    assert module("plan.plan_states").state(line.plan_object()).colliding
    yield from screen.picture("feel-2-collides", vary=["SIDEBAR"])
    yield from pressed(12, 0.9, 2, 2)
    yield lambda: "collides" not in drawn[1]
    yield from led(12, -0.3)
    yield from pressed(12, -0.3, 1, 3)
    at = line.indices()[1]
    assert np.abs(line.paths()[0].keys[at] - tool()).max() < 0.05
    assert "collides" not in drawn[1] and not module("plan.plan_states").state(line.plan_object()).colliding
    yield from led(-8, -0.3)
    yield from pressed(-8, -0.3, 1, 4)
    mine = session()
    screen.key("Z", ctrl=True)
    yield lambda: line.settled() and len(line.indices()) == 3
    assert session() is mine
    yield lambda: len(mine.run.session.keys) == 3
    screen.key("Z", ctrl=True, shift=True)
    yield lambda: line.settled() and len(line.indices()) == 4
    yield from pressed(-8, -0.3, 2, 3)
    assert line.indices() == [0, at, 144]
    lead(-8, -0.3, 2)
    yield lambda: "no key here" in session().problem
    lead(-8, -0.3)
    yield 0.5
    assert "no key here" in state().why


def unplugged(screen):
    """The force ends, the panel names why, nothing of the plan changes, no press counts; plugged in, it continues."""
    yield from led(12, 0.9)
    run = session().run
    yield lambda: run.torque > 100
    keys, stood = line.indices(), tool().copy()
    run.device.unplug()
    yield lambda: run.torque == 0 and run.force == 0
    yield lambda: "the simulated pen is unplugged; plug it in again" in state().why
    lead(12, 0.9, 1)
    yield 1.0
    assert line.indices() == keys and np.abs(tool() - stood).max() < 0.05 and session() is not None
    yield from screen.picture("feel-3-unplugged")
    lead(12, 0.9)
    run.device.plug()
    yield lambda: run.state == "active"
    assert run.torque < 100 and np.abs(tool() - stood).max() < 0.05, "the tool or the hand jumped"
    yield from led(12, 1.3)  # the hand takes the tool up where it is
    yield lambda: run.torque > 100
    assert line.indices() == keys and state().why == "", state().why
    screen.key("ESC")
    yield lambda: session() is None
    yield 0.5
    assert line.indices() == keys and module("plan.current_pose").held is None
    assert any("keys set" in text and "2 keys deleted" in text for text in lessons.messages(screen))


def deleted(screen):
    """The plan is deleted while the hand turns its tool: the session ends with a sentence. Ctrl Z restores the plan."""
    bpy.ops.ed.undo_push(message="Session")
    yield from begun(screen, "riffler.plan_pen")
    status = []
    say = module("pen.operators").say
    module("pen.operators").say = lambda text: status.append(text) or say(text)
    bpy.data.objects.remove(line.plan_object())
    bpy.ops.ed.undo_push(message="Delete")
    yield lambda: session() is None
    module("pen.operators").say = say
    assert status[-1].endswith("its path was deleted or found again"), status
    assert not state().sculpting and module("plan.current_pose").held is None
    screen.key("Z", ctrl=True)
    yield lambda: any(module("plan.plan_store").is_plan(ob) for ob in bpy.data.objects)
    yield line.settled


def by_mouse(screen):
    """The mouse drags the tool's end, with Ctrl it goes along the path; a click sets a key, a right-click deletes."""
    bpy.context.scene.riffler.plan.device = "pointer"
    bpy.context.scene.frame_set(73)
    lessons.activate(line.plan_object())
    yield gizmo.quiet
    keys = line.indices()
    yield from begun(screen, "riffler.plan_pen")
    assert not session().run.pushes
    at = gizmo.spot().centre
    turning, sight = module("plan.current_pose"), gizmo.view(screen)
    reach = turning.reach(bpy.context, sight, at)
    before, goal = session().hand.axis.copy(), leaning(-0.6)
    held = np.subtract(screen.at, gizmo.pixel(screen, at + reach * before))  # the mouse is anywhere in the view
    for share in np.linspace(0, 1, 12):
        axis = before + share * (goal - before)
        screen.move(*gizmo.pixel(screen, at + reach * axis / np.linalg.norm(axis)) + held)
        yield 0.05
    yield lambda: np.abs(tool() - goal).max() < 0.05
    screen.button("PRESS")
    screen.button("RELEASE")
    yield lambda: line.settled() and len(line.indices()) == len(keys) + 1
    assert np.abs(line.paths()[0].keys[72] - goal).max() < 0.05
    yield from screen.picture("feel-4-mouse")
    screen.button("PRESS", "RIGHTMOUSE")
    screen.button("RELEASE", "RIGHTMOUSE")
    yield lambda: line.settled() and line.indices() == keys
    held = tool().copy()
    for k in np.linspace(72, 108, 12).astype(int):
        lessons.event(screen, "MOUSEMOVE", "NOTHING", contact(screen, k), ctrl=True)
        yield 0.05
    yield lambda: abs(session().run.point - 108) <= 1
    assert np.abs(tool() - held).max() < 0.02
    screen.key("ESC")
    yield lambda: session() is None
    yield 0.5
    assert line.indices() == keys
    screen.button("PRESS", "RIGHTMOUSE")  # Blender's again
    screen.button("RELEASE", "RIGHTMOUSE")
    yield 0.5
    screen.key("ESC")


def by_tablet(screen):
    """Blender simulates no tablet: the session gets events as of one."""
    yield from begun(screen, "riffler.plan_pen")
    region = screen.region()
    back = np.array(gizmo.view(screen).basis().back)
    for tilt in ((0.3, 0.0), (0.0, 0.0), (0.0, 0.2)):  # upright after it has leant: still a pen
        at = contact(screen, 60)
        event = SimpleNamespace(mouse_x=at[0], mouse_y=at[1], is_tablet=True, tilt=tilt, ctrl=False)
        session().move(bpy.context, region, event)
        yield lambda: abs(session().run.point - 60) <= 1
        leans = np.degrees(np.arccos(np.clip(session().hand.axis @ back, -1, 1)))
        assert abs(leans - 90 * np.hypot(*tilt)) < 0.1, (tilt, leans)
    assert "Touch" in session().help
    screen.key("ESC")
    yield lambda: session() is None
