"""Calculates changed operations on a separate thread, and checks the program of all operations."""

import bpy
import riffler

from ..blender import operator_parts
from ..blender.long_work import LongWork
from ..common import units
from ..common.job import TaskJob, ThreadTask
from . import inputs, job_store
from .pure import job_run


class RIFFLER_OT_machining_calculate(LongWork, bpy.types.Operator):
    """Calculate the operations that have changed and those after them, and simulate the whole program"""

    bl_idname = "riffler.machining_calculate"
    bl_label = "Calculate"
    bl_options = {"REGISTER", "UNDO"}
    doing = "Calculating operations"
    cancelled = "Calculation cancelled: nothing has changed"

    @classmethod
    def poll(cls, context):
        if not operator_parts.object_mode(cls, context):
            return False
        if why := inputs.unfit(context.scene):
            return operator_parts.deny(cls, why)
        return not operator_parts.busy(cls, context)

    def begin(self, context):
        given = inputs.take(context)
        for one in given.wanted:
            try:
                riffler.Tool.from_dict(dict(one.tool))
            except ValueError as error:
                raise ValueError(f"{one.name}: {error}") from None
        setup, known = given.setup(), self._known(context.scene)
        self._names, self._keys, self._wanted = given.names, given.keys, given.wanted
        self._scene, self._glances = context.scene.name, inputs.glances(context.scene)
        self._new = sum(key not in known for key in given.keys)
        return TaskJob(
            ThreadTask(lambda progress: job_run.calculate(setup, given.wanted, given.keys, known, progress)),
            units.counted(self._new, "operation"),
        )

    def _known(self, scene):
        """The stored operations by key; none if the data is damaged, so that all operations are calculated again."""
        try:
            return job_store.operations(scene)
        except ValueError:
            return {}

    def lost(self, context):
        for name in self._names:
            if context.scene.objects.get(name) is None:
                return f"Calculation cancelled: {name} was removed or renamed meanwhile"
        if self._scene != context.scene.name or self._glances != inputs.glances(context.scene):
            return "Calculation cancelled: the job was changed meanwhile"
        return ""

    def finish(self, context, job):
        found, scene = job.result, context.scene
        settings = scene.riffler.machining
        job_store.write(scene, found.operations)
        job_store.keep_program(self._keys[-1], found.program)
        settings.problem = found.problem
        for k, row in enumerate(settings.switched_on()):
            self._fill(row, k, found)
        for k, glance in self._glances.items():
            settings.rows[k].glance = glance
        done = [op for _, op in found.operations]
        seconds = sum(op.report.time_s for op in done)
        said = f"{units.counted(len(done), 'operation')}, {clock(seconds)}"
        told = [(one.name, job_run.said(op)) for one, op in zip(self._wanted, done, strict=False)]
        notes = [f"{name}: {text}" for name, text in told if text]
        if found.problem:
            self.report({"ERROR"}, operator_parts.as_sentence(found.problem))
        operator_parts.tell_all(self, said, notes)
        return {"FINISHED"}

    def _fill(self, row, k, found):
        """Writes the result of operation number k to its row."""
        row.key, row.said, row.seconds, row.cut = self._keys[k], "", 0.0, 0.0
        if k >= len(found.operations):
            first = k == len(found.operations)
            row.state = "FAILED" if first else "OPEN"
            row.said = found.problem.removeprefix(f"{row.name}: ") if first else ""
            return
        op = found.operations[k][1]
        row.state = "DONE" if len(op) else "EMPTY"
        row.said, row.seconds, row.cut = job_run.said(op), op.report.time_s, op.report.cut_mm
        if found.program is None and found.problem.startswith(f"{row.name},"):  # such as “Rough, row 12, at (…)”
            row.state, row.said = "FAILED", found.problem


def clock(seconds):
    """A time as text: "1:02:03 h" or "2:03 min"."""
    whole = round(seconds)
    hours, minutes = divmod(whole // 60, 60)
    return f"{hours}:{minutes:02}:{whole % 60:02} h" if hours else f"{minutes}:{whole % 60:02} min"


CLASSES = (RIFFLER_OT_machining_calculate,)
