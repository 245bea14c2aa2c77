"""Sets the scene's unit, so that a plan's part has its real size."""

import math

import bpy

from ...blender import operator_parts, scene_units
from ...stock.millimetres import set_unit
from .. import fit_check
from ..pure import size_guess

UNITS = (
    ("MM", "1 mm", "A model in millimetres, as machines and most CAD systems use"),
    ("CM", "1 cm", "A model in centimetres"),
    ("INCH", "1 inch", "A model in inches"),
    ("M", "1 m", "A model in metres, Blender's default"),
)
LABELS = {unit: said for unit, said, _ in UNITS}


class RIFFLER_OT_scene_unit(bpy.types.Operator):
    """Set what one Blender unit is in this scene, so that the part has its real size; sculpts keep their size in mm"""

    bl_idname = "riffler.scene_unit"
    bl_label = "Unit of the Scene"
    bl_options = {"REGISTER", "UNDO"}

    unit: bpy.props.EnumProperty(name="Unit", items=UNITS, default="MM", description="Length of one Blender unit")

    @classmethod
    def poll(cls, context):
        return operator_parts.object_mode(cls, context) and not operator_parts.busy(cls, context)

    def execute(self, context):
        # If the scene has this unit already, no sculpt's mesh is rebuilt.
        same = math.isclose(scene_units.mm_per_unit(context.scene), size_guess.UNITS[self.unit], rel_tol=1e-6)
        done = {"FINISHED"} if same else set_unit(self, context, size_guess.UNITS[self.unit], self.unit)
        if done == {"FINISHED"}:
            fit_check.accept_size(context.scene)
        return done


CLASSES = (RIFFLER_OT_scene_unit,)
