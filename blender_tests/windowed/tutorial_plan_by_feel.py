"""docs/plan-by-feel.md: on the path of the pencil cut the mouse turns the tool, sets keys and deletes one; the
simulated pen feels the clamp; resolved."""

from pathlib import Path

import bpy
import numpy as np

from support import harness

pencil = harness.load(Path(__file__).with_name("tutorial_pencil_cut.py"))
PIXELS = False
lessons, gizmo, line = pencil.lessons, pencil.gizmo, pencil.line
FAR, CLAMP = 0.8, 0.13  # places of the keys, shares of the path
# Inclination and tilt, degrees: clear of the clamp on the whole path, one that meets it further along, and one into it.
CLEAR, SHORT, INTO = (0.0, 37.5), (-30.0, 22.5), (0.0, 0.0)


def steps(screen):
    yield from lessons.begin(screen)
    yield from pencil.higher_timeline(screen, 45)
    part = pencil.made_part(screen)
    clamp = pencil.cube(screen, "Clamp", (8, 4, 20), (10, 10, 24))
    with screen.override():
        bpy.ops.view3d.view_all()
    pencil.look(screen, (0.8, -0.5, 1.0), (30, 2, 27))
    screen.area.spaces.active.region_3d.view_distance = 165
    yield from lessons.cut.open_tab(screen, "RIFFLER_PT_plan")
    yield from pencil.set_up(screen, part, clamp, "")
    ob = yield from pencil.searched(screen, "")
    yield from begun(screen, ob)
    yield from turned(screen)
    yield from corrected(screen)
    yield from with_pen(screen)
    yield from resolved(screen, ob)


def session():
    return gizmo.module("pen.session").running


def said():
    return gizmo.module("plan.current_pose").said or ("", True)


def path():
    return line.paths()[0]


def point(share):
    return round(share * (len(path()) - 1))


def begun(screen, ob):
    """The plan on the timeline, and the session of the mouse."""
    bpy.context.scene.riffler.plan.feed = 600
    yield from lessons.press(screen, "riffler.plan_to_timeline")
    yield lambda: gizmo.module("plan.timeline").pair(ob) is not None
    lessons.activate(bpy.data.objects["Riffler Tool"])
    (track,) = gizmo.module("plan.replan").layout_of(ob, gizmo.module("plan.plan_store").plan(ob)).tracks
    bpy.context.scene.frame_set(round(track.frame_of(point(FAR))))
    bpy.context.scene.riffler.plan.device = "pointer"
    yield from lessons.press(screen, "riffler.plan_pen")
    yield lambda: session() is not None
    screen.to_view()
    yield lambda: session().run.pose is not None


def slid(screen, share):
    """With Ctrl held, the mouse goes along the path to a share of it."""
    for k in np.linspace(session().run.point, point(share), 12).round().astype(int):
        at = gizmo.pixel(screen, path().contacts[k, pencil.lower(path())])
        lessons.event(screen, "MOUSEMOVE", "NOTHING", at, ctrl=True)
        screen.at = tuple(map(int, at))
        yield 0.05
    yield lambda: abs(session().run.point - point(share)) <= 1
    yield 0.5


def leant(screen, angles):
    """The mouse drags the tool's end to an inclination and a tilt."""
    index = session().run.point
    centre, hand = path().centres[index], session().hand
    reach = gizmo.module("plan.current_pose").reach(bpy.context, gizmo.view(screen), centre)
    begin, goal = hand.axis.copy(), np.array(path().axis(index, *np.radians(angles)))
    held = np.subtract(screen.at, gizmo.pixel(screen, centre + reach * begin))  # the mouse is anywhere in the view
    for share in np.linspace(0, 1, 12):
        axis = begin + share * (goal - begin)
        screen.move(*gizmo.pixel(screen, centre + reach * axis / np.linalg.norm(axis)) + held)
        yield 0.05
    yield 1.0
    off = np.degrees(np.arccos(np.clip(hand.axis @ goal, -1, 1)))
    assert off < 3, (off, angles, gizmo.lean())


def clicked(screen, count, button="LEFTMOUSE"):
    screen.button("PRESS", button)
    screen.button("RELEASE", button)
    yield lambda: line.settled() and len(line.indices()) == count
    yield gizmo.quiet


def view_picture(screen, name):
    yield 0.5
    yield from lessons.picture(screen, name, (0, 0, *lessons.view_box(screen)[2:]))


def turned(screen):
    """A key near the far end, the clamp that stops the tool, and a key from which the tool meets it further along."""
    yield from leant(screen, CLEAR)
    assert said()[1], said()
    yield from view_picture(screen, "plan-by-feel-1")
    yield from clicked(screen, 1)
    yield from slid(screen, CLAMP)
    yield from leant(screen, INTO)
    yield lambda: "hits Clamp" in said()[0]
    yield from view_picture(screen, "plan-by-feel-2")
    yield from leant(screen, SHORT)
    yield from clicked(screen, 2)
    drawn = gizmo.module("program.line_view")._drawn
    yield lambda: "collides" in drawn[1]
    yield from view_picture(screen, "plan-by-feel-3")


def corrected(screen):
    """The key is deleted and set again, clear of the clamp; Ctrl Z and Ctrl Shift Z."""
    drawn = gizmo.module("program.line_view")._drawn
    yield from clicked(screen, 1, "RIGHTMOUSE")
    yield from leant(screen, CLEAR)
    yield from clicked(screen, 2)
    yield lambda: "collides" not in drawn[1]
    keys = line.indices()
    screen.key("Z", ctrl=True)
    yield lambda: line.settled() and len(line.indices()) == 1
    screen.key("Z", ctrl=True, shift=True)
    yield lambda: line.settled() and line.indices() == keys
    screen.key("ESC")
    yield lambda: session() is None
    yield gizmo.quiet


def with_pen(screen):
    """The simulated pen leans the tool into the clamp, which pushes its hand back."""
    bpy.context.scene.riffler.plan.device = "simulated"
    bpy.context.scene.riffler.plan.slide = False
    bpy.context.scene.frame_set(round(line.key_frames()[0]))
    keys = line.indices()
    yield from lessons.press(screen, "riffler.plan_pen")
    yield lambda: session() is not None
    run = session().run
    yield lambda: run.device.state().homed
    home = run.device.state().pose
    run.device.aim(home)
    yield lambda: run.pose is not None
    yield 1.0
    screen.to_view()
    index = run.point
    turn = np.cross(run.pose[3:], path().axis(index, *np.radians(INTO)))  # of the tool, and so of the hand
    for share in np.linspace(0, 1.3, 9):
        axis = home[3:] + share * np.cross(turn, home[3:])
        run.device.aim([*home[:3], *axis / np.linalg.norm(axis)])
        yield 0.2
    yield lambda: run.torque > 100 and "hits Clamp" in said()[0]
    look, session().look = session().look, lambda: True  # the picture is of this moment
    yield from view_picture(screen, "plan-by-feel-4")
    session().look = look
    screen.key("ESC")
    yield lambda: session() is None
    assert line.indices() == keys


def resolved(screen, ob):
    """Nothing is lifted."""
    yield from pencil.by_resolve(screen, ob)
    kinds = [f.kind for f in ob.riffler.plan.findings]
    assert "lifted" not in kinds and "blocked" not in kinds, [f.name for f in ob.riffler.plan.findings]
