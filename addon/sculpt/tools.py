"""The tools in the 3D view's toolbar: buttons and keys, cursor and header of each."""

from pathlib import Path

import bpy

from . import brushes, panel, pointer
from .brushes.smooth import SMOOTH
from .size_gizmo import RIFFLER_GGT_size

ICONS = Path(__file__).resolve().parent.parent / "icons"  # Blender uses an absolute path unchanged


def _stroke(brush, **modifiers):
    """A stroke on the active sculpt; if Blender refuses that, on the object under the pointer."""
    event = {"type": "LEFTMOUSE", "value": "PRESS", **modifiers}
    given = {"properties": [("mode", brush.id.upper())]}
    return ("riffler.stroke", event, given), ("riffler.stroke_elsewhere", event, given)


def _size(brush):
    """F and Shift F, as in Sculpt Mode, where the second sets the strength; for a cutter it sets the depth."""
    for field, shift in ((brush.first, False), (brush.second, True)):
        event = {"type": "F", "value": "PRESS", "shift": shift}
        yield ("riffler.resize", event, {"properties": [("field", field)]})
    for key, larger in (("LEFT_BRACKET", False), ("RIGHT_BRACKET", True)):
        event = {"type": key, "value": "PRESS", "repeat": True}
        yield ("riffler.size_step", event, {"properties": [("field", brush.first), ("larger", larger)]})


class SculptTool:
    """Mixin; a subclass has a brush."""

    bl_space_type = "VIEW_3D"
    bl_context_mode = "OBJECT"
    bl_cursor = "CROSSHAIR"
    bl_widget = RIFFLER_GGT_size.bl_idname


def _tool(brush):
    """The WorkSpaceTool of a brush; Blender needs a class for each."""

    def draw_cursor(context, tool, xy):
        pointer.draw(context, brush, xy)

    return type(
        f"RifflerTool{brush.label}",
        (SculptTool, bpy.types.WorkSpaceTool),
        {
            "__doc__": brush.tip,
            "__module__": __name__,
            "bl_idname": brush.tool,
            "bl_label": brush.label,
            "bl_description": brush.tip,
            "bl_icon": str(ICONS / f"riffler.{brush.icon}"),
            "bl_keymap": (
                *_stroke(brush),
                *_stroke(brushes.opposite(brush), ctrl=True),
                *_stroke(SMOOTH, shift=True),
                ("riffler.pen_stop", {"type": "ESC", "value": "PRESS"}, None),
                ("riffler.frame", {"type": "NUMPAD_PERIOD", "value": "PRESS"}, None),
                ("riffler.leave", {"type": "TAB", "value": "PRESS"}, None),
                ("riffler.leave", {"type": "TAB", "value": "PRESS", "ctrl": True}, {"properties": [("menu", True)]}),
                *_size(brush),
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


TOOLS = tuple(map(_tool, brushes.with_tool()))
# The tools of cutters, then those of brushes with falloff: groups of the toolbar.
GROUPS = tuple(
    tuple(tool for tool, brush in zip(TOOLS, brushes.with_tool(), strict=True) if brush.falloff is falloff)
    for falloff in (False, True)
)
