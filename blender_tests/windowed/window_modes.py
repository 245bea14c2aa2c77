"""Blender's own keys, workspaces and files during a session at a sculpt: the number pad's point frames it, Tab and the
workspace Modeling find its strokes in its mesh, a local view elsewhere does no harm, and a file saved by other means
during a stroke contains no half of one. Then the messages of a stroke: at the stock's box, on a sculpt that is scaled
to zero, scaled by its parent or modified; and Clay with odd sizes."""

import tempfile
from pathlib import Path

import bpy
import numpy as np

from support import common, harness

HERE = Path(__file__).resolve().parent
stroke = harness.load(HERE / "window_stroke.py")
lessons = harness.load(HERE / "lessons.py")
live_tests = harness.load(HERE.parent / "headless" / "sculpt" / "test_live_sculpt.py")
refusals = harness.load(HERE.parent / "headless" / "blender" / "test_refusals.py")
PIXELS = False
LOWEST = 18.5  # mm: the bottom of a groove of 1.5 mm in the top at 20


def steps(screen):
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    lessons.only_open("RIFFLER_PT_sculpt", "RIFFLER_PT_clay")
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
    yield from begun_again(screen)
    yield from with_force(screen)
    yield from at_the_box(screen)
    yield from in_odd_states(screen)
    yield from of_odd_sizes(screen)
    begins_small = [line for line in lessons.messages(screen) if line[:1].islower()]
    assert not begins_small, begins_small


def sculpt():
    return bpy.data.objects["Stock"]


def groove(screen, y, places=2, **more):
    """Along x; with one place, a click."""
    yield from stroke.drag(screen, [(15, y, 20), (45, y, 20)][:places], together=4, **more)


def in_mesh(y):
    """Whether the sculpt's own mesh has the groove at `y` (mm)."""
    co = common.coordinates(sculpt().data) * sculpt().data.riffler.mm_per_unit
    near = co[(np.abs(co[:, 1] - y) < 1) & (np.abs(co[:, 0] - 30) < 16) & (co[:, 2] > 10)]
    return abs(near[:, 2].min() - LOWEST) < 0.1


def framed(screen):
    yield from groove(screen, 10)
    assert stroke.run() is not None and common.is_hidden(sculpt())
    live_tests.shaded_as_the_whole(stroke.run())
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
    """A workspace that opens in Edit Mode and calls no operator of ours."""
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
    """The menu of modes has Sculpt Mode during a session; the next stroke asks about its brush's edits, which
    are kept."""
    yield from groove(screen, 32)
    assert stroke.run() is not None and not sculpt().hide_get()
    with screen.override():
        assert bpy.context.active_object == sculpt()  # the header's menu has its modes
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
    """Blender crashes if an object is put into the local view of a screen without a window."""
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
    assert stroke.module("sculpt.force_view")._shown is None, "a mouse feels no force, and Show Force is off"
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


def told(screen, before):
    """The messages since the log had so many lines."""
    return "\n".join(lessons.messages(screen)[before:])


def begun_again(screen):
    """A block whose box is its own: Apply Mesh Edits has made the other's larger."""
    stroke.module("sculpt.live_registry").end_all()
    bpy.data.objects.remove(sculpt())
    stroke.cut.stock(screen, 0.5)
    with screen.override():
        bpy.ops.ed.undo_push(message="Stock")
    stroke.tool(screen, "riffler.carve")
    stroke.settings().depth = 1.5
    yield 1.0


def with_force(screen):
    """With Show Force a mask shows none, and a stroke that cuts does."""
    stroke.settings().show_force, shown = True, stroke.module("sculpt.force_view")
    for name, cuts in (("riffler.mask", False), ("riffler.carve", True)):
        stroke.tool(screen, name)
        yield 0.3
        yield from groove(screen, 27, release=False)
        assert stroke.module("sculpt.pointer").held is not None and (shown._shown is not None) == cuts, name
        screen.key("ESC")
        yield lambda: stroke.module("sculpt.pointer").held is None
        stroke.press(screen, *screen.at, "RELEASE")
        yield 0.3
    stroke.settings().show_force = False


