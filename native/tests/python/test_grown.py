"""Volume.grown: rays stay where they stand, with what they have."""

import numpy as np
import pytest
import riffler

CYCLIC = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}  # axes of u and v
BALL = riffler.Tool.ball(6, 40)
GROOVE = np.array([[-5.0, 8, 18, 0.1, 0, 1], [20, 17, 17, 0, 0.2, 1], [45, 15, 18, 0, 0, 1]])
GROOVE[:, 3:] /= np.linalg.norm(GROOVE[:, 3:], axis=1)[:, None]
ROOM = 2.5


def grooved(directions="xyz", pitch=0.5, lower=(0, 0, 0), upper=(40, 30, 20)):
    volume = riffler.Volume.block(lower, upper, pitch, directions)
    volume.carve(BALL, GROOVE)
    return volume


def lattice(volume, direction):
    """Coordinates of its rays along u and along v."""
    counts, _ = volume.intervals(direction)
    pairs = zip(CYCLIC[direction], counts.shape, strict=True)
    return [volume.lower[k] + (np.arange(n) + 0.5) * volume.pitch for k, n in pairs]


def moved(volume, grown, direction):
    """By how many rays it stands further inside, along u and v; each is where one was."""
    by = []
    for was, now in zip(lattice(volume, direction), lattice(grown, direction), strict=True):
        k = int(np.argmin(abs(now - was[0])))
        assert len(now) >= k + len(was) and abs(now[k : k + len(was)] - was).max() < 1e-6 * volume.pitch
        by.append(k)
    return by


def holds(volume, grown):
    """The same spans and normals to the bit on the same rays, and no others."""
    for d in volume.directions:
        (counts, spans), (more, theirs) = volume.intervals(d), grown.intervals(d)
        u, v = moved(volume, grown, d)
        padded = np.zeros_like(more)
        padded[u : u + counts.shape[0], v : v + counts.shape[1]] = counts
        assert np.array_equal(padded, more) and np.array_equal(spans, theirs)
        if len(volume.directions) == 3:
            assert np.array_equal(volume.normals(d), grown.normals(d))


@pytest.mark.parametrize("directions", ["xyz", "x", "y", "z"])
@pytest.mark.parametrize("room", [0.5, 2.5, 16.0, 16.5])  # pitches: one, five, a tile of them, one more
def test_every_span_and_normal_stays_to_the_bit(directions, room):
    volume = grooved(directions)
    before = volume.to_bytes()
    grown = volume.grow(volume.lower - room, volume.upper + room)
    assert np.array_equal(grown.lower, volume.lower - room) and np.array_equal(grown.upper, volume.upper + room)
    holds(volume, grown)
    assert grown.volume == pytest.approx(volume.volume, rel=1e-14) and volume.to_bytes() == before
    assert grown.grow(grown.lower, grown.upper).to_bytes() == grown.to_bytes()


def test_boxes_of_any_size_keep_their_rays_and_hold_the_requested_box():
    random = np.random.default_rng(7)
    for k in range(200):
        pitch = float(random.choice([0.1, 0.3, 0.25, 1 / 3, 7.7]))
        lower = random.uniform(-1, 1, 3) * random.choice([1, 100, 1e4])
        sides = random.choice([0.2, 0.5, 1, 1.5, 2.5, 10.5, 31.5, 33, 40.3], 3) * pitch
        volume = riffler.Volume.block(lower, lower + sides, pitch, "xyz")
        more = random.choice([-1, 0, 1e-7, 0.4, 1, 3.3, 31, 32, 33], (2, 3)) * pitch
        wanted = lower - more[0], lower + sides + more[1]
        if (wanted[0] > wanted[1]).any():
            continue
        grown = volume.grow(*wanted)
        holds(volume, grown)
        slack = 2e-6 * pitch
        assert (grown.lower <= np.minimum(wanted[0], lower) + slack).all(), k
        assert (grown.upper >= np.maximum(wanted[1], lower + sides) - slack).all(), k
        assert (grown.lower > np.minimum(wanted[0], lower) - pitch - slack).all(), k
        assert (grown.upper < np.maximum(wanted[1], lower + sides) + 2 * pitch + slack).all(), k
        stays = (more[0] <= 0) & (grown.lower == lower)
        assert stays[more[0] <= 0].all()
        assert volume.grow(grown.lower, grown.upper).to_bytes() == grown.to_bytes()
        assert riffler.Volume.from_bytes(grown.to_bytes()).to_bytes() == grown.to_bytes()


def block_in(box, lower, upper, pitch, directions):
    """The same block in a box that was larger from the start, cut out by planes."""
    volume = riffler.Volume.block(*box, pitch, directions)
    for k in range(3):
        volume.clip(lower, -np.eye(3)[k]).clip(upper, np.eye(3)[k])
    return volume


