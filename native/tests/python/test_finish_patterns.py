"""Patterns of finishing on synthetic and real parts, checked by finish_judge.py, which shares no code with the core."""

import math
import os

import numpy as np
import pytest
import riffler
from finish_judge import PARTS, Judge, boss_on_plate, cone, dome, heights, setup_of, solid_under, steps, z_map
from machining_parts import terrain
from riffler import plan

MODELS = os.path.join(os.path.dirname(__file__), *[".."] * 4, "shared", "models")
TOOLS = {
    "ball": riffler.Tool.ball(diameter=6, length=40),
    "bull": riffler.Tool.fillet(diameter=6, corner_radius=1.5, length=40),
    "flat": riffler.Tool.flat(diameter=4, length=40),
}
BALL, FLAT = TOOLS["ball"], TOOLS["flat"]
UPRIGHT = math.pi / 2
CUSP, TOLERANCE = 0.08, 0.02
# Every cutter and part, and every pattern with two cutters, where RIFFLER_LONG is set; else those that differ most.
LONG = bool(os.environ.get("RIFFLER_LONG"))
WATERLINES = [("dome", "ball"), ("cone", "bull"), ("steps", "flat"), ("torus", "ball"), ("cube at 10°", "flat")]
OTHERS = [
    *(("dome", "scallop", "ball"), ("torus", "scallop", "ball"), ("cube at 10°", "scallop", "bull")),
    *(("dome", "spiral", "bull"), ("steps", "spiral", "ball"), ("cone", "radial", "ball"), ("torus", "radial", "bull")),
]
if LONG:
    WATERLINES = [(name, tool) for name in PARTS for tool in TOOLS]
    OTHERS = [(name, p, tool) for name in PARTS for p in ("scallop", "spiral", "radial") for tool in ("ball", "bull")]


def degrees(low, high):
    return math.radians(low), math.radians(high)


def finished(part, tool, pattern, slopes, **more):
    options = {"cusp": CUSP, "tolerance": TOLERANCE, "slopes": slopes, **more}
    return plan.finish(setup_of(part), tool, pattern, **options)


def assert_kept(op, judge, least=60, cusp=CUSP, tolerance=TOLERANCE, share=0.0):
    """Asserts that no sample is cut too deep, and at most ``share`` of the reachable samples are left too high."""
    assert judge.reachable.sum() >= least, "the judge has hardly a sample"
    deep, standing = judge.deep(op, tolerance), judge.standing(op, cusp, tolerance)
    assert len(deep) == 0, f"cut too deep at {deep[:3]}"
    assert len(standing) <= share * judge.reachable.sum(), (
        f"left too high at {len(standing)} of {judge.reachable.sum()}: {standing[:3]}"
    )


# ---- the promise, for every pattern, cutter and part


@pytest.mark.parametrize(("name", "tool"), WATERLINES)
def test_waterline_cuts_steep_faces_to_the_cusp_and_no_deeper(name, tool):
    part, slopes = PARTS[name](), degrees(25, 90)
    op = finished(part, TOOLS[tool], "waterline", slopes)
    assert_kept(op, Judge(part, TOOLS[tool], 0.0, slopes), least=30)
    program = plan.program(setup_of(part), [op])  # simulates the operation: rapids, shank and gouges
    assert len(program) == len(op)


@pytest.mark.parametrize(("name", "pattern", "tool"), OTHERS)
def test_other_patterns_cut_to_the_cusp_and_no_deeper(name, pattern, tool):
    part, slopes = PARTS[name](), degrees(0, 65)
    op = finished(part, TOOLS[tool], pattern, slopes)
    assert_kept(op, Judge(part, TOOLS[tool], 0.0, slopes))
    assert len(plan.program(setup_of(part), [op])) == len(op)


def test_a_flat_end_finds_level_faces_that_are_smaller_than_the_distance_of_places():
    part, tool, slopes = terrain(np.random.default_rng([33, 0])), riffler.Tool.flat(5.656459, 20.5), degrees(0, 5)
    options = {"cusp": 0.167, "tolerance": 0.0147, "allowance": 0.2056, "angle": 1.22}
    op = finished(part, tool, "scallop", slopes, **options)
    judge = Judge(part, tool, 0.2056, slopes, count=800, seed=0)
    assert_kept(op, judge, least=1, cusp=0.167, tolerance=0.0147)


