"""Volume.soften: the smooth brush."""

import dataclasses

import numpy as np
import pytest
import riffler

BOX = ((0, 0, 0), (30, 20, 12))


def block(directions="xyz", pitch=0.25):
    return riffler.Volume.block(*BOX, pitch, directions)


def bumpy():
    """A block with 60 small hollows in its lid."""
    volume = block()
    random = np.random.default_rng(4)
    ball = riffler.Tool.ball(2, 30)
    for x, y in random.uniform((11, 6), (19, 14), (60, 2)):
        pose = [x, y, 11.8, 0, 0, 1]
        volume.carve(ball, np.array([pose, pose]))
    return volume


def lid(volume, radius):
    """Heights of the lid within ``radius`` of its middle."""
    counts, spans = volume.intervals("z")
    last = np.cumsum(counts.ravel()) - 1
    heights = spans[last, 1].reshape(counts.shape)
    x, y = np.meshgrid(*[(np.arange(n) + 0.5) * volume.pitch for n in counts.shape], indexing="ij")
    return heights[np.hypot(x - 15, y - 10) < radius]


def clean(mesh):
    audit = mesh.audit()
    return not any(n for name, n in dataclasses.asdict(audit).items() if name not in ("components", "volume"))


def test_a_stroke_levels_roughness_and_reports_the_moved_volume():
    volume = bumpy()
    before, rough = volume.volume, lid(volume, 3)
    stroke = [[x, 10, 12] for x in np.linspace(12, 18, 13)]
    moved = volume.smooth(stroke, 5, strength=1.0)
    assert len(moved) == 13 and moved.removed.shape == moved.added.shape == (13,)
    assert (moved.removed > 0).all() and (moved.added > 0).all()
    assert moved.added.sum() - moved.removed.sum() == pytest.approx(volume.volume - before, abs=1e-9)
    assert lid(volume, 3).std() < 0.4 * rough.std()
    assert clean(volume.to_mesh())


def test_single_dabs_give_the_same_bytes_as_a_stroke():
    one, two = bumpy(), bumpy()
    for centre in [(14, 10, 12), (16, 10, 12)]:
        assert len(one.smooth(centre, 3)) == 1
    two.smooth([(14, 10, 12), (16, 10, 12)], 3)
    assert one.to_bytes() == two.to_bytes()
    assert len(two.smooth(np.empty((0, 3)), 3)) == 0


def test_a_plane_costs_nothing_and_keeps_its_bytes():
    volume = block()
    before, revision = volume.to_bytes(), volume.revision
    moved = volume.smooth((15, 10, 12), 5, strength=1.0)
    assert moved.removed.sum() == moved.added.sum() == 0
    assert volume.to_bytes() == before and volume.revision == revision
    counters = volume.take_counters()
    assert counters.moves == 1 and counters.rays_tested == counters.tiles_changed == 0


def test_protected_material_stays():
    volume = bumpy()
    mask = block()
    mask.carve(riffler.Tool.flat(30, 30), np.array([[0.0, -20, 0, 0, 0, 1], [0, 40, 0, 0, 0, 1]]))  # x > 15 is left
    before, free = volume.copy(), volume.copy()
    moved = volume.smooth((15, 10, 12), 5, strength=1.0, protect=mask)
    assert 0 < moved.removed.sum() < free.smooth((15, 10, 12), 5, strength=1.0).removed.sum()
    counts, spans = volume.copy().intersect(mask).intervals("z")
    counts_before, spans_before = before.intersect(mask).intervals("z")
    assert (counts == counts_before).all() and (spans == spans_before).all()
    itself = volume.to_bytes()
    volume.smooth((15, 0, 12), 3, strength=1.0, protect=volume)  # which leaves air to grow into only
    assert volume.to_bytes() == itself


def test_the_mesher_sees_few_bricks_change():
    volume = riffler.Volume.block((0, 0, 0), (60, 60, 30), 0.25, "xyz")
    mesher = riffler.Mesher(volume)
    volume.smooth((30, 0, 30), 4, strength=1.0)
    assert 0 < len(mesher.update(volume)) <= 12


def test_bad_arguments_are_named_and_a_cancelled_call_leaves_no_trace():
    volume = bumpy()
    with pytest.raises(ValueError, match='soften needs a volume of directions "xyz"'):
        block("z").smooth((1, 2, 3), 5)
    with pytest.raises(ValueError, match="centres must have the shape"):
        volume.smooth([[1, 2]], 5)
    with pytest.raises(ValueError, match="centres, row 1: not finite"):
        volume.smooth([[1, 2, 3], [1, np.nan, 3]], 5)
    with pytest.raises(ValueError, match="radius must be a positive length in mm"):
        volume.smooth((1, 2, 3), 0)
    with pytest.raises(ValueError, match="strength must be from 0 to 1"):
        volume.smooth((1, 2, 3), 5, strength=2)
    with pytest.raises(ValueError, match="protect must have the same grid as the volume, but its pitch differs"):
        volume.smooth((1, 2, 3), 5, protect=block(pitch=0.5))
    before = volume.to_bytes()
    shares = []
    with pytest.raises(riffler.Cancelled):
        volume.smooth([(15, 10, 12)] * 3, 5, progress=lambda share: shares.append(share) or len(shares) < 2)
    assert shares == sorted(shares)
    assert volume.to_bytes() == before
