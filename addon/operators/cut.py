"""Cutting: one operator per source of motion, one modal shell for all.

In a window the cut runs in slices on a timer: the status bar and the panel show how far it is, the surface follows,
Esc takes everything back. Without a window (and when settings are changed in the redo panel) it runs in one go. Either
way a finished cut is one undo step and a cancelled or failed one leaves nothing behind.
"""

import time

import bpy
import numpy as np
import riffler
from bpy_extras.io_utils import ImportHelper

from .. import properties
from ..bl import sculpts, store
from ..bl.curves import deformed
from ..core import units
from ..core.job import CutJob, RefreshClock, slice_budget
from . import paths, shared

TELL = 0.1  # s between two reports of progress


class CutShell(shared.TakesTool):
    """Mixin; a subclass makes the cuts."""

    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return shared.sculpt_poll(cls, context)

    def make_cuts(self, context, ob):
        raise NotImplementedError

    # ------------------------------------------------------------------ in one go
    def execute(self, context):
        ob = sculpts.active(context)
        wm = context.window_manager
        wm.progress_begin(0, 100)
        try:
            self._start(context, ob)
            self._job.run(lambda share: wm.progress_update(100 * share))
            return self._finish(ob)
        except (ValueError, RuntimeError, MemoryError) as error:
            return shared.fail(self, error)
        finally:
            wm.progress_end()

    # ------------------------------------------------------------------ in a window
    def invoke(self, context, event):
        if bpy.app.background or context.window is None:
            return self.execute(context)
        ob = sculpts.active(context)
        try:
            self._start(context, ob)
        except (ValueError, RuntimeError, MemoryError) as error:
            return shared.fail(self, error)
        # Names, not references: those die with the next undo.
        self._object, self._identity = ob.name, store.identity(ob.data)
        self._clock, self._shown, self._spent = RefreshClock(), False, 0.0
        self._left = time.perf_counter()
        self._told = 0.0
        wm = context.window_manager
        wm.progress_begin(0, 100)
        wm.riffler.running = True
        self._timer = wm.event_timer_add(0.01, window=context.window)
        wm.modal_handler_add(self)
        self._tell(context)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC":
            self.cancel(context)
            self.report({"INFO"}, "Cut cancelled: the sculpt is as it was")
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"} if event.type in shared.NAVIGATION else {"RUNNING_MODAL"}
        ob = bpy.data.objects.get(self._object)
        if not sculpts.is_sculpt(ob) or store.identity(ob.data) != self._identity:
            self._end(context)
            self.report({"WARNING"}, "Cut cancelled: the sculpt was changed or removed meanwhile")
            return {"CANCELLED"}
        outside = time.perf_counter() - self._left  # what drawing the window took
        if self._spent:
            self._clock.spent(self._spent + outside)
            self._spent = 0.0
        try:
            if self._job.step(slice_budget(outside)):
                done = self._finish(ob)
                self._end(context)
                return done
            self._refresh(ob)
        except (ValueError, RuntimeError, MemoryError) as error:
            self.cancel(context)
            return shared.fail(self, error)
        self._tell(context)
        self._left = time.perf_counter()
        return {"RUNNING_MODAL"}

    def cancel(self, context):
        """Blender calls it too, when the window closes."""
        ob = bpy.data.objects.get(self._object)
        if self._shown and sculpts.is_sculpt(ob) and store.identity(ob.data) == self._identity:
            sculpts.refill(ob.data, sculpts.shown_mm_per_unit(ob.data))
        self._end(context)

    def _end(self, context):
        wm = context.window_manager
        wm.event_timer_remove(self._timer)
        wm.progress_end()
        wm.riffler.running = False
        context.workspace.status_text_set(None)
        shared.redraw_sidebars(context)

    def _tell(self, context):
        if time.perf_counter() - self._told < TELL:
            return
        self._told = time.perf_counter()
        state = context.window_manager.riffler
        state.percent = 100 * self._job.fraction
        state.text = f"Move {units.format_count(self._job.done)} of {units.format_count(self._job.total)}; Esc cancels"
        context.window_manager.progress_update(state.percent)
        context.workspace.status_text_set(f"Riffler: cutting, {state.percent:.0f} %    Esc: cancel")
        shared.redraw_sidebars(context)

    def _refresh(self, ob):
        if self._clock.due():
            begin = time.perf_counter()
            sculpts.show(ob.data, self._job.volume.to_mesh(), sculpts.shown_mm_per_unit(ob.data))
            self._spent = time.perf_counter() - begin
            self._shown = True

    # ------------------------------------------------------------------ both
    def _start(self, context, ob):
        self._begin = time.perf_counter()
        content = store.content(ob.data)
        if sculpts.edited(ob.data):
            self.report({"WARNING"}, "The mesh had been edited: the cut starts from the volume, the edits are gone")
        cuts = self.make_cuts(context, ob)
        self._job = CutJob(content.volume.copy(), cuts, riffler.Tool.from_dict)
        self._before = content.cuts

    def _finish(self, ob):
        job = self._job
        sculpts.commit(ob.data, job.volume, self._before + job.cuts, sculpts.shown_mm_per_unit(ob.data))
        seconds = time.perf_counter() - self._begin
        removed = units.format_volume(job.removed)
        level = {"INFO"} if job.removed > 0 else {"WARNING"}
        self.report(level, f"Removed {removed} in {units.format_count(job.total)} moves, {seconds:.2f} s")
        return {"FINISHED"}


