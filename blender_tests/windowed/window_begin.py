"""The first minute: the default cube is there, Carve is chosen, the mouse is dragged over it. The cube stays, Riffler
asks, Return is pressed, and the drag is a stroke; Ctrl Z takes back first the stroke, then the sculpt. A drag off
everything says what to do; a drag over another sculpt strokes that one."""

import itertools
import time
from pathlib import Path

import bpy
import harness
import numpy as np

import support

stroke = harness.load(Path(__file__).with_name("window_stroke.py"))


def cube():
    return bpy.data.objects["Cube"]


def pixel(screen, place):
    """In the window, of a place in the world."""
    region = screen.region()
    matrix = np.array(screen.area.spaces.active.region_3d.perspective_matrix)
    sight = support.part("core.sight").Sight(matrix, (region.width, region.height))
    return (sight.project([place])[0] + (region.x, region.y)).round().astype(int)


def drag(screen, *places):
    way = [pixel(screen, p) for p in places]
    screen.move(*map(int, way[0]))
    yield 0.3
    stroke.press(screen, *way[0], "PRESS")
    yield 0.1
    for a, b in itertools.pairwise(way):
        for share in np.linspace(0, 1, 8)[1:]:
            screen.move(*map(int, a + share * (b - a)))
            yield 0.02
    stroke.press(screen, *way[-1], "RELEASE")
    yield 0.5


def answered(screen, key="RET"):
    x, y = screen.at
    for value in ("PRESS", "RELEASE"):
        screen.window.event_simulate(key, value, x=x, y=y)
    yield 0.3


def steps(screen):
    view = screen.area.spaces.active.region_3d
    view.view_distance *= 0.45
    place = cube().matrix_world.copy()
    stroke.tool(screen, "riffler.carve")
    yield 1.0
    yield from drag(screen, (-0.6, -0.4, 1), (0.6, 0.3, 1))
    yield 0.5
    assert cube().matrix_world == place and "Cube Stock" not in bpy.data.objects
    yield from screen.picture("begin-1-asked")

    # somebody who does not want to: nothing has happened
    yield from answered(screen, "ESC")
    yield 0.5
    assert "Cube Stock" not in bpy.data.objects and bpy.context.scene.unit_settings.scale_length == 1

    yield from drag(screen, (-0.6, -0.4, 1), (0.6, 0.3, 1))
    yield 0.5
    begin = time.perf_counter()
    yield from answered(screen)
    yield lambda: "Cube Stock" in bpy.data.objects and volume() < 1e6
    support.figure("click to first chip, default cube, s", round(time.perf_counter() - begin, 2))
    assert cube().matrix_world == place and cube().hide_get()
    yield 1.0
    carved = volume()
    screen.move(*map(int, pixel(screen, (0, -0.3, 1))))
    yield 0.7
    yield from screen.picture("begin-2-chip")

    # the next one is a stroke like any other
    yield from drag(screen, (-0.6, 0.2, 1), (0.5, -0.5, 1))
    yield lambda: volume() < carved and support.part("drawing.pointer").held is None
    screen.to_view()
    for expected in (carved, 1e6):
        screen.key("Z", ctrl=True)
        yield 1.5
        assert volume() == expected
    screen.key("Z", ctrl=True)
    yield 1.5
    assert "Cube Stock" not in bpy.data.objects and not cube().hide_get() and cube().matrix_world == place
    assert bpy.context.scene.unit_settings.scale_length == 1
    yield from off_everything(screen, place)
    yield from over_another_sculpt(screen)


def volume():
    return support.part("bl.live").content(bpy.data.objects["Cube Stock"]).volume.volume


def off_everything(screen, place):
    """Nothing is under the pointer, and what is active has no surface."""
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
    yield from screen.picture("begin-3-nothing")


def over_another_sculpt(screen):
    """It becomes the active one, and the stroke is made at once."""
    with screen.override():
        assert bpy.ops.riffler.make_sculpt("EXEC_DEFAULT", True, object="Cube") == {"FINISHED"}
    bpy.context.view_layer.objects.active = bpy.data.objects["Light"]
    whole = volume()
    yield 0.5
    yield from drag(screen, (-0.6, -0.4, 1), (0.6, 0.3, 1))
    yield lambda: volume() < whole and support.part("drawing.pointer").held is None
    assert bpy.context.object.name == "Cube Stock"
    support.part("bl.live").end_all()
    yield 0.5
