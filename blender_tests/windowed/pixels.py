"""Leaves out what a software renderer would draw between two pictures.

Blender draws as ever, with every call of the add-on, but OpenGL discards its commands: conditional rendering (OpenGL
4.6, 10.9) executes them only if a sample passed in an earlier query, here one in which nothing was drawn. Blender uses
no conditional rendering itself. It finds two things by drawing them, and these stay:

- An object under a click. It draws it in the context of 3D views, where commands are discarded only while a view is
  drawn for the display.
- A gizmo under the pointer. It draws it in the window's context, so a script calls `find_gizmos` before it points at
  one.

A script with the line `PIXELS = False` takes no pictures that are compared, and clicks on nothing in a view that is
found by its pixels: Mesa then fills nothing at all (LP_NO_RAST).
"""

import ctypes
import os

import bpy

GL_QUERY_WAIT = 0x8E13
GL_SAMPLES_PASSED = 0x8914
NONE = os.environ.get("LP_NO_RAST") == "1"


def library():
    """OpenGL and GLX, or None."""
    try:
        gl = ctypes.CDLL("libGL.so.1")
    except OSError:
        return None
    gl.glIsQuery.restype = ctypes.c_ubyte
    gl.glXGetCurrentDisplay.restype = gl.glXGetCurrentContext.restype = ctypes.c_void_p
    gl.glXGetCurrentDrawable.restype = ctypes.c_ulong
    gl.glXMakeCurrent.argtypes = [ctypes.c_void_p, ctypes.c_ulong, ctypes.c_void_p]
    return gl


class Discard:
    """Conditional rendering in each of Blender's contexts: on if its commands are discarded."""

    def __init__(self):
        self._gl = library()
        self._queries = {}  # by context
        self._on = set()  # contexts

    def current(self):
        """Display, drawable and context; None without GLX."""
        gl = self._gl
        found = gl and (gl.glXGetCurrentDisplay(), gl.glXGetCurrentDrawable(), gl.glXGetCurrentContext())
        return found if found and all(found) else None

    def switch(self, on, place=None):
        """In the current context, or in that of a result of `current`."""
        here = self.current()
        context = (place or here or (None,))[-1]
        if here is None or on == (context in self._on):
            return
        elsewhere = context != here[-1]
        if elsewhere:
            self._gl.glXMakeCurrent(*place)
        if on:
            self._gl.glBeginConditionalRender(self._query(context), GL_QUERY_WAIT)
            self._on.add(context)
        else:
            self._gl.glEndConditionalRender()
            self._on.remove(context)
        if elsewhere:
            self._gl.glXMakeCurrent(*here)

    def _query(self, context):
        query = self._queries.setdefault(context, ctypes.c_uint(0))
        if not self._gl.glIsQuery(query):
            self._gl.glGenQueries(1, ctypes.byref(query))
            self._gl.glBeginQuery(GL_SAMPLES_PASSED, query)
            self._gl.glEndQuery(GL_SAMPLES_PASSED)
        return query


class Pixels:
    """Switches for the window and for 3D views. Without GLX, everything is filled."""

    def __init__(self):
        self.kept = False  # for a picture
        self.gizmos = False  # a script points at them
        self._discard = Discard()
        self._view = None  # what Discard.current is while a view is drawn
        add = bpy.types.SpaceView3D.draw_handler_add
        self._handlers = [
            add(self._view_begins, (), "WINDOW", "PRE_VIEW"),
            add(self._view_ends, (), "WINDOW", "POST_PIXEL"),
        ]

    def _view_begins(self):
        self._view = self._discard.current()
        self._discard.switch(not self.kept)

    def _view_ends(self):
        """By now, Blender is back in the window's context."""
        if self._view is not None:
            self._discard.switch(False, self._view)
            self._view = None

    def tick(self):
        """To be called again and again: each window has a context."""
        self._discard.switch(not (self.kept or self.gizmos))

    def find_gizmos(self, found=True):
        """From here on, until `found` is false, Blender finds gizmos under the pointer."""
        self.gizmos = found
        self.tick()

    def fill_again(self, window):
        """Fills from here on, beginning with the whole window: steps to `yield from`."""
        if self.kept:
            return
        self.kept = True
        self.tick()
        window.view_layer = window.view_layer  # tells the bars at the top and at the bottom, which are no areas
        for area in window.screen.areas:
            area.tag_redraw()
        yield 0.2
        yield 0.2
