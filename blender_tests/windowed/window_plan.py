"""A machinist's steps to a plan: part, fixtures, tool, pencil cuts; a part that was moved; Ctrl-Z; Esc."""

import time
from pathlib import Path

import bpy
import numpy as np

from support import common, harness

HERE = Path(__file__).resolve().parent
cut = harness.load(HERE / "window_cut.py")
find = harness.load(HERE.parent / "headless" / "plan" / "test_plan_find.py")


def running():
    return bpy.context.window_manager.riffler.running


def plans():
    return find.store().in_scene(bpy.context.scene)


def known():
    """The panel's verdict on the only plan."""
    return common.part("plan.operators.watch")._known.get(plans()[0].name, (None, None))[1]


def steps(screen):
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    with screen.override():
        bpy.ops.riffler.millimetres()
    yield from cut.open_tab(screen, "RIFFLER_PT_plan")
    ui = screen.region("UI")
    screen.to_view()
    yield 1.0
    yield from screen.picture("20-plan-empty")
    find.step()
    with screen.override():
        bpy.ops.view3d.view_all()
    vise = make_vise()
    with screen.override():
        bpy.ops.object.select_all(action="DESELECT")
        vise.select_set(True)
        bpy.ops.riffler.plan_fixtures_add("INVOKE_DEFAULT", True)
        bpy.context.view_layer.objects.active = find.settings().part
        bpy.ops.riffler.plan_part("INVOKE_DEFAULT", True)
        bpy.ops.riffler.plan_assembly("EXEC_DEFAULT", True, shank=6, reach=45, holder=28, upper=32, height=30)
    assert ui.width > 100
    yield 1.0
    with screen.override():
        assert bpy.ops.riffler.plan_find("INVOKE_DEFAULT", True) == {"RUNNING_MODAL"}
    yield lambda: not running()
    assert len(plans()) == 1 and len(find.curves(plans()[0])) == 1
    yield lambda: known() is not None
    assert known().part == "" and known().edited == 0
    yield 1.0
    yield from screen.picture("21-plan")
    yield from moved_and_back(screen)
    yield from undone(screen)
    yield from cancelled(screen)
    yield from engraved(screen)


def make_vise():
    bpy.ops.mesh.primitive_cube_add(size=1, location=(30, 45, 4))
    bpy.context.object.name = "Vise"
    bpy.context.object.scale = (80, 10, 20)
    return bpy.context.object


def moved_and_back(screen):
    """The panel reports by itself that the part was moved, and that a curve was edited."""
    part = find.settings().part
    part.location.x = 2
    find.curves(plans()[0])[0].location.z = 5
    yield lambda: known() is not None and known().part != ""
    assert "moved" in known().part and known().edited == 1
    yield 1.0
    yield from screen.picture("22-plan-part-moved")
    part.location.x = 0
    with screen.override():
        bpy.ops.riffler.plan_show()
    yield lambda: known() is not None and known().part == "" and known().edited == 0


def undone(screen):
    """Ctrl-Z in the window: first the moves, in one step with the redrawing, then the plan."""
    with screen.override():
        bpy.ops.ed.undo_push(message="Moved and back")
    screen.to_view()
    for _ in range(2):
        yield 0.5
        screen.key("Z", ctrl=True)
    yield lambda: plans() == []
    screen.key("Z", ctrl=True, shift=True)
    yield lambda: len(plans()) == 1
    assert find.judge(plans()[0]).part == ""


def engraved(screen):
    """A selected curve becomes a path of another plan, drawn unchanged; Ctrl-Z removes it."""
    curve = common.curve("Line", [(5, 10, 8), (55, 10, 8)], mm_per_unit=1.0)
    find.settings().part, find.settings().strategy = plans()[0].riffler.plan.part, "ENGRAVE"
    with screen.override():
        common.select(curve)
        bpy.ops.ed.undo_push(message="Curve")
        assert bpy.ops.riffler.plan_find("INVOKE_DEFAULT", True, strategy="ENGRAVE") == {"RUNNING_MODAL"}
    yield lambda: not running()
    made = plans()[-1]
    assert len(plans()) == 2 and find.store().plan(made).depths == {0: 0.3}
    lines = common.part("program.line_view")
    yield lambda: lines._drawn is not None and set(lines._drawn[1]) == {"keyed"}
    screen.to_view()
    screen.key("Z", ctrl=True)
    yield lambda: len(plans()) == 1


def ripples(n=300):
    """A field of valleys, on which a search takes many seconds."""
    x = np.linspace(0, 200, n)
    x, y = np.meshgrid(x, x, indexing="ij")
    z = 4 * np.abs(np.sin(x / 6 + y / 17)) + 3 * np.abs(np.sin(y / 7 - x / 19))
    i = np.arange(n * n).reshape(n, n)
    a, b, c, d = (k.ravel() for k in (i[:-1, :-1], i[1:, :-1], i[1:, 1:], i[:-1, 1:]))
    mesh = bpy.data.meshes.new("Ripples")
    common.part("blender.meshes").fill(
        mesh, np.stack([x, y, z], -1).reshape(-1, 3), np.r_[np.c_[a, b, c], np.c_[a, c, d]]
    )
    ob = bpy.data.objects.new("Ripples", mesh)
    bpy.context.collection.objects.link(ob)
    return ob


def cancelled(screen):
    """Esc during a search: it ends soon, and nothing has changed. The window responds meanwhile."""
    find.settings().part = ripples()
    before = len(bpy.data.objects), [find.store().identity(ob) for ob in plans()]
    with screen.override():
        bpy.ops.ed.undo_push(message="Ripples")
        assert bpy.ops.riffler.plan_find("INVOKE_DEFAULT", True) == {"RUNNING_MODAL"}
    yield lambda: bpy.context.window_manager.riffler.percent > 1 or not running()
    assert running() == "Finding paths"
    yield from screen.picture("23-plan-searching")
    shell, took = common.part("blender.long_work").LongWork, []
    original = shell.cancel

    def cancel(self, context):
        begin = time.perf_counter()
        original(self, context)
        took.append(round(1000 * (time.perf_counter() - begin)))

    shell.cancel = cancel
    screen.key("ESC")
    yield lambda: not running()
    shell.cancel = original
    common.figure("ending a search, ms", took)  # without the window's drawing
    assert (len(bpy.data.objects), [find.store().identity(ob) for ob in plans()]) == before
    yield 0.5
