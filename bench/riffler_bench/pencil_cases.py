"""Meshes of parts whose pencil curves are known, turned at random, and what is measured of the paths found on them."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np
from riffler import Mesh, Tool, plan

from . import valleys
from .curves import Segments
from .remesh import WAYS, mesh

TOLERANCE = 0.01
TOOL = Tool.ball(2 * valleys.R, 30)


@dataclass(frozen=True)
class Case:
    """One mesh of a part, turned and moved, with its curves. `facets`: how far chords can move a centre, mm; `tilt`:
    how far a facet's normal can be from the surface's, rad."""

    part: valleys.Part
    way: str
    mesh: Mesh
    true: list[valleys.Curve]
    facets: float
    tilt: float
    moved: float

    @property
    def limit(self) -> float:
        return TOLERANCE + self.facets

    @property
    def lines(self) -> Segments:
        return Segments.of([c.centres for c in self.true], [c.closed for c in self.true])


def turned(rng: np.random.Generator) -> np.ndarray:
    """A rotation at random: the orthogonal part of a matrix of normal numbers."""
    q, r = np.linalg.qr(rng.normal(size=(3, 3)))
    q *= np.sign(np.diag(r))
    return q if np.linalg.det(q) > 0 else -q


def case(part: valleys.Part, way: str, seed: int, moved: float = 0.0, upright: bool = False) -> Case:
    rng = np.random.default_rng(seed)
    upon, _, spanned = mesh(part.surface, way, rng)
    turn = np.eye(3) if upright else turned(rng)
    shift = moved * np.array([1.0, -0.7, 0.4])
    placed = Mesh(np.asarray(upon.vertices) @ turn.T + shift, upon.triangles)
    angle = 2 * pi * spanned if part.bent else 0.0
    facets = part.lever * part.bent * (1 - np.cos(angle / 2))
    return Case(part, way, placed, [c.placed(turn, shift) for c in part.curves], float(facets), angle, moved)


def cases(part: valleys.Part, seed: int, quick: bool) -> list[Case]:
    if quick:
        return [case(part, "needles" if seed % 2 else "coarse", seed)]
    found = [case(part, way, 10 * seed + k) for k, way in enumerate(WAYS)]
    return [*found, case(part, "fine", 10 * seed + 3, moved=1e4)]


def lines_of(paths) -> Segments:
    return Segments.of([np.asarray(p.centres) for p in paths], [bool(p.closed) for p in paths])


def digest(paths) -> str:
    whole = hashlib.sha256()
    for p in paths:
        for array in (p.centres, p.contacts, p.normals):
            whole.update(np.ascontiguousarray(array).tobytes())
        whole.update(bytes([bool(p.closed)]))
    return whole.hexdigest()


def contacts(paths, true: list[valleys.Curve]) -> dict[str, float]:
    """The farthest that a contact is from that of the true curve, sides kept along each path, and the largest angle
    between a normal and the direction from contact to centre."""
    apart, angle = 0.0, 0.0
    every = [Segments.of([c.centres], [c.closed]) for c in true]
    for p in paths:
        centres, touched, normals = (np.asarray(x) for x in (p.centres, p.contacts, p.normals))
        # The curve that most of the path is nearest to: at a corner three are near.
        means = [segments.nearest(centres)[0].mean() for segments in every]
        k = int(np.argmin(means))
        _, which, share = every[k].nearest(centres)
        ends = true[k].contacts
        there = ends[which] + share[:, None, None] * (ends[(which + 1) % len(ends)] - ends[which])
        apart = max(apart, min(np.linalg.norm(touched - x, axis=2).max() for x in (there, there[:, ::-1])))
        away = centres[:, None] - touched
        away /= np.linalg.norm(away, axis=2)[..., None]
        angle = max(angle, np.arctan2(np.linalg.norm(np.cross(away, normals), axis=2), (away * normals).sum(2)).max())
    return {"contacts_mm": float(apart), "normals_degrees": float(np.degrees(angle))}


def picture(part: valleys.Part) -> dict[str, Any]:
    """What the plot shows: the coarse part as it stands, its curves, and the paths found on it."""
    c = case(part, "coarse", 0, upright=True)
    paths = plan.pencil(c.mesh, TOOL, tolerance=TOLERANCE)
    return {
        "view": part.view,
        "vertices": np.round(c.mesh.vertices, 4).tolist(),
        "triangles": np.asarray(c.mesh.triangles).tolist(),
        "true": [thinned(t.centres, t.closed) for t in c.true],
        "found": [thinned(np.asarray(p.centres), p.closed) for p in paths],
    }


def thinned(points: np.ndarray, closed: bool) -> list[list[float]]:
    every = max(1, len(points) // 100)
    kept = [*points[::every], points[0] if closed else points[-1]]
    return np.round(kept, 4).tolist()
