"""Parts and fixtures: objects of the scene as surfaces in millimetres of the world, the frame that plans are in."""

import numpy as np
import riffler

from ..core import poses
from ..properties.plan import WITH_SURFACE
from . import meshes, units

SHEAR = 1e-4  # cosine between two axes of an object that are to be square to each other


def surface(ob, depsgraph, to_mm):
    """The object with its modifiers as a riffler.Mesh: `to_mm` (4, 4) maps its own Blender units to millimetres; where
    it mirrors, normals still look out of the material."""
    co, triangles = meshes.read(ob, depsgraph)
    if len(triangles) == 0:
        raise ValueError(f"{ob.name} has no faces: choose another object, or give it a surface")
    return riffler.Mesh(*placed(co, triangles, to_mm))


def placed(co, triangles, to_mm):
    """Vertices and triangles under a map (4, 4); where it mirrors, normals still look out of the material."""
    if np.linalg.det(to_mm[:3, :3]) < 0:
        triangles = np.ascontiguousarray(triangles[:, ::-1])
    return poses.transform_points(to_mm, co), triangles


def in_world(context, ob):
    """The object as it lies in the scene. ValueError with the remedy where it cannot be a part."""
    if why := unfit(ob, context.scene):
        raise ValueError(why)
    if not _evaluated(ob, context.view_layer.layer_collection):
        raise ValueError(f"{ob.name} is disabled in viewports or in this view layer: enable it in the Outliner")
    depsgraph = context.evaluated_depsgraph_get()
    matrix = meshes.matrix(ob.evaluated_get(depsgraph).matrix_world)
    refuse_sheared(ob, matrix)
    matrix[:3] *= units.mm_per_unit(context.scene)
    return surface(ob, depsgraph, matrix)


def size(ob, scene):
    """Sides in mm of the box that an object fills in the scene, from what Blender knows of it: cheap enough for a
    panel."""
    matrix, box = meshes.matrix(ob.matrix_world), np.array(ob.bound_box, float)
    return np.ptp(poses.transform_points(matrix, box), axis=0) * units.mm_per_unit(scene)


def unfit(ob, scene):
    """Why the object can be neither part nor fixture, or nothing; cheap enough for a poll."""
    if ob is None:
        return "There is no part: select one and use Set Part"
    if scene.objects.get(ob.name) != ob:
        return f"{ob.name} was deleted from this scene: set another part"
    if ob.type not in WITH_SURFACE:
        return f"{ob.name} has no surface: take a mesh, curve, text, surface or metaball"
    if ob.mode != "OBJECT":
        return f"Leave the mode that {ob.name} is in first"
    return ""


def _evaluated(ob, layer):
    """True where the object has its modifiers and stands where it should: hidden ones do, disabled ones do not, but
    where something points to them they say that they are."""
    if ob.hide_viewport or layer.exclude or layer.collection.hide_viewport:
        return False
    return layer.collection.objects.get(ob.name) == ob or any(_evaluated(ob, child) for child in layer.children)


def sheared(matrix):
    """True where the axes are not square to each other."""
    axes = matrix[:3, :3]
    size = np.linalg.norm(axes, axis=0)
    if not size.all():
        return False  # flat: it has no volume, which is another matter
    between = (axes / size).T @ (axes / size)
    return bool(np.abs(between - np.eye(3)).max() > SHEAR)


def refuse_sheared(ob, matrix=None):
    """ValueError with the remedy where its axes are not square to each other; `matrix`: of the world, if not its own.
    Blender drops the shear of whatever is put at the same place, so that would not be at the same place."""
    if sheared(meshes.matrix(ob.matrix_world) if matrix is None else matrix):
        raise ValueError(f"{ob.name} is sheared: {_unshear(ob)}")


def _unshear(ob):
    if ob.parent is None:
        return "use Object > Apply > Visual Transform, or take away the constraint that does it"
    above = ob.parent
    while above.parent is not None:
        above = above.parent
    return f"select {above.name}, which it hangs on, and use Object > Apply > Scale"


def instance(ob):
    """Why an object that stands for a collection, as one that was linked does, can be no fixture, or nothing."""
    if ob.instance_type != "COLLECTION" or ob.instance_collection is None:
        return ""
    return f"{ob.name} is an instance of {ob.instance_collection.name}: use Object > Apply > Make Instances Real"


def fixtures(settings, part):
    """The objects of the fixtures' collection that have a surface, but the part. ValueError where there is one whose
    surface would be passed over."""
    if settings.fixtures is None:
        return []
    if why := next(filter(None, map(instance, settings.fixtures.all_objects)), ""):
        raise ValueError(f"{why}, or take it out of the fixtures")
    return [ob for ob in settings.fixtures.all_objects if ob.type in WITH_SURFACE and ob != part]