@pytest.mark.parametrize("directions", ["z", "xyz"])
def test_carving_after_growing_equals_carving_in_a_large_box(directions):
    lower, upper = np.zeros(3), np.array((40.0, 30, 20))
    box = lower - ROOM, upper + ROOM
    grown, large = grooved(directions).grow(*box), block_in(box, lower, upper, 0.5, directions)
    large.carve(BALL, GROOVE)
    assert grown.to_bytes() == large.to_bytes()
    put_on = np.array([[5.0, 15, 17, 0, 0, 1], [30, 33, 19, 0.6, 0, 0.8]])
    for mode, poses in (("add", put_on), ("remove", put_on + np.array((3, 0, 1, 0, 0, 0)))):
        did = [v.carve(BALL, poses, mode=mode).removed for v in (grown, large)]
        assert np.array_equal(*did) and did[0].sum() > 10
        assert grown.to_bytes() == large.to_bytes()


def test_a_mask_that_grows_with_the_stock_protects_the_same():
    stock, mask = grooved(), riffler.Volume.sphere((20, 15, 20), 8, 0.5, "xyz", lower=(0, 0, 0), upper=(40, 30, 20))
    box = stock.lower - 3, stock.upper + 3
    across = np.array([[20.0, -5, 18, 0, 0, 1], [20, 35, 18, 0, 0, 1]])
    grown = stock.grow(*box)
    grown.carve(BALL, across, protect=mask.grow(*box))
    stock.carve(BALL, across, protect=mask)
    holds(stock, grown)


@pytest.mark.parametrize("directions", ["z", "xyz"])
@pytest.mark.parametrize("room, moved", [(0.75, 0), (1.0, 40)])
def test_the_surface_does_not_move(directions, room, moved):
    """Made larger five times: inside of the old box every vertex is one that was there, to the bit of its float32. A
    vertex outside of its cell has a place that depends on the cell's number by 3: it may go there, some float32 steps
    (4e-6 mm here), where the box grows by another number of pitches."""
    volume = grooved(directions, 0.25)
    before = volume.to_mesh()
    for _ in range(5):
        volume = volume.grow(volume.lower - room, volume.upper + room)
    after = volume.to_mesh()
    assert len(before.triangles) == len(after.triangles) and after.audit().open_edges == 0
    was, now = (np.unique(np.asarray(m.vertices), axis=0) for m in (before, after))
    inner = ((was > 0.25) & (was < np.array((40, 30, 20)) - 0.25)).all(axis=1)
    there = {tuple(v) for v in now.tolist()}
    gone = np.array([tuple(v) not in there for v in was.tolist()])
    assert inner.sum() > 6000 and (gone & inner).sum() <= moved
    for v in was[gone]:
        assert abs(now - v).max(axis=1).min() <= 16 * np.spacing(np.float32(40))


def test_shared_tiles_stay_shared():
    block = riffler.Volume.block((0, 0, 0), (400, 400, 400), 0.5, "xyz")
    for room in (1.0, 16.0):
        grown = block.grow(block.lower - room, block.upper + room)
        assert grown.nbytes < 5 * block.nbytes < 0.05 * 24 * 3 * 800**2


def test_threads_do_not_change_a_byte(monkeypatch):
    volume, made = grooved(), []
    for threads in ("1", "3"):
        monkeypatch.setenv("RIFFLER_THREADS", threads)
        made.append(volume.grow(volume.lower - 1.7, volume.upper).to_bytes())
    assert made[0] == made[1]


def test_an_empty_volume_grows_too():
    empty = riffler.Volume.empty((0, 0, 0), (4, 3, 2), 0.5, "xyz").grow(upper=(9, 9, 9))
    assert empty.volume == 0 and np.array_equal(empty.upper, (9, 9, 9)) and np.array_equal(empty.lower, (0, 0, 0))


@pytest.mark.parametrize(
    "box, words",
    [
        (((np.nan, 0, 0), None), "lower"),
        ((None, (0, np.inf, 0)), "upper"),
        (((0, 0, 9), (1, 1, 1)), "lower must not be above upper"),
        (((-1e9, -1e9, -1e9), (1e9, 1e9, 1e9)), "at most"),
        (((-1e300, 0, 0), None), "."),
    ],
)
def test_absurd_boxes_are_refused_before_memory_is_allocated(box, words):
    volume = grooved()
    before = volume.to_bytes()
    with pytest.raises(ValueError, match=words):
        volume.grow(*box)
    assert volume.to_bytes() == before


def test_a_progress_of_false_cancels_the_call():
    with pytest.raises(riffler.Cancelled):
        grooved().grow((-3, -3, -3), progress=lambda share: False)
