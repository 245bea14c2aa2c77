"""Gives the session that turns a plan's tool (plan/pointer_orientation.py) the events of mouse and tablet."""

import bpy

from ...blender import operator_parts
from ...pen import operators as pen_operators
from ...pen import session as pen_session
from ..pointer_orientation import BUTTONS, PointerOrientation

MOVES = ("MOUSEMOVE", "INBETWEEN_MOUSEMOVE")


class RIFFLER_OT_plan_pointer(bpy.types.Operator):
    """Turn the plan's tool with mouse or tablet, until Esc"""

    bl_idname = "riffler.plan_pointer"
    bl_label = "Orient by Pointer"
    bl_options = {"INTERNAL"}  # each key is an undo step of its own

    @classmethod
    def poll(cls, context):
        running = isinstance(pen_session.running, PointerOrientation)
        return running or operator_parts.deny(cls, "No pen session is running")

    def invoke(self, context, event):
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        session = pen_session.running
        if not isinstance(session, PointerOrientation):
            return {"FINISHED"}
        if event.type == "ESC" and event.value == "PRESS":
            return pen_operators.stop(self)
        region = _view_at(context.window, event.mouse_x, event.mouse_y)
        if region is None or event.alt:  # buttons of the panels, and Blender's own for the view
            session.hand.leave()
            return {"PASS_THROUGH"}
        if event.type in MOVES:
            session.move(context, region, event)
        elif event.type in BUTTONS:
            if event.value == "PRESS":
                session.press(event.type)
            return {"RUNNING_MODAL"}
        return {"PASS_THROUGH"}


def _view_at(window, x, y):
    """The region of a 3D view at pixels of the window, or None; what lies over a view is not the view."""
    for area in window.screen.areas if window is not None else ():
        here = [r for r in area.regions if r.x <= x < r.x + r.width and r.y <= y < r.y + r.height]
        if area.type == "VIEW_3D" and here and all(r.type == "WINDOW" for r in here):
            return here[0]
    return None


CLASSES = (RIFFLER_OT_plan_pointer,)
