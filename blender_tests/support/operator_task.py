"""An operator whose long work is defined by a test, through the add-on's own shell for native tasks."""

from contextlib import contextmanager

import bpy
import riffler

from support import common


class Task:
    """Has the interface of riffler.Future. `looks`: number of polls before it is done by itself; None: when the test
    says so."""

    def __init__(self, looks=None, outcome="made"):
        self.looks, self.outcome, self.share = looks, outcome, 0.0
        self.finished = self.cancelled = False

    def progress(self):
        return self.share

    def done(self):
        if self.looks is not None:
            self.looks -= 1
            self.finished = self.finished or self.looks < 0
        return self.finished

    def cancel(self):
        self.cancelled = True

    def result(self):
        if isinstance(self.outcome, Exception):
            raise self.outcome
        return self.outcome


@contextmanager
def meshes_taken_by(task):
    """Code that makes a volume of a mesh gets `task` instead of the native one."""
    native = riffler.submit
    made = (riffler.Volume.from_mesh, riffler.Volume.from_mesh_with_report)
    riffler.submit = lambda call, *args, **kwargs: task if call in made else native(call, *args, **kwargs)
    try:
        yield
    finally:
        riffler.submit = native


class Stage:
    """The operator riffler.test_work while it is registered: its behaviour, and a record of its calls."""

    def __init__(self):
        self.task = Task()
        self.refusal = None  # raised by begin()
        self.gone = ""  # result of lost()
        self.log = []

    def __enter__(self):
        self.operator = _operator(self)
        bpy.utils.register_class(self.operator)
        return self

    def __exit__(self, *_):
        bpy.utils.unregister_class(self.operator)


def _operator(stage):
    shared = common.part("blender.operator_parts")

    class RIFFLER_OT_test_work(common.part("blender.long_work").LongWork, bpy.types.Operator):
        """Do what a test says"""

        bl_idname = "riffler.test_work"
        bl_label = "Test Work"
        bl_options = {"REGISTER", "UNDO"}
        doing = "Testing the shell"
        cancelled = "Test cancelled"

        @classmethod
        def poll(cls, context):
            return not shared.busy(cls, context)

        def begin(self, context):
            if stage.refusal:
                raise stage.refusal
            return common.part("common.job").TaskJob(stage.task, "Looking")

        def lost(self, context):
            return stage.gone

        def show(self, context, job):
            stage.log.append("show")

        def restore(self, context):
            stage.log.append("restore")

        def finish(self, context, job):
            stage.log.append(job.result)
            context.scene["made"] = job.result
            return {"FINISHED"}

    return RIFFLER_OT_test_work
