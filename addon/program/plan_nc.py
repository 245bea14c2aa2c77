"""From a plan to NC code: cutter locations free of collisions with part and fixtures, written for a machine."""

from dataclasses import replace

import bpy
import numpy as np
import riffler
from bpy.props import EnumProperty, FloatProperty

from ..blender import operator_parts, scene_units
from ..common import problems, units
from ..common.job import AfterJob, ChainJob
from ..plan import findings, fit_check, obstacles, plan_states, plan_store, replan, timeline
from ..plan.current_pose import plan_object
from ..plan.machines import MACHINES
from ..plan.operators.plan_work import PlanWork, part_poll, plan_poll
from ..plan.pure import location_messages
from . import programs
from .nc_file import WritesNc


class RIFFLER_OT_plan_resolve(PlanWork, bpy.types.Operator):
    """Find where the tool stands along the plan's paths: it is lifted along its axis where it would collide with the
    part or a fixture, and collisions that no lift removes are listed
    """

    bl_idname = "riffler.plan_resolve"
    bl_label = "Resolve"
    doing = "Resolving collisions"
    cancelled = "Resolving cancelled: the plan is unchanged"

    max_lift: FloatProperty(
        name="Max Lift",
        default=100.0,
        min=0.0,
        max=1e4,
        precision=2,
        description="Largest lift along the tool axis, in mm",
    )

    @classmethod
    def poll(cls, context):
        return plan_poll(cls, context) and part_poll(cls, context)

    def begin(self, context):
        ob, plan = self.take(context)
        taken = obstacles.take(context, ob)
        self._notes = fit_check.notes(context, plan, taken)
        clearance = scene_units.clean(context.scene.riffler.plan.clearance)
        self._mark = taken.fingerprint(plan.tool, clearance)
        same = plan.provenance.get(plan_store.RESOLVED) == self._mark
        turned = plan_store.wanted(plan)
        if not turned:
            raise ValueError(programs.nothing_wanted(plan))
        open_ones = set(plan_store.unresolved(plan)) if same else set(turned)
        self._paths = [k for k in turned if k in open_ones] or turned  # valid locations need not be found again
        self._found = []
        tool = riffler.plan.with_room(plan.tool, clearance)  # the cutter touches the surface that it cuts
        self._clearance, self._max_lift = clearance, scene_units.clean(self.max_lift)
        return AfterJob(taken, lambda near: self._all(plan, tool, near))

    def _all(self, plan, tool, near):
        self._near = near
        tolerance = plan.tolerance or 0.01

        def locate(k):
            path = plan.paths[k]
            if k in plan.depths:
                room = self._clearance
                kept = riffler.plan.kept_locations
                return riffler.submit(kept, path, plan.depths[k], plan.tool, near.collider, room, tolerance=tolerance)
            sizes = {"tolerance": tolerance, "max_lift": self._max_lift}
            return riffler.submit(riffler.plan.cutter_locations, path, tool, near.collider, **sizes)

        def start(k):
            def go(before):
                self._found += [before] if before is not None else []
                return locate(k)

            return go

        return ChainJob(*map(start, self._paths), text=units.counted(len(self._paths), "path"))

    def finish(self, context, job):
        ob, plan = self.ob, plan_store.plan(self.ob)
        cl = list(plan.cl) or [None] * len(plan.paths)
        kept = [e for e in findings.read(ob.riffler.plan.findings) if e["path"] not in self._paths]
        found, blocked = [*self._found, job.result], 0
        for k, (rows, report) in zip(self._paths, found, strict=True):
            entered = self._entered(plan, rows) if k in plan.depths else []
            free = report.ok and not entered
            cl[k] = rows if free else None  # a path with any collision is not written
            blocked += not free
            kept += location_messages.entries(k, plan.paths[k].centres, rows, report)
            kept += [location_messages.entered(k, plan.paths[k].centres[0], *fixture) for fixture in entered]
        plan = replace(plan, cl=cl, provenance={**plan.provenance, plan_store.RESOLVED: self._mark})
        plan_store.write(ob, plan)
        findings.write(ob.riffler.plan.findings, location_messages.ordered(kept))
        plan_store.refresh_rows(ob)
        if timeline.pair(ob) is not None:
            replan.sync(context.scene, ob)
        done = [k for k in self._paths if cl[k] is not None]
        free = [report for k, (_, report) in zip(self._paths, found, strict=True) if k in done]
        self._notes += self._too_near(plan, [cl[k] for k in done])
        self._say(ob, blocked, location_messages.left(free, plan.tolerance or 0.01))
        return {"FINISHED"}

    def _entered(self, plan, rows):
        """(mm, name) of the fixtures that a tool enters whose cutter is meant to enter the part."""
        return self._near.near_fixtures(plan.tool, rows, -(plan.tolerance or 0.01)) if len(rows) else []

    def _too_near(self, plan, free):
        """Reports where the cutter itself comes closer to a fixture than the clearance, for which only shank and holder
        are lifted."""
        room = scene_units.clean(bpy.context.scene.riffler.plan.clearance)
        if not free or room <= 0:
            return []
        near = self._near.near_fixtures(plan.tool, np.concatenate(free), room - (plan.tolerance or 0.01))
        said = "The tool comes within {} mm of {}, nearer than the clearance"
        return [said.format(units.trim(gap, 3), name) for gap, name in near]

    def _say(self, ob, blocked, left):
        count, played = units.counted(len(self._paths), "path"), timeline.pair(ob) is not None
        notes = [*self._notes, *(plan_states.state(ob).problems if played else [])]
        if blocked:
            collide, their = ("collides", "its") if blocked == 1 else ("collide", "their")
            switch = "switch it off" if blocked == 1 else "switch them off"
            done = f"{blocked} of {count} still {collide}: turn {their} keys, or {switch}"
        else:
            done = f"{count} {'are' if len(self._paths) > 1 else 'is'} free"
            done += f", but {left}" if left else ""
            done += f". {plan_states.state(ob).difference}" if played else ""
        operator_parts.tell_all(self, done, notes, blocked > 0 or left != "")


