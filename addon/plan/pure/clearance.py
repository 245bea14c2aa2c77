"""Collision checks of a plan's tool with the part and its fixtures: distances, and their text."""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np
import riffler

from ...common import units

FLAT = 1e-6  # ratio of thickness to width of a flat sheet
# A triangle that no machine reaches.
_FAR = np.array([(1e6, 0, 0), (1e6 + 1, 0, 0), (1e6, 1, 0)])


def _nowhere():
    return riffler.Mesh(_FAR, np.array([(0, 1, 2)]))


@functools.cache
def nothing():
    """An empty Collider, for callers that only need the tool's pose."""
    return riffler.Collider(_nowhere())


@dataclass(frozen=True)
class State:
    """The tool's clearance: `distance` (mm) is negative in a collision, otherwise the distance of the nearest obstacle
    outside its cut; `room` is the required minimum."""

    distance: float
    piece: str  # of the tool: "cutter", "shank", "holder", or "tool"
    other: str  # name of the part or fixture
    room: float = 0.0

    @property
    def free(self) -> bool:
        return self.distance >= self.room

    def __str__(self) -> str:
        size = units.trim(abs(self.distance), 1 if abs(self.distance) >= 0.1 else 3)
        piece = self.piece.capitalize()
        if self.distance < 0:
            return f"{piece} hits {self.other} by {size} mm"
        if not self.free:
            return f"{piece} is only {size} mm from {self.other}, not {units.trim(self.room)} mm"
        return f"Free, {size} mm to {self.other}" if np.isfinite(self.distance) else "Free"


class Surroundings:
    """`collider`: a riffler.Collider of the part, called `name`, and all fixtures; `fixtures`: (name, riffler.Collider)
    of each fixture alone. Built by Making."""

    def __init__(self, collider, name: str, fixtures):
        self.collider, self._name, self._fixtures = collider, name, fixtures

    def clearance(self, tool, poses: np.ndarray) -> np.ndarray:
        """(n,) mm for poses (n, 6), over part and fixtures."""
        if not self._fixtures:  # uses all threads
            return self.collider.clearance(tool, poses)
        return np.array([self.collider.nearest(tool, pose).distance for pose in poses])

    def near_fixtures(self, tool, poses: np.ndarray, room: float) -> list[tuple[float, str]]:
        """(mm, name) of the fixtures that the tool, including its cutter, approaches closer than `room` at poses (n,
        6)."""
        found = [(min(c.nearest(tool, pose).distance for pose in poses), name) for name, c in self._fixtures]
        return [(gap, name) for gap, name in found if gap < room]

    def state(self, tool, pose, tolerance: float = 0.01, room: float = 0.0) -> State:
        """The tool at a pose on its path: the cutter touches the part, within the tolerance."""
        distance, _, piece = self.collider.nearest(tool, pose)
        near = [(c.nearest(tool, pose).distance, "tool", name) for name, c in self._fixtures]
        if distance < -tolerance:
            found = min(near)[1:] if piece == "fixture" else (piece, self._name)
            return State(distance, *found)
        body, lift = above(tool)
        if body is not None:
            moved = np.concatenate([pose[:3] + lift * pose[3:], pose[3:]])
            gap, _, piece = self.collider.nearest(body, moved)
            if piece != "fixture":  # those are in the list already
                near.append((gap, _first(tool) if piece == "cutter" else piece, self._name))
        if not near:
            return State(np.inf, "tool", "")
        gap, piece, other = min(near)
        return State(max(gap, 0.0), piece, other, max(room - tolerance, 0.0))


def _first(tool) -> str:
    return "shank" if tool.shank else "holder"


def above(tool):
    """Shank and holder as a separate tool, and the height of its start above the tip (mm); (None, 0) if there are none.
    Its cutter is a sliver of the first piece."""
    pieces = [*tool.shank, *tool.holder]
    if not pieces:
        return None, 0.0
    low, r0, high, r1 = pieces[0]
    sliver = 1e-3 * (high - low)

    def lifted(rows, begin=None):
        out = [(z0 - low, a, z1 - low, b) for z0, a, z1, b in rows]
        return out if begin is None else [(begin, out[0][1], out[0][2], out[0][3]), *out[1:]]

    body = riffler.Tool.flat(diameter=2 * min(r0, r1), length=sliver)
    if tool.shank:
        body = body.with_shank(lifted(tool.shank, sliver))
        return (body.with_holder(lifted(tool.holder)) if tool.holder else body), low
    return body.with_holder(lifted(tool.holder, sliver)), low


def check_fixture(mesh, name: str) -> None:
    """ValueError with the remedy if a riffler.Mesh is a flat sheet, in any direction, since it has no volume."""
    vertices = np.asarray(mesh.vertices, float)
    away = vertices - vertices.mean(axis=0)
    across = np.sqrt(np.maximum(np.linalg.eigvalsh(away.T @ away), 0))
    if across[0] <= FLAT * across[2]:
        raise _unfit(name, "is flat, so it has no volume")


def _unfit(name: str, why: str) -> ValueError:
    return ValueError(f"{name} {why}: give it thickness, by the modifier Solidify, or take it out of the fixtures")


class Making:
    """Builds Surroundings with native tasks. `part`: a riffler.Mesh and its name; `fixtures`: (name, riffler.Mesh)
    each, which become volumes first."""

    def __init__(self, part, name: str, fixtures=()):
        self._part, self._name, self._fixtures = part, name, [fixture for fixture, _ in fixtures]
        self._volumes = [
            riffler.submit(riffler.Volume.from_mesh, mesh, riffler.plan.fixture_pitch(mesh)) for _, mesh in fixtures
        ]
        self._colliders = None  # of all surfaces, then of each fixture
        self._error = None  # of a volume that could not be made

    def done(self) -> bool:
        """Poll this: it makes colliders of finished volumes."""
        if self._colliders is None:
            if not all(task.done() for task in self._volumes):
                return False
            self._collide()
        return all(task.done() for task in self._colliders)

    def progress(self) -> float:
        """Share of the work done, 0 … 1."""
        begun = [*self._volumes, *(self._colliders or ())]
        return sum(task.progress() for task in begun) / (2 * len(self._volumes) + 1)

    def result(self) -> Surroundings:
        """Waits for the result; raises its error."""
        if self._colliders is None:
            self._collide()
        if self._error is not None:
            raise self._error
        whole, *each = [task.result() for task in self._colliders]
        return Surroundings(whole, self._name, list(zip(self._fixtures, each, strict=True)))

    def _collide(self) -> None:
        self._colliders = []
        try:
            volumes = [self._volume(task, name) for task, name in zip(self._volumes, self._fixtures, strict=True)]
            self._colliders.append(riffler.submit(riffler.Collider, self._part, fixtures=volumes))
            self._colliders += [riffler.submit(riffler.Collider, _nowhere(), fixtures=[volume]) for volume in volumes]
        except (ValueError, TypeError, MemoryError) as error:
            self._error = error

    def _volume(self, task, name: str):
        try:
            return task.result()
        except ValueError as error:
            raise _unfit(name, f"cannot be a fixture, as {error}") from error
