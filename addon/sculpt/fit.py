"""The scene's unit, and the cutter, made such that an object can be sculpted: common/fitting.py says which suit it."""

import bpy
import numpy as np

from ..blender import scene_units
from ..common import fitting, units
from . import sculpts

# What an object is whose size in mm rests on the scene's unit. Features that make such objects add theirs.
HOLDERS = [sculpts.is_sculpt]


def others(context):
    """True where the scene's unit is that of sculpts or plans that are there."""
    return any(holds(ob) for ob in context.scene.objects for holds in HOLDERS)


def side(context, longest):
    """Millimetres that a longest side of so many Blender units is to have: those it has, where they are handy."""
    now = longest * scene_units.mm_per_unit(context.scene)
    keep = fitting.is_handy(now) or others(context)
    return units.clean(now if keep else longest * fitting.unit(longest))


def take_unit(context, unit):
    """One Blender unit is so many millimetres. The view stays as it is, and so do objects."""
    if not np.isclose(unit, scene_units.mm_per_unit(context.scene), rtol=1e-6):
        scene_units.set_unit(context.scene, bpy.data.screens, units.clean(unit))


def cutter(context, longest):
    """Diameter (mm) of the one that suits a longest side in mm."""
    return fitting.tool(context.scene.riffler.tool.dictionary(), longest)["diameter"]


def take_cutter(context, diameter):
    """The scene's cutter with another diameter (mm), and a depth of strokes that suits it."""
    settings, tool = context.scene.riffler, context.scene.riffler.tool.dictionary()
    if not np.isclose(tool["diameter"], diameter):
        settings.tool.take(fitting.scaled(tool, diameter))
    if not fitting.depth_suits(settings.sculpt.depth, diameter):
        settings.sculpt.depth = fitting.depth(diameter)


class Kept:
    """Unit and cutter as they were, for an operator that is refused in the middle."""

    def __init__(self, context):
        self._scene, settings = context.scene, context.scene.unit_settings
        self._units = {key: getattr(settings, key) for key in ("system", "scale_length", "length_unit")}
        self._tool, self._depth = context.scene.riffler.tool.dictionary(), context.scene.riffler.sculpt.depth

    def restore(self):
        for key, value in self._units.items():
            if value:  # a scene without a system of units has none of length
                setattr(self._scene.unit_settings, key, value)
        self._scene.riffler.tool.take(self._tool)
        self._scene.riffler.sculpt.depth = self._depth
