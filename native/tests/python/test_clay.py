"""Volume.carve with mode and protect: what artists call clay."""

import numpy as np
import pytest
import riffler

BOX = ((0, 0, 0), (30, 20, 12))
BALL = riffler.Tool.ball(6, 30)
ALONG = np.array([[5.0, 10, 8, 0, 0, 1], [25, 10, 8, 0, 0, 1]])


def slab(directions="xyz"):
    """The lower 8 mm of the box."""
    volume = riffler.Volume.block(*BOX, 0.25, directions)
    level = np.array([[-20.0, 10, 8, 0, 0, 1], [50, 10, 8, 0, 0, 1]])
    volume.carve(riffler.Tool.flat(60, 20), level)
    return volume


def clean(mesh):
    audit = mesh.audit()
    names = ("open_edges", "nonmanifold_edges", "nonmanifold_vertices", "degenerate", "duplicates")
    return not any(getattr(audit, n) for n in names)


@pytest.mark.parametrize("directions", ["z", "xyz"])
def test_material_is_added_where_the_cutter_sweeps_within_the_box(directions):
    volume = slab(directions)
    before = volume.volume
    put = volume.carve(BALL, ALONG, mode="add", dt=0.1)
    # the ball's lower half reaches from z = 8 to 11, its shaft on to the box's lid
    half = np.pi * 3**2 / 2 * 20 + 2 / 3 * np.pi * 3**3
    shaft = (6 * 20 + np.pi * 3**2) * 1
    assert put.removed.sum() == pytest.approx(volume.volume - before)
    assert volume.volume - before == pytest.approx(half + shaft, rel=5e-3)
    assert np.linalg.norm(put.force) > 0
    assert clean(volume.to_mesh())


def test_protected_material_stays_and_the_rest_is_removed():
    volume = slab()
    keep = riffler.Volume.block(*BOX, 0.25, "xyz")
    keep.carve(riffler.Tool.flat(40, 30), np.array([[35.0, 10, 0, 0, 0, 1], [35, 10, 0, 0, 0, 1]]))
    down = ALONG - [0, 0, 2, 0, 0, 0]
    before = volume.copy()
    cut = volume.carve(BALL, down, protect=keep)
    inside = before.copy().intersect(keep)
    assert volume.copy().intersect(keep).volume == pytest.approx(inside.volume, abs=1e-9)
    assert cut.removed.sum() == pytest.approx(before.volume - volume.volume)
    unprotected = before.copy()
    assert unprotected.carve(BALL, down).removed.sum() > cut.removed.sum() > 0
    assert clean(volume.to_mesh())


def test_a_mask_is_painted_as_material_is_added():
    mask = slab().subtract(slab())
    assert mask.volume == 0
    mask.carve(BALL, ALONG - [0, 0, 3, 0, 0, 0], mode="add")
    volume = slab()
    volume.take_counters()
    assert volume.carve(BALL, ALONG - [0, 0, 1, 0, 0, 0], protect=mask).removed.sum() == 0
    assert volume.take_counters().tiles_changed == 0


def test_bad_modes_and_other_grids_are_named():
    volume = slab()
    with pytest.raises(ValueError, match='mode must be "remove" or "add", not "smear"'):
        volume.carve(BALL, ALONG, mode="smear")
    coarse = riffler.Volume.block(*BOX, 0.5, "xyz")
    with pytest.raises(ValueError, match="protect must have the same grid as the volume, but its pitch differs"):
        volume.carve(BALL, ALONG, protect=coarse)
    with pytest.raises(ValueError, match="row 1: not finite"):
        volume.carve(BALL, [ALONG[0], ALONG[1] * np.nan], mode="add")
    before = volume.to_bytes()
    with pytest.raises(riffler.Cancelled):
        volume.carve(BALL, ALONG, mode="add", progress=lambda share: False)
    assert volume.to_bytes() == before


def test_a_volume_may_protect_itself():
    volume = slab()
    before = volume.to_bytes()
    volume.carve(BALL, ALONG - [0, 0, 3, 0, 0, 0], protect=volume)
    assert volume.to_bytes() == before
