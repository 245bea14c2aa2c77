"""The add-on's tools in the 3D view's toolbar: put there in their order, and taken out."""

import itertools

import bpy

from .plan.orient_tool import PlanTool
from .sculpt.tools import TOOLS

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
_registered = []  # those of TOOLS and PlanTool that Blender has


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
