"""Results of a sculpt: a plain mesh with a known error, and colours of its distance from a reference."""

import bpy
import numpy as np
import riffler
from bpy.props import FloatProperty, StringProperty

from ..blender import attributes, meshes, object_surfaces, operator_parts, refusals, scene_units
from ..blender.long_work import LongWork
from ..common import units
from ..common.job import ChainJob, TaskJob
from ..sculpt import live_registry, sculpts
from ..sculpt.sculpt_work import SculptWork
from . import properties


class RIFFLER_OT_to_mesh(properties.ResultSettings, SculptWork, bpy.types.Operator):
    """Make a plain mesh of the sculpt, decimated and smoothed, and report its distance from the sculpt"""

    bl_idname = "riffler.to_mesh"
    bl_label = "To Mesh"
    doing = "Making a mesh"
    cancelled = "No mesh was made"
    leaves_mesh = True

    def begin(self, context):
        _, content = self.take(context)
        iterations, tolerance = self.iterations, scene_units.clean(self.tolerance)

        def first(_):
            return riffler.submit(content.volume.to_mesh_with_report)

        def made_of(found):
            """The first step's mesh, whose report is kept; other steps give meshes."""
            if not isinstance(found, tuple):
                return found
            mesh, report = found
            self._thin = report.lost_note
            return mesh

        def smooth(found):
            self._exact = made_of(found)
            limit = scene_units.clean(self.smooth_tolerance)
            return riffler.submit(self._exact.smooth, iterations=iterations, tolerance=limit)

        def decimate(found):
            mesh = made_of(found)
            if self._exact is None:
                self._exact = mesh
            return riffler.submit(riffler.Mesh.decimate, mesh, tolerance=tolerance)

        def there(mesh):
            self._made = mesh
            return riffler.submit(riffler.Mesh.deviation, mesh, self._exact)

        def back(distance):
            self._there = distance
            return riffler.submit(riffler.Mesh.deviation, self._exact, self._made)

        self._exact, self._thin = None, ""
        changes = [smooth] * (iterations > 0) + [decimate] * (tolerance > 0)
        return ChainJob(first, *changes, there, back) if changes else ChainJob(first)

    def finish(self, context, job):
        changed = self._exact is not None
        if changed:
            mesh = self._made
        else:
            mesh, report = job.result
            self._thin = report.lost_note
        if not len(mesh.triangles):
            raise ValueError(self._thin or "the sculpt has no material left")
        if self._thin:
            self.report({"WARNING"}, self._thin)
        error = max(np.abs(self._there).max(), np.abs(job.result).max()) if changed else 0.0
        sculpt = bpy.data.objects[self._object]
        scale = sculpts.shown_mm_per_unit(sculpt.data)
        ob = bpy.data.objects.new(f"{sculpt.name} Mesh", bpy.data.meshes.new(f"{sculpt.name} Mesh"))
        meshes.fill(ob.data, np.asarray(mesh.vertices) / scale, mesh.triangles)
        ob.data[attributes.ERROR] = float(error)
        sculpts.take_looks(ob, sculpt)
        for collection in sculpt.users_collection:
            collection.objects.link(ob)
        ob.matrix_world = sculpt.matrix_world
        sculpts.select_only(context, ob)
        if self.hide_sculpt:
            sculpt.hide_set(True)
        self.report({"INFO"}, said_of(ob.data))
        return {"FINISHED"}

    def draw(self, context):
        operator_parts.draw_fields(self, properties.ResultSettings.__annotations__)


def said_of(mesh):
    """A note on the mesh compared with its sculpt."""
    count = units.counted(len(mesh.polygons), "triangle")
    return f"{count}, at most {units.trim(mesh[attributes.ERROR], 5)} mm from the sculpt"


def _in_world(context, ob):
    """In mm of the scene, vertex by vertex that of the evaluated mesh; a sculpt's with all triangles. ValueError if it
    is unknown."""
    if why := refusals.disabled(ob, context.view_layer):
        raise ValueError(why)
    matrix = meshes.matrix(ob.matrix_world)
    matrix[:3] *= scene_units.mm_per_unit(context.scene)
    if _shows_less(ob):
        return riffler.Mesh(*object_surfaces.placed(*sculpts.every_triangle(ob.data), matrix))
    return object_surfaces.surface(ob, context.evaluated_depsgraph_get(), matrix)


