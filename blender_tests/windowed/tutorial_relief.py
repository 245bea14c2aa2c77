"""docs/relief.md: a flower from a picture, smoothed, masked, and dimples around it."""

import subprocess
from pathlib import Path

import bpy
import numpy as np

from support import common, harness

lessons = harness.load(Path(__file__).with_name("lessons.py"))
PIXELS = False
SIDE, DEEP, WIDTH, DEPTH = 70.0, 12.0, 60.0, 3.0  # block and relief, mm


def flower(n=512):
    """Heights (n, n) of 0 to 1 of eight petals around a heart of seeds."""
    x = np.linspace(-1, 1, n)
    x, y = np.meshgrid(x, x)
    r, a = np.hypot(x, y), np.arctan2(y, x)
    edge = 0.42 + 0.38 * np.abs(np.cos(4 * a)) ** 0.7  # of the petals
    height = (0.45 + 0.4 * np.clip(r, 0, 0.8)) * (0.75 + 0.25 * np.abs(np.cos(4 * a)))
    petal = np.clip(1 - (r / edge) ** 6, 0, 1) * height
    seeds = 0.85 + 0.15 * np.sin(40 * r + 3 * a) * np.sin(14 * a)
    heart = np.sqrt(np.clip(1 - (r / 0.3) ** 2, 0, 1)) * seeds
    return np.clip(np.maximum(petal, heart), 0, 1)


def picture_file(screen):
    """The page's own picture, flower.png, in grey."""
    heights = np.round(255 * flower()).astype(np.uint8)
    path = screen.out / "tutorials" / "flower.png"
    path.parent.mkdir(parents=True, exist_ok=True)
    raw = path.with_suffix(".pgm")
    raw.write_bytes(b"P5 %d %d 255\n" % heights.shape[::-1] + heights[::-1].tobytes())
    subprocess.run(["convert", str(raw), "-strip", str(path)], check=True)
    raw.unlink()
    return path, heights / 255


def steps(screen):
    lessons.only_open("RIFFLER_PT_clay", "RIFFLER_PT_mask", "RIFFLER_PT_relief", "RIFFLER_PT_sculpt")
    yield from lessons.begin(screen, millimetres=False)
    ob = lessons.block(screen, (SIDE, SIDE, DEEP))
    yield from lessons.aside(screen)
    yield from embossed(screen, ob)
    yield from smoothed(screen, ob)
    yield from masked(screen, ob)
    assert 0 < len(common.content(ob).cuts) <= 64  # the dimples: NC code would have only these
    path = common.out("relief.stl")
    with screen.override():
        assert bpy.ops.riffler.export_stl(filepath=path) == {"FINISHED"}
    lessons.closed(path, lessons.volume(ob).volume, within=2e-3)


def embossed(screen, ob):
    path, heights = picture_file(screen)
    with screen.override():
        bpy.ops.object.empty_add("INVOKE_DEFAULT", True, type="PLAIN_AXES", radius=10)
        bpy.context.object.name = "Place"
        bpy.ops.object.select_all(action="DESELECT")
        ob.select_set(True)
        bpy.context.view_layer.objects.active = ob
    settings = bpy.context.scene.riffler.clay
    settings.image = bpy.data.images.load(str(path))
    settings.place = bpy.data.objects["Place"]
    settings.mode, settings.invert, settings.depth, settings.width = "ENGRAVE", True, DEPTH, WIDTH
    yield 0.7
    yield from lessons.picture(screen, "relief-1", lessons.view_box(screen))
    yield from lessons.press(screen, "riffler.relief")
    yield lambda: lessons.volume(ob).volume < SIDE * SIDE * DEEP
    yield from lessons.hidden(screen, bpy.data.objects["Place"])
    removed = SIDE * SIDE * DEEP - lessons.volume(ob).volume
    exact = DEPTH * WIDTH**2 * (1 - heights.mean())
    assert abs(removed / exact - 1) < 0.02, (removed, exact)
    yield 1.2  # the button is redrawn
    yield from lessons.picture(screen, "relief-2", lessons.view_box(screen))


def smoothed(screen, ob):
    """One petal, stroked from the heart to its tip."""
    with screen.override():
        bpy.ops.view3d.view_axis(type="TOP")
    sculpt = bpy.context.scene.riffler.sculpt
    sculpt.radius, sculpt.strength, sculpt.radial, sculpt.radial_axis = 3.0, 0.7, 8, "Z"
    yield 0.5
    yield from lessons.tool(screen, "riffler.carve")
    yield from lessons.pie(screen, "riffler.smooth")
    before = lessons.volume(ob).copy()
    yield from lessons.brushed(screen, ob, [(11, 0, 0), (20, 0, 0), (11, 0, 0)], hold="relief-3", together=3)
    after = lessons.volume(ob)
    changed = before.subtract(after).volume
    assert changed > 1, changed


def masked(screen, ob):
    """All within 25 mm of the middle is protected; dimples surround it."""
    with screen.override():
        bpy.ops.curve.primitive_bezier_circle_add("INVOKE_DEFAULT", True, radius=25)
        circle = bpy.context.object
        bpy.ops.object.select_all(action="DESELECT")
        bpy.context.view_layer.objects.active = ob
    bpy.context.scene.riffler.clay.form = circle
    yield from lessons.tool(screen, "builtin.select_box")
    yield lambda: ob.visible_get()
    yield from lessons.press(screen, "riffler.mask_form", share=0.25)
    yield lambda: lessons.module("sculpt.sculpt_store").content(ob.data).mask is not None
    yield from lessons.hidden(screen, circle)
    yield 0.5
    mask = lessons.module("sculpt.sculpt_store").content(ob.data).mask
    assert mask is not None and abs(mask.volume / (np.pi * 25**2 * DEEP) - 1) < 0.02
    before = lessons.volume(ob).copy()
    screen.to_view()
    yield from lessons.picture(screen, "relief-4", lessons.view_box(screen))
    sculpt = bpy.context.scene.riffler.sculpt
    sculpt.radius, sculpt.depth, sculpt.radial = 2.5, 1.0, 32
    yield from lessons.tool(screen, "riffler.smooth")  # the tool of the four that was used last
    yield from lessons.pie(screen, "riffler.carve")
    yield from lessons.brushed(screen, ob, [(27.0, 0, -3), (27.2, 0, -3)], together=3)
    yield from lessons.brushed(screen, ob, [(24.0, 2.4, -3), (24.2, 2.4, -3)], together=3)
    after = lessons.volume(ob)
    assert before.volume - after.volume > 50
    assert np.isclose(before.copy().intersect(mask).volume, after.copy().intersect(mask).volume, rtol=1e-12)
    yield from lessons.tool(screen, "builtin.select_box")
    yield lambda: ob.visible_get()
    with screen.override():
        assert bpy.ops.riffler.mask_clear() == {"FINISHED"}
        bpy.ops.view3d.view_orbit(type="ORBITDOWN", angle=0.9)
    screen.to_view()
    yield from lessons.picture(screen, "relief-5", lessons.view_box(screen))
