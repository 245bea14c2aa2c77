"""What operators on the active sculpt share: refusals, warnings, and long work on it."""

import bpy
import numpy as np

from ..blender import operator_parts, refusals
from ..blender.long_work import LongWork
from ..common import json_object, units
from ..translations import local
from . import live_registry, mesh_edits, sculpt_store, sculpts

EDITS_FIRST = (
    "{} was edited in Blender's own modes: use Apply Mesh Edits to keep the edits, or Rebuild Mesh to discard them"
)
EDITS_LEFT_OUT = (
    "The mesh was edited, but the result has the volume without the edits: use Apply Mesh Edits first to include them"
)


def tool_of_text(text):
    """A tool's dictionary from JSON."""
    return json_object.loads(text, "tool")


class TakesTool:
    """Mixin of operators that cut with the scene's tool or a given one."""

    tool: bpy.props.StringProperty(
        name="Tool", options={"HIDDEN", "SKIP_SAVE"}, description="Tool as JSON; empty: the scene's tool"
    )

    def tool_dict(self, context, hand=False):
        if self.tool:
            return tool_of_text(self.tool)
        own = context.scene.riffler
        return (own.hand_tool if hand else own.tool).dictionary()


def sculpt_poll(cls, context):
    """True if the active object is a sculpt that can be changed; otherwise the button's tooltip gives the reason."""
    ob = sculpts.active(context)
    if ob is None:
        return operator_parts.deny(cls, no_sculpt(context))
    if not operator_parts.object_mode(cls, context):
        return False
    if why := refusals.linked(ob, ob.data):
        return operator_parts.deny(cls, why)
    return not operator_parts.busy(cls, context)


def no_sculpt(context):
    """Why there is no active sculpt, with the remedy."""
    return refusals.instance(context.object) or "Select a sculpt first, or make a new stock"


def refuse_edits(ob):
    """ValueError if Blender's own tools have changed the mesh of a sculpt since it was shown: rebuilding it from the
    volume would discard the user's work without asking."""
    if mesh_edits.made(ob):
        raise ValueError(local(EDITS_FIRST).format(ob.name))


def tell_edits(operator, ob):
    """The same as a warning, for work that only reads the volume and leaves the mesh unchanged."""
    if mesh_edits.made(ob):
        operator.report({"WARNING"}, local(EDITS_LEFT_OUT))


def check_state(operator, context, ob):
    """ValueError if a sculpt is unusable; a warning if its display differs from its volume, since it is scaled,
    mirrored or modified."""
    refusals.refuse(context, ob)
    for why in filter(None, (refusals.scaled(ob), refusals.modified(ob))):
        operator.report({"WARNING"}, why)


def tell_made(operator, ob):
    """Reports the size of a new sculpt's box, and of its mesh."""
    size = np.subtract(ob.data.riffler.upper, ob.data.riffler.lower)
    triangles = units.counted(len(ob.data.polygons), "triangle")
    operator.report({"INFO"}, f"{ob.name}: {units.format_size(size)}, {triangles}")


class SculptWork(LongWork):
    """Mixin; a subclass makes the job from the result of `take` and ends with `keep`."""

    bl_options = {"REGISTER", "UNDO"}
    from_edits = False  # True if it applies the edits of Blender's own tools
    leaves_mesh = False  # True if its result is another object, and the mesh stays unchanged

    @classmethod
    def poll(cls, context):
        return sculpt_poll(cls, context)

    def take(self, context):
        """(object, content) of the active sculpt; the content must not be changed."""
        live_registry.end_all()
        ob = sculpts.active(context)
        if self.from_edits:
            refusals.refuse(context, ob)
        else:
            check_state(self, context, ob)
            tell_edits(self, ob) if self.leaves_mesh else refuse_edits(ob)
        self._object, self._identity = ob.name, sculpt_store.identity(ob.data)
        return ob, sculpt_store.content(ob.data)

    def lost(self, context):
        ob = bpy.data.objects.get(self._object)
        if sculpts.is_sculpt(ob) and sculpt_store.identity(ob.data) == self._identity:
            return ""
        return f"{self.doing} cancelled: the sculpt was changed or removed meanwhile"

    @property
    def mesh(self):
        return bpy.data.objects[self._object].data

    def keep(self, content, unseen=""):
        """`unseen`: that of sculpts.commit."""
        sculpts.commit(self.mesh, content, sculpts.shown_mm_per_unit(self.mesh), unseen=unseen)
