"""Stress of brushes with falloff: random dabs of all kinds on random volumes, each judged by numpy.

    python native/tests/python/brush_stress.py --dabs 100000 --seed 1

prints each fault with its session and dab, and ends with their count; ``--only N`` runs one session again. After each
dab: the mesh is a closed two-manifold, no interval end has changed a bit beyond the radius, and the volume has changed
by what the dab says it has added and removed.
"""

import argparse
import os
import sys
import time
import warnings
from dataclasses import dataclass, field

import numpy as np
import riffler

KINDS = ("clay", "inflate", "flatten", "scrape", "fill", "grab", "snake_hook", "pinch", "crease", "twist")
FALLOFFS = ("smooth", "smoother", "sphere", "root", "sharp", "linear", "sharper", "inverse_square", "constant")
DEFECTS = ("open_edges", "nonmanifold_edges", "nonmanifold_vertices", "degenerate", "duplicates", "folds")
DABS = 100  # of a session
PULLS = ("grab", "snake_hook")


def random_volume(random):
    """A block or a ball in a box with room, with grooves and material put on."""
    pitch = float(10 ** random.uniform(-1, 0.5))
    size = random.integers(16, 40, 3) * pitch
    lower = random.uniform(-1, 1, 3) * 10 ** random.uniform(0, 4)
    volume = riffler.Volume.empty(lower, lower + size, pitch, "xyz")
    middle, half = lower + size / 2, size / 2
    tool = riffler.Tool.ball(float(size.min() * random.uniform(0.4, 0.9)), float(size.max()))
    volume.carve(tool, [(*middle, 0, 0, 1), (*(middle + 0.1 * pitch * np.eye(3)[0]), 0, 0, 1)], mode="add")
    for _ in range(random.integers(0, 5)):
        tool = riffler.Tool.flat(float(pitch * random.uniform(1, 8)), float(size.max()))
        ends = middle + random.uniform(-1, 1, (2, 3)) * half
        axis = random.normal(size=3)
        poses = np.hstack([ends, np.tile(axis / np.linalg.norm(axis), (2, 1))])
        volume.carve(tool, poses, mode=str(random.choice(["add", "remove"])))
    return volume


def ends_of(volume):
    """{direction: (points (n, 3), kinds (n,))} of all interval ends, in order."""
    found, lower = {}, np.asarray(volume.lower)
    for k, direction in enumerate("xyz"):
        counts, spans = volume.intervals(direction)
        ray = np.repeat(np.arange(counts.size), counts.ravel())
        u, v = np.unravel_index(ray, counts.shape)
        others = ((k + 1) % 3, (k + 2) % 3)
        points = np.empty((len(ray), 2, 3))
        points[:, :, k] = spans
        for a, index in zip(others, (u, v), strict=True):
            points[:, :, a] = (lower[a] + (index + 0.5) * volume.pitch)[:, None]
        found[direction] = points.reshape(-1, 3), np.tile([0, 1], len(ray))
    return found


def beyond(ends, start, goal, radius):
    """The ends farther than the radius from the line between two places."""
    points, kinds = ends
    d = goal - start
    t = np.clip((points - start) @ d / max(d @ d, 1e-300), 0, 1)
    far = np.linalg.norm(points - start - t[:, None] * d, axis=1) > radius * (1 + 1e-9) + 1e-9
    return points[far], kinds[far]


@dataclass
class Session:
    number: int
    seed: int
    faults: list = field(default_factory=list)
    lost: float = 0.0  # mm³
    dabs: int = 0

    def run(self, count):
        random = np.random.default_rng([self.seed, self.number])
        volume = random_volume(random)
        before, mesh = ends_of(volume), volume.to_mesh()
        for _ in range(count):
            if not len(mesh.vertices):
                return self
            before, mesh = self._dab(volume, random, before, np.asarray(mesh.vertices))
            self.dabs += 1
        return self

    def _dab(self, volume, random, before, vertices):
        kind, falloff = str(random.choice(KINDS)), str(random.choice(FALLOFFS))
        radius = float(volume.pitch * 10 ** random.uniform(-0.5, 1.1))
        start = vertices[random.integers(len(vertices))] + random.normal(size=3) * random.choice([0.0, 0.3]) * radius
        axis = random.normal(size=3)
        axis /= np.linalg.norm(axis)
        rows = [(*start, *axis)]
        goal = start
        if kind in PULLS:
            goal = start + random.normal(size=3) * radius * 10 ** random.uniform(-2, 0.3)
            rows.append((*goal, *axis))
        amount = float(random.choice([-1, 1]) * 10 ** random.uniform(-2, 0) * (3 if kind == "twist" else radius))
        options = {"strength": float(random.uniform(0, 1)), "amount": amount, "falloff": falloff}
        copy, was = volume.copy(), volume.volume
        made = volume.brush(kind, rows, radius, **options)
        self.lost += made.lost

        def fault(text):
            self.faults.append(f"session {self.number}, dab {self.dabs}, {kind}, radius {radius:.4g}: {text}")

        if self.dabs % 10 == 0:
            os.environ["RIFFLER_THREADS"] = "3"
            copy.brush(kind, rows, radius, **options)
            del os.environ["RIFFLER_THREADS"]
            if copy.to_bytes() != volume.to_bytes():
                fault("another number of threads gives other bytes")
        mesh = volume.to_mesh()
        audit = mesh.audit()
        if any(getattr(audit, name) for name in DEFECTS):
            fault(f"the mesh has defects: {audit}")
        after = ends_of(volume)
        for direction in "xyz":
            old, new = (beyond(ends[direction], start, goal, radius) for ends in (before, after))
            if not all(np.array_equal(a, b) for a, b in zip(old, new, strict=True)):
                fault(f"ends of {direction} have changed beyond the radius")
        change = volume.volume - was
        if abs(change - (made.added - made.removed)) > 1e-9 * (abs(was) + made.added + made.removed):
            fault(f"changed by {change} mm³, but {made.added} added and {made.removed} removed")
        return after, mesh


def main():
    warnings.simplefilter("ignore")  # of material thinner than the pitch, which is no part of the mesh
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--dabs", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", type=int)
    given = parser.parse_args()
    begin, faults, dabs, lost, number = time.monotonic(), 0, 0, 0.0, given.only or 0
    while dabs < given.dabs:
        session = Session(number, given.seed).run(min(DABS, given.dabs - dabs))
        number, dabs, lost, faults = number + 1, dabs + session.dabs, lost + session.lost, faults + len(session.faults)
        for text in session.faults:
            print(text, flush=True)
        if given.only is not None:
            break
    print(f"{dabs} dabs in {number} sessions, {time.monotonic() - begin:.0f} s, {lost:.3g} mm³ lost: {faults} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
