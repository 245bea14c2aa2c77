"""docs/engrave.md: a name from Blender's text, cut with a pointed tool, and again with a ball on another block."""

from pathlib import Path

import bpy
import numpy as np

from support import common, harness

lessons = harness.load(Path(__file__).with_name("lessons.py"))
PIXELS = False
SIZE = (90.0, 34.0, 10.0)
DEPTH = 0.6


def steps(screen):
    lessons.only_open("RIFFLER_PT_sculpt", "RIFFLER_PT_tool", "RIFFLER_PT_cut", "RIFFLER_PT_export")
    yield from lessons.begin(screen, millimetres=False)
    first = lessons.block(screen, SIZE)
    curve = yield from written(screen)
    yield from engraved(screen, first, curve)
    recording = common.out("name.rjournal")
    with screen.override():
        assert bpy.ops.riffler.export_recording(filepath=recording) == {"FINISHED"}
        assert bpy.ops.riffler.export_nc(filepath=common.out("name.ngc"), post="3-axis") == {"FINISHED"}
    lessons.interpreted(common.out("name.ngc"), sum(len(cut.poses) - 1 for cut in common.content(first).cuts))
    yield from replayed(screen, first, curve, recording)


def written(screen):
    """A text becomes a curve."""
    with screen.override():
        bpy.ops.object.text_add("INVOKE_DEFAULT", True, radius=24)
    text = bpy.context.object
    assert text.data.body == "Text" and np.isclose(text.data.size, 24), (text.data.body, text.data.size)
    screen.to_view()
    yield 0.5
    for key in ("TAB", *["BACK_SPACE"] * 4):
        screen.key(key)
        yield 0.2
    for letter in "Riffler":
        for value in ("PRESS", "RELEASE"):
            unicode = {"unicode": letter} if value == "PRESS" else {}
            lessons.event(screen, letter.upper(), value, screen.at, **unicode)
        yield 0.1
    screen.key("TAB")
    yield lambda: bpy.context.mode == "OBJECT"
    assert text.data.body == "Riffler", text.data.body
    text.data.align_x, text.data.align_y = "CENTER", "CENTER"
    with screen.override():
        bpy.ops.view3d.view_axis(type="TOP")
    screen.area.spaces.active.region_3d.view_distance *= 0.75
    yield from lessons.aside(screen)
    yield from lessons.picture(screen, "engrave-1", lessons.view_box(screen))
    with screen.override():
        bpy.ops.object.convert("EXEC_DEFAULT", True, target="CURVE")
    assert bpy.context.object.type == "CURVE"
    return bpy.context.object


def engraved(screen, stock, curve):
    lessons.activate(stock)
    lessons.cutter("Engraver 60°, ball R0.1")
    settings = bpy.context.scene.riffler.cut
    settings.curve, settings.depth = curve, DEPTH
    yield 0.3
    yield from lessons.press(screen, "riffler.cut_curve")
    yield lambda: lessons.idle() and lessons.volume(stock).volume < np.prod(SIZE)
    yield from lessons.hidden(screen, curve)
    # a groove of the cone's section along all outlines; corners and crossings are cut once
    radius, half = 0.1, np.radians(30)
    section = np.tan(half) * (DEPTH + radius / np.sin(half) - radius) ** 2 - radius**2 * (
        1 / np.tan(half) - (np.pi / 2 - half)
    )
    way = sum(s.calc_length() for s in curve.data.splines)
    removed = np.prod(SIZE) - lessons.volume(stock).volume
    assert 0.9 < removed / (section * way) < 1.02, (removed, section * way)
    yield from lessons.picture(screen, "engrave-2", lessons.view_box(screen))


def replayed(screen, first, curve, recording):
    """The same strokes, with the panel's current tool, on a new block."""
    first.location.y = 42
    second = lessons.block(screen, SIZE)
    lessons.cutter("Ball 3 mm")
    yield 0.3
    with screen.override():
        done = bpy.ops.riffler.cut_recording("INVOKE_DEFAULT", True, filepath=recording, other=True)
        assert done == {"RUNNING_MODAL"}
    yield lambda: lessons.idle() and lessons.volume(second).volume < np.prod(SIZE)
    cuts = common.content(second).cuts
    assert {c.tool["name"] for c in cuts} == {"Ball 3 mm"}
    before = common.content(first).cuts
    assert all(np.array_equal(a.poses, b.poses) for a, b in zip(before, cuts, strict=True))
    removed = [np.prod(SIZE) - lessons.volume(ob).volume for ob in (first, second)]
    assert removed[1] > 2 * removed[0]  # the ball's groove is 2.4 mm wide, the engraver's 0.8
    with screen.override():
        first.select_set(True)
        bpy.ops.view3d.view_selected()
        bpy.ops.view3d.view_orbit(type="ORBITDOWN", angle=0.5)
        first.select_set(False)
    screen.area.spaces.active.region_3d.view_distance *= 1.15
    yield from lessons.aside(screen)
    screen.to_view()
    yield from lessons.picture(screen, "engrave-3", lessons.view_box(screen))
    path = common.out("name.stl")
    with screen.override():
        assert bpy.ops.riffler.export_stl(filepath=path) == {"FINISHED"}
    surface = lessons.closed(path, lessons.volume(second).volume, within=2e-3)
    assert np.allclose(np.ptp(surface.vertices, axis=0), SIZE, atol=1e-4)  # crests between grooves stay below the top
