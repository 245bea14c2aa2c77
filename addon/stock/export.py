"""Export of STL, 3MF, NC code and recordings."""

import bpy
import numpy as np
import riffler
from bpy_extras.io_utils import ExportHelper
from riffler import threemf_writer

from ..blender import operator_parts
from ..blender.fields import length
from ..blender.file_work import FileWork
from ..common import poses, problems, units
from ..common.job import AfterJob, PiecesJob, TaskJob
from ..sculpt import live_registry, sculpt_work, sculpts
from ..sculpt.surfaces import DETAIL, SHARE
from ..translations import local
from . import cut_paths, cut_program, properties


class Export(ExportHelper):
    """Mixin: file selector in a window, one clear message for an error."""

    @classmethod
    def poll(cls, context):
        if sculpts.active(context) is None:
            return operator_parts.deny(cls, sculpt_work.no_sculpt(context))
        return True

    def execute(self, context):
        try:
            path = bpy.path.abspath(self.filepath)
            problems.check_target(path)
            ob = sculpts.active(context)
            sculpt_work.check_state(self, context, ob)
            done = self.write(context, ob, path)
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        self.report({"INFO"}, f"{bpy.path.basename(path)}: {done}")
        return {"FINISHED"}

    def removing(self, ob, content):
        """cut_program.removing, with a report on what is left out."""
        cuts = cut_program.removing(ob.name, content)
        for said in cut_program.not_in_cuts(content):
            self.report({"WARNING"}, local(said))
        return cuts


class ExportSurface(FileWork):
    """Mixin of the operators that write the surface, by `job`, completely or not at all. `in_background`: that of the
    job."""

    bl_options = set()  # a written file is not an undo step
    helper = ExportHelper
    doing = "Exporting"
    cancelled = "Not exported: no file was written"

    world: bpy.props.BoolProperty(
        name="Apply Transform",
        default=True,
        description="Apply the object's transform; off: as milled, in the stock's own coordinates",
    )

    detail: bpy.props.EnumProperty(name="Triangles", items=DETAIL, default="NEEDED", description="What is written")
    tolerance: length(
        "Tolerance", 0.0, "Largest distance from the surface of all triangles, in mm; 0: a tenth of the pitch", 0.0
    )

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "world")
        layout.prop(self, "detail")
        row = layout.row()
        row.enabled = self.detail == "NEEDED"
        row.prop(self, "tolerance")
        if (ob := sculpts.active(context)) is None:
            return
        if self.detail == "NEEDED":
            within = units.trim(self.within(ob.data.riffler.pitch), 6)
            layout.label(text=f"{local('Tolerance')}: {within} mm", translate=False)
        amount = _amount(sculpts.all_triangles(ob.data), self.filename_ext)
        layout.label(text=f"{local('All')}: {amount}", translate=False)

    def within(self, pitch):
        """The tolerance in mm; None for all triangles."""
        if self.detail == "ALL":
            return None
        return units.clean(self.tolerance) or SHARE * pitch

    @classmethod
    def poll(cls, context):
        if sculpts.active(context) is None:
            return operator_parts.deny(cls, sculpt_work.no_sculpt(context))
        running = context.window_manager.riffler.running
        return not running or operator_parts.deny(cls, f"{running}: Esc cancels")

    def begin(self, context):
        ob, path = sculpts.active(context), bpy.path.abspath(self.filepath)
        problems.check_target(path, self.filename_ext)
        sculpt_work.check_state(self, context, ob)
        sculpt_work.tell_edits(self, ob)
        matrix = sculpts.to_world_mm(ob, context.scene) if self.world else np.eye(4)
        name = ob.name

        # a copy, so that sculpting can continue meanwhile
        volume = live_registry.content(ob).volume.copy()
        tolerance = self.within(volume.pitch)

        def write(made):
            surface, report = made
            self._thin = report.lost_note
            if not len(surface.triangles):
                raise ValueError(self._thin or "the sculpt has no material left")
            surface = placed(surface, matrix)
            self._done = _said(surface, report.all_triangles, tolerance, self.filename_ext)
            return self.job(surface, path, name)

        task = riffler.submit(volume.to_mesh_with_report, tolerance=tolerance)
        return AfterJob(task, write, self.in_background)

    def finish(self, context, job):
        name = bpy.path.basename(self.filepath)
        if self._thin:
            self.report({"WARNING"}, f"{name}: {self._thin}")
        self.report({"INFO"}, f"{name}: {self._done}")
        return {"FINISHED"}


