"""Replacements for Blender's own keys in the view, for a live sculpt: it is hidden and its chunks represent it, so
"frame selected" finds nothing and its modes cannot be entered."""

import bpy
import numpy as np
from bpy.props import BoolProperty
from mathutils import Vector

from ..blender import meshes, operator_parts
from ..common import poses
from . import live_registry, sculpt_work, sculpts

SENSOR = 36.0  # mm; a view's lens is that of a sensor of this width (Blender's DEFAULT_SENSOR_WIDTH)
ROOM = 1.1  # margin around the framed box


class RIFFLER_OT_frame(bpy.types.Operator):
    """Fit the whole sculpt into the view"""

    bl_idname = "riffler.frame"
    bl_label = "Frame Sculpt"
    bl_options = set()

    @classmethod
    def poll(cls, context):
        if sculpts.active(context) is None or context.region_data is None:
            return operator_parts.deny(cls, "Select a sculpt first, in a 3D view")
        return True

    def execute(self, context):
        corners = _corners(sculpts.active(context))
        middle = corners.mean(axis=0)
        region, view = context.region, context.region_data
        narrow = min(region.width, region.height) / max(region.width, region.height)
        view.view_location = Vector(middle)
        reach = ROOM * np.linalg.norm(corners - middle, axis=1).max()
        view.view_distance = reach * context.space_data.lens / SENSOR / narrow
        return {"FINISHED"}


def _corners(ob):
    """(8, 3): corners of the volume's box, in the world."""
    p = ob.data.riffler
    sides = np.array([p.lower, p.upper]) / sculpts.shown_mm_per_unit(ob.data)
    box = np.array([[sides[i >> k & 1][k] for k in range(3)] for i in range(8)])
    return poses.transform_points(meshes.matrix(ob.matrix_world), box)


class RIFFLER_OT_leave(bpy.types.Operator):
    """Write the strokes into the sculpts' meshes, so that Blender's other modes can be used"""

    bl_idname = "riffler.leave"
    bl_label = "Leave for Another Mode"
    bl_options = set()  # entering the mode is Blender's own undo step

    menu: BoolProperty(
        name="Menu", description="Open the pie menu of modes; off: enter Edit Mode", options={"SKIP_SAVE"}
    )

    @classmethod
    def poll(cls, context):
        return sculpt_work.sculpt_poll(cls, context)

    def execute(self, context):
        try:
            live_registry.end_all()
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        if self.menu:
            bpy.ops.wm.call_menu_pie("INVOKE_DEFAULT", name="VIEW3D_MT_object_mode_pie")
            return {"FINISHED"}
        return bpy.ops.object.mode_set("EXEC_DEFAULT", True, mode="EDIT")


CLASSES = (RIFFLER_OT_frame, RIFFLER_OT_leave)
