"""Hand tools by mouse in the window: the pointer shows the blade, a drag cuts a groove along its direction, F sets the
width, the panel shows the blade's sizes, and Ctrl-Z undoes the groove."""

from pathlib import Path

import bpy
import numpy as np

from support import harness

PIXELS = False
stroke = harness.load(Path(__file__).with_name("window_stroke.py"))


def steps(screen):
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    yield from stroke.cut.open_tab(screen)
    stroke.cut.stock(screen, 0.5)
    settings = stroke.settings()
    settings.depth, settings.pressure = 1.5, "NONE"
    stroke.tool(screen, "riffler.hand_tool")
    bpy.ops.riffler.hand_tool_preset(name="Gouge No. 7, 10 mm")
    yield 0.5
    full = stroke.volume().volume
    yield from stroke.drag(screen, [(10, 15, 20), (30, 30, 20), (50, 25, 20)], together=4)
    left, first = stroke.volume().volume, stroke.volume().to_bytes()
    assert full - left > 100, full - left
    bpy.ops.riffler.hand_tool_preset(name="V-Tool 60°, 6 mm")
    yield from stroke.drag(screen, [(10, 40, 20), (30, 50, 20), (50, 38, 20)], together=4)
    assert left - stroke.volume().volume > 20
    screen.move(*map(int, stroke.pixel(screen, (38, 12, 20))))
    yield 1.0
    yield from screen.shot("hand-tools-1-blade")
    screen.key("Z", ctrl=True)
    yield lambda: stroke.volume().to_bytes() == first
    screen.move(*map(int, stroke.pixel(screen, (30, 30, 20))))
    yield 0.3
    screen.key("F")
    yield 0.3
    screen.key("TWO")
    screen.key("RET")
    yield lambda: np.isclose(settings.width, 2.0)