@pytest.mark.parametrize("pattern", ["scallop", "spiral", "radial"])
def test_a_flat_end_finishes_level_faces_in_every_pattern(pattern):
    part, slopes = steps(), degrees(0, 5)
    op = finished(part, FLAT, pattern, slopes)
    assert_kept(op, Judge(part, FLAT, 0.0, slopes))
    cuts = op.poses[op.kind == 2][:, 2]
    assert np.abs(cuts[:, None] - [3, 7, 10]).min(axis=1).max() <= TOLERANCE


def test_a_row_that_ends_at_a_riser_ends_on_its_own_face():
    """Where the part lies on the grid of places decides where rows end; they did so between both faces."""
    part = steps()
    moved = riffler.Mesh(np.add(part.vertices, [0.26018, -0.40367, 0.0]), part.triangles)
    op = finished(moved, FLAT, "scallop", degrees(0, 5))
    cuts = op.poses[op.kind == 2][:, 2]
    assert np.abs(cuts[:, None] - [3, 7, 10]).min(axis=1).max() <= TOLERANCE


@pytest.mark.parametrize("pattern", plan.PATTERNS)
def test_the_allowance_stays_on_walls_and_on_tops(pattern):
    part, slopes = cone(), degrees(30 if pattern == "waterline" else 0, 65)
    op = finished(part, BALL, pattern, slopes, allowance=0.4)
    assert_kept(op, Judge(part, BALL, 0.4, slopes))
    assert len(Judge(part, BALL, 0.0, slopes).standing(op, CUSP, TOLERANCE)) > 0, "nothing was left on"


# ---- waterline


def test_waterline_leaves_no_step_where_the_part_has_none():
    """The height left at neighbouring samples of a cone's wall differs by at most cusp and tolerance."""
    part = cone()
    op = finished(part, BALL, "waterline", degrees(30, 90), cusp=0.02, tolerance=0.005)
    turn = 2 * math.pi * (np.arange(48) + 0.5) / 48
    height = np.linspace(4.0, 8.0, 400)
    apothem = (8 - (height - 2) / math.tan(math.pi / 3)) * math.cos(math.pi / 48)
    for t in turn[::12]:
        left = z_map(op, 15 + apothem * math.cos(t), 15 + apothem * math.sin(t), step=0.02) - height
        assert left.min() >= -0.011 and left.max() <= 0.06  # upright, on a wall of 60°: twice the distance
        assert np.abs(np.diff(left)).max() < 0.02


def test_upright_walls_are_upright():
    part = boss_on_plate(10.0)
    op = finished(part, FLAT, "waterline", degrees(80, 90), cusp=0.02, tolerance=0.01)
    cuts = op.poses[op.kind == 2]
    turn = math.radians(10)
    local = (cuts[:, :2] - 15) @ np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
    boss = (cuts[:, 2] < 7.9) & (np.abs(local).max(axis=1) < 12)
    beside = boss & (np.abs(local[:, 1]) < 4.4)  # along the walls of length 9, which lie at x = ±6
    gap = np.abs(local[beside, 0]) - 6 - 2
    assert beside.sum() > 10
    assert gap.min() >= -1e-6 and gap.max() <= 0.01 + 1e-6  # at every height
    assert np.ptp(cuts[boss][:, 2]) > 3


def test_waterline_reaches_the_floor_and_the_lowest_wall():
    part = steps()
    op = finished(part, FLAT, "waterline", degrees(80, 90))
    cuts = op.poses[op.kind == 2]
    from_middle = np.hypot(cuts[:, 0] - 15, cuts[:, 1] - 15)
    for floor, radius in ((0.0, 14.0), (3.0, 9.0), (7.0, 5.0)):
        wall = np.abs(from_middle - radius - 2) < 0.1
        assert abs(cuts[wall][:, 2].min() - floor) <= TOLERANCE


def test_waterline_follows_walls_whose_lower_edge_is_almost_level():
    """In meshes of dexels, and in single precision, an edge at the lowest level has an end a rounding error higher."""
    part = solid_under(np.array([0.0, 24.0]), np.full((2, 2), 4.0))
    points = np.array(part.vertices)
    points[points[:, 2] == 0, 2] += [0.0, 1e-9, 0.0, 1e-7]
    part = riffler.Mesh(points, part.triangles)
    op = finished(part, FLAT, "waterline", degrees(25, 90))
    assert_kept(op, Judge(part, FLAT, 0.0, degrees(25, 90), count=800))


