"""The 3D views, of all screens or of those in windows, and drawing in them."""

import bpy


def views():
    """Every 3D view: name of its screen, number of its area, space."""
    for screen in bpy.data.screens:
        for k, area in enumerate(screen.areas):
            if area.type == "VIEW_3D":
                yield screen.name, k, area.spaces.active


def redraw():
    """Redraws the views in windows."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


def redraw_sidebars(context):
    """Redraws the sidebars only: the view itself is costly, and is redrawn when the mesh changes."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                for region in area.regions:
                    if region.type == "UI":
                        region.tag_redraw()


class InViews:
    """The draw handlers of one topic. `when`: POST_VIEW, in the scene's space, or POST_PIXEL, in the region's."""

    def __init__(self):
        self._handlers = []

    def __len__(self):
        return len(self._handlers)

    def add(self, draw, when="POST_PIXEL"):
        self._handlers.append(bpy.types.SpaceView3D.draw_handler_add(draw, (), "WINDOW", when))

    def clear(self):
        while self._handlers:
            bpy.types.SpaceView3D.draw_handler_remove(self._handlers.pop(), "WINDOW")
