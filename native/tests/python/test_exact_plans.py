"""Plans on exact faces, judged by closed forms: a torus, and a round boss on a plate, on coarse triangles of them."""

from itertools import pairwise

import numpy as np
import pytest
import riffler
from riffler import plan

RING, TUBE = 20.0, 5.0  # mm
COARSE = 0.05  # mm: chord error of the triangles
CORNERS = np.array([[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]], float)
ROUND = np.where(np.arange(9) % 2, 0.5**0.5, 1.0)
KNOTS = np.array([0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4], float)


def torus() -> riffler.Surface:
    radius = RING + TUBE * CORNERS[:, 0]
    points = np.empty((9, 9, 3))
    points[..., 0], points[..., 1] = CORNERS[:, :1] * radius, CORNERS[:, 1:] * radius
    points[..., 2] = TUBE * CORNERS[:, 1]
    return riffler.Surface.nurbs(points, np.outer(ROUND, ROUND), KNOTS, KNOTS, 2, 2)


@pytest.fixture(scope="module")
def setup() -> plan.Setup:
    part = torus().to_mesh(COARSE)
    lower, upper = part.bounds
    return plan.Setup(part, riffler.Volume.block(lower, upper + np.array([0, 0, 1]), 0.5), exact=torus())


def off_torus(points, radius):
    """Distance of balls around `points` from the torus."""
    return np.hypot(np.hypot(points[:, 0], points[:, 1]) - RING, points[:, 2]) - TUBE - radius


def without(setup: plan.Setup) -> plan.Setup:
    return plan.Setup(setup.part, setup.stock)


REGION = [[(17, -2, 0), (29, -2, 0), (29, 2, 0), (17, 2, 0)]]
OPTIONS = {"cusp": 0.1, "tolerance": 0.004, "slopes": (0.0, 1.4), "region": REGION, "lead": 0}


@pytest.mark.parametrize("pattern", ["parallel", "waterline"])
@pytest.mark.parametrize("allowance", [0.0, 0.3])
def test_a_balls_locations_are_those_of_the_exact_torus(setup, pattern, allowance):
    tool = riffler.Tool.ball(6, 30)
    options = {**OPTIONS, "pattern": pattern, "allowance": allowance}
    before, after = plan.finish(without(setup), tool, **options), plan.finish(setup, tool, **options)
    radius = 3 + allowance
    errors = [off_torus(op.poses[op.kind == 2, :3] + [0, 0, 3], radius) for op in (before, after)]
    assert abs(errors[0]).max() > 0.01 and before.report.exact is None
    fit = after.report.exact
    assert abs(errors[1]).max() < 1e-5 and fit.kept == fit.raised == 0 and fit.before > 0.01
    cuts = np.flatnonzero(after.kind == 2)
    for share in (0.25, 0.5, 0.7):  # between the locations: within the tolerance
        chords = (1 - share) * after.poses[cuts - 1, :3] + share * after.poses[cuts, :3] + [0, 0, 3]
        assert abs(off_torus(chords, radius)).max() < 0.004


