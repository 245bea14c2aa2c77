"""Operations on a sculpt as a whole: another pitch or box, cropping by a plane, splitting, applying edits."""

from dataclasses import replace

import bpy
import numpy as np
import riffler
from bpy.props import BoolProperty, EnumProperty, FloatProperty, FloatVectorProperty, StringProperty
from riffler.mesh_notes import notes_on

from ..blender import scene_units
from ..common import units
from ..common.contents import Content
from ..common.job import TaskJob, ThreadTask
from ..sculpt import mask_display, sculpts
from ..sculpt.sculpt_work import SculptWork
from ..translations import local
from . import object_volumes, properties
from .pure import estimate

DIRECTIONS = (("KEEP", "Unchanged", "The sculpt's current directions"), *properties.DIRECTIONS)


class RIFFLER_OT_resample(SculptWork, bpy.types.Operator):
    """Make the clay finer or coarser: the same shape, with another distance between rays"""

    bl_idname = "riffler.resample"
    bl_label = "Change Pitch"
    doing = "Changing the pitch"
    cancelled = "Pitch not changed: the sculpt is unchanged"

    pitch: FloatProperty(
        name="Pitch (mm)", default=0.25, min=1e-4, max=1e5, precision=3, description="New distance between rays"
    )
    directions: EnumProperty(name="Rays", items=DIRECTIONS, default="KEEP", description="New directions of the rays")

    def begin(self, context):
        ob, self._before = self.take(context)
        volume, pitch = self._before.volume, scene_units.clean(self.pitch)
        wanted = volume.directions if self.directions == "KEEP" else self.directions
        area = estimate.shown_area(sculpts.all_triangles(ob.data), volume.pitch)
        estimate.check_surface(ob.name, volume.upper - volume.lower, area, pitch)
        return TaskJob(riffler.submit(riffler.Volume.resample, volume, pitch, wanted))

    def finish(self, context, job):
        before = self._before
        content = replace(before, volume=job.result, mask=mask_display.on_grid_of(job.result, before.mask))
        self.keep(content, unseen=estimate.too_thin(self._object, job.result.pitch))
        context.scene.riffler.clay.pitch = job.result.pitch  # the panel's next default
        off = job.result.volume - before.volume.volume
        self.report({"INFO"}, f"{units.counted(job.result.rays, 'ray')}; material {_signed(off)}")
        return {"FINISHED"}


class RIFFLER_OT_room(SculptWork, bpy.types.Operator):
    """Grow the sculpt's box, so that material can be added outside it; the sculpt stays in place"""

    bl_idname = "riffler.room"
    bl_label = "Grow Box"
    doing = "Growing the box"
    cancelled = "Box not grown: the sculpt is unchanged"

    room: FloatProperty(
        name="Margin (mm)",
        default=5.0,
        min=1e-3,
        precision=2,
        description="Width added on every side, rounded to whole pitches",
    )

    def begin(self, context):
        _, self._before = self.take(context)
        volume, room = self._before.volume, scene_units.clean(self.room)
        return TaskJob(riffler.submit(riffler.Volume.grow, volume, volume.lower - room, volume.upper + room))

    def finish(self, context, job):
        before, volume = self._before, job.result
        self.keep(replace(before, volume=volume, mask=mask_display.on_grid_of(volume, before.mask)))
        counted = volume.volume - before.volume.volume
        note = ""
        if abs(counted) > 1e-9 * before.volume.volume:
            note = f"; {_signed(counted)} are counted, since the rays at the old border now stand for whole cells"
        self.report({"INFO"}, f"The box is {units.format_size(volume.upper - volume.lower)}{note}")
        return {"FINISHED"}


def _signed(volume):
    return f"{'+' if volume >= 0 else '−'}{units.format_volume(abs(volume))}"


class RIFFLER_OT_crop(SculptWork, bpy.types.Operator):
    """Cut off one side of the sculpt, at the plane of another object or at a point and a normal"""

    bl_idname = "riffler.crop"
    bl_label = "Crop by Plane"
    doing = "Cropping"
    cancelled = "Not cropped: the sculpt is unchanged"

    plane: StringProperty(name="Plane", description="Object whose local plane z = 0 cuts; empty: the values below")
    point: FloatVectorProperty(
        name="Point", subtype="TRANSLATION", description="Point on the plane, in world space and Blender units"
    )
    normal: FloatVectorProperty(
        name="Normal", subtype="DIRECTION", description="Normal of the plane, towards the removed side; 0: unused"
    )
    flip: BoolProperty(name="Other Side", description="Remove what lies behind the plane")

    def begin(self, context):
        ob, self._before = self.take(context)
        point, normal = self._plane(context, ob)
        normal = -normal if self.flip else normal
        volume = self._before.volume.copy()
        return TaskJob(ThreadTask(lambda progress: volume.clip(point, normal, progress=progress)))

    def finish(self, context, job):
        before, volume = self._before, job.result
        if volume.volume <= 0:
            raise ValueError("nothing would be left: choose the other side, or move the plane")
        self.keep(replace(before, volume=volume, shaped=True))
        taken = before.volume.volume - volume.volume
        self.report({"INFO"} if taken > 0 else {"WARNING"}, f"Removed {units.format_volume(taken)}")
        return {"FINISHED"}

    def _plane(self, context, ob):
        if not self.plane and any(self.normal):
            m = sculpts.from_world(ob)
            normal = np.linalg.inv(m[:3, :3]).T @ np.array(self.normal)
            return (m @ (*self.point, 1.0))[:3], normal
        return object_volumes.plane(
            ob, object_volumes.chosen(context, self.plane, {"MESH", "EMPTY"}, "the plane, a mesh or an empty,")
        )


