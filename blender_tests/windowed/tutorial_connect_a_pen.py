"""docs/connect-a-pen.md: preferences with limits and doctor, then a session with the simulated pen, undo and Esc."""

import time
from pathlib import Path

import bpy
import numpy as np

from support import common, harness

lessons = harness.load(Path(__file__).with_name("lessons.py"))
PIXELS = False
SIZE = (60.0, 60.0, 20.0)
SEEN = 0.12  # N: an arrow that is longer than its head


def steps(screen):
    lessons.only_open("RIFFLER_PT_sculpt", "RIFFLER_PT_pen")  # the session's panel takes the rest of the height
    yield from lessons.begin(screen, millimetres=False)
    yield from preferences(screen)
    name = lessons.block(screen, SIZE).name
    bpy.context.scene.riffler.tool.diameter = 8
    yield from lessons.aside(screen)
    with screen.override():
        bpy.ops.ed.undo_push(message="Stock")
    yield from session(screen, name)
    path = common.out("pen.stl")
    with screen.override():
        assert bpy.ops.riffler.export_stl(filepath=path) == {"FINISHED"}
    lessons.closed(path, lessons.volume(bpy.data.objects[name]).volume, within=2e-3)


def preferences(screen):
    """Edit > Preferences > Add-ons, with Riffler expanded, in the view's area; its doctor report is made."""
    area = screen.area
    bpy.context.preferences.active_section = "ADDONS"
    bpy.context.window_manager.addon_search = "Riffler"
    area.type = "PREFERENCES"
    yield 1.0  # it must be drawn once
    bpy.ops.preferences.addon_expand(module=common.MODULE)
    area.tag_redraw()
    yield 1.0
    region = next(r for r in area.regions if r.type == "WINDOW")
    # Above is the add-on's file, below are folders: of a computer, not of the page.
    top = area.y + area.height
    yield from lessons.picture(screen, "connect-a-pen-1", (area.x + 172, top - 481, area.x + 1147, top - 254))
    with bpy.context.temp_override(window=screen.window, area=area, region=region):
        assert bpy.ops.riffler.doctor("INVOKE_DEFAULT") == {"FINISHED"}
    report = bpy.data.texts["Riffler Doctor"].as_string()
    assert "Riffler in Blender" in report and bpy.app.version_string in report, report
    bpy.context.window_manager.addon_search = ""
    area.type = "VIEW_3D"
    yield 1.0


def cutting():
    """Steps: until the hand is in a stroke and feels it; a computer that is too slow gets any stroke in the end."""
    force, begin = common.part("sculpt.force_view"), time.perf_counter()

    def cuts():
        session = common.part("pen.session").running
        if session is None:
            return True
        run, waited = session.run, time.perf_counter() - begin
        felt = run.state == "active" and min(run.force, force._shown.size if force._shown else 0) > SEEN
        return run.in_stroke and run.pose[2] < -2.5 and (felt or waited > 100)

    yield cuts


def session(screen, name):
    state, settings = bpy.context.window_manager.riffler, bpy.context.scene.riffler.pen
    settings.device, settings.removal_constant = "simulated", 0.02
    yield 0.3
    yield from lessons.press(screen, "riffler.pen_sculpt")
    yield lambda: state.sculpting
    screen.to_view()
    yield from cutting()
    session = common.part("pen.session").running
    assert state.sculpting and state.force, "the session was over before it could be looked at"
    look, session.look = session.look, lambda: True  # the picture is of this moment
    yield from lessons.picture(screen, "connect-a-pen-2", lessons.view_box(screen))
    session.look = look
    screen.key("ESC")
    yield lambda: not state.sculpting
    yield 1.0
    removed = np.prod(SIZE) - lessons.volume(bpy.data.objects[name]).volume
    assert removed > 100, removed
    screen.move(screen.area.x + 300, screen.area.y - 30)  # no cutter under the pointer
    yield from lessons.picture(screen, "connect-a-pen-3", lessons.view_box(screen))
    less = lessons.volume(bpy.data.objects[name]).volume
    screen.key("Z", ctrl=True)  # one stroke
    yield lambda: lessons.volume(bpy.data.objects[name]).volume > less
    yield 0.5
    screen.key("Z", ctrl=True, shift=True)
    yield lambda: np.isclose(lessons.volume(bpy.data.objects[name]).volume, less)
