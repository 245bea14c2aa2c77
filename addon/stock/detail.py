"""How many triangles the mesh of a sculpt has: those that its shape needs, or all."""

import bpy

from ..blender import attributes, versions
from ..common import units
from ..common.job import TaskJob, ThreadTask
from ..sculpt import live_registry, mask_display, sculpts, surfaces
from ..sculpt.sculpt_work import SculptWork
from ..translations import CONTEXT, local

NEEDED = (
    "Leave out triangles that the shape does not need within a tenth of the pitch: strokes are faster and files smaller"
    ". The volume, from which cuts and exports are made, is the same"
)
ALL = "Show two triangles for each cell of the surface, evenly spaced: for Sculpt Mode, remeshing and modifiers"


class RIFFLER_OT_detail(SculptWork, bpy.types.Operator):
    """Choose the triangles that the sculpt's mesh has; its volume is unchanged"""

    bl_idname = "riffler.detail"
    bl_label = "Set Triangles"
    doing = "Making triangles"
    cancelled = "The triangles are unchanged"

    detail: bpy.props.EnumProperty(name="Triangles", items=surfaces.DETAIL, default="ALL", description="What it has")

    @classmethod
    def description(cls, context, properties):
        return local(NEEDED if properties.detail == "NEEDED" else ALL)

    def begin(self, context):
        _, content = self.take(context)
        tolerance = surfaces.within(self.detail, content.volume.pitch, content.mask)
        volume = content.volume.copy()
        return TaskJob(ThreadTask(lambda progress: surfaces.of_volume(volume, tolerance, progress)))

    def finish(self, context, job):
        self.mesh.riffler.detail = self.detail
        sculpts.show_whole(self.mesh, job.result)
        self.report({"INFO"}, f"{self._object}: {units.counted(len(self.mesh.polygons), 'triangle')}")
        return {"FINISHED"}


def choose(row, ob):
    """The choice for a sculpt, if there is one (surfaces.within)."""
    if not versions.OWN_NORMALS:
        return
    row = row.row(align=True)
    row.alignment = "RIGHT"
    for key, name, _ in surfaces.DETAIL:
        chosen = ob.data.riffler.detail == key
        row.operator(RIFFLER_OT_detail.bl_idname, text=name, text_ctxt=CONTEXT, depress=chosen).detail = key


def all_for(ob):
    """Why a sculpt shows all triangles though the user wants those that it needs; otherwise ""."""
    if ob.data.riffler.detail == "ALL" or not versions.OWN_NORMALS:
        return ""
    run = live_registry.of(ob)
    if run is not None:
        return "all, while it has a mask" if run.mask is not None else ""
    if ob.data.riffler.shown_within:
        return ""
    if mask_display.is_shown(ob.data):
        return "all, while it has a mask"
    return "all, with their colours" if attributes.SCALE in ob.data else ""


CLASSES = (RIFFLER_OT_detail,)
