"""STL, NC code and recordings out."""

import bpy
import numpy as np
import riffler
from bpy_extras.io_utils import ExportHelper

from .. import properties
from ..bl import sculpts, store
from ..core import poses
from ..core import units as names
from . import paths, shared


class Export(ExportHelper):
    """Mixin: file selector in a window, one clear message for what goes wrong."""

    @classmethod
    def poll(cls, context):
        if sculpts.active(context) is None:
            return shared.deny(cls, "Select a sculpt first")
        return True

    def execute(self, context):
        try:
            path = bpy.path.abspath(self.filepath)
            done = self.write(context, sculpts.active(context), path)
        except (ValueError, OSError, RuntimeError, MemoryError) as error:
            return shared.fail(self, error)
        self.report({"INFO"}, f"{bpy.path.basename(path)}: {done}")
        return {"FINISHED"}


class RIFFLER_OT_export_stl(Export, bpy.types.Operator):
    """Write the active sculpt as a binary STL in millimetres, straight from its volume"""

    bl_idname = "riffler.export_stl"
    bl_label = "Export STL"

    filename_ext = ".stl"
    filter_glob: bpy.props.StringProperty(default="*.stl", options={"HIDDEN"})
    world: bpy.props.BoolProperty(
        name="As placed", default=True, description="Apply the object's transform; off: as milled, in the stock's frame"
    )

    def write(self, context, ob, path):
        if sculpts.edited(ob.data):
            self.report({"WARNING"}, "The mesh was edited: what is written is the volume, without the edits")
        surface = store.content(ob.data).volume.to_mesh()
        if self.world:
            surface = placed(surface, sculpts.to_world_mm(ob, context.scene))
        surface.write(path)
        size = np.ptp(surface.vertices, axis=0) if len(surface.vertices) else np.zeros(3)
        return f"{names.format_count(len(surface.triangles))} triangles, {names.format_size(size)}"


def placed(surface, matrix):
    """A surface under an affine map; still outward where the map mirrors."""
    if np.allclose(matrix, np.eye(4), rtol=0, atol=1e-12):
        return surface
    triangles = surface.triangles
    if np.linalg.det(matrix[:3, :3]) < 0:
        triangles = np.ascontiguousarray(triangles[:, ::-1])
    return riffler.Mesh(poses.transform_points(matrix, surface.vertices), triangles)


class RIFFLER_OT_export_nc(properties.NcSettings, Export, bpy.types.Operator):
    """Write the cuts made on the active sculpt as NC code in the stock's own frame"""

    bl_idname = "riffler.export_nc"
    bl_label = "Write NC"

    filename_ext = ".ngc"
    filter_glob: bpy.props.StringProperty(default="*.ngc;*.nc;*.tap", options={"HIDDEN"})

    def write(self, context, ob, path):
        content = store.content(ob.data)
        cuts = content.cuts
        if not cuts:
            raise ValueError(f"{ob.name} has no cuts yet: an NC program is what was cut")
        tools = [riffler.Tool.from_dict(c.tool) for c in cuts]
        feed, spindle = names.clean(self.feed), names.clean(self.spindle)
        program = riffler.Program.from_cl(
            [c.poses for c in cuts],
            tools=tools,
            feed=feed,
            spindle=spindle,
            # retracts clear the stock as it was before the first cut
            occupied=(content.volume.lower, content.volume.upper),
            provenance={"stock": ob.name},
        )
        program.write(path, post=self.post)
        return f"{len(cuts)} cuts, {names.format_count(len(program.poses))} moves"


class RIFFLER_OT_export_recording(Export, bpy.types.Operator):
    """Write the cuts made on the active sculpt as a recording, which another stock can be cut with"""

    bl_idname = "riffler.export_recording"
    bl_label = "Save Recording"

    filename_ext = ".rjournal"
    filter_glob: bpy.props.StringProperty(default="*.rjournal", options={"HIDDEN"})

    def write(self, context, ob, path):
        content = store.content(ob.data)
        cuts = content.cuts
        if not cuts:
            raise ValueError(f"{ob.name} has no cuts yet")
        paths.to_recording(cuts, content.volume).write(path)
        return f"{len(cuts)} strokes"


CLASSES = (RIFFLER_OT_export_stl, RIFFLER_OT_export_nc, RIFFLER_OT_export_recording)
