"""Finds paths on the part with a strategy, on a thread of its own; the result is a plan and its curves."""

import functools

import bpy
import riffler

from ...blender import object_surfaces, operator_parts, scene_units
from ...blender.long_work import LongWork
from ...common import units
from ...common.job import TaskJob, ThreadTask
from ...sculpt import live_registry, sculpt_work
from ...translations import local
from .. import (
    fit_check,
    given_curves,
    obstacles,
    path_curves,
    path_switches,
    plan_states,
    plan_store,
    properties,
    replan,
    strategy_fields,
    timeline,
)


def missing(context, settings):
    """A message on the chosen strategy's missing input and the next step, or "". Cheap enough for a panel."""
    strategy, ob = strategy_fields.chosen(settings), plan_store.active(context)
    there = {
        "curves": given_curves.objects(context),
        "paths": ob is not None and any(r.on for r in ob.riffler.plan.rows),
    }
    return "" if there.get(strategy.needs, True) else strategy.missing


class RIFFLER_OT_plan_find(LongWork, properties.FindSettings, bpy.types.Operator):
    """Find paths on the part with a strategy, and make a plan of them"""

    bl_idname = "riffler.plan_find"
    bl_label = "Find Paths"
    bl_options = {"REGISTER", "UNDO"}
    doing = "Finding paths"
    cancelled = "Search cancelled: nothing has changed"

    strategy: strategy_fields.choice(options={"SKIP_SAVE"})  # without a value it is the first one, not the last used
    tool: bpy.props.StringProperty(
        name="Tool", options={"HIDDEN", "SKIP_SAVE"}, description="Tool as JSON; empty: the scene's plan tool"
    )
    replace: bpy.props.StringProperty(
        name="Replace",
        options={"SKIP_SAVE"},
        description=(
            "Name of a plan whose paths are found again on its own part, without its orientations; empty: a new plan"
        ),
    )

    @classmethod
    def description(cls, context, properties):
        if not properties.replace:
            return local(strategy_fields.chosen(properties).description)
        return f"Replace the paths of {properties.replace} and their orientations by paths found on its part again"

    @classmethod
    def poll(cls, context):
        if not operator_parts.object_mode(cls, context):
            return False
        mine, own = context.scene.riffler.plan.part, obstacles.part_of(context.scene, plan_store.active(context))
        why = object_surfaces.unfit(mine, context.scene)
        if why and object_surfaces.unfit(own, context.scene):  # a plan's own part is enough to find its paths again
            return operator_parts.deny(cls, why)
        return not operator_parts.busy(cls, context)

    def invoke(self, context, event):
        """Asks the user for confirmation; a script gets none."""
        if asked := fit_check.size_question(context.scene):
            return operator_parts.fail(
                self, ValueError(f"{asked} Choose it in the panel Part and Fixtures, even if it is right")
            )
        return super().invoke(context, event)

    def begin(self, context):
        settings = context.scene.riffler.plan
        if self.replace and not plan_store.is_plan(context.scene.objects.get(self.replace)):
            raise ValueError(f"there is no plan {self.replace!r} in this scene: leave Replace empty for a new one")
        self._tool = riffler.Tool.from_dict(sculpt_work.tool_of_text(self.tool) if self.tool else settings.tool_dict())
        part = self._own_part(context) or settings.part
        live_registry.end_all()  # the mesh of a live sculpt is not up to date
        mesh = object_surfaces.in_world(context, part)
        self._part, self._mm = part.name, scene_units.mm_per_unit(context.scene)
        strategy, options = strategy_fields.chosen(self), strategy_fields.options(self)
        given = self._given(context, strategy)
        strategy.check(self._tool, given)  # reports errors at once, not from the thread
        self._nothing = strategy.nothing
        call = functools.partial(riffler.plan.find, strategy.id, mesh, self._tool, given, name=self._part, **options)
        return TaskJob(ThreadTask(lambda progress: call(progress=progress)))

    def _given(self, context, strategy):
        """The curves or paths that the strategy starts from. ValueError with the next step if there are none."""
        found = []
        if strategy.needs == "curves":
            found = given_curves.selected(context, strategy_fields.options(self).get("tolerance", 0.01))
        elif strategy.needs == "paths":
            ob = context.scene.objects[self.replace] if self.replace else plan_store.active(context)
            found = [] if ob is None else plan_store.plan(ob).sources
        if strategy.needs != "part" and not found:
            raise ValueError(local(strategy.missing))
        return found

    def _own_part(self, context):
        """The part of the plan that is to be replaced, if it still exists."""
        own = context.scene.objects[self.replace].riffler.plan.part if self.replace else None
        return None if object_surfaces.unfit(own, context.scene) else own

    def lost(self, context):
        if context.scene.objects.get(self._part) is None:
            return f"Search cancelled: {self._part} was removed or renamed meanwhile"
        if self.replace and not plan_store.is_plan(context.scene.objects.get(self.replace)):
            return f"Search cancelled: {self.replace} was removed or renamed meanwhile"
        return ""

    def finish(self, context, job):
        plan, paths = job.result.plan, job.result.plan.paths
        if not paths:
            raise ValueError(f"{self._part}: no {self._nothing}, as {job.result.reason}")
        if self.replace:
            ob = context.scene.objects[self.replace]
            ob.riffler.plan.findings.clear()  # they are of the old paths
            plan_store.write(ob, plan)
        else:
            ob = plan_store.new(context, plan)
        ob.riffler.plan.part = context.scene.objects[self._part]
        left = path_curves.kept_note(path_curves.show(ob, plan, self._mm))
        total = units.trim(sum(path.length for path in paths), 1)
        found = f"{ob.name}: {units.counted(len(paths), 'path')}, {total} mm"
        problems = list(job.result.notes)
        if timeline.pair(ob) is not None:
            replan.sync(context.scene, ob)
            problems += plan_states.state(ob).problems
        operator_parts.tell_all(self, f"{found}. {left}" if left else found, problems)
        return {"FINISHED"}

    def draw(self, context):
        operator_parts.draw_fields(self, ("strategy", *strategy_fields.shown(self)))


class RIFFLER_OT_plan_show(bpy.types.Operator):
    """Draw the plan's paths again; edits of their curves are lost, but copies, renamed curves and curves in use stay"""

    bl_idname = "riffler.plan_show"
    bl_label = "Redraw Paths"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        if plan_store.active(context) is None:
            return operator_parts.deny(cls, "Select a plan, or one of its paths")
        return operator_parts.object_mode(cls, context) and not operator_parts.busy(cls, context)

    def execute(self, context):
        ob = plan_store.active(context)
        try:
            plan = plan_store.plan(ob)
        except ValueError as error:
            return operator_parts.fail(self, error)
        context.view_layer.objects.active = ob  # the active curve may be deleted
        left = path_curves.show(ob, plan, scene_units.mm_per_unit(context.scene))
        path_switches.show(ob)
        if left:
            self.report({"INFO"}, path_curves.kept_note(left))
        return {"FINISHED"}


CLASSES = (RIFFLER_OT_plan_find, RIFFLER_OT_plan_show)
