"""The paths of the plan as a list: on or off, state, length; a click on one goes there."""

import bpy

from ..blender.panel_parts import lines, wrapped
from ..common import units
from ..translations import local
from . import path_rows
from .current_pose import plan_object
from .operators import switch_paths
from .panel import OfPlan
from .properties import STATES

ICONS = {"free": "CHECKMARK", "blocked": "CANCEL", "keyed": "KEYFRAME_HLT", "unplanned": "KEYFRAME", "off": "REMOVE"}
SAID = {state: said for state, said, _ in STATES}
MEANS = {state: means for state, _, means in STATES}


class RIFFLER_UL_paths(bpy.types.UIList):
    bl_idname = "RIFFLER_UL_paths"

    def draw_item(self, context, layout, data, item, icon, active_data, active_property, index=0):
        row = layout.row(align=True)
        row.prop(item, "on", text="")
        split = row.split(factor=0.65)
        split.active = item.on
        split.label(text=item.name, icon=ICONS[item.state], translate=False)
        end = split.row()
        end.alignment = "RIGHT"
        end.label(text=units.trim(item.length, 1), translate=False)


class RIFFLER_PT_plan_paths(OfPlan, bpy.types.Panel):
    bl_idname = "RIFFLER_PT_plan_paths"
    bl_label = "Paths (mm)"

    def draw(self, context):
        layout, ob = self.layout, plan_object(context)
        p, settings = ob.riffler.plan, context.scene.riffler.plan
        row = layout.row()
        row.template_list(RIFFLER_UL_paths.bl_idname, "", p, "rows", p, "row", rows=5)
        column = row.column(align=True)
        column.operator_menu_enum(switch_paths.RIFFLER_OT_plan_switch.bl_idname, "which", text="", icon="CHECKBOX_HLT")
        column.operator_menu_enum(switch_paths.RIFFLER_OT_plan_delete_paths.bl_idname, "which", text="", icon="TRASH")
        if 0 <= p.row < len(p.rows):
            item = p.rows[p.row]
            said = f"{item.name}: {local(SAID[item.state])}. {local(MEANS[item.state])}"
            lines(layout, *wrapped(context, said), icon=ICONS[item.state])
        lines(layout, *wrapped(context, summary(p)))
        row = layout.row(align=True)
        row.prop(settings, "draw_paths", toggle=True)
        row.prop(settings, "frame_names", toggle=True)


def summary(p):
    """“284 paths on, 5204.1 mm: 280 Free, 4 Blocked”, of those that are on."""
    found = path_rows.counts(p)
    off = found.pop("off", 0)
    length = units.trim(sum(row.length for row in p.rows if row.on), 1)
    parts = [f"{units.format_count(found[state])} {local(SAID[state])}" for state in SAID if state in found]
    head = f"{units.format_count(len(p.rows) - off)} {local('on')}, {length} mm"
    return f"{head}: {', '.join(parts)}" if parts else head


CLASSES = (RIFFLER_UL_paths, RIFFLER_PT_plan_paths)
