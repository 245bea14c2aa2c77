"""The simulated pen carves in view: bricks and tool follow, Ctrl-Z takes a stroke back, Esc ends it: one undo step."""

from pathlib import Path

import bpy
import harness
import numpy as np

import support

cut = harness.load(Path(__file__).with_name("window_cut.py"))


def sculpting():
    return bpy.context.window_manager.riffler.sculpting


def live():
    return support.part("operators.pen")._live


def begin(screen, **more):
    with screen.override():
        settings = bpy.context.scene.riffler.pen
        for key, value in more.items():
            setattr(settings, key, value)
        given = {k: getattr(settings, k) for k in support.part("properties").PenSettings.__annotations__}
        return bpy.ops.riffler.pen_sculpt("INVOKE_DEFAULT", True, **given)


def only_open(*names):
    """The sidebar with these panels open, so that one picture has them."""
    for cls in support.part("ui.panels").CLASSES + support.part("ui.pen_panel").CLASSES:
        if issubclass(cls, bpy.types.Panel):
            bpy.utils.unregister_class(cls)
            cls.bl_options = set() if cls.__name__ in names else {"DEFAULT_CLOSED"}
            bpy.utils.register_class(cls)


def steps(screen):
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    only_open("RIFFLER_PT_sculpt", "RIFFLER_PT_tool", "RIFFLER_PT_pen")
    yield from cut.open_tab(screen)
    with screen.override():
        bpy.ops.riffler.millimetres()
        settings = bpy.context.scene.riffler
        settings.tool.kind, settings.tool.diameter = "ball", 8.0
        bpy.ops.riffler.new_stock(
            "INVOKE_DEFAULT", True, source="BLOCK", origin="CORNER", size=(60, 60, 20), pitch=0.25, directions="xyz"
        )
        bpy.ops.ed.undo_push(message="Stock")
    before = cut.state()
    screen.to_view()
    yield 2.0

    assert begin(screen) == {"RUNNING_MODAL"} and sculpting()
    yield lambda: live() is None or live().run.removed > 400
    assert sculpting(), "the session was over before it could be looked at"
    screen.to_view()
    yield lambda: live() is None or live().run.in_stroke
    screen.shoot("08-pen")
    assert bpy.data.objects["Stock"].hide_get()

    # a click beside the sidebar does nothing; once the hand has let go, Ctrl-Z takes the last stroke back
    screen.click(screen.region().x + 200, screen.region().y + 200)
    device = live().run.device
    device.aim(device.geometry.forward([device.geometry.home])[0])
    yield lambda: not device.state().buttons and not live().run.in_stroke
    yield 1.0
    removed = before[0] - live().run.volume.volume
    screen.key("Z", ctrl=True)
    yield lambda: before[0] - live().run.volume.volume < removed
    less = before[0] - live().run.volume.volume
    screen.key("Z", ctrl=True, shift=True)
    yield lambda: before[0] - live().run.volume.volume > less
    assert before[0] - live().run.volume.volume == removed
    device.wander()

    screen.key("ESC")
    yield lambda: not sculpting()
    yield 2.0
    screen.shoot("09-pen-ended")
    after = cut.state()
    assert after[0] < before[0] and not bpy.data.objects["Stock"].hide_get()
    assert "Riffler Tool" not in bpy.data.objects and len(bpy.data.collections) == 1
    yield from cut.undo_and_redo(screen, before, after)

    # called again, it ends
    assert begin(screen, gap=100.0) == {"RUNNING_MODAL"}
    yield 1.0
    begin(screen)
    yield lambda: not sculpting()
    assert cut.same(cut.state(), after) and np.isfinite(after[1]).all()
