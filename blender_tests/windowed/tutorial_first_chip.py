"""docs/first-chip.md: a block, the first chip and Ctrl Z; then an owl from an egg, and its STL."""

from pathlib import Path

import bpy
import harness
import numpy as np

import support

lessons = harness.load(Path(__file__).with_name("lessons.py"))
HALF = (20.0, 20.0, 27.0)  # of the egg, mm


def steps(screen):
    yield from lessons.begin(screen)
    yield from lessons.picture(screen, "first-chip-1", lessons.view_box(screen))
    yield from first_chip(screen)
    yield from egg(screen)
    yield from owl(screen)
    yield from exported(screen)


def first_chip(screen):
    """New Stock, Carve, a drag."""
    yield from lessons.press(screen, "riffler.new_stock")
    block = bpy.data.objects["Stock"]
    screen.area.spaces.active.region_3d.view_distance *= 1.25  # the wheel
    yield from lessons.tool(screen, "riffler.carve")
    whole = lessons.volume(block).volume
    assert whole == 100 * 60 * 30
    y, depth, ball = 30.0, bpy.context.scene.riffler.sculpt.depth, 3.0
    yield from lessons.brushed(screen, block, [(20, y, 30), (80, y, 30)], hold="first-chip-2", steps=12)
    # a groove of 60 mm with half a cap of the ball at either end; a pixel is 0.2 mm or so
    half = np.arccos((ball - depth) / ball)
    chip = 60 * ball**2 * (half - np.sin(half) * np.cos(half)) + np.pi * depth**2 * (3 * ball - depth) / 3
    removed = whole - lessons.volume(block).volume
    assert abs(removed / chip - 1) < 0.05, (removed, chip)
    screen.to_view()
    screen.key("Z", ctrl=True)
    yield lambda: lessons.volume(bpy.data.objects["Stock"]).volume == whole
    screen.key("Z", ctrl=True, shift=True)
    yield lambda: lessons.volume(bpy.data.objects["Stock"]).volume < whole
    assert np.isclose(whole - lessons.volume(bpy.data.objects["Stock"]).volume, removed)


def egg(screen):
    """A sphere, stretched, is the material."""
    yield from lessons.tool(screen, "builtin.select_box")  # from a tool of Riffler nothing is selected
    yield lambda: bpy.data.objects["Stock"].select_get()
    screen.to_view()
    screen.key("DEL")
    yield lambda: "Stock" not in bpy.data.objects
    with screen.override():
        bpy.ops.mesh.primitive_uv_sphere_add("INVOKE_DEFAULT", True, segments=96, ring_count=48, radius=20)
        bpy.ops.transform.resize("EXEC_DEFAULT", True, value=(1, 1, 1.35))
        bpy.ops.view3d.view_axis(type="FRONT")
        bpy.ops.view3d.view_selected()
    stock = bpy.context.scene.riffler.stock
    stock.source, stock.pitch = "OBJECT", 0.4
    yield 0.5
    yield from lessons.picture(screen, "first-chip-3", lessons.view_box(screen))
    yield from lessons.press(screen, "riffler.new_stock")
    yield lambda: "Sphere Stock" in bpy.data.objects
    made = bpy.context.object
    assert made.name == "Sphere Stock" and bpy.data.objects["Sphere"].hide_get()
    exact = 4 / 3 * np.pi * np.prod(HALF)
    assert abs(lessons.volume(made).volume / exact - 1) < 0.005
    view = screen.area.spaces.active.region_3d
    view.view_distance *= 1.3
    view.view_location.x += 7  # the size's handles stand beside the egg
    yield 0.5


def front(x, z):
    """A place on the egg's front."""
    return (x, -HALF[1] * np.sqrt(max(0.0, 1 - (x / HALF[0]) ** 2 - (z / HALF[2]) ** 2)), z)


def arc(*corners):
    return [front(x, z) for x, z in corners]


def settings(radius, depth):
    scene = bpy.context.scene.riffler
    scene.tool.kind, scene.sculpt.radius, scene.sculpt.depth = "ball", radius, depth


def owl(screen):
    ob = bpy.context.object
    yield from lessons.tool(screen, "riffler.carve")
    bpy.context.scene.riffler.sculpt.mirror = {"X"}
    settings(6.5, 2.5)
    yield from lessons.brushed(screen, ob, arc((7, 11), (7.4, 11.4)), hold="first-chip-4")
    settings(3.0, 2.0)
    yield from lessons.brushed(screen, ob, arc((7, 11), (7.1, 11.1)), ctrl=True)
    settings(1.2, 0.9)
    yield from lessons.brushed(screen, ob, arc((2.4, 8), (1.6, 4), (0.2, 0.5)))
    settings(1.6, 1.2)
    yield from lessons.brushed(screen, ob, arc((9.5, 2), (14, -3), (14.5, -10), (11.5, -17), (8.5, -20)), steps=3)
    settings(1.2, 0.8)
    for z in (-6, -12):
        for x in (1.5, 4.5, 7.5):
            yield from lessons.brushed(screen, ob, arc((x - 1.3, z), (x, z - 1.6), (x + 1.3, z)), steps=2)
    settings(2.5, 1.8)
    yield from lessons.brushed(screen, ob, arc((9, 20), (11, 22)), ctrl=True)
    screen.to_view()
    yield from lessons.picture(screen, "first-chip-5", lessons.view_box(screen))


def exported(screen):
    ob = bpy.context.object
    path = Path(support.out("owl.stl"))
    path.unlink(missing_ok=True)
    screen.click(46, screen.window.height - 13)
    yield 0.6
    screen.move(80, screen.window.height - 318)
    yield 0.8
    screen.move(307, screen.window.height - 318)
    yield 0.3
    screen.move(307, screen.window.height - 525)
    yield from lessons.picture(screen, "first-chip-6")
    for _ in range(3):
        screen.key("ESC")
        yield 0.2
    with screen.override():
        assert bpy.ops.riffler.export_stl(filepath=str(path)) == {"FINISHED"}
    surface = lessons.closed(path, lessons.volume(ob).volume, within=2e-3)
    # Grooves and caps as on a plane: 222 + 25 + 138 + 63 mm³ of sockets, beak, wings and feathers are taken away,
    # 59 + 74 of eyes and ears put on; the strokes' round ends come on top.
    removed = 4 / 3 * np.pi * np.prod(HALF) - surface.volume
    assert 250 < removed < 500, removed
    yield 0.2
