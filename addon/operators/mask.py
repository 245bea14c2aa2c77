"""What of a sculpt is protected: from closed curves and meshes, the other way round, or nothing."""

from dataclasses import replace

import bpy
import riffler
from bpy.props import EnumProperty, StringProperty

from ..bl import forms
from ..core.job import TaskJob
from ..properties.clay import HOW
from .sculpt_work import SculptEdit, SculptWork

TOLERANCE = 0.25  # pitches: of curves


def masked(content, mask):
    """The content with that mask, of which None is left where it protects nothing."""
    return replace(content, mask=None if mask is None or mask.volume == 0 else mask)


def said_of(content):
    whole, mask = content.volume, content.mask
    share = 0.0 if mask is None else mask.copy().intersect(whole).volume / max(whole.volume, 1e-9)
    return f"{100 * share:.0f} % of the material is protected"


class Masking(SculptEdit):
    """Mixin of what changes the mask only, at once."""

    def edited(self, context, ob, content):
        return masked(content, self.mask_of(content))

    def tell(self, before, after):
        self.report({"INFO"}, said_of(after))


class RIFFLER_OT_mask_form(SculptWork, bpy.types.Operator):
    """Protect what lies in a mesh object, or under the closed splines of a curve, seen along its own z"""

    bl_idname = "riffler.mask_form"
    bl_label = "Mask from Object"
    doing = "Masking"
    cancelled = "Not masked: what is protected is as it was"

    form: StringProperty(name="Form", description="Name of a mesh or a curve; empty: the other selected object")
    how: EnumProperty(name="How", items=HOW, default="REPLACE", description="What becomes of the mask that there is")

    def begin(self, context):
        source = forms.chosen(context, self.form, {"MESH", "CURVE"}, "a mesh or a curve")
        ob, self._before = self.take(context)
        volume = self._before.volume
        if source.type == "CURVE":
            surface = forms.of_outline(context, source, ob, volume, TOLERANCE * volume.pitch)
        else:
            surface = forms.of_object(context, source, ob)
        return TaskJob(forms.task_of(surface, volume))

    def finish(self, context, job):
        after = masked(self._before, self._combined(self._before.mask, job.result))
        self.keep(after)
        self.report({"INFO"}, said_of(after))
        return {"FINISHED"}

    def _combined(self, before, form):
        if self.how == "REPLACE" or before is None:
            return None if self.how == "SUBTRACT" else form
        return before.copy().add(form) if self.how == "ADD" else before.copy().subtract(form)


class RIFFLER_OT_mask_invert(Masking, bpy.types.Operator):
    """Protect what was free, and free what was protected"""

    bl_idname = "riffler.mask_invert"
    bl_label = "Invert Mask"

    def mask_of(self, content):
        v = content.volume
        mask = riffler.Volume.block(v.lower, v.upper, v.pitch, v.directions)
        return mask if content.mask is None else mask.subtract(content.mask)


class RIFFLER_OT_mask_clear(Masking, bpy.types.Operator):
    """Protect nothing"""

    bl_idname = "riffler.mask_clear"
    bl_label = "Clear Mask"

    def mask_of(self, content):
        return None


CLASSES = (RIFFLER_OT_mask_form, RIFFLER_OT_mask_invert, RIFFLER_OT_mask_clear)
