"""What draws in every 3D view while it is there."""

import bpy


class InViews:
    """The drawing functions of one topic. `when`: POST_VIEW, in the scene's space, or POST_PIXEL, in the region's."""

    def __init__(self):
        self._handlers = []

    def __len__(self):
        return len(self._handlers)

    def add(self, draw, when="POST_PIXEL"):
        self._handlers.append(bpy.types.SpaceView3D.draw_handler_add(draw, (), "WINDOW", when))

    def clear(self):
        while self._handlers:
            bpy.types.SpaceView3D.draw_handler_remove(self._handlers.pop(), "WINDOW")
