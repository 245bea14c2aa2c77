"""Stock of too few rays, of facets and of invalid sizes, by the panel's button. Then work whose file is chosen first:
the selector opens, the work runs in the background, Esc leaves no file."""

import time
from pathlib import Path

import bpy
import numpy as np
from riffler import threemf_writer

from support import common, harness

cut = harness.load(Path(__file__).with_name("window_cut.py"))
lessons = harness.load(Path(__file__).with_name("lessons.py"))
STOCK = {"source": "BLOCK", "size": (100, 60, 30), "pitch": 0.5, "directions": "xyz"}


def running():
    return bpy.context.window_manager.riffler.running


def selectors():
    return [(w, a) for w in bpy.context.window_manager.windows for a in w.screen.areas if a.type == "FILE_BROWSER"]


def typed(params, wanted):
    """Whether folder and name are the wanted ones. If not, they are typed: a selector that is drawn late fills in its
    own."""
    if (params.directory.rstrip(b"/"), params.filename) == wanted:
        return True
    params.directory, params.filename = wanted
    return False


def choose(screen, operator, path, name=None, shot="", **more):
    """The operator's button, the file in the selector that opens, and its button: steps to `yield from`. `name`: if not
    that of the path. `shot`: the name of a picture of the selector."""
    path = Path(path)
    with screen.override():
        assert operator("INVOKE_DEFAULT", **more) == {"RUNNING_MODAL"}
    yield lambda: selectors() and selectors()[0][1].spaces.active.params is not None
    yield 0.5
    window, area = selectors()[0]
    wanted = str(path.parent).encode(), path.name if name is None else name
    yield lambda: typed(area.spaces.active.params, wanted)
    yield 0.5
    yield lambda: typed(area.spaces.active.params, wanted)
    if shot:
        yield from screen.shot(shot)
    region = next(r for r in area.regions if r.type == "WINDOW")
    with bpy.context.temp_override(window=window, area=area, region=region):
        bpy.ops.file.execute("INVOKE_DEFAULT")
    yield lambda: not selectors()


def steps(screen):
    bpy.context.preferences.view.filebrowser_display_type = "SCREEN"
    yield from cut.open_tab(screen)
    with screen.override():
        bpy.ops.riffler.millimetres()
    yield from of_few_rays(screen)
    yield from of_facets(screen)
    yield from of_odd_sizes(screen)
    yield from without_a_name(screen)
    with screen.override():
        bpy.ops.riffler.new_stock(**STOCK)
    yield from written(screen)
    yield from cancelled(screen)
    yield from no_recording(screen)
    yield from recording(screen)


def of_few_rays(screen):
    """Suzanne in millimetres, at a fine pitch: the panel warns that there will be no details, and so does the report;
    one button fixes it."""
    stock, before = bpy.context.scene.riffler.stock, bpy.context.scene.riffler.tool.dictionary()
    stock.source, stock.pitch = "OBJECT", 0.06
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    with screen.override():
        bpy.ops.mesh.primitive_monkey_add("EXEC_DEFAULT", True, size=2)
        bpy.ops.view3d.view_selected()
        bpy.ops.ed.undo_push(message="Suzanne")
    with lessons.Recorded("stock.panel", "lines") as panel:
        screen.to_view()
        yield 1.0
    said = " ".join(panel.texts())
    assert "Longest side 2.734 mm: only 46 rays, so no details. the cutter is large, 6 mm." in said, said
    log = len(lessons.messages(screen))
    yield from lessons.press(screen, "riffler.new_stock")
    yield lambda: "Suzanne Stock" in bpy.data.objects and not running()
    said = "\n".join(lessons.messages(screen)[log:])
    assert "Suzanne Stock has 46 rays along its longest side, so no details: undo, and use Fit Pitch" in said, said
    screen.to_view()
    screen.key("Z", ctrl=True)
    yield lambda: "Suzanne Stock" not in bpy.data.objects
    yield from lessons.press(screen, "riffler.make_sculpt")
    yield 0.3
    yield from screen.shot("few-rays")
    for value in ("PRESS", "RELEASE"):
        lessons.event(screen, "RET", value, screen.at)
    yield lambda: "Suzanne Stock" in bpy.data.objects
    made, cutter = bpy.data.objects["Suzanne Stock"].data.riffler, bpy.context.scene.riffler.tool.diameter
    side = max(u - low for low, u in zip(made.lower, made.upper, strict=True))
    assert side / made.pitch > 120 and side / 12.5 < cutter < side / 4, (side, made.pitch, cutter)
    screen.to_view()
    screen.key("Z", ctrl=True)
    yield lambda: "Suzanne Stock" not in bpy.data.objects
    assert abs(bpy.context.scene.unit_settings.scale_length - 0.001) < 1e-9
    bpy.context.scene.riffler.tool.take(before)
    bpy.data.objects.remove(bpy.data.objects["Suzanne"])


