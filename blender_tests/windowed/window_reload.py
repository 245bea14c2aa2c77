"""The add-on is disabled and enabled three times in a window, each time in the middle of something: a stroke whose
button is still held, a long cut, a pen's session. Nothing of it remains, and what was carved by then is kept. An active
tool of ours in another workspace is deactivated, and a turned tool returns to its path."""

from pathlib import Path

import bpy

from support import common, harness, leak_check, plans

cut = harness.load(Path(__file__).with_name("window_cut.py"))
strokes = harness.load(Path(__file__).with_name("window_stroke.py"))
PIXELS = False


class RIFFLERTEST_OT_count(bpy.types.Operator):
    """Count the events of timers; it has none of its own, so all of them are leftovers"""

    bl_idname = "rifflertest.count"
    bl_label = "Count Timers"
    seen = 0

    def invoke(self, context, event):
        type(self).seen = 0
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC":
            return {"CANCELLED"}
        if event.type.startswith("TIMER"):
            type(self).seen += 1
        return {"PASS_THROUGH"}


def disable():
    bpy.ops.preferences.addon_disable(module=common.MODULE)


def enable():
    bpy.ops.preferences.addon_enable(module=common.MODULE)


def whole(before):
    """The sculpt itself is shown again, unchanged."""
    ob = bpy.data.objects["Stock"]
    assert not ob.hide_get() and ob.visible_get()
    left = [c.name for c in (*bpy.data.collections, *bpy.data.objects, *bpy.data.meshes) if "Riffler" in c.name]
    assert not left, left
    assert cut.same(cut.state(), before), "the sculpt is not what it was"


def timers(screen):
    """Number of ticks of the window's timers in a second."""
    yield 0.5  # for events waiting in the window's queue
    bpy.utils.register_class(RIFFLERTEST_OT_count)
    with screen.override():
        bpy.ops.rifflertest.count("INVOKE_DEFAULT")
    yield 1.0
    screen.key("ESC")
    yield 0.5
    bpy.utils.unregister_class(RIFFLERTEST_OT_count)


def stroke_held(screen):
    strokes.tool(screen, "riffler.carve")
    yield 0.5
    before = cut.state()
    yield from strokes.drag(screen, [(15, 40, 20), (45, 40, 20)], together=4, release=False)
    assert common.part("sculpt.pointer").held is not None
    assert strokes.volume().volume < before[0]
    return before


def long_cut(screen):
    strokes.tool(screen, "riffler.carve")
    before = cut.state()
    # long enough on any computer, also while it starts to draw
    name = cut.spiral(6, 400_000, "Long")
    bpy.data.objects[name].hide_set(True)
    bpy.context.view_layer.objects.active = bpy.data.objects["Stock"]
    with screen.override():
        assert bpy.ops.riffler.cut_curve("INVOKE_DEFAULT", True, curve=name, depth=6) == {"RUNNING_MODAL"}
    # as soon as something is cut: how much is left a second later depends on the window's drawing time
    yield lambda: bpy.context.window_manager.riffler.percent > 0 or not cut.running()
    assert cut.running() == "Cutting", "the cut was over before it could be looked at"
    return before


def pen_session(screen):
    strokes.tool(screen, "riffler.add")
    before = cut.state()
    with screen.override():
        # far above the stock: what it carves would be kept, and this test checks that everything is unchanged
        assert bpy.ops.riffler.pen_sculpt("INVOKE_DEFAULT", True, device="simulated", gap=500) == {"FINISHED"}
    yield 1.0
    assert bpy.context.window_manager.riffler.sculpting
    return before


def tool_of_another_workspace(screen):
    """It is deactivated also where no window shows it, and its cursor's draw function is removed in every workspace."""
    from bl_ui.space_toolsystem_common import _activate_by_item as chosen

    strokes.tool(screen, "riffler.carve")
    before = screen.window.workspace
    screen.window.workspace = bpy.data.workspaces["Animation"]
    yield 1.0
    disable()
    assert "VIEW_3D" not in chosen._cursor_draw_handle
    screen.window.workspace = before
    yield 1.0
    assert before.tools.from_space_view3d_mode("OBJECT").idname == "builtin.select_box"
    ob = bpy.data.objects["Stock"]
    ob.select_set(True)
    region = screen.region()  # a box around nothing, next to its lower edge, selects nothing
    x, y = region.x + region.width // 2, region.y + 20
    yield from screen.drag([(x, y), (x + 20, y + 20), (x + 40, y + 20)])
    yield 0.5
    assert not ob.select_get(), "Blender's tool does not select"
    enable()
    yield 1.0