def test_a_flat_end_mill_touches_the_exact_torus(setup):
    """Its rim is a circle; the nearest of 20 000 of its points to the torus, by numpy."""
    tool = riffler.Tool.flat(6, 30)
    op = plan.finish(setup, tool, **OPTIONS)
    angle = 2 * np.pi * np.arange(20000) / 20000
    rim = 3 * np.column_stack([np.cos(angle), np.sin(angle), np.zeros(20000)])
    chosen = op.poses[op.kind == 2][:: max(1, len(op) // 40), :3]
    depth = [off_torus(tip + rim, 0).min() for tip in chosen]
    assert abs(np.array(depth)).max() < 1e-5 and op.report.exact.before > 0.01


def test_fixtures_stay_clear_and_the_program_is_checked(setup):
    tool = riffler.Tool.ball(6, 30)
    block = riffler.Volume.block((24, -8, -5), (30, 8, 9), 0.5, "xyz")
    part = plan.Setup(setup.part, setup.stock, [block], exact=torus())
    op = plan.finish(part, tool, **OPTIONS)
    assert op.poses[op.kind >= 1, 0].max() <= 21 + 1e-6
    assert len(plan.program(part, [op])) == len(op)


def test_the_same_for_any_number_of_threads(setup):
    tool, region = riffler.Tool.fillet(6, 1, 30), [[(18, -2, 0), (24, -2, 0), (24, 2, 0), (18, 2, 0)]]
    found = []
    for threads in (1, 2):
        riffler.set_threads(threads)
        found.append(plan.finish(setup, tool, **{**OPTIONS, "region": region}).poses.tobytes())
    riffler.set_threads(None)
    assert found[0] == found[1]


def test_a_surface_in_another_place_is_refused(setup):
    away = riffler.Surface.nurbs(
        [[[40, 0, 0], [40, 9, 0]], [[50, 0, 0], [50, 9, 0]]], np.ones((2, 2)), [0, 0, 1, 1], [0, 0, 1, 1], 1, 1
    )
    with pytest.raises(ValueError, match=r"exact: the part's triangles are up to .* mm from this surface"):
        plan.Setup(setup.part, setup.stock, exact=away)


PROFILE = [(0, -5), (20, -5), (20, 0), (10, 0), (10, 12), (0, 12)]  # mm: radius and height of a round boss on a plate
SIDES = 40  # of its triangles: 0.03 mm from the cylinder


def boss() -> plan.Setup:
    patches = []
    for one in pairwise(PROFILE):
        points = np.array([[(r * x, r * y, z) for r, z in one] for x, y in CORNERS])
        patches.append(riffler.Surface.nurbs(points, np.outer(ROUND, [1, 1]), KNOTS, [0, 0, 1, 1], 2, 1))
    angle = 2 * np.pi * np.arange(SIDES) / SIDES
    rings = np.array([(r * np.cos(angle), r * np.sin(angle), np.full(SIDES, z)) for r, z in PROFILE[1:-1]])
    vertices = np.concatenate([rings.transpose(0, 2, 1).reshape(-1, 3), [(0, 0, -5), (0, 0, 12)]])
    triangles = []
    for k in range(SIDES):
        n, low, high = (k + 1) % SIDES, 4 * SIDES, 3 * SIDES
        triangles += [(low, n, k), (low + 1, high + k, high + n)]
        for ring in range(3):
            a, b = ring * SIDES, (ring + 1) * SIDES
            triangles += [(a + k, a + n, b + n), (a + k, b + n, b + k)]
    part = riffler.Mesh(vertices, triangles)
    assert part.audit().open_edges == 0 and part.volume > 0
    return plan.Setup(part, riffler.Volume.block(*part.bounds, 0.5), exact=riffler.Surface(patches))


def test_a_pencil_cut_follows_the_exact_valley():
    setup, tool = boss(), riffler.Tool.ball(6, 30)
    errors = []
    for one in (plan.Setup(setup.part, setup.stock), setup):
        op = plan.pencil_operation(one, tool, tolerance=0.004)
        tips = op.poses[op.kind == 2, :3]
        assert len(tips) > 10
        errors.append(max(abs(np.hypot(tips[:, 0], tips[:, 1]) - 13).max(), abs(tips[:, 2]).max()))
    cuts = np.flatnonzero(op.kind == 2)
    middles = 0.5 * (op.poses[cuts - 1, :2] + op.poses[cuts, :2])
    assert errors[0] > 0.01 and errors[1] < 1e-5
    assert 13 - np.hypot(middles[:, 0], middles[:, 1]).min() < 0.004
    assert op.report.exact.before > 0.01 and op.report.exact.after < 1e-6 and op.report.exact.kept == 0


def test_rows_near_a_valley_cut_neither_face():
    setup, tool = boss(), riffler.Tool.ball(6, 30)
    op = plan.finish(
        setup, tool, cusp=0.1, tolerance=0.004, lead=0, region=[[(9, -2, 0), (16, -2, 0), (16, 2, 0), (9, 2, 0)]]
    )
    centres = op.poses[op.kind >= 1, :3] + [0, 0, 3]
    side = np.hypot(centres[:, 0], centres[:, 1])
    low = centres[:, 2] < 12
    assert (side[low] - 13).min() > -1e-5 and (centres[:, 2] - 3).min() > -1e-5
    assert op.report.exact.fitted > 20 and op.report.exact.kept_depth == 0


def test_axes_that_change_are_refused_on_an_exact_surface(setup):
    turning = plan.Setup(setup.part, setup.stock, machine="tcp", exact=setup.exact)
    with pytest.raises(ValueError, match="without its exact surface"):
        plan.finish(turning, riffler.Tool.ball(6, 30), orientation="normal", **OPTIONS)
