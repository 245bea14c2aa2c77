"""riffler.shape: slabs, reliefs and extrusions, by audit, by volume in closed form, and as volumes."""

import numpy as np
import pytest
import riffler
from riffler import shape


def clean(mesh):
    audit = mesh.audit()
    return not any(getattr(audit, n) for n in ("open_edges", "nonmanifold_edges", "degenerate", "duplicates"))


def sheets(n, m, height=2.0):
    x, y = np.meshgrid(np.arange(n, dtype=float), np.arange(m, dtype=float), indexing="ij")
    bottom = np.stack([x, y, np.zeros((n, m))], axis=2)
    return bottom + np.array([0, 0, height]), bottom


def test_a_slab_is_closed_and_faces_outwards():
    mesh = shape.slab(*sheets(5, 7))
    assert clean(mesh) and mesh.volume == pytest.approx(4 * 6 * 2)


def test_a_slab_with_holes_has_walls_around_them():
    rng = np.random.default_rng(8)
    for _ in range(20):
        cells = rng.random((9, 6)) < 0.6
        mesh = shape.slab(*sheets(10, 7), cells=cells)
        assert mesh.volume == pytest.approx(2 * cells.sum())
        assert mesh.audit().open_edges == 0  # cells that touch in a corner share its edge


def test_unused_points_need_not_be_finite():
    top, bottom = sheets(4, 4)
    top[0, 0] = bottom[0, 0] = np.nan
    cells = np.ones((3, 3), bool)
    with pytest.raises(ValueError, match="top, row 0, column 0: not finite"):
        shape.slab(top, bottom, cells=cells)
    cells[0, 0] = False
    assert shape.slab(top, bottom, cells=cells).volume == pytest.approx(16)


def test_a_relief_has_the_volume_under_its_heights():
    x, y = np.meshgrid(np.linspace(0, 1, 81), np.linspace(0, 1, 61))
    mesh = shape.relief(x * y, (40, 30), 5, sink=0.5)
    assert clean(mesh)
    assert mesh.volume == pytest.approx(40 * 30 * (5 / 4 + 0.5), rel=1e-4)
    assert np.allclose(mesh.bounds, [(0, 0, -0.5), (40, 30, 5)])
    # the first row of a picture is the lowest, the first column the leftmost
    corner = np.zeros((3, 3))
    corner[0, 2] = 1
    top = shape.relief(corner, (2, 2), 1).vertices
    assert np.allclose(top[np.argmax(top[:, 2])], (2, 0, 1))


def test_a_relief_is_embossed_to_the_requested_height():
    heights = np.zeros((60, 60))
    heights[20:40, 20:40] = 1.0
    volume = riffler.Volume.block((0, 0, 0), (60, 60, 10), 0.5, "z")
    volume.clip((0, 0, 5), (0, 0, 1))
    mesh = shape.relief(heights, (60, 60), 2, sink=1)
    mesh = riffler.Mesh(mesh.vertices + np.array([0, 0, 5]), mesh.triangles)
    form = riffler.Volume.from_mesh(mesh, 0.5, "z", lower=volume.lower, upper=volume.upper)
    volume.add(form)
    counts, spans = volume.intervals("z")
    top = spans[:, 1].reshape(counts.shape)
    assert top[60, 60] == pytest.approx(7) and top[5, 5] == pytest.approx(5)


def star(points=5, outer=10.0, inner=4.0):
    angle = np.pi * np.arange(2 * points) / points
    radius = np.where(np.arange(2 * points) % 2, inner, outer)
    return np.c_[radius * np.cos(angle), radius * np.sin(angle), np.zeros(2 * points)]


def area(p):
    x, y = p[:, 0], p[:, 1]
    return 0.5 * abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))


@pytest.mark.parametrize("turn", [1, -1])
@pytest.mark.parametrize("direction", [(0, 0, 8), (0, 0, -8), (3, 1, 8)])
def test_outlines_that_are_not_convex_become_the_right_material(turn, direction):
    # a comb: its fan's triangles overlap and leave it
    x = [0, 20, 20, 16, 16, 12, 12, 8, 8, 4, 4, 0]
    y = [0, 0, 10, 10, 3, 3, 10, 10, 3, 3, 10, 10]
    comb = np.c_[x, y, np.zeros(12)].astype(float)
    for outline in (star(), comb):
        mesh = shape.extrude(outline[::turn], direction)
        assert mesh.audit().open_edges == 0
        assert mesh.volume == pytest.approx(area(outline) * 8)
        volume = riffler.Volume.from_mesh(mesh, 0.1, "z")
        assert volume.volume == pytest.approx(area(outline) * 8, rel=0.01)


def test_an_outline_in_another_that_turns_the_other_way_is_a_hole():
    outer, inner = star(), 0.3 * star()[::-1]
    mesh = shape.extrude([outer, inner], (0, 0, 2))
    assert mesh.volume == pytest.approx(2 * (area(outer) - area(inner)))


def test_bad_shapes_are_named():
    top, bottom = sheets(3, 3)
    for bad, words in (
        (lambda: shape.slab(top[0], bottom), "top must have the shape"),
        (lambda: shape.slab(top, bottom[:2]), "one shape"),
        (lambda: shape.slab(top, bottom, cells=np.ones((3, 3), bool)), "cells must have the shape"),
        (lambda: shape.slab(top, bottom, cells=np.zeros((2, 2), bool)), "there is none"),
        (lambda: shape.relief([1, 2], (1, 1), 1), "heights must have"),
        (lambda: shape.relief(np.ones((2, 2)), (1, 1), 0), "depth"),
        (lambda: shape.relief(np.full((2, 2), np.nan), (1, 1), 1), "not finite"),
        (lambda: shape.extrude(star()[:2], (0, 0, 1)), "number 0: needs three points"),
        (lambda: shape.extrude([star(), star() * np.nan], (0, 0, 1)), "number 1, row 0: not finite"),
        (lambda: shape.extrude(star(), (0, 0, 0)), "direction"),
    ):
        with pytest.raises(ValueError, match=words):
            bad()
