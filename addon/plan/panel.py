"""The plan's tab: part, fixtures, tool, settings, missing input, and findings. Drawing reads properties, and the
results that plan/operators/watch.py has already."""

import math

import bpy
import riffler

from ..blender import object_surfaces, operator_parts, scene_units, versions
from ..blender.panel_parts import Sidebar, give, lines, wrapped
from ..common import presets, units
from ..sculpt import sculpts
from ..translations import local
from . import fit_check, obstacles, plan_store, properties, strategy_fields, tool_icons, tool_libraries
from .current_pose import plan_object
from .operators import change_tool, find, from_strokes, scene_unit, setup, watch
from .pure import size_guess, tool_library

PICTURE = 4.5  # height of a tool's picture, in lines


class Tab(Sidebar):
    """Mixin of the tab's panels."""

    bl_category = "Riffler Plan"


class OfPlan(Tab):
    """Mixin of the panels that need a plan."""

    @classmethod
    def poll(cls, context):
        return plan_object(context) is not None


def draw_library(layout, take):
    """Draws a button of the operator `take` for each tool of the library; returns a line for each file that cannot be
    read."""
    entries, problems = tool_libraries.files()
    for entry in (*entries, *tool_library.shipped()):
        op = layout.operator(take, text=entry.name, icon_value=tool_icons.icon(entry.tool), translate=False)
        op.name, op.path = entry.name, str(entry.path or "")
    return problems


class RIFFLER_MT_plan_tools(bpy.types.Menu):
    bl_idname = "RIFFLER_MT_plan_tools"
    bl_label = "Tool Library"

    def draw(self, context):
        layout = self.layout
        take = setup.RIFFLER_OT_plan_tool.bl_idname
        problems = draw_library(layout, take)
        layout.separator()
        layout.operator(take, text="Cutter of the Tool Panel", icon="FORWARD").sculpting = True
        layout.operator(setup.RIFFLER_OT_plan_tool_open.bl_idname, text="Open File…", icon="FILEBROWSER")
        for problem in problems:
            layout.label(text=problem, icon="ERROR")


class RIFFLER_PT_plan(Tab, bpy.types.Panel):
    bl_idname = "RIFFLER_PT_plan"
    bl_label = "Plan (mm)"

    def draw(self, context):
        layout = self.layout
        ob = plan_store.active(context)
        state = context.window_manager.riffler
        if ob is not None:
            self._plan(layout, context, ob)
        self._next(layout, context, ob)
        if state.running:
            versions.progress(layout, state)
            layout.label(text=state.text)
            return
        column = layout.column(align=True)
        column.use_property_split = True
        column.use_property_decorate = False
        settings = context.scene.riffler.plan
        for key in ("strategy", *strategy_fields.shown(settings)):
            column.prop(settings, key)
        self._find(layout, context, "")
        if ob is not None:
            self._find(layout, context, ob.name)
        if sculpts.active(context) is not None:
            layout.operator(from_strokes.RIFFLER_OT_plan_from_strokes.bl_idname, icon="GREASEPENCIL")

    def _plan(self, layout, context, ob):
        p = ob.riffler.plan
        layout.label(text=ob.name, icon="CURVE_DATA", translate=False)
        own = watch.part_of(context.scene, ob)
        part = own.name if own else "a deleted part"
        count = f"Paths: {units.format_count(p.paths)}, {units.trim(p.length, 1)} mm"
        lines(layout, count, *wrapped(context, f"On {part} with {p.tool}"))
        verdict = watch.known(context, ob)
        if verdict is None:
            return
        if verdict.part:
            lines(layout, *wrapped(context, f"{verdict.part}. Find the paths again."), icon="ERROR")
        if verdict.edited:
            edits = f"Curves that were edited or are gone: {units.format_count(verdict.edited)}. The plan is unchanged."
            lines(layout, *wrapped(context, edits), icon="ERROR")
            layout.operator(find.RIFFLER_OT_plan_show.bl_idname, icon="FILE_REFRESH")
        if verdict.tool is not None and (note := fit_check.tool_note(context.scene.riffler.plan, verdict.tool)):
            lines(layout, *wrapped(context, f"{note}."), icon="ERROR")
            layout.operator(change_tool.RIFFLER_OT_plan_use_tool.bl_idname, icon="TOOL_SETTINGS")

    def _next(self, layout, context, ob):
        """The missing input of a search, or the next step."""
        settings = context.scene.riffler.plan
        if why := object_surfaces.unfit(settings.part, context.scene):
            lines(layout, *wrapped(context, f"{why}."), icon="INFO")
        elif why := find.missing(context, settings):
            lines(layout, *wrapped(context, f"{local(why)}."), icon="INFO")
        elif ob is None:
            plans = plan_store.in_scene(context.scene)
            said = "Select one of the plans, or find another." if plans else "Next: find the paths."
            lines(layout, *wrapped(context, said), icon="INFO")

    def _find(self, layout, context, replace):
        action = strategy_fields.chosen(context.scene.riffler.plan).action
        text, icon = ("Find Again", "FILE_REFRESH") if replace else (action, "VIEWZOOM")
        op = layout.operator(find.RIFFLER_OT_plan_find.bl_idname, text=text, icon=icon)
        op.replace = replace
        give(op, context.scene.riffler.plan, properties.FindSettings)


