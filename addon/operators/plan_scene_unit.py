"""What one unit of the scene is, so that a plan's part has its real size."""

import math

import bpy

from ..bl import plan_fit, units
from ..core import size_guess
from . import shared
from .scene import set_unit

UNITS = (
    ("MM", "1 mm", "A model in millimetres, as machines and most CAD systems have them"),
    ("CM", "1 cm", "A model in centimetres"),
    ("INCH", "1 inch", "A model in inches"),
    ("M", "1 m", "A model in metres, as Blender begins with"),
)
LABELS = {unit: said for unit, said, _ in UNITS}


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


CLASSES = (RIFFLER_OT_scene_unit,)