@pytest.mark.parametrize("floor", [4.3, 4.9])
def test_waterline_cuts_down_to_a_floor_between_two_levels(floor):
    """Walls that lean by 0.001, as of castings, over a floor that falls by 11 degrees: no level is at their foot."""
    profile = np.array([floor + 6, floor + 6, floor, floor - 3])
    part = solid_under(np.array([0.0, 10.0, 10.006, 25.0]), profile[:, None] * np.ones(4))
    op = finished(part, BALL, "waterline", degrees(30, 90), cusp=0.2, tolerance=0.05)
    assert_kept(op, Judge(part, BALL, 0.0, degrees(30, 90), count=1500), cusp=0.2, tolerance=0.05)


def test_waterline_climbs_or_not():
    part = dome()
    for climb in (True, False):
        op = finished(part, BALL, "waterline", degrees(40, 80), climb=climb)
        a, b = op.poses[:-1, :2] - 15, op.poses[1:, :2] - 15
        cut = (op.kind[1:] == 2) & (np.linalg.norm(b - a, axis=1) > 1e-3)
        turning = (
            a[cut][:, 0] * b[cut][:, 1] - a[cut][:, 1] * b[cut][:, 0]
        )  # clockwise about the part: it is on the right
        assert (turning < 0).all() if climb else (turning > 0).all()


def test_waterline_goes_down_a_wall_without_lifting_the_tool():
    op = finished(cone(), BALL, "waterline", degrees(40, 80))
    levels = op.poses[op.kind == 2][:, 2]
    assert (np.diff(levels) <= 1e-9).all()
    assert op.report.stats["retracts"] <= 1 and op.report.stats["direct"] >= 5
    assert (op.kind == 0).sum() <= 6


def test_waterline_without_cuts_gives_the_reason():
    walls = [((0, 0), (30, 30), 0, 4), ((0, 0), (30, 13), 4, 12), ((0, 17), (30, 30), 4, 12)]  # a slot of 4 mm
    boxes = [riffler.Volume.block((*a, low), (*b, high), 5, "xyz").to_mesh() for a, b, low, high in walls]
    vertices = np.concatenate([np.asarray(m.vertices) for m in boxes])
    before = np.cumsum([0, *[len(m.vertices) for m in boxes[:-1]]])
    part = riffler.Mesh(
        vertices, np.concatenate([np.asarray(m.triangles) + k for m, k in zip(boxes, before, strict=True)])
    )
    slot = [np.array([(1, 12, 0), (29, 12, 0), (29, 18, 0), (1, 18, 0)], float)]
    fits = finished(part, riffler.Tool.flat(3, 40), "waterline", degrees(60, 90), region=slot)
    assert len(fits) and (fits.poses[fits.kind == 2][:, 2].min() - 4) < 0.02
    large = finished(part, riffler.Tool.flat(8, 40), "waterline", degrees(60, 90), region=slot)
    assert len(large) == 0
    assert "waterline: the tool of 8 mm touches no face steeper than 60°" in large.reason
    tops = finished(part, FLAT, "waterline", degrees(20, 50))
    assert len(tops) == 0 and "waterline: no face steeper than 20° is meant" in tops.reason
    with pytest.raises(ValueError, match="slopes: waterline finishes faces from 3° on"):
        finished(part, FLAT, "waterline", degrees(0, 1))


def test_waterline_reports_the_level_faces_that_it_leaves():
    op = finished(dome(), BALL, "waterline", (0.0, UPRIGHT))
    (flat,) = [b for b in op.report.blocked if "flatter than 3°" in b.reason]
    assert flat.length > 50
    assert not finished(dome(), BALL, "waterline", degrees(10, 90)).report.blocked


# ---- scallop, spiral, radial


