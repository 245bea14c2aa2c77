"""The display of a plan: one curve object for each path, along the ball's centres. They show the plan and can be
selected; edits of them do not change it.

The plan's Empty points to the curves that the add-on has made. A copy of one is in no list, so it belongs to the user;
if the Empty is copied with its curves, Blender lets the copy point to the copies. Curves that the user has renamed or
used elsewhere belong to the user, too: redrawing leaves them unchanged.
"""

import re
from collections import Counter

import bpy
import numpy as np

from . import plan_store

_T = bpy.types
# types that contain or show visible objects
_KEEPERS = (_T.Scene, _T.Collection, _T.Screen, _T.WorkSpace, _T.WindowManager)
_NUMBER = re.compile(r"\.\d{3,}$")  # Blender's suffix for a name that is taken


def show(ob, plan, mm_per_unit):
    """Makes the plan's curves again, as children of its Empty and in its collections; returns what was left, as `hide`
    does."""
    left = hide(ob)
    home = ob.users_collection[0]
    for k, path in enumerate(plan.paths):
        curve = bpy.data.curves.new(name_of(k, path), "CURVE")
        curve.dimensions = "3D"
        spline = curve.splines.new("POLY")
        spline.points.add(len(path) - 1)
        spline.points.foreach_set("co", _points(path, mm_per_unit))
        spline.use_cyclic_u = path.closed
        shown = bpy.data.objects.new(curve.name, curve)
        shown.parent = ob
        plan_store.lock(shown)
        home.objects.link(shown)
        line = ob.riffler.plan.curves.add()
        line.name, line.curve = shown.name, shown
    return left


def hide(ob):
    """Removes the curves; returns the names of those that belong to the user by now, which stay."""
    lines = [(line.curve, line.name) for line in ob.riffler.plan.curves if _is_of(line.curve, ob)]
    used = _used([curve for curve, _ in lines])
    left = [curve for curve, name in lines if curve in used or _plain(curve.name) != _plain(name)]
    names = [curve.name for curve in left]
    going = {curve for curve, _ in lines}.difference(left)
    data = {curve.data for curve in going}
    ob.riffler.plan.curves.clear()
    bpy.data.batch_remove(going)
    bpy.data.batch_remove([curve for curve in data if curve.users == 0])
    return names


def of(ob):
    """The plan's curve objects in the order of their paths."""
    return list(numbered(ob).values())


def numbered(ob):
    """The plan's curve objects by the number of their path, from 0; without deleted ones, which stay in the file as
    long as the plan points to them."""
    seen = {other for scene in bpy.data.scenes for other in scene.objects}
    lines = enumerate(line.curve for line in ob.riffler.plan.curves)
    return {k: curve for k, curve in lines if _is_of(curve, ob) and curve in seen}


def _is_of(curve, ob):
    """False for curves of the original, to which a copy of the Empty alone points."""
    return curve is not None and curve.type == "CURVE" and curve.parent == ob


def _plain(name):
    return _NUMBER.sub("", name)


def kept_note(names):
    """A note on the curves that `hide` has left."""
    if not names:
        return ""
    shown = ", ".join(names[:3]) + (" …" if len(names) > 3 else "")
    return f"Left unchanged, since they were renamed or are in use: {shown}"


def _used(curves):
    """The objects that the user has used elsewhere: in one more collection, by other data (children, modifiers,
    constraints), by a setting of a scene, or with something added to them."""
    if not curves:
        return set()
    homes = Counter(ob for collection in _collections() for ob in collection.objects)
    used = set()
    for curve, users in bpy.data.user_map(subset=curves).items():
        plans = sum(plan_store.is_plan(user) for user in users if isinstance(user, bpy.types.Object))
        others = [user for user in users if not isinstance(user, _KEEPERS)]
        counted = curve.users - homes[curve] - plans  # for instance by a setting
        if homes[curve] > 1 or len(others) > plans or counted > 0 or _has_additions(curve):
            used.add(curve)
    return used


def _collections():
    return [*bpy.data.collections, *(scene.collection for scene in bpy.data.scenes)]


def _has_additions(curve):
    data = curve.data
    added = (curve.modifiers, curve.constraints, data.materials)
    return any(map(len, added)) or any((curve.animation_data, data.animation_data, data.shape_keys))


def name_of(k, path):
    """The number comes first, so that lists have the plan's order."""
    return f"Path {k + 1}: {path.length:.1f} mm"


def edited(ob, plan, mm_per_unit):
    """The number of paths that are not shown unchanged: their curve was edited, moved, or removed."""
    right = set()
    for k, c in numbered(ob).items():
        if k < len(plan.paths) and _is_as_shown(c, plan.paths[k], mm_per_unit):
            right.add(k)
    return len(plan.paths) - len(right)


def _is_as_shown(c, path, mm_per_unit):
    if len(c.data.splines) != 1 or len(c.data.splines[0].points) != len(path):
        return False
    spline = c.data.splines[0]
    co = np.empty(4 * len(path), np.float32)
    spline.points.foreach_get("co", co)
    still = np.allclose(c.matrix_world, np.eye(4), rtol=0, atol=1e-6)
    return still and spline.use_cyclic_u == path.closed and np.array_equal(co, _points(path, mm_per_unit))


def _points(path, mm_per_unit):
    co = np.ones((len(path), 4), np.float32)
    co[:, :3] = path.centres / mm_per_unit
    return co.ravel()
