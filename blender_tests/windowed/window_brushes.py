"""Brushes with falloff by mouse in the window: the pointer shows the ring and the falloff, clay and a snake hook add
material, Ctrl digs, a grab goes back to where it began, and Ctrl-Z undoes them."""

from pathlib import Path

import bpy

from support import harness

PIXELS = False
stroke = harness.load(Path(__file__).with_name("window_stroke.py"))


def steps(screen):
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    yield from stroke.cut.open_tab(screen)
    stroke.cut.stock(screen, 0.5)
    live = stroke.module("sculpt.live_registry").begin(bpy.context, bpy.data.objects["Stock"])
    live.volume = live.volume.grow((0, 0, 0), (60, 60, 20))
    live.end()
    settings = stroke.settings()
    settings.radius, settings.depth, settings.strength, settings.pressure = 6.0, 3.0, 1.0, "NONE"
    with screen.override():
        bpy.ops.ed.undo_push(message="Stock")
    full = stroke.volume().volume
    stroke.tool(screen, "riffler.clay")
    yield 1.0
    screen.move(*stroke.pixel(screen, (30, 30, 20)))
    yield 0.5
    yield from stroke.drag(screen, [(15, 20, 20), (45, 20, 20)], ctrl=True)
    dug = stroke.volume().volume
    assert dug < full - 100
    screen.move(*stroke.pixel(screen, (30, 40, 20)))
    yield 1.0
    yield from screen.shot("brushes-1-dug")
    yield from stroke.drag(screen, [(20, 20, 17), (40, 20, 17)])
    assert dug < stroke.volume().volume < full
    stroke.tool(screen, "riffler.grab")
    yield from stroke.drag(screen, [(30, 0.5, 20), (30, 10, 24)])
    yield 0.5
    yield from screen.shot("brushes-2-grabbed")
    grabbed = stroke.volume().to_bytes()
    screen.key("Z", ctrl=True)
    yield lambda: stroke.volume().to_bytes() != grabbed
    told = " ".join(stroke.module("sculpt.panel").looks(stroke.run().stages))
    print(told)
