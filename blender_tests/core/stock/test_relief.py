"""Pictures as heights."""

import numpy as np
import pytest
import riffler
from riffler import shape

from addon.stock.pure import relief_heights


def test_brightness_is_weighted_as_by_the_eye_and_transparent_pixels_are_dark():
    pixels = np.array([[[1, 0, 0, 1], [0, 1, 0, 1], [0, 0, 1, 1], [1, 1, 1, 1], [1, 1, 1, 0], [2, 2, 2, 1]]], float)
    assert relief_heights.luminance(pixels)[0] == pytest.approx([0.2126, 0.7152, 0.0722, 1, 0, 1])
    assert relief_heights.luminance(np.array([[[0.5, 0.5]]])) == pytest.approx(0.25)
    assert relief_heights.luminance(np.array([[[np.nan]]])) == 0


def test_a_picture_keeps_its_mean_at_any_size():
    rng = np.random.default_rng(2)
    picture = rng.random((40, 30))
    for rows, columns in ((41, 31), (11, 7), (200, 151), (2, 2)):
        fit = relief_heights.fitted(picture, rows, columns)
        assert fit.shape == (rows, columns)
        assert fit.min() >= picture.min() - 1e-12 and fit.max() <= picture.max() + 1e-12
        inner = 0.25 * (fit[1:, 1:] + fit[1:, :-1] + fit[:-1, 1:] + fit[:-1, :-1])
        assert inner.mean() == pytest.approx(picture.mean(), abs=0.04)
    assert np.allclose(relief_heights.fitted(np.full((5, 9), 0.3), 17, 4), 0.3)
    ramp = np.tile((np.arange(100) + 0.5) / 100, (4, 1))
    assert np.allclose(relief_heights.fitted(ramp, 2, 51)[0, 1:-1], np.linspace(0, 1, 51)[1:-1], atol=1e-12)


def grid(n, m, z):
    x, y = np.meshgrid(np.linspace(0, 10, n), np.linspace(0, 8, m), indexing="ij")
    return np.stack([x, y, z(x, y)], axis=2)


UP = np.array([0.0, 0, 1])


@pytest.mark.parametrize("depth", [1.5, -1.5])
def test_heights_follow_the_surface(depth):
    points = grid(61, 49, lambda x, y: 0.3 * x + 0.1 * np.sin(y))
    heights = np.random.default_rng(1).random((61, 49))
    top, bottom, cells = relief_heights.draped(points, np.ones((61, 49), bool), UP, heights, depth, 0.4)
    assert cells.all()
    over, under = (heights * 1.5, 0.4) if depth > 0 else (0.4, heights * 1.5)
    assert np.allclose(top[:, :, 2] - points[:, :, 2], over)
    assert np.allclose(points[:, :, 2] - bottom[:, :, 2], under)
    mesh = shape.slab(top, bottom, cells=cells)
    assert mesh.audit().open_edges == 0
    assert mesh.volume == pytest.approx((heights[:-1, :-1].mean() * 1.5 + 0.4) * 80, rel=0.02)


def test_edges_and_gaps_of_the_surface_are_no_part_of_it():
    points = grid(21, 17, lambda x, y: np.where(x > 5.2, 6.0, 0.0))
    found = np.ones((21, 17), bool)
    found[3, 3] = False
    points[3, 3] = np.nan
    top, bottom, cells = relief_heights.draped(points, found, UP, np.ones((21, 17)), 1.0, 0.2)
    assert not cells[10].any() and not cells[2:4, 2:4].any()
    assert cells.sum() == 20 * 16 - 16 - 4
    assert shape.slab(top, bottom, cells=cells).audit().open_edges == 0


def test_an_embossed_ball_has_the_requested_height():
    volume = riffler.Volume.block((0, 0, 0), (30, 30, 10), 0.25, "xyz")
    surface = riffler.Mesher(volume).freeze()
    x, y = np.meshgrid(np.linspace(5, 25, 161), np.linspace(5, 25, 161), indexing="ij")
    origins = np.stack([x, y, np.full_like(x, 20)], axis=2).reshape(-1, 3)
    distance, _, _, _ = surface.pick(origins, np.tile([0.0, 0, -1], (len(origins), 1)))
    points = (origins - distance[:, None] * UP).reshape(161, 161, 3)
    heights = np.clip(1 - ((x - 15) ** 2 + (y - 15) ** 2) / 64, 0, 1)
    top, bottom, cells = relief_heights.draped(points, np.isfinite(points).all(axis=2), UP, heights, -2.0, 0.5)
    mesh = shape.slab(top, bottom, cells=cells)
    form = riffler.Volume.from_mesh(mesh, 0.25, "xyz", lower=volume.lower, upper=volume.upper)
    volume.subtract(form)
    # a paraboloid of radius 8 and depth 2
    assert 30 * 30 * 10 - volume.volume == pytest.approx(0.5 * np.pi * 64 * 2, rel=5e-3)
