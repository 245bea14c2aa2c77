"""Imports CAD files (STEP, IGES, BREP) as a mesh object. An attribute has the exact face of each of its faces."""

import os

import bpy
import numpy as np
import riffler
from bpy_extras.io_utils import ImportHelper
from riffler import cad

from ..blender import attributes, exact_surfaces, meshes, operator_parts, refusals, scene_units
from ..blender.exact_surfaces import FILE, NAMES, TOLERANCE
from ..blender.fields import length
from ..blender.file_work import FileWork
from ..blender.long_work import LongWork
from ..common import problems, units
from ..common.job import TaskJob


class ReadCad(LongWork):
    """Mixin: reads a CAD file in another process and fills a mesh with the result."""

    doing = "Reading CAD File"
    tolerance: length("Tolerance", 0.01, "Largest distance of the triangles from the exact faces, in mm", 1e-4)

    def read(self, path):
        problems.check_source(path)
        tolerance = units.clean(self.tolerance)
        return TaskJob(riffler.submit(cad.read, path, tolerance=tolerance, python=exact_surfaces.python()))

    def fill(self, context, mesh, path, part):
        """Replaces the mesh's content with the part, in scene units, and reports what was mended."""
        meshes.fill(mesh, part.mesh.vertices / scene_units.mm_per_unit(context.scene), part.mesh.triangles)
        attributes.set_exact_faces(mesh, part.face_of_triangle)
        _paint(mesh, part)
        mesh[FILE], mesh[TOLERANCE] = path, part.report.tolerance
        mesh.pop(NAMES, None)
        if any(face.name for face in part.faces):
            mesh[NAMES] = [face.name for face in part.faces]
        for note in part.report.notes:
            self.report({"WARNING"}, f"{os.path.basename(path)}: {note}")
        lower, upper = part.mesh.bounds
        told = (units.counted(len(part.mesh.triangles), "triangle"), units.format_size(upper - lower))
        self.report({"INFO"}, f"{os.path.basename(path)}: {', '.join(told)}")


def _paint(mesh, part):
    """Makes a material for each colour of the file, if it has any. Reuses materials of earlier imports."""
    colors = list(dict.fromkeys(face.color for face in part.faces if face.color is not None))
    mesh.materials.clear()
    if not colors:
        return
    for color in colors:
        mesh.materials.append(_material(color))
    plain = len(colors)
    if any(face.color is None for face in part.faces):
        mesh.materials.append(None)
    slots = np.array([plain if face.color is None else colors.index(face.color) for face in part.faces], np.int32)
    mesh.polygons.foreach_set("material_index", np.ascontiguousarray(slots[part.face_of_triangle]))


def _material(color):
    name = "CAD #" + "".join(f"{round(255 * x):02X}" for x in color)
    made = bpy.data.materials.get(name)
    if made is None:
        made = bpy.data.materials.new(name)
        linear = [x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4 for x in color]  # as Blender has them
        made.diffuse_color = (*linear, 1.0)
    return made


class RIFFLER_OT_import_cad(FileWork, ReadCad, bpy.types.Operator, ImportHelper):
    """Import a STEP, IGES or BREP file as a mesh in millimetres; its faces have the numbers of the exact faces"""

    bl_idname = "riffler.import_cad"
    bl_label = "Import CAD File"
    bl_options = {"REGISTER", "UNDO"}
    helper = ImportHelper
    cancelled = "Not imported: the scene is unchanged"

    filename_ext = ".step"
    filter_glob: bpy.props.StringProperty(default="*.step;*.stp;*.iges;*.igs;*.brep", options={"HIDDEN"})

    @classmethod
    def poll(cls, context):
        return operator_parts.object_mode(cls, context) and not operator_parts.busy(cls, context)

    def draw(self, context):
        operator_parts.draw_fields(self, ("tolerance",))

    def begin(self, context):
        return self.read(bpy.path.abspath(self.filepath))

    def finish(self, context, job):
        path = bpy.path.abspath(self.filepath)
        name = os.path.splitext(os.path.basename(path))[0]
        mesh = bpy.data.meshes.new(name)
        self.fill(context, mesh, path, job.result)
        ob = bpy.data.objects.new(name, mesh)
        context.collection.objects.link(ob)
        for other in context.selected_objects:
            other.select_set(False)
        ob.select_set(True)
        context.view_layer.objects.active = ob
        return {"FINISHED"}


class RIFFLER_OT_retessellate(ReadCad, bpy.types.Operator):
    """Read the active object's CAD file again with another tolerance; place, name and modifiers stay"""

    bl_idname = "riffler.retessellate"
    bl_label = "Change CAD Tolerance"
    bl_options = {"REGISTER", "UNDO"}
    cancelled = "Not read: the mesh is unchanged"

    @classmethod
    def poll(cls, context):
        ob = context.object
        if ob is None or ob.type != "MESH" or FILE not in ob.data:
            return operator_parts.deny(cls, "Select an object that was imported from a CAD file")
        if why := refusals.linked(ob, ob.data):
            return operator_parts.deny(cls, why)
        return operator_parts.object_mode(cls, context) and not operator_parts.busy(cls, context)

    def begin(self, context):
        self._object = context.object.name
        return self.read(context.object.data[FILE])

    def lost(self, context):
        ob = bpy.data.objects.get(self._object)
        kept = ob is not None and ob.type == "MESH" and FILE in ob.data
        return "" if kept else "Not read: the object was removed meanwhile"

    def finish(self, context, job):
        if why := self.lost(context):
            raise ValueError(why)
        mesh = bpy.data.objects[self._object].data
        self.fill(context, mesh, mesh[FILE], job.result)
        return {"FINISHED"}


CLASSES = (RIFFLER_OT_import_cad, RIFFLER_OT_retessellate)
