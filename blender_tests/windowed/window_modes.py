"""What Blender's own keys, workspaces and files do in the middle of the work at a sculpt: the point of the number pad
frames it, Tab and the workspace Modeling find its strokes in its mesh, a local view elsewhere is no danger, and a file
that is saved by somebody else in mid-stroke leaves no half of one."""

import tempfile
from pathlib import Path

import bpy
import numpy as np

from support import common, harness

stroke = harness.load(Path(__file__).with_name("window_stroke.py"))
LOWEST = 18.5  # mm: the bottom of a groove of 1.5 mm in the top at 20


def steps(screen):
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    yield from stroke.cut.open_tab(screen)
    stroke.cut.stock(screen, 0.5)
    with screen.override():
        bpy.ops.ed.undo_push(message="Stock")
    stroke.tool(screen, "riffler.carve")
    stroke.settings().depth = 1.5
    yield 1.0
    yield from framed(screen)
    yield from tabbed(screen)
    yield from in_modeling(screen)
    yield from from_the_header(screen)
    yield from in_local_view(screen)
    yield from saved_in_mid_stroke(screen)


def sculpt():
    return bpy.data.objects["Stock"]


def groove(screen, y, **more):
    yield from stroke.drag(screen, [(15, y, 20), (45, y, 20)], **more)


def in_mesh(y):
    """Whether the sculpt's own mesh has the groove at `y` (mm)."""
    co = common.coordinates(sculpt().data) * sculpt().data.riffler.mm_per_unit
    near = co[(np.abs(co[:, 1] - y) < 1) & (np.abs(co[:, 0] - 30) < 5) & (co[:, 2] > 10)]
    return abs(near[:, 2].min() - LOWEST) < 0.1


def framed(screen):
    yield from groove(screen, 10)
    assert stroke.run() is not None and common.is_hidden(sculpt())
    view = screen.area.spaces.active.region_3d
    view.view_location, view.view_distance = (1.0, 2.0, 3.0), 9.0
    yield 0.5
    screen.key("NUMPAD_PERIOD")
    yield lambda: view.view_distance != 9.0
    yield 2.0
    middle, region = stroke.pixel(screen, (30, 30, 10)), screen.region()
    assert np.allclose(middle, (region.x + region.width / 2, region.y + region.height / 2), atol=2), middle
    corners = np.array([stroke.pixel(screen, (x, y, z)) for x in (0, 60) for y in (0, 60) for z in (0, 20)])
    size = corners.max(axis=0) - corners.min(axis=0)
    assert 0.3 * region.height < size.max() and np.all(size < (region.width, region.height)), size


def tabbed(screen):
    screen.key("TAB")
    yield lambda: sculpt().mode == "EDIT"
    assert stroke.run() is None
    screen.key("TAB")
    yield lambda: sculpt().mode == "OBJECT"
    assert in_mesh(10)
    yield 1.0


def in_modeling(screen):
    """A workspace that opens in Edit Mode and asks no operator of ours."""
    yield from groove(screen, 22)
    assert stroke.run() is not None
    before = screen.window.workspace
    screen.window.workspace = bpy.data.workspaces["Modeling"]
    yield lambda: sculpt().mode == "EDIT" and not stroke.module("sculpt.live_sculpt").lives
    assert not common.is_hidden(sculpt())
    yield 1.0
    screen.window.workspace = before
    yield lambda: sculpt().mode == "OBJECT"
    yield 1.0
    assert in_mesh(22) and not stroke.module("sculpt.sculpts").edited(sculpt().data)


def from_the_header(screen):
    """The menu of modes has Sculpt Mode while somebody works at the sculpt; what its brush does there is asked about at
    the next stroke, and kept."""
    yield from groove(screen, 32)
    assert stroke.run() is not None and not sculpt().hide_get()
    with screen.override():
        assert bpy.context.active_object == sculpt()  # whose modes the header's menu has
        bpy.ops.object.mode_set("EXEC_DEFAULT", True, mode="SCULPT")
    yield lambda: not stroke.module("sculpt.live_sculpt").lives
    assert sculpt().mode == "SCULPT" and not common.is_hidden(sculpt()) and in_mesh(32)
    yield 1.0
    before = common.coordinates(sculpt().data)
    yield from screen.drag([tuple(map(int, stroke.pixel(screen, (x, 50, 20)))) for x in (20, 25, 30, 35, 40)], 0.1)
    yield 1.0
    assert not np.array_equal(common.coordinates(sculpt().data), before), "the brush of Sculpt Mode did nothing"
    with screen.override():
        bpy.ops.object.mode_set("EXEC_DEFAULT", True, mode="OBJECT")
    stroke.tool(screen, "riffler.carve")
    yield 0.5
    assert stroke.module("sculpt.mesh_edits").noticed(sculpt())
    edited = common.coordinates(sculpt().data)[:, 2].max()
    yield from groove(screen, 44)
    yield 0.5
    for value in ("PRESS", "RELEASE"):
        screen.window.event_simulate("RET", value, x=screen.at[0], y=screen.at[1])
    yield lambda: stroke.run() is not None and stroke.module("sculpt.pointer").held is None
    stroke.module("sculpt.live_registry").end_all()
    yield 0.5
    assert in_mesh(32) and in_mesh(44)
    mm = sculpt().data.riffler.mm_per_unit
    assert abs(common.coordinates(sculpt().data)[:, 2].max() - edited) * mm < 0.1, "the edits were dropped"


def in_local_view(screen):
    """Blender crashes where an object is put into the local view of a screen that no window shows."""
    text = stroke.module("sculpt.stroke_operator").last
    with screen.override():
        bpy.ops.view3d.localview()
    before = screen.window.workspace
    screen.window.workspace = bpy.data.workspaces["Shading"]
    yield 2.0
    with screen.override():
        assert bpy.ops.riffler.stroke(stroke=text, mode="ADD") == {"FINISHED"}
    stroke.module("sculpt.live_registry").end_all()
    screen.window.workspace = before
    yield 2.0
    with screen.override():
        bpy.ops.view3d.localview()
    yield 1.0


def saved_in_mid_stroke(screen):
    whole = stroke.volume().to_bytes()
    yield from groove(screen, 40, release=False)
    assert stroke.volume().to_bytes() != whole
    with tempfile.TemporaryDirectory() as folder:
        with screen.override():
            bpy.ops.wm.save_as_mainfile(filepath=str(Path(folder) / "saved.blend"), copy=True)
        screen.move(*map(int, stroke.pixel(screen, (40, 44, 20))))
        yield lambda: stroke.module("sculpt.pointer").held is None
        stroke.press(screen, *screen.at, "RELEASE")
        yield 0.5
    assert stroke.volume().to_bytes() == whole and stroke.run() is None and sculpt().visible_get()
    yield from groove(screen, 40)
    stroke.module("sculpt.live_registry").end_all()
    yield 0.5
    assert in_mesh(40)
