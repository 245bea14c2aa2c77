"""Makes new stock, and rebuilds a stock's mesh."""

from typing import NamedTuple

import bpy
import numpy as np
import riffler
from mathutils import Matrix
from riffler.mesh_notes import notes_on

from ..blender import meshes, object_surfaces, operator_parts, refusals, scene_units
from ..blender.long_work import LongWork
from ..common import fitting, units
from ..common.contents import Content
from ..common.job import DoneJob, TaskJob
from ..sculpt import live_registry, sculpt_store, sculpt_work, sculpts
from . import cut_paths, properties
from .pure import estimate, round_facets

FACET = 0.02  # pitches: largest distance of new facets from the round surface, which no light shows
NO_SOURCE = "select the object to make material of: a mesh, curve, text, surface or metaball"


def source_size(ob, scene):
    """Its displayed size along its own axes in millimetres."""
    return tuple(float(d) * scene_units.mm_per_unit(scene) for d in ob.dimensions)


class _New(NamedTuple):
    """The sculpt to be made from the material."""

    name: str
    frame: Matrix  # its place in the world
    source: tuple = ()  # its source: name and file, as keys of bpy.data.objects


class RIFFLER_OT_new_stock(properties.StockSettings, LongWork, bpy.types.Operator):
    """Make a block of material, or make material of the active object"""

    bl_idname = "riffler.new_stock"
    bl_label = "New Stock"
    bl_options = {"REGISTER", "UNDO"}
    doing = "Making stock"
    cancelled = "No stock was made"

    @classmethod
    def poll(cls, context):
        return operator_parts.object_mode(cls, context) and not operator_parts.busy(cls, context)

    def invoke(self, context, event):
        """Only a mesh takes long; all other sources are immediate."""
        long = self.source == "OBJECT" and not _is_its_volume(context, object_surfaces.source_object(context))
        return _viewed(context, super().invoke(context, event) if long else self.execute(context))

    def modal(self, context, event):
        return _viewed(context, super().modal(context, event))

    def begin(self, context):
        live_registry.end_all()
        make = {"BLOCK": self._block, "OBJECT": self._from_object, "RECORDING": self._from_recording}[self.source]
        self._new, job = make(context)
        return job

    def lost(self, context):
        source = self._from()
        if source is None or source.name not in context.view_layer.objects:
            return f"No stock was made: {self._new.source[0]} was removed meanwhile"
        return ""

    def finish(self, context, job):
        new, source, volume = self._new, self._from(), job.result
        if isinstance(volume, tuple):
            volume, report = volume
            self._check(source, volume, report)
        unseen = estimate.too_thin(new.source[0] if new.source else "the stock", volume.pitch)
        ob = sculpts.new_object(context, new.name, Content(volume), new.frame, unseen=unseen)
        if source is not None:
            if sculpts.is_sculpt(source):
                sculpts.take_looks(ob, source)
            source.hide_set(True)
        sculpt_work.tell_made(self, ob)
        across = round(max(np.subtract(ob.data.riffler.upper, ob.data.riffler.lower)) / volume.pitch)
        if across < fitting.FEW_RAYS:
            rays = units.counted(across, "ray")
            few = f"{ob.name} has {rays} along its longest side, so no details: undo, and use Fit Pitch"
            self.report({"WARNING"}, few)
        return {"FINISHED"}

    def _from(self):
        """The object that the stock is made from, if there is one and it still exists."""
        return bpy.data.objects.get(self._new.source) if self._new.source else None

    def _check(self, source, volume, report):
        if volume.volume <= 0:
            why = report.lost_note or "it has no volume at this pitch: close it, or use a finer one"
            raise ValueError(f"{source.name}: {why}")
        if report.open_edges:
            count = units.counted(report.open_edges, "open edge")
            self.report({"WARNING"}, f"{source.name} is not closed: {count} closed approximately")
        for note in notes_on(report):
            self.report({"WARNING"}, f"{source.name}: {note}")

    # ------------------------------------------------------------------ (what it becomes, the job that makes it)
    def _block(self, context):
        size = np.array([units.clean(s) for s in self.size])
        lower = {"CORNER": 0 * size, "TOP": -size * (0.5, 0.5, 1.0), "CENTRE": -0.5 * size}[self.origin]
        pitch = units.clean(self.pitch)
        estimate.check_block(size, pitch)
        volume = riffler.Volume.block(lower, lower + size, pitch, self.directions)
        return _New("Stock", _at_cursor(context)), DoneJob(volume)

    def _from_object(self, context):
        source = object_surfaces.source_object(context)
        if source is None:
            raise ValueError(refusals.instance(context.object) or NO_SOURCE)
        if unfit := refusals.disabled(source, context.view_layer) or refusals.flat(source):
            raise ValueError(unfit)
        # Scale and shear become part of the shape, so that a millimetre of the sculpt is one along every axis.
        place, turn, _ = source.matrix_world.decompose()
        frame = Matrix.Translation(place) @ turn.to_matrix().to_4x4()
        return (self._from_sculpt if _is_its_volume(context, source) else self._from_mesh)(context, source, frame)

    def _from_mesh(self, context, source, frame):
        to_stock = meshes.matrix(frame.inverted() @ source.matrix_world)
        to_stock[:3] *= scene_units.mm_per_unit(context.scene)
        mesh = object_surfaces.surface(source, context.evaluated_depsgraph_get(), to_stock)
        pitch, size = units.clean(self.pitch), mesh.bounds[1] - mesh.bounds[0]
        if not size.all():
            raise ValueError(f"{source.name} is flat, so it has no volume: give it thickness, by the modifier Solidify")
        estimate.check_surface(source.name, size, mesh.area, pitch)
        if self.rounded:
            mesh = riffler.Mesh(*round_facets.rounded(mesh.vertices, mesh.triangles, FACET * pitch))
        new = _New(f"{source.name} Stock", frame, sculpts.key_of(source))
        return new, TaskJob(riffler.submit(riffler.Volume.from_mesh_with_report, mesh, pitch, self.directions))

    def _from_sculpt(self, context, source, frame):
        """Uses its volume itself: nothing is lost if the pitch stays the same."""
        volume = sculpt_store.content(source.data).volume.resample(units.clean(self.pitch), self.directions)
        return _New(f"{source.name} Copy", frame, sculpts.key_of(source)), DoneJob(volume)

    def _from_recording(self, context):
        if not self.recording:
            raise ValueError("choose a recording (.rjournal)")
        volume = cut_paths.stock_of_recording(bpy.path.abspath(self.recording))
        return _New("Stock", _at_cursor(context)), DoneJob(volume)

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "source")
        if self.source == "RECORDING":
            layout.prop(self, "recording")
            return
        if self.source == "BLOCK":
            layout.prop(self, "size", text="Size (mm)")
            layout.prop(self, "origin")
        if self.source == "OBJECT":
            layout.prop(self, "rounded")
        layout.prop(self, "pitch", text="Pitch (mm)")
        layout.prop(self, "directions")


