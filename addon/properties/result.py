"""Settings of what is made of a sculpt: a plain mesh, deviation colours."""

import bpy
from bpy.props import BoolProperty, IntProperty, PointerProperty

from .fields import length


class ResultSettings:
    """Shared by the panel's settings and the operator."""

    tolerance: length(
        "Tolerance", 0.01, "How far decimation may take the surface from the volume's, in mm; 0: all", 0.0
    )
    iterations: IntProperty(name="Smooth", default=0, min=0, max=200, description="Passes that smooth, edges stay")
    smooth_tolerance: length("At most", 0.02, "How far smoothing may move a vertex, in mm", 1e-5)
    hide_sculpt: BoolProperty(name="Hide Sculpt", default=True, description="Show the new mesh in the sculpt's place")


class RifflerResult(ResultSettings, bpy.types.PropertyGroup):
    reference: PointerProperty(
        name="Reference", type=bpy.types.Object, description="The surface that distances are measured from"
    )
    scale: length("Full colours at", 0.1, "Distance from which colours are full, in mm", 1e-5)
