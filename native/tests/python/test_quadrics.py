"""Volume.sphere and Volume.cylinder against signed distances and closed forms that share nothing with the core."""

import re

import numpy as np
import pytest
import riffler

SHIFT = 5e-10  # pitches: by so much rays stand off their places
AXES = [(0, 0, 1), (0, 0, -3), (1, 0, 0), (0, 1, 0), (1, 2, 3), (-1, 1, 0), (1e-12, 0, 1), (0, 1, 1e-12), (1, 1e-9, 0)]
CYCLIC = {"x": (1, 2, 0), "y": (2, 0, 1), "z": (0, 1, 2)}  # axes of u, v and of the ray itself


class Ball:
    def __init__(self, centre, radius):
        self.centre, self.radius = np.array(centre, float), radius
        self.exact = 4 / 3 * np.pi * radius**3

    def volume(self, pitch, directions="xyz", **more):
        return riffler.Volume.sphere(self.centre, self.radius, pitch, directions, **more)

    def distance(self, points):
        return np.linalg.norm(points - self.centre, axis=-1) - self.radius

    def normals(self, points):
        """Those that the surface may have at points on it."""
        return [(points - self.centre) / self.radius]


class Bar:
    def __init__(self, centre, radius, height, axis):
        self.centre, self.radius, self.height = np.array(centre, float), radius, height
        self.given, self.axis = axis, np.array(axis) / np.linalg.norm(axis)
        self.exact = np.pi * radius**2 * height

    def volume(self, pitch, directions="xyz", **more):
        return riffler.Volume.cylinder(
            self.centre, self.radius, self.height, pitch, directions, axis=self.given, **more
        )

    def _split(self, points):
        along = (points - self.centre) @ self.axis
        return along, points - self.centre - along[..., None] * self.axis

    def distance(self, points):
        """Signed; only a bound outside next to the rims, where no test uses it."""
        along, off = self._split(points)
        return np.maximum(np.linalg.norm(off, axis=-1) - self.radius, abs(along) - self.height / 2)

    def normals(self, points):
        along, off = self._split(points)
        side, cap = np.linalg.norm(off, axis=-1) - self.radius, abs(along) - self.height / 2
        flat = np.sign(along)[:, None] * self.axis
        near_side, near_cap = (abs(d) < 1e-6 * self.radius for d in (side, cap))
        return [
            np.where(near_side[:, None], off / self.radius, flat),
            np.where(near_cap[:, None], flat, off / self.radius),
        ]


SOLIDS = [
    *(Ball((0.1, -0.2, 0.3), 7.3), Ball((1e5, -1e5, 1e5), 4.0)),
    *(Bar((0.1, -0.2, 0.3), 5.0, 9.0, axis) for axis in AXES),
    Bar((1e5, 1e5, -1e5), 5.0, 9.0, (3, 1, 2)),
]


def feet(volume, direction):
    """(nu, nv, 3): where its rays pass the box's lower side."""
    u, v, w = CYCLIC[direction]
    counts, _ = volume.intervals(direction)
    out = np.empty((*counts.shape, 3))
    out[..., u] = (volume.lower[u] + (np.arange(counts.shape[0]) + 0.5) * volume.pitch)[:, None]
    out[..., v] = volume.lower[v] + (np.arange(counts.shape[1]) + 0.5) * volume.pitch
    out[..., w] = volume.lower[w]
    return out


def ends(volume, direction):
    """(n, 2, 3): the points at which its spans end."""
    counts, spans = volume.intervals(direction)
    points = np.repeat(np.repeat(feet(volume, direction).reshape(-1, 3), counts.ravel(), axis=0)[:, None], 2, axis=1)
    points[..., CYCLIC[direction][2]] = spans
    return points


@pytest.mark.parametrize("solid", SOLIDS, ids=lambda s: f"{type(s).__name__}{tuple(s.centre)}{getattr(s, 'given', '')}")
def test_every_ray_has_its_ends_on_the_surface(solid):
    pitch = 0.25
    volume = solid.volume(pitch)
    slack = 2 * SHIFT * pitch + 4 * np.spacing(abs(solid.centre).max() + 20)
    for direction in "xyz":
        found = ends(volume, direction)
        assert abs(solid.distance(found)).max() < slack
        assert solid.distance(found.mean(axis=1)).max() < 0
        allowed = [n.reshape(found.shape) for n in solid.normals(found.reshape(-1, 3))]
        dots = [np.einsum("nij,nij->ni", volume.normals(direction), n) for n in allowed]
        assert np.maximum.reduce(dots).min() > 1 - 1e-8  # rad²/2: packed within 5e-5 rad
        counts, _ = volume.intervals(direction)
        assert counts.max() == 1
        missed = feet(volume, direction)[counts == 0]
        w = CYCLIC[direction][2]
        for share in np.linspace(0, 1, 801):
            missed[..., w] = volume.lower[w] + share * (volume.upper[w] - volume.lower[w])
            assert solid.distance(missed).min(initial=1) > -slack


