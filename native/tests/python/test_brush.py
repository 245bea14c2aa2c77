"""Volume.brush: brushes with falloff. The reference of their displacements is in native/tests/brush."""

import dataclasses

import numpy as np
import pytest
import riffler

KINDS = ("clay", "inflate", "flatten", "scrape", "fill", "grab", "snake_hook", "pinch", "crease", "twist")
AMOUNT = {"clay": 0.8, "inflate": 0.8, "crease": -0.8, "twist": 0.7}
FALLOFFS = {
    "smooth": lambda p: 3 * p**2 - 2 * p**3,
    "smoother": lambda p: 6 * p**5 - 15 * p**4 + 10 * p**3,
    "sphere": lambda p: np.sqrt(2 * p - p**2),
    "root": np.sqrt,
    "sharp": lambda p: p**2,
    "linear": lambda p: p,
    "sharper": lambda p: p**4,
    "inverse_square": lambda p: 2 * p - p**2,
    "constant": np.ones_like,
}


def bumpy_block(h=0.5):
    """A block with grooves and edges, and room above."""
    volume = riffler.Volume.empty((0, 0, 0), (40, 30, 20), h, "xyz")
    volume.add(riffler.Volume.block((0, 0, 0), (40, 30, 20), h, "xyz"))
    volume.carve(riffler.Tool.flat(200, 30), [(20, 15, 14, 0, 0, 1), (21, 15, 14, 0, 0, 1)])
    tool = riffler.Tool.ball(3, 30)
    for y in (12, 15, 18):
        volume.carve(tool, [(2, y, 13, 0, 0, 1), (38, y, 13.3, 0, 0, 1)])
    return volume


def dabs_for(kind, place=(20, 15, 14), axis=(0, 0, 1)):
    rows = [[*place, *axis]]
    if kind in ("grab", "snake_hook"):
        rows.append([place[0] + 1.5, place[1] - 1.0, place[2] + 3.0, *axis])
    return np.array(rows, float)


def clean(volume):
    audit = volume.to_mesh().audit()
    return not any(n for name, n in dataclasses.asdict(audit).items() if name not in ("components", "volume"))


def spans_outside(volume, near):
    """Bytes of the parts of all rays that are not in the ball or capsule: `near(points)` is the distance from it."""
    out = []
    for direction in "xyz":
        counts, spans = volume.intervals(direction)
        axes = {"x": (1, 2, 0), "y": (2, 0, 1), "z": (0, 1, 2)}[direction]
        i, j = np.unravel_index(np.repeat(np.arange(counts.size), counts.ravel()), counts.shape)
        for side in (0, 1):
            points = np.empty((len(spans), 3))
            for k, n in ((axes[0], i), (axes[1], j)):
                points[:, k] = volume.lower[k] + (n + 0.5) * volume.pitch
            points[:, axes[2]] = spans[:, side]
            far = near(points) > 1e-9
            out.append(points[far])
    return out


def capsule(dabs, radius):
    a, b = dabs[0, :3], dabs[-1, :3]

    def near(points):
        d = b - a
        t = np.clip((points - a) @ d / max(d @ d, 1e-30), 0, 1)
        return np.linalg.norm(points - a - t[:, None] * d, axis=1) - radius

    return near


@pytest.mark.parametrize("name", FALLOFFS)
def test_falloffs_are_blenders(name):
    t = np.linspace(0, 1.2, 25)
    expected = np.where(t < 1, FALLOFFS[name](np.clip(1 - t, 0, 1)), 0)
    assert np.allclose([riffler.falloff(name, x) for x in t], expected, atol=1e-15)


@pytest.mark.parametrize("kind", KINDS)
def test_nothing_changes_outside_the_radius_and_the_mesh_stays_closed(kind):
    volume = bumpy_block()
    before = volume.copy()
    dabs = dabs_for(kind)
    made = volume.brush(kind, dabs, 6, strength=0.7, amount=AMOUNT.get(kind, 0))
    assert made.added + made.removed > 0 and made.lost == 0
    near = capsule(dabs, 6)
    for a, b in zip(spans_outside(before, near), spans_outside(volume, near), strict=True):
        assert a.tobytes() == b.tobytes()
    assert clean(volume)
    assert volume.volume - before.volume == pytest.approx(made.added - made.removed, abs=1e-6)


def test_a_dab_of_clay_has_the_volume_of_its_falloff():
    for name, f in FALLOFFS.items():
        volume = riffler.Volume.block((0, 0, 0), (24, 24, 16), 0.25, "xyz")
        volume.carve(riffler.Tool.flat(100, 30), [(12, 12, 10, 0, 0, 1), (13, 12, 10, 0, 0, 1)])
        made = volume.brush("clay", [(12, 12, 10, 0, 0, 1)], 8, amount=0.5, falloff=name)
        t = (np.arange(4000) + 0.5) / 4000
        expected = 0.5 * 2 * np.pi * 64 * np.mean(f(1 - t) * t)
        assert made.added == pytest.approx(expected, rel=0.04 if name == "constant" else 0.01), name


def test_wrong_arguments_are_named_and_change_nothing():
    volume = bumpy_block(1.0)
    before = volume.to_bytes()
    dab = [(20, 15, 14, 0, 0, 1)]
    with pytest.raises(ValueError, match=r'kind must be "clay", .* or "twist"'):
        volume.brush("carve", dab, 3)
    with pytest.raises(ValueError, match=r'falloff must be "smooth", .* or "constant"'):
        volume.brush("clay", dab, 3, falloff="hat")
    with pytest.raises(ValueError, match="radius must be a positive length"):
        volume.brush("clay", dab, 0)
    with pytest.raises(ValueError, match="strength must be from 0 to 1"):
        volume.brush("clay", dab, 3, strength=2)
    with pytest.raises(ValueError, match="dabs"):
        volume.brush("clay", [(0, 0, 0, 0, 0, 0)], 3)
    with pytest.raises(ValueError, match='brush needs a volume of directions "xyz"'):
        riffler.Volume.block((0, 0, 0), (9, 9, 9), 1).brush("clay", dab, 3)
    with pytest.raises(riffler.Cancelled):
        volume.brush("clay", dab * 3, 3, amount=1, progress=lambda share: False)
    assert volume.to_bytes() == before


def test_a_journal_keeps_brushes(tmp_path):
    start = bumpy_block()
    start.save(tmp_path / "stock.rvol")
    journal = riffler.Journal()
    journal.set_stock(start.lower, start.upper, start.pitch, "xyz", snapshot="stock.rvol")
    journal.add_tool(1, riffler.Tool.ball(8, 30))
    volume = start.copy()
    for kind in KINDS:
        options = {"strength": 0.6, "amount": AMOUNT.get(kind, 0), "falloff": "sharp"}
        volume.brush(kind, dabs_for(kind), 4, **options)
        journal.add_stroke(1, dabs_for(kind), mode=kind, **options)
    journal.save(tmp_path / "strokes.rjournal")
    read = riffler.Journal.load(tmp_path / "strokes.rjournal")
    assert [(s.mode, s.strength, s.amount, s.falloff) for s in read.strokes] == [
        (kind, 0.6, AMOUNT.get(kind, 0), "sharp") for kind in KINDS
    ]
    assert read.replay(tmp_path).to_bytes() == volume.to_bytes()