def test_spiral_is_one_curve_and_radial_rows_meet_at_the_centre():
    flat = riffler.Mesh([(0, 0, 2), (20, 0, 2), (20, 20, 2), (0, 20, 2)], [(0, 1, 2), (0, 2, 3)])
    setup = plan.Setup(flat, riffler.Volume.block((0, 0, 0), (20, 20, 4), 0.5))
    square = [np.array([(4, 4, 0), (16, 4, 0), (16, 16, 0), (4, 16, 0)], float)]
    op = plan.finish(setup, BALL, "spiral", cusp=0.1, region=square, centre=(10, 10, 0))
    cuts = op.poses[op.kind == 2][:, :2] - 10
    inner = np.hypot(cuts[:, 0], cuts[:, 1]) < 5.9  # within the square the turns are whole
    turn = np.unwrap(np.arctan2(cuts[inner][:, 1], cuts[inner][:, 0]))
    assert (np.diff(turn) >= -1e-9).all() or (np.diff(turn) <= 1e-9).all()
    op = plan.finish(setup, BALL, "radial", cusp=0.1, centre=(5, 8, 0))
    a, b = op.poses[:-1, :2] - (5, 8), op.poses[1:, :2] - (5, 8)
    cut = op.kind[1:] == 2
    assert np.abs(a[cut][:, 0] * b[cut][:, 1] - a[cut][:, 1] * b[cut][:, 0]).max() < 1e-6
    assert np.hypot(*op.poses[op.kind == 2][:, :2].T - np.array([[5], [8]])).min() < 0.1
    with pytest.raises(ValueError, match="centre"):
        plan.finish(setup, BALL, "radial", centre=(math.nan, 0, 0))


# ---- selected faces


@pytest.mark.parametrize("pattern", plan.PATTERNS)
def test_curves_and_triangles_choose_what_is_finished(pattern):
    part = boss_on_plate()
    slopes = degrees(60, 90) if pattern == "waterline" else degrees(0, 70)
    far = 14.0 if pattern == "waterline" else 8.0  # with a wall of the boss, or level only
    square = np.array([(8, 2, 0), (22, 2, 0), (22, far, 0), (8, far, 0)], float)
    op = finished(part, BALL, pattern, slopes, region=[square])
    cuts = op.poses[op.kind == 2]
    assert len(cuts)
    if pattern != "waterline":  # on the level plate the tip is the contact
        assert cuts[:, 0].min() >= 8 - 0.021 and cuts[:, 0].max() <= 22.021 and cuts[:, 1].max() <= 8.021
        assert min(cuts[:, 0].min() - 8, 22 - cuts[:, 0].max()) <= 0.7  # half a row from the border for scallop

    def within(points, triangles):
        return (np.abs(points[:, 0] - 15) < 6.9) & (points[:, 1] > 2.1) & (points[:, 1] < far - 0.1)

    assert_kept(op, Judge(part, BALL, 0.0, slopes, count=6000, within=within), least=20)
    normals = np.cross(*(np.asarray(part.vertices)[np.asarray(part.triangles)][:, k] -
                         np.asarray(part.vertices)[np.asarray(part.triangles)][:, 0] for k in (1, 2)))  # fmt: skip
    corners = np.asarray(part.vertices)[np.asarray(part.triangles)]
    upright = np.abs(normals[:, 2]) < 1e-9
    boss = corners[:, :, 2].max(axis=1) > 7.9
    chosen = boss & (upright if pattern == "waterline" else ~upright & (normals[:, 2] > 0))
    op = finished(part, BALL, pattern, slopes, region=np.flatnonzero(chosen))
    again = finished(part, BALL, pattern, slopes, region=chosen)
    assert op.poses.tobytes() == again.poses.tobytes()
    cuts = op.poses[op.kind == 2]
    assert len(cuts)
    # At most, the ball rolls over the edge of the top.
    assert cuts[:, 2].min() >= (3 if pattern == "waterline" else 5) - 1e-6
    assert_kept(op, Judge(part, BALL, 0.0, slopes, count=6000, within=lambda _, triangles: chosen[triangles]), least=20)


def test_regions_are_refused_by_name():
    part = boss_on_plate()
    for region, text in (
        ([len(part.triangles)], "region: triangle 24 is none of the part's 24"),
        ([-1], "region: triangle -1"),
        (np.zeros(24, bool), "region: no triangle is marked"),
        (np.zeros(5, bool), "region: 5 marks, and the part has 24 triangles"),
        ([0.5, 1.5], "region must be closed curves"),
    ):
        with pytest.raises(ValueError, match=text):
            plan.finish(setup_of(part), BALL, region=region)


# ---- all patterns


@pytest.mark.parametrize("pattern", plan.PATTERNS)
def test_the_same_bytes_for_any_number_of_threads(monkeypatch, pattern):
    part, found = boss_on_plate(), []
    for threads in ("1", "2", "4"):
        monkeypatch.setenv("RIFFLER_THREADS", threads)
        found.append(plan.finish(setup_of(part), BALL, pattern, cusp=0.1, angle=0.3).poses.tobytes())
    assert found[0] and found[0] == found[1] == found[2]


