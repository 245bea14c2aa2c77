"""A user's steps with keys on the timeline: scrubbing, turning the tool and keying it, and the dope sheet's Delete, G,
Shift D and Ctrl Z; each changes the plan."""

import math
from pathlib import Path

import bpy
import numpy as np

from support import common, harness, plans

cut = harness.load(Path(__file__).with_name("window_cut.py"))


def area(screen, kind):
    found = [a for a in screen.window.screen.areas if a.type == kind]
    return max(found, key=lambda a: a.width * a.height)


def region(screen, kind):
    return next(r for r in area(screen, kind).regions if r.type == "WINDOW")


def middle(screen, kind):
    r = region(screen, kind)
    return r.x + r.width // 2, r.y + r.height // 3


def press(screen, kind, *names, **modifiers):
    """Keys with the mouse over an editor."""
    x, y = middle(screen, kind)
    screen.move(x, y)
    yield 0.1
    for name in names:
        screen.window.event_simulate(name, "PRESS", x=x, y=y, **modifiers)
        screen.window.event_simulate(name, "RELEASE", x=x, y=y, **modifiers)
        yield 0.1


def number(screen, kind, digits):
    names = {"-": "MINUS", "0": "ZERO", "1": "ONE", "2": "TWO", "3": "THREE", "4": "FOUR", "5": "FIVE", "6": "SIX"}
    for digit in digits:
        x, y = middle(screen, kind)
        screen.window.event_simulate(names[digit], "PRESS", unicode=digit, x=x, y=y)
        screen.window.event_simulate(names[digit], "RELEASE", x=x, y=y)
        yield 0.1
    yield from press(screen, kind, "RET")


def plan_object():
    return next(ob for ob in bpy.data.objects if common.part("plan.plan_store").is_plan(ob))


def paths():
    return common.part("plan.plan_store").plan(plan_object()).paths


def pair():
    return common.part("plan.timeline").pair(plan_object())


def indices():
    return list(paths()[0].keys)


def key_frames():
    return common.part("plan.timeline").read_keys(pair()[0])[0].tolist()


def shown():
    """Ball centre and axis of the displayed tool, mm."""
    matrix = np.array(pair()[0].evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world)
    return matrix[:3, 3] + 3 * matrix[:3, 2], matrix[:3, 2]


def settled():
    replan, collisions = common.part("plan.replan"), common.part("plan.collision_marks")
    ours = (replan._due, replan._settle_all, collisions.go_on, collisions.look_again)
    return not any(map(bpy.app.timers.is_registered, ours))


def marks():
    """The timeline's markers, except those that name the paths."""
    return [m.name for m in bpy.context.scene.timeline_markers if "▸ " not in m.name]


def select_column(screen, frame):
    """Selects the keys at a frame, like a click on the column."""
    bpy.context.scene.frame_set(frame)
    with bpy.context.temp_override(
        window=screen.window, area=area(screen, "DOPESHEET_EDITOR"), region=region(screen, "DOPESHEET_EDITOR")
    ):
        bpy.ops.action.select_all(action="DESELECT")
        bpy.ops.action.select_column(mode="CFRA")
        bpy.ops.ed.undo_push(message="Select")


def look_at_the_part(screen):
    space = area(screen, "VIEW_3D").spaces.active
    space.region_3d.view_perspective = "PERSP"
    space.region_3d.view_location = (30, 20, 25)
    space.region_3d.view_rotation = (0.78, 0.48, 0.21, 0.34)
    space.region_3d.view_distance = 170
    space.overlay.show_relationship_lines = False


