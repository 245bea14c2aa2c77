"""Changes shank or holder of a plan that has keys; its paths stay unchanged."""

from dataclasses import replace

import bpy

from ...blender import operator_parts
from .. import fit_check, plan_store, replan, timeline
from ..current_pose import plan_object
from .plan_work import plan_poll, tell


class RIFFLER_OT_plan_use_tool(bpy.types.Operator):
    """Use the shank and the holder of the Tool panel's tool in this plan; keys stay, but the paths must be resolved
    again
    """

    bl_idname = "riffler.plan_use_tool"
    bl_label = "Use This Tool"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return plan_poll(cls, context)

    def execute(self, context):
        try:
            replan.flush()
            ob = plan_object(context)
            plan, tool = plan_store.plan(ob), fit_check.tool_of_scene(context.scene.riffler.plan)
            if not fit_check.same_cutter(tool, plan.tool):
                raise ValueError(
                    f"{tool.name} has another cutter than {plan.tool.name}, which the paths were found for: "
                    "use Find Again, or another tool with that cutter"
                )
            known = {key: text for key, text in plan.provenance.items() if key != plan_store.RESOLVED}
            ob.riffler.plan.findings.clear()  # they are of the previous tool
            plan_store.write(ob, replace(plan, tool=tool, cl=[], provenance=known))
            if timeline.pair(ob) is None:
                self.report({"INFO"}, f"{ob.name}: {tool.name}")
                return {"FINISHED"}
            timeline.make(context, ob, tool)
            replan.sync(context.scene, ob)
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        return tell(self, ob)


CLASSES = (RIFFLER_OT_plan_use_tool,)
