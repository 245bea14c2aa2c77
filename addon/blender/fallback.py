"""Registered if the native core does not load: a panel with the reason and the remedy."""

import bpy

from ..common import diagnosis

_report = {"why": "", "facts": [], "steps": [], "text": ""}


def set_error(error):
    _report.update(diagnosis.report(error, diagnosis.Machine.current(bpy.app.version_string)))
    print(_report["text"])  # support asks for the console's text first


def text():
    return _report["text"]


class RIFFLER_OT_copy_report(bpy.types.Operator):
    """Copy this report to the clipboard"""

    bl_idname = "riffler.copy_report"
    bl_label = "Copy Report"

    def execute(self, context):
        context.window_manager.clipboard = _report["text"]
        self.report({"INFO"}, "Copied")
        return {"FINISHED"}


class RIFFLER_PT_fallback(bpy.types.Panel):
    bl_idname = "RIFFLER_PT_fallback"
    bl_label = "Riffler Cannot Start"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Riffler"

    def draw(self, context):
        _draw(self.layout, context)


class RifflerFallbackPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__.rpartition(".")[0]

    def draw(self, context):
        _draw(self.layout, context)


def _draw(layout, context):
    # Labels do not wrap: fit them to the region's width.
    width = max(24, int(context.region.width / (7.2 * context.preferences.system.ui_scale)) - 6)
    layout.label(text="Native core not loaded", icon="ERROR")
    for title, texts in (
        ("Why", [_report["why"]]),
        ("How to fix it", _report["steps"]),
        ("Facts", _report["facts"]),
    ):
        box = layout.box().column(align=True)
        box.label(text=title)
        for entry in texts:
            for k, line in enumerate(diagnosis.wrap(entry, width)):
                box.label(text=line if k == 0 else f"   {line}")
    layout.operator(RIFFLER_OT_copy_report.bl_idname, icon="COPYDOWN")


CLASSES = (RIFFLER_OT_copy_report, RIFFLER_PT_fallback, RifflerFallbackPreferences)
