"""Pencil paths on an exact surface: moves the ball's centres, which were found on triangles, until both its contacts
lie on the surface."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .._core import PencilPath, Surface
from .operations import ExactFit

ROUNDS = 60
CONVERGED = 1e-9  # mm, along the normals
ALONG = 1e-6  # mm, along the surface: an error of the distance is the square of it
INNER = 0.5  # of the radius: a point so far towards a contact is nearer to its face than to the other
TURNED = 0.5  # rad between the normals of triangle and surface at a contact: more is another face
PARALLEL = 1e-3  # 1 - the cosine between both normals: less is one contact
HALVINGS = 10
EXPLAINED = 3.0  # factor on the deviation of the triangles


@dataclass(frozen=True)
class PathFit:
    """Counts and distances (mm) of a fit, as in `ExactFit`."""

    fitted: int
    inserted: int
    kept: int
    before: float
    after: float


@dataclass
class _Places:
    centres: NDArray[np.float64]
    contacts: NDArray[np.float64]
    normals: NDArray[np.float64]
    good: NDArray[np.bool_]
    before: NDArray[np.float64]
    after: NDArray[np.float64]


def _unfitted(centres: NDArray[np.float64], contacts: NDArray[np.float64], normals: NDArray[np.float64]) -> _Places:
    n = len(centres)
    return _Places(centres, contacts, normals, np.zeros(n, np.bool_), np.zeros(n), np.zeros(n))


def fit_path(path: PencilPath, exact: Surface, deviation: float, tolerance: float) -> tuple[PencilPath, PathFit]:
    """The path with its centres one radius from both exact faces, and points inserted where the middle of a chord is
    more than half of ``tolerance`` from its place. Points without such a place nearby stay where they are."""
    limit = EXPLAINED * deviation + tolerance
    start = _unfitted(path.centres, path.contacts, path.normals)
    found = _fit(start, path.radius, exact, limit)
    before, inserted = float(found.before[found.good].max(initial=0.0)), 0
    ends = np.arange(len(found.centres) - (not path.closed))  # segments that may need a middle
    for _ in range(HALVINGS):
        following = (ends + 1) % len(found.centres)
        middles = _unfitted(*(0.5 * (rows[ends] + rows[following]) for rows in _rows(found)))
        middles.normals /= np.maximum(np.linalg.norm(middles.normals, axis=-1, keepdims=True), 1e-300)
        exact_middles = _fit(middles, path.radius, exact, limit)
        off = np.linalg.norm(exact_middles.centres - middles.centres, axis=1)
        wanted = np.flatnonzero(exact_middles.good & (off > 0.5 * tolerance) & found.good[ends] & found.good[following])
        if not len(wanted):
            break
        at = ends[wanted] + 1
        for name in ("centres", "contacts", "normals", "good", "before", "after"):
            setattr(found, name, np.insert(getattr(found, name), at, getattr(exact_middles, name)[wanted], axis=0))
        inserted += len(wanted)
        new = at + np.arange(len(at))
        ends = np.sort(np.concatenate([new - 1, new]))
    out = PencilPath(path.radius, *_rows(found), closed=path.closed)
    after = float(found.after[found.good].max(initial=0.0))
    return out, PathFit(int(found.good.sum()), inserted, int((~found.good).sum()), before, after)


def total_fit(fits: list[PathFit], raised: int = 0) -> ExactFit:
    """The sum of the fits of several paths."""
    return ExactFit(
        fitted=sum(fit.fitted for fit in fits),
        inserted=sum(fit.inserted for fit in fits),
        raised=raised,
        kept=sum(fit.kept for fit in fits),
        before=max((fit.before for fit in fits), default=0.0),
        after=max((fit.after for fit in fits), default=0.0),
        kept_depth=0.0,
    )


def _rows(places: _Places) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    return places.centres, places.contacts, places.normals


def _fit(start: _Places, radius: float, exact: Surface, limit: float) -> _Places:
    """Newton's method: in each round both faces are planes through the nearest points of the contacts."""
    n = len(start.centres)
    centres, contacts = start.centres.copy(), start.contacts
    gap = abs(np.linalg.norm(centres[:, None] - contacts, axis=2) - radius)
    active = gap <= limit
    if not n:
        return start
    first = np.zeros((n, 2))
    missing = feet = normals = np.zeros(0)
    for k in range(ROUNDS):
        inner = centres[:, None] + INNER * (contacts - centres[:, None])
        feet, normals = (a.reshape(n, 2, 3) for a in exact.closest(inner.reshape(-1, 3))[:2])
        missing = np.where(active, radius - np.einsum("nij,nij->ni", centres[:, None] - feet, normals), 0.0)
        first = missing if k == 0 else first
        step = _step(missing, normals, active)
        centres += step
        contacts = centres[:, None] - radius * normals
        if abs(step).max() < CONVERGED and abs(contacts - feet)[active].max(initial=0.0) < ALONG:
            break
    residual = abs(missing).max(axis=1)
    far = np.linalg.norm(np.where(active[..., None], contacts - feet, 0.0), axis=2).max(axis=1)
    turned = np.einsum("nij,nij->ni", normals, start.normals) < np.cos(TURNED)
    moved = np.linalg.norm(centres - start.centres, axis=1)
    free = exact.closest(centres)[2] >= radius - 1e-6
    good = active.any(1) & ~(turned & active).any(1) & (residual < 1e-6) & (far < 1e-5) & (moved < 8 * limit) & free
    return _Places(
        np.where(good[:, None], centres, start.centres),
        np.where(good[:, None, None], np.where(active[..., None], feet, start.contacts), start.contacts),
        np.where(good[:, None, None], np.where(active[..., None], normals, start.normals), start.normals),
        good,
        abs(first).max(axis=1),
        residual,
    )


def _step(missing: NDArray[np.float64], normals: NDArray[np.float64], active: NDArray[np.bool_]) -> NDArray[np.float64]:
    """The shortest step of each centre that moves it by ``missing`` along each active normal."""
    cosine = np.einsum("nj,nj->n", normals[:, 0], normals[:, 1])
    both = active.all(1) & (1 - abs(cosine) > PARALLEL)
    det = np.where(both, 1 - cosine**2, 1.0)
    a = np.where(both, (missing[:, 0] - cosine * missing[:, 1]) / det, 0.0)
    b = np.where(both, (missing[:, 1] - cosine * missing[:, 0]) / det, 0.0)
    weight = np.where(both[:, None], np.stack([a, b], 1), missing / np.maximum(active.sum(1), 1)[:, None])
    return np.einsum("ni,nij->nj", weight, normals)