class RIFFLER_OT_cut_curve(CutShell, properties.CutSettings, bpy.types.Operator):
    """Carve the active sculpt with the tool's tip along a curve object"""

    bl_idname = "riffler.cut_curve"
    bl_label = "Cut Along Curve"

    curve: bpy.props.StringProperty(name="Curve", description="Name of the curve object; empty: a selected one")

    def make_cuts(self, context, ob):
        curve = bpy.data.objects.get(self.curve) if self.curve else _selected_curve(context)
        if curve is None or curve.type != "CURVE":
            raise ValueError(
                f"there is no curve object {self.curve!r}" if self.curve else "choose a curve to cut along"
            )
        if deformed(curve):
            self.report(
                {"WARNING"}, f"{curve.name}: modifiers and shape keys are not followed; convert it to a curve first"
            )
        depth, tolerance = units.clean(self.depth), units.clean(self.tolerance)
        return paths.along_curve(context, ob, curve, self.tool_dict(context), self.axis, depth, self.follow, tolerance)

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.prop_search(self, "curve", bpy.data, "objects", icon="CURVE_DATA")
        layout.prop(self, "axis")
        layout.prop(self, "depth")
        layout.prop(self, "follow")
        layout.prop(self, "tolerance")


def _selected_curve(context):
    return next((ob for ob in context.selected_objects if ob.type == "CURVE"), None)


class RIFFLER_OT_cut_recording(CutShell, bpy.types.Operator, ImportHelper):
    """Carve the active sculpt with the strokes of a recording, in the stock's own frame"""

    bl_idname = "riffler.cut_recording"
    bl_label = "Cut Recording"

    filename_ext = ".rjournal"
    filter_glob: bpy.props.StringProperty(default="*.rjournal", options={"HIDDEN"})
    filepath: bpy.props.StringProperty(name="Recording", subtype="FILE_PATH", options={"SKIP_SAVE"})

    def invoke(self, context, event):
        if self.filepath:
            return CutShell.invoke(self, context, event)
        return ImportHelper.invoke(self, context, event)

    def make_cuts(self, context, ob):
        if not self.filepath:
            raise ValueError("choose a recording (.rjournal)")
        cuts, stock = paths.from_recording(bpy.path.abspath(self.filepath))
        volume = store.content(ob.data).volume
        if stock and not (np.allclose(stock["lower"], volume.lower) and np.allclose(stock["upper"], volume.upper)):
            size = units.format_size(stock["upper"] - stock["lower"])
            corner = ", ".join(units.trim(x) for x in stock["lower"])
            self.report({"WARNING"}, f"The recording was made on a stock of {size} from ({corner}), which this is not")
        return cuts


CLASSES = (RIFFLER_OT_cut_curve, RIFFLER_OT_cut_recording)