def at_the_box(screen):
    """Material that Add puts into a groove is clipped at the block's top, with a message; Grow Box moves no vertex;
    then there is room, and the seam of the added material is sharp everywhere."""
    yield from groove(screen, 16)
    stroke.tool(screen, "riffler.add")
    stroke.settings().depth = 2.5
    yield 0.3
    before, whole = len(lessons.messages(screen)), stroke.volume().to_bytes()
    yield from groove(screen, 16)
    assert CUT_OFF in told(screen, before), told(screen, before)
    screen.key("Z", ctrl=True)
    yield lambda: stroke.volume().to_bytes() == whole
    yield 0.5
    stroke.module("sculpt.live_registry").end_all()
    with screen.override():
        bpy.ops.riffler.detail(detail="ALL")  # whose vertices are on every edge
    yield 0.3
    mesh, mm, wanted = sculpt().data, sculpt().data.riffler.mm_per_unit, box() + 6
    inside = common.coordinates(mesh) * mm
    inside = inside[(inside[:, 2] > 1) & (inside[:, 2] < 19.4) & (np.abs(inside[:, :2] - 30) < 29).all(axis=1)]
    bpy.context.scene.riffler.clay.room, before = 3.0, len(lessons.messages(screen))
    screen.area.tag_redraw()
    yield 0.5
    yield from lessons.press(screen, "riffler.room")
    yield lambda: np.allclose(box(), wanted)
    there = set(map(bytes, np.ascontiguousarray(common.coordinates(sculpt().data) * mm)))
    assert len(inside) > 500 and all(bytes(v) in there for v in np.ascontiguousarray(inside))
    size = stroke.module("common.units").format_size(wanted)
    assert f"The box is {size}" in told(screen, before), told(screen, before)
    before, stroke.settings().depth = len(lessons.messages(screen)), 0.5
    yield from groove(screen, 4)
    assert told(screen, before) == ""
    stroke.module("sculpt.live_registry").end_all()
    yield 0.5
    yield from screen.shot("bead")
    sharp = seam(sculpt().data, mm)
    assert len(sharp) > 60 and sharp.mean() > 0.98, (len(sharp), sharp.mean())


def box():
    """Its sides, mm."""
    return np.subtract(sculpt().data.riffler.upper, sculpt().data.riffler.lower)


CUT_OFF = "The added material was cut off at the stock's box: use Grow Box in Clay to enlarge it"


def seam(mesh, mm):
    """For each edge in which the bead at 4 meets the top at 20: whether it is drawn sharp."""
    co, tri = (common.coordinates(mesh) * mm).astype(float), common.triangles(mesh)
    normals = np.cross(co[tri[:, 1]] - co[tri[:, 0]], co[tri[:, 2]] - co[tri[:, 0]])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    ends = np.sort(np.concatenate([tri[:, [0, 1]], tri[:, [1, 2]], tri[:, [2, 0]]]), axis=1)
    order = np.lexsort(ends.T)
    first, second = order[0::2] % len(tri), order[1::2] % len(tri)
    bend = np.degrees(np.arccos(np.clip((normals[first] * normals[second]).sum(axis=1), -1, 1)))
    at = co[ends[order[0::2]]]
    side = np.sqrt(4.0**2 - 3.5**2)
    here = (np.abs(at[:, :, 2] - 20) < 0.05).all(axis=1) & (np.abs(np.abs(at[:, :, 1] - 4) - side) < 0.3).all(axis=1)
    here &= (np.abs(at[:, :, 0] - 30) < 12).all(axis=1) & (bend > 12)
    if hasattr(mesh, "auto_smooth_angle"):
        return bend[here] > np.degrees(mesh.auto_smooth_angle)
    own, sharp = np.empty((len(mesh.edges), 2), np.int32), np.zeros(len(mesh.edges), bool)
    mesh.edges.foreach_get("vertices", own.ravel())
    mesh.attributes["sharp_edge"].data.foreach_get("value", sharp)
    return sharp[np.lexsort(np.sort(own, axis=1).T)][here]