def of_facets(screen):
    """Blender's own sphere, with Round Facets in the panel: the button makes a ball of it."""
    stock = bpy.context.scene.riffler.stock
    stock.source, stock.pitch, stock.rounded = "OBJECT", 0.5, True
    with screen.override():
        bpy.ops.mesh.primitive_uv_sphere_add("EXEC_DEFAULT", True, radius=20)
        bpy.ops.ed.undo_push(message="Sphere")
    screen.to_view()
    yield 0.5
    yield from lessons.press(screen, "riffler.new_stock")
    yield lambda: "Sphere Stock" in bpy.data.objects and not running()
    off = np.linalg.norm(common.coordinates(bpy.data.objects["Sphere Stock"].data), axis=1) - 20
    assert np.abs(off).max() < 0.02, np.abs(off).max()
    yield from screen.shot("facets")
    bpy.data.objects.remove(bpy.data.objects["Sphere Stock"])
    bpy.data.objects.remove(bpy.data.objects["Sphere"])
    stock.rounded = False


NONSENSE = (
    ({"size": (-5, 60, 30)}, "Size along x is 0.001 mm, less than the pitch of 0.5 mm: make it larger"),
    ({"size": (100, 60, 30), "pitch": 1000}, "Size along x is 100 mm, less than the pitch of 1000 mm"),
    ({"size": (0.4, 10, 10), "pitch": 1}, "Size along x is 0.4 mm, less than the pitch of 1 mm"),
    ({"size": (1e5, 1e5, 1e5), "pitch": 0.001}, "take a coarser pitch"),
)


def of_odd_sizes(screen):
    """New Stock with fields as a user has typed them: each is refused by its name, and nothing is made."""
    stock, there = bpy.context.scene.riffler.stock, len(bpy.data.objects)
    for fields, words in NONSENSE:
        stock.source, stock.pitch = "BLOCK", 0.5
        for name, value in fields.items():
            setattr(stock, name, value)
        screen.area.tag_redraw()
        yield 0.3
        log = len(lessons.messages(screen))
        yield from lessons.press(screen, "riffler.new_stock")
        said = lessons.messages(screen)[log:]
        assert len(said) == 1 and words in said[0], said
        assert len(bpy.data.objects) == there
        screen.key("ESC")  # closes the message, which covers the sidebar in Blender 5
        yield 0.3
    yield from screen.shot("sizes")
    screen.to_view()
    yield 0.5


def without_a_name(screen):
    """The selector's button with no name: the message names the folder, and the remedy."""
    with screen.override():
        bpy.ops.riffler.new_stock(source="BLOCK", size=(20, 20, 20), pitch=1.0, directions="z")
    log = len(lessons.messages(screen))
    yield from choose(screen, bpy.ops.riffler.export_stl, f"{common.out('')}/", name="")
    yield 0.5
    said = "\n".join(lessons.messages(screen)[log:])
    assert "is a folder: give the file a name" in said and not said.startswith(". "), said
    bpy.data.objects.remove(bpy.data.objects["Stock"])
    screen.to_view()
    yield 0.3


def written(screen):
    """Both formats, by the selector."""
    for operator in (bpy.ops.riffler.export_stl, bpy.ops.riffler.export_3mf):
        path = Path(common.out(f"chosen.{operator.idname()[-3:]}"))
        path.unlink(missing_ok=True)
        yield from choose(screen, operator, path, shot=operator.idname()[-10:])
        yield path.exists
        yield lambda: not running()
        assert path.stat().st_size > 5_000


class Endless:
    """A file's first piece, then nothing more, in the form of a generator. A window that draws slowly gets long slices
    of work, and a whole file could be written before the driver looks again."""

    def __init__(self, pieces):
        self._pieces, self._begun = pieces, False

    def send(self, _):
        if self._begun:
            time.sleep(0.001)
        else:
            self._begun = True
            next(self._pieces)

    def close(self):
        self._pieces.close()


def cancelled(screen):
    """Esc: no file, and no leftovers next to it; an existing file stays."""
    path = Path(common.out("chosen.3mf"))
    # Other windows write into the same folder.
    before, beside = path.read_bytes(), set(path.parent.glob("*chosen*"))
    pieces = threemf_writer.pieces
    threemf_writer.pieces = lambda *words: Endless(pieces(*words))
    try:
        yield from choose(screen, bpy.ops.riffler.export_3mf, path, check_existing=False)
        yield lambda: running() == "Exporting"
        assert not bpy.ops.riffler.export_stl.poll()  # one long work at a time
        screen.key("ESC")
        yield lambda: not running()
    finally:
        threemf_writer.pieces = pieces
    assert path.read_bytes() == before and set(path.parent.glob("*chosen*")) == beside


def no_recording(screen):
    """An invalid file is reported with the message of the code that detects it, and nothing runs."""
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
    """Strokes from a file: in the background, and one undo step."""
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
