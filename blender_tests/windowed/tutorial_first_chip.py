"""docs/first-chip.md: a block, the first chip and Ctrl Z; then an owl from an egg, and its STL."""

from pathlib import Path

import bpy
import numpy as np

from support import common, harness, report

lessons = harness.load(Path(__file__).with_name("lessons.py"))
PIXELS = False
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
    yield from lessons.brushed(screen, block, [(20, y, 30), (80, y, 30)], hold="first-chip-2", steps=12, together=4)
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
    yield from lessons.tool(screen, "builtin.select_box")  # Riffler's tools select nothing
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
    stock.source, stock.pitch = "OBJECT", 0.3
    yield 0.5
    yield from lessons.picture(screen, "first-chip-3", lessons.view_box(screen))
    yield from lessons.press(screen, "riffler.new_stock")
    yield lambda: "Sphere Stock" in bpy.data.objects
    made = bpy.context.object
    assert made.name == "Sphere Stock" and bpy.data.objects["Sphere"].hide_get()
    exact = 4 / 3 * np.pi * np.prod(HALF)
    assert abs(lessons.volume(made).volume / exact - 1) < 0.005
    view = screen.area.spaces.active.region_3d
    view.view_distance *= 1.1
    view.view_location.x += 6  # the size's handles are next to the egg
    yield 0.5


def front(x, z):
    """A place on the egg's front."""
    return (x, -HALF[1] * np.sqrt(max(0.0, 1 - (x / HALF[0]) ** 2 - (z / HALF[2]) ** 2)), z)


def curve(*corners, steps=24):
    """A smooth path over the egg's front, through (x, z): Catmull–Rom."""
    c = np.array([2 * np.subtract(corners[0], corners[1]) + corners[1], *corners])
    c = np.vstack([c, 2 * c[-1] - c[-2]])
    way = []
    for s in np.linspace(0, len(corners) - 1, steps + 1):
        k = min(int(s), len(corners) - 2)
        t = s - k
        weights = np.array((-t + 2 * t**2 - t**3, 2 - 5 * t**2 + 3 * t**3, t + 4 * t**2 - 3 * t**3, t**3 - t**2)) / 2
        way.append(front(*(weights @ c[k : k + 4])))
    return way


def feather(x, z):
    """A small U."""
    return [front(x - 1.5 * np.cos(a), z - 1.9 * np.sin(a)) for a in np.linspace(0, np.pi, 21)]


def carved(screen, ob, way, radius, depth, **more):
    scene = bpy.context.scene.riffler
    scene.tool.kind, scene.sculpt.radius, scene.sculpt.depth = "ball", radius, depth
    yield from lessons.brushed(screen, ob, way, steps=1, together=24, **more)


def owl(screen):
    ob = bpy.context.object
    yield from lessons.tool(screen, "riffler.carve")
    bpy.context.scene.riffler.sculpt.mirror = {"X"}
    before = lessons.volume(ob).copy()
    yield from carved(screen, ob, curve((6.3, 9), (6.4, 9.3)), 6.5, 2.5, hold="first-chip-4")
    yield from carved(screen, ob, curve((6.1, 9.1), (6.2, 9.2)), 3.2, 2.2, ctrl=True)
    yield from carved(screen, ob, curve((5.9, 9), (6, 9.1)), 1.5, 1.1)  # pupils
    yield from carved(screen, ob, curve((0.7, 8.6), (2.2, 6.2), (1.7, 3.4), (0, 1)), 0.9, 0.8)  # beak
    yield from carved(screen, ob, curve((0.8, 10), (2.6, 14.2), (7, 17), (11, 21)), 1.5, 1.3, ctrl=True)  # brows
    yield from carved(screen, ob, curve((5.4, 16.2), (8.6, 18.6), (12.2, 22.8)), 2.1, 1.6, ctrl=True)  # ears
    edge = curve((18.3, 4), (14.8, 5.6), (11.2, 3.4), (9.6, -2), (9.9, -9), (12, -15), (13.6, -18))
    yield from carved(screen, ob, edge, 1.3, 1.0)  # wings
    for way in (((12.6, 0), (12.4, -6), (13.8, -12.5)), ((15.4, 0.8), (15.2, -5), (16, -10.5))):
        yield from carved(screen, ob, curve(*way), 0.9, 0.7)
    for row, z in enumerate((-4.5, -7.9, -11.3, -14.7)):
        for x in (2.0, 6.0) if row % 2 == 0 else (0.0, 4.0):
            yield from carved(screen, ob, feather(x, z), 0.8, 0.6)
    for x in (2.2, 4.4, 6.6):  # toes
        yield from carved(screen, ob, curve((x, -20.4), (1.05 * x, -22.6)), 1.3, 1.2, ctrl=True)
    after = lessons.volume(ob)
    taken, put_on = before.copy().subtract(after).volume, after.copy().subtract(before).volume
    report.say(note=f"owl: {taken:.0f} mm³ taken, {put_on:.0f} mm³ put on")
    # Grooves and caps as on a plane: sockets, pupils, beak, wings and feathers remove 470 mm³, less the eyes; brows,
    # ears and toes add material, with their round ends, and follow what they have added.
    assert 250 < taken < 500 and 250 < put_on < 900, (taken, put_on)
    screen.area.spaces.active.shading.show_cavity = True
    region = screen.region()
    screen.move(region.x + 130, region.y + 190)  # off the owl
    yield 0.5
    screen.move(region.x + 300, screen.area.y - 30)
    yield 0.5
    yield from lessons.picture(screen, "first-chip-5", lessons.view_box(screen))


def exported(screen):
    ob = bpy.context.object
    path = Path(common.out("owl.stl"))
    path.unlink(missing_ok=True)
    screen.click(46, screen.window.height - 13)
    yield 0.6
    old = bpy.app.version < (5, 0)
    row = screen.window.height - (318 if old else 332)  # of Export in the menu File
    screen.move(80, row)
    yield 0.8
    screen.move(307, row)
    yield 0.3
    screen.move(307, row - (207 if old else 146))  # Riffler STL
    yield from lessons.picture(screen, "first-chip-6")
    for _ in range(3):
        screen.key("ESC")
        yield 0.2
    with screen.override():
        assert bpy.ops.riffler.export_stl(filepath=str(path)) == {"FINISHED"}
    lessons.closed(path, lessons.volume(ob).volume, within=2e-3)
    yield 0.2
