"""What the operators have in common."""

import bpy
import numpy as np
from riffler.mesh_notes import notes_on

from ..bl import edits, refusals, sculpts
from ..core import json_object, units
from ..core.problems import capitalised, said
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


EDITS_FIRST = "{} was edited in Blender's own modes: Take Edits keeps that, Rebuild Mesh drops it; then go on"
EDITS_LEFT_OUT = "The mesh was edited: what is made is the volume, without the edits. Take Edits takes them over first"


def tool_of_text(text):
    """A tool's dictionary from JSON."""
    return json_object.loads(text, "tool")


class TakesTool:
    """Mixin of operators that cut with the scene's tool or one that they are given."""

    tool: bpy.props.StringProperty(
        name="Tool", options={"HIDDEN", "SKIP_SAVE"}, description="A tool as JSON; empty: the scene's tool"
    )

    def tool_dict(self, context):
        return tool_of_text(self.tool) if self.tool else context.scene.riffler.tool.dictionary()


def sculpt_poll(cls, context):
    """True where the active object is a sculpt that can be changed; otherwise the button's tooltip says why not."""
    ob = sculpts.active(context)
    if ob is None:
        return deny(cls, no_sculpt(context))
    if not object_mode(cls, context):
        return False
    if why := refusals.linked(ob, ob.data):
        return deny(cls, why)
    return not busy(cls, context)


def no_sculpt(context):
    """Why the active object is none, with the step that helps."""
    return refusals.instance(context.object) or "Select a sculpt first, or make a new stock"


def object_mode(cls, context):
    """True where objects can be made, removed and selected."""
    return context.mode == "OBJECT" or deny(cls, "Leave Edit Mode or Sculpt Mode first")


def busy(cls, context, simulation=True):
    """True while something runs that has the sculpt; the tooltip says what. `simulation`: one that is shown counts."""
    state = context.window_manager.riffler
    if state.running:
        deny(cls, f"{state.running}: Esc cancels")
    if state.sculpting:
        deny(cls, "A pen is sculpting: Esc ends it")
    if state.simulating and simulation:
        deny(cls, f"{state.simulating} is being simulated: Esc in the view ends it")
    return bool(state.running or state.sculpting or (state.simulating and simulation))


def refuse_edits(ob):
    """ValueError where Blender's own tools have changed the mesh of a sculpt since it was shown: it would be shown anew
    from the volume, and nobody's work is dropped unasked."""
    if edits.made(ob):
        raise ValueError(local(EDITS_FIRST).format(ob.name))


def tell_edits(operator, ob):
    """The same as a warning, for what only reads the volume and leaves the mesh."""
    if edits.made(ob):
        operator.report({"WARNING"}, local(EDITS_LEFT_OUT))


def check_state(operator, context, ob):
    """ValueError where a sculpt cannot be worked with; a warning where what is seen is not its volume, as it is scaled,
    mirrored or modified."""
    refusals.refuse(context, ob)
    for why in filter(None, (refusals.scaled(ob), refusals.modified(ob))):
        operator.report({"WARNING"}, why)


def tell_turned(operator, name, mesh):
    """A warning where a mesh that is taken as a solid has triangles that are turned for it."""
    found = {}
    mesh.oriented(found)
    for note in notes_on(found):
        operator.report({"WARNING"}, f"{name}: {note}")


def tell_made(operator, ob):
    """The size of a new sculpt's box, and what its mesh has."""
    size = np.subtract(ob.data.riffler.upper, ob.data.riffler.lower)
    triangles = units.counted(len(ob.data.polygons), "triangle")
    operator.report({"INFO"}, f"{ob.name}: {units.format_size(size)}, {triangles}")


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


def redraw_sidebars(context):
    """The sidebars only: the view itself is costly, and is drawn again when the mesh changes."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                for region in area.regions:
                    if region.type == "UI":
                        region.tag_redraw()
