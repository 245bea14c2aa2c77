"""Shared by the tutorials' scripts: buttons are found by pointing at them, and pictures are cropped and scaled down.

A tutorial_*.py follows its page in docs/, in the same order, and its pictures are the page's: `make tutorials` copies
them there.
"""

import itertools
import subprocess
from pathlib import Path
from typing import ClassVar

import bpy
import numpy as np
import riffler

from support import common, harness, report

HERE = Path(__file__).resolve().parent
cut = harness.load(HERE / "window_cut.py")
PAGES = bool(harness.job.get("smooth"))  # pictures are for the pages
COLOURS = 128  # of a picture's palette: at most 250 kB for a whole window
PIE = {"riffler.carve": (-1, 0), "riffler.add": (1, 0), "riffler.smooth": (0, -1), "riffler.mask": (0, 1)}
STEP = 12  # pixels between two positions on a panel's buttons: less than a button's height


def module(name):
    return common.part(name)


def messages(screen):
    """Lines of Blender's log of messages, the newest last: texts of popups and the status bar. It does not have reports
    of calls from scripts, only of operators started by mouse or keyboard, or of work in the background."""
    area = next(a for a in screen.window.screen.areas if a.type in ("DOPESHEET_EDITOR", "OUTLINER", "PROPERTIES"))
    before, area.type = area.type, "INFO"
    try:
        shown = area.spaces.active
        shown.show_report_info = shown.show_report_warning = shown.show_report_error = True
        shown.show_report_operator = shown.show_report_debug = False
        with bpy.context.temp_override(window=screen.window, area=area, region=area.regions[-1]):
            bpy.ops.info.select_all(action="SELECT")
            bpy.ops.info.report_copy()
    finally:
        area.type = before
    lines = bpy.context.window_manager.clipboard.splitlines()
    return [line for line in lines if not line.startswith("bpy.")]  # it also has the calls


class Recorded:
    """Within it, calls of one of the add-on's functions are recorded: (arguments, return value)."""

    def __init__(self, part, name):
        self._part, self._name, self.calls = module(part), name, []

    def __enter__(self):
        self._function = getattr(self._part, self._name)

        def keeping(*arguments, **more):
            result = self._function(*arguments, **more)
            self.calls.append((arguments, result))
            return result

        setattr(self._part, self._name, keeping)
        return self

    def __exit__(self, *_):
        setattr(self._part, self._name, self._function)

    def texts(self):
        """All texts among the arguments, in the order of the calls."""
        return [text for arguments, _ in self.calls for text in arguments if isinstance(text, str)]


def plain_window():
    """As for a user, except for what would disturb a picture."""
    preferences = bpy.context.preferences
    preferences.view.show_tooltips = False
    preferences.view.show_splash = False
    preferences.view.show_developer_ui = True  # buttons show their operators


def picture(screen, name, box=None):
    """Steps: <out>/tutorials/<name>.png for the pages, of the whole window or of a box (left, below, right, above) of
    window pixels, if run.py has --smooth. Otherwise the window is drawn without filling it: nothing compares it."""
    whole = 0, 0, screen.window.width, screen.window.height
    left, below, right, above = (int(x) for x in box or whole)
    assert 0 <= left < right <= whole[2] and 0 <= below < above <= whole[3], (box, whole)
    if not PAGES:
        for area in screen.window.screen.areas:
            area.tag_redraw()
        yield 0.2
        return
    folder = screen.out / "tutorials"
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name}.png"
    screen.draw_smoothly(True)
    yield 0.4  # what still moves comes to rest before it is filled
    yield from screen.pixels.fill_again(screen.window)
    crop = f"{right - left}x{above - below}+{left}+{whole[3] - above}"
    command = ["import", "-window", "root", "-crop", crop, "+repage"]
    subprocess.run([*command, "-strip", "+dither", "-colors", str(COLOURS), f"PNG8:{path}"], check=True)
    screen.draw_smoothly(False)
    screen.pixels.kept = False
    size = path.stat().st_size
    assert 2_000 < size < 250_000, f"{path}: {size} bytes"


def view_box(screen):
    """The 3D view with its sidebar."""
    a = screen.area
    return a.x, a.y, a.x + a.width, a.y + a.height


ASIDE = (-0.06, -0.03, 0.03, 0.06)  # shares of a sidebar's width, from where Blender 3.4 has a button


