"""Writes a calculated job as NC code."""

import bpy
import numpy as np
from bpy.props import EnumProperty

from ..blender import operator_parts, scene_units
from ..blender.panel_parts import lines, wrapped
from ..common import problems, units
from ..machining import inputs, job_program, job_store
from ..plan.machines import MACHINES
from ..plan.panel import Tab
from ..sculpt import sculpts
from . import programs
from .nc_file import WritesNc


class RIFFLER_OT_machining_nc(WritesNc, bpy.types.Operator):
    """Write the job's operations as one NC program; nothing is written that a simulation has found a fault in"""

    bl_idname = "riffler.machining_nc"
    bl_label = "Write Job"

    post: EnumProperty(
        name="Machine",
        items=MACHINES,
        default="3-axis",
        options={"SKIP_SAVE"},
        description="Machine that the NC code is written for",
    )

    @classmethod
    def poll(cls, context):
        if why := inputs.unfit(context.scene):
            return operator_parts.deny(cls, why)
        if not job_store.identity(context.scene):
            return operator_parts.deny(cls, "Nothing is calculated: use Calculate first")
        return not operator_parts.busy(cls, context, simulation=False)

    def _stem(self, context):
        return context.scene.riffler.plan.part.name

    def _take_settings(self, context):
        """Takes the scene's machine if no machine was given."""
        if not self.properties.is_property_set("post"):
            self.post = context.scene.riffler.plan.post

    def execute(self, context):
        self._take_settings(context)
        scene = context.scene
        try:
            chosen = programs.options(scene, self.post, self.options)
            program, given = job_program.of_scene(context)
            path = bpy.path.abspath(self.filepath)
            problems.check_target(path)
            at_zero = program.transformed(job_program.to_zero(scene))
            tolerance = min(op.tolerance for op in job_store.operations(scene).values())
            written = at_zero.write(path, post=self.post, tolerance=tolerance, options=chosen)
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        count = units.counted(len(given.wanted), "operation")
        done = f"{bpy.path.basename(path)}: {count}, {units.counted(written.blocks, 'block')}"
        operator_parts.tell_all(self, done, programs.rewound(written))
        return {"FINISHED"}

    def draw(self, context):
        operator_parts.draw_fields(self, ("post",))


PLACES = (
    ("TOP", "Middle of the Top", "The middle of the upper side of the stock's box"),
    ("CORNER", "Corner of the Top", "The corner of that side with the smallest coordinates"),
    ("CURSOR", "3D Cursor", "The 3D cursor"),
)


class RIFFLER_OT_machining_zero(bpy.types.Operator):
    """Put the program's zero at a place of the stock, or at the 3D cursor"""

    bl_idname = "riffler.machining_zero"
    bl_label = "Set Zero"
    bl_options = {"REGISTER", "UNDO"}

    place: EnumProperty(name="Place", items=PLACES, default="TOP", description="Where the zero is")

    @classmethod
    def poll(cls, context):
        if inputs.stock_of(context.scene) is None:
            return operator_parts.deny(cls, inputs.NO_STOCK)
        return not operator_parts.busy(cls, context)

    def execute(self, context):
        scene = context.scene
        try:
            zero = self._place(scene)
        except ValueError as error:
            return operator_parts.fail(self, error)
        scene.riffler.machining.zero = zero
        return {"FINISHED"}

    def _place(self, scene):
        """(3,) the zero in the scene's frame, mm."""
        if self.place == "CURSOR":
            return np.array(scene.cursor.location) * scene_units.mm_per_unit(scene)
        ob = inputs.stock_of(scene)
        to_world = sculpts.to_world_mm(ob, scene)
        low, high = np.array(ob.data.riffler.lower), np.array(ob.data.riffler.upper)
        axis = np.linalg.inv(to_world[:3, :3]) @ inputs.world_axis(scene)
        k = int(np.abs(axis).argmax())  # the side that the tool comes from
        at = 0.5 * (low + high) if self.place == "TOP" else low.copy()
        at[k] = high[k] if axis[k] > 0 else low[k]
        return to_world[:3, :3] @ at + to_world[:3, 3]


class RIFFLER_PT_job_nc(Tab, bpy.types.Panel):
    bl_idname = "RIFFLER_PT_job_nc"
    bl_label = "NC Code of the Job (mm)"

    @classmethod
    def poll(cls, context):
        return len(context.scene.riffler.machining.rows) > 0

    def draw(self, context):
        layout, scene = self.layout, context.scene
        column = layout.column(align=True)
        column.use_property_split = True
        column.use_property_decorate = False
        column.prop(scene.riffler.plan, "post")
        column.prop(scene.riffler.machining, "zero")
        column.operator_menu_enum(RIFFLER_OT_machining_zero.bl_idname, "place", icon="EMPTY_AXIS")
        if scene.riffler.machining.problem:
            lines(layout, *wrapped(context, "The operations must not run: see the panel Job."), icon="ERROR")
        layout.operator(RIFFLER_OT_machining_nc.bl_idname, icon="EXPORT")


CLASSES = (RIFFLER_OT_machining_zero, RIFFLER_OT_machining_nc, RIFFLER_PT_job_nc)
