"""From a plan to NC code, with simulation and verification: findings, and going to each."""

import bpy

from ..blender import versions
from ..blender.panel_parts import lines, wrapped
from ..plan import current_pose, machine_panel, timeline
from ..plan.panel import OfPlan, Tab
from ..translations import local
from . import plan_nc, programs, properties, simulation, verify

ICONS = {
    "blocked": "CANCEL",
    "unsafe": "ERROR",
    "lifted": "TRIA_UP",
    "inserted": "ADD",
    "gouge": "REMOVE",
    "rest": "ADD",
    "machine": "SETTINGS",
    "unknown": "QUESTION",
}


class RIFFLER_UL_findings(bpy.types.UIList):
    bl_idname = "RIFFLER_UL_findings"

    def draw_item(self, context, layout, data, item, icon, active_data, active_property, index=0):
        row = layout.row(align=True)
        row.label(text=item.title or item.name, icon=ICONS.get(item.kind, "ERROR"))
        op = row.operator(verify.RIFFLER_OT_finding_go.bl_idname, text="", icon="VIEWZOOM", emboss=False)
        op.of, op.index = ("PLAN" if item.path >= 0 else "VERIFY"), index


def resolved(p):
    """How many paths of a plan (properties.RifflerPlanObject) are ready for NC code; "" if not counted yet."""
    if p.resolved < 0:
        return ""
    off = sum(not row.on for row in p.rows)
    said = f"{p.resolved} of {p.paths} paths resolved"
    said += f", {p.paths - p.keyed - off} without keys" if p.keyed + off < p.paths else ""
    return f"{said}, {off} off" if off else said


def found(layout, context, name, of, rows):
    """The list of findings of a plan or a verification, which truncates them, and the full text of the selected one
    below it."""
    layout.template_list(RIFFLER_UL_findings.bl_idname, name, of, "findings", of, "index", rows=rows)
    if 0 <= of.index < len(of.findings):
        item = of.findings[of.index]
        line = f", {local('line {}').format(item.line)}" if item.line > 0 else ""
        lines(layout, *wrapped(context, f"{item.title}{line}: {item.name}" if item.title else item.name))


class RIFFLER_PT_nc(OfPlan, bpy.types.Panel):
    bl_idname = "RIFFLER_PT_nc"
    bl_label = "NC Code (mm)"

    def draw(self, context):
        layout, ob = self.layout, current_pose.plan_object(context)
        layout.operator(plan_nc.RIFFLER_OT_plan_resolve.bl_idname, icon="MOD_PHYSICS")
        p = ob.riffler.plan
        if said := resolved(p):
            lines(layout, *wrapped(context, said), icon="CHECKMARK" if 0 < p.keyed == p.resolved else "INFO")
        if p.findings:
            found(layout, context, "plan", p, rows=3)
            if timeline.pair(ob) is None:
                lines(layout, *wrapped(context, "Put the plan on the timeline to jump to frames."), icon="INFO")
        layout.operator(plan_nc.RIFFLER_OT_plan_nc.bl_idname, icon="EXPORT")


class RIFFLER_PT_verify(Tab, bpy.types.Panel):
    bl_idname = "RIFFLER_PT_verify"
    bl_label = "Simulate and Verify (mm)"

    def draw(self, context):
        layout = self.layout
        settings = context.scene.riffler.verify
        self._program(layout, context, settings)
        row = layout.row(align=True)
        op = row.operator(simulation.RIFFLER_OT_simulate.bl_idname, icon="PLAY")
        self._give(op, settings, properties.ProgramSettings)
        if simulation.active() is not None:
            row.operator(simulation.RIFFLER_OT_simulate_stop.bl_idname, text="", icon="X")
        column = layout.column(align=True)
        column.use_property_split = True
        column.use_property_decorate = False
        for key in properties.VerifySettings.__annotations__:
            column.prop(settings, key)
        row = layout.row(align=True)
        op = row.operator(verify.RIFFLER_OT_verify.bl_idname, icon="CHECKMARK")
        self._give(op, settings, properties.VerifySettings)
        if settings.said:
            row.operator(verify.RIFFLER_OT_verify_clear.bl_idname, text="", icon="X")
            self._found(layout, context, settings)

    def _found(self, layout, context, settings):
        lines(layout, *wrapped(context, settings.said), icon="ERROR" if settings.findings else "CHECKMARK")
        if settings.findings:
            found(layout, context, "verify", settings, rows=4)

    def _program(self, layout, context, settings):
        column = layout.column(align=True)
        column.use_property_split = True
        column.use_property_decorate = False
        column.prop(settings, "source")
        if settings.source == "FILE":
            for key in ("filepath", "frame", "machine"):
                column.prop(settings, key)
            machine_panel.draw_options(layout, context, settings.machine)
            column = layout.column(align=True)
            column.use_property_split = True
            column.use_property_decorate = False
        if settings.source == "JOB":
            return
        column.prop(settings, "stock")
        if settings.stock is None:
            ob = programs.stock_object(context)
            said = f"Stock: {ob.name}" if ob else "Choose a stock, or select a sculpt"
            lines(layout, *wrapped(context, said), icon="INFO")

    def _give(self, op, settings, group):
        """Gives an operator the settings of a group, and of its base classes."""
        for key in versions.fields_of(group):
            setattr(op, key, getattr(settings, key))


CLASSES = (RIFFLER_UL_findings, RIFFLER_PT_nc, RIFFLER_PT_verify)
