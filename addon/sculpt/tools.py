"""The tools in the 3D view's toolbar: what each one's buttons and keys do, its cursor and its header."""

from pathlib import Path

import bpy

from . import panel, pointer
from .pure import brush_stroke
from .size_gizmo import RIFFLER_GGT_size

ICONS = Path(__file__).resolve().parent.parent / "icons"  # an absolute path is taken as it is


def _stroke(mode, **modifiers):
    """On the active sculpt; where Blender may not call that, on whatever is under the pointer."""
    event = {"type": "LEFTMOUSE", "value": "PRESS", **modifiers}
    given = {"properties": [("mode", mode.upper())]}
    return ("riffler.stroke", event, given), ("riffler.stroke_elsewhere", event, given)


def _size(mode):
    """F and Shift F, as in Sculpt Mode, where the second is strength; of a cutter that is its depth."""
    second = "STRENGTH" if mode == "soften" else "DEPTH"
    for field, shift in (("RADIUS", False), (second, True)):
        event = {"type": "F", "value": "PRESS", "shift": shift}
        yield ("riffler.resize", event, {"properties": [("field", field)]})
    for key, larger in (("LEFT_BRACKET", False), ("RIGHT_BRACKET", True)):
        event = {"type": key, "value": "PRESS", "repeat": True}
        yield ("riffler.size_step", event, {"properties": [("larger", larger)]})


class SculptTool:
    """Mixin; a subclass has a mode of sculpt/pure/brush_stroke.py."""

    bl_space_type = "VIEW_3D"
    bl_context_mode = "OBJECT"
    bl_cursor = "CROSSHAIR"
    bl_widget = RIFFLER_GGT_size.bl_idname


def _tool(mode, label, text):
    """A WorkSpaceTool of a mode; Blender wants a class for each."""

    def draw_cursor(context, tool, xy):
        pointer.draw(context, mode, xy)

    name = label.lower()
    return type(
        f"RifflerTool{label}",
        (SculptTool, bpy.types.WorkSpaceTool),
        {
            "__doc__": text,
            "__module__": __name__,
            "bl_idname": f"riffler.{name}",
            "bl_label": label,
            "bl_description": text,
            "bl_icon": str(ICONS / f"riffler.{name}"),
            "bl_keymap": (
                *_stroke(mode),
                *_stroke(brush_stroke.OPPOSITE[mode], ctrl=True),
                *_stroke("soften", shift=True),
                ("riffler.pen_stop", {"type": "ESC", "value": "PRESS"}, None),
                ("riffler.frame", {"type": "NUMPAD_PERIOD", "value": "PRESS"}, None),
                ("riffler.leave", {"type": "TAB", "value": "PRESS"}, None),
                ("riffler.leave", {"type": "TAB", "value": "PRESS", "ctrl": True}, {"properties": [("menu", True)]}),
                *_size(mode),
                (
                    "wm.call_menu_pie",
                    {"type": "W", "value": "PRESS"},
                    {"properties": [("name", panel.RIFFLER_MT_sculpt_pie.bl_idname)]},
                ),
            ),
            "draw_settings": staticmethod(lambda context, layout, tool: panel.draw_header(context, layout)),
            "draw_cursor": staticmethod(draw_cursor),
        },
    )


TOOLS = (
    _tool("remove", "Carve", "Take material away with the cutter, along the surface. Ctrl: put it on. Shift: smooth"),
    _tool("add", "Add", "Put material on in the shape of the cutter. Ctrl: take it away. Shift: smooth"),
    _tool("soften", "Smooth", "Smooth the surface as wide as the cutter"),
    _tool("mask", "Mask", "Protect what the cutter sweeps from all other tools. Ctrl: protect it no more"),
)