@pytest.mark.parametrize("axis", AXES)
def test_a_cylinders_rays_are_those_of_quadratic_and_slabs(axis):
    """In long doubles, by the quadratic formula where a ray is not along the side, and with all of its cap if it is."""
    solid = Bar((0.1, -0.2, 0.3), 5.0, 9.0, axis)
    volume = solid.volume(0.5)
    a = np.array(axis, np.longdouble)
    a /= np.sqrt((a * a).sum())
    for direction in "xyz":
        d = np.eye(3, dtype=np.longdouble)[CYCLIC[direction][2]]
        foot = feet(volume, direction).reshape(-1, 3).astype(np.longdouble) - solid.centre
        across, off = d - (d @ a) * a, foot - (foot @ a)[:, None] * a
        qa, qb, qc = across @ across, off @ across, (off * off).sum(axis=1) - np.longdouble(25)
        with np.errstate(all="ignore"):
            slabs = (np.array([[-4.5], [4.5]], np.longdouble) - foot @ a) / (d @ a)
            root = np.sqrt(qb * qb - qa * qc)
            sides = np.array([(-qb - root) / qa, (-qb + root) / qa])
        if d @ a == 0:
            slabs = np.where(abs(foot @ a) < 4.5, np.longdouble("inf"), np.nan) * [[-1], [1]]
        if qa < 1e-20:  # along the side: 1e-10 rad over 10 mm are far below what is asked here
            sides = np.where(qc < 0, np.longdouble("inf"), np.nan) * [[-1], [1]]
        near, far = np.maximum(slabs.min(axis=0), sides[0]), np.minimum(slabs.max(axis=0), sides[1])
        length = np.where(far > near, far - near, 0).astype(float)
        counts, spans = volume.intervals(direction)
        mine = np.zeros(counts.size)
        mine[counts.ravel() > 0] = spans[:, 1] - spans[:, 0]
        assert abs(mine - length).max() < 2e-4  # √(2 r · shift): what the shift may be worth to a ray that grazes


@pytest.mark.parametrize("make", [lambda c: Ball(c, 6.0), lambda c: Bar(c, 4.0, 10.0, (1, 2, 3))])
def test_volumes_converge_as_the_pitch_halves(make):
    """Midpoint sums of chords err by h^1.5 where a shape's shadow ends, over many places in the lattice."""
    places = np.random.default_rng(4).uniform(-1, 1, (12, 3))
    box = {"lower": (-9, -9, -9), "upper": (9, 9, 9)}
    rms = []
    for pitch in (1.0, 0.5, 0.25, 0.125):
        errors = [make(c).volume(pitch, "z", **box).volume / make(c).exact - 1 for c in places]
        rms.append(np.sqrt(np.mean(np.square(errors))))
    orders = np.log2(np.array(rms[:-1]) / rms[1:])
    assert orders.mean() > 1.3 and rms[-1] < 2e-4, (orders, rms)


@pytest.mark.parametrize("directions, share", [("z", 0.75), ("xyz", None)])
@pytest.mark.parametrize(
    "solid, of_three",  # vertices within this part of a pitch; next to a curved rim they are less exact
    [
        (Ball((0.1, 0.2, 0.3), 8.0), 1e-4),
        (Bar((0.1, 0.2, 0.3), 5, 9, (0, 0, 1)), 0.02),
        (Bar((0.1, 0.2, 0.3), 5, 9, (1, 2, 3)), 0.04),
    ],
)
def test_meshes_are_closed_and_lie_on_the_surface(solid, of_three, directions, share):
    pitch, share = 0.25, share or of_three
    mesh = solid.volume(pitch, directions).to_mesh()
    audit = mesh.audit()
    assert not any(getattr(audit, n) for n in ("open_edges", "nonmanifold_edges", "nonmanifold_vertices", "degenerate"))
    # across one direction's rays a wall is known within half a pitch along each of two axes
    assert abs(solid.distance(mesh.vertices.astype(float))).max() < share * pitch


def test_a_cylinders_rim_is_sharp():
    solid = Bar((0, 0, 0), 5.0, 9.0, (0, 0, 1))
    co = solid.volume(0.25).to_mesh().vertices.astype(float)
    on_rim = (abs(np.hypot(co[:, 0], co[:, 1]) - 5) < 0.0025) & (abs(abs(co[:, 2]) - 4.5) < 0.0025)
    angle = np.sort(np.arctan2(co[on_rim & (co[:, 2] > 0), 1], co[on_rim & (co[:, 2] > 0), 0]))
    assert 5 * np.diff(angle).max() < 2 * 0.25  # mm between neighbours: nowhere is it cut off


