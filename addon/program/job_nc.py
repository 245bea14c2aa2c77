"""Writes a calculated job as NC code."""

import bpy
import numpy as np
from bpy.props import EnumProperty, StringProperty
from bpy_extras.io_utils import ExportHelper

from ..blender import operator_parts
from ..blender.panel_parts import lines, wrapped
from ..common import problems, units
from ..machining import inputs, job_program, job_store
from ..plan.machines import MACHINES
from ..plan.panel import Tab
from ..plan.pure import machine_fields
from . import programs
from .properties import GivenOptions


class RIFFLER_OT_machining_nc(GivenOptions, bpy.types.Operator, ExportHelper):
    """Write the job's operations as one NC program; nothing is written that a simulation has found a fault in"""

    bl_idname = "riffler.machining_nc"
    bl_label = "Write Job"

    filter_glob: StringProperty(default=machine_fields.file_filter("*.nc;*.tap"), options={"HIDDEN"})
    post: EnumProperty(
        name="Machine",
        items=MACHINES,
        default="3-axis",
        options={"SKIP_SAVE"},
        description="Machine that the NC code is written for",
    )

    @property
    def filename_ext(self):
        return machine_fields.extension(self.post)

    @classmethod
    def poll(cls, context):
        if why := inputs.unfit(context.scene):
            return operator_parts.deny(cls, why)
        if not job_store.identity(context.scene):
            return operator_parts.deny(cls, "Nothing is calculated: use Calculate first")
        return not operator_parts.busy(cls, context, simulation=False)

    def invoke(self, context, event):
        self._take_settings(context)
        try:
            programs.options(context.scene, self.post, self.options)
        except ValueError as error:  # before the user chooses a file in vain
            return operator_parts.fail(self, error)
        if not self.filepath:
            self.filepath = f"{context.scene.riffler.plan.part.name}{self.filename_ext}"
        return ExportHelper.invoke(self, context, event)

    def _take_settings(self, context):
        """The machine that was not given is the scene's."""
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
        notes = []
        if len(written.rewinds):
            rows = ", ".join(str(int(r)) for r in np.atleast_1d(written.rewinds)[:4])
            notes.append(f"The tool leaves the material to turn an axis back, at rows {rows}")
        operator_parts.tell_all(self, done, notes)
        return {"FINISHED"}

    def draw(self, context):
        operator_parts.draw_fields(self, ("post",))


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
        if scene.riffler.machining.problem:
            lines(layout, *wrapped(context, "The operations must not run: see the panel Job."), icon="ERROR")
        layout.operator(RIFFLER_OT_machining_nc.bl_idname, icon="EXPORT")


CLASSES = (RIFFLER_OT_machining_nc, RIFFLER_PT_job_nc)
