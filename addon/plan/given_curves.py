"""The curves that a strategy starts from: the selected curve objects, where they lie in the scene."""

import bpy
import numpy as np

from ..blender import curve_objects, meshes, scene_units
from ..common import splines
from . import plan_store


def objects(context):
    """The selected curve objects, except those that show the paths of a plan."""
    return [ob for ob in context.selected_objects if ob.type == "CURVE" and not plan_store.is_plan(ob.parent)]


def selected(context, tolerance):
    """Their splines as polylines (n, 3) in mm of the world, within `tolerance` mm. ValueError with the remedy for a
    text, and for a curve that differs from its control points."""
    found, texts = objects(context), [ob.name for ob in context.selected_objects if ob.type == "FONT"]
    if not found and texts:
        raise ValueError(f"{texts[0]} is a text: use Object > Convert > Curve first")
    return lines(found, context.scene, tolerance)


def lines(found, scene, tolerance):
    """The splines of curve objects as polylines, like `selected`."""
    depsgraph, out = bpy.context.evaluated_depsgraph_get(), []
    for ob in found:
        if curve_objects.deformed(ob):
            raise ValueError(
                f"{ob.name} has modifiers or shape keys, which are not followed: convert it to a curve first"
            )
        to_mm = meshes.matrix(ob.evaluated_get(depsgraph).matrix_world)
        to_mm[:3] *= scene_units.mm_per_unit(scene)
        polylines = [splines.evaluate(spline, tolerance)[0] for spline in curve_objects.splines(ob, depsgraph, to_mm)]
        out += [line for line in polylines if len(line) > 1]
    if found and not out:
        raise ValueError(f"{found[0].name} has no spline with two points: add points, or select another curve")
    return [np.ascontiguousarray(line) for line in out]
