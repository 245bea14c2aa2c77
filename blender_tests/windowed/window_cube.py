"""The first minute (docs/first-chip.md, "The cube"): Blender's cube is there, Carve is chosen, and the mouse is dragged
over it. The cube stays, Riffler asks, Return is pressed, and the drag is a stroke; Ctrl Z undoes first the stroke, then
the sculpt. A drag off everything shows what to do, a drag over another sculpt strokes that one. At the end the cube is
a small figure, by the mouse and keys alone."""

import time
from pathlib import Path

import bpy
import numpy as np
from mathutils import Euler

from support import common, harness

stroke = harness.load(Path(__file__).with_name("window_stroke.py"))
lessons = harness.load(Path(__file__).with_name("lessons.py"))
PIXELS = False
UNIT = 50.0  # mm in a unit of the scene, once the cube is a sculpt of 100 mm


def cube():
    return bpy.data.objects["Cube"]


def drag(screen, *places):
    """Through places in the world, by the left button."""
    yield from lessons.brushed(screen, cube(), places, steps=7, together=4)
    yield 0.4


def answered(screen, key="RET"):
    for value in ("PRESS", "RELEASE"):
        lessons.event(screen, key, value, screen.at)
    yield 0.3


def steps(screen):
    lessons.plain_window()
    view = screen.area.spaces.active.region_3d
    view.view_distance *= 0.45
    place = cube().matrix_world.copy()
    stroke.tool(screen, "riffler.carve")
    yield 1.0
    yield from drag(screen, (-0.6, -0.4, 1), (0.6, 0.3, 1))
    yield 0.5
    assert cube().matrix_world == place and "Cube Stock" not in bpy.data.objects
    yield from lessons.picture(screen, "cube-1", lessons.view_box(screen))

    # the user declines: nothing has happened
    yield from answered(screen, "ESC")
    yield 0.5
    assert "Cube Stock" not in bpy.data.objects and bpy.context.scene.unit_settings.scale_length == 1

    yield from drag(screen, (-0.6, -0.4, 1), (0.6, 0.3, 1))
    yield 0.5
    begin = time.perf_counter()
    yield from answered(screen)
    yield lambda: "Cube Stock" in bpy.data.objects and volume() < 1e6
    common.figure("click to first chip, default cube, s", round(time.perf_counter() - begin, 2))
    assert cube().matrix_world == place and cube().hide_get()
    yield 1.0
    carved = volume()
    screen.move(*map(int, lessons.pixel(screen, cube(), (0, -0.3, 1))))
    yield 0.7
    yield from lessons.picture(screen, "cube-2", lessons.view_box(screen))

    # the next one is a stroke like any other
    yield from drag(screen, (-0.6, 0.2, 1), (0.5, -0.5, 1))
    yield lambda: volume() < carved and common.part("sculpt.pointer").held is None
    yield from sized(screen, 7, 3)
    screen.to_view()
    for expected in (carved, 1e6):  # no undo step of the sizes, which stay
        screen.key("Z", ctrl=True)
        yield 1.5
        assert volume() == expected
        brush = bpy.context.scene.riffler.sculpt
        assert np.allclose((brush.radius, brush.depth), (7, 3)), (brush.radius, brush.depth)
    screen.key("Z", ctrl=True)
    yield 1.5
    assert "Cube Stock" not in bpy.data.objects and not cube().hide_get() and cube().matrix_world == place
    assert bpy.context.scene.unit_settings.scale_length == 1
    yield from off_everything(screen, place)
    yield from from_the_menu(screen)
    yield from over_another_sculpt(screen)
    yield from bear(screen)


def volume():
    return common.part("sculpt.live_registry").content(bpy.data.objects["Cube Stock"]).volume.volume


def off_everything(screen, place):
    """Nothing is under the pointer, and the active object has no surface."""
    bpy.context.view_layer.objects.active = bpy.data.objects["Light"]
    region = screen.region()
    screen.move(region.x + 150, region.y + 100)
    yield 0.3
    screen.button("PRESS")
    yield 0.1
    screen.move(region.x + 250, region.y + 140)
    yield 0.1
    screen.button("RELEASE")
    yield 1.0
    assert cube().matrix_world == place and len(bpy.data.objects) == 3
    yield from answered(screen, "ESC")


def from_the_menu(screen):
    """Shift A, Mesh, Riffler, Sphere, by the arrow keys: a sculpt without facets, which one Ctrl Z takes away."""
    screen.to_view()
    yield 0.3
    screen.key("A", shift=True)
    yield 0.5
    for key in MENU:
        yield from answered(screen, key)
    yield from screen.shot("menu")
    yield from answered(screen)
    yield lambda: "Sphere" in bpy.data.objects
    ball = bpy.context.object
    content, mm = common.content(ball), ball.data.riffler.mm_per_unit  # the radius is a unit
    off = np.linalg.norm(common.coordinates(ball.data).astype(float) * mm, axis=1) - mm
    assert ball.name == "Sphere" and np.abs(off).max() < 0.01 * content.volume.pitch, np.abs(off).max()
    assert abs(content.volume.volume / (4 / 3 * np.pi * mm**3) - 1) < 1e-4
    screen.to_view()
    screen.key("Z", ctrl=True)
    yield lambda: "Sphere" not in bpy.data.objects
    assert bpy.context.scene.unit_settings.scale_length == 1


