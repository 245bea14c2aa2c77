"""The shell of long work, from a script: in one go, with the errors of the work, and seen by others."""

import bpy
import work

import support


def progress():
    return bpy.context.window_manager.riffler


def test_a_script_gets_the_finished_work():
    with work.Stage() as stage:
        stage.task = work.Task(looks=30)
        assert bpy.ops.riffler.test_work() == {"FINISHED"}
        assert stage.log == ["made"] and stage.task.looks < 0 and bpy.context.scene["made"] == "made"
        assert progress().running == ""


def test_finished_work_is_one_undo_step():
    with work.Stage() as stage:
        support.push("before")
        stage.task = work.Task(looks=1)
        bpy.ops.riffler.test_work("EXEC_DEFAULT", True)
        bpy.ops.ed.undo()
        assert "made" not in bpy.context.scene
        bpy.ops.ed.redo()
        assert bpy.context.scene["made"] == "made"


def test_errors_of_the_beginning_and_of_the_task_are_reported():
    with work.Stage() as stage:
        for error in (ValueError("tool: choose one"), OSError("tools.json: not readable"), MemoryError("too fine")):
            stage.refusal = error
            support.refused(bpy.ops.riffler.test_work, str(error))
        stage.refusal, stage.task = None, work.Task(looks=1, outcome=RuntimeError("no path was found"))
        support.refused(bpy.ops.riffler.test_work, "no path was found")
        assert stage.log == [] and "made" not in bpy.context.scene


def test_what_has_to_wait_says_for_what():
    support.stock()
    curve = support.curve("Line", [(10, 15, 20), (30, 15, 20)]).name
    with work.Stage():
        progress().running = "Finding pencil paths"
        for call in (
            bpy.ops.riffler.test_work,
            bpy.ops.riffler.new_stock,
            lambda: bpy.ops.riffler.cut_curve(curve=curve),
        ):
            support.refused(call, "Finding pencil paths: Esc cancels")
        progress().running = ""
        assert bpy.ops.riffler.cut_curve.poll() and bpy.ops.riffler.test_work.poll()
