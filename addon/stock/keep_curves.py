"""Strokes from curve objects that were not drawn with a sculpt tool."""

import bpy
import numpy as np

from ..blender import curve_objects, operator_parts, refusals
from ..common import splines, units
from ..sculpt import brushes, kept_strokes, live_registry, sculpt_work, sculpts
from ..sculpt.pure.stroke_curves import MOST_AXES, Stroke, chains
from .cut_paths import nearest_on_surface

NOTHING = "Select the curves that become strokes, and the sculpt last"


class RIFFLER_OT_stroke_add_curves(bpy.types.Operator):
    """Cut along the selected curves with the active tool, Depth below them, and keep them as strokes"""

    bl_idname = "riffler.stroke_add_curves"
    bl_label = "Add Curves"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return sculpt_work.sculpt_poll(cls, context)

    def execute(self, context):
        ob = sculpts.active(context)
        curves = [o for o in context.selected_objects if o.type == "CURVE"]
        try:
            if not curves:
                raise ValueError(NOTHING)
            sculpt_work.refuse_edits(ob)
            refusals.refuse(context, ob)
            content = live_registry.content(ob)
            if content.mask is not None:
                raise ValueError(kept_strokes.MASKED)
            strokes = [(curve, self._stroke(context, ob, curve)) for curve in curves]
            if kept_strokes.begin(ob, content):
                self.report({"WARNING"}, kept_strokes.DROPPED)
            for curve, stroke in strokes:
                kept_strokes.tie(ob, curve)
                kept_strokes.add_row(ob, curve, stroke)
            context.view_layer.update()
            kept_strokes.edit(ob)
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        return {"FINISHED"}

    def _stroke(self, context, ob, curve):
        """ValueError if the curve has nothing to cut along."""
        own = context.scene.riffler
        brush = brushes.active(context)
        hand = brush is not None and brush.hand
        adds = brush is not None and brush.cuts == "add"
        choice = own.sculpt.choice("hand" if hand else "add" if adds else "remove")
        tool = (own.hand_tool if hand else own.tool).dictionary()
        lines = curve_objects.splines(curve, None, sculpts.from_object(ob, curve))
        axes = []
        for line in lines if choice.axis == "NORMAL" else ():
            points, _ = splines.evaluate(line, 0.1 * ob.data.riffler.pitch)
            if len(points) < 2:
                axes.append(np.array([[0.0, 0.0, 1.0]]))
                continue
            points, _ = splines.refine(points, np.zeros(len(points)), splines.length(points) / MOST_AXES)
            scale = sculpts.shown_mm_per_unit(ob.data)
            _, normals = nearest_on_surface(ob, context.evaluated_depsgraph_get(), points, scale)
            axes.append(normals)
        depth = units.clean(-choice.depth if adds else choice.depth)
        stroke = Stroke(tool, "add" if adds else "remove", hand, depth, choice.lean, choice.turn, (), tuple(axes))
        try:
            chains(stroke, lines, ob.data.riffler.pitch, 0.1 * ob.data.riffler.pitch)
        except ValueError as error:
            raise ValueError(f"{curve.name}: {error}") from error
        return stroke


CLASSES = (RIFFLER_OT_stroke_add_curves,)
