"""The mask of a sculpt: set from closed curves and meshes, inverted, or cleared."""

from dataclasses import replace

import bpy
import riffler
from bpy.props import EnumProperty, StringProperty

from ..common.job import DoneJob, TaskJob, ThreadTask
from ..sculpt.sculpt_work import SculptWork
from . import object_volumes
from .properties import HOW

TOLERANCE = 0.25  # pitches: tolerance of curves


def masked(content, mask):
    """The content with that mask, or with None if it protects nothing."""
    return replace(content, mask=None if mask is None or mask.volume == 0 else mask)


def said_of(content):
    whole, mask = content.volume, content.mask
    share = 0.0 if mask is None else mask.copy().intersect(whole).volume / max(whole.volume, 1e-9)
    return f"{100 * share:.0f} % of the material is protected"


class Masking(SculptWork):
    """Mixin of operators that change only the mask. The job returns it, or None."""

    doing = "Masking"
    cancelled = "Not masked: the mask is unchanged"

    def begin(self, context):
        _, self._before = self.take(context)
        return self.job(self._before.volume, self._before.mask)

    def finish(self, context, job):
        after = masked(self._before, self.mask_of(job.result))
        self.keep(after)
        self.report({"INFO"}, said_of(after))
        return {"FINISHED"}

    def mask_of(self, made):
        return made


class RIFFLER_OT_mask_form(Masking, bpy.types.Operator):
    """Protect the material inside a mesh object, or under the closed splines of a curve, seen along its own z"""

    bl_idname = "riffler.mask_form"
    bl_label = "Mask from Object"

    form: StringProperty(name="Form", description="Name of a mesh or a curve; empty: the other selected object")
    how: EnumProperty(name="How", items=HOW, default="REPLACE", description="How to combine with the existing mask")

    def begin(self, context):
        source = object_volumes.chosen(context, self.form, {"MESH", "CURVE"}, "a mesh or a curve")
        ob, self._before = self.take(context)
        volume = self._before.volume
        if source.type == "CURVE":
            surface = object_volumes.of_outline(context, source, ob, volume, TOLERANCE * volume.pitch)
        else:
            surface = object_volumes.of_object(context, source, ob)
        return TaskJob(object_volumes.task_of(surface, volume))

    def mask_of(self, form):
        before = self._before.mask
        if self.how == "REPLACE" or before is None:
            return None if self.how == "SUBTRACT" else form
        return before.copy().add(form) if self.how == "ADD" else before.copy().subtract(form)


class RIFFLER_OT_mask_invert(Masking, bpy.types.Operator):
    """Protect what was free, and free what was protected"""

    bl_idname = "riffler.mask_invert"
    bl_label = "Invert Mask"

    def job(self, volume, mask):
        return TaskJob(ThreadTask(lambda progress: _inverse(volume, mask, progress)))


def _inverse(volume, mask, progress):
    whole = riffler.Volume.block(volume.lower, volume.upper, volume.pitch, volume.directions)
    return whole if mask is None else whole.subtract(mask, progress=progress)


class RIFFLER_OT_mask_clear(Masking, bpy.types.Operator):
    """Remove the protection from the whole sculpt"""

    bl_idname = "riffler.mask_clear"
    bl_label = "Clear Mask"

    def job(self, volume, mask):
        return DoneJob(None)


CLASSES = (RIFFLER_OT_mask_form, RIFFLER_OT_mask_invert, RIFFLER_OT_mask_clear)
