"""Enabled, disabled and enabled again: nothing stays behind, nothing is missing."""

import bpy

import support

OPERATORS = {
    "cut_curve",
    "cut_recording",
    "export_nc",
    "export_recording",
    "export_stl",
    "fit_pitch",
    "millimetres",
    "new_stock",
    "pen_home",
    "pen_reset",
    "pen_sculpt",
    "rebuild",
    "tool_preset",
}


def leftovers():
    classes = [n for n in dir(bpy.types) if n.startswith("RIFFLER_")]
    attributes = [
        t.__name__ for t in (bpy.types.Scene, bpy.types.Mesh, bpy.types.WindowManager) if hasattr(t, "riffler")
    ]
    handlers = [
        f"{n}: {f.__module__}"
        for n in dir(bpy.app.handlers)
        if isinstance(getattr(bpy.app.handlers, n), list)
        for f in getattr(bpy.app.handlers, n)
        if f.__module__.startswith(support.MODULE)
    ]
    return classes + attributes + handlers


def test_the_native_core_is_the_one_that_was_installed():
    import os

    import riffler

    inside = riffler.__file__.startswith(os.path.realpath(os.environ["BLENDER_USER_RESOURCES"]))
    assert inside == (support.JOB["mode"] != "source"), riffler.__file__


def test_everything_is_registered():
    assert set(dir(bpy.ops.riffler)) >= OPERATORS, dir(bpy.ops.riffler)
    panels = [c for c in bpy.types.Panel.__subclasses__() if getattr(c, "bl_category", "") == "Riffler"]
    assert len(panels) == 6, panels


def test_three_cycles_leave_nothing():
    support.stock()
    for _ in range(3):
        bpy.ops.preferences.addon_disable(module=support.MODULE)
        assert leftovers() == []
        bpy.ops.preferences.addon_enable(module=support.MODULE)
        assert leftovers()
        assert set(dir(bpy.ops.riffler)) >= OPERATORS


def test_a_sculpt_outlives_a_disabled_addon():
    ob = support.stock()
    name, before = ob.name, support.shape(support.content(ob).volume)
    bpy.ops.preferences.addon_disable(module=support.MODULE)
    bpy.ops.preferences.addon_enable(module=support.MODULE)
    ob = bpy.data.objects[name]
    assert support.same(before, support.shape(support.content(ob).volume))
