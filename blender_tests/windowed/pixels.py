"""Leaves out what a software renderer would fill between two pictures.

Blender draws as ever, with every call of the add-on and every shader, but OpenGL discards triangles before it fills
them (rasterizer discard, OpenGL 4.6, 14.1). The switch is set in the context of the window. Blender draws 3D views in
another context, so clicks still find what they hit.

A script with the line `PIXELS = False` takes no pictures that are compared, and clicks on nothing in a view that is
found by its pixels: Mesa then fills nothing at all (LP_NO_RAST).
"""

import ctypes
import os

GL_RASTERIZER_DISCARD = 0x8C89
GL_VERSION = 0x1F02
NONE = os.environ.get("LP_NO_RAST") == "1"


class Pixels:
    """The switch. Without OpenGL, everything is filled."""

    def __init__(self):
        self.kept = False  # for a picture
        try:
            self._gl = ctypes.CDLL("libGL.so.1")
            self._gl.glGetString.restype = ctypes.c_char_p
        except OSError:
            self._gl = None

    def _set(self, discard):
        if self._gl is not None and self._gl.glGetString(GL_VERSION):
            (self._gl.glEnable if discard else self._gl.glDisable)(GL_RASTERIZER_DISCARD)

    def tick(self):
        """To be called again and again: Blender turns the switch back with each change of a mask of what is written,
        and each window has a context."""
        self._set(not self.kept)

    def fill_again(self, window):
        """Fills from here on, beginning with the whole window: steps to `yield from`."""
        if self.kept:
            return
        self.kept = True
        self._set(False)
        window.view_layer = window.view_layer  # tells the bars at the top and at the bottom, which are no areas
        for area in window.screen.areas:
            area.tag_redraw()
        yield 0.2
        yield 0.2
