"""Rays through pixels and pixels of points, compared with a camera in closed form."""

import numpy as np
import pytest

from addon.sculpt.pure.view_rays import ViewRays

SIZE = (800, 500)


def camera(rng, perspective, near=0.1, far=1e4):
    """World → clip as in OpenGL, with a camera at some place; and that place, with its axes as rows."""
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    turn[2] = np.cross(turn[0], turn[1])
    place = rng.normal(size=3) * 50
    view = np.eye(4)
    view[:3, :3], view[:3, 3] = turn, -turn @ place
    clip = np.zeros((4, 4))
    if perspective:
        clip[0, 0], clip[1, 1] = 2.0, 2.0 * SIZE[0] / SIZE[1]
        clip[2, 2:], clip[3, 2] = (-(far + near) / (far - near), -2 * far * near / (far - near)), -1
    else:
        clip[0, 0], clip[1, 1] = 0.05, 0.05 * SIZE[0] / SIZE[1]
        clip[2, 2], clip[3, 3] = -1 / far, 1
    return (clip @ view).astype(np.float32), place, turn


@pytest.mark.parametrize("perspective", [True, False])
def test_a_ray_meets_the_points_that_are_drawn_at_its_pixel(perspective):
    rng = np.random.default_rng(4)
    for _ in range(50):
        matrix, place, turn = camera(rng, perspective)
        sight = ViewRays(matrix, SIZE)
        local = np.c_[rng.uniform(-5, 5, (20, 2)), -rng.uniform(20, 200, 20)]
        points = place + local @ turn
        pixels = sight.project(points)
        if perspective:  # by hand: f = 2 across the half width
            expected = (local[:, :1] * 2 / -local[:, 2:] + 1) * 0.5 * SIZE[0]
        else:
            expected = (local[:, :1] * 0.05 + 1) * 0.5 * SIZE[0]
        assert np.allclose(pixels[:, :1], expected, atol=0.05)
        for point, pixel in zip(points, pixels, strict=True):
            origin, direction = sight.ray(*pixel)
            away = point - origin
            assert np.linalg.norm(away - (away @ direction) * direction) < 2e-4
            assert away @ direction > 0 and np.linalg.norm(direction) == pytest.approx(1)


@pytest.mark.parametrize("perspective", [True, False])
def test_the_views_axes_are_the_cameras(perspective):
    rng = np.random.default_rng(5)
    for _ in range(20):
        matrix, place, turn = camera(rng, perspective)
        sight = ViewRays(matrix, SIZE)
        assert np.allclose(np.stack(sight.basis()), turn, atol=1e-4)
        point = place - 40 * turn[2]
        expected = (2.0 / 40 if perspective else 0.05) * 0.5 * SIZE[0]
        assert sight.pixels_per_unit(point) == pytest.approx(expected, rel=1e-4)


def test_behind_the_camera_nothing_is_drawn():
    matrix, place, turn = camera(np.random.default_rng(1), True)
    pixels = ViewRays(matrix, SIZE).project([place + 5 * turn[2], place - 5 * turn[2]])
    assert np.isnan(pixels[0]).all() and np.allclose(pixels[1], (400, 250), atol=0.1)


@pytest.mark.parametrize("matrix, size", [(np.zeros(16), SIZE), (np.eye(4) * np.nan, SIZE), (np.eye(4), (0, 5))])
def test_a_view_that_shows_nothing_is_refused(matrix, size):
    with pytest.raises(ValueError, match="view"):
        ViewRays(matrix, size)
