"""docs/pencil-cut.md: part, clamp, tool; path, keys by click, by dial and in the map; resolved, written, simulated,
verified."""

from pathlib import Path

import bpy
import numpy as np

from support import common, harness

HERE = Path(__file__)
lessons = harness.load(HERE.with_name("lessons.py"))
gizmo = harness.load(HERE.with_name("window_gizmo.py"))
line = gizmo.line
# Inclination and tilt at the key by the clamp, degrees: one of two with the least tilt, with which the clamp is hit
# further along, and one that stays clear of it on the whole path.
LEAST, CLEAR = (-30.0, 22.5), (0.0, 37.5)
CENTRES = np.array([17.0, 11.0])  # y and z of the ball along the valley: 3 mm off wall and plate


def steps(screen):
    yield from lessons.begin(screen)
    yield from higher_timeline(screen, 45)
    part = made_part(screen)
    clamp = cube(screen, "Clamp", (8, 4, 20), (10, 10, 24))
    stock = made_stock(screen, part)
    with screen.override():
        bpy.ops.view3d.view_all()
    look(screen, (1.0, -0.5, 0.6), (30, 2, 24))
    yield from lessons.cut.open_tab(screen, "RIFFLER_PT_plan")
    yield from set_up(screen, part, clamp)
    ob = yield from searched(screen)
    near = yield from keyed(screen, ob)
    yield from turned(screen)
    yield from resolved(screen, ob)
    yield from turned_again(screen, near)
    yield from to_code(screen, ob)
    yield from simulated(screen, stock)
    yield from verified(screen, stock)


def look(screen, direction, at):
    """Views from a direction, with a place (mm) in the middle of the view."""
    view = screen.area.spaces.active.region_3d
    view.view_rotation = gizmo.Vector(direction).to_track_quat("Z", "Y")
    view.view_distance, view.view_location = 140, at


def cube(screen, name, middle, size):
    """A cube from the menu; Dimensions and Location in the sidebar set its size and place."""
    with screen.override():
        bpy.ops.mesh.primitive_cube_add("INVOKE_DEFAULT", True)
    ob = bpy.context.object
    assert np.allclose(ob.dimensions, 2000), ob.dimensions[:]
    ob.name, ob.dimensions, ob.location = name, size, middle
    bpy.context.view_layer.update()
    return ob


def made_part(screen):
    """A plate and a wall, joined: their inner edge is the valley."""
    plate = cube(screen, "Part", (30, 20, 4), (60, 40, 8))
    wall = cube(screen, "Wall", (30, 30, 13), (60, 20, 22))
    wall.select_set(True)
    bpy.context.view_layer.objects.active = plate
    plate.select_set(True)
    bpy.ops.object.join()
    bpy.ops.object.transform_apply(location=True, rotation=True, scale=True)
    return bpy.context.object


def made_stock(screen, part):
    """The stock after roughing: the part with about half a millimetre more."""
    lessons.activate(part)
    bpy.ops.object.duplicate()
    rough = bpy.context.object
    rough.name = "Rough"
    rough.modifiers.new("Displace", "DISPLACE").strength = 0.9
    bpy.ops.riffler.new_stock(source="OBJECT", pitch=0.5, directions="xyz")
    stock = bpy.context.object
    stock.hide_set(True)
    bpy.context.scene.riffler.verify.stock = stock
    return stock


def set_up(screen, part, clamp, name="pencil-cut-1"):
    """Part, fixture and tool by their buttons; `name`: of the picture, or ""."""
    settings = bpy.context.scene.riffler.plan
    lessons.activate(part)
    yield from lessons.press(screen, "riffler.plan_part", share=0.785)
    assert settings.part == part
    lessons.activate(clamp)
    yield from lessons.press(screen, "riffler.plan_fixtures_add", share=0.7)
    assert clamp.name in settings.fixtures.objects
    with screen.override():
        assert bpy.ops.riffler.plan_tool(name="Ball 6 mm") == {"FINISHED"}
        done = bpy.ops.riffler.plan_assembly("EXEC_DEFAULT", True, shank=6, reach=40, holder=28, upper=32, height=30)
        assert done == {"FINISHED"}
    lessons.activate(part)
    screen.to_view()
    yield 0.5
    if name:
        yield from lessons.picture(screen, name, lessons.view_box(screen))


