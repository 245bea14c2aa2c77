"""Sets the scene to millimetres; sculpts keep their size."""

import bpy
from bpy.props import FloatProperty

from ..blender import operator_parts, scene_units
from ..sculpt import live_registry, sculpt_store, sculpt_work, sculpts


def set_unit(operator, context, mm, shown="MM"):
    """Sets the scene's unit; sculpts keep their size in mm. Returns the operator's result."""
    try:
        live_registry.end_all()
        found = [ob for ob in context.scene.objects if sculpts.is_sculpt(ob) and not ob.data.library]
        for ob in found:  # anything that can fail comes before the first change
            sculpt_store.content(ob.data)
            sculpt_work.refuse_edits(ob)
        scene_units.set_unit(context.scene, bpy.data.screens, mm, shown)
        for mesh in {ob.data for ob in found}:
            sculpts.refill(mesh, scene_units.mm_per_unit(context.scene))
    except operator_parts.ERRORS as error:
        return operator_parts.fail(operator, error)
    return {"FINISHED"}


class RIFFLER_OT_millimetres(bpy.types.Operator):
    """Set the millimetres of one Blender unit in this scene; sculpts keep their size in mm, other objects their size
    in units
    """

    bl_idname = "riffler.millimetres"
    bl_label = "Scene in Millimetres"
    bl_options = {"REGISTER", "UNDO"}

    unit: FloatProperty(
        name="Unit (mm)",
        default=1.0,
        min=1e-3,
        max=1e6,
        precision=3,
        options={"SKIP_SAVE"},
        description="Millimetres in one Blender unit",
    )

    @classmethod
    def poll(cls, context):
        return operator_parts.object_mode(cls, context) and not operator_parts.busy(cls, context)

    def execute(self, context):
        return set_unit(self, context, scene_units.clean(self.unit))


CLASSES = (RIFFLER_OT_millimetres,)
