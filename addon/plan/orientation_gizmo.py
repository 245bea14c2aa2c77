"""Handles of the plan's tool: a dial for the inclination, one for the tilt, and the tool's end, which follows the
pointer. They start operators, since only those can be undone."""

import bpy
import numpy as np
from mathutils import Matrix, Vector

from ..blender import scene_units
from ..common import glyphs
from ..pen import session as pen_session
from . import current_pose
from .pure import tool_rotation

# Blender's colours of x and y: the tilt is about the path's x, the inclination about its y.
COLOURS = {
    tool_rotation.INCLINATION: ((0.35, 0.75, 0.2), (0.6, 1.0, 0.4)),
    tool_rotation.TILT: ((0.9, 0.25, 0.3), (1.0, 0.5, 0.5)),
    tool_rotation.FREE: ((0.95, 0.95, 0.95), (1.0, 1.0, 0.6)),
}
SIZE = {tool_rotation.INCLINATION: 1.0, tool_rotation.TILT: 0.85, tool_rotation.FREE: 0.13}


class RIFFLER_GGT_orientation(bpy.types.GizmoGroup):
    bl_idname = "RIFFLER_GGT_orientation"
    bl_label = "Orientation of the Tool"
    bl_space_type = "VIEW_3D"
    bl_region_type = "WINDOW"
    bl_options = {"3D"}

    @classmethod
    def poll(cls, context):
        # A device that turns the tool leaves nothing to drag.
        return context.mode == "OBJECT" and pen_session.running is None and current_pose.seen(context) is not None

    def setup(self, context):
        self._handles = {handle: self._handle(handle) for handle in tool_rotation.HANDLES}
        self.draw_prepare(context)

    def _handle(self, handle):
        if handle == tool_rotation.FREE:
            gizmo = self.gizmos.new("GIZMO_GT_move_3d")
            gizmo.draw_style, gizmo.draw_options = "RING_2D", {"FILL", "ALIGN_VIEW"}
        else:
            gizmo = self.gizmos.new("GIZMO_GT_dial_3d")
            gizmo.draw_options = {"CLIP"}
        gizmo.line_width = 2.5
        gizmo.color, gizmo.color_highlight = COLOURS[handle]
        gizmo.alpha, gizmo.alpha_highlight = 0.8, 1.0
        gizmo.scale_basis = SIZE[handle]
        gizmo.use_draw_modal = True
        gizmo.target_set_operator("riffler.plan_turn").handle = handle
        return gizmo

    def draw_prepare(self, context):
        spot = current_pose.seen(context)
        space = context.region_data
        for gizmo in self._handles.values():
            gizmo.hide = spot is None or space is None
        if spot is None or space is None:
            return
        axis = spot.axis if current_pose.held is None else current_pose.held
        mm = scene_units.mm_per_unit(context.scene)
        inclination, _ = spot.line.lean(spot.index, axis)
        for handle in (tool_rotation.INCLINATION, tool_rotation.TILT):
            around = tool_rotation.dial_axis(spot.line.frames[spot.index], inclination, handle)
            self._handles[handle].matrix_basis = _matrix(spot.centre / mm, around)
        view = current_pose.sight(context, context.region, space)
        end = spot.centre + current_pose.reach(context, view, spot.centre) * axis
        self._handles[tool_rotation.FREE].matrix_basis = Matrix.Translation(Vector(end / mm))


def _matrix(place, axis):
    """A dial's matrix: its z is the axis."""
    first, second, axis = glyphs.frame(axis)
    return Matrix(np.vstack([np.column_stack([first, second, axis, place]), (0, 0, 0, 1)]).tolist())


CLASSES = (RIFFLER_GGT_orientation,)
