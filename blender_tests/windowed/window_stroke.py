"""A stroke by mouse in the window: the tool is chosen, its cursor follows the surface, a drag carves, Ctrl-Z undoes it,
a script repeats it, Esc cancels one, F sizes the cutter, and the arrows of force appear and disappear."""

import itertools
from pathlib import Path

import bpy
import numpy as np

from support import common, harness

cut = harness.load(Path(__file__).with_name("window_cut.py"))


def module(name):
    return common.part(name)


def run():
    return module("sculpt.live_registry").of(bpy.data.objects["Stock"])


def volume():
    return module("sculpt.live_registry").content(bpy.data.objects["Stock"]).volume


def settings():
    return bpy.context.scene.riffler.sculpt


def pixel(screen, place):
    """In the window, of a place on the stock (mm)."""
    region = screen.region()
    space = screen.area.spaces.active.region_3d
    matrix = np.array(space.perspective_matrix) @ np.array(bpy.data.objects["Stock"].matrix_world)
    sight = module("sculpt.pure.view_rays").ViewRays(matrix, (region.width, region.height))
    return (sight.project([place])[0] + (region.x, region.y)).round().astype(int)


def press(screen, x, y, value, kind="LEFTMOUSE", **modifiers):
    screen.window.event_simulate(kind, value, x=int(x), y=int(y), **modifiers)


def drag(screen, places, release=True, together=1, **modifiers):
    """Press at the first place, move through the others; places in mm on the stock. `together`: moves between two
    drawings of the window, each of which costs a software renderer 0.1 to 0.5 s."""
    way = [pixel(screen, p) for p in places]
    screen.move(*map(int, way[0]))
    yield 0.3
    press(screen, *way[0], "PRESS", **modifiers)
    yield 0.1
    moves = [a + share * (b - a) for a, b in itertools.pairwise(way) for share in np.linspace(0, 1, 8)[1:]]
    for k, at in enumerate(moves, 1):
        screen.move(*map(int, at))
        if k % together == 0 or k == len(moves):
            yield 0.02
    if release:
        press(screen, *way[-1], "RELEASE", **modifiers)
        yield lambda: module("sculpt.pointer").held is None
    yield 0.5


def tool(screen, name):
    with screen.override():
        assert bpy.ops.wm.tool_set_by_id(name=name) == {"FINISHED"}


def at_rest(screen):
    """While neither the mouse nor the sculpt moves, the view is not drawn."""
    assert run() is not None
    drawn = []
    handler = bpy.types.SpaceView3D.draw_handler_add(lambda: drawn.append(1), (), "WINDOW", "POST_PIXEL")
    screen.area.tag_redraw()
    yield lambda: drawn
    yield 0.5
    before = len(drawn)
    yield 2.0
    bpy.types.SpaceView3D.draw_handler_remove(handler, "WINDOW")
    assert len(drawn) == before, f"{len(drawn) - before} drawings in 2 s without a change"


def handles(screen):
    """The handle of the radius next to the stock, dragged outwards by 10 mm."""
    view = screen.area.spaces.active.region_3d
    view.view_distance *= 1.6
    at = view.view_location.copy()
    view.view_location.x += 30  # or a wide sidebar covers it
    settings().radius = 4.0
    yield 1.0
    middle = np.array([60 + 0.3 * 60, 30, 20])
    base, far = (pixel(screen, middle + np.array([x, 0, 0])) for x in (4, 14))
    along = (far - base) / np.linalg.norm(far - base)
    grip = (base + 18 * along).round().astype(int)
    screen.pixels.find_gizmos()
    for step in (-3, 0):
        screen.move(*map(int, grip + step))
        yield 0.7
    press(screen, *grip, "PRESS")
    yield 0.3
    screen.pixels.find_gizmos(False)
    for share in (0.3, 0.6, 1.0):
        screen.move(*map(int, grip + share * (far - base)))
        yield 0.5
    yield from screen.picture("stroke-5-handle")
    press(screen, *(grip + (far - base)), "RELEASE")
    yield 1.0
    assert abs(settings().radius - 14) < 1.5, settings().radius
    settings().radius, view.view_location = 4.0, at