def _is_its_volume(context, ob):
    """Whether a sculpt's display in the world is its volume: of the same size, not mirrored, neither modified nor
    edited."""
    if not sculpts.is_sculpt(ob) or refusals.has_modifiers(ob):
        return False
    if live_registry.of(ob) is None and sculpts.changed(ob.data):
        return False
    shown, scene = sculpts.shown_mm_per_unit(ob.data), scene_units.mm_per_unit(context.scene)
    return not refusals.scaled(ob) and np.isclose(shown, scene, rtol=1e-6)


def _at_cursor(context):
    return Matrix.Translation(context.scene.cursor.location)


def _viewed(context, done):
    """Moves the new sculpt, if one was made, into the view that the operator was called in."""
    if done == {"FINISHED"} and context.area and context.area.type == "VIEW_3D":
        region = next((r for r in context.area.regions if r.type == "WINDOW"), None)
        if region:
            with context.temp_override(region=region):
                bpy.ops.view3d.view_selected()
    return done


class RIFFLER_OT_fit_pitch(bpy.types.Operator):
    """Set a pitch that suits the size: about 400 rays along the longest side"""

    bl_idname = "riffler.fit_pitch"
    bl_label = "Fit Pitch"
    bl_options = {"INTERNAL", "UNDO"}

    def execute(self, context):
        stock = context.scene.riffler.stock
        source = object_surfaces.source_object(context)
        if stock.source == "OBJECT" and source is None:
            return operator_parts.fail(self, ValueError("select the object to make material of"))
        if stock.source == "RECORDING":
            return operator_parts.fail(self, ValueError("a recording has the pitch of the stock that it was made on"))
        size = stock.size if stock.source == "BLOCK" else source_size(source, context.scene)
        try:
            stock.pitch = fitting.pitch(fitting.longest(size), 400)
        except ValueError as error:
            return operator_parts.fail(self, error)
        return {"FINISHED"}


class RIFFLER_OT_rebuild(bpy.types.Operator):
    """Rebuild the mesh from the stored volume, in the scene's units; edits of the mesh are lost"""

    bl_idname = "riffler.rebuild"
    bl_label = "Rebuild Mesh"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return sculpt_work.sculpt_poll(cls, context)

    def execute(self, context):
        try:
            live_registry.end_all()
            sculpts.refill(sculpts.active(context).data, scene_units.mm_per_unit(context.scene))
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        return {"FINISHED"}


CLASSES = (RIFFLER_OT_new_stock, RIFFLER_OT_fit_pitch, RIFFLER_OT_rebuild)