class RIFFLER_OT_plan_nc(WritesNc, bpy.types.Operator):
    """Write the plan's resolved paths as NC code in the scene's millimetres"""

    bl_idname = "riffler.plan_nc"
    bl_label = "Write NC"

    post: EnumProperty(
        name="Machine",
        items=MACHINES,
        default="tcp",
        options={"SKIP_SAVE"},
        description="Machine that the NC code is written for",
    )
    feed: FloatProperty(
        name="Feed", default=0.0, min=0.0, max=1e6, options={"SKIP_SAVE"}, description="mm/min; 0: the plan's"
    )
    spindle: FloatProperty(
        name="Spindle", default=-1.0, min=-1.0, max=1e6, options={"SKIP_SAVE"}, description="rev/min; -1: the plan's"
    )

    @classmethod
    def poll(cls, context):
        if plan_object(context) is None:
            return operator_parts.deny(cls, "Select a plan first, or find paths on a part")
        return not operator_parts.busy(cls, context, simulation=False)

    def _stem(self, context):
        return plan_object(context).name

    def _take_settings(self, context):
        """Settings that were not given are the scene's."""
        settings = context.scene.riffler.plan
        if not self.properties.is_property_set("post"):
            self.post = settings.post
        self.feed = self.feed or settings.feed
        self.spindle = settings.spindle if self.spindle < 0 else self.spindle

    def execute(self, context):
        self._take_settings(context)
        try:
            replan.flush()
            ob = plan_object(context)
            plan, chosen = plan_store.plan(ob), programs.options(context.scene, self.post, self.options)
            program = programs.of_plan(context, ob, plan, scene_units.clean(self.feed), scene_units.clean(self.spindle))
            path = bpy.path.abspath(self.filepath)
            problems.check_target(path)
            collider = obstacles.take(context, ob).result().collider
            written = programs.write(program, plan, path, self.post, chosen, collider)
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        self._tell(context, ob, path, written)
        return {"FINISHED"}

    def _tell(self, context, ob, path, written):
        done = f"{bpy.path.basename(path)}: {units.counted(written.blocks, 'block')}"
        plan = plan_store.plan(ob)
        said = (programs.left_out(plan), fit_check.tool_note(context.scene.riffler.plan, plan.tool))
        notes = [note for note in said if note]
        if timeline.pair(ob) is not None:
            difference = plan_states.state(ob).difference
            notes += plan_states.state(ob).problems  # a refused key is on the timeline, but not in the code
            if difference.small:
                done = f"{done}. {difference}"
            else:
                notes.append(str(difference))
        notes += programs.rewound(written)
        operator_parts.tell_all(self, done, notes)

    def draw(self, context):
        operator_parts.draw_fields(self, ("post", "feed", "spindle"))


CLASSES = (RIFFLER_OT_plan_resolve, RIFFLER_OT_plan_nc)
