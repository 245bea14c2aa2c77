"""Work on the active sculpt: what operators of cuts and of clay have in common."""

import bpy

from ..bl import live, refusals, sculpts, store
from . import shared
from .long import LongWork


class SculptWork(LongWork):
    """Mixin; a subclass makes the job from what `take` gives and ends in `keep`."""

    bl_options = {"REGISTER", "UNDO"}
    from_edits = False  # it takes over what Blender's own tools have made of the mesh
    leaves_mesh = False  # it makes something else, and the mesh stays as it is

    @classmethod
    def poll(cls, context):
        return shared.sculpt_poll(cls, context)

    def take(self, context):
        """(object, content) of the active sculpt; the content must not be changed."""
        live.end_all()
        ob = sculpts.active(context)
        if self.from_edits:
            refusals.refuse(context, ob)
        else:
            shared.check_state(self, context, ob)
            shared.tell_edits(self, ob) if self.leaves_mesh else shared.refuse_edits(ob)
        self._object, self._identity = ob.name, store.identity(ob.data)
        return ob, store.content(ob.data)

    def lost(self, context):
        ob = bpy.data.objects.get(self._object)
        if sculpts.is_sculpt(ob) and store.identity(ob.data) == self._identity:
            return ""
        return f"{self.doing} cancelled: the sculpt was changed or removed meanwhile"

    @property
    def mesh(self):
        return bpy.data.objects[self._object].data

    def keep(self, content, unseen=""):
        """`unseen`: as sculpts.commit's."""
        sculpts.commit(self.mesh, content, sculpts.shown_mm_per_unit(self.mesh), unseen=unseen)
