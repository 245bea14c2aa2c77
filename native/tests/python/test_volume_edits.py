"""riffler.Volume as a whole: empty, clip, parts, contains, resampled."""

import numpy as np
import pytest
import riffler

BOX = ((0, 0, 0), (40, 30, 20))
BALL = riffler.Tool.ball(10, 40)


def dented(pitch, directions="xyz"):
    """A block with the lower half of a ball of 10 mm taken out of its top, and what is left of it in closed form."""
    volume = riffler.Volume.block(*BOX, pitch, directions)
    volume.carve(BALL, np.array([[20.0, 15, 15, 0, 0, 1]] * 2))
    return volume, 40 * 30 * 20 - 2 / 3 * np.pi * 5**3


def clean(mesh):
    audit = mesh.audit()
    names = ("open_edges", "nonmanifold_edges", "nonmanifold_vertices", "degenerate", "duplicates")
    return not any(getattr(audit, n) for n in names)


def test_an_empty_volume_takes_added_material():
    volume = riffler.Volume.empty(*BOX, 0.5, "xyz")
    assert volume.volume == 0 and len(volume.to_mesh().triangles) == 0
    assert volume.add(riffler.Volume.block(*BOX, 0.5, "xyz")).volume == 40 * 30 * 20
    with pytest.raises(ValueError, match="pitch"):
        riffler.Volume.empty(*BOX, 0, "z")


def test_clip_cuts_in_place_and_returns_the_volume():
    volume, _ = dented(0.5)
    assert volume.clip((20, 15, 10), (0, 3, 0)) is volume
    assert volume.to_mesh().bounds[1][1] == pytest.approx(15, abs=1e-6)
    assert clean(volume.to_mesh())
    before = volume.to_bytes()
    with pytest.raises(ValueError, match="normal"):
        volume.clip((0, 0, 0), (0, 0, 0))
    with pytest.raises(riffler.Cancelled):
        volume.clip((0, 0, 10), (0, 0, 1), progress=lambda share: False)
    assert volume.to_bytes() == before


def test_a_sawn_block_has_two_parts():
    volume = riffler.Volume.block(*BOX, 0.5, "xyz")
    saw = riffler.Tool.flat(2, 60)
    volume.carve(saw, np.array([[15.0, -5, -1, 0, 0, 1], [15, 40, -1, 0, 0, 1]]))
    parts = volume.parts()
    assert [p.volume for p in parts] == pytest.approx([24 * 600, 14 * 600])
    assert sum(p.volume for p in parts) == pytest.approx(volume.volume, abs=1e-9)
    assert all(clean(p.to_mesh()) for p in parts)
    assert len(volume.parts(minimum=9000)) == 1
    with pytest.raises(ValueError, match="least"):
        volume.parts(minimum=-1)
    with pytest.raises(riffler.Cancelled):
        volume.parts(progress=lambda share: False)


def test_contains_agrees_with_the_closed_form():
    volume, _ = dented(0.25)
    points = np.random.default_rng(2).uniform((-2, -2, -2), (42, 32, 22), (20000, 3))
    inside = ((points >= BOX[0]) & (points <= BOX[1])).all(axis=1)
    column = points - (20, 15, 20)
    hollow = np.linalg.norm(column * [1, 1, 1], axis=1) < 5
    near = np.abs(np.linalg.norm(column, axis=1) - 5) < 0.25
    assert (volume.contains(points) == (inside & ~hollow))[~near].all()
    with pytest.raises(ValueError, match="points, row 1"):
        volume.contains([[0, 0, 0], [np.nan, 0, 0]])


@pytest.mark.parametrize("pitch", [0.25, 0.4, 1.0])
def test_resampling_finer_and_coarser_keeps_the_shape(pitch):
    volume, exact = dented(0.5)
    again = volume.resample(pitch)
    assert (again.pitch, again.directions) == (pitch, "xyz")
    assert np.array_equal(again.lower, volume.lower) and np.array_equal(again.upper, volume.upper)
    assert again.volume == pytest.approx(exact, rel=1e-3)
    there = volume.to_mesh()
    assert np.abs(again.to_mesh().deviation(there)).max() < 0.2 * max(pitch, 0.5)
    assert again.resample(0.5).volume == pytest.approx(volume.volume, rel=1e-3)


def test_resampling_copies_unchanged_or_takes_another_box_or_directions():
    volume, exact = dented(0.5)
    same = volume.resample(0.5)
    assert same.to_bytes() == volume.to_bytes() and same is not volume
    assert volume.resample(0.5, "z").directions == "z"
    wider = volume.resample(0.5, lower=(-5, -5, -5), upper=(45, 35, 25))
    assert wider.volume == pytest.approx(exact, rel=1e-3)
    half = volume.resample(0.5, upper=(40, 15, 20))
    assert half.volume == pytest.approx(exact / 2, rel=1e-3)
    assert riffler.Volume.empty(*BOX, 0.5, "xyz").resample(1).volume == 0
    with pytest.raises(ValueError, match="pitch"):
        volume.resample(-1)
    with pytest.raises(riffler.Cancelled):
        volume.resample(0.25, progress=lambda share: False)
