"""What operators of all features share: refusals, reports, errors."""

import bpy
from riffler.mesh_notes import notes_on

from ..common.problems import capitalised, said
from ..translations import local

NAVIGATION = {
    "MIDDLEMOUSE",
    "WHEELUPMOUSE",
    "WHEELDOWNMOUSE",
    "MOUSEMOVE",
    "INBETWEEN_MOUSEMOVE",
    "TRACKPADPAN",
    "TRACKPADZOOM",
    "NDOF_MOTION",
}
# Errors that are messages to the user. Any other exception is a bug, and its traceback is shown.
ERRORS = (ValueError, OSError, RuntimeError, MemoryError)


def object_mode(cls, context):
    """True if objects can be made, removed and selected."""
    return context.mode == "OBJECT" or deny(cls, "Leave Edit Mode or Sculpt Mode first")


def busy(cls, context, simulation=True):
    """True while something runs that uses the sculpt; the tooltip names it. `simulation`: a running simulation counts,
    too."""
    state = context.window_manager.riffler
    if state.running:
        deny(cls, f"{state.running}: Esc cancels")
    if state.sculpting:
        deny(cls, "A pen session is running: Esc ends it")
    if state.simulating and simulation:
        deny(cls, f"{state.simulating} is being simulated: Esc in the view ends it")
    return bool(state.running or state.sculpting or (state.simulating and simulation))


def tell_turned(operator, name, mesh):
    """Warns if triangles of a mesh had to be turned to make it a solid."""
    for note in notes_on(mesh.orient_with_report()[1]):
        operator.report({"WARNING"}, f"{name}: {note}")


def tell_all(operator, done, notes, wrong=False):
    """Reports the result; as a warning if `wrong`, or if there are notes."""
    operator.report({"WARNING" if wrong or notes else "INFO"}, ". ".join([done, *map(local, notes)]))


def deny(cls, message):
    cls.poll_message_set(message)
    return False


def fail(operator, error):
    """Reports one clear message instead of a traceback, and cancels the operator."""
    operator.report({"ERROR"}, as_sentence(said(error)))
    return {"CANCELLED"}


def as_sentence(text):
    """A message in the interface's language, with a capital first letter; names from the file stay unchanged."""
    data = bpy.data.objects, bpy.data.collections, bpy.data.images, bpy.data.texts, bpy.data.meshes
    return capitalised(local(text), (x.name for kind in data for x in kind))


def draw_fields(operator, keys):
    """Draws some of the operator's properties in the redo panel or the file selector, one below the other."""
    operator.layout.use_property_split = True
    for key in keys:
        operator.layout.prop(operator, key)
