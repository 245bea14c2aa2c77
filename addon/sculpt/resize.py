"""F and Shift F, [ and ]: radius, depth and strength of the sculpt tools, by the pointer's distance or in steps.

Blender's own radial control leaves an undo step, which settings of a brush do not.
"""

import bpy
from bpy.props import BoolProperty, EnumProperty

from ..blender import operator_parts
from ..common import units
from . import pointer
from .pure import sizing

FIELDS = (
    ("RADIUS", "Radius", "Radius of the cutter"),
    ("WIDTH", "Width", "Width of the hand tool"),
    ("DEPTH", "Depth", "Depth of the stroke"),
    ("STRENGTH", "Strength", "Strength of smoothing, and of brushes that level, pull or pinch"),
)
SHORTER = 0.9  # ratio of sizes for one step
FACTOR_PIXELS = 200.0  # pixels for the full strength

WORDS = ("ZERO", "ONE", "TWO", "THREE", "FOUR", "FIVE", "SIX", "SEVEN", "EIGHT", "NINE")
DIGITS = {
    **{word: str(k) for k, word in enumerate(WORDS)},
    **{f"NUMPAD_{k}": str(k) for k in range(10)},
    "PERIOD": ".",
    "NUMPAD_PERIOD": ".",
    "COMMA": ".",
    "BACK_SPACE": "\b",
}


class RIFFLER_OT_resize(bpy.types.Operator):
    """Set the size by the pointer's distance from the centre of the circle, or type a number (Shift: finer, Ctrl:
    round numbers)
    """

    bl_idname = "riffler.resize"
    bl_label = "Resize Cutter"
    bl_options = set()  # settings of a brush are not undo steps

    field: EnumProperty(name="Field", items=FIELDS, default="RADIUS", options={"SKIP_SAVE"}, description="Size to set")

    @classmethod
    def poll(cls, context):
        return context.region_data is not None or operator_parts.deny(cls, "Use it in a 3D view")

    def invoke(self, context, event):
        settings = context.scene.riffler.sculpt
        scale = FACTOR_PIXELS if self.field == "STRENGTH" else pointer.pixels_per_mm
        self._name = self.field.lower()
        self._region = context.region.x, context.region.y
        at = event.mouse_x - self._region[0], event.mouse_y - self._region[1]
        self._drag = sizing.Drag(getattr(settings, self._name), scale, at)
        self._show(context)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS":
            self._set(context, self._drag.first)
            return self._end(context, {"CANCELLED"})
        if event.type in {"LEFTMOUSE", "RET", "NUMPAD_ENTER"} and event.value == "PRESS":
            return self._end(context, {"FINISHED"})
        if event.type == "MOUSEMOVE":
            at = event.mouse_x - self._region[0], event.mouse_y - self._region[1]
            self._set(context, self._drag.to(at, fine=event.shift, rounded=event.ctrl))
        elif event.type in DIGITS and event.value == "PRESS":
            self._set(context, self._drag.typed(DIGITS[event.type]))
        return {"RUNNING_MODAL"}

    def cancel(self, context):
        self._end(context, {"CANCELLED"})

    def _set(self, context, value):
        settings = context.scene.riffler.sculpt
        setattr(settings, self._name, value)
        self._drag.value = getattr(settings, self._name)  # clamped to its field's range
        self._show(context)

    def _show(self, context):
        unit = "" if self.field == "STRENGTH" else " mm"
        pointer.sizing = self._drag
        label = next(label for name, label, _ in FIELDS if name == self.field)
        text = self._drag.text or units.trim(self._drag.value, 3)
        context.area.header_text_set(f"{label}: {text}{unit}")
        context.area.tag_redraw()

    def _end(self, context, result):
        pointer.sizing = None
        if context.area is not None:
            context.area.header_text_set(None)
            context.area.tag_redraw()
        return result


class RIFFLER_OT_size_step(bpy.types.Operator):
    """Make the cutter a step smaller or larger"""

    bl_idname = "riffler.size_step"
    bl_label = "Step Cutter Size"
    bl_options = set()

    field: EnumProperty(
        name="Field", items=FIELDS[:2], default="RADIUS", options={"SKIP_SAVE"}, description="Size to set"
    )
    larger: BoolProperty(name="Larger", options={"SKIP_SAVE"}, description="Make the cutter larger; off: smaller")

    def execute(self, context):
        settings = context.scene.riffler.sculpt
        name, step = self.field.lower(), 1 / SHORTER if self.larger else SHORTER
        setattr(settings, name, units.clean(getattr(settings, name) * step))
        if context.area is not None:
            context.area.tag_redraw()
        return {"FINISHED"}


CLASSES = (RIFFLER_OT_resize, RIFFLER_OT_size_step)


def detach():
    pointer.sizing = None
