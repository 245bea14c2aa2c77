"""A ball led along a torus, exact or in triangles: times of queries, and errors against the closed form."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
from riffler import Collider, Surface, Tool

RING, TUBE, RADIUS = 20.0, 5.0, 3.0  # mm: torus and ball
DEPTH = 0.1  # mm


def torus() -> Surface:
    """A torus about z as one rational patch; its normals point outwards."""
    corner = np.array([[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]], float)
    weight = np.where(np.arange(9) % 2, 0.5**0.5, 1.0)
    knots = np.array([0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4], float)
    radius = RING + TUBE * corner[:, 0]
    points = np.empty((9, 9, 3))
    points[..., 0], points[..., 1] = corner[:, :1] * radius, corner[:, 1:] * radius
    points[..., 2] = TUBE * corner[:, 1]
    return Surface.nurbs(points, np.outer(weight, weight), knots, knots, 2, 2)


def poses(a: np.ndarray, b: np.ndarray, depth: float, lean: float) -> np.ndarray:
    """Poses of a ball `depth` mm deep in the torus, at the angles `a` around it and `b` around its tube."""
    ring = np.column_stack([np.cos(a), np.sin(a), np.zeros_like(a)])
    normal = np.cos(b)[:, None] * ring + np.sin(b)[:, None] * [0, 0, 1]
    axis = normal + lean * np.column_stack([-np.sin(a), np.cos(a), np.full_like(a, 0.3)])
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    return np.column_stack([RING * ring + (TUBE + RADIUS - depth) * normal - RADIUS * axis, axis])


def measured(tolerance: float | None, count: int) -> dict[str, Any]:
    """Measures one surface, in a process of its own. `tolerance`: of triangles, mm; None: the exact surface."""
    surface = torus()
    part = surface if tolerance is None else surface.to_mesh(tolerance)
    start = time.process_time()
    collider = Collider(part)
    built, tool = time.process_time() - start, Tool.ball(2 * RADIUS, 30)
    a = np.linspace(0.2, 6.0, count)
    where = poses(a, 0.3 + 0.4 * np.sin(a), DEPTH, 0.2)
    collider.query(tool, where[0])
    depths, times = [], []
    for pose in where:
        spent = []
        for _ in range(3):
            start = time.thread_time()
            contact = collider.query(tool, pose)
            spent.append(time.thread_time() - start)
        depths.append(contact.depth), times.append(sorted(spent)[1])
    along = poses(0.8 + 1e-3 * np.arange(200), np.full(200, 0.3), DEPTH, 0.0)
    force = np.array([np.linalg.norm(collider.query(tool, pose).force) for pose in along])
    off = collider.clearance(tool, poses(a, 0.3 + 0.4 * np.sin(a), -0.05, 0.0)) - 0.05
    return {
        "triangles": 0 if tolerance is None else len(part.triangles),
        "build_s": built,
        "mean_s": float(np.mean(times)),
        "p99_s": float(np.quantile(times, 0.99)),
        "depth_mm": float(abs(np.array(depths) - DEPTH).max()),
        "ripple": float((force.max() - force.min()) / (force.max() + force.min())),
        "cl_mm": float(abs(off).max()),
    }
