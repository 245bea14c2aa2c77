"""Grooves of a mouse's whole pixels, with the settings of a new scene: compared with the sweep of a ball along the
hand's own path, computed densely in doubles."""

import numpy as np
import pytest
import riffler
import scipy.spatial
from hands import Run, samples, way

from addon.sculpt.pure import brush_stroke
from addon.sculpt.pure.stroke_path import Sample
from addon.sculpt.pure.view_rays import ViewRays

RADIUS, DEPTH, PITCH = 3.0, 0.5, 0.25
BALL = {"kind": "ball", "diameter": 2 * RADIUS, "length": 30.0}
SIZE, PIXEL = (400, 300), 0.1  # mm
SPHERE = 25.0  # mm


def above():
    return ViewRays(np.diag([2 / (SIZE[0] * PIXEL), 2 / (SIZE[1] * PIXEL), -0.01, 1.0]), SIZE)


def plane():
    volume = riffler.Volume.block((-20, -15, -4), (20, 15, 4), PITCH, "xyz")
    volume.carve(riffler.Tool.flat(diameter=200, length=30), [(-1, 0, 0.1, 0, 0, 1), (1, 0, 0.1, 0, 0, 1)])
    return volume, lambda p: (np.c_[p, np.full(len(p), 0.1)], np.tile([0.0, 0, 1], (len(p), 1)))


def sphere():
    """The cap of a sphere, its middle 20 mm below."""
    volume = riffler.Volume.empty((-20, -15, -4), (20, 15, 6), PITCH, "xyz")
    ball = riffler.Tool.ball(diameter=2 * SPHERE, length=2 * SPHERE)
    volume.carve(ball, [(0, 0, SPHERE - 20, 0, 0, -1)] * 2, mode="add")

    def on(p):
        normals = np.c_[p, np.sqrt(SPHERE**2 - (p**2).sum(axis=1))] / SPHERE
        return SPHERE * normals - (0, 0, 20), normals

    return volume, on


def groove(run, on, places, seconds):
    """Carves; returns the hand's own path of the ball's centre, and the surface's normals there, (n, 3) each."""
    made = brush_stroke.BrushStroke(run, BALL, above(), brush_stroke.Choice(depth=DEPTH))
    for row in samples(places, seconds):
        made.add(Sample(*row))
    made.end()
    points, normals = on((places - np.array(SIZE) / 2) * PIXEL)
    return points + (RADIUS - DEPTH) * normals, normals


def off_the_sweep(volume, centres, normals):
    """mm between a groove's surface and the sweep of the ball along the hand's own path: of its floor, half as wide as
    the groove, and of all of it except the pitch at its rim; the two ends are left out."""
    vertices = np.asarray(volume.to_mesh().vertices, float)
    vertices = vertices[np.abs(vertices[:, 2]) < 5.9]
    reach = RADIUS + 3 * PITCH  # vertices further from every centre are not of the groove
    near = (vertices > centres.min(axis=0) - reach) & (vertices < centres.max(axis=0) + reach)
    vertices = vertices[near.all(axis=1)]
    distance, along = scipy.spatial.KDTree(centres).query(vertices)
    off = distance - RADIUS
    lean = np.arccos(np.clip(((centres[along] - vertices) * normals[along]).sum(axis=1) / distance, -1, 1))
    rim = np.arccos((RADIUS - DEPTH) / RADIUS)
    apart = np.linalg.norm(np.diff(centres, axis=0), axis=1).cumsum()
    within = np.interp(along, np.arange(len(apart)) + 1, apart)
    clear = (within > 1) & (within < apart[-1] - 1) & (np.abs(off) < 3 * PITCH)
    floor = off[clear & (lean < 0.5 * rim)]
    wall = off[clear & (lean < rim - 1.5 * PITCH / RADIUS)]
    assert len(floor) > 300 and len(wall) > 1.5 * len(floor)
    return floor, wall


def turned(run, centres):
    """rad between the directions of the ball's path and the hand's own, from one pose to the next."""
    poses = np.vstack(run.way)[1:]
    made = poses[:, :3] + RADIUS * poses[:, 3:]
    steps = np.diff(made, axis=0)
    own = np.gradient(centres, axis=0)
    _, near = scipy.spatial.KDTree(centres).query(0.5 * (made[1:] + made[:-1]))
    cosines = (steps * own[near]).sum(axis=1) / np.linalg.norm(steps, axis=1) / np.linalg.norm(own[near], axis=1)
    return np.arccos(np.clip(cosines, -1, 1))[3:-3]


@pytest.mark.parametrize("body", [plane, sphere])
@pytest.mark.parametrize("speed", [40, 250])
@pytest.mark.parametrize("degrees, bend", [(0.6, 0.0), (3.0, 0.0), (20.0, 0.6), (44.0, 0.1), (88.0, 0.3)])
def test_whole_pixels_leave_no_ribs(body, degrees, bend, speed):
    length = 250 if degrees < 45 else 180
    angle = np.radians(degrees)
    start = np.array(SIZE) / 2 - 0.5 * length * np.array([np.cos(angle), np.sin(angle)]) + 0.3
    volume, on = body()
    run = Run(volume)
    centres, normals = groove(run, on, *way(start, angle, length, bend, speed))
    floor, wall = off_the_sweep(volume, centres, normals)
    ribs = turned(run, centres)
    assert np.abs(floor).max() <= 0.1 * PITCH
    assert np.abs(wall).max() <= 0.12 * PITCH
    assert np.degrees(ribs.max()) < 8, "straight from pixel to pixel it would be 20 to 90 degrees"
