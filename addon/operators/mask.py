"""What of a sculpt is protected: from closed curves and meshes, the other way round, or nothing."""

import bpy
import riffler
from bpy.props import EnumProperty, StringProperty

from ..bl import forms
from ..core.cache import Content
from ..properties.clay import HOW
from .sculpt_work import SculptEdit

TOLERANCE = 0.25  # pitches: of curves


class Masking(SculptEdit):
    """Mixin of what changes the mask only."""

    def edited(self, context, ob, content):
        mask = self.masked(context, ob, content)
        return Content(content.volume, content.cuts, None if mask is None or mask.volume == 0 else mask)

    def tell(self, before, after):
        whole, mask = after.volume, after.mask
        share = 0.0 if mask is None else mask.copy().intersect(whole).volume / max(whole.volume, 1e-9)
        self.report({"INFO"}, f"{100 * share:.0f} % of the material is protected")


class RIFFLER_OT_mask_form(Masking, bpy.types.Operator):
    """Protect what lies in a mesh object, or under the closed splines of a curve, seen along its own z"""

    bl_idname = "riffler.mask_form"
    bl_label = "Mask from Object"

    form: StringProperty(name="Form", description="Name of a mesh or a curve; empty: the other selected object")
    how: EnumProperty(name="How", items=HOW, default="REPLACE", description="What becomes of the mask that there is")

    def masked(self, context, ob, content):
        source = forms.chosen(context, self.form, {"MESH", "CURVE"}, "a mesh or a curve")
        if source.type == "CURVE":
            surface = forms.of_outline(context, source, ob, content.volume, TOLERANCE * content.volume.pitch)
        else:
            surface = forms.of_object(context, source, ob)
        mask = forms.volume_of(surface, content.volume)
        if self.how == "REPLACE" or content.mask is None:
            return None if self.how == "SUBTRACT" else mask
        before = content.mask.copy()
        return before.add(mask) if self.how == "ADD" else before.subtract(mask)


class RIFFLER_OT_mask_invert(Masking, bpy.types.Operator):
    """Protect what was free, and free what was protected"""

    bl_idname = "riffler.mask_invert"
    bl_label = "Invert Mask"

    def masked(self, context, ob, content):
        v = content.volume
        mask = riffler.Volume.block(v.lower, v.upper, v.pitch, v.directions)
        return mask if content.mask is None else mask.subtract(content.mask)


class RIFFLER_OT_mask_clear(Masking, bpy.types.Operator):
    """Protect nothing"""

    bl_idname = "riffler.mask_clear"
    bl_label = "Clear Mask"

    def masked(self, context, ob, content):
        return None


CLASSES = (RIFFLER_OT_mask_form, RIFFLER_OT_mask_invert, RIFFLER_OT_mask_clear)
