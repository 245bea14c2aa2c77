"""Long work in a window: display in panel and status bar, Esc, errors, a lost object, a disabled add-on,
another file."""

from pathlib import Path

import bpy

from support import common, harness, operator_task

cut = harness.load(Path(__file__).with_name("window_cut.py"))
lessons = harness.load(Path(__file__).with_name("lessons.py"))


def progress():
    return bpy.context.window_manager.riffler


def begin(screen):
    with screen.override():
        assert bpy.ops.riffler.test_work("INVOKE_DEFAULT", True) == {"RUNNING_MODAL"}
    assert progress().running == "Testing the shell"


def ended():
    return progress().running == ""


def steps(screen):
    yield from cut.open_tab(screen)
    screen.to_view()
    with operator_task.Stage() as stage:
        yield from watched(screen, stage)
        yield from cancelled(screen, stage)
        yield from stock_of_a_mesh(screen)
        yield from failed(screen, stage)  # its report stays in the window, and takes the next Esc
        yield from lost(screen, stage)
    yield from disabled(screen)
    yield from another_file(screen)


def watched(screen, stage):
    """The work's progress is shown while other operators wait; Blender continues; then the result is one undo step."""
    with screen.override():
        bpy.ops.ed.undo_push(message="Before")
    begin(screen)
    stage.task.share = 0.4
    yield lambda: abs(progress().percent - 40) < 1e-3
    assert progress().text == "Looking" and not bpy.ops.riffler.new_stock.poll()
    yield lambda: "show" in stage.log
    yield from screen.picture("10-long-work")
    stage.task.finished = True
    yield ended
    assert stage.log[-1] == "made" and "restore" not in stage.log and bpy.ops.riffler.new_stock.poll()
    screen.key("Z", ctrl=True)
    yield lambda: "made" not in bpy.context.scene
    screen.key("Z", ctrl=True, shift=True)
    yield lambda: "made" in bpy.context.scene


def fresh(stage, **more):
    stage.task, stage.log[:] = operator_task.Task(**more), []


def cancelled(screen, stage):
    """Esc reaches the task; the preview is removed."""
    fresh(stage)
    begin(screen)
    yield lambda: "show" in stage.log
    screen.key("ESC")
    yield ended
    assert stage.task.cancelled and stage.log[-1] == "restore"


def failed(screen, stage):
    """An error of the task ends the work, with a message or, for a bug, a traceback."""
    for error in (ValueError("no path was found"), KeyError("a fault")):
        fresh(stage, outcome=error)
        begin(screen)
        yield 0.3
        stage.task.finished = True
        yield ended
        assert "made" not in stage.log


def lost(screen, stage):
    """The work's object is gone: the work ends, and changes nothing."""
    fresh(stage)
    begin(screen)
    yield lambda: "show" in stage.log
    stage.gone = "Test cancelled: gone"
    yield ended
    assert stage.task.cancelled and "restore" not in stage.log


def begin_stock(screen):
    with screen.override():
        how = {"source": "OBJECT", "pitch": 0.5, "directions": "xyz"}
        assert bpy.ops.riffler.new_stock("INVOKE_DEFAULT", True, **how) == {"RUNNING_MODAL"}
    assert progress().running == "Making stock"


def stock_of_a_mesh(screen):
    """Esc, and removing the mesh, leave no stock; a finished one is shown, and is one undo step."""
    with screen.override():
        bpy.ops.riffler.millimetres()
        bpy.ops.mesh.primitive_uv_sphere_add("EXEC_DEFAULT", True, radius=20, location=(200, 0, 0))
        bpy.context.object.name = "Ball"
        bpy.ops.ed.undo_push(message="Ball")
    task = operator_task.Task()
    with operator_task.meshes_taken_by(task):
        begin_stock(screen)
        task.share = 0.4
        with lessons.Recorded("stock.panel", "at_work") as panels:
            yield lambda: abs(progress().percent - 40) < 1e-3
            yield 0.5
        drawn = {cls.__name__ for arguments, draws in panels.calls if draws for cls in arguments[2:]}
        assert drawn == {"RIFFLER_OT_new_stock"}, "its progress is not in the panel that began it, or in another, too"
        screen.key("ESC")
        yield ended
    assert task.cancelled and "Ball Stock" not in bpy.data.objects and not bpy.data.objects["Ball"].hide_get()
    begin_stock(screen)
    yield ended
    assert bpy.context.object.name == "Ball Stock" and bpy.data.objects["Ball"].hide_get()
    view = screen.area.spaces.active.region_3d
    yield lambda: abs(view.view_location.x - 200) < 1
    screen.key("Z", ctrl=True)
    yield lambda: "Ball Stock" not in bpy.data.objects
    assert not bpy.data.objects["Ball"].hide_get()
    task = operator_task.Task()
    with operator_task.meshes_taken_by(task):
        begin_stock(screen)
        bpy.data.objects.remove(bpy.data.objects["Ball"])
        yield ended
    assert task.cancelled and not any("Stock" in ob.name for ob in bpy.data.objects)


def long_cut(screen):
    """A cut that is running and visible, of a new stock; returns the stock's state before it."""
    with screen.override():
        bpy.ops.riffler.millimetres()
        how = {"source": "BLOCK", "size": (100, 60, 30), "pitch": 0.5, "directions": "xyz"}
        bpy.ops.riffler.new_stock("INVOKE_DEFAULT", True, **how)
    name, before = cut.spiral(6, 250_000, "Long"), cut.state()
    bpy.context.view_layer.objects.active = bpy.data.objects["Stock"]
    faces = len(bpy.data.objects["Stock"].data.polygons)
    with screen.override():
        assert bpy.ops.riffler.cut_curve("INVOKE_DEFAULT", True, curve=name, depth=6) == {"RUNNING_MODAL"}
    yield lambda: len(bpy.data.objects["Stock"].data.polygons) != faces or ended()
    assert progress().running == "Cutting"
    return before


def disabled(screen):
    """The add-on is disabled during a cut: the cut is cancelled, the mesh shows the volume; enabled, it cuts again."""
    before = yield from long_cut(screen)
    bpy.ops.preferences.addon_disable(module=common.MODULE)
    yield 1.0
    bpy.ops.preferences.addon_enable(module=common.MODULE)
    yield 1.0
    assert ended() and cut.same(cut.state(), before)
    with screen.override():
        name = cut.spiral(1, 50, "Short")
        assert bpy.ops.riffler.cut_curve("INVOKE_DEFAULT", True, curve=name, depth=6) == {"RUNNING_MODAL"}
    yield ended
    assert cut.state()[0] < before[0]


def another_file(screen):
    """Another file is opened during a cut."""
    bpy.data.objects.remove(bpy.data.objects["Stock"])
    yield from long_cut(screen)
    with screen.override():
        bpy.ops.wm.read_homefile()
    yield 1.0
    assert ended() and "Stock" not in bpy.data.objects and common.part("blender.long_work")._running is None
    yield from long_cut(screen)
    screen.key("ESC")
    yield ended