def steps(screen):
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    screen.window.workspace = bpy.data.workspaces["Animation"]
    yield 1.0
    min((a for a in screen.window.screen.areas if a.type == "VIEW_3D"), key=lambda a: a.width).type = "CONSOLE"
    area(screen, "VIEW_3D").spaces.active.show_region_ui = True
    with screen.override():
        bpy.ops.riffler.millimetres()
    part = plans.part_object()
    ob = plans.on_timeline(chosen=plans.paths()[:1])
    bpy.context.scene.riffler.plan.part = part
    tool, _ = pair()
    bpy.context.view_layer.objects.active = tool
    for other in bpy.data.objects:
        other.select_set(other == tool)
    look_at_the_part(screen)
    bpy.ops.riffler.plan_check("EXEC_DEFAULT")
    dope = area(screen, "DOPESHEET_EDITOR")
    with bpy.context.temp_override(window=screen.window, area=dope, region=region(screen, "DOPESHEET_EDITOR")):
        bpy.ops.action.view_all()
    bpy.ops.ed.undo_push(message="Timeline")
    assert indices() == [0, 144] and ob == plan_object()
    assert [(m.frame, m.name) for m in bpy.context.scene.timeline_markers] == [(1, "▸ Path 1, 60 mm")]
    yield 1.0
    yield from scrub(screen)
    yield from turn_and_key(screen)
    yield from dope_sheet(screen)
    yield from undo(screen)
    yield from collide(screen)


def scrub(screen):
    """A drag in the ruler above the keys."""
    r = region(screen, "DOPESHEET_EDITOR")
    y = r.y + r.height - 10
    places = [r.view2d.view_to_region(f, 0, clip=False)[0] + r.x for f in (20, 40, 60, 73)]
    screen.move(int(places[0]), y)
    screen.window.event_simulate("LEFTMOUSE", "PRESS", x=int(places[0]), y=y)
    for x in places[1:]:
        yield 0.3
        screen.move(int(x), y)
    yield 0.5
    screen.window.event_simulate("LEFTMOUSE", "RELEASE", x=int(places[-1]), y=y)
    yield 0.5
    frame = bpy.context.scene.frame_current
    assert 70 <= frame <= 76, frame
    assert np.abs(shown()[0] - (60 - 60 * (frame - 1) / 144, 17, 11)).max() < 1e-3
    yield settled
    yield 0.5
    yield from screen.picture("timeline-01-scrubbed")
    bpy.context.scene.frame_set(73)
    yield 0.5
    yield settled


def turn_and_key(screen):
    """R X 30 Enter, and I: the tool follows the pointer and stays on its path; the key has the displayed
    orientation."""
    place, before = shown()
    bpy.context.scene.keying_sets.active = bpy.context.scene.keying_sets_all["Rotation"]
    area(screen, "VIEW_3D").tag_redraw()
    yield from press(screen, "VIEW_3D", "R", "X")
    yield from number(screen, "VIEW_3D", "30")
    yield 1.0
    turned = shown()
    tip = place - 3 * before
    assert np.abs(turned[0] - 3 * turned[1] - tip).max() < 1e-4, "the tip left the path"
    c, s = math.cos(math.radians(30)), math.sin(math.radians(30))
    wanted = np.array([[1, 0, 0], [0, c, -s], [0, s, c]]) @ before
    assert np.abs(turned[1] - wanted).max() < 1e-4, (turned[1], wanted)
    assert indices() == [0, 144]
    yield from screen.picture("timeline-02-turned")
    yield from press(screen, "VIEW_3D", "I")
    yield lambda: settled() and indices() == [0, 72, 144]
    assert np.abs(paths()[0].keys[72] - wanted).max() < 1e-4
    yield 1.0
    assert np.abs(shown()[1] - wanted).max() < 1e-4
    yield from screen.picture("timeline-03-keyed")


