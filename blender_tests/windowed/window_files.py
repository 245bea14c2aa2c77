"""Work whose file is chosen first: the selector opens, the work goes on behind the window, Esc leaves no file."""

from pathlib import Path

import bpy

from support import common, harness

cut = harness.load(Path(__file__).with_name("window_cut.py"))
# two million triangles: work that can be seen
STOCK = {"source": "BLOCK", "size": (100, 60, 30), "pitch": 0.15, "directions": "xyz"}


def running():
    return bpy.context.window_manager.riffler.running


def selectors():
    return [(w, a) for w in bpy.context.window_manager.windows for a in w.screen.areas if a.type == "FILE_BROWSER"]


def choose(screen, operator, path, **more):
    """The operator's button, the file in the selector that comes, and its button: steps to `yield from`."""
    path = Path(path)
    with screen.override():
        assert operator("INVOKE_DEFAULT", **more) == {"RUNNING_MODAL"}
    yield lambda: selectors() and selectors()[0][1].spaces.active.params is not None
    yield 0.5
    window, area = selectors()[0]
    params = area.spaces.active.params
    params.directory, params.filename = str(path.parent).encode(), path.name
    yield 0.5
    region = next(r for r in area.regions if r.type == "WINDOW")
    with bpy.context.temp_override(window=window, area=area, region=region):
        bpy.ops.file.execute("INVOKE_DEFAULT")
    yield lambda: not selectors()


def steps(screen):
    bpy.context.preferences.view.filebrowser_display_type = "SCREEN"
    yield from cut.open_tab(screen)
    with screen.override():
        bpy.ops.riffler.millimetres()
        bpy.ops.riffler.new_stock(**STOCK)
    yield from written(screen)
    yield from cancelled(screen)
    yield from no_recording(screen)
    yield from recording(screen)


def written(screen):
    """Both formats, by the selector."""
    for operator in (bpy.ops.riffler.export_stl, bpy.ops.riffler.export_3mf):
        path = Path(common.out(f"chosen.{operator.idname()[-3:]}"))
        path.unlink(missing_ok=True)
        yield from choose(screen, operator, path)
        yield path.exists
        yield lambda: not running()
        assert path.stat().st_size > 1_000_000


def cancelled(screen):
    """Esc: no file, and nothing beside it; what was there stays."""
    path = Path(common.out("chosen.3mf"))
    # Other windows write into the same folder.
    before, beside = path.read_bytes(), set(path.parent.glob("*chosen*"))
    yield from choose(screen, bpy.ops.riffler.export_3mf, path, check_existing=False)
    yield lambda: running() == "Exporting"
    assert not bpy.ops.riffler.export_stl.poll()  # one long work at a time
    screen.key("ESC")
    yield lambda: not running()
    assert path.read_bytes() == before and set(path.parent.glob("*chosen*")) == beside


def no_recording(screen):
    """A file that is none is said in the words of whoever finds it, and nothing runs."""
    shared, said = common.part("blender.operator_parts"), []
    fail = shared.fail
    shared.fail = lambda operator, error: said.append(str(error)) or fail(operator, error)
    try:
        yield from choose(screen, bpy.ops.riffler.cut_recording, common.out("chosen.stl"))
        yield lambda: said
        yield 0.5
    finally:
        shared.fail = fail
    assert not running()
    assert len(said) == 2 and said[0] == said[1] and said[0].startswith("chosen.stl"), said


def recording(screen):
    """Strokes from a file: behind the window, and one step of undo."""
    name = cut.spiral(2, 6_000, "Spiral")
    path = Path(common.out("chosen.rjournal"))
    with screen.override():
        bpy.context.view_layer.objects.active = bpy.data.objects["Stock"]
        assert bpy.ops.riffler.cut_curve(curve=name, depth=2) == {"FINISHED"}
        made = cut.state()
        assert bpy.ops.riffler.export_recording(filepath=str(path)) == {"FINISHED"}
        bpy.data.objects.remove(bpy.data.objects["Stock"])
        bpy.ops.riffler.new_stock(**STOCK)
        bpy.ops.ed.undo_push(message="Before")
    before = cut.state()
    yield from choose(screen, bpy.ops.riffler.cut_recording, path)
    yield lambda: running() == "Cutting" or cut.state()[0] < before[0]
    yield lambda: not running()
    assert cut.state()[0] == made[0] < before[0]
    yield from cut.undo(screen, before)
