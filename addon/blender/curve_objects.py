"""Curve objects as splines in the stock's frame."""

import numpy as np

from ..common import poses
from ..common.splines import Spline


def splines(curve, depsgraph, to_stock):
    """The splines of a curve object from its control points (without modifiers and shape keys), mapped by `to_stock`
    (4, 4): from the object's Blender units to millimetres in the stock's frame. Hidden splines are left out. Without a
    `depsgraph` the points are those of the curve itself, in Edit Mode the edited ones."""
    out = []
    for s in (curve if depsgraph is None else curve.evaluated_get(depsgraph)).data.splines:
        if s.hide:
            continue
        if s.type == "BEZIER":
            points = s.bezier_points
            out.append(
                Spline(
                    "BEZIER",
                    poses.transform_points(to_stock, _column(points, "co", 3)),
                    s.use_cyclic_u,
                    _column(points, "tilt"),
                    left=poses.transform_points(to_stock, _column(points, "handle_left", 3)),
                    right=poses.transform_points(to_stock, _column(points, "handle_right", 3)),
                )
            )
            continue
        if s.point_count_v > 1:
            raise ValueError(f"{curve.name} is a surface, not a curve")
        co = _column(s.points, "co", 4)
        out.append(
            Spline(
                s.type,
                poses.transform_points(to_stock, co[:, :3]),
                s.use_cyclic_u,
                _column(s.points, "tilt"),
                weights=co[:, 3],
                order=s.order_u,
                endpoint=s.use_endpoint_u,
                bezier=s.use_bezier_u,
            )
        )
    return out


def deformed(curve):
    """True if the visible curve differs from its control points."""
    return bool(curve.data.shape_keys) or any(m.show_viewport for m in curve.modifiers)


def _column(points, name, width=1):
    values = np.empty(len(points) * width, np.float32)
    points.foreach_get(name, values)
    values = values.astype(np.float64)
    return values.reshape(-1, width) if width > 1 else values