MENU = ("RIGHT_ARROW", "UP_ARROW", "RIGHT_ARROW", "DOWN_ARROW")
if bpy.app.version >= (4, 1):  # from here on the menu begins with Search, and with nothing chosen
    MENU = ("DOWN_ARROW", *MENU)


def over_another_sculpt(screen):
    """It becomes the active one, and the stroke is made at once."""
    with screen.override():
        assert bpy.ops.riffler.make_sculpt("EXEC_DEFAULT", True, object="Cube") == {"FINISHED"}
    bpy.context.view_layer.objects.active = bpy.data.objects["Light"]
    whole = volume()
    yield 0.5
    yield from drag(screen, (-0.6, -0.4, 1), (0.6, 0.3, 1))
    yield lambda: volume() < whole and common.part("sculpt.pointer").held is None
    assert bpy.context.object.name == "Cube Stock"
    screen.to_view()
    screen.key("Z", ctrl=True)
    yield lambda: volume() == whole


def sized(screen, radius, depth):
    """F, Shift F, digits, Return."""
    for shift, size in ((False, radius), (True, depth)):
        screen.to_view()
        for key in ("F", *f"{size:g}", "RET"):
            name = {".": "PERIOD"}.get(key, WORDS[int(key)] if key.isdigit() else key)
            for value in ("PRESS", "RELEASE"):
                lessons.event(screen, name, value, screen.at, shift=shift and key == "F")
            yield 0.05
    yield 0.2
    found = bpy.context.scene.riffler.sculpt
    assert np.allclose((found.radius, found.depth), (radius, depth)), (found.radius, found.depth)


WORDS = ("ZERO", "ONE", "TWO", "THREE", "FOUR", "FIVE", "SIX", "SEVEN", "EIGHT", "NINE")


def seen(screen, tilt, turn):
    """From a direction that a user has turned the view to: degrees down from above, and around z from the front."""
    view = screen.area.spaces.active.region_3d
    view.view_perspective = "ORTHO"
    view.view_rotation = Euler(np.radians((tilt, 0, turn))).to_quaternion()
    view.update()  # its matrix, from which places become pixels, is otherwise that of the last drawing
    yield 0.4


def carved(screen, *places, **modifiers):
    ob = bpy.data.objects["Cube Stock"]
    way = [np.array(p) / UNIT for p in places]
    yield from lessons.brushed(screen, ob, way, steps=6, together=6, **modifiers)


def bear(screen):
    """A bear's head: a flat cutter bevels the edges, a ball carves eyes, snout and mouth, all with Mirror on. Strokes
    along an edge keep 1.5 mm away from it: exactly on it, a pixel decides which face the cutter leans on."""
    view, shown, h = screen.area.spaces.active.region_3d, bpy.context.window_manager.riffler, 50.0
    whole, aside = volume(), 1.5
    shown.sculpt.mirror, shown.tool.kind = {"X"}, "flat"
    yield from sized(screen, 28, 6)
    for turn, y in ((45, -h), (135, h)):
        yield from seen(screen, 90, turn)
        yield from carved(screen, (h - aside, y, -h + 3), (h - aside, y, h - 3))
    for turn, a, b in (
        (0, (0, -h, h - aside), (h - 8, -h, h - aside)),
        (90, (h, -h, h - aside), (h, h, h - aside)),
        (180, (0, h, h - aside), (h - 8, h, h - aside)),
    ):
        yield from seen(screen, 45, turn)
        yield from carved(screen, a, b)
    yield from seen(screen, 90, 0)
    shown.tool.kind = "ball"
    yield from sized(screen, 13, 8)
    yield from carved(screen, (18, -h, 10), (18.5, -h, 10.5))  # sockets
    yield from sized(screen, 7, 6)
    yield from carved(screen, (18, -h, 10), (18.3, -h, 10.2), ctrl=True)  # eyes
    yield from sized(screen, 9, 5)
    yield from carved(screen, (7, -h, 0), (15, -h, -7), (24, -h, -16), (28, -h, -26))  # next to the snout
    yield from sized(screen, 3, 2.5)
    yield from carved(screen, (0, -h, -14), (0, -h, -22), (7, -h, -28), (15, -h, -27))  # the mouth
    yield from carved(screen, (-4, -h, -8), (4, -h, -8))  # the nose
    after = volume()
    assert 0.6 * whole < after < 0.97 * whole, (whole, after)
    body = common.part("sculpt.live_registry").content(bpy.data.objects["Cube Stock"]).volume
    places = np.random.default_rng(2).uniform(-49, 49, (4000, 3))
    inside, other = body.contains(places), body.contains(places * (-1, 1, 1))
    assert (inside != other).mean() < 5e-3, (inside != other).mean()
    yield from seen(screen, 74, 24)
    view.view_perspective, view.view_distance = "PERSP", view.view_distance * 0.75
    screen.area.spaces.active.shading.show_cavity = True
    # At rest: Cavity leaves out the borders of objects, so it draws faint lines between the chunks of a live sculpt.
    stroke.tool(screen, "builtin.select_box")
    yield lambda: not common.part("sculpt.live_sculpt").lives
    bpy.data.objects["Cube Stock"].select_set(False)
    screen.move(screen.region().x + 60, screen.area.y + screen.area.height + 40)  # off the view: no cursor, no planes
    yield 1.0
    yield from lessons.picture(screen, "cube-3", lessons.view_box(screen))
