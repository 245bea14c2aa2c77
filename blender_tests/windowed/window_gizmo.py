"""A user turns the plan's tool in the view: the Orient tool is chosen, a dial is dragged, Ctrl Z, typed degrees, Esc,
the tool's end is dragged, the map is clicked, a path is clicked, and Ctrl-clicked."""

import math
from pathlib import Path

import bpy
import numpy as np
from mathutils import Vector

from support import common, harness, plans

HERE = Path(__file__)
line = harness.load(HERE.with_name("window_timeline.py"))


def module(name):
    return common.part(name)


def spot():
    return module("plan.current_pose").spot(bpy.context.scene, line.plan_object())


def axis():
    return spot().axis


def view(screen):
    region = screen.region()
    matrix = np.array(screen.area.spaces.active.region_3d.perspective_matrix)
    return module("sculpt.pure.view_rays").ViewRays(
        matrix, (region.width, region.height)
    )  # a unit is a millimetre here


def pixel(screen, place):
    region = screen.region()
    return (view(screen).project([place])[0] + (region.x, region.y)).round().astype(int)


def lean():
    return np.degrees(spot().line.lean(spot().index, axis()))


def press(screen, at, value, kind="LEFTMOUSE", **modifiers):
    screen.window.event_simulate(kind, value, x=int(at[0]), y=int(at[1]), **modifiers)


def drag(screen, way, release=True):
    """Along pixels, slowly enough that the handle under the pointer is found."""
    found = screen.pixels.gizmos
    screen.pixels.find_gizmos()
    screen.move(*map(int, way[0] + (3, 3)))
    yield 0.3
    screen.move(*map(int, way[0]))
    yield 0.6
    press(screen, way[0], "PRESS")
    yield 0.2
    screen.pixels.find_gizmos(found)
    for at in way[1:]:
        screen.move(*map(int, at))
        yield 0.15
    if release:
        press(screen, way[-1], "RELEASE")
        yield 0.5


def on_dial(screen, handle, angles, size):
    """Pixels of a dial at angles (rad) about its axis; `size`: relative to Blender's gizmo size."""
    at = spot()
    turn = module("plan.pure.tool_rotation")
    frame = at.line.frames[at.index]
    first, second, _ = module("common.glyphs").frame(turn.dial_axis(frame, math.radians(lean()[0]), handle))
    preferences = bpy.context.preferences
    pixels = size * preferences.view.gizmo_size * preferences.system.ui_scale
    radius = pixels / view(screen).pixels_per_unit(at.centre)
    return [pixel(screen, at.centre + radius * (math.cos(a) * first + math.sin(a) * second)) for a in angles]


def facing(screen, handle, size):
    """The angle of the dial's nearest place, which no other handle hides."""
    at = spot()
    _, away = view(screen).ray(400, 300)
    turn = module("plan.pure.tool_rotation")
    first, second, _ = module("common.glyphs").frame(
        turn.dial_axis(at.line.frames[at.index], math.radians(lean()[0]), handle)
    )
    return math.atan2(-(away @ second), -(away @ first))


def quiet():
    return line.settled() and not bpy.app.timers.is_registered(module("plan.orientation_probe")._look)


def steps(screen):
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    with screen.override():
        bpy.ops.riffler.millimetres()
    part = plans.part_object()
    plans.on_timeline(chosen=plans.paths()[:1])
    bpy.context.scene.riffler.plan.part = part
    bpy.context.scene.frame_set(73)
    line.look_at_the_part(screen)
    # Neither dial is seen edge-on.
    line.area(screen, "VIEW_3D").spaces.active.region_3d.view_rotation = Vector((0.7, 0.8, 1)).to_track_quat("Z", "Y")
    with screen.override():
        assert bpy.ops.wm.tool_set_by_id(name="riffler.plan") == {"FINISHED"}
    bpy.ops.ed.undo_push(message="Timeline")
    screen.pixels.find_gizmos()
    screen.to_view()
    yield 1.0
    yield quiet
    yield 0.5
    yield from screen.picture("orient-01-map")
    yield from dial(screen)
    yield from numbers(screen)
    yield from escape(screen)
    yield from hold_still(screen)
    yield from end(screen)
    yield from click_the_map(screen)
    yield from click_a_path(screen)


def dial(screen):
    """40° along the dial of the inclination are 40° of it; one Ctrl Z undoes them."""
    turn = module("plan.pure.tool_rotation")
    before = lean()
    begin = facing(screen, turn.INCLINATION, 1.0)
    way = on_dial(screen, turn.INCLINATION, begin + np.radians(np.linspace(0, 40, 3)), 1.0)
    yield from drag(screen, way, release=False)
    assert module("plan.current_pose").held is not None, "the dial was not taken"
    assert line.indices() == [0, 144], "a key before the button was let go"
    yield from screen.picture("orient-02-turning")
    press(screen, way[-1], "RELEASE")
    yield lambda: line.indices() == [0, 72, 144]
    yield quiet
    turned = lean() - before
    assert abs(turned[0] - 40) < 1 and abs(turned[1]) < 1e-3, turned
    assert module("plan.current_pose").held is None and not len(module("sculpt.force_view")._in_views)
    yield 0.5
    tip, shown = line.shown()[0] - 3 * line.shown()[1], line.shown()[1]
    assert np.abs(shown - axis()).max() < 1e-4 and np.abs(tip + 3 * shown - spot().centre).max() < 1e-3
    yield from screen.picture("orient-03-turned")
    yield from line.press(screen, "VIEW_3D", "Z", ctrl=True)
    yield lambda: line.settled() and line.indices() == [0, 144]
    assert np.abs(lean() - before).max() < 1e-3


