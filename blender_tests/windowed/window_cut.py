"""A user's steps through the add-on: the sidebar's tab, new stock, a cut that runs in view, Ctrl-Z, and Esc."""

import bpy
import numpy as np

from support import common


def open_tab(screen, panel="RIFFLER_PT_sculpt"):
    """Opens the sidebar and clicks down its tabs until ours draws."""
    drawn = []
    cls = getattr(bpy.types, panel)
    original = cls.draw

    def draw(self, context):
        drawn.append(1)
        original(self, context)

    cls.draw = draw
    screen.area.spaces.active.show_region_ui = True
    yield 0.5
    ui = screen.region("UI")
    for down in range(40, 400, 24):
        screen.click(ui.x + ui.width - 9, ui.y + ui.height - down)
        yield 0.4
        if drawn:
            break
    cls.draw = original
    assert drawn, "the tab was not found"


def stock(screen, pitch):
    """A block of 60 × 60 × 20 mm from the origin on, and a ball of 8 mm as the tool."""
    with screen.override():
        bpy.ops.riffler.millimetres()
        tool = bpy.context.scene.riffler.tool
        tool.kind, tool.diameter = "ball", 8.0
        bpy.ops.riffler.new_stock(
            "INVOKE_DEFAULT", True, source="BLOCK", origin="CORNER", size=(60, 60, 20), pitch=pitch, directions="xyz"
        )


def running():
    return bpy.context.window_manager.riffler.running


def state():
    ob = bpy.data.objects["Stock"]
    return common.content(ob).volume.volume, common.coordinates(ob.data)


def spiral(turns, rows, name):
    a = np.linspace(0, 1, rows)
    r = 4 + 22 * a
    xyz = np.c_[50 + r * np.cos(2 * np.pi * turns * a), 30 + r * np.sin(2 * np.pi * turns * a), 30 - 6 * (1 - a)]
    return common.curve(name, xyz, mm_per_unit=1).name


def steps(screen):
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    yield from open_tab(screen)
    screen.to_view()
    yield 1.0
    yield from screen.picture("01-sidebar")

    with screen.override():
        bpy.ops.riffler.millimetres()
        settings = bpy.context.scene.riffler
        stock = {k: getattr(settings.stock, k) for k in ("source", "origin", "directions")}
        bpy.ops.riffler.new_stock("INVOKE_DEFAULT", True, size=(100, 60, 30), pitch=0.5, **stock)
    assert bpy.data.objects["Stock"].dimensions[:] == (100, 60, 30)
    screen.to_view()
    yield 3.0
    yield from screen.picture("02-new-stock")

    with screen.override():
        settings.cut.curve = bpy.data.objects[spiral(6, 50_000, "Spiral")]
        settings.cut.depth = 1.0
        bpy.ops.ed.undo_push(message="Curve")
    before = state()
    with screen.override():
        assert bpy.ops.riffler.cut_curve("INVOKE_DEFAULT", True, curve="Spiral", depth=1) == {"RUNNING_MODAL"}
    assert running()
    yield lambda: bpy.context.window_manager.riffler.percent > 20 or not running()
    assert running(), "the cut was over before it could be looked at"
    yield from screen.picture("03-cutting", vary=["VIEW_3D"])
    yield lambda: not running()
    yield 3.0
    after = state()
    assert after[0] < before[0] and len(after[1]) != len(before[1])
    bpy.data.objects["Spiral"].hide_set(True)
    yield 1.0
    yield from screen.picture("04-cut")
    bpy.data.objects["Spiral"].hide_set(False)

    yield from undo_and_redo(screen, before, after)
    yield from cancel(screen, after)
    # no undo step of its own: the first undoes the long curve, the second the cut before
    yield from undo(screen, after)
    assert "Long" not in bpy.data.objects
    yield from undo(screen, before)


def same(a, b):
    return a[0] == b[0] and np.array_equal(a[1], b[1])


def undo(screen, before):
    screen.to_view()
    yield 0.3
    screen.key("Z", ctrl=True)
    yield 1.5
    assert same(state(), before), "Ctrl-Z did not restore mesh and volume"


def undo_and_redo(screen, before, after):
    yield from undo(screen, before)
    yield 2.0
    yield from screen.picture("05-undone")
    screen.key("Z", ctrl=True, shift=True)
    yield 1.5
    assert same(state(), after), "Ctrl-Shift-Z did not restore mesh and volume"


def cancel(screen, after):
    """Esc during a cut, after the half-cut surface was shown: everything is restored, and no undo step is left."""
    name = spiral(6, 250_000, "Long")  # long enough on any computer
    bpy.data.objects[name].hide_set(True)
    bpy.context.view_layer.objects.active = bpy.data.objects["Stock"]
    with screen.override():
        bpy.ops.ed.undo_push(message="Long curve")
    faces = len(bpy.data.objects["Stock"].data.polygons)
    with screen.override():
        bpy.ops.riffler.cut_curve("INVOKE_DEFAULT", True, curve=name, depth=6)
    yield lambda: len(bpy.data.objects["Stock"].data.polygons) != faces or not running()
    assert running(), "the cut was over before Esc"
    screen.key("ESC")
    yield lambda: not running()
    assert same(state(), after), "Esc did not restore mesh and volume"
    yield 3.0
    yield from screen.picture("06-cancelled")
