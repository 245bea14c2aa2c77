"""A plan on the timeline, checked and edited by tests."""

import bpy
import numpy as np

from support import common


def pair(ob):
    return common.part("plan.timeline").pair(ob)


def paths(ob):
    return common.part("plan.plan_store").plan(ob).paths


def state(ob):
    return common.part("plan.plan_states").state(ob)


def tracks(ob):
    return common.part("plan.replan").layout_of(ob, common.part("plan.plan_store").plan(ob)).tracks


def curves(tool):
    found = common.part("blender.versions").channels(tool)
    return [found.find("rotation_quaternion", index=i) for i in range(4)]


def update():
    bpy.context.view_layer.update()


def quat(axis, before=(1, 0, 0, 0)):
    axis = np.array(axis, float)
    return common.part("common.quaternions").transported((axis / np.linalg.norm(axis))[None], np.array(before))[0]


def insert(tool, frame, axis, sign=1.0):
    """Like inserting in the graph editor: a point in each curve."""
    for curve, value in zip(curves(tool), sign * quat(axis), strict=True):
        curve.keyframe_points.insert(frame, value)
    update()


def remove(tool, frame):
    for curve in curves(tool):
        point = next(p for p in curve.keyframe_points if abs(p.co[0] - frame) < 1e-3)
        curve.keyframe_points.remove(point)
    update()


def indices(ob):
    return [list(p.keys) for p in paths(ob)]


def seen(ob, frame):
    """Tip in mm and axis of the tool in Blender at a frame, by its dependency graph."""
    bpy.context.scene.frame_set(int(frame // 1), subframe=frame % 1)
    matrix = np.array(pair(ob)[0].evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world)
    scale = bpy.context.scene.unit_settings.scale_length * 1000
    return matrix[:3, 3] * scale, matrix[:3, 2] / np.linalg.norm(matrix[:3, 2])


def close(a, b, tolerance=1e-5):
    return np.abs(np.asarray(a) - np.asarray(b)).max() < tolerance


def same_axes(path, wanted, tolerance=1e-5):
    """Compares the path's keys with a dict of index to axis of any length."""
    assert list(path.keys) == sorted(wanted), (list(path.keys), wanted)
    return all(close(path.keys[k], np.array(a, float) / np.linalg.norm(a), tolerance) for k, a in wanted.items())
