"""Machining's first minute: a question about the part's size, the list of paths with their lines and names, the
machine's options as fields."""

import re
from pathlib import Path

import bpy

from support import common, harness, programs

HERE = Path(__file__).resolve().parent
cut = harness.load(HERE / "window_cut.py")
paths = harness.load(HERE.parent / "headless" / "plan" / "test_plan_paths.py")
ABOVE = ("RIFFLER_PT_plan_part", "RIFFLER_PT_plan_tool", "RIFFLER_PT_plan")


def settings():
    return bpy.context.scene.riffler.plan


def lines():
    return common.part("program.line_view")


def steps(screen):
    yield from asked(screen)
    yield from listed(screen)
    yield from chosen(screen)
    yield from machine(screen)


def asked(screen):
    """Four metres and a ball of 6 mm: no search begins before the user has confirmed the size."""
    cube = bpy.data.objects["Cube"]
    cube.scale = (2, 2, 0.5)
    with screen.override():
        bpy.context.view_layer.update()
        bpy.context.view_layer.objects.active = cube
        bpy.ops.riffler.plan_part("INVOKE_DEFAULT", True)
        bpy.ops.view3d.view_all()
    yield from cut.open_tab(screen, "RIFFLER_PT_plan")
    screen.to_view()
    yield 1.0
    yield from screen.picture("40-asked")
    refused = False
    with screen.override():
        try:
            bpy.ops.riffler.plan_find("INVOKE_DEFAULT", True)
        except RuntimeError as error:
            refused = "what is one unit of the scene?" in str(error)
    assert refused and not bpy.context.window_manager.riffler.running
    with screen.override():
        assert bpy.ops.riffler.scene_unit("EXEC_DEFAULT", True, unit="MM") == {"FINISHED"}
    yield 0.5
    assert common.part("plan.fit_check").size_question(bpy.context.scene) == ""
    bpy.context.scene.riffler.cutter.kind = "flat"
    with screen.override():
        common.refused(lambda: bpy.ops.riffler.plan_find("INVOKE_DEFAULT", True), "tool", "ball")
    assert not bpy.context.window_manager.riffler.running
    bpy.context.scene.riffler.cutter.kind = "ball"
    bpy.data.objects.remove(cube)


def listed(screen):
    """A free path, one without keys, a blocked one, one to resolve."""
    for name in ABOVE:
        bpy.utils.unregister_class(getattr(bpy.types, name))
    with screen.override():
        ob = paths.four()
        common.part("plan.path_curves").show(ob, programs.content(ob), 1.0)
        bpy.context.view_layer.objects.active = ob
        bpy.ops.view3d.view_all()
        bpy.ops.ed.undo_push(message="Plan")
    space = screen.area.spaces.active
    space.overlay.show_relationship_lines = False
    space.region_3d.view_rotation = (0.78, 0.48, 0.21, 0.34)
    yield 1.5
    assert lines().kept.built > 0 and set(lines()._drawn[1]) == {"cut", "unplanned", "blocked", "keyed"}
    yield from screen.picture("41-paths")
    built = lines().kept.built
    screen.area.tag_redraw()
    yield 1.0
    assert lines().kept.built == built, "nothing is rebuilt without a change"


def chosen(screen):
    """Paths that block the program are switched off; the moves between the cuts are shown once it is written."""
    ob = bpy.data.objects["Riffler Plan"]
    with screen.override():
        bpy.ops.riffler.plan_key("EXEC_DEFAULT", True, path=2, point=0, axis=(0, -0.6, 0.8))
        bpy.ops.riffler.plan_resolve("EXEC_DEFAULT", True, max_lift=1.0)
        bpy.ops.riffler.plan_switch("EXEC_DEFAULT", True, which="BLOCKED")
        bpy.ops.riffler.plan_nc("EXEC_DEFAULT", filepath=common.out("window.ngc"))
    yield 1.0
    assert set(lines()._drawn[1]) == {"cut", "off", "lead", "retract", "rapid"}
    ob.riffler.plan.row = 3
    yield 1.0
    track = common.part("plan.replan").layout_of(ob, programs.content(ob)).tracks[3]
    assert bpy.context.scene.frame_current_final == track.first
    assert bpy.context.object == common.part("plan.path_curves").of(ob)[3]
    screen.area.spaces.active.region_3d.view_distance = 150
    yield 1.0
    yield from screen.picture("42-program")
    with screen.override():
        bpy.ops.ed.undo_push(message="Before")
        ob.riffler.plan.rows[0].on = False
        bpy.ops.ed.undo_push(message="Off")
    assert programs.content(ob).off == {0, 2}
    screen.key("Z", ctrl=True)
    yield lambda: programs.content(bpy.data.objects["Riffler Plan"]).off == {2}
    assert [row.on for row in bpy.data.objects["Riffler Plan"].riffler.plan.rows] == [True, True, False, True]


def machine(screen):
    """Required options are asked for where the machine is chosen."""
    bpy.utils.unregister_class(bpy.types.RIFFLER_PT_plan_paths)
    cls = bpy.types.RIFFLER_PT_plan_machine
    bpy.utils.unregister_class(cls)
    for name in ("RIFFLER_PT_timeline", "RIFFLER_PT_nc", "RIFFLER_PT_verify"):
        bpy.utils.unregister_class(getattr(bpy.types, name))
    bpy.utils.register_class(cls)
    settings().post = "linuxcnc-xyzac"
    yield 1.0
    ui = screen.region("UI")
    screen.click(ui.x + 60, ui.y + ui.height - 14)  # it is collapsed at first
    screen.to_view()
    yield 1.0
    yield from screen.picture("43-machine-asks")
    bpy.context.scene.cursor.location = (30, 20, -40)
    with screen.override():
        bpy.ops.riffler.machine_option("EXEC_DEFAULT", True, machine="linuxcnc-xyzac", option="rot_point", how="CURSOR")
        bpy.ops.riffler.machine_option_add("EXEC_DEFAULT", True, machine="linuxcnc-xyzac", option="limits_a")
        bpy.ops.riffler.machine_option_add("EXEC_DEFAULT", True, machine="linuxcnc-xyzac", option="coolant")
    yield 1.0
    yield from screen.picture("44-machine")
    with screen.override():
        bpy.ops.riffler.plan_nc("EXEC_DEFAULT", filepath=common.out("window-xyzac.ngc"))
    first_and_last(Path(common.out("window-xyzac.ngc")).read_text().splitlines())


def first_and_last(blocks):
    """Up first, then turned, then across, then down; up at the end; and at most one turn."""
    moves = [re.findall(r"([XYZAC])-?\d", block) for block in blocks if not block.startswith("(")]
    assert [move for move in moves if move][:4] == [["Z"], ["A", "C"], ["X", "Y"], ["Z"]], blocks[:24]
    assert "G53 G0 Z0" in blocks and blocks[-2:] == ["G53 G0 Z0", "M30"], blocks[-5:]
    turns = [float(angle) for block in blocks for angle in re.findall(r"C(-?[\d.]+)", block)]
    assert turns and max(map(abs, turns)) <= 360, turns