class RIFFLER_OT_split(SculptWork, bpy.types.Operator):
    """Split the sculpt into its separate pieces: each becomes a sculpt of its own, the largest stays this one"""

    bl_idname = "riffler.split"
    bl_label = "Split into Parts"
    doing = "Splitting"
    cancelled = "Not split: the sculpt is unchanged"

    least: FloatProperty(
        name="Smallest (mm³)", default=0.0, min=0.0, description="Pieces smaller than this stay with the largest"
    )

    def begin(self, context):
        _, self._before = self.take(context)
        return TaskJob(riffler.submit(self._before.volume.parts, minimum=scene_units.clean(self.least)))

    def finish(self, context, job):
        first, *others = job.result or [self._before.volume]
        if not others:
            self.report({"WARNING"}, local("The sculpt is one piece"))
            return {"CANCELLED"}
        ob = bpy.data.objects[self._object]
        collections, matrix, name = ob.users_collection, ob.matrix_world.copy(), ob.name
        middle = sculpts.middle(ob.data, self._before.volume)
        mm = sculpts.shown_mm_per_unit(ob.data)
        made = []
        try:
            for piece in others:
                content = Content(piece, mask=_left_of(self._before.mask, piece))
                new = sculpts.new_object(context, f"{name} Part", content, matrix, mm, collections)
                made.append(new)
                sculpts.take_looks(new, ob)
                sculpts.keep_middle(new.data, piece, middle)
            self.keep(replace(self._before, volume=first))  # last: until then the sculpt has all pieces
        except BaseException:
            bpy.data.batch_remove([*made, *(new.data for new in made)])
            sculpts.select_only(context, ob)
            raise
        self.report({"INFO"}, units.counted(len(job.result), "part"))
        return {"FINISHED"}


def _left_of(mask, piece):
    """The mask of one piece: None if it protects nothing of it."""
    if mask is None:
        return None
    return mask if mask.copy().intersect(piece).volume > 0 else None


class RIFFLER_OT_take_edits(SculptWork, bpy.types.Operator):
    """Make the mesh, as edited by Blender's own tools and modifiers, the sculpt's material"""

    bl_idname = "riffler.take_edits"
    bl_label = "Apply Mesh Edits"
    doing = "Applying the edits"
    cancelled = "Edits not applied: the sculpt's volume is unchanged"
    from_edits = True

    def begin(self, context):
        ob, self._before = self.take(context)
        volume = self._before.volume
        surface = object_volumes.of_object(context, ob, ob)
        box = volume.grow(*surface.bounds)  # so that unmoved material stays on its rays
        rays = box.pitch, box.directions
        made = riffler.Volume.from_mesh_with_report
        return TaskJob(riffler.submit(made, surface, *rays, lower=box.lower, upper=box.upper))

    def finish(self, context, job):
        before, (volume, report) = self._before, job.result
        if volume.volume <= 0:
            raise ValueError("the edited mesh has no volume: close it, or undo the edits")
        # unmoved: material that was moved has left it, or come into it
        mask = mask_display.on_grid_of(volume, before.mask)
        middle = sculpts.middle(self.mesh, before.volume)
        self.keep(Content(volume, mask=mask, shaped=True))
        sculpts.keep_middle(self.mesh, volume, middle)
        ob = bpy.data.objects[self._object]
        for modifier in [m for m in ob.modifiers if m.show_viewport]:
            ob.modifiers.remove(modifier)
        open_edges, mended = report.open_edges, notes_on(report)
        level = {"WARNING"} if open_edges or mended else {"INFO"}
        note = f", {units.counted(open_edges, 'open edge')} closed" if open_edges else ""
        note += f"; no longer in the NC code: {units.counted(len(before.cuts), 'cut')}" if before.cuts else ""
        note += "".join(f"; {text}" for text in mended)
        self.report(level, f"{units.format_volume(volume.volume)} of material{note}")
        return {"FINISHED"}


CLASSES = (RIFFLER_OT_resample, RIFFLER_OT_room, RIFFLER_OT_crop, RIFFLER_OT_split, RIFFLER_OT_take_edits)
