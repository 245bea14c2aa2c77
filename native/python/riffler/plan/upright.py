"""Helps to make operations along the axis of a set-up: finds where rapids must end, and collects the moves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from .. import _core
from .._core import Mesh, Tool
from ..arguments import Progress
from .locations import drop
from .operations import LEAD, RAPID, Blocked, ExactFit, Operation, PlannedMoves, operation_of
from .setups import Setup

ABOVE = 1.0  # mm above the stock: where a rapid downwards ends


def joined(meshes: Sequence[Mesh]) -> Mesh:
    """One mesh with the triangles of all meshes."""
    ends = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    triangles = [np.asarray(mesh.triangles) + k for mesh, k in zip(meshes, ends[:-1], strict=True)]
    return Mesh(np.concatenate([mesh.vertices for mesh in meshes]), np.concatenate(triangles))


def plane_of(setup: Setup) -> float:
    """Height of the clearance plane along the axis, mm."""
    box = np.array([setup.stock.lower, setup.stock.upper])
    corners = np.array([[box[i, 0], box[j, 1], box[k, 2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
    points = np.concatenate([corners, *(mesh.vertices for mesh in (setup.part, *setup.obstacles))])
    return float((points @ setup.axis).max()) + setup.clearance


def stock_tops(setup: Setup, tool: Tool, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Height along the axis at which the cutter meets the stock at each point, mm; NaN if there is no stock."""
    stock = setup.stock.to_mesh()
    if not len(stock.triangles) or not len(points):
        return np.full(len(points), np.nan)
    flat = Tool.flat(diameter=tool.diameter, length=tool.length)
    heights, _ = drop(points, flat, stock, axis=setup.axis)
    return heights + setup.stock.pitch


class Moves:
    """A list of moves with the tool along the axis of a set-up: tips, kinds and feeds."""

    def __init__(self, setup: Setup, feed: float, plunge: float) -> None:
        self.setup, self.feed, self.plunge = setup, feed, plunge
        self.plane = plane_of(setup)
        self.tips: list[NDArray[np.float64]] = []
        self.kinds: list[int] = []

    def to(self, tip: NDArray[np.float64], kind: int) -> None:
        if not self.tips or not np.array_equal(tip, self.tips[-1]):
            self.tips.append(tip)
            self.kinds.append(kind)

    def at(self, tip: NDArray[np.float64], height: float) -> NDArray[np.float64]:
        """The place above or below a tip at ``height`` along the axis."""
        return tip + (height - float(tip @ self.setup.axis)) * self.setup.axis

    def approach(self, tip: NDArray[np.float64], height: float) -> None:
        """Adds rapids across the clearance plane and down to a height, then a lead to the tip."""
        self.to(self.at(tip, self.plane), RAPID)
        self.to(self.at(tip, min(self.plane, max(height, float(tip @ self.setup.axis) + ABOVE))), RAPID)
        self.to(tip, LEAD)

    def retract(self) -> None:
        self.to(self.at(self.tips[-1], self.plane), RAPID)

    def operation(
        self, tool: Tool, blocked: Sequence[Blocked], reason: str, stats: Mapping[str, int], spindle: float,
        tolerance: float, progress: Progress = None, exact: ExactFit | None = None,
    ) -> Operation:  # fmt: skip
        """Makes the operation. Leaves out all moves from an approach to its retract if shank or holder would touch the
        stock in any of them."""
        count = len(self.tips)
        if not count:
            poses, nothing = np.zeros((0, 6)), np.zeros(0)
            kinds = np.zeros(0, np.uint8)
            none = PlannedMoves(poses, kinds, nothing, nothing, tuple(blocked), reason, stats, exact=exact)
            return operation_of(none, tool, self.setup.stock.pitch, spindle, tolerance)
        kind = np.array(self.kinds, dtype=np.uint8)
        moves = _core.clear_passes(
            self.setup.part,
            self.setup.obstacles,
            self.setup.stock,
            tool,
            axis=self.setup.axis,
            clearance=self.setup.clearance,
            poses=np.hstack([np.array(self.tips), np.tile(self.setup.axis, (count, 1))]),
            kinds=kind.tolist(),
            feeds=np.array([0.0, self.plunge, self.feed, self.feed])[kind].tolist(),
            tolerance=tolerance,
            progress=progress,
        )
        moves = replace(moves, blocked=(*blocked, *moves.blocked), stats=stats, exact=exact)
        return operation_of(moves, tool, self.setup.stock.pitch, spindle, tolerance)
