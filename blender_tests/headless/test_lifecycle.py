"""Enabled, disabled and enabled again: nothing remains, nothing is missing."""

import importlib
import sys

import bpy

from support import common, leak_check


def listed():
    """Every class that the add-on's modules list for registration."""
    return [cls for module in common.part("registration").modules() for cls in module.CLASSES]


def operators():
    return {cls.bl_idname.removeprefix("riffler.") for cls in listed() if issubclass(cls, bpy.types.Operator)}


def disable():
    bpy.ops.preferences.addon_disable(module=common.MODULE)


def enable():
    bpy.ops.preferences.addon_enable(module=common.MODULE)


def test_the_native_core_is_the_one_that_was_installed():
    import os

    import riffler

    inside = riffler.__file__.startswith(os.path.realpath(os.environ["BLENDER_USER_RESOURCES"]))
    assert inside == (common.JOB["mode"] != "source"), riffler.__file__


def test_everything_is_registered():
    assert set(leak_check.classes(common.MODULE)) == {f"class {cls.__name__}" for cls in listed()}
    assert len(operators()) > 10 and set(dir(bpy.ops.riffler)) == operators()
    for cls in listed():
        assert not issubclass(cls, bpy.types.Operator) or (cls.bl_label and cls.__doc__), f"{cls}: no tooltip"


def test_no_class_was_forgotten():
    """Every class of the add-on's modules that Blender could register is in a list of CLASSES."""
    made = {c for c in leak_check.subclasses(bpy.types.bpy_struct) if leak_check.of(common.MODULE, c)}
    current = {c for c in made if getattr(sys.modules.get(c.__module__), c.__name__, None) is c}
    fallback = (
        set(common.part("blender.fallback").CLASSES) if f"{common.MODULE}.blender.fallback" in sys.modules else set()
    )
    tools = {c for c in current if issubclass(c, bpy.types.WorkSpaceTool)}  # bpy.utils.register_tool registers these
    assert current - fallback - tools == set(listed())


def test_three_cycles_leave_nothing():
    common.stock()
    disable()
    with leak_check.Watch(common.MODULE) as watch:
        assert watch.left() == []
        enable()
        first = watch.left()
        assert any("handler" in line for line in first) and any("property" in line for line in first)
        for _ in range(2):
            disable()
            assert watch.left() == []
            enable()
            assert watch.left() == first and set(dir(bpy.ops.riffler)) == operators()


def test_everything_left_behind_is_detected():
    """One of each kind, as a careless module of the add-on would leave it."""

    def callback(*_):
        return None

    class RifflerCareless(bpy.types.PropertyGroup):
        pass

    class Tool(bpy.types.WorkSpaceTool):
        bl_space_type, bl_context_mode, bl_idname, bl_label = "VIEW_3D", "OBJECT", "riffler.careless", "Careless"

    callback.__module__ = RifflerCareless.__module__ = f"{common.MODULE}.careless"
    with leak_check.Watch(common.MODULE) as watch:
        before = watch.left()
        drawn = bpy.types.SpaceView3D.draw_handler_add(callback, (), "WINDOW", "POST_VIEW")
        bpy.app.timers.register(callback, first_interval=1e6)
        bpy.app.handlers.save_pre.append(callback)
        bpy.utils.register_class(RifflerCareless)
        bpy.types.Object.riffler_careless = bpy.props.IntProperty()
        keymap = bpy.context.window_manager.keyconfigs.addon.keymaps.new("Object Mode")
        item = keymap.keymap_items.new("riffler.rebuild", "F13", "PRESS")
        pictures = bpy.utils.previews.new()
        bpy.utils.register_tool(Tool)
        bpy.types.VIEW3D_MT_object.append(callback)
        more = [line for line in watch.left() if line not in before]
        bpy.types.SpaceView3D.draw_handler_remove(drawn, "WINDOW")
        bpy.app.timers.unregister(callback)
        bpy.app.handlers.save_pre.remove(callback)
        bpy.utils.unregister_class(RifflerCareless)
        del bpy.types.Object.riffler_careless
        keymap.keymap_items.remove(item)
        bpy.utils.previews.remove(pictures)
        bpy.utils.unregister_tool(Tool)
        bpy.types.VIEW3D_MT_object.remove(callback)
        assert watch.left() == before
    kinds = ("class", "draw handler", "handler", "key", "menu", "preview collection", "property", "timer", "tool")
    for kind in kinds:
        assert any(line.startswith(kind) for line in more), (kind, more)