@pytest.mark.parametrize("pattern", plan.PATTERNS)
def test_a_cancelled_pattern_leaves_nothing(pattern):
    shares = []

    def stop(share):
        shares.append(share)
        return len(shares) < 4

    with pytest.raises(riffler.Cancelled):
        plan.finish(setup_of(dome()), BALL, pattern, cusp=0.02, progress=stop)
    assert len(shares) == 4 and shares == sorted(shares)


@pytest.mark.parametrize("pattern", plan.PATTERNS)
def test_a_holder_that_is_in_the_way_is_named(pattern):
    short = riffler.Tool.ball(diameter=3, length=4).with_holder([(4, 8, 30, 8)])
    slopes = degrees(40, 90) if pattern == "waterline" else (0, UPRIGHT)
    op = finished(boss_on_plate(), short, pattern, slopes, cusp=0.2)
    assert "the holder meets the part" in [b.reason for b in op.report.blocked]


@pytest.mark.skipif(not os.path.isdir(MODELS), reason="the test parts in ../shared/models are not there")
@pytest.mark.parametrize(("pattern", "slopes"), [("waterline", (30, 90)), ("scallop", (0, 45)), ("spiral", (0, 45))])
@pytest.mark.parametrize("name", ["ktoolcor", "suzanne"])
def test_real_models_are_cut_to_the_cusp_and_no_deeper(name, pattern, slopes):
    part = riffler.Mesh.read(os.path.join(MODELS, f"{name}.stl"))
    lower, upper = part.bounds
    part = riffler.Mesh((np.asarray(part.vertices) - lower) * (40 / (upper - lower).max()), part.triangles)
    op = finished(part, BALL, pattern, degrees(*slopes), cusp=0.2, tolerance=0.05)
    judge = Judge(part, BALL, 0.0, degrees(*slopes), count=3000)
    if name == "suzanne":  # an open model: from above, the judge cannot see covered samples either
        judge.points, judge.normals, judge.reachable = (
            x[judge.reachable] for x in (judge.points, judge.normals, judge.reachable)
        )
    assert_kept(op, judge, least=15, cusp=0.2, tolerance=0.05)


@pytest.mark.parametrize("pattern", ["parallel", "spiral", "radial"])
def test_rows_in_a_small_region_need_few_points_and_cut_it_all(pattern):
    part = dome()
    setup = plan.Setup(part, riffler.Volume.from_mesh(part, 0.5))
    square = np.array([[18, 14, 0], [21, 14, 0], [21, 17, 0], [18, 17, 0]], float)
    options = {"cusp": 0.04, "tolerance": 0.01}
    ball = riffler.Tool.ball(diameter=2, length=20)
    whole = plan.finish(setup, ball, pattern, **options)
    inner = plan.finish(setup, ball, pattern, region=[square], **options)
    assert len(inner) and inner.report.stats["drops"] < 0.2 * whole.report.stats["drops"]
    x, y = np.random.default_rng(2).uniform((18.1, 14.1), (20.9, 16.9), (300, 2)).T
    left = z_map(inner, x, y, step=0.04) - heights(part, x, y)
    assert left.min() >= -0.011 and left.max() <= 0.051


def test_a_region_in_a_long_face_is_cut_in_whole_rows():
    """A straight row needs no point between the ends of a long face, which are both outside of the region."""
    side = 200.0
    part = solid_under(np.array([0, side]), np.full((2, 2), 5.0))
    square = np.array([(120, 20, 0), (140, 20, 0), (140, 40, 0), (120, 40, 0)], float)
    setup = plan.Setup(part, riffler.Volume.block((0, 0, 0), (side, side, 7), pitch=2))
    op = plan.finish(setup, BALL, "parallel", cusp=0.05, tolerance=0.02, region=[square])
    cut = np.flatnonzero(op.kind[1:] == 2)
    ways = op.poses[cut + 1, :3] - op.poses[cut, :3]
    spacing = 2 * math.sqrt(2 * 3 * 0.05)
    assert len(cut) <= 30 and np.linalg.norm(ways, axis=1).sum() < 1.25 * 20 * 20 / spacing
    x, y = np.random.default_rng(3).uniform(20.1, 39.9, (2, 400))
    assert (z_map(op, x + 100, y, step=0.04) - 5).max() <= 0.071
