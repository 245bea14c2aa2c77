"""The paths of a plan, several at a time: switched on and off, deleted."""

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
    ("NONE", "All Off", "No path is"),
    ("INVERT", "Invert", "What is on goes off, and what is off comes on"),
    ("ONLY", "Only the Chosen One", "All are off but the one that is chosen in the list"),
    ("BLOCKED", "Blocked Off", "Paths on which the tool collides are left out"),
    ("UNPLANNED", "Without Keys Off", "Paths without key orientations are left out"),
)
DELETED = (
    ("CHOSEN", "The Chosen One", "The path that is chosen in the list"),
    ("OFF", "All That Are Off", "Paths that are left out anyway"),
)


class RIFFLER_OT_plan_switch(bpy.types.Operator):
    """Switch several paths on or off: what is off is neither resolved nor written"""

    bl_idname = "riffler.plan_switch"
    bl_label = "Switch Paths"
    bl_options = {"REGISTER", "UNDO"}

    which: EnumProperty(name="Which", items=SWITCH, default="ALL", description="Which paths are on afterwards")

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
                raise ValueError("No path is chosen: click one in the list")
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
    """Delete paths from the plan, with their keys; the others keep theirs, and get new numbers"""

    bl_idname = "riffler.plan_delete_paths"
    bl_label = "Delete Paths"
    bl_options = {"REGISTER", "UNDO"}

    which: EnumProperty(name="Which", items=DELETED, default="CHOSEN", description="Which paths go")

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
                raise ValueError("No path is off: switch those off that are to go")
            return set(plan.off)
        if not 0 <= ob.riffler.plan.row < len(plan.paths):
            raise ValueError("No path is chosen: click one in the list")
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
            context.view_layer.objects.active = ob  # the curve that may be active goes
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
