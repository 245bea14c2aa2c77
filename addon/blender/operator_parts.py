"""What operators of every feature have in common: why they are refused, what they report, how they fail."""

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
# What is a message to the person in front of the screen; anything else is a fault of ours, and its traceback is shown.
ERRORS = (ValueError, OSError, RuntimeError, MemoryError)


def object_mode(cls, context):
    """True where objects can be made, removed and selected."""
    return context.mode == "OBJECT" or deny(cls, "Leave Edit Mode or Sculpt Mode first")


def busy(cls, context, simulation=True):
    """True while something runs that has the sculpt; the tooltip says what. `simulation`: one that is shown counts."""
    state = context.window_manager.riffler
    if state.running:
        deny(cls, f"{state.running}: Esc cancels")
    if state.sculpting:
        deny(cls, "A pen session is running: Esc ends it")
    if state.simulating and simulation:
        deny(cls, f"{state.simulating} is being simulated: Esc in the view ends it")
    return bool(state.running or state.sculpting or (state.simulating and simulation))


def tell_turned(operator, name, mesh):
    """A warning where a mesh that is taken as a solid has triangles that are turned for it."""
    found = {}
    mesh.oriented(found)
    for note in notes_on(found):
        operator.report({"WARNING"}, f"{name}: {note}")


def tell_all(operator, done, notes, wrong=False):
    """What was done; a warning where that is `wrong`, or there is more to be said of it."""
    operator.report({"WARNING" if wrong or notes else "INFO"}, ". ".join([done, *map(local, notes)]))


def deny(cls, message):
    cls.poll_message_set(message)
    return False


def fail(operator, error):
    """One clear message instead of a traceback; the operator is cancelled."""
    operator.report({"ERROR"}, as_sentence(said(error)))
    return {"CANCELLED"}


def as_sentence(text):
    """A message in the interface's language; it begins large, but names of what is in the file stay as they are."""
    data = bpy.data.objects, bpy.data.collections, bpy.data.images, bpy.data.texts, bpy.data.meshes
    return capitalised(local(text), (x.name for kind in data for x in kind))


def draw_fields(operator, keys):
    """Some of its properties in the redo panel or the file selector, one below the other."""
    operator.layout.use_property_split = True
    for key in keys:
        operator.layout.prop(operator, key)
