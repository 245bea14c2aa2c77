"""The shell of long work, from a script: in one call, with the errors of the work, and as other operators see it."""

import threading

import bpy
import riffler

from support import common, operator_task, programs


def progress():
    return bpy.context.window_manager.riffler


def test_no_operator_overrides_functions_of_the_shell_by_accident():
    """Without a window the shell's functions are not called, so that no other test would detect it."""
    shell = common.part("blender.long_work").LongWork
    own = {name for name, value in vars(shell).items() if name.startswith("_") and callable(value)} - set(vars(object))
    assert {"_tell", "_end"} <= own
    for module in common.part("registration").modules():
        for cls in module.CLASSES:
            if issubclass(cls, shell):
                taken = [name for name in own if getattr(cls, name) is not getattr(shell, name)]
                assert not taken, (cls.__name__, taken)


def test_a_script_gets_the_finished_work():
    with operator_task.Stage() as stage:
        stage.task = operator_task.Task(looks=30)
        assert bpy.ops.riffler.test_work() == {"FINISHED"}
        assert stage.log == ["made"] and stage.task.looks < 0 and bpy.context.scene["made"] == "made"
        assert progress().running == ""


def test_finished_work_is_one_undo_step():
    with operator_task.Stage() as stage:
        common.push("before")
        stage.task = operator_task.Task(looks=1)
        bpy.ops.riffler.test_work("EXEC_DEFAULT", True)
        bpy.ops.ed.undo()
        assert "made" not in bpy.context.scene
        bpy.ops.ed.redo()
        assert bpy.context.scene["made"] == "made"


def test_errors_of_the_beginning_and_of_the_task_are_reported():
    with operator_task.Stage() as stage:
        for error in (ValueError("tool: choose one"), OSError("tools.json: not readable"), MemoryError("too fine")):
            stage.refusal = error
            common.refused(bpy.ops.riffler.test_work, str(error))
        stage.refusal, stage.task = None, operator_task.Task(looks=1, outcome=RuntimeError("no path was found"))
        common.refused(bpy.ops.riffler.test_work, "no path was found")
        assert stage.log == [] and "made" not in bpy.context.scene


def test_waiting_work_names_what_it_waits_for():
    common.stock()
    curve = common.curve("Line", [(10, 15, 20), (30, 15, 20)]).name
    with operator_task.Stage():
        progress().running = "Finding pencil paths"
        for call in (
            bpy.ops.riffler.test_work,
            bpy.ops.riffler.new_stock,
            lambda: bpy.ops.riffler.cut_curve(curve=curve),
        ):
            common.refused(call, "Finding pencil paths: Esc cancels")
        progress().running = ""
        assert bpy.ops.riffler.cut_curve.poll() and bpy.ops.riffler.test_work.poll()


@common.core_bound
def test_part_and_fixtures_are_built_while_the_window_stays_responsive():
    """Nothing waits for surroundings that are being built: they are polled until they are ready."""
    programs.plan()
    surroundings = common.part("plan.obstacles")
    made, plain = [], surroundings.Making

    class Slow(plain):
        left = 3

        def done(self):
            self.left -= 1
            return self.left < 0 and super().done()

        def result(self):
            assert self.left < 0, "waited for"
            made.append(self)
            return super().result()

    surroundings.Making = Slow
    try:
        for call in (
            bpy.ops.riffler.plan_resolve,
            bpy.ops.riffler.plan_check,
            lambda: bpy.ops.riffler.plan_least_tilt(paths="ALL"),
            lambda: bpy.ops.riffler.plan_point_key(path=1, point=10),
        ):
            surroundings._kept.clear()
            assert call() == {"FINISHED"}
    finally:
        surroundings.Making = plain
    assert len(made) == 4


@common.core_bound
def test_a_verification_is_made_on_a_thread():
    programs.resolved()
    programs.stock()
    threads, plain = [], riffler.Verification

    class Noted(riffler.Verification):
        def __init__(self, *given, **more):
            threads.append(threading.current_thread())
            super().__init__(*given, **more)

    riffler.Verification = Noted
    try:
        bpy.ops.riffler.verify(source="PLAN")
        bpy.ops.riffler.verify(source="PLAN")  # which is ready
    finally:
        riffler.Verification = plain
    assert len(threads) == 1 and threads[0] is not threading.main_thread()
