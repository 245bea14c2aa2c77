"""Computes the feeds of a program from its simulated removal, for `Program.scheduled`."""

from __future__ import annotations

from collections.abc import Mapping
from copy import copy
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from ._core import Cancelled, Program, Tool, Volume
from .arguments import Progress

PITCHES = 4.0  # smallest step of the simulation in pitches, because rays lose their material in lumps
RADII = 0.25  # smallest step in radii of the cutter; the larger step counts
JUMP = 1.15  # steps whose feeds differ by a smaller factor stay one row
SLACK = 1e-9


def scheduled(
    program: Program,
    stock: Volume,
    removal_rate: float | None,
    force: float | None,
    lowest: float,
    highest: float | None,
    removal_constant: float,
    tools: Mapping[int, Tool] | None,
    progress: Progress,
) -> Program:
    """See ``Program.scheduled``."""
    limit = _limit(removal_rate, force, removal_constant)
    for name, value in (("lowest", lowest), ("highest", highest)):
        if value is not None and not (isfinite(value) and value > 0):
            raise ValueError(f"{name} must be positive and finite, not {value}")
    if highest is not None and highest < lowest:
        raise ValueError(f"highest must not be less than lowest, {lowest:g}, but is {highest:g}")
    split = _Split(program, stock.pitch, {**program.tools, **(tools or {})})
    removed = _removed(program, split, stock, progress)
    return _rebuilt(program, split, removed, limit, lowest, highest)


def _limit(removal_rate: float | None, force: float | None, removal_constant: float) -> float:
    """Largest removal rate, mm³/min."""
    named = {"removal_rate": removal_rate, "force": force, "removal_constant": removal_constant}
    for name, value in named.items():
        if value is not None and not (isfinite(value) and value > 0):
            raise ValueError(f"{name} must be positive and finite, not {value}")
    if removal_rate is None and force is None:
        raise ValueError("removal_rate or force must be given")
    return min(
        np.inf if removal_rate is None else removal_rate, np.inf if force is None else 60 * force / removal_constant
    )


class _Split:
    """The steps of the simulation: each move of a program is divided into steps. ``row``: the program's row of each
    step; ``share``: the part of the row's move up to the end of the step."""

    def __init__(self, program: Program, pitch: float, tools: Mapping[int, Tool]) -> None:
        self.tools = tools
        poses = program.poses
        length = np.linalg.norm(np.diff(poses[:, :3], axis=0, prepend=poses[:1, :3]), axis=1)
        counts = np.ones(len(program), dtype=int)
        whole = program.rapid | program.at_machine | (length <= 0)
        whole[list(program.via)] = True
        for number in np.unique(program.tool):
            if int(number) in tools:
                step = max(PITCHES * pitch, RADII * 0.5 * tools[int(number)].diameter)
                which = (program.tool == number) & ~whole
                counts[which] = np.maximum(1, np.ceil(length[which] / step)).astype(int)
        self.row = np.repeat(np.arange(len(program)), counts)
        first = np.cumsum(counts) - counts
        self.share = (np.arange(len(self.row)) - first[self.row] + 1) / counts[self.row]
        self.poses = _between(poses[np.maximum(self.row - 1, 0)], poses[self.row], self.share)
        self.length = length[self.row] / counts[self.row]


def _between(a: NDArray[np.float64], b: NDArray[np.float64], share: NDArray[np.float64]) -> NDArray[np.float64]:
    """Poses on the moves from ``a`` to ``b``: tips on lines, axes on great circles at constant rate; exact ends."""
    s = share[:, None]
    tip = a[:, :3] + s * (b[:, :3] - a[:, :3])
    angle = np.arctan2(np.linalg.norm(np.cross(a[:, 3:], b[:, 3:]), axis=1), (a[:, 3:] * b[:, 3:]).sum(axis=1))[:, None]
    small = angle < 1e-12
    sine = np.where(small, 1.0, np.sin(angle))
    axis = np.where(small, b[:, 3:], (np.sin((1 - s) * angle) * a[:, 3:] + np.sin(s * angle) * b[:, 3:]) / sine)
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    return np.where(s == 1, b, np.hstack([tip, axis]))


def _removed(program: Program, split: _Split, stock: Volume, progress: Progress) -> NDArray[np.float64]:
    """Volume that each step removes, mm³."""
    left, out = copy(stock), np.zeros(len(split.row))
    number = program.tool[split.row]
    lost = program.at_machine[split.row] | program.at_machine[np.maximum(split.row - 1, 0)]
    ends = np.flatnonzero(np.diff(number)) + 1
    for first, last in zip([0, *ends], [*ends, len(number)], strict=True):
        first = max(int(first), 1)
        if last <= first:
            continue
        tool = split.tools.get(int(number[first]))
        if tool is None:
            if program.rapid[split.row[first:last]].all():
                continue
            raise ValueError(
                f"tool {int(number[first])} of row {int(split.row[first])} has no known shape; give it in tools"
            )
        out[first:last] = left.carve(tool, split.poses[first - 1 : last]).removed
        if progress is not None and progress(last / len(number)) is False:
            raise Cancelled("cancelled")
    return np.where(lost, 0.0, out)


def _rebuilt(
    program: Program, split: _Split, removed: NDArray[np.float64], limit: float, lowest: float, highest: float | None
) -> Program:
    old = program.feed[split.row]
    most = old if highest is None else np.full(len(old), highest)
    moves = (split.length > 0) & ~program.rapid[split.row]
    with np.errstate(divide="ignore", invalid="ignore"):
        allowed = np.where(removed > 0, limit * split.length / removed, np.inf)
    feed = np.where(moves, np.minimum(most, allowed), old)
    low = np.flatnonzero(moves & (removed > 0) & (allowed < lowest * (1 - SLACK)))
    if len(low):
        k = low[np.argmin(allowed[low])]
        at = ", ".join(f"{x:.3f}" for x in split.poses[k, :3])
        raise ValueError(
            f"row {int(split.row[k])}, at ({at}): the limit needs a feed of {allowed[k]:.3g} mm/min, less than lowest, "
            f"{lowest:g}; allow a larger rate or force, or a smaller lowest"
        )
    keep, feeds = _runs(split.row, feed)
    rows = split.row[keep]
    new = {old_row: k for k, old_row in enumerate(rows)}  # the last step of each row
    return Program(
        split.poses[keep],
        feeds,
        rapid=program.rapid[rows],
        tool=program.tool[rows],
        line=program.line[rows],
        spindle=program.spindle[rows],
        tools=program.tools,
        provenance=program.provenance,
        notes=program.notes,
        at_machine=program.at_machine[rows],
        via={new[row]: poses for row, poses in program.via.items()},
    )


def _runs(row: NDArray[np.intp], feed: NDArray[np.float64]) -> tuple[NDArray[np.intp], NDArray[np.float64]]:
    """Joins steps of a row whose feeds differ little. Returns the last step and the smallest feed of each run."""
    keep: list[int] = []
    feeds: list[float] = []
    low = high = 0.0
    for k in range(len(row)):
        if k and row[k] == row[k - 1] and max(high, feed[k]) <= JUMP * min(low, feed[k]):
            low, high = min(low, feed[k]), max(high, feed[k])
            keep[-1], feeds[-1] = k, low
        else:
            low = high = float(feed[k])
            keep.append(k)
            feeds.append(low)
    return np.array(keep, dtype=np.intp), np.array(feeds)
