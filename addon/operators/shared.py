"""What the operators have in common."""

import json

import bpy

from ..bl import sculpts

NAVIGATION = {
    "MIDDLEMOUSE",
    "WHEELUPMOUSE",
    "WHEELDOWNMOUSE",
    "MOUSEMOVE",
    "INBETWEEN_MOUSEMOVE",
    "TRACKPADPAN",
    "TRACKPADZOOM",
}


class TakesTool:
    """Mixin of operators that cut with the scene's tool or one that they are given."""

    tool: bpy.props.StringProperty(
        name="Tool", options={"HIDDEN", "SKIP_SAVE"}, description="A tool as JSON; empty: the scene's tool"
    )

    def tool_dict(self, context):
        if not self.tool:
            return context.scene.riffler.tool.dictionary()
        tool = json.loads(self.tool)
        if not isinstance(tool, dict):
            raise ValueError("tool must be a JSON object")
        return tool


def sculpt_poll(cls, context):
    """True where the active object is a sculpt that can be changed; otherwise the button's tooltip says why not."""
    ob = sculpts.active(context)
    if ob is None:
        return deny(cls, "Select a sculpt first, or make a new stock")
    if ob.mode != "OBJECT":
        return deny(cls, "Leave Edit Mode or Sculpt Mode first")
    if ob.library or ob.data.library:
        return deny(cls, "The sculpt is linked from another file: make it local first")
    return not busy(cls, context)


def busy(cls, context):
    """True while something runs that has the sculpt; the tooltip says what."""
    state = context.window_manager.riffler
    if state.running:
        deny(cls, "A cut is running: Esc cancels it")
    if state.sculpting:
        deny(cls, "A pen is sculpting: Esc ends it")
    return state.running or state.sculpting


def deny(cls, message):
    cls.poll_message_set(message)
    return False


def fail(operator, error):
    """One clear message instead of a traceback; the operator is cancelled."""
    operator.report({"ERROR"}, str(error) or type(error).__name__)
    return {"CANCELLED"}


def redraw_sidebars(context):
    """The sidebars only: the view itself is costly, and is drawn again when the mesh changes."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                for region in area.regions:
                    if region.type == "UI":
                        region.tag_redraw()
