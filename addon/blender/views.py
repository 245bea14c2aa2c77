"""The 3D views, of all screens or of those in windows, and drawing in them."""

import bpy
import numpy as np


def views():
    """Every 3D view: name of its screen, number of its area, space."""
    for screen in bpy.data.screens:
        for k, area in enumerate(screen.areas):
            if area.type == "VIEW_3D":
                yield screen.name, k, area.spaces.active


def facing():
    """(3, 3): right, up and towards the viewer in the world, as rows, of the largest 3D view in the windows; without a
    window of any screen. None if there is no 3D view."""
    screens = [window.screen for window in bpy.context.window_manager.windows] or list(bpy.data.screens)
    areas = [area for screen in screens for area in screen.areas if area.type == "VIEW_3D"]
    if not areas:
        return None
    space = max(areas, key=lambda area: area.width * area.height).spaces.active
    region = space.region_3d
    if region is None:
        return None
    # not its view_matrix, which is that of the last drawing
    camera = space.camera if region.view_perspective == "CAMERA" else None
    axes = camera.matrix_world.to_3x3() if camera is not None else region.view_rotation.to_matrix()
    return np.array(axes).T


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
