"""A coarse mesh as the round surface that it stands for, without Blender.

Each edge becomes a cubic curve and each triangle a cubic patch through its corners, perpendicular to the mean normals
there: curved PN triangles (A. Vlachos and others, 2001), with the handles of circular arcs. An edge that stays sharp is
curved in both of its faces' tangent planes, so that a cylinder's rim becomes a circle.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

# Edges between facets that differ by more stay sharp: Blender's torus has 30°, the corner of a chamfered block 35°.
SHARP = np.radians(32)
LEVEL = np.radians(0.5)  # triangles that differ by less are of one facet
SMALL = 1 / 4  # of its largest neighbour: a smaller facet has no say about the normal, so a bevel begins at a flat face
MOST = 1_000_000  # triangles of the result; a mesh of more than a quarter stays unchanged
FINEST = 32  # pieces of an edge


class _Edges(NamedTuple):
    """Each edge once. `of` (F, 3): the edge from each corner of a triangle to the next. `sides` (E, 2): its two
    half-edges, numbers of corners, or -1 unless it has exactly two, of opposite directions."""

    of: np.ndarray
    ends: np.ndarray
    sides: np.ndarray


def rounded(vertices: np.ndarray, triangles: np.ndarray, deviation: float) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (n, 3) and triangles of the round surface, in facets that deviate from it by about `deviation` at most,
    or as many as MOST allows. A mesh without round parts, such as a cube, keeps its shape."""
    co, tri = np.asarray(vertices, float), np.asarray(triangles)
    if 4 * len(tri) <= MOST:
        co, tri = _welded(co, tri)
    if len(tri) == 0 or 4 * len(tri) > MOST:
        return co, tri.astype(np.int32)
    faces, edges = _normals(co, tri), _edges(tri)
    smooth = _bends_less(SHARP, faces, edges)
    handles = _handles(co, tri, edges, smooth, _corner_normals(co, tri, faces, edges, smooth))
    pieces = _pieces(co, edges.ends, handles, len(tri), deviation)
    return _divided(co, tri, edges, handles, pieces)


def _welded(co, tri):
    """Vertices at one place become one; triangles with two corners there vanish."""
    co, index = np.unique(co, axis=0, return_inverse=True)
    tri = index.reshape(-1)[tri]
    return co, tri[(tri != np.roll(tri, 1, axis=1)).all(axis=1)]


def _unit(v):
    size = np.linalg.norm(v, axis=-1, keepdims=True)
    return np.divide(v, size, out=np.zeros_like(v), where=size > 0)


def _normals(co, tri):
    a, b, c = (co[tri[:, k]] for k in range(3))
    return _unit(np.cross(b - a, c - a))


def _edges(tri):
    first, second = tri.ravel(), np.roll(tri, -1, axis=1).ravel()
    pairs = np.sort(np.column_stack([first, second]), axis=1)
    ends, of, counts = np.unique(pairs, axis=0, return_inverse=True, return_counts=True)
    of = of.reshape(-1)
    order = np.argsort(of, kind="stable")
    begin = np.cumsum(counts) - counts
    two = counts == 2
    sides = np.full((len(ends), 2), -1)
    sides[two] = np.column_stack([order[begin[two]], order[begin[two] + 1]])
    turned = two & (first[sides[:, 0]] == first[sides[:, 1]])  # faces that do not agree about their outside
    sides[turned] = -1
    return _Edges(of.reshape(-1, 3), ends, sides)


