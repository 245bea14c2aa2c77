"""Work on a plan: what the operators of its keys, of the tool's turning and of its NC code share."""

import bpy

from ...blender import object_surfaces, operator_parts, refusals
from ...blender.long_work import LongWork
from .. import obstacles, plan_states, plan_store, replan, timeline
from ..current_pose import plan_object


def plan_poll(cls, context):
    """True if there is a plan that can be changed; otherwise the button's tooltip gives the reason."""
    if plan_object(context) is None:
        return operator_parts.deny(cls, "Select a plan first, or find paths on a part")
    if why := refusals.linked(plan_object(context)):
        return operator_parts.deny(cls, why)
    return not operator_parts.busy(cls, context)


def timeline_poll(cls, context):
    if not plan_poll(cls, context):
        return False
    if timeline.pair(plan_object(context)) is None:
        return operator_parts.deny(cls, "The plan is not on the timeline: use Plan to Timeline first")
    return True


def part_poll(cls, context):
    """True if the plan has a part for checks, whether or not the plan can be changed."""
    if why := object_surfaces.unfit(obstacles.part_of(context.scene, plan_object(context)), context.scene):
        return operator_parts.deny(cls, why)
    return True


def tell(operator, ob):
    """Reports how the plan plays now, or its problem."""
    now = plan_states.state(ob)
    problems = timeline.faults(timeline.pair(ob)[0], plan_states.scene_of(ob)) + now.problems
    if problems:
        operator.report({"WARNING"}, "; ".join(problems))
    elif not now.difference.small:
        operator.report({"WARNING"}, str(now.difference))
    else:
        operator.report({"INFO"}, str(now.difference))
    return {"FINISHED"}


class PlanWork(LongWork):
    """Mixin; a subclass makes the job from the result of `take`."""

    bl_options = {"REGISTER", "UNDO"}

    def take(self, context):
        """(object, plan), after all updates from its keyframes."""
        replan.flush()
        ob = plan_object(context)
        plan = plan_store.plan(ob)
        self._plan, self._identity = ob.name, plan_store.identity(ob)
        return ob, plan

    def lost(self, context):
        if plan_store.is_plan(self.ob) and plan_store.identity(self.ob) == self._identity:
            return ""
        return f"{self.doing} cancelled: the plan was changed or removed meanwhile"

    @property
    def ob(self):
        """The plan's object, or None if it was removed."""
        return bpy.data.objects.get(self._plan)


class TimelineWork(PlanWork):
    """Mixin of work that also needs the plan's tool on the timeline, and the part."""

    @classmethod
    def poll(cls, context):
        return timeline_poll(cls, context) and part_poll(cls, context)

    def lost(self, context):
        why = super().lost(context)
        if not why and timeline.pair(self.ob) is None:
            return f"{self.doing} cancelled: the plan's tool was deleted meanwhile"
        return why
