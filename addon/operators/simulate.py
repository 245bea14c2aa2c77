"""A program is simulated: its stock follows the timeline, forwards and back."""

import bpy

from .. import properties
from ..bl import programs, replan, simulating, timeline
from ..core import units as names
from . import shared


def program_poll(cls, context):
    """True where there may be a program on a stock."""
    if not shared.object_mode(cls, context):
        return False
    if programs.stock_object(context) is None:
        return shared.deny(cls, programs.no_stock(context))
    return True


class RIFFLER_OT_simulate(properties.ProgramSettings, properties.GivenOptions, bpy.types.Operator):
    """Show the stock as the program leaves it at the current frame: play, or drag the frame. Esc in the view ends it"""

    bl_idname = "riffler.simulate"
    bl_label = "Simulate"
    bl_options = {"REGISTER"}  # what is shown is no step of undo

    @classmethod
    def poll(cls, context):
        return program_poll(cls, context) and not shared.busy(cls, context, simulation=False)

    def execute(self, context):
        try:
            simulating.end()
            replan.flush()  # the program is that of the keys as they are now
            setup = programs.take(context, self)
            now = simulating.begin(context, setup)
            if now is None:
                raise ValueError(context.window_manager.riffler.notice)
        except shared.ERRORS as error:
            simulating.end()
            return shared.fail(self, error)
        first, last = now.course.first, now.course.last
        timeline.show_range(context.scene, first, last)
        count = names.counted(len(setup.program.poses), "row")
        done = f"{setup.name}: {count} at frames {first} to {last}. Esc in the view ends it"
        shared.tell_all(self, done, setup.notes)
        return {"FINISHED"}

    def invoke(self, context, event):
        return self.execute(context)


class RIFFLER_OT_simulate_stop(bpy.types.Operator):
    """End the simulation: the stock is seen as it is"""

    bl_idname = "riffler.simulate_stop"
    bl_label = "End Simulation"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context):
        if simulating.active() is None:
            return shared.deny(cls, "Nothing is being simulated")
        return True

    def execute(self, context):
        simulating.end()
        return {"FINISHED"}


CLASSES = (RIFFLER_OT_simulate, RIFFLER_OT_simulate_stop)
