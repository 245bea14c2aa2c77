"""A plan of the step, resolved or not, a stock around it, and NC text made here."""

import bpy
import numpy as np
import riffler
from mathutils import Matrix

from support import common, plans

LEANING = (0.0, -0.6, 0.8)  # away from the wall: free
INTO = (0.0, 0.8, 0.6)  # into the wall


def valley(*axes):
    """The step's path with these axes from its beginning to its end."""
    path = riffler.plan.pencil(riffler.Mesh(*plans.step()), plans.TOOL)[0].divided(1.0)
    places = np.linspace(0, len(path) - 1, len(axes)).astype(int)
    units = [np.array(axis, float) / np.linalg.norm(axis) for axis in axes]
    return path.orient(dict(zip(map(int, places), units, strict=True)), interpolation="slerp")


def bare():
    """The step's path without keys."""
    path = valley(LEANING)
    return riffler.plan.PencilPath(path.radius, path.centres, path.contacts, path.normals, closed=path.closed)


def plan(*paths, mm_per_unit=1.0, timeline=True):
    """The plan's object, its part being the step."""
    common.scale(mm_per_unit)
    part = plans.part_object(mm_per_unit)
    bpy.context.scene.riffler.plan.part = part
    paths = list(paths) or [valley(LEANING)]
    if timeline:
        ob = plans.on_timeline(mm_per_unit, chosen=paths)
    else:
        ob = common.part("plan.plan_store").new(bpy.context, riffler.plan.Plan(paths, plans.TOOL, tolerance=0.01))
    ob.riffler.plan.part = part
    return ob


def content(ob):
    return common.part("plan.plan_store").plan(ob)


def stock(pitch=0.5, offset=0.5, location=(0, 0, 0), turn=0.0):
    """A sculpt that is the step with `offset` mm of material on it, at any place in the scene."""
    vertices = plans.step()[0]
    low, high = vertices.min(axis=0) - 1, vertices.max(axis=0) + 1
    triangles = plans.step()[1]
    grown = vertices.copy()
    grown[:, 0] += np.where(vertices[:, 0] > 30, offset, -offset)
    grown[:, 1] += np.where(vertices[:, 1] > 30, offset, -offset)
    grown[:, 2] += np.where(vertices[:, 2] > 0, offset, 0)
    common.scale(1.0)
    volume = riffler.Volume.from_mesh(riffler.Mesh(grown, triangles), pitch, lower=low, upper=high, directions="xyz")
    matrix = Matrix.Translation(location) @ Matrix.Rotation(turn, 4, "Z")
    if turn or any(location):  # the same place in the scene from another frame
        back = np.linalg.inv(np.array(matrix))
        co = (np.c_[grown, np.ones(len(grown))] @ back.T)[:, :3]
        volume = riffler.Volume.from_mesh(riffler.Mesh(co, triangles), pitch, directions="xyz")
    ob = common.part("sculpt.sculpts").new_object(
        bpy.context, "Stock", common.part("common.contents").Content(volume), matrix
    )
    bpy.context.scene.riffler.verify.stock = ob
    bpy.context.view_layer.update()
    return ob


def resolved(*paths, **more):
    ob = plan(*paths, **more)
    assert bpy.ops.riffler.plan_resolve() == {"FINISHED"}
    return ob


def settings():
    return bpy.context.scene.riffler.verify


def listed(collection):
    return common.part("plan.findings").read(collection)
