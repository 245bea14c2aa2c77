"""Few keys that are free: on a step whose wall, roof and floor are known in closed form."""

import math

import numpy as np
import pytest
import riffler
from valleys import valley

from addon.plan.pure import tilt_search

BALL = riffler.Tool.ball(6, 25).with_shank([(25, 3, 60, 3)])
UP = np.array([0.0, 0, 1])


def box(lower, upper):
    (x0, y0, z0), (x1, y1, z1) = lower, upper
    v = np.array([(x, y, z) for x in (x0, x1) for y in (y0, y1) for z in (z0, z1)], float)
    f = [
        (0, 1, 3),
        (0, 3, 2),
        (4, 6, 7),
        (4, 7, 5),
        (0, 4, 5),
        (0, 5, 1),
        (2, 3, 7),
        (2, 7, 6),
        (0, 2, 6),
        (0, 6, 4),
        (1, 5, 7),
        (1, 7, 3),
    ]
    return v, np.array(f)


def solid(*boxes):
    vertices, faces, count = [], [], 0
    for lower, upper in boxes:
        v, f = box(lower, upper)
        vertices.append(v)
        faces.append(f + count)
        count += len(v)
    return riffler.Collider(riffler.Mesh(np.vstack(vertices), np.vstack(faces)))


FLOOR, WALL = ((-10, -60, -10), (70, 20, 0)), ((-10, 0, -5), (70, 20, 40))


def found(path, collider, **more):
    job = tilt_search.SearchesJob([tilt_search.Search(path, tilt_search.Rule(BALL, collider, 0.01, **more))])
    while not job.step(1.0):
        pass
    return job.answers[0]


def test_an_open_valley_is_keyed_at_its_ends_in_the_middle_between_the_walls():
    answer = found(valley(61, 60), solid(FLOOR, WALL))
    assert list(answer.path.keys) == [0, 60]
    assert np.allclose(answer.path.axes, (0, -math.sqrt(0.5), math.sqrt(0.5)), atol=1e-9)


def test_a_roof_over_the_middle_takes_further_keys_and_the_path_is_free():
    """A beam across the valley, from 22 to 38 in x: compared with the distance from axis to beam."""
    beam = ((22, -40, 12), (38, -8, 16))
    collider = solid(FLOOR, WALL, beam)
    answer = found(valley(61, 60), collider)
    assert answer.path is not None and 2 < len(answer.path.keys) < 20
    path = answer.path
    lean = np.arccos(np.clip(path.axes @ (0, -math.sqrt(0.5), math.sqrt(0.5)), -1, 1))
    assert lean[[0, 60]].max() < math.radians(11) < lean[30]  # a diagonal of the map's grid
    steps = np.linspace(0, 57, 200)
    low, high = np.array(beam[0]), np.array(beam[1])
    for centre, axis in zip(path.centres, path.axes, strict=True):
        on = centre + steps[:, None] * axis
        away = np.linalg.norm(np.maximum(np.maximum(low - on, on - high), 0), axis=1).min()
        assert away > 3 - 0.02 and on[:, 1].max() <= -3 + 0.02 and on[:, 2].min() >= 3 - 0.02


def test_where_nothing_is_free_the_point_is_named():
    lid = ((20, -60, 6.5), (40, 20, 30))  # lower than the cutter is long
    answer = found(valley(61, 60), solid(FLOOR, WALL, lid, ((20, -60, -5), (40, -8, 30))), count=3)
    assert answer.path is None and 20 <= answer.point <= 40 and "no orientation is free" in answer.reason
    assert "point" not in answer.reason  # the index among the few points, which means nothing to the user


def test_the_machine_s_cone_is_kept():
    limited = found(valley(61, 60), solid(FLOOR, WALL), limit=(UP, math.radians(30)))
    angles = np.arccos(limited.path.axes @ UP)
    assert angles.max() <= math.radians(30) + 1e-9 and angles.min() > math.radians(15)
    none = found(valley(61, 60), solid(FLOOR, WALL), limit=((0.0, 1, 0), math.radians(20)))
    assert none.path is None and none.reason


def test_first_keys_are_in_the_middle_at_the_ends_or_both():
    path = valley(61, 60)
    assert (
        tilt_search.begun(path, 1) == [30]
        and tilt_search.begun(path, 2) == [0, 60]
        and tilt_search.begun(path, 3) == [0, 30, 60]
    )
    assert tilt_search.begun(path, 1000) == list(range(61))
    single = riffler.plan.PencilPath(3.0, path.centres[:1], path.contacts[:1], path.normals[:1])
    assert tilt_search.begun(single, 2) == [0]
    around = np.exp(2j * np.pi * np.arange(60) / 60)
    centres = 20 * np.c_[around.real, around.imag, np.zeros(60)]
    loop = riffler.plan.PencilPath(
        3.0, centres, np.stack([0.85 * centres, centres - [0, 0, 3]], axis=1), path.normals[:60], closed=True
    )
    assert tilt_search.begun(loop, 1) == [0] and tilt_search.begun(loop, 4) == [0, 15, 30, 45]


@pytest.mark.parametrize(
    ("points", "blocked", "wanted"),
    [
        ([0, 9], [], [0, 9]),
        ([0, 9], [4, 5, 6], [0, 5, 9]),
        ([0, 9], [2, 6, 7, 8], [0, 2, 7, 9]),
        ([0, 5, 9], [4, 5, 6], [0, 4, 5, 9]),
        ([0, 5, 9], [5], [0, 5, 9]),
    ],
)
def test_further_keys_divide_the_blocked_stretches(points, blocked, wanted):
    assert tilt_search.further(points, blocked) == wanted


class Slow:
    """A search that takes so many polls."""

    def __init__(self, name, looks):
        self.answer, self.looks, self.cancelled = name, looks, False

    def step(self, budget):
        self.looks -= 1
        return self.looks < 0

    def cancel(self):
        self.cancelled = True


def test_results_keep_the_order_of_the_paths():
    searches = [Slow(k, (7 * k) % 11) for k in range(30)]
    job = tilt_search.SearchesJob(searches, sleep=lambda s: None)
    shares = []
    while not job.step(0.0):
        shares.append(job.fraction)
        assert len(job._running) <= tilt_search.AT_ONCE
    assert job.answers == list(range(30)) and shares == sorted(shares) and job.fraction == 1


def test_all_running_searches_are_cancelled():
    searches = [Slow(k, 5) for k in range(20)]
    job = tilt_search.SearchesJob(searches, sleep=lambda s: None)
    job.step(0.0)
    job.cancel()
    assert sum(s.cancelled for s in searches) == tilt_search.AT_ONCE
