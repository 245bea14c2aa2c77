"""A user's mouse and keyboard on a sculpt, from outside, by xdotool: a drag carves, Ctrl Z and Ctrl Shift Z, a drag
cancelled by Esc, Ctrl S; the file is opened again, has the sculpt to the byte, and the next drag carves on."""

import subprocess
import tempfile
from pathlib import Path

import bpy
import numpy as np

from support import common, harness
from support.sculpting import matches_its_volume, nothing_is_left

REAL_EVENTS = True
PIXELS = False
NAME = "Stock"

strokes = harness.load(Path(__file__).with_name("window_stroke.py"))
run, pixel = strokes.run, strokes.pixel


def content():
    return strokes.volume().to_bytes()


def held():
    return common.part("sculpt.pointer").held is not None


def drag(screen, first, last, release=True):
    """A stroke between two places (mm of the stock); the stroke's own samples begin and end at their pixels."""
    a, b = pixel(screen, first), pixel(screen, last)
    screen.move(*a)
    yield 0.3
    screen.button("PRESS")
    yield held  # the sculpt's first stroke takes a while to begin
    for share in np.linspace(0, 1, 12)[1:]:
        screen.move(*(a + share * (b - a)).round())
        yield 0.05
    if not release:
        return
    screen.button("RELEASE")
    yield lambda: not held()
    yield 0.5
    _, samples, _ = common.part("sculpt.pure.brush_stroke").read(common.part("sculpt.stroke_operator").last)
    region = screen.region()
    for sample, wanted in ((samples[0], a), (samples[-1], b)):
        assert (sample.x + region.x, sample.y + region.y) == tuple(wanted), (sample, wanted)
        assert sample.pressure == 1, "a mouse has none"


def typed(screen, expected, **modifiers):
    """Z with modifiers, which must restore the volume `expected` (bytes)."""
    screen.key("Z", **modifiers)
    yield lambda: content() == expected
    yield 0.5


def begin(screen, path):
    """A stock in a file of its own, and the tool."""
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    strokes.cut.stock(screen, 0.5)
    strokes.tool(screen, "riffler.carve")
    strokes.settings().depth = 1.5
    with screen.override():
        bpy.ops.ed.undo_push(message="Stock")
        bpy.ops.wm.save_as_mainfile(filepath=str(path))
    yield 2.0


def save(screen, path):
    """Ctrl S, without a dialog, since the file has a name."""
    before = path.stat().st_mtime_ns
    assert bpy.data.is_dirty, "a stroke is a change that Blender asks about when it is closed"
    screen.key("S", ctrl=True)
    yield lambda: not bpy.data.is_dirty
    assert path.stat().st_mtime_ns > before
    yield 0.5


def reopen(screen, path):
    """Through a new file, so that only the file's content is left."""
    with screen.override():
        bpy.ops.wm.read_homefile()
    yield 1.0
    assert NAME not in bpy.data.objects
    nothing_is_left()
    with screen.override():
        bpy.ops.wm.open_mainfile(filepath=str(path))
    yield 2.0
    assert run() is None
    nothing_is_left()
    matches_its_volume(NAME)
    tool = screen.window.workspace.tools.from_space_view3d_mode("OBJECT").idname
    assert tool == "riffler.carve", tool


def steps(screen):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "hand.blend"
        yield from begin(screen, path)
        yield from carved_and_undone(screen)
        yield from give_up(screen)
        yield from without_ribs(screen)
        carved = content()
        yield from save(screen, path)
        assert content() == carved
        yield from reopen(screen, path)
        assert content() == carved, "the file has another volume than was carved"
        yield from carve_on(screen)


def carved_and_undone(screen):
    """Two strokes, which Ctrl Z undoes one after the other, and Ctrl Shift Z redoes."""
    states = [content()]
    for y in (15, 45):
        yield from drag(screen, (15, y, 20), (45, y, 20))
        states.append(content())
    assert len(set(states)) == 3, "a stroke has carved nothing"
    for expected in states[1::-1]:
        yield from typed(screen, expected, ctrl=True)
    for expected in states[1:]:
        yield from typed(screen, expected, ctrl=True, shift=True)