def searched(screen, name="pencil-cut-2"):
    """The plan's object; `name`: of the picture, or ""."""
    yield from lessons.press(screen, "riffler.plan_find")
    yield lambda: lessons.idle() and len(lessons.module("plan.plan_store").in_scene(bpy.context.scene)) == 1
    (ob,) = lessons.module("plan.plan_store").in_scene(bpy.context.scene)
    paths = line.paths()
    inner = min(paths, key=lambda p: np.abs(p.centres[:, 1:] - CENTRES).max())
    assert np.abs(inner.centres[:, 1:] - CENTRES).max() < 0.01 and 55 < inner.length < 62, inner.length
    assert len(paths) == 1, [p.length for p in paths]
    screen.to_view()
    yield 0.5
    if name:
        yield from lessons.picture(screen, name, lessons.view_box(screen))
    return ob


def keyed(screen, ob):
    """Ctrl-click near the far end, and then by the clamp, sets the free orientation of least tilt. Returns the frame of
    the latter."""
    bpy.context.scene.riffler.plan.feed = 600
    yield from lessons.press(screen, "riffler.plan_to_timeline")
    yield lambda: lessons.module("plan.timeline").pair(ob) is not None
    lessons.activate(bpy.data.objects["Riffler Tool"])  # the timeline shows the keys of selected objects
    yield from lessons.tool(screen, "riffler.plan")
    last = len(line.paths()[0]) - 1
    for index in (round(0.93 * last), round(0.13 * last)):
        count = len(line.indices())
        at = gizmo.pixel(screen, line.paths()[0].contacts[index, lower(line.paths()[0])])
        screen.move(*map(int, at))
        yield 0.5
        gizmo.press(screen, at, "PRESS", ctrl=True)
        gizmo.press(screen, at, "RELEASE", ctrl=True)
        yield lambda count=count: len(line.indices()) == count + 1
        yield gizmo.quiet
    alike = (LEAST, (-LEAST[1], -LEAST[0]))  # rounding decides
    assert min(np.abs(gizmo.lean() - angles).max() for angles in alike) < 0.1, gizmo.lean()
    yield from in_map(screen, LEAST)
    screen.to_view()
    yield 0.5
    yield from lessons.picture(screen, "pencil-cut-3", (0, 0, *lessons.view_box(screen)[2:]))
    return line.key_frames()[line.indices().index(round(0.13 * last))]


