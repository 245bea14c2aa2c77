"""Exact surfaces of CAD files: the faces as NURBS patches with their borders, each in its places in the assembly."""

from __future__ import annotations

from typing import Any

import numpy as np

from .._core import FormatError, Surface


def surface_of(
    answer: dict[str, Any], arrays: dict[str, np.ndarray], name: str, place: np.ndarray | None = None
) -> Surface:
    """Makes the surface from the reader's answer: a copy of every prototype's faces in each of its places. ``place``
    (4, 4): an affine map of the whole, which may scale and mirror it."""
    made = [_patches(arrays, k, p["patches"]) for k, p in enumerate(answer["prototypes"])]
    patches = []
    whole = np.eye(4) if place is None else np.asarray(place, float)
    for instance in answer["instances"]:
        matrix = whole[:3] @ np.vstack([np.array(instance["matrix"], float), [0.0, 0.0, 0.0, 1.0]])
        patches += [_placed(patch, matrix) for patch in made[instance["prototype"]]]
    if not patches:
        raise FormatError(f"{name}: none of its faces has an area; export it again, as AP214 or AP242")
    return Surface(patches)


def _patches(arrays: dict[str, np.ndarray], k: int, records: list[dict[str, Any]]) -> list[dict[str, Any]]:
    points, knots, trims = arrays[f"nets{k}"], arrays[f"knots{k}"], arrays[f"trims{k}"]
    at_point = at_knot = at_trim = 0
    found = []
    for record in records:
        nu, nv = record["counts"]
        net = points[at_point : at_point + nu * nv].reshape(nu, nv, 4)
        at_point += nu * nv
        both = []
        for n, degree in zip((nu, nv), record["degrees"], strict=True):
            both.append(knots[at_knot : at_knot + n + degree + 1])
            at_knot += n + degree + 1
        loops = []
        for length in record["loops"]:
            loops.append(trims[at_trim : at_trim + length])
            at_trim += length
        if loops and sum(abs(_area(loop)) for loop in loops) > 0:
            found.append(record | {"net": net, "knots": both, "trims": loops})
    return found


def _area(loop: np.ndarray) -> float:
    u, v = (loop - loop[0]).T
    return 0.5 * float(u @ np.roll(v, -1) - v @ np.roll(u, -1))


def _placed(patch: dict[str, Any], matrix: np.ndarray) -> Surface:
    """A patch in its place, with normals out of the material: u is reversed where the face or the place turns them."""
    net, (knots_u, knots_v), trims = patch["net"], patch["knots"], patch["trims"]
    if patch["reversed"] != (np.linalg.det(matrix[:, :3]) < 0):
        ends = knots_u[patch["degrees"][0]] + knots_u[patch["counts"][0]]
        net, knots_u = net[::-1], ends - knots_u[::-1]
        low, high = knots_u[patch["degrees"][0]], knots_u[patch["counts"][0]]
        trims = [np.column_stack([np.clip(ends - loop[:, 0], low, high), loop[:, 1]]) for loop in trims]
    points = net[..., :3] @ matrix[:, :3].T + matrix[:, 3]
    return Surface.nurbs(points, net[..., 3], knots_u, knots_v, *patch["degrees"], trims=trims, name=patch["name"])