def dope_sheet(screen):
    axes = paths()[0].axes
    select_column(screen, 73)
    yield from press(screen, "DOPESHEET_EDITOR", "G")
    yield from number(screen, "DOPESHEET_EDITOR", "20")
    yield lambda: settled() and indices() == [0, 92, 144]
    assert key_frames() == [1, 93, 145]
    yield from press(screen, "DOPESHEET_EDITOR", "D", shift=True)
    yield from number(screen, "DOPESHEET_EDITOR", "-50")
    yield lambda: settled() and indices() == [0, 42, 92, 144]
    assert key_frames() == [1, 43, 93, 145]
    keys = paths()[0].keys
    assert np.abs(keys[42] - keys[92]).max() < 1e-6 and not np.allclose(paths()[0].axes, axes)
    bpy.context.scene.frame_set(43)
    yield 1.0
    assert np.abs(shown()[1] - keys[42]).max() < 1e-4
    yield from screen.picture("timeline-04-moved-and-doubled")
    yield from press(screen, "DOPESHEET_EDITOR", "DEL")
    yield lambda: settled() and indices() == [0, 92, 144]


def undo(screen):
    """Each Ctrl Z undoes an edit and its effect on the plan; Ctrl Shift Z redoes both."""
    for wanted in ([0, 42, 92, 144], [0, 92, 144], [0, 72, 144]):
        yield from press(screen, "DOPESHEET_EDITOR", "Z", ctrl=True)
        yield lambda wanted=wanted: settled() and indices() == wanted
        yield 0.3
    bpy.context.scene.frame_set(73)
    yield 0.7
    assert np.abs(shown()[1] - paths()[0].keys[72]).max() < 1e-4
    x, y = middle(screen, "DOPESHEET_EDITOR")
    for wanted in ([0, 92, 144], [0, 42, 92, 144]):
        screen.window.event_simulate("Z", "PRESS", x=x, y=y, ctrl=True, shift=True)
        screen.window.event_simulate("Z", "RELEASE", x=x, y=y, ctrl=True, shift=True)
        yield lambda wanted=wanted: settled() and indices() == wanted
        yield 0.3
    assert common.part("plan.plan_states").state(plan_object()).difference.small
    yield from screen.picture("timeline-05-redone")


def collide(screen):
    """A key that turns the tool into the wall: the frames are marked, and unmarked when it is deleted."""
    yield from cut.open_tab(screen, "RIFFLER_PT_timeline")
    bpy.context.scene.frame_set(20)
    with screen.override():
        assert bpy.ops.riffler.plan_key("EXEC_DEFAULT", True, axis=(0, 1, 0.4)) == {"FINISHED"}
    yield lambda: settled() and marks()
    ((first, last),) = common.part("plan.plan_states").state(plan_object()).colliding
    assert 1 < first < 20 < last < 43
    assert marks() == [f"collides {first}–{last}"]
    ui = screen.region("UI")
    x, y = ui.x + ui.width // 2, ui.y + ui.height // 2
    screen.move(x, y)
    for _ in range(30):  # scroll down to the panel
        screen.window.event_simulate("WHEELDOWNMOUSE", "PRESS", x=x, y=y)
    yield 1.5
    yield from screen.picture("timeline-06-colliding")
    part = bpy.context.scene.riffler.plan.part
    for way, markers in ((-100, 0), (100, 1)):  # mm: away from the tool and back, checked automatically
        part.location.z += way * bpy.context.scene.unit_settings.scale_length * 1000
        yield lambda count=markers: settled() and len(marks()) == count
    assert not common.part("plan.collision_marks").outdated(plan_object())
    select_column(screen, 20)
    yield from press(screen, "DOPESHEET_EDITOR", "DEL")
    yield lambda: settled() and not marks()
    yield from least(screen)


def least(screen):
    """Keys of least tilt, searched while the window responds; one Ctrl Z undoes them."""
    before, state = indices(), bpy.context.window_manager.riffler
    with screen.override():
        assert bpy.ops.riffler.plan_least_tilt("INVOKE_DEFAULT", True, paths="ALL", count=2) == {"RUNNING_MODAL"}
    assert state.running
    yield lambda: not state.running and settled()
    assert indices() == [0, 144] and not marks()
    yield from press(screen, "DOPESHEET_EDITOR", "Z", ctrl=True)
    yield lambda: settled() and indices() == before