def at_the_limit(screen):
    """1 N where 1 N is the limit, in a picture; batches are made once for each state."""
    force = module("sculpt.force_view")
    live = module("sculpt.live_registry").begin(bpy.context, bpy.data.objects["Stock"])
    shown = force.begin(1.0, 8.0, live.to_world)
    shown.pose, shown.force = np.array([30.0, 30, 20, 0, 0, 1]), np.array([0.6, 0.0, 0.8])
    shown.torque = np.array([0.0, 0, 5])
    screen.area.tag_redraw()
    yield 1.5
    yield from screen.picture("stroke-6-limit")
    built = force.kept.built
    screen.area.tag_redraw()
    yield 1.5
    assert force.kept.built == built > 0, "nothing has changed: nothing is rebuilt"
    shown.force = 2 * shown.force
    screen.area.tag_redraw()
    yield 1.5
    assert force.kept.built > built
    force.end()
    yield 0.5


def spread(milliseconds):
    low, high = np.percentile(milliseconds, (50, 95))
    return f"{low:.1f} / {high:.1f} ms"


def measure(side, name):
    """The cost of an update that a hand waits for, event by event, without the drawing: a 60 Hz hand on a
    square block."""
    import time

    with_live = module("sculpt.live_registry")
    bpy.ops.riffler.new_stock(source="BLOCK", origin="CENTRE", size=(side, side, 10), pitch=0.25, directions="xyz")
    ob = bpy.context.object
    begin = time.perf_counter()
    live = with_live.begin(bpy.context, ob)
    bpy.context.view_layer.update()
    began = time.perf_counter() - begin
    matrix = np.diag([0.02, 0.02, -0.001, 1.0])
    sight = module("sculpt.pure.view_rays").ViewRays(matrix, (1000, 1000))  # ten pixels a millimetre
    brush, stroke = module("sculpt.pure.brush_stroke"), module("sculpt.pure.stroke_path")
    made = brush.BrushStroke(live, {"kind": "ball", "diameter": 6.0, "length": 30.0}, sight, brush.Choice(depth=0.8))
    live.stages.take_counts()
    waits = []
    looks = 150 if harness.job["measure"] else 90
    for k in range(looks):
        begin = time.perf_counter()
        angle = 0.06 * k  # 20 mm off the middle at 60 events a second: 72 mm/s
        made.add(stroke.Sample(500 + 200 * np.cos(angle), 500 + 200 * np.sin(angle), time=k / 60))
        made.look()
        bpy.context.view_layer.update()
        waits.append(1000 * (time.perf_counter() - begin))
    made.end()
    begin = time.perf_counter()
    live.finish_stroke(bpy.context, "Stroke")
    ended = 1000 * (time.perf_counter() - begin)
    counts = live.stages.take_counts()
    stages = {key: round(value, 2) for key, value in live.stages.milliseconds().items() if key != "draw"}
    per_look = {key: round(value / looks, 1) for key, value in counts.items()}
    triangles = sum(len(o.data.polygons) for o in bpy.data.objects if o.name.startswith("Riffler Chunk"))
    common.figure(f"{name}: triangles; chunks made, s", [triangles, round(began, 2)])
    common.figure(f"{name}: event to look, p50 / p95, {1000 / np.median(waits):.0f} looks a second", spread(waits))
    common.figure(
        f"{name}: stages of a look, ms; counts a look; end of stroke, ms", [stages, per_look, round(ended, 1)]
    )
    begin = time.perf_counter()
    bpy.ops.wm.redraw_timer(type="DRAW_WIN_SWAP", iterations=3)
    common.figure(f"{name}: drawn a second, by this graphics card", round(3 / (time.perf_counter() - begin), 1))
    assert (
        counts["bricks"] / looks < 12 and counts["moves"] / looks > 2.6
    )  # the cost of an update does not grow with the sculpt
    with_live.end_all()
    bpy.data.objects.remove(ob)


