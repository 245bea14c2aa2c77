"""The plan's tool in the 3D view's toolbar."""

import bpy

from ..sculpt.tools import ICONS
from . import current_pose, path_view, timeline_panel
from .orientation_gizmo import RIFFLER_GGT_orientation


class PlanTool(bpy.types.WorkSpaceTool):
    """Turns the tool at the plan's point of the current frame."""

    bl_space_type = "VIEW_3D"
    bl_context_mode = "OBJECT"
    bl_idname = current_pose.TOOL
    bl_label = "Orient"
    bl_description = (
        "Turn the plan's tool by dials, by its end, or by a click in the map of free orientations; "
        "click on a path to go to that point (Ctrl: set a free key there)"
    )
    bl_icon = str(ICONS / current_pose.TOOL)
    bl_cursor = "DEFAULT"
    bl_widget = RIFFLER_GGT_orientation.bl_idname
    bl_keymap = (
        ("riffler.plan_turn", {"type": "LEFTMOUSE", "value": "PRESS"}, {"properties": [("handle", "MAP")]}),
        ("riffler.plan_point", {"type": "LEFTMOUSE", "value": "PRESS"}, None),
        ("riffler.pen_stop", {"type": "ESC", "value": "PRESS"}, None),
        ("riffler.plan_point_key", {"type": "LEFTMOUSE", "value": "PRESS", "ctrl": True}, None),
    )

    @staticmethod
    def draw_settings(context, layout, tool):
        timeline_panel.draw_header(context, layout)

    @staticmethod
    def draw_cursor(context, tool, xy):
        path_view.draw_cursor(context, tool, xy)