def test_quadrics_agree_with_meshes_of_many_facets():
    r, n = 5.0, 700  # 980 000 facets; their sagitta is below r (1 - cos(π / n)) · 2
    polar, turn = np.meshgrid(np.linspace(0, np.pi, n + 1)[1:-1], np.arange(n) * 2 * np.pi / n, indexing="ij")
    grid = r * np.stack([np.sin(polar) * np.cos(turn), np.sin(polar) * np.sin(turn), np.cos(polar)], axis=-1)
    vertices = np.vstack([[[0, 0, r]], grid.reshape(-1, 3), [[0, 0, -r]]])
    ring = 1 + np.arange(n - 1)[:, None] * n + np.arange(n)
    after = np.roll(ring, -1, axis=1)
    first = np.stack([np.zeros(n, int), ring[0], after[0]], axis=1)
    last = np.stack([np.full(n, len(vertices) - 1), after[-1], ring[-1]], axis=1)
    between = [np.stack([ring[:-1], ring[1:], after[1:]], -1), np.stack([ring[:-1], after[1:], after[:-1]], -1)]
    triangles = np.vstack([first, *(b.reshape(-1, 3) for b in between), last]).astype(np.int32)
    assert len(triangles) > 970_000
    box = {"lower": (-5, -5, -5), "upper": (5, 5, 5)}
    faceted = riffler.Volume.from_mesh(riffler.Mesh(vertices, triangles), 0.25, "xyz", **box)
    exact = riffler.Volume.sphere((0, 0, 0), r, 0.25, "xyz")
    sagitta = r * (1 - np.cos(np.pi / n)) * 2
    for direction in "xyz":
        counts, spans = exact.intervals(direction)
        theirs, other = faceted.intervals(direction)
        both = (counts == 1) & (theirs == 1)
        assert both.sum() > 0.995 * counts.sum()
        mine = spans[both[counts == 1]]
        assert (abs(mine - other[both[theirs == 1]]) < sagitta * r / np.maximum(abs(mine), 0.05)).all()


def test_threads_do_not_change_a_byte(monkeypatch):
    made = []
    for threads in ("1", "3"):
        monkeypatch.setenv("RIFFLER_THREADS", threads)
        made.append([s.volume(0.25).to_bytes() for s in SOLIDS[:6]])
    assert made[0] == made[1]


def test_rays_that_touch_the_side_or_run_in_it_give_valid_spans():
    """A radius of whole and half pitches: rays at r to the last bit, and a cylinder's side through rays along it."""
    for r in (2.0, 2.25):
        ball = riffler.Volume.sphere((0, 0, 0), r, 0.5, "xyz", lower=(-3, -3, -3), upper=(3, 3, 3))
        counts, spans = ball.intervals("z")
        assert (spans[:, 0] < spans[:, 1]).all() and np.isfinite(spans).all()
        bar = riffler.Volume.cylinder((0, 0, 0), r, 4, 0.5, "xyz", lower=(-3, -3, -3), upper=(3, 3, 3))
        audit = bar.to_mesh().audit()
        assert audit.open_edges == 0 and audit.components == 1
        counts, spans = bar.intervals("z")
        x = -2.75 + 0.5 * np.arange(12)
        d = np.hypot(x[:, None], x)
        assert (counts[d < r - 1e-6] == 1).all() and (counts[d > r + 1e-6] == 0).all()
        assert np.array_equal(spans, np.tile([-2.0, 2.0], (len(spans), 1)))


@pytest.mark.parametrize("directions", ["z", "xyz"])
def test_a_ray_on_the_boxs_side_or_just_beyond_it_counts_the_material_within(directions):
    """Across 10.5 pitches the last ray is on the side; across 0.2, through a plate, the only one is beyond it. The same
    as from_mesh."""
    lying = riffler.Volume.cylinder((0, 0, 0), 5, 10.5, 1, directions, axis=(1, 0, 0))
    shorter = riffler.Volume.cylinder((0, 0, 0), 5, 10, 1, directions, axis=(1, 0, 0))
    assert lying.volume == pytest.approx(1.05 * shorter.volume, rel=1e-12)
    disc = riffler.Volume.cylinder((0, 0, 0), 5, 0.2, 1, directions)
    assert disc.volume == pytest.approx(0.2 * np.pi * 25, rel=0.02)
    box = {"lower": (2.9, 1.9, 0.9), "upper": (3.9, 2.9, 1.1)}  # of one ray along z, and a lone layer of cells
    speck = riffler.Volume.sphere((3.4, 2.4, 1), 0.1, 1, directions, **box)
    assert all(speck.intervals(d)[0].sum() == 1 for d in directions)
    assert np.allclose(speck.intervals("z")[1], [[0.9, 1.1]], atol=1e-12)