class RIFFLER_PT_plan_part(Tab, bpy.types.Panel):
    bl_idname = "RIFFLER_PT_plan_part"
    bl_label = "Part and Fixtures"

    def draw(self, context):
        layout = self.layout
        settings = context.scene.riffler.plan
        layout.label(text="Part")
        row = layout.row(align=True)
        row.prop(settings, "part", text="")
        row.operator(setup.RIFFLER_OT_plan_part.bl_idname, text="", icon="IMPORT")
        self._size(layout, context, settings)
        layout.label(text="Fixtures")
        row = layout.row(align=True)
        row.prop(settings, "fixtures", text="")
        row.operator(setup.RIFFLER_OT_plan_fixtures_add.bl_idname, text="", icon="ADD")
        row.operator(setup.RIFFLER_OT_plan_fixtures_remove.bl_idname, text="", icon="REMOVE")
        try:
            held = [ob.name for ob in obstacles.fixture_objects(settings, settings.part)]
        except ValueError as error:
            lines(layout, *wrapped(context, f"{error}."), icon="ERROR")
            return
        if held:
            lines(layout, *wrapped(context, f"Stays clear of {', '.join(held)}"))

    def _size(self, layout, context, settings):
        """The part's size; if it is unusual, the units that would make it usual."""
        if object_surfaces.unfit(settings.part, context.scene):
            return
        size = object_surfaces.size(settings.part, context.scene)
        lines(layout, units.format_size(size))
        if why := fit_check.size_question(context.scene):
            box = layout.box()
            lines(box, *wrapped(context, why), icon="QUESTION")
            column, one = box.column(align=True), max(size) / scene_units.mm_per_unit(context.scene)
            for unit, _, _ in scene_unit.UNITS:
                long = one * size_guess.UNITS[unit]
                text = f"{local(scene_unit.LABELS[unit])}: {units.trim(long, 1)} mm"
                if unit == size_guess.likely(one):
                    text = f"{text}, {local('likely')}"
                elif math.isclose(long, max(size), rel_tol=1e-6):
                    text = f"{text}, {local('unchanged')}"
                op = column.operator(scene_unit.RIFFLER_OT_scene_unit.bl_idname, text=text, translate=False)
                op.unit = unit


class RIFFLER_PT_plan_tool(Tab, bpy.types.Panel):
    bl_idname = "RIFFLER_PT_plan_tool"
    bl_label = "Tool (mm)"

    def draw(self, context):
        layout = self.layout
        settings = context.scene.riffler.plan
        try:
            given = settings.tool_dict()
            tool = riffler.Tool.from_dict(given)
        except operator_parts.ERRORS as error:
            layout.menu(RIFFLER_MT_plan_tools.bl_idname, text="Choose a tool")
            lines(layout, *wrapped(context, str(error)), icon="ERROR")
            return
        layout.menu(RIFFLER_MT_plan_tools.bl_idname, text=tool.name, translate=False)
        row = layout.row()
        row.template_icon(icon_value=tool_icons.icon(tool_icons.cutter(given)), scale=PICTURE)
        if tool.shank or tool.holder:
            row.template_icon(icon_value=tool_icons.icon(given), scale=PICTURE)
        self._sizes(layout, context, tool)
        lines(layout, *_facts(tool))
        row = layout.row(align=True)
        row.operator(setup.RIFFLER_OT_plan_assembly.bl_idname, text="Holder…")
        row.operator(setup.RIFFLER_OT_plan_tool_save.bl_idname, text="Save…")

    def _sizes(self, layout, context, tool):
        """The tool's sizes; a free profile has none."""
        if tool.kind not in presets.SIZES:
            lines(layout, f"Cutter: Ø {units.trim(tool.diameter)}, {units.trim(tool.length)} mm long")
            return
        column = layout.column(align=True)
        column.use_property_split = True
        column.use_property_decorate = False
        for key in ("kind", *presets.SIZES[tool.kind]):
            column.prop(context.scene.riffler.cutter, key)


def _facts(tool):
    for what, pieces in (("Shank", tool.shank), ("Holder", tool.holder)):
        if pieces:
            widest = 2 * max(max(r0, r1) for _, r0, _, r1 in pieces)
            yield f"{what}: Ø {units.trim(widest)}, {units.trim(pieces[0][0])} to {units.trim(pieces[-1][2])} mm"
    if not tool.holder:
        yield "No holder: it is not looked at."


CLASSES = (
    RIFFLER_MT_plan_tools,
    RIFFLER_PT_plan_part,
    RIFFLER_PT_plan_tool,
    RIFFLER_PT_plan,
)
