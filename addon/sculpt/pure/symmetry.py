"""Copies of a stroke: mirrored in planes, rotated about an axis. A tool of revolution is its own mirror image, so a
copy of a pose is a pose. A hand tool may need its mirror image (common/hand_tools.py)."""

from __future__ import annotations

import numpy as np


def maps(mirror: str = "", axis: str = "Z", count: int = 1) -> list[np.ndarray]:
    """(3, 3) orthogonal maps, the identity first: all products of mirrors in the planes x = 0, y = 0, z = 0 of the
    letters in `mirror` and of `count` rotations about `axis`. Without duplicates."""
    if count < 1:
        raise ValueError("count must be at least 1")
    if set(mirror) - set("XYZ") or axis not in ("X", "Y", "Z"):
        raise ValueError("mirror takes letters of X, Y, Z, axis one of them")
    found = [turned(axis, 2 * np.pi * k / count) for k in range(count)]
    for letter in sorted(set(mirror)):
        sides = np.ones(3)
        sides["XYZ".index(letter)] = -1
        found += [np.diag(sides) @ m for m in found]
    kept: list[np.ndarray] = []
    for m in found:
        if not any(np.allclose(m, other, atol=1e-9) for other in kept):
            kept.append(m)
    return kept


def turned(axis: str, angle: float) -> np.ndarray:
    i = "XYZ".index(axis)
    j, k = (i + 1) % 3, (i + 2) % 3
    m = np.eye(3)
    m[j, j] = m[k, k] = np.cos(angle)
    m[k, j], m[j, k] = np.sin(angle), -np.sin(angle)
    return m


def copies(poses: np.ndarray, about: list[np.ndarray], origin, symmetric=True) -> list[tuple[np.ndarray, bool]]:
    """The poses, (n, 6) or (n, 9), under each of the maps about `origin` (3,), mm, and whether the map mirrors. A copy
    equal to an earlier one is left out: a stroke in the mirror's plane is cut once. `symmetric`: the tool is its own
    mirror image."""
    origin = np.asarray(origin, float)
    near = 1e-6 * (1.0 + np.abs(poses[:, :3]).max(initial=0.0))
    kept: list[tuple[np.ndarray, bool]] = []
    for m in about:
        turned = [poses[:, k : k + 3] @ m.T for k in range(3, poses.shape[1], 3)]
        copy, mirrors = np.hstack([(poses[:, :3] - origin) @ m.T + origin, *turned]), bool(np.linalg.det(m) < 0)
        others = (other for other, its in kept if symmetric or its == mirrors)
        if not any(np.abs(copy - other).max(initial=0.0) < near for other in others):
            kept.append((copy, mirrors))
    return kept


def outlines(mirror, count: int, axis: str, box, middle) -> list[tuple[np.ndarray, str, bool]]:
    """Symmetry elements within a box (`lower`, `upper`, mm): for each mirror a rectangle (4, 3), the letter of its
    normal, and True; for rotations the axis (2, 3), its letter, and False."""
    lower, upper, middle = np.asarray(box.lower, float), np.asarray(box.upper, float), np.asarray(middle, float)
    found = []
    for letter in sorted(mirror):
        i = "XYZ".index(letter)
        j, k = (i + 1) % 3, (i + 2) % 3
        corners = np.tile(middle, (4, 1))
        corners[:, j] = lower[j], upper[j], upper[j], lower[j]
        corners[:, k] = lower[k], lower[k], upper[k], upper[k]
        found.append((corners, letter, True))
    if count > 1:
        ends = np.tile(middle, (2, 1))
        i = "XYZ".index(axis)
        ends[:, i] = lower[i], upper[i]
        found.append((ends, axis, False))
    return found
