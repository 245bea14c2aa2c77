"""The simulation of a program: the stock at the row of the scene's current frame, shown in chunks like a live sculpt.
It carves a copy of the sculpt, which is hidden meanwhile.

With a window a timer carves for a few milliseconds at a time, so scrubbing stays responsive and the stock catches up.
Without a window timers never run, so the stock is carved at once. There is no modal operator. Undo ends a simulation,
because it may restore any part of the display; saving or loading a file ends it too.
"""

import time

import bpy
import riffler

from ..blender import handlers, operator_parts
from ..common import tool_solid, units
from ..common.problems import said
from ..machining import inputs
from ..plan import plan_states, plan_store, replan, timeline
from ..sculpt import chunks, sculpts, surfaces, undo_states
from . import programs, properties
from .pure.program_prefix import ProgramPrefix

BUDGET, PAUSE = 0.02, 0.01  # s of carving per slice, and between two slices
SHOWN = 0.15  # s between two redraws of a stock that is still catching up
_now = None


class Simulation:
    """Simulates the program of a programs.Setup. `prefix.volume` is the displayed stock."""

    def __init__(self, context, setup):
        ob = bpy.data.objects[setup.sculpt]
        self.name, self.scene, self.program_timeline, self.sculpt = (
            setup.name,
            context.scene.name,
            setup.program_timeline,
            ob.name,
        )
        self._plan, self._identity = setup.plan, _identity(setup.plan)
        self.prefix = ProgramPrefix(setup.stock, setup.runs)
        volume = self.prefix.volume
        self._mesher = riffler.Mesher(volume, tolerance=surfaces.within(ob.data.riffler.detail, volume.pitch))
        self.mark = sculpts.new_mark(ob)
        self.chunks = chunks.Chunks(context, ob, self._mesher.shape, sculpts.shown_mm_per_unit(ob.data))
        try:
            self.chunks.update(self._mesher, self._mesher.patches())
        except BaseException:
            chunks.sweep(self.mark, ob.name)
            raise
        self._own_tool = not setup.plan or timeline.pair(bpy.data.objects[setup.plan]) is None
        self._tool, self._pictured = None, 0.0

    @property
    def object(self):
        """The sculpt, as long as it and its display exist."""
        return sculpts.marked(self.mark, self.sculpt) if self.chunks.there else None

    @property
    def outdated(self):
        """True if the program belongs to a plan that has changed."""
        return _identity(self._plan) != self._identity

    @property
    def scene_frame(self):
        return bpy.data.scenes[self.scene].frame_current_final

    def go_on(self, budget):
        """Carves towards the row of the current frame; True when the stock has reached it and is displayed."""
        there = self.prefix.step(self.program_timeline.row_at(self.scene_frame), budget)
        if there or time.monotonic() - self._pictured > SHOWN:
            self._show()
        return there

    def _show(self):
        self._pictured = time.monotonic()
        self.chunks.update(self._mesher, self._mesher.update(self.prefix.volume))
        self.chunks.place(self.object.matrix_world)
        if self._own_tool:
            tool, pose = self.prefix.pose(self.prefix.row)
            if tool is not self._tool:
                self._tool = tool
                self.chunks.show_tool(tool_solid.solid(tool.outline()))
            self.chunks.place_tool(pose)


def _identity(plan):
    """The identity of the plan object with that name."""
    return plan_store.identity(bpy.data.objects.get(plan))


def active():
    """The displayed Simulation, or None."""
    return _now


def begin(context, setup):
    """Shows `setup` at the current frame, in place of an earlier simulation. None if it stopped at once, with a
    message."""
    global _now
    end()
    _now = Simulation(context, setup)
    context.window_manager.riffler.simulating = setup.name
    _follow()
    return _now


def end():
    """Shows the sculpt itself again."""
    global _now
    was, _now = _now, None
    handlers.stop(_tick)
    if was is not None:
        bpy.context.window_manager.riffler.simulating = ""
        chunks.sweep(was.mark, was.sculpt)


