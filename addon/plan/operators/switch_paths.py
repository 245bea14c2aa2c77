"""Switches several paths of a plan on or off, or deletes them."""

from dataclasses import replace

import bpy
from bpy.props import EnumProperty

from ...blender import operator_parts, scene_units
from ...common import units
from .. import findings, path_curves, path_switches, plan_states, plan_store, replan, timeline
from ..current_pose import plan_object
from ..pure import location_messages
from . import keys
from .plan_work import plan_poll

SWITCH = (
    ("ALL", "All On", "Every path is resolved and written"),
    ("NONE", "All Off", "No path is resolved or written"),
    ("INVERT", "Invert", "Switch on paths that are off, and off paths that are on"),
    ("ONLY", "Only the Selected Path", "Switch on only the path selected in the list"),
    ("BLOCKED", "Blocked Paths Off", "Switch off the paths on which the tool collides"),
    ("UNPLANNED", "Paths Without Keys Off", "Switch off the paths without key orientations"),
)
DELETED = (
    ("CHOSEN", "Selected Path", "The path selected in the list"),
    ("OFF", "Paths That Are Off", "Paths that are switched off"),
)


class RIFFLER_OT_plan_switch(bpy.types.Operator):
    """Switch several paths on or off; paths that are off are neither resolved nor written"""

    bl_idname = "riffler.plan_switch"
    bl_label = "Switch Paths"
    bl_options = {"REGISTER", "UNDO"}

    which: EnumProperty(name="Paths", items=SWITCH, default="ALL", description="Paths to switch on or off")

    @classmethod
    def poll(cls, context):
        return plan_poll(cls, context)

    def execute(self, context):
        try:
            replan.flush()
            ob = plan_object(context)
            plan = plan_store.plan(ob)
            off = self._off(ob, plan)
            path_switches.switch_to(ob, off)
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        on, of = units.format_count(len(plan.paths) - len(off)), units.format_count(len(plan.paths))
        self.report({"INFO"}, f"{ob.name}: {on} of {of} paths are on")
        return {"FINISHED"}

    def _off(self, ob, plan):
        every, rows = set(range(len(plan.paths))), ob.riffler.plan.rows
        if self.which == "ONLY":
            if ob.riffler.plan.row not in every:
                raise ValueError("No path is selected in the list: click one")
            return every - {ob.riffler.plan.row}
        states = {k: row.state for k, row in enumerate(rows)}
        return {
            "ALL": set(),
            "NONE": every,
            "INVERT": every - plan.off,
            "BLOCKED": plan.off | {k for k in every if states[k] == "blocked"},
            "UNPLANNED": plan.off | {k for k in every if not len(plan.paths[k].axes)},
        }[self.which]


class RIFFLER_OT_plan_delete_paths(bpy.types.Operator):
    """Delete paths and their keys from the plan; the other paths keep their keys and are renumbered"""

    bl_idname = "riffler.plan_delete_paths"
    bl_label = "Delete Paths"
    bl_options = {"REGISTER", "UNDO"}

    which: EnumProperty(name="Paths", items=DELETED, default="CHOSEN", description="Paths to delete")

    @classmethod
    def poll(cls, context):
        return plan_poll(cls, context) and operator_parts.object_mode(cls, context)

    def execute(self, context):
        try:
            replan.flush()
            ob = plan_object(context)
            plan = plan_store.plan(ob)
            going = self._going(ob, plan)
            self._delete(context, ob, plan, going)
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        left = units.format_count(len(plan.paths) - len(going))
        self.report({"INFO"}, f"{ob.name}: {units.counted(len(going), 'path')} deleted, {left} left")
        return {"FINISHED"}

    def _going(self, ob, plan):
        if self.which == "OFF":
            if not plan.off:
                raise ValueError("No path is off: switch off the paths to delete")
            return set(plan.off)
        if not 0 <= ob.riffler.plan.row < len(plan.paths):
            raise ValueError("No path is selected in the list: click one")
        return {ob.riffler.plan.row}

    def _delete(self, context, ob, plan, going):
        kept = [k for k in range(len(plan.paths)) if k not in going]
        number = {k: n for n, k in enumerate(kept)}
        cl = list(plan.cl) or [None] * len(plan.paths)
        after = replace(
            plan,
            paths=[plan.paths[k] for k in kept],
            cl=[cl[k] for k in kept],
            off=frozenset(number[k] for k in plan.off if k in number),
            depths={number[k]: depth for k, depth in plan.depths.items() if k in number},
        )
        p, found = ob.riffler.plan, timeline.pair(ob)
        marks = [
            location_messages.renumbered(e, number[e["path"]]) for e in findings.read(p.findings) if e["path"] in number
        ]
        plan_store.write(ob, after)
        findings.write(p.findings, marks)
        plan_store.refresh_rows(ob)
        if context.object is not None and context.object.parent == ob:
            context.view_layer.objects.active = ob  # the active curve may be deleted
        if found is not None and after.paths:
            keys.lay_out(context, ob, after, (found[0][timeline.RATE], found[0][timeline.FIRST]))
        path_curves.show(ob, after, scene_units.mm_per_unit(context.scene))
        path_switches.show(ob)
        if found is not None and not after.paths:
            replan.sync(context.scene, ob)
        if p.row >= len(after.paths):
            p.row = len(after.paths) - 1
        plan_states.tell_followers()


CLASSES = (RIFFLER_OT_plan_switch, RIFFLER_OT_plan_delete_paths)