def _bends_less(angle, faces, edges):
    """Whether each edge has two faces, and bends by no more than `angle`."""
    own, other = (faces[edges.sides[:, k] // 3] for k in range(2))
    return (edges.sides[:, 0] >= 0) & (np.einsum("ec,ec->e", own, other) >= np.cos(angle))


def _sizes(co, tri, faces, edges):
    """(F,): the area of the facet that each triangle belongs to."""
    level = edges.sides[_bends_less(LEVEL, faces, edges)] // 3
    a, b, c = (co[tri[:, k]] for k in range(3))
    facet = _groups(len(tri), level)
    return np.bincount(facet, np.linalg.norm(np.cross(b - a, c - a), axis=1), len(tri))[facet]


def _next(corners):
    return corners - corners % 3 + (corners + 1) % 3


def _corner_normals(co, tri, faces, edges, smooth):
    """(3F, 3): at each corner of a triangle, the mean normal of the triangles around it as far as the next sharp edges,
    weighted by their angles; of facets that are not SMALL."""
    a, b = edges.sides[smooth].T
    pairs = np.concatenate([np.column_stack([a, _next(b)]), np.column_stack([_next(a), b])])
    group = _groups(3 * len(tri), pairs)
    along, back = (_unit(co[np.roll(tri, -k, axis=1)] - co[tri]) for k in (1, 2))
    angles = np.arccos(np.clip(np.einsum("fkc,fkc->fk", along, back), -1, 1)).ravel()
    own, size = np.repeat(faces, 3, axis=0), np.repeat(_sizes(co, tri, faces, edges), 3)
    largest = np.zeros(len(own))
    np.maximum.at(largest, group, size)
    angles *= size >= SMALL * largest[group]
    total = np.column_stack([np.bincount(group, angles * own[:, k], len(own)) for k in range(3)])
    mean = _unit(total)[group]
    return np.where(mean.any(axis=1, keepdims=True), mean, own)


def _groups(count, pairs):
    """The least member of each one's group, where the members of a pair are of one group."""
    group = np.arange(count)
    while True:
        least = group[pairs].min(axis=1)
        before = group.copy()
        for k in range(2):
            np.minimum.at(group, pairs[:, k], least)
        group = group[group]
        if np.array_equal(group, before):
            return group


def _handles(co, tri, edges, smooth, normals):
    """(E, 2, 3): the inner control points of each edge's curve, near its first and its second end."""
    begins = tri.ravel()
    out = np.empty((len(edges.ends), 2, 3))
    known = edges.sides[:, 0] >= 0
    for k in range(2):
        here, there = co[edges.ends[:, k]], co[edges.ends[:, 1 - k]]
        chord = there - here
        # the corners of both faces at this end
        corners = np.where(begins[edges.sides] == edges.ends[:, [k]], edges.sides, _next(edges.sides))
        one, other = normals[corners[:, 0]], normals[corners[:, 1]]
        across = np.cross(one, other)
        bend = np.linalg.norm(across, axis=1)
        flat = chord - np.einsum("ec,ec->e", chord, one)[:, None] * one
        seam = _unit(across) * np.einsum("ec,ec->e", chord, _unit(across))[:, None]
        way = np.where((smooth | (bend < 0.1))[:, None], flat, seam)
        straight = ~known | (~smooth & (bend < 0.1) & (np.einsum("ec,ec->e", one, other) < 0))
        out[:, k] = here + _arc(chord, np.where(straight[:, None], chord, way))
    return out


def _arc(chord, way):
    """The handle along `way`, the chord's projection, of a circular arc over the chord; of a third of the chord where
    it would leave the chord by more than 60°."""
    size = np.linalg.norm(chord, axis=1, keepdims=True)
    cosine = np.linalg.norm(way, axis=1, keepdims=True) / size
    return np.where(cosine > 0.5, _unit(way) * size * (2 / 3) / (1 + cosine), chord / 3)


def _pieces(co, ends, handles, count, deviation):
    """Into how many pieces each edge is divided."""
    a, b = co[ends[:, 0]], co[ends[:, 1]]
    off = max(np.linalg.norm(handles[:, k] - (2 * p + q) / 3, axis=1).max() for k, p, q in ((0, a, b), (1, b, a)))
    wanted = np.ceil(np.sqrt(0.75 * off / deviation))
    return int(max(1, min(wanted, FINEST, np.sqrt(MOST / count))))


def _divided(co, tri, edges, handles, n):
    """Vertices and triangles, each edge in `n` pieces."""
    inner, count = [p for p in _grid(n) if min(p) > 0], len(tri)
    shares = (np.arange(1, n) / n)[None, :, None]
    a, b = (co[edges.ends[:, k]][:, None] for k in range(2))
    near, far = (handles[:, k][:, None] for k in range(2))
    rest = 1 - shares
    on_edges = rest**3 * a + 3 * rest**2 * shares * near + 3 * rest * shares**2 * far + shares**3 * b
    corners, forward = co[tri], edges.ends[edges.of, 0] == tri
    first = np.where(forward[:, :, None], handles[edges.of, 0], handles[edges.of, 1])  # near the edge's own corner
    second = np.where(forward[:, :, None], handles[edges.of, 1], handles[edges.of, 0])
    middle = (first + second).sum(axis=1) / 6
    middle = middle + 0.5 * (middle - corners.mean(axis=1))
    within = np.empty((count, len(inner), 3))
    for k, place in enumerate(inner):
        u = np.array(place) / n
        v = np.roll(u, -1)
        within[:, k] = (
            np.einsum("k,fkc->fc", u**3, corners)
            + 3 * np.einsum("k,fkc->fc", u**2 * v, first)
            + 3 * np.einsum("k,fkc->fc", u * v**2, second)
            + 6 * u.prod() * middle
        )
    at = {}  # the vertices at each place of the grid, one of each triangle
    for k, place in enumerate(inner):
        at[place] = len(co) + on_edges.shape[0] * (n - 1) + np.arange(count) * len(inner) + k
    for k in range(3):
        at[tuple(n if j == k else 0 for j in range(3))] = tri[:, k]
        for step in range(1, n):
            place = [0, 0, 0]
            place[k], place[(k + 1) % 3] = n - step, step
            along = np.where(forward[:, k], step, n - step) - 1
            at[tuple(place)] = len(co) + edges.of[:, k] * (n - 1) + along
    made = [np.column_stack([at[p] for p in corner]) for corner in _cells(n)]
    vertices = np.concatenate([co, on_edges.reshape(-1, 3), within.reshape(-1, 3)])
    return vertices, np.concatenate(made).astype(np.int32)


def _grid(n):
    """Places in a triangle: thirds of weights that add up to `n`."""
    return [(i, j, n - i - j) for i in range(n + 1) for j in range(n + 1 - i)]


def _cells(n):
    """Triples of places, in the triangle's own direction."""
    for i, j, k in _grid(n):
        if i:
            yield (i, j, k), (i - 1, j + 1, k), (i - 1, j, k + 1)
        if i and j:
            yield (i, j, k), (i - 1, j, k + 1), (i, j - 1, k + 1)