def drop_outdated():
    """Ends the simulation if its plan has changed; True if it did."""
    if _now is None or not _now.outdated:
        return False
    name = _now.name
    end()
    undo_states.tell(f"{name}: simulation ended: the plan has changed")
    return True


def _follow():
    if bpy.app.background:
        _lot(float("inf"))
    elif not bpy.app.timers.is_registered(_tick):
        bpy.app.timers.register(_tick, first_interval=0.0)


def _tick():
    """Timer function. Does nothing during a render, which reads the data that a simulation changes."""
    if _now is not None and bpy.app.is_job_running("RENDER"):
        return SHOWN
    return None if _now is None or _lot(BUDGET) else PAUSE


def _lot(budget):
    """One slice of work; True if nothing is left to do."""
    if _now.object is None or _now.scene not in bpy.data.scenes:
        end()
        return True
    if drop_outdated():
        return True
    try:
        return _now.go_on(budget)
    except (ValueError, OSError, RuntimeError, MemoryError) as error:
        name = _now.name
        end()
        undo_states.tell(f"{name}: simulation stopped: {said(error)}")
        return True


@bpy.app.handlers.persistent
def _on_frame(scene, depsgraph=None):
    """Follows the frame, except in a render, which has a copy of the scene and shows the sculpt itself."""
    if _now is not None and scene.name == _now.scene and (depsgraph is None or depsgraph.mode == "VIEWPORT"):
        _follow()


@bpy.app.handlers.persistent
def _end(*_):
    end()


@bpy.app.handlers.persistent
def _before_render(*_):
    if _now is not None and _now.object is not None:
        try:
            chunks.weigh(_now.object)
        except ValueError as error:
            undo_states.tell(str(error))


_HANDLERS = {
    "frame_change_post": _on_frame,
    "save_pre": _end,
    "undo_post": _end,
    "redo_post": _end,
    "render_init": _before_render,
    "load_pre": _end,
}


# ---------------------------------------------------------------------- operators
def program_poll(cls, context):
    """True if a program can run on a stock."""
    if not operator_parts.object_mode(cls, context):
        return False
    if programs.stock_object(context) is None and inputs.stock_of(context.scene) is None:
        return operator_parts.deny(cls, programs.no_stock(context))
    return True


class RIFFLER_OT_simulate(properties.ProgramSettings, properties.GivenOptions, bpy.types.Operator):
    """Show the stock as the program has cut it at the current frame; Esc in the view ends the simulation"""

    bl_idname = "riffler.simulate"
    bl_label = "Simulate"
    bl_options = {"REGISTER"}  # the display is not an undo step

    @classmethod
    def poll(cls, context):
        return program_poll(cls, context) and not operator_parts.busy(cls, context, simulation=False)

    def execute(self, context):
        try:
            end()
            replan.flush()  # so that the program has the current keys
            setup = programs.take(context, self)
            now = begin(context, setup)
            if now is None:
                raise ValueError(context.window_manager.riffler.notice)
        except operator_parts.ERRORS as error:
            end()
            return operator_parts.fail(self, error)
        first, last = now.program_timeline.first, now.program_timeline.last
        timeline.show_range(context.scene, first, last)
        count = units.counted(len(setup.program.poses), "row")
        done = f"{setup.name}: {count} at frames {first} to {last}. Esc in the view ends it"
        operator_parts.tell_all(self, done, setup.notes)
        return {"FINISHED"}

    def invoke(self, context, event):
        return self.execute(context)


class RIFFLER_OT_simulate_stop(bpy.types.Operator):
    """End the simulation and show the uncut stock again"""

    bl_idname = "riffler.simulate_stop"
    bl_label = "End Simulation"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context):
        if active() is None:
            return operator_parts.deny(cls, "Nothing is being simulated")
        return True

    def execute(self, context):
        end()
        return {"FINISHED"}


CLASSES = (RIFFLER_OT_simulate, RIFFLER_OT_simulate_stop)


def attach():
    handlers.listen(_HANDLERS)
    plan_states.followers.append(drop_outdated)


def detach():
    if drop_outdated in plan_states.followers:
        plan_states.followers.remove(drop_outdated)
    handlers.ignore(_HANDLERS)
    end()
