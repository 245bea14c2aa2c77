"""Parts and fixtures: objects of the scene as surfaces in millimetres of the world, the frame of plans."""

import numpy as np
import riffler

from ..common import poses
from . import meshes, refusals, scene_units

WITH_SURFACE = {"MESH", "CURVE", "SURFACE", "FONT", "META"}  # object types that can have a surface


def surface(ob, depsgraph, to_mm):
    """The object with its modifiers as a riffler.Mesh: `to_mm` (4, 4) maps its own Blender units to millimetres. If it
    mirrors, triangles are turned so that normals still point out of the material."""
    co, triangles = meshes.read(ob, depsgraph)
    if len(triangles) == 0:
        raise ValueError(f"{ob.name} has no faces: choose another object, or give it a surface")
    return riffler.Mesh(*placed(co, triangles, to_mm))


def placed(co, triangles, to_mm):
    """Vertices and triangles under a map (4, 4). If it mirrors, normals still point out of the material."""
    if np.linalg.det(to_mm[:3, :3]) < 0:
        triangles = np.ascontiguousarray(triangles[:, ::-1])
    return poses.transform_points(to_mm, co), triangles


def in_world(context, ob):
    """The object as it lies in the scene. ValueError with the remedy if it cannot be a part."""
    if why := unfit(ob, context.scene):
        raise ValueError(why)
    if why := refusals.disabled(ob, context.view_layer):
        raise ValueError(why)
    depsgraph = context.evaluated_depsgraph_get()
    matrix = meshes.matrix(ob.evaluated_get(depsgraph).matrix_world)
    if why := refusals.flat(ob, matrix) or refusals.sheared(ob, matrix):
        raise ValueError(why)
    matrix[:3] *= scene_units.mm_per_unit(context.scene)
    return surface(ob, depsgraph, matrix)


def size(ob, scene):
    """Sides in mm of the object's bounding box in the scene, from Blender's cached data: cheap enough for a panel."""
    matrix, box = meshes.matrix(ob.matrix_world), np.array(ob.bound_box, float)
    return np.ptp(poses.transform_points(matrix, box), axis=0) * scene_units.mm_per_unit(scene)


def unfit(ob, scene):
    """Why the object can be neither part nor fixture, or ""; cheap enough for a poll."""
    if ob is None:
        return "There is no part: select one and use Set Part"
    if scene not in ob.users_scene:  # another file may have an object of the same name
        return f"{ob.name} was deleted from this scene: set another part"
    if why := refusals.instance(ob):
        return why
    if ob.type not in WITH_SURFACE:
        return f"{ob.name} has no surface: take a mesh, curve, text, surface or metaball"
    if ob.mode != "OBJECT":
        return f"Leave the mode that {ob.name} is in first"
    return ""


def source_object(context):
    """The object that would become material, or None."""
    ob = context.object
    return ob if ob is not None and ob.type in WITH_SURFACE else None