def steps(screen):
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    cut_panel = harness.load(Path(__file__).with_name("window_pen.py"))
    cut_panel.only_open("RIFFLER_PT_sculpt", "RIFFLER_PT_tool", "RIFFLER_PT_sculpt_tool")
    yield from cut.open_tab(screen)
    pitch = 0.25 if harness.job["measure"] else 0.5
    cut.stock(screen, pitch)
    with screen.override():
        bpy.ops.ed.undo_push(message="Stock")
    screen.area.spaces.active.region_3d.view_distance *= 0.8
    yield 2.0
    tool(screen, "riffler.carve")
    settings().depth, settings().limit, settings().show_force = 1.5, 2.0, True
    with screen.override():
        bpy.ops.ed.undo_push(message="Settings")  # which undo restores, too
    yield 1.0
    whole = volume().volume

    # the first stroke: held down, so that a picture has the arrows
    yield from drag(screen, [(15, 20, 20), (45, 20, 20)], release=False)
    assert run() is not None and module("sculpt.pointer").held is not None
    yield 1.0
    yield from screen.picture("stroke-1-force")
    end = pixel(screen, (45, 20, 20))
    press(screen, *end, "RELEASE")
    yield lambda: module("sculpt.pointer").held is None
    yield 0.5
    first = volume().volume
    removed, ball, depth = whole - first, 4.0, 1.5
    half = np.arccos((ball - depth) / ball)
    expected = 30 * ball**2 * (half - np.sin(half) * np.cos(half)) + np.pi * depth**2 * (3 * ball - depth) / 3
    assert abs(removed / expected - 1) < 0.03, (removed, expected)  # a pixel is about 0.1 mm
    text, at = module("sculpt.stroke_operator").last, volume().to_bytes()
    stages = run().stages.milliseconds()
    assert all(stages.values()), stages
    told = module("sculpt.panel").looks(run().stages)
    assert "draw " in told[2] and " tiles, " in told[3] and not told[3].startswith("0.0"), told
    name = f"stroke of 8 mm on 60×60×20 mm at {pitch} mm, a look, ms"
    common.figure(name, {k: round(v, 2) for k, v in stages.items()})

    # more, so that the cursor has a surface
    yield from drag(screen, [(15, 40, 20), (30, 34, 20), (45, 42, 20)])
    yield from drag(screen, [(30, 10, 20), (30, 50, 20)], ctrl=True)
    added = volume().volume
    screen.move(*map(int, pixel(screen, (24, 20, 18.5))))
    yield 1.0
    yield from screen.picture("stroke-2-cursor")
    yield from at_rest(screen)

    # a cancelled drag leaves nothing
    before = volume().to_bytes()
    yield from drag(screen, [(10, 52, 20), (50, 52, 20)], release=False)
    assert volume().volume < added
    screen.key("ESC")
    yield lambda: module("sculpt.pointer").held is None
    press(screen, *pixel(screen, (50, 52, 20)), "RELEASE")
    yield 1.0
    assert volume().to_bytes() == before

    # undo, stroke by stroke; then a script repeats the first one, to the byte
    screen.to_view()
    for _ in range(3):
        screen.key("Z", ctrl=True)
        yield 1.5
    assert volume().volume == whole
    with screen.override():
        assert bpy.ops.riffler.stroke(stroke=text) == {"FINISHED"}
    assert volume().to_bytes() == at
    yield 0.5

    # F: twice the distance from the centre of the circle is twice the width
    x, y = pixel(screen, (30, 30, 20))
    screen.move(int(x), int(y))
    yield 1.0
    scale, before = module("sculpt.pointer").pixels_per_mm, settings().radius
    press(screen, x, y, "PRESS", kind="F")
    yield 0.5
    screen.move(int(x + 3 * scale), int(y))
    yield 0.5
    yield from screen.picture("stroke-3-size")
    press(screen, x + 3 * scale, y, "PRESS")
    press(screen, x + 3 * scale, y, "RELEASE")
    yield 1.0
    assert abs(settings().radius - before - 3) < 0.5, (before, settings().radius, scale)

    # the pie
    screen.move(int(x), int(y))
    press(screen, x, y, "PRESS", kind="W")
    press(screen, x, y, "RELEASE", kind="W")
    yield 1.0
    for step in (4, -4, 4):  # it opens gradually, a bit with every event
        screen.move(int(x + step), int(y))
        yield 1.0
    yield from screen.picture("stroke-4-pie")
    screen.key("ESC")
    yield 1.0
    yield from handles(screen)
    yield from at_the_limit(screen)
    module("sculpt.live_registry").end_all()
    yield 1.0
    assert bpy.data.objects["Stock"].visible_get()
    yield from screen.picture("stroke-7-ended")

    with screen.override():
        for side, name in ((55.0, "250 k"), (115.0, "1 M"))[: 2 if harness.job["measure"] else 1]:
            measure(side, name)
            yield 1.0