class Look(bpy.types.Operator):
    """Records the command of the button under the mouse, or "", by the mouse's height."""

    bl_idname = "wm.riffler_test_look"
    bl_label = "Look"
    KEY = "F19"
    seen: ClassVar[dict[int, str]] = {}

    def invoke(self, context, pointer):
        context.window_manager.clipboard = ""
        if bpy.ops.ui.copy_python_command_button.poll():
            bpy.ops.ui.copy_python_command_button()
        self.seen[pointer.mouse_y] = context.window_manager.clipboard
        return {"FINISHED"}


def enable_looking():
    """Once in a Blender: KEY records a button, over any panel."""
    if not hasattr(bpy.types, "WM_OT_riffler_test_look"):
        bpy.utils.register_class(Look)
        keymap = bpy.context.window_manager.keyconfigs.addon.keymaps.new("User Interface")
        keymap.keymap_items.new(Look.bl_idname, Look.KEY, "PRESS")


def commands(screen, x, heights):
    """Steps: {height: command} of the buttons there, by events that Blender handles together, between two drawings:
    each drawing costs a software renderer 40 ms. A button that the mouse leaves takes one move, and the next button
    another. A field for text or for an object handles the key itself, and has no entry."""
    Look.seen.clear()
    for y in heights:
        screen.move(x, y)
        screen.move(x + 1, y)
        for value in ("PRESS", "RELEASE"):
            event(screen, Look.KEY, value, screen.at)
    yield 0.2
    return dict(Look.seen)


