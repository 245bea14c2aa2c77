"""What is seen of a plan: one curve object for each path, along the ball's centres. They are a picture of the plan that
can be selected; edits to them change nothing."""

import bpy
import numpy as np

from . import plan_store


def show(ob, plan, mm_per_unit):
    """Makes the plan's curves anew, as children of its Empty and beside it."""
    hide(ob)
    home = ob.users_collection[0]
    for k, path in enumerate(plan.paths):
        curve = bpy.data.curves.new(name_of(k, path), "CURVE")
        curve.dimensions = "3D"
        spline = curve.splines.new("POLY")
        spline.points.add(len(path) - 1)
        spline.points.foreach_set("co", _points(path, mm_per_unit))
        spline.use_cyclic_u = path.closed
        shown = bpy.data.objects.new(curve.name, curve)
        shown.riffler.plan.path = k
        shown.parent = ob
        plan_store.lock(shown)
        home.objects.link(shown)


def hide(ob):
    """Takes the curves away."""
    curves = [c.data for c in of(ob)]
    bpy.data.batch_remove([*of(ob), *[c for c in curves if c.users <= 1]])


def of(ob):
    """The plan's curve objects by the number of their path; copies that a person made are among them."""
    found = [c for c in ob.children if c.type == "CURVE" and c.riffler.plan.path >= 0]
    return sorted(found, key=lambda c: c.riffler.plan.path)


def name_of(k, path):
    """The number is in front, so that lists have them in the plan's order."""
    return f"Path {k + 1}: {path.length:.1f} mm"


def edited(ob, plan, mm_per_unit):
    """How many of the paths are not shown as they are: their curve was edited, moved, or is gone."""
    right = set()
    for c in of(ob):
        k = c.riffler.plan.path
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
