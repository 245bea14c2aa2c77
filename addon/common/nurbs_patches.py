"""Blender's NURBS surfaces as patches of riffler.Surface. Their evaluation is that of splines.py in both directions."""

from __future__ import annotations

import numpy as np
import riffler

from . import splines


def patch(points: np.ndarray, net: np.ndarray, ends):
    """A function that makes the riffler.Surface of one spline; called with True, one with its normals reversed.

    `points`: (nu · nv, 3) mm, v fastest; `net`: (nu, nv, 4), of which the last column has the weights; `ends`: (order,
    cyclic, endpoint, bezier) of u and v. ValueError if Blender shows no surface for it.
    """
    nu, nv, _ = net.shape
    if not np.isfinite(points).all():
        raise ValueError("the surface has a point that is not finite")
    weights = net[..., 3]
    if not (weights > 0).all():
        raise ValueError("a NURBS point has a weight that is not positive")
    knots, degrees, rows = [], [], []
    for count, (order, cyclic, endpoint, bezier), letter in zip((nu, nv), ends, "UV", strict=True):
        odd = bezier and cyclic and count % (order - 1)
        short = bezier and not endpoint and not cyclic and count <= order
        if count < order or odd or short:
            raise ValueError(f"it needs more points in {letter} for its order: choose a smaller Order {letter}")
        knots.append(splines.knots(count, order, cyclic, endpoint, bezier))
        degrees.append(order - 1)
        rows.append(np.arange(count + (order - 1 if cyclic else 0)) % count)
    points = points.reshape(nu, nv, 3)[rows[0]][:, rows[1]]
    weights = weights[rows[0]][:, rows[1]]

    def make(reverse: bool = False) -> riffler.Surface:
        along_u, p, w = knots[0], points, weights
        if reverse:
            along_u, p, w = along_u[0] + along_u[-1] - along_u[::-1], p[::-1], w[::-1]
        return riffler.Surface.nurbs(p, w, along_u, knots[1], *degrees)

    return make
