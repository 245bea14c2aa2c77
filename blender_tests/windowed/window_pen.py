"""The simulated pen carves in view: chunks, tool and arrows follow, Blender makes its autosave meanwhile, Ctrl-Z undoes
a stroke and Ctrl-Shift-Z redoes it, Esc or another tool ends it; with the tool Add active it adds."""

import shutil
import time
from pathlib import Path

import bpy
import numpy as np

from support import common, harness

cut = harness.load(Path(__file__).with_name("window_cut.py"))
lessons = harness.load(Path(__file__).with_name("lessons.py"))
NAME = "Stock"
TOP = 20.0  # mm, of the block
MINUTE = 60.0  # s: Blender makes its autosave no sooner
SEEN = 0.12  # N: an arrow that is longer than its head


def sculpting():
    return bpy.context.window_manager.riffler.sculpting


def session():
    return common.part("pen.session").running


def volume():
    return common.part("sculpt.live_registry").content(bpy.data.objects[NAME]).volume


def begin(screen, **more):
    with screen.override():
        settings = bpy.context.scene.riffler.pen
        for key, value in more.items():
            setattr(settings, key, value)
        given = {k: getattr(settings, k) for k in common.part("pen.properties").PenSettings.__annotations__}
        return bpy.ops.riffler.pen_sculpt("INVOKE_DEFAULT", True, **given)


def only_open(*names):
    """The sidebar with these panels open, so that one picture has them all."""
    classes = [cls for module in common.part("registration").modules() for cls in module.CLASSES]
    for cls in classes:
        if issubclass(cls, bpy.types.Panel):
            bpy.utils.unregister_class(cls)
            cls.bl_options = set() if cls.__name__ in names else {"DEFAULT_CLOSED"}
            bpy.utils.register_class(cls)


def autosaves():
    """Makes Blender autosave into the folder, MINUTE from now."""
    folder = Path(common.out("pen-autosave"))
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    paths = bpy.context.preferences.filepaths
    paths.temporary_directory, paths.auto_save_time = str(folder), 1
    paths.use_auto_save_temporary_files = False
    paths.use_auto_save_temporary_files = True
    return folder


def prepare(screen):
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    only_open("RIFFLER_PT_sculpt", "RIFFLER_PT_tool", "RIFFLER_PT_pen")
    yield from cut.open_tab(screen)
    cut.stock(screen, 0.25 if lessons.PAGES else 0.5)  # fine for the page's picture
    bpy.context.scene.riffler.sculpt.limit = 0.2
    with screen.override():
        bpy.ops.ed.undo_push(message="Stock")
    screen.to_view()
    yield 2.0


def counted(looks):
    """Counts the polls of the running session."""
    look = session().look

    def counting():
        begin = time.perf_counter()
        try:
            return look()
        finally:
            looks.append((begin, time.perf_counter()))

    session().look = counting


def of_the_page(screen):
    """The picture of docs/sessions.md: deep in a stroke, with force on tool and hand. If the computer is too slow for a
    minute, a report says so, and later any stroke is used."""
    force, begin = common.part("sculpt.force_view"), time.perf_counter()

    def cuts():
        if session() is None:
            return True
        run = session().run
        waited = time.perf_counter() - begin
        good = run.pose[2] < TOP - 2 and min(run.force, force._shown.size) > SEEN
        return run.in_stroke and (waited > 105 or (good and (run.state == "active" or waited > 60)))

    view = screen.area.spaces.active.region_3d
    view.view_distance *= 1.25
    at = view.view_location.copy()
    yield from lessons.aside(screen)
    yield cuts
    assert sculpting(), "the session was over before it could be looked at"
    look, session().look = session().look, lambda: True
    yield 1.0
    yield from lessons.picture(screen, "session", lessons.view_box(screen))
    session().look = look
    view.view_distance /= 1.25
    view.view_location = at


