"""In a window: the hand rests, the artist leaves, Blender makes its autosave meanwhile, and an interrupted session is
offered and recovered."""

import shutil
import time
from pathlib import Path

import bpy

from support import common, harness
from support.sculpting import live, matches_its_volume, nothing_is_left, stroke, work

cut = harness.load(Path(__file__).with_name("window_cut.py"))
NAME = "Stock"


class Tool(bpy.types.WorkSpaceTool):
    bl_space_type, bl_context_mode, bl_idname, bl_label = "VIEW_3D", "OBJECT", "riffler.test", "Test"


def take_up(screen, tool):
    with screen.override():
        bpy.ops.wm.tool_set_by_id(name=tool)


def running():
    return live().of(bpy.data.objects[NAME])


def content():
    return common.content(bpy.data.objects[NAME])


def steps(screen):
    common.scale(1)
    bpy.utils.register_tool(Tool)
    yield from cut.open_tab(screen)
    folder = Path(common.out("autosave"))
    folder.mkdir(exist_ok=True, parents=True)
    for old in folder.glob("*.blend"):
        old.unlink()
    paths = bpy.context.preferences.filepaths
    paths.temporary_directory, paths.auto_save_time = str(folder), 1
    paths.use_auto_save_temporary_files = False
    paths.use_auto_save_temporary_files = True  # the minute begins now
    with screen.override():
        bpy.data.batch_remove(list(bpy.data.objects))
        common.stock(size=(60, 60, 20), pitch=0.5, directions="xyz")
        bpy.ops.view3d.view_all()
        common.push("stock")
    yield from rests(screen)
    yield from leaves(screen)
    yield from saved_meanwhile(screen, folder)
    yield from cut_off(screen)


def rests(screen):
    """A large sculpt is packed when the hand rests, and stays live as long as the tool is active."""
    take_up(screen, "riffler.test")
    run = work(NAME)
    run.persistence._packing.nbytes = 1e9
    last = stroke(NAME, 1)
    assert content().volume.to_bytes() != last
    yield lambda: run.persistence.packed == run.token
    assert content().volume.to_bytes() == last and running() is run
    yield 2.0
    assert running() is run
    yield from screen.picture("20-live")


def leaves(screen):
    """Another tool or another object: the session ends, and an undo undoes the last stroke."""
    second = stroke(NAME, 2)
    take_up(screen, "builtin.select_box")
    yield lambda: running() is None
    nothing_is_left()
    matches_its_volume(NAME)
    assert content().volume.to_bytes() == second
    take_up(screen, "riffler.test")
    screen.key("Z", ctrl=True)
    yield lambda: running() is not None
    first = running().volume.to_bytes()
    assert first != second
    bpy.context.view_layer.objects.active = None
    yield lambda: running() is None
    assert content().volume.to_bytes() == first
    bpy.context.view_layer.objects.active = bpy.data.objects[NAME]
    nothing_is_left()


def saved_meanwhile(screen, folder):
    """Blender's own autosave comes while the sculpt is live, and has a stroke that was made before it."""
    states = [content().volume.to_bytes()]
    k, begun = 4, time.monotonic()
    while not (files := list(folder.glob("*.blend"))):
        assert time.monotonic() - begun < 150, "no autosave, which is made every minute"
        states.append(stroke(NAME, k, ("remove", "add")[k % 2], may_be_none=True))
        k += 1
        yield lambda: running().persistence.packed == running().token  # at the stroke's end, or at rest
        yield 2.0
    assert running() is not None
    path = common.out("autosaved.blend")
    shutil.copy(files[0], path)
    with screen.override():
        bpy.ops.wm.open_mainfile(filepath=path)
    yield 1.0
    nothing_is_left()
    found = content().volume.to_bytes()
    assert found in states[-3:], "an older state than that of the last strokes"
    matches_its_volume(NAME)


def cut_off(screen):
    """The journal of a Blender that died is offered in the sidebar, and recovered by its button."""
    keeping = common.part("sculpt.persistence")
    take_up(screen, "riffler.test")
    stroke(NAME, 8, may_be_none=True)  # like those before, if the autosave took long
    last = stroke(NAME, 8, "add")
    begun = running().persistence.journal
    yield begun.settled
    kept = begun.folder.parent.parent / "kept"
    shutil.rmtree(kept, ignore_errors=True)
    shutil.copytree(begun.folder, kept)
    with screen.override():
        bpy.ops.wm.read_homefile(use_empty=False)
    yield 1.0
    assert not begun.folder.exists()
    shutil.move(kept, begun.folder)
    keeping.crashed(look=True)
    common.scale(1)
    bpy.data.batch_remove(list(bpy.data.objects))
    yield from cut.open_tab(screen)
    yield 1.0
    yield from screen.picture("21-cut-off")
    with screen.override():
        assert bpy.ops.riffler.recover("INVOKE_DEFAULT", True) == {"RUNNING_MODAL"}
    yield lambda: NAME in bpy.data.objects
    assert content().volume.to_bytes() == last
    matches_its_volume(NAME)
    yield lambda: not keeping.crashed()
    with screen.override():
        bpy.ops.view3d.view_all()
    yield 1.0
    yield from screen.picture("22-recovered", vary=["VIEW_3D"])  # at any time of the crash