def found(screen, region, words, share):
    """Steps: moves the mouse over the first button of a region, at or near a share of its width, whose command has all
    `words`; scrolls to buttons further down."""
    enable_looking()
    middle = (region.x + int(region.width * share), region.y + region.height // 2)
    heights = range(region.y + region.height - 8, region.y + 8, -STEP)
    seen = set()
    for columns in ((share,), tuple(share + aside for aside in ASIDE)):
        for turns in (-60, 12, 12, 12):
            for _ in range(abs(turns)):
                event(screen, "WHEELDOWNMOUSE" if turns > 0 else "WHEELUPMOUSE", "PRESS", middle)
            yield 0.3
            for column in columns:
                x = region.x + int(region.width * column)
                there = yield from commands(screen, x, heights)
                seen.update(there.values())
                fitting = [y for y in heights if all(word in there.get(y, "") for word in words)]
                if fitting:
                    screen.move(x, fitting[0])
                    yield 0.1
                    there = yield from commands(screen, x, fitting[:1])
                    if all(word in there.get(fitting[0], "") for word in words):
                        return
                    # What was drawn late has moved the button since.
    yield from screen.shot("no-button")
    raise AssertionError(f"no button has {words}; there are {sorted(seen)}")


def press(screen, *words, region="UI", share=0.6):
    """Clicks the button of an operator in the sidebar; `share`: its horizontal place in a row of several."""
    yield from found(screen, screen.region(region), words, share)
    screen.click(*screen.at)
    yield 0.3


def begin(screen, millimetres=True):
    """A new file as Blender opens it: our tab opened, all deleted, millimetres set; by hand unless the button is in a
    collapsed panel."""
    plain_window()
    yield from cut.open_tab(screen)
    screen.to_view()
    yield 0.3
    screen.key("A")
    yield 0.2
    screen.key("DEL")
    yield lambda: not bpy.data.objects
    if millimetres:
        yield from press(screen, "riffler.millimetres")
    else:
        with screen.override():
            bpy.ops.riffler.millimetres()
    assert np.isclose(bpy.context.scene.unit_settings.scale_length, 0.001)
    screen.to_view()
    yield 0.5


def tool(screen, name):
    """Clicks a tool's button in the toolbar."""
    for _ in range(3):  # a busy window may miss a click
        yield from press(screen, "tool_set_by_id", f'"{name}"', region="TOOLS")
        yield 1.0
        active = bpy.context.workspace.tools.from_space_view3d_mode("OBJECT", create=False)
        if active.idname == name:
            return
    raise AssertionError(f"{active.idname} instead of {name}")


def pie(screen, name):
    """W over the view, and one of the four tools of the pie menu."""
    x, y = (PIE[name][k] * 70 for k in (0, 1))
    screen.to_view()
    at = np.array(screen.at)
    event(screen, "W", "PRESS", at)
    event(screen, "W", "RELEASE", at)
    yield 0.8
    for share in (0.5, 0.9, 1.0):
        screen.move(*map(int, at + share * np.array((x, y))))
        yield 0.3
    screen.button("PRESS")
    screen.button("RELEASE")
    yield lambda: bpy.context.workspace.tools.from_space_view3d_mode("OBJECT", create=False).idname == name


def pixel(screen, ob, place):
    """In the window, of a place (mm) in an object's frame."""
    region, space = screen.region(), screen.area.spaces.active.region_3d
    matrix = np.array(space.perspective_matrix) @ np.array(ob.matrix_world)
    sight = module("sculpt.pure.view_rays").ViewRays(matrix, (region.width, region.height))
    return (sight.project([place])[0] + (region.x, region.y)).round().astype(int)


def event(screen, kind, value, at, **modifiers):
    screen.window.event_simulate(kind, value, x=int(at[0]), y=int(at[1]), **modifiers)


def brushed(screen, ob, places, steps=6, hold="", together=1, **modifiers):
    """A stroke with the left button through places (mm, the object's frame); `hold`: a picture before it ends;
    `together`: so many moves of the mouse between two drawings of the window."""
    way = [pixel(screen, ob, p) for p in places]
    screen.move(*map(int, way[0]))
    yield 0.15
    event(screen, "LEFTMOUSE", "PRESS", way[0], **modifiers)
    yield 0.05
    moves = [a + share * (b - a) for a, b in itertools.pairwise(way) for share in np.linspace(0, 1, steps + 1)[1:]]
    for k, at in enumerate(moves, 1):
        screen.move(*map(int, at))
        if k % together == 0 or k == len(moves):
            yield 0.01
    if hold:
        yield 1.0
        yield from picture(screen, hold, view_box(screen))
    event(screen, "LEFTMOUSE", "RELEASE", way[-1], **modifiers)
    yield lambda: module("sculpt.pointer").held is None
    yield 0.1


def volume(ob):
    return module("sculpt.live_registry").content(ob).volume


def only_open(*names):
    """The tab with these panels open and all others collapsed; before its first drawing."""
    harness.load(HERE / "window_pen.py").only_open(*names)


def cutter(name):
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
        assert bpy.ops.riffler.tool_preset(name=name) == {"FINISHED"}


def idle():
    return not bpy.context.window_manager.riffler.running


def closed(path, expected, within):
    """An STL's surface: closed, and of the expected volume (mm³) within a share."""
    surface = riffler.Mesh.read(str(path))
    audit = surface.audit()
    assert audit.open_edges == 0, audit
    assert abs(surface.volume / expected - 1) < within, (surface.volume, expected)
    return surface


def block(screen, size):
    """New Stock with its zero in the middle of its top: fine for the pages' pictures, otherwise coarse."""
    pitch = 0.25 if PAGES else 0.5
    with screen.override():
        bpy.ops.riffler.new_stock("INVOKE_DEFAULT", True, source="BLOCK", size=size, origin="TOP", pitch=pitch)
    screen.area.spaces.active.region_3d.view_distance *= 1.25
    return bpy.context.object


def aside(screen):
    """Steps: moves the centre of the view to the centre of the part not covered by the sidebar."""
    yield 0.5  # the matrix is that of the last drawing
    region, view = screen.region(), screen.area.spaces.active.region_3d
    sight = module("sculpt.pure.view_rays").ViewRays(np.array(view.perspective_matrix), (region.width, region.height))
    pixels = screen.region("UI").width / 2 / sight.pixels_per_unit(np.array(view.view_location))
    view.view_location += pixels * view.view_rotation.to_matrix().col[0]
    yield 0.3


def activate(ob):
    """Like a click on it in the outliner."""
    for other in bpy.context.view_layer.objects:
        other.select_set(False)
    ob.select_set(True)
    bpy.context.view_layer.objects.active = ob


def hidden(screen, ob):
    """Steps: a click on the eye next to a name in the outliner, of a scene with one collection."""
    area = next(a for a in screen.window.screen.areas if a.type == "OUTLINER")
    region = next(r for r in area.regions if r.type == "WINDOW")
    system = bpy.context.preferences.system
    line = round(18 * system.ui_scale) + 2 * system.pixel_size
    row = 2 + sorted(o.name.lower() for o in bpy.context.view_layer.objects).index(ob.name.lower())
    screen.click(region.x + region.width - 2.05 * line, region.y + region.height - (row + 0.6) * line)
    yield 0.5
    assert ob.hide_get(), f"{ob.name}: the eye is not in row {row} of lines of {line}"
    screen.to_view()


def interpreted(path, rows):
    """LinuxCNC's interpreter accepts the program and finds at least so many feed moves; without it, the test counts as
    skipped."""
    judge = harness.load(HERE.parent / "headless" / "program" / "test_plan_nc.py")
    try:
        feeds = judge.interpreted(Path(path))
    except common.Skip as reason:
        report.say(name=f"{Path(path).name}, interpreted", outcome="skipped", seconds=0, message=str(reason))
        return
    assert len(feeds) >= rows, (len(feeds), rows)
