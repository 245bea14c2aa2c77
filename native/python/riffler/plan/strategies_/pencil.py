"""Pencil cuts: where a ball touches a part at two places at once."""

import numpy as np

from .. import _core


class PencilPaths(list):
    """A list of ``PencilPath``; what was done to find them stands beside it.

    ``ends``: a pair for each path, ``"part"``, ``"corner"``, ``"faded"``, ``"loop"``, ``"cut"``, ``"joined"`` where
    another path continues or, for passes beside a valley, ``"pass"``; ``rest_area``: mm² that the tool's ball cannot
    reach; ``rest_areas``: (k,) the same for each triangle; ``reference_area``, ``reference_areas``: the same for the
    ball of ``reference_tool`` (or of ``overthickness``), what there is to be machined; without one those of the tool;
    ``stats``: counters; ``reason``: why there are no paths, empty where there are some.
    """

    def __init__(self, found):
        super().__init__(found["paths"])
        self.ends = found["ends"]
        self.rest_area = found["rest_area"]
        self.rest_areas = found["rest_areas"]
        self.reference_area = found["reference_area"]
        self.reference_areas = found["reference_areas"]
        self.stats = found["stats"]
        self.reason = found["reason"]


def pencil(
    part_mesh,
    tool,
    tolerance=0.01,
    passes=1,
    progress=None,
    *,
    bitangency_angle=None,
    minimum_length=0.0,
    stepover=None,
    scallop=None,
    overthickness=0.0,
    reference_tool=None,
):
    """The valleys of ``part_mesh`` for the ball at the tool's tip, as ``PencilPaths``.

    The curves of ball centres along which the ball touches the part at two places at once and enters it nowhere. A
    valley counts where the ball's gap to its bottom exceeds ``tolerance`` (mm), to which the curves are traced; if
    ``bitangency_angle`` (rad) is given, instead where the directions to both contacts differ by at least that. Paths
    shorter than ``minimum_length`` (mm) are dropped.

    With ``passes`` above 1 each valley is followed by passes - 1 curves on either side, ``stepover`` (mm) apart or as
    far as leaves ridges of ``scallop`` (mm; the tolerance, if neither is given) on a plane; there both contacts are the
    one point that the ball touches.

    ``overthickness`` (mm) adds what a ball whose radius is larger by that much leaves behind: its valleys, with the
    tool's ball laid into them, where that has none of its own, as in blends of its own radius or a larger one.
    ``reference_tool``, a larger one that has been there before, does the same for what its ball could not reach: rest
    machining, corners included.

    ``progress`` is called with the finished share and cancels by returning False. ValueError for an empty mesh, for
    sizes that are not positive and finite, and for a tool or reference tool whose tip is no ball.
    """
    if stepover is not None and scallop is not None:
        raise ValueError("stepover and scallop: only one of them")
    radius = _core.tip_ball_radius(tool, "tool")
    if scallop is not None:
        if not 0 < scallop <= radius:
            raise ValueError(f"scallop must be positive and at most the ball's radius, not {scallop}")
        stepover = _core.stepover_of_scallop(radius, scallop)
    if reference_tool is not None:
        larger = _core.tip_ball_radius(reference_tool, "reference_tool")
        if larger <= radius:
            raise ValueError(f"reference_tool must have a ball larger than {2 * radius:g} mm, not {2 * larger:g}")
        overthickness = max(overthickness, larger - radius)
    found = _core.pencil(
        part_mesh,
        tool,
        tolerance=tolerance,
        bitangency_angle=bitangency_angle,
        minimum_length=minimum_length,
        passes=passes,
        stepover=stepover,
        overthickness=overthickness,
        progress=progress,
    )
    return _core.then(found, PencilPaths)


def linked(paths, start=None):
    """The paths in an order, and turned round, so that the moves between them are short: ``[(index, reversed), ...]``.

    From ``start`` (a point; otherwise the first path's beginning) always to the nearest end, then exchanges of two
    moves as long as they shorten the way. The same input gives the same order. A loop begins and ends at its first
    point.
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


def _exchanged(order, ends, start, rounds=20):
    """2-opt (Croes, Operations Research 6 (1958) 791): turns stretches of the order round while that shortens it."""
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
