"""The add-on's tools in the 3D view's toolbar: adds them in order, and removes them."""

import itertools

import bpy

from .plan.orient_tool import PlanTool
from .sculpt.tools import GROUPS, TOOLS

# Blender's default tool, with all its settings; Blender 3.4 crashes if one of these is missing.
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
_registered = []  # those of TOOLS and PlanTool that are registered


def attach():
    """Adds the sculpting tools as two groups of the toolbar, and the planning tool below: placed after a tool of
    a group, it would join the group."""
    _register(PlanTool, "builtin.measure", separator=True)
    before = "builtin.measure"
    for group in GROUPS:
        _register(group[0], before, separator=before == "builtin.measure", group=True)
        for last, tool in itertools.pairwise(group):
            _register(tool, last.bl_idname)
        before = group[-1].bl_idname


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
    """Activates Blender's default tool in place of ours, also in workspaces without a window: with a missing tool
    nothing can be selected."""
    ours = {tool.bl_idname for tool in (*TOOLS, PlanTool)}
    windows = () if bpy.app.background else bpy.context.window_manager.windows
    # While an add-on is registered, and when that has failed, Blender hides its data; then none of our tools is active.
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
    """Activates the tool again: the draw function of the last tool's cursor, in any workspace, stays until a tool is
    activated."""
    for window in windows:
        area = next((a for a in window.screen.areas if a.type == "VIEW_3D"), None)
        if area is None:
            continue
        with bpy.context.temp_override(window=window, area=area):
            tool = window.workspace.tools.from_space_view3d_mode(bpy.context.mode, create=False)
            if tool is not None:
                bpy.ops.wm.tool_set_by_id(name=tool.idname)
