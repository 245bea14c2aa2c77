"""Sets the scene's unit and the cutter such that an object can be sculpted: common/fitting.py chooses them."""

import bpy
import numpy as np

from ..blender import scene_units
from ..common import fitting, units
from . import sculpts

# Types of data whose size in mm depends on the scene's unit. Features that make such objects add theirs.
HOLDERS = [sculpts.is_sculpt]


def others(context):
    """True if the scene has sculpts or plans, which depend on its unit."""
    return any(holds(ob) for ob in context.scene.objects for holds in HOLDERS)


def side(context, longest):
    """Size in millimetres for a longest side of so many Blender units: the current one, if it is handy."""
    now = longest * scene_units.mm_per_unit(context.scene)
    keep = fitting.is_handy(now) or others(context)
    return units.clean(now if keep else longest * fitting.unit(longest))


def take_unit(context, unit):
    """Sets the millimetres of one Blender unit. Views and objects stay unchanged."""
    if not np.isclose(unit, scene_units.mm_per_unit(context.scene), rtol=1e-6):
        scene_units.set_unit(context.scene, bpy.data.screens, units.clean(unit))


def cutter(context, longest):
    """Diameter (mm) of a cutter that suits a longest side in mm."""
    return fitting.tool(context.scene.riffler.tool.dictionary(), longest)["diameter"]


def take_cutter(context, diameter):
    """Sets the diameter (mm) of the scene's cutter, and a depth of strokes that suits it."""
    settings, tool = context.scene.riffler, context.scene.riffler.tool.dictionary()
    if not np.isclose(tool["diameter"], diameter):
        settings.tool.take(fitting.scaled(tool, diameter))
    if not fitting.depth_suits(settings.sculpt.depth, diameter):
        settings.sculpt.depth = fitting.depth(diameter)


class Kept:
    """The previous unit and cutter, for an operator that fails halfway."""

    def __init__(self, context):
        self._scene, settings = context.scene, context.scene.unit_settings
        self._units = {key: getattr(settings, key) for key in ("system", "scale_length", "length_unit")}
        self._tool, self._depth = context.scene.riffler.tool.dictionary(), context.scene.riffler.sculpt.depth

    def restore(self):
        for key, value in self._units.items():
            if value:  # a scene without a unit system has no unit of length
                setattr(self._scene.unit_settings, key, value)
        self._scene.riffler.tool.take(self._tool)
        self._scene.riffler.sculpt.depth = self._depth
