"""An order of paths in which the moves between them are short."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import PencilPath
from ..hints import hinted


@hinted("plan.order_paths")
def order_paths(paths: Sequence[PencilPath], *, start: ArrayLike | None = None) -> list[tuple[int, bool]]:
    """An order of the paths, and which are reversed, so that the moves between them are short.

    Goes from ``start`` to the nearest end of a path, and always on to the nearest end; then exchanges two moves while
    that shortens the travel. The same input gives the same order. A loop begins and ends at its first point.

    Parameters
    ----------
    paths : list of PencilPath
        The paths.
    start : array_like, shape (3,), optional
        Start of the tool, mm; None: the first path's first point.

    Returns
    -------
    list of tuple
        (number of the path, whether it is reversed), each path once.

    Examples
    --------
    >>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
    >>> paths = riffler.plan.pencil(part, riffler.Tool.ball(diameter=4, length=20), passes=2, stepover=1)
    >>> sorted(index for index, reversed in riffler.plan.order_paths(paths))
    [0, 1, 2]
    """
    if not paths:
        return []
    first = np.array([p.centres[0] for p in paths])
    last = np.array([p.centres[0 if p.closed else -1] for p in paths])
    ends = np.stack([first, last])  # [end, path]
    at = first[0] if start is None else np.asarray(start, dtype=float)
    if at.shape != (3,) or not np.isfinite(at).all():
        raise ValueError("start must be three finite numbers")
    order, left = [], np.ones(len(paths), dtype=bool)
    here = at
    for _ in paths:
        away = np.where(left, np.linalg.norm(ends - here, axis=2), np.inf)
        turned, index = np.unravel_index(np.argmin(away), away.shape)
        order.append((int(index), bool(turned)))
        left[index] = False
        here = ends[1 - turned, index]
    return _exchanged(order, ends, None if start is None else at)


def _exchanged(
    order: list[tuple[int, bool]], ends: NDArray[np.float64], start: NDArray[np.float64] | None, rounds: int = 20
) -> list[tuple[int, bool]]:
    """2-opt (Croes, Operations Research 6 (1958) 791): reverses runs of the order while that shortens the travel."""
    index = np.array([i for i, _ in order])
    turned = np.array([int(t) for _, t in order])
    n = len(index)
    for _ in range(rounds):
        better = False
        for i in range(n):
            into = ends[turned, index]
            out = ends[1 - turned, index]
            j = np.arange(i, n)
            before = out[i - 1] if i else start
            now = np.zeros(n - i) if before is None else np.full(n - i, np.linalg.norm(into[i] - before))
            then = np.zeros(n - i) if before is None else np.linalg.norm(out[j] - before, axis=1)
            now[:-1] += np.linalg.norm(into[j[:-1] + 1] - out[j[:-1]], axis=1)
            then[:-1] += np.linalg.norm(into[j[:-1] + 1] - into[i], axis=1)
            gain = now - then
            k = int(np.argmax(gain))
            if gain[k] > 1e-9:
                better = True
                index[i : i + k + 1] = index[i : i + k + 1][::-1]
                turned[i : i + k + 1] = 1 - turned[i : i + k + 1][::-1]
        if not better:
            break
    return [(int(i), bool(t)) for i, t in zip(index, turned, strict=True)]