def _shows_less(ob):
    """Whether it is a sculpt that shows only the triangles that its shape needs."""
    if not sculpts.is_sculpt(ob) or ob.modifiers:
        return False
    return ob.data.riffler.shown_within > 0 and not sculpts.changed(ob.data)


class RIFFLER_OT_show_deviation(LongWork, bpy.types.Operator):
    """Colour the active mesh by its distance from another object, in mm: blue for too much material, red for too
    little
    """

    bl_idname = "riffler.show_deviation"
    bl_label = "Show Deviation"
    bl_options = {"REGISTER", "UNDO"}
    doing = "Measuring"
    cancelled = "Not measured: the mesh is unchanged"

    reference: StringProperty(name="Reference", description="Name of the object; empty: the other selected one")
    scale: FloatProperty(
        name="Colour Range (mm)",
        default=0.1,
        min=1e-5,
        precision=4,
        description="Distance at which colours reach full strength",
    )

    @classmethod
    def poll(cls, context):
        if context.object is None or context.object.type != "MESH":
            return operator_parts.deny(cls, "Select the mesh or the sculpt to colour")
        if why := refusals.linked(context.object, context.object.data):
            return operator_parts.deny(cls, why)
        return operator_parts.object_mode(cls, context) and not operator_parts.busy(cls, context)

    def begin(self, context):
        live_registry.end_all()
        ob = context.object
        others = [o for o in context.selected_objects if o != ob and o.type == "MESH"]
        name = self.reference or (others[0].name if len(others) == 1 else "")
        reference = bpy.data.objects.get(name)
        if reference is None:
            raise ValueError(f"there is no object {name!r}" if name else "select the reference as well, or name it")
        if reference == ob:
            raise ValueError(f"{ob.name} is measured from itself: choose another reference")
        if reference.type not in object_surfaces.WITH_SURFACE:
            raise ValueError(f"{name} has no surface: choose a mesh, curve, text, surface or metaball")
        self._object = ob.name
        own = _in_world(context, ob)
        same = _shows_less(ob) or len(own.vertices) == len(ob.data.vertices)  # all are shown with their colours
        if sculpts.is_sculpt(ob) and not ob.modifiers and not same:
            raise ValueError("the mesh was edited: rebuild it first")
        if not same:
            raise ValueError(f"{ob.name}: apply its modifiers first, since they change its vertices")
        return TaskJob(riffler.submit(riffler.Mesh.deviation, own, _in_world(context, reference), signed=True))

    def lost(self, context):
        ob = bpy.data.objects.get(self._object)
        return "" if ob is not None and ob.type == "MESH" else "Not measured: the mesh was removed meanwhile"

    def finish(self, context, job):
        mesh, distance = bpy.data.objects[self._object].data, np.asarray(job.result)
        if _shows_less(bpy.data.objects[self._object]):
            sculpts.show_all(mesh)
        if len(distance) != len(mesh.vertices):
            raise ValueError("not coloured: the mesh was changed meanwhile")
        attributes.show_distance(mesh, distance, scene_units.clean(self.scale))
        attributes.shade_by_attribute()
        low, high = (units.trim(v, 4) for v in (distance.min(), distance.max()))
        rms = units.trim(float(np.sqrt(np.mean(distance**2))), 4)
        self.report({"INFO"}, f"From {low} to {high} mm, RMS {rms} mm")
        return {"FINISHED"}


class RIFFLER_OT_hide_deviation(bpy.types.Operator):
    """Remove the deviation colours from the active mesh"""

    bl_idname = "riffler.hide_deviation"
    bl_label = "Hide Deviation"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        ob = context.object
        if ob is None or ob.type != "MESH" or attributes.SCALE not in ob.data:
            return operator_parts.deny(cls, "The active object shows no deviation")
        if why := refusals.linked(ob, ob.data):
            return operator_parts.deny(cls, why)
        return True

    def execute(self, context):
        attributes.hide_colours(context.object.data)
        attributes.settle()
        if sculpts.is_sculpt(context.object):
            sculpts.show_needed(context.object.data)
        return {"FINISHED"}


CLASSES = (RIFFLER_OT_to_mesh, RIFFLER_OT_show_deviation, RIFFLER_OT_hide_deviation)
