"""The 3D views, of all screens or of those that windows show."""

import bpy


def views():
    """Every 3D view: name of its screen, number of its area, space."""
    for screen in bpy.data.screens:
        for k, area in enumerate(screen.areas):
            if area.type == "VIEW_3D":
                yield screen.name, k, area.spaces.active


def redraw():
    """Those that windows show are drawn again."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
