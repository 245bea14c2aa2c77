"""Booleans and the .rvol file as Python sees them, on volumes that were carved."""

import numpy as np
import pytest
import riffler


def carved(seed: int, directions: str, moves: int = 9) -> riffler.Volume:
    """A block with oblique, turning cuts all over it, some of them only just touching the surface."""
    rng = np.random.default_rng(seed)
    volume = riffler.Volume.block((0, 0, 0), (20, 16, 10), 0.4, directions)
    tips = rng.uniform((-2, -2, 0), (22, 18, 10.001), (moves, 3)).round(int(rng.integers(0, 4)))
    axes = rng.normal(size=(moves, 3)) * 0.2 + (0, 0, 1)
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    for tool in (riffler.Tool.ball(3, 30), riffler.Tool.fillet(4, 1, 30), riffler.Tool.flat(2, 30)):
        volume.carve(tool, np.hstack([tips, axes]))
        tips, axes = tips[::-1], axes[::-1]
    return volume


def dense(volume: riffler.Volume, direction: str, where: np.ndarray) -> np.ndarray:
    """Whether each ray has material at the positions `where`: (nu, nv, len(where)) booleans."""
    counts, spans = volume.intervals(direction)
    ray = np.repeat(np.arange(counts.size), counts.ravel())
    inside = np.zeros((counts.size, len(where)), dtype=bool)
    for r, (near, far) in zip(ray, spans, strict=True):
        inside[r] |= (where > near) & (where < far)
    return inside.reshape(*counts.shape, len(where))


def equal(a: riffler.Volume, b: riffler.Volume) -> bool:
    return all(np.array_equal(x, y) for d in a.directions for x, y in zip(a.intervals(d), b.intervals(d), strict=True))


@pytest.mark.parametrize("operation", ["subtract", "add", "intersect"])
def test_booleans_agree_with_points(operation):
    a, b = carved(1, "xyz"), carved(2, "xyz")
    where = np.linspace(0.003, 20, 333)
    expected = {}
    for d in "xyz":
        x, y = dense(a, d, where), dense(b, d, where)
        expected[d] = {"subtract": x & ~y, "add": x | y, "intersect": x & y}[operation]
    assert getattr(a, operation)(b) is a
    for d in "xyz":
        np.testing.assert_array_equal(dense(a, d, where), expected[d])


def test_a_volume_may_be_combined_with_itself():
    a = carved(3, "z")
    before = a.copy()
    assert equal(a.add(a), before) and equal(a.intersect(a), before)
    assert a.revision == before.revision
    assert a.subtract(a).volume == 0
    assert before.volume > 0


def test_another_grid_is_refused():
    a, b = carved(1, "z"), riffler.Volume.block((0, 0, 0), (20, 16, 10), 0.5)
    before = a.volume
    with pytest.raises(ValueError, match="pitch"):
        a.subtract(b)
    assert a.volume == before


def test_a_cancelled_call_leaves_the_volume(tmp_path):
    a, b = carved(1, "xyz"), carved(2, "xyz")
    before = a.copy()
    with pytest.raises(riffler.Cancelled):
        a.subtract(b, progress=lambda share: False)
    assert equal(a, before) and a.revision == before.revision
    with pytest.raises(riffler.Cancelled):
        a.save(tmp_path / "a.rvol", progress=lambda share: False)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("directions", ["z", "xyz"])
def test_carved_volumes_read_back(tmp_path, monkeypatch, seed, directions):
    volume = carved(seed, directions)
    for d in volume.directions:
        counts, spans = volume.intervals(d)
        assert np.isfinite(spans).all() and (spans[:, 0] < spans[:, 1]).all()
        ray = np.repeat(np.arange(counts.size), counts.ravel())
        same = ray[1:] == ray[:-1]
        assert (spans[1:, 0] > spans[:-1, 1])[same].all()
    volume.save(tmp_path / "a.rvol")
    loaded = riffler.Volume.load(tmp_path / "a.rvol")
    assert equal(loaded, volume)
    assert (loaded.pitch, loaded.directions) == (volume.pitch, volume.directions)
    assert np.array_equal(loaded.lower, volume.lower) and np.array_equal(loaded.upper, volume.upper)
    if directions == "xyz":
        for d in "xyz":
            np.testing.assert_array_equal(loaded.normals(d), volume.normals(d))
    for threads in ("1", "3"):
        monkeypatch.setenv("RIFFLER_THREADS", threads)
        loaded.save(tmp_path / "b.rvol")
        assert (tmp_path / "b.rvol").read_bytes() == (tmp_path / "a.rvol").read_bytes()
    # A loaded volume carves on as the original does.
    path = np.array([[0, 3, 6, 0, 0, 1], [20, 9, 5, 0, 0.6, 0.8]])
    for v in (volume, loaded):
        v.carve(riffler.Tool.ball(3, 30), path)
    assert equal(loaded, volume)


def test_bad_files_are_format_errors(tmp_path):
    path = tmp_path / "a.rvol"
    carved(1, "z").save(path)
    data = path.read_bytes()
    for bad in (b"", data[:60], data[:-5], data + b"x", data[:200] + b"\0" + data[201:], b"solid " + data):
        path.write_bytes(bad)
        with pytest.raises(riffler.FormatError, match=r"^a\.rvol, byte \d+: "):
            riffler.Volume.load(path)
    with pytest.raises(riffler.FormatError, match=r"none\.rvol"):
        riffler.Volume.load(tmp_path / "none.rvol")
    with pytest.raises(RuntimeError, match=r"a\.rvol"):
        carved(1, "z").save(tmp_path / "nowhere" / "a.rvol")
