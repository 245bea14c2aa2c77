"""A 3D view from above in a window: events sent to it, and the moment at which what they did can be seen.

Drawn means that a pixel of the view has been read back: until then a driver may only have noted what to do.
"""

import time

import bpy
import gpu
from bpy_extras import view3d_utils


class View:
    def __init__(self, width):
        """Looks down on the middle of `width` Blender units."""
        self.window = bpy.context.window_manager.windows[0]
        self.area = next(a for a in self.window.screen.areas if a.type == "VIEW_3D")
        self.region = next(r for r in self.area.regions if r.type == "WINDOW")
        space = self.area.spaces.active
        space.show_region_ui, space.overlay.show_floor = False, False
        space.clip_end = 1e5
        # Otherwise a still view is drawn again and again, for smoother edges, and an event waits for that.
        bpy.context.preferences.system.viewport_aa = "OFF"
        self.space = space.region_3d
        with self.override():
            bpy.ops.view3d.view_axis(type="TOP")
        self.space.view_location, self.space.view_distance = (0, 0, 0), 1.15 * width
        self.begun = self.drawn = None
        self.drawing, self.graph = [], []
        self._graph_begun = None
        handle = bpy.types.SpaceView3D.draw_handler_add
        self._handles = [
            handle(self._before, (), "WINDOW", "PRE_VIEW"),
            handle(self._after, (), "WINDOW", "POST_PIXEL"),
        ]
        bpy.app.handlers.depsgraph_update_pre.append(self._graph_before)
        bpy.app.handlers.depsgraph_update_post.append(self._graph_after)
        bpy.app.handlers.undo_post.append(self._undone)
        bpy.app.handlers.redo_post.append(self._undone)

    def override(self):
        return bpy.context.temp_override(window=self.window, area=self.area, region=self.region)

    def pixel(self, place):
        """In the window, of a place in the scene."""
        xy = view3d_utils.location_3d_to_region_2d(self.region, self.space, place)
        return round(xy.x + self.region.x), round(xy.y + self.region.y)

    def place(self, pixel):
        """Where that pixel's ray meets z = 0, by Blender."""
        xy = pixel[0] - self.region.x, pixel[1] - self.region.y
        return view3d_utils.region_2d_to_location_3d(self.region, self.space, xy, (0, 0, 0))

    def send(self, kind, value, pixel, **modifiers):
        self.drawn, self.drawing, self.graph, self.undone = None, [], [], None
        self.sent = time.perf_counter(), time.process_time()
        self.window.event_simulate(kind, value, x=pixel[0], y=pixel[1], **modifiers)

    def history(self, times, kinds):
        """Ctrl-Z for each of `kinds`, by which its time is called, and then Ctrl-Shift-Z: from the key to the picture.
        Steps to `yield from`."""
        middle = self.region.x + self.region.width // 2, self.region.y + self.region.height // 2
        for name in (*kinds, *(kind.replace("undo", "redo") for kind in reversed(kinds))):
            self.send("Z", "PRESS", middle, ctrl=True, shift=name.startswith("redo"))
            yield lambda: self.undone and self.drawn and self.drawn[0] > self.undone
            times.add(name, *self.latency())
            self.send("Z", "RELEASE", middle)
            yield 0.3

    def latency(self):
        """Wall and processor seconds from the last event to the picture of what it did."""
        return self.drawn[0] - self.sent[0], self.drawn[1] - self.sent[1]

    def renderer(self):
        return gpu.platform.renderer_get()

    # ------------------------------------------------------------------ handlers
    def _before(self):
        self._begun = time.perf_counter()

    def _after(self):
        gpu.state.active_framebuffer_get().read_color(0, 0, 1, 1, 4, 0, "UBYTE")
        self.drawn = time.perf_counter(), time.process_time()
        self.drawing.append(self.drawn[0] - self._begun)

    def _graph_before(self, *_):
        self._graph_begun = time.perf_counter()

    def _graph_after(self, *_):
        if self._graph_begun is not None:
            self.graph.append(time.perf_counter() - self._graph_begun)
            self._graph_begun = None

    def _undone(self, *_):
        self.undone = time.perf_counter()
