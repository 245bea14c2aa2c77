"""A machinist's steps from a plan to NC code: resolved, simulated by scrubbing, verified; going to a finding; Esc."""

from pathlib import Path

import bpy
import numpy as np

from support import common, harness, programs

HERE = Path(__file__).resolve().parent
cut = harness.load(HERE / "window_cut.py")
lessons = harness.load(HERE / "lessons.py")
verify = harness.load(HERE.parent / "headless" / "program" / "test_verify.py")


def now():
    return common.part("program.simulation").active()


def there():
    """The simulated stock has reached the frame, and the timer has ended."""
    wanted = now().program_timeline.row_at(bpy.context.scene.frame_current_final)
    return now().prefix.row == wanted and not bpy.app.timers.is_registered(common.part("program.simulation")._tick)


def steps(screen):
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    with screen.override():
        bpy.ops.riffler.millimetres()
    yield from cut.open_tab(screen, "RIFFLER_PT_plan")
    make_room()
    with screen.override():
        ob = programs.plan(programs.valley(programs.LEANING, (0, -0.2, 1), (0, 0.5, 0.8), programs.LEANING))
        bpy.context.view_layer.objects.active = ob
        bpy.ops.ed.undo_push(message="Plan")
        assert bpy.ops.riffler.plan_resolve("INVOKE_DEFAULT", True) == {"RUNNING_MODAL"}
    yield lambda: not bpy.context.window_manager.riffler.running
    assert programs.content(ob).cl[0] is not None and len(ob.riffler.plan.findings) > 0
    stock = programs.stock()
    with screen.override():
        bpy.ops.view3d.view_all()
    yield 2.0
    yield from screen.picture("30-resolved")
    yield from simulated(screen, stock)
    yield from verified(screen, stock)


def make_room():
    """Removes the panels above ours: a user would scroll."""
    take_away("plan_part", "plan_tool", "plan", "plan_paths", "plan_machine")


def take_away(*names):
    for name in names:
        bpy.utils.unregister_class(getattr(bpy.types, f"RIFFLER_PT_{name}"))


def simulated(screen, stock):
    with screen.override():
        assert bpy.ops.riffler.simulate("INVOKE_DEFAULT") == {"FINISHED"}
    scene = bpy.context.scene
    for frame in (40, 110, 75):
        scene.frame_set(frame)
        yield there
        whole = now().prefix.volume.copy()
        assert common.is_hidden(stock) and 0 < now().prefix.row < now().prefix.rows - 1
        left = programs_volume(now().prefix.row)
        assert whole.to_bytes() == left
    yield 0.5
    yield from screen.picture("31-simulated")
    with screen.override():
        bpy.ops.screen.animation_play()
    begin = scene.frame_current
    yield lambda: scene.frame_current != begin
    with screen.override():
        bpy.ops.screen.animation_cancel()
    screen.key("ESC")
    yield lambda: now() is None
    assert not common.is_hidden(stock) and common.part("sculpt.chunks").shown() == []
    yield 0.5


def programs_volume(row):
    """The stock with all rows up to that one carved in one call."""
    setup = common.part("program.programs").take(bpy.context, programs.settings())
    volume = setup.stock
    ((tool, poses),) = setup.runs
    volume.carve(tool, poses[: row + 1])
    return volume.to_bytes()


def verified(screen, stock):
    path, _ = verify.nc(slip=40)
    take_away("timeline", "nc")
    other = max((a for a in screen.window.screen.areas if a.type == "PROPERTIES"), key=lambda a: a.height)
    other.type = "TEXT_EDITOR"
    settings = programs.settings()
    settings.source, settings.filepath, settings.coloured = "FILE", path, "LEFT"
    with screen.override():
        assert bpy.ops.riffler.verify("INVOKE_DEFAULT", True, source="FILE", filepath=path, coloured="LEFT") == {
            "RUNNING_MODAL"
        }
    yield lambda: not bpy.context.window_manager.riffler.running
    assert verify.kinds() == ["gouge"] and common.is_hidden(stock)
    index = 0
    kind, size, at, *place = verify.findings()[0]["title"].split()  # the form of the list's rows
    assert (kind, at) == ("Gouge", "at") and 0 < float(size) < 1 and len(place) == 3, verify.findings()[0]
    with screen.override():
        bpy.ops.riffler.finding_go("INVOKE_DEFAULT", of="VERIFY", index=index)
    yield 1.0
    found = verify.findings()[index]
    assert bpy.context.scene.frame_current_final == found["frame"]
    space = other.spaces.active
    assert space.text == settings.text and space.text.current_line_index == found["line"] - 1
    assert space.top <= found["line"] - 1 < space.top + space.visible_lines
    assert np.allclose(screen.area.spaces.active.region_3d.view_location, found["place"], atol=1e-3)
    screen.area.spaces.active.region_3d.view_distance = 90
    tip = np.array(bpy.data.objects["Riffler Tool"].matrix_world)[:3, 3]
    assert np.linalg.norm(tip - found["place"]) < 4  # the plan's tool is there, too
    assert common.part("stock.deviation_legend").kept.built > 0
    yield 1.0
    yield from screen.picture("32-verified")
    built = common.part("stock.deviation_legend").kept.built
    screen.area.tag_redraw()
    yield 1.0
    assert common.part("stock.deviation_legend").kept.built == built
    with screen.override():
        bpy.ops.riffler.verify_clear("EXEC_DEFAULT", True)
    yield 0.5
    assert not common.is_hidden(stock) and screen.area.spaces.active.shading.color_type == "MATERIAL"
    yield from on_the_plans_machine(screen)


def on_the_plans_machine(screen):
    """Verify uses the machine chosen for the plan; the finding of a machine that cannot lean so far begins like
    this."""
    bpy.context.scene.riffler.plan.post = "linuxcnc-xyzac"
    own = bpy.context.scene.riffler.machines.of("linuxcnc-xyzac")
    own.rot_point = (0, 0, -40)
    file = {"source": "FILE", "filepath": verify.saved(bpy.data.objects["Riffler Plan"]), "machine": "linuxcnc-xyzac"}
    for limit, what, found in ((90, {"source": "PLAN"}, []), (10, file, ["machine"])):
        own.limits_a, log = (-limit, limit), len(lessons.messages(screen))
        with screen.override():
            assert bpy.ops.riffler.verify("INVOKE_DEFAULT", True, **what) == {"RUNNING_MODAL"}
        yield lambda: not bpy.context.window_manager.riffler.running
        said = "\n".join(lessons.messages(screen)[log:])
        assert verify.kinds() == found and said and "machine was given" not in said, (verify.kinds(), said)
    assert verify.findings()[0]["title"].startswith("Out of reach at ")
