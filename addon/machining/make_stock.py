"""Makes sculpts: a stock around the part, and the stock that the job leaves."""

import bpy
import numpy as np
import riffler
from mathutils import Matrix

from ..blender import object_surfaces, operator_parts, scene_units
from ..common import fitting, units
from ..common.contents import Content
from ..sculpt import live_registry, sculpt_work, sculpts
from ..stock.pure import estimate
from . import inputs, job_store, properties

RAYS = 400  # number of rays along the longest side, if no pitch is given


def _frame(scene):
    """Rotation (3, 3) from the stock's frame to the scene: its z is the tool's axis."""
    ob = scene.riffler.machining.upright
    if ob is None:
        return np.eye(3)
    inputs.world_axis(scene)  # raises ValueError if the object has no axis
    return np.array(ob.matrix_world.to_quaternion().to_matrix())


class RIFFLER_OT_machining_stock(properties.StockShape, bpy.types.Operator):
    """Make a stock around the part, with an allowance, for the job"""

    bl_idname = "riffler.machining_stock"
    bl_label = "Make Stock"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        if why := object_surfaces.unfit(context.scene.riffler.plan.part, context.scene):
            return operator_parts.deny(cls, why)
        return operator_parts.object_mode(cls, context) and not operator_parts.busy(cls, context)

    def execute(self, context):
        scene = context.scene
        try:
            live_registry.end_all()
            part = object_surfaces.in_world(context, scene.riffler.plan.part)
            turn = _frame(scene)
            volume = self._volume(np.asarray(part.vertices) @ turn)
            frame = Matrix(turn.tolist()).to_4x4()
            ob = sculpts.new_object(context, f"{scene.riffler.plan.part.name} Stock", Content(volume), frame)
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        ob.display_type = "BOUNDS"  # so that the part inside is visible
        ob.display_bounds_type = self.shape
        scene.riffler.machining.stock = ob
        sculpt_work.tell_made(self, ob)
        return {"FINISHED"}

    def _volume(self, points):
        sides, top, bottom = (scene_units.clean(getattr(self, key)) for key in ("sides", "top", "bottom"))
        low, high = points.min(axis=0), points.max(axis=0)
        grown_low, grown_high = low - np.array((sides, sides, bottom)), high + np.array((sides, sides, top))
        if self.shape == "CYLINDER":
            middle = 0.5 * (low + high)
            radius = np.linalg.norm(points[:, :2] - middle[:2], axis=1).max() + sides
            grown_low[:2], grown_high[:2] = middle[:2] - radius, middle[:2] + radius
        size = grown_high - grown_low
        if not (size > 0).all():
            raise ValueError("the stock has no height: give it material above or below the part")
        pitch = scene_units.clean(self.pitch) or fitting.pitch(fitting.longest(size), RAYS)
        estimate.check_block(size, pitch)
        if self.shape == "BOX":
            return riffler.Volume.block(grown_low, grown_high, pitch, "xyz")
        centre = 0.5 * (grown_low + grown_high)
        return riffler.Volume.cylinder(centre, radius, size[2], pitch, "xyz")

    def draw(self, context):
        operator_parts.draw_fields(self, tuple(properties.StockShape.__annotations__))


class RIFFLER_OT_machining_left(bpy.types.Operator):
    """Add the stock as the calculated operations leave it, as a sculpt"""

    bl_idname = "riffler.machining_left"
    bl_label = "Remaining Stock"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        if not job_store.identity(context.scene):
            return operator_parts.deny(cls, "Nothing is calculated: use Calculate first")
        return operator_parts.object_mode(cls, context) and not operator_parts.busy(cls, context)

    def execute(self, context):
        scene = context.scene
        try:
            given, known = inputs.take(context), job_store.operations(scene)
            setup, count = given.setup(), 0
            for key in given.keys:
                op = known.get(key)
                if op is None:
                    break
                count += 1
                setup.apply(op)
            if not count:
                raise ValueError("the first operation has changed since it was calculated: use Calculate again")
            volume = setup.stock
            ob = sculpts.new_object(
                context, f"{given.names[0]} after {count}", Content(volume, shaped=True), Matrix(_scene(context, given))
            )
        except operator_parts.ERRORS as error:
            return operator_parts.fail(self, error)
        done = f"{ob.name}: {units.counted(count, 'operation')}, {units.format_volume(volume.volume)} left"
        notes = [] if count == len(given.keys) else ["The operations after them have changed: use Calculate"]
        operator_parts.tell_all(self, done, notes)
        return {"FINISHED"}


def _scene(context, given):
    """Rows of a (4, 4) matrix: from the stock's frame to the scene, with the offset in the scene's units."""
    matrix = given.to_world.copy()
    matrix[:3, 3] /= scene_units.mm_per_unit(context.scene)
    return matrix.tolist()


CLASSES = (RIFFLER_OT_machining_stock, RIFFLER_OT_machining_left)
