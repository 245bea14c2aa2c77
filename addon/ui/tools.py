"""The tools in the 3D view's toolbar: what each one's buttons and keys do, its cursor and its header."""

import itertools
from pathlib import Path

import bpy

from ..bl import turning
from ..core import brush
from ..drawing import paths, pointer
from ..gizmos.orientation import RIFFLER_GGT_orientation
from ..gizmos.size import RIFFLER_GGT_size
from . import sculpt_panel, timeline_panel

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
    """Mixin; a subclass has a mode of core/brush.py."""

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
                *_stroke(brush.OPPOSITE[mode], ctrl=True),
                *_stroke("soften", shift=True),
                ("riffler.pen_stop", {"type": "ESC", "value": "PRESS"}, None),
                ("riffler.frame", {"type": "NUMPAD_PERIOD", "value": "PRESS"}, None),
                ("riffler.leave", {"type": "TAB", "value": "PRESS"}, None),
                ("riffler.leave", {"type": "TAB", "value": "PRESS", "ctrl": True}, {"properties": [("menu", True)]}),
                *_size(mode),
                (
                    "wm.call_menu_pie",
                    {"type": "W", "value": "PRESS"},
                    {"properties": [("name", sculpt_panel.RIFFLER_MT_sculpt_pie.bl_idname)]},
                ),
            ),
            "draw_settings": staticmethod(lambda context, layout, tool: sculpt_panel.draw_header(context, layout)),
            "draw_cursor": staticmethod(draw_cursor),
        },
    )


TOOLS = (
    _tool("remove", "Carve", "Take material away with the cutter, along the surface. Ctrl: put it on. Shift: smooth"),
    _tool("add", "Add", "Put material on in the shape of the cutter. Ctrl: take it away. Shift: smooth"),
    _tool("soften", "Smooth", "Smooth the surface as wide as the cutter"),
    _tool("mask", "Mask", "Protect what the cutter sweeps from all other tools. Ctrl: protect it no more"),
)
# Blender's first tool, as it sets it itself; Blender 3.4 crashes where one of these is left out.
FIRST = {
    "idname": "builtin.select_box",
    "keymap": "3D View Tool: Select Box",
    "cursor": "DEFAULT",
    "options": set(),
    "gizmo_group": "",
    "data_block": "",
    "operator": "",
    "index": 0,
    "idname_fallback": "",
    "keymap_fallback": "",
}
CLASSES = ()
_registered = []  # of those below and PlanTool, those that Blender has


class PlanTool(bpy.types.WorkSpaceTool):
    """At the point of the plan that the frame is at."""

    bl_space_type = "VIEW_3D"
    bl_context_mode = "OBJECT"
    bl_idname = turning.TOOL
    bl_label = "Orient"
    bl_description = (
        "Turn the plan's tool by dials, by its end, or by a click in the map of free orientations. A click on a path "
        "goes to that point. Ctrl: set a free key there"
    )
    bl_icon = str(ICONS / turning.TOOL)
    bl_cursor = "DEFAULT"
    bl_widget = RIFFLER_GGT_orientation.bl_idname
    bl_keymap = (
        ("riffler.plan_turn", {"type": "LEFTMOUSE", "value": "PRESS"}, {"properties": [("handle", "MAP")]}),
        ("riffler.plan_point", {"type": "LEFTMOUSE", "value": "PRESS"}, None),
        ("riffler.plan_point_key", {"type": "LEFTMOUSE", "value": "PRESS", "ctrl": True}, None),
    )

    @staticmethod
    def draw_settings(context, layout, tool):
        timeline_panel.draw_header(context, layout)

    @staticmethod
    def draw_cursor(context, tool, xy):
        paths.draw_cursor(context, tool, xy)


def attach():
    """The four of sculpting in one group of the toolbar, that of planning below: after a tool of a group it would be in
    it."""
    _register(PlanTool, "builtin.measure", separator=True)
    _register(TOOLS[0], "builtin.measure", separator=True, group=True)
    for before, tool in itertools.pairwise(TOOLS):
        _register(tool, before.bl_idname)


def _register(tool, after, **more):
    bpy.utils.register_tool(tool, after={after}, **more)
    _registered.append(tool)


def detach():
    try:
        _put_down()
    finally:
        while _registered:
            bpy.utils.unregister_tool(_registered.pop())


def _put_down():
    """Whoever has one of ours at hand, also in a workspace that no window shows, gets Blender's first one: a tool that
    is gone leaves no way to select."""
    ours = {tool.bl_idname for tool in (*TOOLS, PlanTool)}
    windows = () if bpy.app.background else bpy.context.window_manager.windows
    # While an add-on is registered, and when that has failed, Blender shows no data; nobody has a tool of it then.
    workspaces = getattr(bpy.data, "workspaces", ())
    at_hand = [t for t in map(_chosen, workspaces) if t is not None and t.idname in ours]
    if not windows or not at_hand:
        return
    with bpy.context.temp_override(window=windows[0]):
        for tool in at_hand:
            tool.setup(**FIRST)
    _choose_again(windows)


def _chosen(workspace):
    return workspace.tools.from_space_view3d_mode("OBJECT", create=False)


def _choose_again(windows):
    """What draws the cursor of the tool that was chosen last, in whichever workspace, stays until one is chosen."""
    for window in windows:
        area = next((a for a in window.screen.areas if a.type == "VIEW_3D"), None)
        if area is None:
            continue
        with bpy.context.temp_override(window=window, area=area):
            tool = window.workspace.tools.from_space_view3d_mode(bpy.context.mode, create=False)
            if tool is not None:
                bpy.ops.wm.tool_set_by_id(name=tool.idname)
