"""Settings of the scene: tool presets and millimetres."""

import bpy
from bpy.props import FloatProperty

from ..bl import live, sculpts, store, units
from ..core import presets
from . import shared


class RIFFLER_OT_tool_preset(bpy.types.Operator):
    """Take the cutter of this name for strokes and cuts"""

    bl_idname = "riffler.tool_preset"
    bl_label = "Tool Preset"
    bl_options = {"INTERNAL"}  # no undo step, as of all settings of the sculpt tools

    name: bpy.props.StringProperty(name="Name", description="Of the preset")

    def execute(self, context):
        try:
            context.scene.riffler.tool.take(presets.preset(self.name))
        except ValueError as error:
            return shared.fail(self, error)
        return {"FINISHED"}


class RIFFLER_OT_millimetres(bpy.types.Operator):
    """Make one Blender unit so many millimetres in this scene, one if nothing is said; sculpts keep their size in mm,
    other objects their units"""

    bl_idname = "riffler.millimetres"
    bl_label = "Scene in Millimetres"
    bl_options = {"REGISTER", "UNDO"}

    unit: FloatProperty(
        name="Unit (mm)",
        default=1.0,
        min=1e-3,
        max=1e6,
        precision=3,
        options={"SKIP_SAVE"},
        description="Millimetres in one Blender unit",
    )

    @classmethod
    def poll(cls, context):
        return shared.object_mode(cls, context) and not shared.busy(cls, context)

    def execute(self, context):
        try:
            live.end_all()
            found = [ob for ob in context.scene.objects if sculpts.is_sculpt(ob) and not ob.data.library]
            for ob in found:  # what cannot be comes before the first change
                store.content(ob.data)
                shared.refuse_edits(ob)
            units.set_millimetres(context.scene, bpy.data.screens, units.clean(self.unit))
            for mesh in {ob.data for ob in found}:
                sculpts.refill(mesh, units.mm_per_unit(context.scene))
        except shared.ERRORS as error:
            return shared.fail(self, error)
        return {"FINISHED"}


CLASSES = (RIFFLER_OT_tool_preset, RIFFLER_OT_millimetres)