def failing(owner, name, at):
    """Replaces a function by one that fails at its `at`-th call; returns a function that restores it."""
    original, calls = getattr(owner, name), []

    def call(*args, **more):
        calls.append(args)
        if len(calls) == at:
            raise KeyError("in the middle")
        return original(*args, **more)

    setattr(owner, name, call)
    return lambda: setattr(owner, name, original)


def fails_to(call):
    """Blender's message on an add-on that raises is an error in some versions, and printed by others."""
    try:
        call()
    except RuntimeError as error:
        assert "in the middle" in str(error), error


def test_a_failed_registration_leaves_nothing():
    disable()
    with leak_check.Watch(common.MODULE) as watch:
        for name, at in (("register_tool", 3), ("register_class", 50)):
            put_back = failing(bpy.utils, name, at)
            try:
                fails_to(enable)
            finally:
                put_back()
            assert watch.left() == [], (name, watch.left())
        enable()
    test_everything_is_registered()


def test_a_failed_unregistration_leaves_only_its_own_rest():
    common.stock()
    live = common.part("sculpt.live_registry")
    run = live.begin(bpy.context, bpy.context.object)
    with leak_check.Watch(common.MODULE) as watch:
        put_back = failing(live.LiveSculpt, "end", 1)
        try:
            fails_to(disable)
        finally:
            put_back()
        assert watch.left() == [], watch.left()
        enable()
        run.end()
    test_everything_is_registered()


def test_detaching_what_was_never_attached_is_silent():
    """As after an attach() that failed at once."""
    disable()
    for module in common.part("registration").modules():
        if hasattr(module, "detach"):
            module.detach()
    enable()
    test_everything_is_registered()


def test_a_reload_replaces_all_modules():
    """After an update, and for Reload Scripts, Blender runs the add-on's __init__ again: all other modules must be
    reloaded, too."""
    disable()
    with leak_check.Watch(common.MODULE) as watch:
        enable()
        first = watch.left()
        seen = [common.part("blender.doctor").RIFFLER_OT_doctor]
        for _ in range(2):
            disable()
            importlib.reload(sys.modules[common.MODULE])
            enable()
            seen.append(common.part("blender.doctor").RIFFLER_OT_doctor)
            assert common.part("registration") is sys.modules[common.MODULE].registration
            assert watch.left() == first and set(dir(bpy.ops.riffler)) == operators()
        assert len(set(seen)) == 3
        test_everything_is_registered()
        disable()
        assert watch.left() == []
        enable()


def test_an_update_that_finds_the_old_core_loaded_reports_it():
    import riffler

    disable()
    version, riffler.__version__ = riffler.__version__, "0.0.9"
    try:
        enable()
        fallback = common.part("blender.fallback")
        assert {n for n in dir(bpy.types) if n.startswith("RIFFLER_")} == {c.__name__ for c in fallback.CLASSES[:2]}
        for words in (f"riffler 0.0.9 is in use, this add-on is {version}", "Restart Blender: it still uses the core"):
            assert words in fallback.text(), fallback.text()
        disable()
        assert sys.modules["riffler"] is riffler, "a second core would have been loaded"
    finally:
        riffler.__version__ = version
        enable()
    test_everything_is_registered()


def test_the_add_on_is_installed_over_itself():
    """Like an update while the core is in use: overwriting its file makes Blender crash in the next call."""
    from support import harness

    for _ in range(2):
        assert harness.install() == common.MODULE
        common.content(common.stock()).volume.to_bytes()


def test_a_sculpt_outlives_a_disabled_addon():
    ob = common.stock()
    name, before = ob.name, common.shape(common.content(ob).volume)
    disable()
    enable()
    ob = bpy.data.objects[name]
    assert common.same(before, common.shape(common.content(ob).volume))