def in_odd_states(screen):
    """Where a stroke is impossible, a popup has the sentence with the remedy, which works; where the display differs
    from the volume, the stroke warns like STL."""
    stroke.tool(screen, "riffler.carve")
    stroke.settings().depth = 1.5
    way = [tuple(map(int, stroke.pixel(screen, (x, 27, 20)))) for x in (15, 30, 45)]
    sculpt().scale.z = 0
    yield 0.3
    whole, before = stroke.volume().to_bytes(), len(lessons.messages(screen))
    yield from screen.drag(way)
    yield 0.3
    assert refusals.UNFIT[refusals.flat].replace("Sculpt", "Stock") in told(screen, before), told(screen, before)
    assert stroke.volume().to_bytes() == whole and stroke.run() is None
    yield from screen.shot("flat")
    screen.key("ESC")  # closes the message, which would take the next key in Blender 5
    yield 0.3
    lessons.activate(sculpt())
    screen.to_view()
    yield 0.5
    screen.key("S", alt=True)  # Clear > Scale
    yield lambda: sculpt().scale.z == 1
    for state, sentence in ((refusals.under_a_scaled_one, refusals.SCALED), (refusals.modified, refusals.MODIFIED)):
        state(sculpt())
        sculpt().rotation_euler.z = 0.2
        if sculpt().parent:
            sculpt().parent.scale = (0.9, 0.9, 0.9)
        yield 0.5
        before, whole, sentence = len(lessons.messages(screen)), content(), sentence[state].replace("Sculpt", "Stock")
        with lessons.Recorded("sculpt.stroke_operator", "summary") as status:
            yield from groove(screen, 27)
        assert sentence in told(screen, before), told(screen, before)
        assert stroke.volume().volume < whole and status.calls
        stroke.module("sculpt.live_registry").end_all()
        path = common.out("modes.stl")
        with screen.override():
            said = common.printed(lambda path=path: bpy.ops.riffler.export_stl(filepath=path, check_existing=False))
        assert sentence in said, said
        sculpt().modifiers.clear()
        sculpt().parent, sculpt().rotation_euler.z = None, 0
        yield 0.3
    with lessons.Recorded("sculpt.stroke_operator", "summary") as status:
        yield from groove(screen, 20, places=1, release=False)
        stroke.press(screen, *screen.at, "RELEASE")
        yield lambda: stroke.module("sculpt.pointer").held is None
    assert [text for _, text in status.calls if text.endswith(" in 1 move")], status.calls
    stroke.module("sculpt.live_registry").end_all()


def content():
    return stroke.volume().volume


def of_odd_sizes(screen):
    """Finer halves the pitch, and the field follows; a pitch or a margin of 10⁹ mm is refused by a popup."""
    clay = bpy.context.scene.riffler.clay
    clay.pitch = 2.0
    screen.area.tag_redraw()
    yield 0.5
    yield from lessons.press(screen, "riffler.resample", "pitch=0.25")
    yield lambda: sculpt().data.riffler.pitch == 0.25
    assert clay.pitch == 0.25
    whole, faces = stroke.volume().to_bytes(), len(sculpt().data.polygons)
    for field, name, share, words in (
        ("pitch", "riffler.resample", 0.82, "longer than every side of the box"),
        ("room", "riffler.room", 0.75, "take a coarser pitch or a smaller box"),
    ):
        setattr(clay, field, 1e9)
        screen.area.tag_redraw()
        yield 0.5
        before = len(lessons.messages(screen))
        yield from lessons.press(screen, name, share=share)
        yield lambda before=before, words=words: words in told(screen, before)
        screen.key("ESC")  # closes the message
        yield 0.3
        assert stroke.volume().to_bytes() == whole and len(sculpt().data.polygons) == faces
    yield from screen.shot("sizes")