def test_normals_on_the_boxs_sides_point_out_of_the_box():
    half = riffler.Volume.sphere((0, 0, 0), 5, 0.25, "xyz", upper=(5, 5, 0))
    assert half.volume == pytest.approx(2 / 3 * np.pi * 125, rel=1e-3)
    _, spans = half.intervals("z")
    assert (spans[:, 1] == 0).all() and np.allclose(half.normals("z")[:, 1], (0, 0, 1), atol=1e-4)
    beside = riffler.Volume.sphere((0, 0, 0), 1, 0.25, "xyz", lower=(2, 2, 2), upper=(3, 3, 3))
    assert beside.volume == 0
    block = riffler.Volume.block((-6, -6, -6), (6, 6, 6), 0.25, "xyz")
    ball = riffler.Volume.sphere((0, 0, 0), 5, 0.25, "xyz", lower=block.lower, upper=block.upper)
    assert block.subtract(ball).volume == pytest.approx(12**3 - 4 / 3 * np.pi * 125, rel=1e-3)


@pytest.mark.parametrize(
    "call, words",
    [
        (lambda: riffler.Volume.sphere((0, 0, 0), 0, 0.1), "radius"),
        (lambda: riffler.Volume.sphere((0, 0, 0), -1, 0.1), "radius"),
        (lambda: riffler.Volume.sphere((0, 0, 0), np.nan, 0.1), "radius"),
        (lambda: riffler.Volume.sphere((0, 0, 0), np.inf, 0.1), "radius"),
        (lambda: riffler.Volume.sphere((0, np.nan, 0), 1, 0.1), "centre"),
        (lambda: riffler.Volume.sphere((0, 0, 0), 1, 0), "pitch"),
        (lambda: riffler.Volume.sphere((1e5, 0, 0), 1e-13, 0.1), "coordinates"),
        (lambda: riffler.Volume.sphere((0, 0, 0), 1, 0.1, "w"), "directions"),
        (lambda: riffler.Volume.sphere((0, 0, 0), 1e9, 0.1, "xyz"), "at most"),
        (lambda: riffler.Volume.cylinder((0, 0, 0), 1, 0, 0.1), "height"),
        (lambda: riffler.Volume.cylinder((0, 0, 0), 1, np.nan, 0.1), "height"),
        (lambda: riffler.Volume.cylinder((0, 0, 0), 0, 1, 0.1), "radius"),
        (lambda: riffler.Volume.cylinder((0, 0, 0), 1, 1, 0.1, axis=(0, 0, 0)), "axis"),
        (lambda: riffler.Volume.cylinder((0, 0, 0), 1, 1, 0.1, axis=(0, np.inf, 0)), "axis"),
    ],
)
def test_absurd_arguments_are_refused_by_name(call, words):
    with pytest.raises(ValueError, match=words):
        call()


@pytest.mark.parametrize("directions", ["z", "xyz"])
def test_shapes_that_no_ray_meets_are_refused_and_the_remedy_works(directions):
    box = {"lower": (-4, -4, -4), "upper": (4, 4, 4)}
    for make in (
        lambda pitch: riffler.Volume.sphere((0, 0, 0), 0.0123, pitch, directions, **box),
        lambda pitch: riffler.Volume.cylinder((0.3, 0, 0), 0.0123, 7, pitch, directions, axis=(1, 0.37, 2)),
    ):
        with pytest.raises(ValueError, match="no ray meets") as error:
            make(1.0)
        at_most = float(re.search(r"at most ([\d.e-]+) mm", str(error.value))[1])
        assert make(at_most).volume > 0


def test_an_axis_may_have_any_length():
    one = riffler.Volume.cylinder((0, 0, 0), 5, 9, 0.5, "xyz", axis=(1, 2, 3)).to_bytes()
    for scale in (2.0**-1000, 2.0**900):
        axis = np.array((1, 2, 3)) * scale
        assert riffler.Volume.cylinder((0, 0, 0), 5, 9, 0.5, "xyz", axis=axis).to_bytes() == one


def test_a_progress_of_false_cancels_the_call():
    with pytest.raises(riffler.Cancelled):
        riffler.Volume.sphere((0, 0, 0), 5, 0.05, "xyz", progress=lambda share: False)
