"""Our splines compared with Blender's own tessellation."""

import bpy
import numpy as np

from support import common

RNG = np.random.default_rng(7)


def blender_points(ob, resolution=64):
    ob.data.resolution_u = resolution
    bpy.context.view_layer.update()
    evaluated = ob.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    points = common.coordinates(mesh).astype(float)
    evaluated.to_mesh_clear()
    return points


def ours(ob, tolerance):
    read = common.part("blender.curve_objects").splines
    curves = common.part("common.splines")
    splines = read(ob, bpy.context.evaluated_depsgraph_get(), np.eye(4))
    return np.vstack([curves.evaluate(s, tolerance)[0] for s in splines])


def distance(points, polyline):
    """Largest distance of points to a polyline."""
    a, b = polyline[:-1], polyline[1:]
    d = b - a
    t = ((points[:, None] - a) * d).sum(2) / np.maximum((d * d).sum(1), 1e-30)
    near = a + np.clip(t, 0, 1)[..., None] * d
    return np.linalg.norm(points[:, None] - near, axis=2).min(axis=1).max()


def test_nurbs_of_every_kind_agree_with_blenders():
    for cyclic in (False, True):
        for endpoint in (False, True):
            for bezier in (False, True):
                for order in (3, 4):
                    count = 4 * (order - 1) + (0 if cyclic else 1)
                    points = RNG.uniform(-10, 10, (count, 3))
                    ob = common.curve("N", points, mm_per_unit=1, kind="NURBS", cyclic=cyclic)
                    spline = ob.data.splines[0]
                    spline.order_u = order
                    spline.use_endpoint_u, spline.use_bezier_u = endpoint, bezier
                    for p in spline.points:
                        p.co[3] = RNG.uniform(0.5, 2)
                    theirs = blender_points(ob)
                    what = (cyclic, endpoint, bezier, order)
                    assert len(theirs) > 10, what
                    line = ours(ob, 1e-3)
                    assert distance(theirs, line) < 2e-3, (what, distance(theirs, line))
                    # and none of ours is beyond theirs (chords of Blender's are coarser)
                    closed = np.vstack([theirs, theirs[:1]]) if cyclic else theirs
                    assert distance(line, closed) < 0.2, (what, distance(line, closed))


def test_bezier_splines_agree_with_blenders():
    for cyclic in (False, True):
        data = bpy.data.curves.new("B", "CURVE")
        data.dimensions = "3D"
        spline = data.splines.new("BEZIER")
        spline.bezier_points.add(3)
        for p in spline.bezier_points:
            p.co, p.handle_left, p.handle_right = (RNG.uniform(-10, 10, 3) for _ in range(3))
        spline.use_cyclic_u = cyclic
        ob = bpy.data.objects.new("B", data)
        bpy.context.collection.objects.link(ob)
        theirs = blender_points(ob)
        line = ours(ob, 1e-3)
        assert distance(theirs, line) < 2e-3
        closed = np.vstack([theirs, theirs[:1]]) if cyclic else theirs
        assert distance(line, closed) < 0.05


def test_nurbs_that_are_no_curve_are_their_control_polygon():
    for count, cyclic, bezier in ((7, True, True), (4, False, True), (3, False, False), (2, False, False)):
        ob = common.curve("N", RNG.uniform(-10, 10, (count, 3)), mm_per_unit=1, kind="NURBS", cyclic=cyclic)
        ob.data.splines[0].order_u = 4
        ob.data.splines[0].use_bezier_u = bezier
        theirs, line = blender_points(ob), ours(ob, 1e-3)
        assert distance(theirs, line) < 2e-3, (count, cyclic, bezier)
        assert bezier == (len(line) == count + cyclic), (count, len(line))