def give_up(screen):
    """Esc while the button is held: everything is restored, and the button's release does nothing."""
    before = content()
    yield from drag(screen, (15, 30, 20), (45, 30, 20), release=False)
    yield lambda: content() != before
    screen.key("ESC")
    yield lambda: not held()
    screen.button("RELEASE")
    yield 1.0
    assert content() == before and not held()


def without_ribs(screen):
    """Whole pixels of a slow hand, at an angle: the tool's path does not turn with each of them, and the groove's floor
    lies on the hand's own path."""
    a, b = pixel(screen, (8, 24, 20)), pixel(screen, (52, 36, 20))
    screen.move(*a)
    yield 0.3
    screen.button("PRESS")
    yield held
    hand = np.linspace(a, b, int(np.abs(b - a).max() / 3)).round().astype(int)
    words = [w for x, y in hand for w in ("mousemove", x, screen.window.height - 1 - y, "sleep", 0.01)]
    moving = subprocess.Popen(["xdotool", *map(str, words)])
    yield lambda: moving.poll() is not None
    yield 0.2
    screen.button("RELEASE")
    yield lambda: not held()
    yield 0.5
    ball, depth, ends = 4.0, 1.5, [on_top(screen, at) for at in (a, b)]
    poses = strokes.module("sculpt.live_registry").content(bpy.data.objects[NAME]).cuts[-1].poses
    middles = poses[:, :3] + ball * poses[:, 3:]
    steps_ = np.diff(middles, axis=0)
    steps_ = steps_[np.linalg.norm(steps_, axis=1) > 1e-9]
    way = steps_ / np.linalg.norm(steps_, axis=1)[:, None]
    turns = np.degrees(np.arccos(np.clip((way[1:] * way[:-1]).sum(axis=1), -1, 1)))[3:-3]
    assert len(turns) > 30 and turns.max() < 8, np.sort(turns)[-5:]
    begin, along = ends[0] + (0, 0, ball - depth), ends[1] - ends[0]
    length = np.linalg.norm(along)
    surface = np.asarray(strokes.volume().to_mesh().vertices, float) - begin
    at = surface @ along / length
    apart = surface - at[:, None] * along / length
    size = np.linalg.norm(apart, axis=1)
    rim = np.arccos((ball - depth) / ball)
    floor = (at > 2) & (at < length - 2) & (np.arccos(np.clip(-apart[:, 2] / size, -1, 1)) < 0.5 * rim)
    off = (size - ball)[floor & (np.abs(size - ball) < 1)]
    common.figure(
        "floor of a slow mouse's groove, off the hand's own, pitches", round(float(np.abs(off).max() / 0.5), 3)
    )
    assert len(off) > 300 and np.abs(off).max() <= 0.1 * 0.5, np.abs(off).max()


def on_top(screen, at):
    """The place on the stock's top (mm) at a pixel of the window."""
    region = screen.region()
    matrix = np.array(screen.area.spaces.active.region_3d.perspective_matrix)
    sight = strokes.module("sculpt.pure.view_rays").ViewRays(matrix, (region.width, region.height))
    origin, way = sight.ray(at[0] - region.x, at[1] - region.y)
    return origin + (20 - origin[2]) / way[2] * way


def carve_on(screen):
    """A stroke on the opened sculpt, across those in the file; Ctrl Z undoes that one only."""
    saved, whole = content(), strokes.volume().volume
    yield from drag(screen, (30, 10, 20), (30, 50, 20))
    assert run() is not None and strokes.volume().volume < whole
    carved = content()
    yield from typed(screen, saved, ctrl=True)
    yield from typed(screen, carved, ctrl=True, shift=True)