def numbers(screen):
    """-20 and Enter, on the dial of the tilt."""
    turn = module("plan.pure.tool_rotation")
    before = lean()
    begin = facing(screen, turn.TILT, 0.85)
    way = on_dial(screen, turn.TILT, begin + np.radians([0, 3]), 0.85)
    yield from drag(screen, way, release=False)
    assert module("plan.current_pose").held is not None, "the dial was not taken"
    yield from line.number(screen, "VIEW_3D", "-20")
    yield lambda: line.indices() == [0, 72, 144]
    press(screen, way[-1], "RELEASE")
    assert np.abs(lean() - before - (0, -20)).max() < 1e-3, (lean(), before)
    yield quiet


def escape(screen):
    turn = module("plan.pure.tool_rotation")
    before, shown = axis(), line.shown()
    begin = facing(screen, turn.INCLINATION, 1.0)
    way = on_dial(screen, turn.INCLINATION, begin + np.radians(np.linspace(0, -30, 3)), 1.0)
    yield from drag(screen, way, release=False)
    assert np.abs(line.shown()[1] - before).max() > 0.1, "the tool does not follow"
    assert np.abs(line.shown()[0] - spot().centre).max() < 1e-3, "the ball left its point"
    press(screen, way[-1], "PRESS", "ESC")
    yield 0.5
    press(screen, way[-1], "RELEASE")
    yield 0.5
    assert np.array_equal(axis(), before) and np.abs(np.subtract(line.shown(), shown)).max() < 1e-5


def hold_still(screen):
    """A click on a dial turns nothing, and is not an undo step."""
    before, turn = line.key_frames(), module("plan.pure.tool_rotation")
    (at,) = on_dial(screen, turn.INCLINATION, [facing(screen, turn.INCLINATION, 1.0)], 1.0)
    yield from line.press(screen, "VIEW_3D", "Z", ctrl=True)  # the typed key
    yield lambda: line.settled() and line.indices() == [0, 144]
    yield from drag(screen, [at, at])
    yield 0.5
    assert line.indices() == [0, 144] and len(before) == 3 and module("plan.current_pose").held is None


def end(screen):
    """The tool's end follows the pointer: here straight up over the point."""
    at = spot()
    turning = module("plan.current_pose")
    reach = turning.reach(bpy.context, view(screen), at.centre)
    goal = np.array([0.0, -0.3, 1.0]) / np.linalg.norm((0, -0.3, 1))
    way = [pixel(screen, at.centre + reach * at.axis), pixel(screen, at.centre + reach * goal)]
    way = [way[0] + share * (way[1] - way[0]) for share in np.linspace(0, 1, 3)]
    yield from drag(screen, way)
    yield quiet
    assert np.degrees(math.acos(min(1.0, axis() @ goal))) < 1.5, (axis(), goal)


def click_the_map(screen):
    """A cell that collides, and one that is free: the key has exactly its angles, and the map stays."""
    looking, drawn = module("plan.orientation_probe"), module("plan.orientation_map_view")
    maps = looking.maps
    found = looking._known.map
    assert found is not None and found.index == 72
    free = np.argwhere(found.free)
    blocked = np.argwhere(~found.free)
    for cell, picture in ((blocked[len(blocked) // 3], "orient-04-blocked"), (free[len(free) // 2], "orient-05-free")):
        with screen.override():
            grid = drawn.grid_of(found, bpy.context.preferences.system.ui_scale)
            x, y = drawn.corner(bpy.context, grid)
        at = grid.place(*grid.angles_of(*cell))
        region = screen.region()
        screen.click(region.x + x + at[0], region.y + y + at[1])
        wanted = found.axes[tuple(cell)]
        yield lambda wanted=wanted: np.abs(axis() - wanted).max() < 1e-9
        yield quiet
        yield 0.5
        assert looking._known.free == bool(found.free[tuple(cell)])
        yield from screen.picture(picture)
    assert looking.maps == maps


def click_a_path(screen):
    """From in front of the wall, since what it hides cannot be clicked."""
    line.area(screen, "VIEW_3D").spaces.active.region_3d.view_rotation = Vector((0.4, -0.8, 1)).to_track_quat("Z", "Y")
    yield 0.5
    at = spot()
    place = at.line.contacts[8, 0]  # no handle is over it
    seen = module("plan.path_view").kept
    seen.clear()
    screen.move(*map(int, pixel(screen, place)))
    yield lambda: "line 0" in seen._kept  # the ring around the contact under the pointer was drawn
    yield 0.5
    yield from screen.picture("orient-06-pointed-at")
    screen.click(*map(int, pixel(screen, place)))
    yield lambda: abs(bpy.context.scene.frame_current_final - 9) <= 1
    yield quiet
    yield 0.5
    keys = line.indices()
    at = pixel(screen, spot().line.contacts[110, 1])
    screen.move(*map(int, at))
    yield 0.3
    press(screen, at, "PRESS", ctrl=True)
    press(screen, at, "RELEASE", ctrl=True)
    yield lambda: len(line.indices()) == len(keys) + 1
    yield quiet
    new = next(k for k in line.indices() if k not in keys)
    assert abs(new - 110) <= 1
    assert np.abs(line.paths()[0].keys[new] - np.array((0, -1, 1)) / math.sqrt(2)).max() < 1e-9
    yield 0.5
    yield from screen.picture("orient-07-free-key")
