"""Kept strokes by mouse in the window: a stroke becomes a curve, the list edits it, and the sculpt is cut again while
its point is dragged with G; Ctrl-Z undoes the drag."""

import time
from pathlib import Path

import bpy

from support import harness

PIXELS = False
stroke = harness.load(Path(__file__).with_name("window_stroke.py"))


def kept():
    return stroke.module("sculpt.kept_strokes")


def steps(screen):
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    yield from stroke.cut.open_tab(screen)
    stroke.cut.stock(screen, 0.5)
    settings = stroke.settings()
    settings.depth, settings.pressure, settings.keep, settings.radius = 1.5, "NONE", True, 4.0
    stroke.tool(screen, "riffler.carve")
    yield 0.5
    yield from stroke.drag(screen, [(10, 15, 20), (30, 25, 20), (50, 15, 20)], together=4)
    bpy.ops.riffler.hand_tool_preset(name="Gouge No. 5, 12 mm")
    stroke.tool(screen, "riffler.hand_tool")
    yield from stroke.drag(screen, [(10, 40, 20), (30, 48, 20), (50, 40, 20)], together=4)
    own = bpy.data.objects["Stock"].riffler.strokes
    assert [row.curve.name for row in own.rows] == ["Stock Carve", "Stock Hand Tool"]
    before = stroke.volume().to_bytes()
    own.index = 0
    with screen.override():
        assert bpy.ops.riffler.stroke_edit("INVOKE_DEFAULT") == {"FINISHED"}
    yield 1.0
    curve = own.rows[0].curve
    assert bpy.context.view_layer.objects.active == curve and curve.mode == "EDIT" and stroke.run() is not None
    points = curve.data.splines[0].points
    for k, point in enumerate(points):
        point.select = k == len(points) // 2
    screen.move(*map(int, stroke.pixel(screen, (30, 25, 20))))
    yield 0.3
    updates, begin = [], time.perf_counter()
    follow = stroke.module("sculpt.pure.stroke_history").StrokeHistory.follow

    def counted(self, wanted):
        start = time.perf_counter()
        made = follow(self, wanted)
        updates.append(time.perf_counter() - start)
        return made

    stroke.module("sculpt.pure.stroke_history").StrokeHistory.follow = counted
    screen.key("G")
    for k in range(12):
        screen.move(*map(int, stroke.pixel(screen, (30, 25 + 0.8 * k, 20))))
        yield 0.15
    yield lambda: stroke.volume().to_bytes() != before
    stroke.press(screen, *stroke.pixel(screen, (30, 34, 20)), "PRESS")
    stroke.press(screen, *stroke.pixel(screen, (30, 34, 20)), "RELEASE")
    yield 0.7
    stroke.module("sculpt.pure.stroke_history").StrokeHistory.follow = follow
    print(
        f"{len(updates)} cuts in {time.perf_counter() - begin:.1f} s, {1000 * sum(updates) / len(updates):.1f} ms each"
    )
    assert len(updates) > 3, "the sculpt follows the drag, not only its end"
    yield from screen.shot("kept-strokes-1-bent")
    screen.key("Z", ctrl=True)
    yield lambda: stroke.volume().to_bytes() == before
    assert stroke.run() is not None