def scripts_reloaded(screen):
    """Reload Scripts during a session: the sculpt has its strokes, and the add-on continues."""
    strokes.tool(screen, "riffler.carve")
    yield from strokes.drag(screen, [(15, 20, 20), (45, 20, 20)], together=4)
    assert strokes.run() is not None
    volume, before = strokes.volume().volume, common.part("sculpt.live_registry")
    with screen.override():
        bpy.ops.script.reload()
    yield lambda: common.part("sculpt.live_registry") is not before
    yield 2.0
    carved = cut.state()
    assert carved[0] == volume
    whole(carved)
    strokes.tool(screen, "riffler.carve")
    yield from strokes.drag(screen, [(15, 10, 20), (45, 10, 20)], together=4)
    assert strokes.volume().volume < volume


def tool_turned(screen):
    """During a drag: the tool moves with the animation again."""
    bpy.context.scene.riffler.plan.part = plans.part_object()
    plan = plans.on_timeline(chosen=plans.paths()[:1])
    bpy.context.scene.frame_set(73)
    yield 1.0
    region = screen.region()
    screen.move(region.x + region.width // 2, region.y + region.height // 2)
    yield 0.3
    with screen.override():
        assert bpy.ops.riffler.plan_turn("INVOKE_DEFAULT", handle="FREE") == {"RUNNING_MODAL"}
    screen.move(region.x + region.width // 2 + 40, region.y + region.height // 2 + 40)
    yield 0.5
    tool, _ = common.part("plan.timeline").pair(plan)
    operator, turning = common.part("plan.operators.turn"), common.part("plan.current_pose")
    assert turning.held is not None and {c.influence for c in tool.constraints} == {0}
    disable()
    assert {c.influence for c in tool.constraints} == {1}
    assert turning.held is None and operator._held is None
    yield 0.5
    enable()


def keys_of_others(screen):
    """The list of keys finds ours in addition to the key of another add-on, which came first, and reports if the user
    has removed one."""
    configurations = bpy.context.window_manager.keyconfigs
    disable()
    keymap = configurations.addon.keymaps.new("Object Mode")
    other = keymap.keymap_items.new("object.select_all", "F13", "PRESS")
    enable()
    yield 1.0  # for the user's configuration to have both
    keys = common.part("keymaps")
    found = list(keys.users())
    assert [item and item.idname for _, item in found] == [key.operator for key in keys.KEYS], found
    found[0][0].keymap_items.remove(found[0][1])
    yield 0.5
    found = [item and item.idname for _, item in keys.users()]
    assert found == [None, *(key.operator for key in keys.KEYS[1:])], found
    configurations.user.keymaps["Object Mode"].restore_to_default()
    keymap.keymap_items.remove(other)
    yield 0.5
    assert None not in [item for _, item in keys.users()]


def preferences(screen):
    """Their look, in the 3D view's area."""
    if bpy.app.version >= (4, 2, 0):  # there extensions are listed by other means
        return
    import addon_utils

    bpy.context.preferences.active_section = "ADDONS"
    bpy.context.window_manager.addon_search = "Riffler"
    listed = next(m for m in addon_utils.modules() if m.__name__ == common.MODULE)
    addon_utils.module_bl_info(listed)["show_expanded"] = True
    with screen.override():
        bpy.ops.riffler.doctor()
    area = screen.area
    area.type = "PREFERENCES"
    yield 2.0
    yield from screen.shot("preferences")
    area.type = "VIEW_3D"
    yield 1.0


def steps(screen):
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    disable()
    with leak_check.Watch(common.MODULE) as watch:
        assert watch.left() == []
        enable()
        first = watch.left()
        yield from keys_of_others(screen)
        yield from preferences(screen)
        yield from cut.open_tab(screen)
        with screen.override():
            bpy.ops.riffler.millimetres()
            bpy.ops.riffler.new_stock(
                "INVOKE_DEFAULT", True, source="BLOCK", origin="CORNER", size=(60, 60, 20), pitch=0.5
            )
            bpy.ops.ed.undo_push(message="Stock")
        yield 1.0
        for begin in (stroke_held, long_cut, pen_session):
            before = yield from begin(screen)
            disable()
            assert watch.left() == [], (begin.__name__, watch.left())
            yield from timers(screen)
            assert RIFFLERTEST_OT_count.seen == 0, f"{begin.__name__}: {RIFFLERTEST_OT_count.seen} ticks of a timer"
            assert not bpy.context.workspace.tools.from_space_view3d_mode("OBJECT").idname.startswith("riffler.")
            strokes.press(screen, screen.region().x + 200, screen.region().y + 200, "RELEASE")
            yield 0.5
            enable()
            whole(before)
            now = watch.left()
            assert set(now) == set(first), sorted(set(now) ^ set(first))
            yield 1.0
        # and it works
        whole_volume = cut.state()[0]
        strokes.tool(screen, "riffler.carve")
        yield from strokes.drag(screen, [(15, 40, 20), (45, 40, 20)], together=4)
        assert strokes.volume().volume < whole_volume
        yield from tool_of_another_workspace(screen)
        yield from scripts_reloaded(screen)
        yield from tool_turned(screen)
