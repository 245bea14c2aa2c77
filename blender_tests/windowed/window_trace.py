"""The simulated pen traces a STEP file in view: panel, tool, normal and arrows follow; Esc ends it and leaves a curve
on the exact faces; a second call, and a move of the object, end it too."""

from pathlib import Path

import bpy
import numpy as np
from mathutils import Euler

from support import common, harness
from support.cad_parts import part, with_reader

HERE = Path(__file__)
lessons = harness.load(HERE.with_name("lessons.py"))
cut = harness.load(HERE.with_name("window_cut.py"))
pen = harness.load(HERE.with_name("window_pen.py"))
TOP = 20.0  # mm, of the part


def tracing():
    return bpy.context.window_manager.riffler.sculpting


def session():
    return common.part("pen.session").running


def begin(screen, **more):
    with screen.override():
        settings = bpy.context.scene.riffler.pen
        for key, value in more.items():
            setattr(settings, key, value)
        given = {k: getattr(settings, k) for k in common.part("pen.properties").TraceSettings.__annotations__}
        return bpy.ops.riffler.pen_trace("INVOKE_DEFAULT", True, **given)


def curves():
    return [ob for ob in bpy.data.objects if ob.type == "CURVE"]


def led(x, y, z):
    """Aims the simulated hand, mm from where it began."""
    device = session().run.device
    device.aim([*np.add(home[:3], (x, y, z)), *home[3:]], buttons=1)


home = np.zeros(6)


def steps(screen):
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    with_reader()
    pen.only_open("RIFFLER_PT_tool", "RIFFLER_PT_pen")
    with screen.override():
        bpy.ops.riffler.millimetres()
        bpy.ops.riffler.import_cad("EXEC_DEFAULT", True, filepath=part("milled.step"), tolerance=0.2)
        ob = bpy.context.object
        tool = bpy.context.scene.riffler.tool
        tool.kind, tool.diameter = "ball", 6.0
        bpy.context.scene.cursor.location = (8, 20, TOP + 1)
        bpy.ops.ed.undo_push(message="Part")
    yield from cut.open_tab(screen, "RIFFLER_PT_pen")
    view = screen.area.spaces.active.region_3d
    view.view_location, view.view_distance = (18, 12, 14), 75
    view.view_rotation = Euler((np.radians(50), 0, np.radians(-35))).to_quaternion()
    screen.area.spaces.active.overlay.show_floor = False
    screen.to_view()
    yield 1.0

    assert begin(screen, start="CURSOR", scale=0.5) == {"RUNNING_MODAL"}
    yield lambda: session() is not None or not bpy.context.window_manager.riffler.running
    assert tracing(), "reading the exact faces has failed"
    run = session().run
    yield lambda: session() is None or (run.device.state().homed and run.state in ("ready", "ramp", "active"))
    home[:] = run.device.state().pose
    pose = run.pose.copy()

    # into the groove of the torus, whose ring of 12 mm is around a corner of the part
    led(0, 0, -8)
    yield lambda: session() is None or run.contact is not None
    led(10, -20, -8)
    yield lambda: session() is None or run.traces.points > 20
    led(2, -26, -14)
    yield lambda: session() is None or (run.contact is not None and np.linalg.norm(run.push[0]) > 0.3)
    assert tracing(), "the session was over before it could be looked at"
    assert np.abs(run.pose[:2] - pose[:2]).max() > 1, "the tool follows the hand"
    force = common.part("sculpt.force_view")
    assert force._shown.size > 0 and common.part("pen.trace_view")._shown.contact is not None
    yield from lessons.picture(screen, "trace", lessons.view_box(screen))

    screen.key("ESC")
    yield lambda: not tracing()
    yield 0.5
    (curve,) = curves()
    points = np.array([p.co[:3] for s in curve.data.splines for p in s.points])
    surface = common.part("blender.exact_surfaces").reader(bpy.context, ob)(None)
    assert len(points) > 20 and surface.closest(points)[2].max() < 1e-4
    assert force._shown is None and common.part("pen.trace_view")._shown is None
    screen.key("Z", ctrl=True)
    yield lambda: not curves()

    # another call ends it, and so does a move of the object
    for last in (begin, lambda screen: ob_of().location.__setattr__("x", 1.0)):
        with screen.override():
            bpy.context.view_layer.objects.active = ob_of()
        assert begin(screen) == {"RUNNING_MODAL"}
        yield tracing
        yield 0.5
        last(screen)
        yield lambda: not tracing()
    assert session() is None


def ob_of():
    return bpy.data.objects["milled"]
