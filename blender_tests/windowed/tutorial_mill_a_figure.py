"""Follows docs/mill-a-figure.md: roughs a head in a block with a flat cutter, finishes it with a ball, simulates,
verifies, and writes the program for a three-axis router."""

from pathlib import Path

import bpy
import numpy as np
import riffler

from support import common, harness

HERE = Path(__file__)
lessons = harness.load(HERE.with_name("lessons.py"))
gizmo = harness.load(HERE.with_name("window_gizmo.py"))
PIXELS = False
SIZE = 30.0  # mm, longest side of the head
FLAT, BALL = "Flat 6 mm", "Ball 3 mm"


def steps(screen):
    lessons.only_open("RIFFLER_PT_sculpt", "RIFFLER_PT_plan_part", "RIFFLER_PT_job")
    yield from lessons.begin(screen, millimetres=False)
    head = made_head(screen)
    look(screen)
    yield from lessons.cut.open_tab(screen, "RIFFLER_PT_job")
    yield from in_a_block(screen, head)
    yield from listed(screen)
    yield from calculated(screen)
    yield from simulated(screen)
    yield from verified(screen)
    yield from to_code(screen)


def made_head(screen):
    """Adds Blender's monkey, smoothed and face up, with its back below the block's bottom."""
    with screen.override():
        bpy.ops.mesh.primitive_monkey_add("INVOKE_DEFAULT", True)
        ob = bpy.context.object
        ob.name = "Head"
        ob.rotation_euler.x = -np.pi / 2
        ob.scale = (SIZE / max(ob.dimensions),) * 3
        ob.modifiers.new("Subdivision", "SUBSURF").levels = 2
        bpy.ops.object.shade_smooth()
    bpy.context.view_layer.update()
    return ob


def look(screen, direction=(0.6, -1.0, 1.1), distance=90.0):
    view = screen.area.spaces.active.region_3d
    view.view_rotation = gizmo.Vector(direction).to_track_quat("Z", "Y")
    view.view_distance, view.view_location = distance, (0, 0, 0)


def in_a_block(screen, head):
    """Presses Set Part, then Make Stock with two millimetres around the part."""
    lessons.activate(head)
    yield from lessons.press(screen, "riffler.plan_part", share=0.785)
    assert bpy.context.scene.riffler.plan.part == head
    bpy.context.scene.riffler.machining.pitch = 0.4
    yield from lessons.press(screen, "riffler.machining_stock")
    stock = bpy.context.scene.riffler.machining.stock
    assert stock is not None and stock.name == "Head Stock" and stock.display_type == "BOUNDS"
    yield from lessons.aside(screen)
    screen.to_view()
    yield 0.5
    yield from lessons.picture(screen, "mill-a-figure-1", lessons.view_box(screen))


def listed(screen):
    """Adds two operations as from the menu of the plus, each with a tool of the library."""
    settings = bpy.context.scene.riffler.machining
    for kind, name in (("ROUGH", FLAT), ("FINISH", BALL)):
        with screen.override():
            assert bpy.ops.riffler.machining_add(kind=kind) == {"FINISHED"}
            assert bpy.ops.riffler.machining_tool(name=name) == {"FINISHED"}
    rough, finish = settings.rows
    rough.stepdown, finish.cusp, finish.tolerance = 3.0, 0.03 if lessons.PAGES else 0.1, 0.01
    finish.slope_to = np.radians(85)
    screen.to_view()
    yield 0.5


def calculated(screen):
    settings = bpy.context.scene.riffler.machining
    yield from lessons.press(screen, "riffler.machining_calculate")
    yield lambda: lessons.idle() and settings.rows[1].state != "OPEN"
    assert [row.state for row in settings.rows] == ["DONE", "DONE"], [(r.state, r.said) for r in settings.rows]
    assert settings.problem == ""
    screen.to_view()
    yield 0.5
    yield from lessons.picture(screen, "mill-a-figure-2", lessons.view_box(screen))


def simulated(screen):
    """Simulates up to the middle of finishing, where both the layers of roughing and the rows are visible."""
    scene = bpy.context.scene
    scene.riffler.machining.draw_moves = False
    with screen.override():
        assert bpy.ops.riffler.simulate(source="JOB") == {"FINISHED"}
    now = lessons.module("program.simulation").active()
    assert now is not None
    tools = np.asarray(lessons.module("machining.job_program").of_scene(bpy.context)[0].tool)
    row = int(np.flatnonzero(tools == tools[-1]).mean())  # halfway through the last tool's moves
    frames = np.linspace(now.program_timeline.first, now.program_timeline.last, 2000)
    scene.frame_set(int(frames[np.argmin([abs(now.program_timeline.row_at(f) - row) for f in frames])]))
    yield lambda: not bpy.app.timers.is_registered(lessons.module("program.simulation")._tick)
    bpy.data.objects["Head"].hide_set(True)
    screen.to_view()
    yield 1.0
    yield from lessons.picture(screen, "mill-a-figure-3", lessons.view_box(screen))
    screen.key("ESC")
    yield lambda: lessons.module("program.simulation").active() is None
    bpy.data.objects["Head"].hide_set(False)


def verified(screen):
    """Verifies, and colours the remaining stock by its distance from the head: material that a router cannot reach from
    above is left."""
    scene = bpy.context.scene
    scene.riffler.plan.post = "3-axis"
    with screen.override():
        assert bpy.ops.riffler.verify(source="JOB", gouge=0.03, coloured="LEFT", scale=0.2) == {"FINISHED"}
    found = scene.riffler.verify.findings
    assert not found, [f.name for f in found]
    screen.to_view()
    yield 1.0
    yield from lessons.picture(screen, "mill-a-figure-4", lessons.view_box(screen))


def to_code(screen):
    path = common.out("figure.ngc")
    with screen.override():
        assert bpy.ops.riffler.machining_zero(place="TOP") == {"FINISHED"}
        assert bpy.ops.riffler.machining_nc(filepath=path, post="3-axis") == {"FINISHED"}
    read = riffler.Program.read(path, machine="3-axis")
    assert read.poses[~read.rapid][:, 2].min() > -SIZE and read.poses[:, 2].max() > 4.9
    yield 0.1
