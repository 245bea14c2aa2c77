"""riffler.plan: pencil cuts, their passes and order, and the report on a part."""

import itertools

import numpy as np
import pytest
import riffler

RADIUS = 3.0
BALL = riffler.Tool.ball(2 * RADIUS, 30)
FACES = [
    [0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4],
    [2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5],
]  # fmt: skip


def box(lower, upper, inside_out=False):
    vertices = [[(upper if i >> k & 1 else lower)[k] for k in range(3)] for i in range(8)]
    triangles = np.array(FACES)
    return riffler.Mesh(vertices, triangles[:, ::-1] if inside_out else triangles)


def both(a, b):
    return riffler.Mesh(np.vstack([a.vertices, b.vertices]), np.vstack([a.triangles, b.triangles + len(a.vertices)]))


def step():
    """A wall x < 0 on a floor z < 0, two shells that cross."""
    return both(box([-20, 0, -5], [0, 40, 15]), box([-20, 0, -5], [30, 40, 0]))


def test_a_wall_on_a_floor_has_one_path():
    paths = riffler.plan.pencil(step(), BALL)
    assert len(paths) == 1 and paths.ends == [("part", "part")] and paths.reason == ""
    (p,) = paths
    assert p.radius == RADIUS and not p.closed and p.length == pytest.approx(40, abs=1e-4)
    assert np.allclose(p.centres[:, [0, 2]], RADIUS, atol=1e-9)
    n = len(p)
    assert p.centres.shape == (n, 3) and p.contacts.shape == (n, 2, 3) and p.normals.shape == (n, 2, 3)
    assert np.allclose(p.centres[:, None] - p.contacts, RADIUS * p.normals, atol=1e-5)
    assert paths.rest_area == pytest.approx(paths.rest_areas.sum())
    assert len(paths.rest_areas) == 24


def test_the_inside_of_a_box_has_twelve_paths_that_meet():
    paths = riffler.plan.pencil(box([0, 0, 0], [50, 40, 30], inside_out=True), BALL)
    assert len(paths) == 12 and set(paths.ends) == {("corner", "corner")}
    ends = np.array([p.centres[k] for p in paths for k in (0, -1)])
    _, counts = np.unique(ends, axis=0, return_counts=True)
    assert list(counts) == [3] * 8
    assert paths.rest_area == pytest.approx(9400 - 2 * (44 * 34 + 44 * 24 + 34 * 24), rel=0.02)


def test_convex_parts_have_no_path_and_a_reason():
    paths = riffler.plan.pencil(box([0, 0, 0], [50, 40, 30]), BALL)
    assert paths == [] and "reaches every point" in paths.reason and paths.stats.starts == 0


def test_passes_lie_on_both_sides_of_the_valley():
    paths = riffler.plan.pencil(step(), BALL, passes=3, stepover=0.5)
    assert [e[0] for e in paths.ends] == ["part", "pass", "pass", "pass", "pass"]
    offsets = sorted((p.centres[:, 0].mean() - RADIUS, p.centres[:, 2].mean() - RADIUS) for p in paths[1:])
    assert np.allclose(offsets, [(0, 0.5), (0, 1), (0.5, 0), (1, 0)], atol=1e-9)
    for p in paths[1:]:
        assert np.array_equal(p.contacts[:, 0], p.contacts[:, 1])
        assert np.allclose(p.centres - p.contacts[:, 0], RADIUS * p.normals[:, 0], atol=1e-5)
    by_height = riffler.plan.pencil(step(), BALL, passes=2, scallop=0.02)
    assert by_height[1].centres.shape[1] == 3
    gap = np.abs(by_height[1].centres - RADIUS)[:, [0, 2]].max()
    assert RADIUS - np.sqrt(RADIUS**2 - (gap / 2) ** 2) == pytest.approx(0.02)


