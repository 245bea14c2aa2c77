"""Settings of the scene: tool presets and millimetres."""

import math

import bpy
from bpy.props import FloatProperty

from ..bl import live, plan_fit, sculpts, store, units
from ..core import presets, size_guess
from . import shared


class RIFFLER_OT_tool_preset(bpy.types.Operator):
    """Take the cutter of this name for strokes and cuts"""

    bl_idname = "riffler.tool_preset"
    bl_label = "Tool Preset"
    bl_options = {"INTERNAL"}  # no undo step, as of all settings of the sculpt tools

    name: bpy.props.StringProperty(name="Name", description="Of the preset")

    def execute(self, context):
        try:
            context.scene.riffler.tool.take(presets.preset(self.name))
        except ValueError as error:
            return shared.fail(self, error)
        return {"FINISHED"}


UNITS = (
    ("MM", "1 mm", "A model in millimetres, as machines and most CAD systems have them"),
    ("CM", "1 cm", "A model in centimetres"),
    ("INCH", "1 inch", "A model in inches"),
    ("M", "1 m", "A model in metres, as Blender begins with"),
)
LABELS = {unit: said for unit, said, _ in UNITS}


def set_unit(operator, context, mm, shown="MM"):
    """Of the scene; sculpts keep their size in mm. What the operator returns."""
    try:
        live.end_all()
        found = [ob for ob in context.scene.objects if sculpts.is_sculpt(ob) and not ob.data.library]
        for ob in found:  # what cannot be comes before the first change
            store.content(ob.data)
            shared.refuse_edits(ob)
        units.set_unit(context.scene, bpy.data.screens, mm, shown)
        for mesh in {ob.data for ob in found}:
            sculpts.refill(mesh, units.mm_per_unit(context.scene))
    except shared.ERRORS as error:
        return shared.fail(operator, error)
    return {"FINISHED"}


class RIFFLER_OT_millimetres(bpy.types.Operator):
    """Make one Blender unit so many millimetres in this scene, one if nothing is said; sculpts keep their size in mm,
    other objects their units"""

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
        return shared.object_mode(cls, context) and not shared.busy(cls, context)

    def execute(self, context):
        return set_unit(self, context, units.clean(self.unit))


class RIFFLER_OT_scene_unit(bpy.types.Operator):
    """Say what one Blender unit is in this scene, so that the part has its real size; sculpts keep their size in mm.
    The part is not asked about again"""

    bl_idname = "riffler.scene_unit"
    bl_label = "Unit of the Scene"
    bl_options = {"REGISTER", "UNDO"}

    unit: bpy.props.EnumProperty(name="Unit", items=UNITS, default="MM", description="What one Blender unit is")

    @classmethod
    def poll(cls, context):
        return shared.object_mode(cls, context) and not shared.busy(cls, context)

    def execute(self, context):
        # Where it is that already, nothing is made anew.
        same = math.isclose(units.mm_per_unit(context.scene), size_guess.UNITS[self.unit], rel_tol=1e-6)
        done = {"FINISHED"} if same else set_unit(self, context, size_guess.UNITS[self.unit], self.unit)
        if done == {"FINISHED"}:
            plan_fit.accept_size(context.scene)
        return done


CLASSES = (RIFFLER_OT_tool_preset, RIFFLER_OT_millimetres, RIFFLER_OT_scene_unit)