def higher_timeline(screen, pixels):
    """Drags its upper edge, so that keys are visible."""
    area = line.area(screen, "DOPESHEET_EDITOR")
    before, x, y = area.height, area.x + area.width // 2, area.y + area.height
    yield from screen.drag([(x, y), (x, y + pixels // 2), (x, y + pixels)], pause=0.3)
    assert abs(area.height - before - pixels) < 9, (before, area.height)


def lower(path):
    """The contact on the plate, of the two, where it is visible."""
    return int(path.contacts[0, 1, 2] < path.contacts[0, 0, 2])


def turned(screen):
    """In the middle the tool is turned by its dial; the map shows the free orientations."""
    scene = bpy.context.scene
    frames = line.key_frames()
    scene.frame_set(round((frames[0] + frames[-1]) / 2))
    yield gizmo.quiet
    yield 0.5
    keys, before, turn = len(line.indices()), gizmo.lean(), gizmo.module("plan.pure.tool_rotation")
    begin = gizmo.facing(screen, turn.TILT, 0.85)
    way = gizmo.on_dial(screen, turn.TILT, begin + np.radians(np.linspace(0, 15, 3)), 0.85)
    yield from gizmo.drag(screen, way, release=False)
    yield 0.5
    yield from lessons.picture(screen, "pencil-cut-4", (0, 0, *lessons.view_box(screen)[2:]))
    gizmo.press(screen, way[-1], "RELEASE")
    yield lambda: len(line.indices()) == keys + 1
    yield gizmo.quiet
    assert abs((gizmo.lean() - before)[1] - 15) < 1, (before, gizmo.lean())


def by_resolve(screen, ob):
    yield from lessons.press(screen, "riffler.plan_resolve")
    yield lambda: lessons.idle() and len(lessons.module("plan.plan_store").plan(ob).cl) > 0
    assert lessons.module("plan.plan_store").plan(ob).cl[0] is not None, "the paths still collide"


def resolved(screen, ob):
    """Where the tool would hit the clamp it is lifted, and the list says so."""
    yield from lessons.press(screen, "riffler.plan_check")
    yield lessons.idle
    yield from by_resolve(screen, ob)
    kinds = [f.kind for f in ob.riffler.plan.findings]
    assert "lifted" in kinds, kinds
    view = screen.area.spaces.active.region_3d
    before = view.view_location.copy(), view.view_distance
    yield from lessons.press(screen, "riffler.finding_go", share=0.76)
    assert ob.riffler.plan.findings[ob.riffler.plan.index].kind == "lifted"
    yield gizmo.quiet
    screen.to_view()
    yield 0.5
    yield from lessons.picture(screen, "pencil-cut-5", (0, 0, *lessons.view_box(screen)[2:]))
    view.view_location, view.view_distance = before  # the magnifier button has moved it


def turned_again(screen, frame):
    """At the key by the clamp the map's cell of no inclination, and the tilt that passes the clamp."""
    scene = bpy.context.scene
    for _ in range(len(line.key_frames())):
        away = frame - scene.frame_current_final
        if abs(away) < 0.01:
            break
        yield from lessons.press(screen, "riffler.plan_key_jump", share=0.08 if away < 0 else 0.79)
    assert abs(frame - scene.frame_current_final) < 0.01, (frame, scene.frame_current_final)
    yield gizmo.quiet
    yield from in_map(screen, CLEAR)


def in_map(screen, angles):
    """A click on the cell of an inclination and a tilt (degrees) turns the key."""
    looking, drawn = gizmo.module("plan.orientation_probe"), gizmo.module("plan.orientation_map_view")
    found, count = looking._known.map, len(line.indices())
    steps = (np.degrees(found.inclinations), np.degrees(found.tilts))
    cell = tuple(np.abs(s - angle).argmin() for s, angle in zip(steps, angles, strict=True))
    with screen.override():
        grid = drawn.grid_of(found, bpy.context.preferences.system.ui_scale)
        x, y = drawn.corner(bpy.context, grid)
    at, region = grid.place(*grid.angles_of(*cell)), screen.region()
    screen.click(region.x + x + at[0], region.y + y + at[1])
    yield lambda: np.abs(gizmo.axis() - found.axes[cell]).max() < 1e-9
    yield gizmo.quiet
    assert np.abs(gizmo.lean() - angles).max() < 0.1, gizmo.lean()
    assert len(line.indices()) == count


def to_code(screen, ob):
    """Nothing is lifted any more."""
    yield from by_resolve(screen, ob)
    kinds = [f.kind for f in ob.riffler.plan.findings]
    assert "lifted" not in kinds and "blocked" not in kinds, [f.name for f in ob.riffler.plan.findings]
    screen.to_view()
    yield 0.5
    yield from lessons.picture(screen, "pencil-cut-6", (0, 0, *lessons.view_box(screen)[2:]))
    path = common.out("pencil.ngc")
    bpy.context.scene.riffler.plan.post = "linuxcnc-xyzac"
    bpy.context.scene.riffler.machines.of("linuxcnc-xyzac").rot_point = (0, 0, -40)
    with screen.override():
        assert bpy.ops.riffler.plan_nc(filepath=path) == {"FINISHED"}
    lessons.interpreted(path, len(lessons.module("plan.plan_store").plan(ob).cl[0]))


def simulated(screen, stock):
    stock.hide_set(False)
    for name in ("Part", "Clamp"):
        bpy.data.objects[name].hide_set(True)
    yield from lessons.tool(screen, "builtin.select_box")
    yield from lessons.press(screen, "riffler.simulate")
    now = lessons.module("program.simulation").active()
    assert now is not None
    frames = line.key_frames()
    bpy.context.scene.frame_set(round(0.35 * frames[0] + 0.65 * frames[-1]))
    yield lambda: not bpy.app.timers.is_registered(lessons.module("program.simulation")._tick)
    whole = lessons.volume(stock).volume
    assert 5 < whole - now.prefix.volume.volume < 200
    look(screen, (-0.9, -0.9, 0.9), (33, 10, 22))  # the tool does not hide what it has cut
    screen.to_view()
    yield 1.0
    yield from lessons.picture(screen, "pencil-cut-7", (0, 0, *lessons.view_box(screen)[2:]))
    screen.key("ESC")
    yield lambda: lessons.module("program.simulation").active() is None


def verified(screen, stock):
    settings = bpy.context.scene.riffler.verify
    settings.coloured = "LEFT"
    bpy.data.objects["Riffler Tool"].hide_set(True)
    yield from lessons.press(screen, "riffler.verify")
    yield lambda: lessons.idle() and settings.said != ""
    kinds = [f.kind for f in settings.findings]
    assert "gouge" not in kinds, settings.said
    screen.to_view()
    yield 1.0
    yield from lessons.picture(screen, "pencil-cut-8", lessons.view_box(screen))