def test_rest_after_a_larger_tool_has_the_corners_of_a_pocket():
    """Ø4 after Ø12 in an open pocket of 40 × 40 × 8 mm: 4 × 36 mm along the floor, 4 × 6 mm up its corners."""
    corners = np.array([(-20, -20), (20, -20), (20, 20), (-20, 20)], float)
    rings = [np.column_stack([k * corners, np.full(4, z)]) for k, z in ((1, 0), (1, 8), (2, 8))]
    triangles = [(0, 1, 2), (0, 2, 3)]
    for low in (0, 4):
        for k in range(4):
            a, b, c, d = low + (k + 1) % 4, low + k, low + 4 + k, low + 4 + (k + 1) % 4
            triangles += [(a, b, c), (a, c, d)]
    pocket = riffler.Mesh(np.concatenate(rings), triangles)
    paths = riffler.plan.pencil(pocket, riffler.Tool.ball(4, 30), reference_tool=riffler.Tool.ball(12, 40))
    assert sum(p.length for p in paths) == pytest.approx(168, abs=1e-3) and len(paths) == 8
    reach = np.abs(np.concatenate([p.centres[:, :2] for p in paths])).max()
    assert reach == pytest.approx(18, abs=1e-6)
    assert paths.rest_area < 0.5 * paths.reference_area
    assert paths.reference_area == pytest.approx(paths.reference_areas.sum())


@pytest.mark.parametrize("name", ["tool", "reference_tool"])
@pytest.mark.parametrize("tool", [riffler.Tool.flat(8, 30), riffler.Tool.fillet(8, 1, 30)])
def test_tools_without_a_ball_at_the_tip_are_refused(name, tool):
    given = {"tool": BALL, name: tool}
    with pytest.raises(ValueError, match=f"^{name}: .*take a ball end, a taper with a ball tip"):
        riffler.plan.pencil(step(), **given)
    given[name] = riffler.Tool.taper(4 if name == "reference_tool" else 1, 0.1, 12, 80)
    assert len(riffler.plan.pencil(step(), **given)) == 1


def test_order_paths_makes_links_short():
    rng = np.random.default_rng(4)
    boxes = None
    for x in rng.permutation(12):
        mesh = box([40.0 * x, 0, 0], [40.0 * x + 20, 20, 20], inside_out=True)
        boxes = mesh if boxes is None else both(boxes, mesh)
    paths = riffler.plan.pencil(boxes, BALL)

    def air(order):
        ends = [(paths[i].centres[0], paths[i].centres[-1])[:: -1 if turned else 1] for i, turned in order]
        return sum(np.linalg.norm(b[0] - a[1]) for a, b in itertools.pairwise(ends))

    order = riffler.plan.order_paths(paths)
    assert sorted(i for i, _ in order) == list(range(len(paths)))
    assert order == riffler.plan.order_paths(paths)
    assert air(order) < 0.5 * air([(i, False) for i in range(len(paths))])
    assert riffler.plan.order_paths([]) == []


def test_analyse_reports_volume_units_and_defects():
    part = riffler.plan.analyse(box([0, 0, 0], [50, 40, 30]))
    assert part.closed and part.outward and part.units == "mm" and part.warnings == ()
    assert part.volume == pytest.approx(60000) and part.components == 1 and part.degenerate_share == 0
    inside = riffler.plan.analyse(box([0, 0, 0], [0.05, 0.04, 0.03], inside_out=True))
    assert inside.outward is False and inside.units == "m" and len(inside.warnings) == 2
    whole = box([0, 0, 0], [50, 40, 30])
    opened = riffler.plan.analyse(riffler.Mesh(whole.vertices, whole.triangles[1:]))
    assert not opened.closed and opened.open_edges == 3 and opened.outward is None


def test_progress_cancels():
    shares = []
    riffler.plan.pencil(step(), BALL, progress=shares.append)
    assert shares and shares[-1] == 1
    with pytest.raises(riffler.Cancelled):
        riffler.plan.pencil(step(), BALL, progress=lambda share: False)


@pytest.mark.parametrize(
    "wrong",
    [
        {"tolerance": 0},
        {"tolerance": float("nan")},
        {"passes": 0},
        {"stepover": -1},
        {"scallop": 5},
        {"scallop": 0.1, "stepover": 0.1},
        {"bitangency_angle": 4},
        {"minimum_length": -1},
        {"overthickness": -1},
        {"reference_tool": riffler.Tool.ball(5, 30)},
    ],
)
def test_wrong_calls_are_refused(wrong):
    with pytest.raises(ValueError, match=next(iter(wrong))):
        riffler.plan.pencil(step(), BALL, **wrong)
    with pytest.raises(ValueError, match="triangles"):
        riffler.plan.pencil(riffler.Mesh([], []), BALL)
