"""The sculpt tool's settings: in the header, in the sidebar, and in a pie under the pointer."""

import bpy

from ..blender import object_surfaces
from ..blender.panel_parts import Sidebar, lines
from ..common import presets, units
from ..translations import CONTEXT
from . import brushes, first_stroke, live_registry, sculpts, tool_panel

AROUND = 4  # places of the pie reserved for brushes
COLUMNS = 3  # of brushes with falloff in the sidebar


def choose(layout, brush, **how):
    """A button that makes the brush's tool the active one."""
    layout.operator("wm.tool_set_by_id", text=brush.label, text_ctxt=CONTEXT, **how).name = brush.tool


def fields(context):
    """(stroke settings, cutter settings) of the scene for panels, without undo steps."""
    shown = context.window_manager.riffler
    return shown.sculpt, shown.tool


def draw_header(context, layout):
    stroke, _ = fields(context)
    if sculpts.active(context) is None:
        begin_button(layout, context)
    brush = brushes.active(context)
    hand = brush is not None and brush.hand
    tool_panel.preset_menu(layout, context, hand)
    if hand:
        layout.prop(stroke, "width", text="Width (mm)")
    else:
        layout.prop(stroke, "radius", text="Radius (mm)")
    if brush is not None and brush.second == "STRENGTH":
        layout.prop(stroke, "strength", slider=True)
    else:
        layout.prop(stroke, "depth", text="Depth (mm)")
    if brush is not None and brush.falloff:
        layout.prop(stroke, "falloff", text="")
    elif brush is None or brush.second != "STRENGTH":
        layout.prop(stroke, "axis", text="")
    if hand:
        layout.prop(context.window_manager.riffler.hand_tool, "lean")
    row = layout.row(align=True)
    row.label(icon="MOD_MIRROR")
    row.prop(stroke, "mirror", expand=True)
    layout.popover(RIFFLER_PT_sculpt_tool.bl_idname, text="Stroke", text_ctxt=CONTEXT)


def begin_button(layout, context):
    """A button that makes the active object a sculpt, if it can become one."""
    source = object_surfaces.source_object(context)
    if source is not None:
        layout.operator(first_stroke.RIFFLER_OT_make_sculpt.bl_idname, text="Make Sculpt", icon="SCULPTMODE_HLT")


class RIFFLER_PT_sculpt_tool(Sidebar, bpy.types.Panel):
    bl_idname = "RIFFLER_PT_sculpt_tool"
    bl_label = "Stroke (mm, mm/s, N)"
    bl_order = 2
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        settings, _ = fields(context)
        self._tools(layout, context)
        brush = brushes.active(context)
        column = layout.column(align=True)
        column.prop(settings, brush.first.lower() if brush is not None else "radius")
        column.prop(settings, "depth")
        layout.prop(settings, "axis")
        layout.prop(settings, "pressure")
        if settings.pressure == "FEED" or settings.show_force:
            layout.prop(settings, "feed")
        layout.prop(settings, "string")
        layout.prop(settings, "strength")
        if brush is not None and brush.falloff:
            layout.prop(settings, "falloff")
        layout.prop(settings, "accumulate")
        layout.prop(context.scene.riffler.sculpt, "fixtures")
        self._symmetry(layout, settings)
        column = layout.column(align=True)
        column.prop(settings, "show_force")
        if settings.show_force:
            column.prop(settings, "limit")
        self._work(layout, context)

    def _tools(self, layout, context):
        active = brushes.active(context)
        row = layout.row(align=True)
        for brush in brushes.with_tool():
            if not brush.falloff:
                choose(row, brush, depress=brush is active)
        if active is None or not active.falloff:
            return
        grid = layout.grid_flow(row_major=True, columns=COLUMNS, even_columns=True, align=True)
        for brush in brushes.with_tool():
            if brush.falloff:
                choose(grid, brush, depress=brush is active)

    def _symmetry(self, layout, settings):
        row = layout.row(heading="Mirror", align=True)
        row.prop(settings, "mirror", expand=True)
        layout.prop(settings, "radial")
        if settings.radial > 1:
            layout.prop(settings, "radial_axis", expand=True)

    def _work(self, layout, context):
        run = live_registry.of(sculpts.active(context))
        if run is None:
            return
        if told := looks(run.stages):
            lines(layout, *told, icon="TIME")


def looks(stages):
    """Time and counts of a display update, in lines as short as the panel is wide. Empty before the first update."""
    times, counts = stages.milliseconds(), stages.per_look()
    whole = sum(times.values())
    if not whole:
        return []
    shares = {name: f"{name} {100 * ms / whole:.0f} %" for name, ms in times.items()}
    middle, longest = stages.lag()
    lag = [f"Lag: {middle:.0f} ms, at most {longest:.0f}"] if longest else []
    return [
        f"Update: {whole:.1f} ms",
        f"{shares['cut']}, {shares['mesh']}",
        f"{shares['transfer']}, {shares['draw']}",
        f"{counts['bricks']:.1f} tiles, {counts['chunks']:.1f} chunks",
        f"{units.format_count(counts['triangles'])} triangles, {units.format_bytes(counts['bytes'])}",
        *lag,
    ]


class RIFFLER_MT_sculpt_pie(bpy.types.Menu):
    bl_idname = "RIFFLER_MT_sculpt_pie"
    bl_label = "Sculpt"

    def draw(self, context):
        pie = self.layout.menu_pie()
        cutters = [brush for brush in brushes.with_tool() if not brush.falloff]  # the pie has no room for all
        around, more = cutters[:AROUND], cutters[AROUND:]
        for brush in around:  # left, right, below, above
            choose(pie, brush)
        settings, tool = fields(context)
        box = pie.box().column()
        box.prop(tool, "kind", text="")
        for key in presets.SIZES[tool.kind][:2]:
            box.prop(tool, key)
        box = pie.box().column()
        for brush in more:
            choose(box, brush)
        box.prop(settings, "depth")
        box.prop(settings, "axis", text="")
        box.prop(settings, "string")
        row = pie.box().row(align=True)
        row.prop(settings, "mirror", expand=True)
        pie.prop(settings, "accumulate")


CLASSES = (RIFFLER_PT_sculpt_tool, RIFFLER_MT_sculpt_pie)
