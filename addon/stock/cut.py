"""Cutting: one operator per source of motion, carved in slices by the shell of long work, with the surface updated
meanwhile."""

import time
from dataclasses import replace

import bpy
import numpy as np
import riffler
from bpy_extras.io_utils import ImportHelper

from ..blender import refusals
from ..blender.curve_objects import deformed
from ..blender.file_work import FileWork
from ..common import units
from ..common.job import Cut, CutJob
from ..sculpt import sculpt_work, sculpts
from ..sculpt.pure import reach
from ..sculpt.sculpt_work import SculptWork
from ..translations import local
from . import cut_paths, properties


class CutShell(sculpt_work.TakesTool, SculptWork):
    """Mixin; a subclass has `make_cuts(context, ob)`, which returns the cuts."""

    doing = "Cutting"
    cancelled = "Cut cancelled: the sculpt is unchanged"

    def begin(self, context):
        self._begin = time.perf_counter()
        ob, self._before = self.take(context)
        cuts = self.make_cuts(context, ob)
        return CutJob(self._before.volume.copy(), cuts, riffler.Tool.from_dict, self._before.mask)

    def show(self, context, job):
        now = replace(self._before, volume=job.volume)
        surface = sculpts.surface_of(self.mesh, now)
        sculpts.show(self.mesh, surface, sculpts.shown_mm_per_unit(self.mesh), now.mask)

    def restore(self, context):
        sculpts.refill(self.mesh, sculpts.shown_mm_per_unit(self.mesh))

    def finish(self, context, job):
        before = self._before
        cuts = [replace(cut, masked=before.mask is not None) for cut in job.cuts]
        self.keep(replace(before, volume=job.volume, cuts=before.cuts + cuts))
        seconds = time.perf_counter() - self._begin
        changed, adds = units.format_volume(job.removed), {cut.mode == "add" for cut in job.cuts}
        done = {(False,): "Removed", (True,): "Added"}.get(tuple(adds), "Removed and added")
        if any(_cut_off(cut, job.volume) for cut in job.cuts):
            self.report({"WARNING"}, local(reach.CUT_OFF))
        level = {"INFO"} if job.removed > 0 else {"WARNING"}
        self.report(level, f"{done} {changed} in {units.counted(job.total, 'move')}, {seconds:.2f} s")
        return {"FINISHED"}


def _cut_off(cut, volume):
    """True if a cut added material that the box clipped."""
    if cut.mode != "add":
        return False
    return reach.is_cut_off(reach.outline_of(riffler.Tool.from_dict(cut.tool)), cut.poses, volume)


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
        if why := refusals.disabled(curve, context.view_layer):
            raise ValueError(why)
        if deformed(curve):
            self.report(
                {"WARNING"}, f"{curve.name}: modifiers and shape keys are not followed; convert it to a curve first"
            )
        depth, tolerance = units.clean(self.depth), units.clean(self.tolerance)
        return cut_paths.along_curve(
            context, ob, curve, self.tool_dict(context), self.axis, depth, self.follow, tolerance
        )

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


class RIFFLER_OT_cut_recording(FileWork, CutShell, bpy.types.Operator, ImportHelper):
    """Carve the active sculpt with the strokes of a recording, in the stock's own coordinates"""

    bl_idname = "riffler.cut_recording"
    bl_label = "Cut Recording"
    helper = ImportHelper

    filename_ext = ".rjournal"
    filter_glob: bpy.props.StringProperty(default="*.rjournal", options={"HIDDEN"})
    filepath: bpy.props.StringProperty(
        name="Recording", subtype="FILE_PATH", options={"SKIP_SAVE"}, description="A recording (.rjournal)"
    )
    other: bpy.props.BoolProperty(
        name="Use Panel's Tool",
        description="Move the tool of the panel Tool along the recorded path, instead of the recorded tool",
    )

    def invoke(self, context, event):
        self.ask = self.ask and not self.filepath
        return FileWork.invoke(self, context, event)

    def make_cuts(self, context, ob):
        if not self.filepath:
            raise ValueError("choose a recording (.rjournal)")
        cuts, stock = cut_paths.from_recording(bpy.path.abspath(self.filepath))
        if self.other or self.tool:
            tool = self.tool_dict(context)
            cuts = [Cut(tool, cut.poses, cut.tolerance, cut.mode) for cut in cuts]
        volume = self._before.volume
        if stock and not (np.allclose(stock.lower, volume.lower) and np.allclose(stock.upper, volume.upper)):
            size = units.format_size(stock.upper - stock.lower)
            corner = ", ".join(units.trim(x) for x in stock.lower)
            self.report({"WARNING"}, f"The recording was made on a stock of {size} from ({corner}), which this is not")
        return cuts


CLASSES = (RIFFLER_OT_cut_curve, RIFFLER_OT_cut_recording)
