"""Makes a plan of recorded strokes, those of a sculpt or of a recording, on a thread of its own."""

import math

import bpy
import numpy as np
import riffler

from ...blender import object_surfaces, operator_parts, scene_units
from ...blender.fields import angle, length
from ...blender.long_work import LongWork
from ...common import problems, units
from ...common.job import TaskJob, ThreadTask
from ...sculpt import live_registry, sculpts
from ...stock import cut_program
from .. import path_curves, plan_store
from ..pure import stroke_plans


class RIFFLER_OT_plan_from_strokes(LongWork, bpy.types.Operator):
    """Make a plan of the active sculpt's strokes: a path for each, with keys where the tool's axis bends. Strokes of
    several tools make several plans
    """

    bl_idname = "riffler.plan_from_strokes"
    bl_label = "Plan from Strokes"
    bl_options = {"REGISTER", "UNDO"}
    doing = "Planning strokes"
    cancelled = "Planning cancelled: nothing has changed"

    tolerance: length("Tolerance", 0.01, "Largest distance between a stroke and its path, in mm", 1e-4, 10.0)
    angle: angle(
        "Angle",
        riffler.plan.recorded.ANGLE,
        "Largest angle between the tool's axis in a stroke and on its path",
        0.001,
        riffler.plan.recorded.LARGEST,
    )
    recording: bpy.props.StringProperty(
        name="Recording",
        subtype="FILE_PATH",
        options={"SKIP_SAVE"},
        description="Recording (.rjournal) whose strokes are planned; empty: those of the active sculpt. They lie in "
        "the frame of the active sculpt, otherwise in that of the scene",
    )

    @classmethod
    def poll(cls, context):
        return operator_parts.object_mode(cls, context) and not operator_parts.busy(cls, context)

    def begin(self, context):
        live_registry.end_all()
        ob = sculpts.active(context)
        to_world = np.eye(4) if ob is None else sculpts.rigid_to_world(context, ob)
        journal, self._name, self._notes = self._strokes(ob)
        part = self._part_object(context, ob)
        self._part, mesh = part.name, object_surfaces.in_world(context, part)
        self._mm = scene_units.mm_per_unit(context.scene)
        bounds = {"tolerance": units.clean(self.tolerance), "angle": units.clean(self.angle)}
        made = stroke_plans.Making(journal, to_world, mesh, part.name, self._name, bounds)
        return TaskJob(ThreadTask(made.run))

    def _strokes(self, ob):
        """(journal, name, notes). ValueError with the next step if there are none."""
        if self.recording:
            path = bpy.path.abspath(self.recording)
            problems.check_source(path)
            return riffler.Journal.load(path), bpy.path.basename(path), []
        if ob is None:
            raise ValueError("Select a sculpt whose strokes are to be planned, or choose a recording")
        content = live_registry.content(ob)
        cuts = cut_program.removing(ob.name, content)
        return stroke_plans.journal_of(cuts), ob.name, cut_program.not_in_cuts(content)

    def _part_object(self, context, ob):
        """The scene's part; without one the sculpt itself, whose surface the strokes touch."""
        part = context.scene.riffler.plan.part
        if (why := object_surfaces.unfit(part, context.scene)) and ob is None:
            raise ValueError(why)
        return ob if why else part

    def lost(self, context):
        if context.scene.objects.get(self._part) is None:
            return f"Planning cancelled: {self._part} was removed or renamed meanwhile"
        return ""

    def finish(self, context, job):
        notes, told = list(self._notes), []
        for found in job.result:
            ob = plan_store.new(context, found.plan)
            ob.riffler.plan.part = context.scene.objects[self._part]
            path_curves.show(ob, found.plan, self._mm)
            keys = sum(len(path.keys) for path in found.plan.paths)
            within = f"{found.error:.2g} mm, {math.degrees(found.turn):.2g}°"
            told.append(
                f"{ob.name}: {units.counted(len(found.paths), 'path')}, {units.counted(keys, 'key')}, within {within}"
            )
            notes += [note[:1].upper() + note[1:] for note in found.notes]
        operator_parts.tell_all(self, ". ".join(told), list(dict.fromkeys(notes)))
        return {"FINISHED"}


CLASSES = (RIFFLER_OT_plan_from_strokes,)
