"""Obstacles of a tool: the meshes of a collection, in a sculpt's millimetres."""

import hashlib

import numpy as np
import riffler
import riffler.plan

from ..blender import meshes, object_surfaces

BETWEEN = (0.25, 0.5, 0.75)  # shares of a move at which its clearance is checked
CLEAR = 1e-3  # mm: distance of a lifted tool from the fixture
_last = ("", None)  # the meshes' hash, and their collider: a stroke changes no fixture


def collider(context, collection, to_mm, without=()):
    """riffler.Collider of the visible meshes of `collection`, or None if there are none. `to_mm`: (4, 4) world → mm;
    `without`: names of objects to leave out."""
    global _last
    depsgraph = context.evaluated_depsgraph_get()
    vertices, triangles, count = [], [], 0
    for ob in collection.all_objects:
        if ob.type != "MESH" or ob.name in without or not ob.visible_get():
            continue
        co, tri = object_surfaces.placed(*meshes.read(ob, depsgraph), to_mm @ meshes.matrix(ob.matrix_world))
        vertices.append(co)
        triangles.append(tri + count)
        count += len(co)
    if not sum(map(len, triangles)):
        return None
    co, tri = np.concatenate(vertices), np.concatenate(triangles).astype(np.int32)
    key = hashlib.sha256(co.tobytes() + tri.tobytes()).hexdigest()
    if _last[0] != key:
        _last = (key, riffler.Collider(riffler.Mesh(co, tri)))
    return _last[1]


def keeper(tool, collider):
    """Poses (n, 6) and seconds (n - 1,) → the same, free of collisions: lifted along the tool's axis as little as
    possible, up before the move and down after it. If no lift frees a pose, the tool waits at the pose before; None if
    there is none."""

    def keep_out(poses, dt):
        lifted, report = riffler.plan.lift(poses, tool, collider, tolerance=CLEAR)
        free = np.flatnonzero(report.free)
        if not len(free):
            return None
        last = np.searchsorted(free, np.arange(len(poses)), side="right") - 1
        rows = free[np.maximum(last, 0)]
        return _upright(lifted[rows], report.lift[rows], dt, lambda way: collider.clearance(tool, way))

    return keep_out


def _upright(poses, lifts, dt, clearance):
    """Inserts the corner above the lower one of two poses of different lift, since the straight move would enter the
    fixture under the higher one."""
    rise = np.diff(lifts)
    steps = np.flatnonzero(np.abs(rise) > CLEAR)
    if not len(steps):
        return poses, dt
    a, b = poses[steps], poses[steps + 1]
    between = np.stack([a + share * (b - a) for share in BETWEEN])
    between[..., 3:] /= np.linalg.norm(between[..., 3:], axis=2, keepdims=True)
    steps = steps[clearance(between.reshape(-1, 6)).reshape(len(BETWEEN), -1).min(axis=0) < -CLEAR]
    corners = poses[np.where(rise[steps] > 0, steps, steps + 1)]
    corners[:, :3] += np.abs(rise[steps])[:, None] * corners[:, 3:]
    dt = np.array(dt, float)
    dt[steps] /= 2
    return np.insert(poses, steps + 1, corners, axis=0), np.insert(dt, steps + 1, dt[steps])