def steps(screen):
    yield from prepare(screen)
    before, whole = cut.state(), volume().volume
    folder, since = autosaves(), time.perf_counter()
    assert begin(screen, removal_constant=0.005) == {"FINISHED"} and sculpting()
    tool = bpy.context.workspace.tools.from_space_view3d_mode("OBJECT", create=False)
    assert tool.idname == "riffler.carve" and common.part("sculpt.chunks").is_hidden(bpy.data.objects[NAME])
    looks = []
    counted(looks)
    force = common.part("sculpt.force_view")
    yield lambda: session() is None or (session().run.in_stroke and force._shown.size > 0)
    assert sculpting(), "the session was over before it could be looked at"
    look, session().look = session().look, lambda: True  # polling pauses for a moment, and a picture has the arrows
    yield 2.0
    yield from screen.picture("10-pen-force", vary=["VIEW_3D", "SIDEBAR"])
    session().look = look
    yield lambda: session() is None or session().changed > 400
    yield from screen.picture("08-pen", vary=["VIEW_3D"])
    yield from of_the_page(screen)
    times = np.array(looks)
    common.figure(
        "a session's looks in the window",
        {
            "a second": round(float((len(times) - 1) / (times[-1, 0] - times[0, 0])), 1),
            "ms, median": round(1e3 * float(np.median(times[:, 1] - times[:, 0])), 2),
        },
    )

    # once the hand has released, Ctrl-Z undoes the last stroke
    device = session().run.device
    device.aim(device.geometry.forward([device.geometry.home])[0])
    yield lambda: not device.state().buttons and not session().run.in_stroke
    yield 1.0
    made, mine = volume().volume, session()
    screen.key("Z", ctrl=True)
    yield lambda: volume().volume > made
    screen.key("Z", ctrl=True, shift=True)
    yield lambda: volume().volume == made
    assert session() is mine

    # nothing modal: Blender makes its autosave, and a stroke of the hand is in it; the display continues when it is due
    look, session().look = session().look, lambda: True
    yield lambda: session() is None or time.perf_counter() - since > MINUTE - 5
    assert session() is mine
    session().look = look
    device.wander()
    yield lambda: list(folder.glob("*.blend"))
    assert session() is mine and sculpting()
    shutil.copy(next(folder.glob("*.blend")), common.out("pen-autosaved.blend"))

    screen.key("ESC")
    yield lambda: not sculpting()
    yield 2.0
    assert not bpy.data.objects["Riffler Tool"].visible_get() and force._shown is None
    yield from screen.picture("09-pen-ended", vary=["VIEW_3D"])
    last = volume().to_bytes()
    with screen.override():
        bpy.ops.wm.tool_set_by_id(name="builtin.select_box")
    yield lambda: common.part("sculpt.live_registry").of(bpy.data.objects[NAME]) is None
    assert volume().to_bytes() == last and volume().volume < whole
    after = cut.state()
    assert after[0] < before[0] and not common.part("sculpt.chunks").is_hidden(bpy.data.objects[NAME])
    assert "Riffler Tool" not in bpy.data.objects and len(bpy.data.collections) == 1

    # a second call ends it; so do another tool, and the object's removal
    assert begin(screen, gap=100.0) == {"FINISHED"}
    yield 1.0
    begin(screen)
    yield lambda: not sculpting()
    assert begin(screen) == {"FINISHED"}
    yield 1.0
    with screen.override():
        bpy.ops.wm.tool_set_by_id(name="builtin.move")
    yield lambda: not sculpting()
    assert volume().to_bytes() == last

    # it does what the active tool does when it starts
    with screen.override():
        bpy.ops.wm.tool_set_by_id(name="riffler.add")
    assert begin(screen) == {"FINISHED"} and session().mode == "add"
    yield 1.0
    screen.key("ESC")
    yield lambda: not sculpting()
    with screen.override():
        bpy.ops.wm.tool_set_by_id(name="riffler.mask")
    common.refused(lambda: begin(screen), "use Carve or Add instead of Mask")
    assert not sculpting() and volume().to_bytes() == last
    with screen.override():
        bpy.ops.wm.open_mainfile(filepath=common.out("pen-autosaved.blend"))
    yield 1.0
    assert volume().volume < whole - 100