def _amount(triangles, suffix):
    """How many they are; with the size of an STL, which follows from it."""
    size = f", {units.format_bytes(84 + 50 * triangles)}" if suffix == ".stl" else ""
    return units.counted(triangles, "triangle") + size


def _said(surface, all_triangles, tolerance, suffix):
    lower, upper = surface.bounds
    said = f"{_amount(len(surface.triangles), suffix)}, {units.format_size(upper - lower)}"
    if tolerance is None:
        return said
    return f"{said}; within {units.trim(tolerance, 6)} mm of all {_amount(all_triangles, suffix)}"


class RIFFLER_OT_export_stl(ExportSurface, bpy.types.Operator, ExportHelper):
    """Write the active sculpt as a binary STL in millimetres, straight from its volume"""

    bl_idname = "riffler.export_stl"
    bl_label = "Export STL"

    filename_ext = ".stl"
    filter_glob: bpy.props.StringProperty(default="*.stl", options={"HIDDEN"})
    in_background = True

    def job(self, surface, path, name):
        return TaskJob(riffler.submit(riffler.Mesh.write, surface, path), self._done)


class RIFFLER_OT_export_3mf(ExportSurface, bpy.types.Operator, ExportHelper):
    """Write the active sculpt as a 3MF file in millimetres, straight from its volume"""

    bl_idname = "riffler.export_3mf"
    bl_label = "Export 3MF"

    filename_ext = ".3mf"
    filter_glob: bpy.props.StringProperty(default="*.3mf", options={"HIDDEN"})
    in_background = False

    def job(self, surface, path, name):
        mesh = surface.vertices, surface.triangles
        return PiecesJob(threemf_writer.pieces(path, *mesh, name), threemf_writer.count(*mesh))


def placed(surface, matrix):
    """A surface under an affine map; still outward if the map mirrors."""
    if np.allclose(matrix, np.eye(4), rtol=0, atol=1e-12):
        return surface
    triangles = surface.triangles
    if np.linalg.det(matrix[:3, :3]) < 0:
        triangles = np.ascontiguousarray(triangles[:, ::-1])
    return riffler.Mesh(poses.transform_points(matrix, surface.vertices), triangles)


class RIFFLER_OT_export_nc(properties.NcSettings, Export, bpy.types.Operator):
    """Write the cuts made on the active sculpt as NC code in the stock's own coordinates"""

    bl_idname = "riffler.export_nc"
    bl_label = "Write NC"

    filename_ext = ".ngc"
    filter_glob: bpy.props.StringProperty(default="*.ngc;*.nc;*.tap", options={"HIDDEN"})

    def write(self, context, ob, path):
        content = live_registry.content(ob)
        feed, spindle = units.clean(self.feed), units.clean(self.spindle)
        cuts = self.removing(ob, content)
        program = cut_program.of_cuts(ob.name, cuts, content.volume, feed, spindle)
        program.write(path, post=self.post)
        return f"{units.counted(len(cuts), 'cut')}, {units.counted(len(program.poses), 'row')}"


class RIFFLER_OT_export_recording(Export, bpy.types.Operator):
    """Write the cuts made on the active sculpt as a recording, to cut another stock with"""

    bl_idname = "riffler.export_recording"
    bl_label = "Save Recording"

    filename_ext = ".rjournal"
    filter_glob: bpy.props.StringProperty(default="*.rjournal", options={"HIDDEN"})

    def write(self, context, ob, path):
        content = live_registry.content(ob)
        cuts = self.removing(ob, content)
        cut_paths.to_recording(cuts, content.volume).save(path)
        return units.counted(len(cuts), "stroke")


CLASSES = (RIFFLER_OT_export_stl, RIFFLER_OT_export_3mf, RIFFLER_OT_export_nc, RIFFLER_OT_export_recording)
