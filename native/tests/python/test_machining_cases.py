"""Cases that users of other planners report, on small parts, judged by height maps in numpy."""

import math

import numpy as np
import pytest
import riffler
from finish_judge import heights, solid_under, z_map
from machining_judge import CELL, SLIVER, HeightMap
from machining_parts import box
from riffler import plan
from riffler.plan.operations import CUT, LEAD

SIZE = (26, 20, 7)
FLAT = riffler.Tool.flat(diameter=4, length=25)


def carved(*boxes, pitch=0.25):
    """A block of 26 × 20 × 7 mm without these boxes."""
    frame = {"lower": (0, 0, 0), "upper": SIZE, "pitch": pitch, "directions": "xyz"}
    volume = riffler.Volume.from_mesh(box((0, 0, 0), SIZE), **frame)
    for low, high in boxes:
        volume -= riffler.Volume.from_mesh(box(np.array(low, float), np.array(high, float)), **frame)
    return volume.to_mesh(tolerance=0.01)


def stock(top=7.5):
    return riffler.Volume.block((0, 0, 0), (*SIZE[:2], top), 0.25)


def cut(op, top=7.5):
    heights = HeightMap((0, 0, 0), (*SIZE[:2], top))
    thick, widths = heights.cut(op)
    return heights, thick, widths


def test_an_outside_cut_that_turns_into_an_inner_corner_is_as_wide_as_requested():
    part = carved(((10, 8, 2), (27, 21, 8)))  # an L seen from above, with an inner corner of 90°
    op = plan.rough(plan.Setup(part, stock()), FLAT, stepdown=5, engagement=0.3, allowance=0.2)
    heights, _, (widths, lengths) = (lambda h, t, w: (h, t, w.T))(*cut(op))
    limit = 0.3 * 4 + 2.5 * CELL
    assert lengths[widths > limit].sum() < 0.002 * lengths.sum(), np.sort(widths)[-5:]
    assert widths.max() < 1.25 * 0.3 * 4 + 2.5 * CELL
    inside = heights.z[np.ix_(heights.x > 12.5, heights.y > 10.5)]
    assert inside.max() <= 2 + 0.2 + 0.05, "the corner is cleared"


@pytest.mark.parametrize("engagement", [0.06])
def test_a_small_step_leaves_nothing_in_the_arms_of_a_pocket(engagement):
    # A T of two grooves, one hardly wider than the cutter, the other a little more.
    part = carved(((3, 12, 3), (23, 17.5, 8)), ((11, 2, 3), (15.7, 13, 8)))
    op = plan.rough(plan.Setup(part, stock()), FLAT, stepdown=4, engagement=engagement, allowance=0.1)
    assert not op.report.blocked
    heights, _, _ = cut(op)
    for x, y in (((5.2, 20.8), (14.2, 15.3)), ((12.9, 13.8), (4.2, 15))):
        left = heights.z[np.ix_((heights.x > x[0]) & (heights.x < x[1]), (heights.y > y[0]) & (heights.y < y[1]))]
        assert left.size and left.max() <= 3 + 0.1 + 0.05


def test_a_wall_between_two_open_pockets_stays():
    part = carved(((-1, 3, 2), (12.5, 17, 8)), ((13.5, 3, 2), (27, 17, 8)))  # open to both sides, a wall of 1 mm
    setup = plan.Setup(part, stock())
    rough = plan.rough(setup, FLAT, stepdown=3, allowance=0.2)
    setup.apply(rough)
    ball = riffler.Tool.ball(diameter=3, length=25)
    heights, _, _ = cut(rough)
    for pattern, slopes in (("waterline", (1.2, math.pi / 2)), ("parallel", (0.0, 0.5))):
        op = plan.finish(setup, ball, pattern, cusp=0.1, tolerance=0.02, slopes=slopes)
        assert len(op)
        heights.cut(op)
        plan.program(setup, [op])
    wall = heights.z[np.ix_(abs(heights.x - 13) < 0.47, (heights.y > 4) & (heights.y < 16))]
    assert wall.min() >= 7 - 0.021
    floor = heights.z[np.ix_((heights.x > 2) & (heights.x < 10), (heights.y > 6) & (heights.y < 14))]
    assert floor.max() <= 2 + 0.1 + 0.03


def test_mirrored_and_scaled_parts_are_machined_like_their_image():
    """A mirror without a change of the triangles turns them inside out, as a negative scale of an object does."""
    random = np.random.default_rng(4)
    x = np.linspace(0, 12, 9)
    part = solid_under(x, 2 + random.uniform(0, 2, (9, 9)))
    points, triangles = np.asarray(part.vertices) * [-2, 1, 1.5] + [24, 0, 0], np.asarray(part.triangles)
    at = random.uniform((1, 1), (23, 11), (300, 2))
    inside_out, right = riffler.Mesh(points, triangles), riffler.Mesh(points, triangles[:, ::-1])
    assert inside_out.volume < 0 < right.volume
    tool = riffler.Tool.ball(diameter=3, length=25)
    for call in (
        lambda setup: plan.rough(setup, FLAT, stepdown=2),
        lambda setup: plan.finish(setup, tool, cusp=0.1, tolerance=0.02),
        lambda setup: plan.finish(setup, tool, "waterline", cusp=0.1, tolerance=0.02, slopes=(0.5, 1.5)),
        lambda setup: plan.outline(setup, FLAT),
    ):
        left = []
        for mesh in (inside_out, right):
            setup = plan.Setup(mesh, riffler.Volume.block((-3, -3, 0), (27, 15, 7), 0.4))
            op = call(setup)
            assert len(plan.program(setup, [op])) == len(op) > 10
            left.append(z_map(op, *at.T))
            assert (left[-1] - heights(right, *at.T)).min() > -0.05, "cut into the part"
        cut = np.isfinite(left[0]) & np.isfinite(left[1])
        if cut.any():  # rows lie elsewhere where two triangles are touched at once
            assert cut.mean() > 0.9 and np.quantile(np.abs(left[0][cut] - left[1][cut]), 0.9) < 0.1


@pytest.mark.parametrize("allowance", [0.3, 1.2])
def test_an_allowance_larger_than_the_smallest_hole_leaves_that_hole_out(allowance):
    part = riffler.Volume.block((0, 0, 0), (24, 16, 4), 0.25, "xyz").grow((-4, -4, 0), (28, 20, 4))
    for diameter, x in ((5, 5), (9, 16)):
        part.carve(riffler.Tool.flat(diameter, 20), [(x, 8, 9, 0, 0, 1), (x, 8, -1, 0, 0, 1)])
    setup = plan.Setup(part.to_mesh(tolerance=0.01), riffler.Volume.block((-4, -4, 0), (28, 20, 4), 0.25))
    small = allowance > 0.5
    op = plan.outline(setup, FLAT, allowance=allowance)
    assert op.report.stats["loops"] == (2 if small else 3)
    narrow = [one for one in op.report.blocked if "narrower than the cutter" in one.reason]
    assert len(narrow) == small and all(np.hypot(*(one.place[:2] - (5, 8))) < 1 for one in narrow)
    assert len(plan.program(setup, [op]))
    walls = plan.finish(setup, FLAT, "waterline", cusp=0.1, allowance=allowance, slopes=(1.2, math.pi / 2))
    cuts = walls.poses[walls.kind == CUT]
    near = (np.hypot(*(cuts[:, :2] - (5, 8)).T) < 2) & (cuts[:, 2] < 3.9)
    assert near.any() != small and len(walls)


def test_a_taper_does_not_go_down_along_an_edge_that_its_flank_touches():
    part = carved()
    tool = riffler.Tool.taper(tip_radius=1, half_angle=0.15, diameter=6, length=30)
    op = plan.finish(plan.Setup(part, stock()), tool, cusp=0.1, tolerance=0.02, slopes=(0.0, 1.1))
    cuts = op.poses[op.kind == CUT][:, 2]
    assert len(cuts) and cuts.min() > 7 - 1 - 0.1, "below the plate's top by more than the tip's radius"
    low = z_map(op, *np.random.default_rng(6).uniform((0.1, 0.1), (25.9, 19.9), (300, 2)).T)
    assert low.min() >= 7 - 0.021 and low.max() <= 7 + 0.1 + 0.021


# --- leads ---


def angles_into_cuts(op):
    """Angles between the last move of each lead and the cut after it, rad, of leads whose last move is no plunge."""
    way = np.diff(op.poses[:, :3], axis=0)
    kind, out = op.kind[1:], []
    for k in np.flatnonzero((kind[:-1] == LEAD) & (kind[1:] == CUT)):
        a, b = way[k], way[k + 1]
        if np.hypot(*a[:2]) > 1e-9:
            out.append(math.acos(np.clip(a @ b / np.linalg.norm(a) / np.linalg.norm(b), -1, 1)))
    return np.array(out)


@pytest.mark.parametrize("pattern", ["parallel", "waterline"])
def test_arcs_enter_and_leave_cuts_tangentially(pattern):
    part = carved(((4, 4, 3), (22, 16, 8)))
    tool = riffler.Tool.ball(diameter=3, length=25)
    setup = plan.Setup(part, stock())
    slopes = (1.2, math.pi / 2) if pattern == "waterline" else (0.0, 0.4)
    options = {"cusp": 0.1, "tolerance": 0.02, "slopes": slopes}
    op = plan.finish(setup, tool, pattern, **options)
    stats, angles = op.report.stats, angles_into_cuts(op)
    assert stats["arcs"] > 0 and stats["arcs"] + stats["straight"] == 2 * (stats["retracts"] + 1)
    assert len(angles) and np.degrees(angles).max() < 6  # a half of a chord's turn
    plain = plan.finish(setup, tool, pattern, lead=0, **options)
    assert plain.report.stats["arcs"] == 0 and not len(angles_into_cuts(plain))
    assert np.allclose(op.poses[op.kind == CUT], plain.poses[plain.kind == CUT])
    _, thick, _ = cut(op)
    assert thick[0] <= SLIVER and len(plan.program(setup, [op])) == len(op)
    at = np.random.default_rng(2).uniform((0.5, 0.5), (25.5, 19.5), (800, 2))
    inside = (np.abs(at - (13, 10)) < (8.9, 5.9)).all(axis=1)
    low = z_map(op, *at.T)
    assert low[~inside & ((np.abs(at - (13, 10)) > (9.1, 6.1)).any(axis=1))].min() >= 7 - 0.03
    assert low[inside].min() >= 3 - 0.03


def test_a_lead_without_room_is_straight_and_counted():
    part = carved(((4, 8, 1), (7.5, 11.5, 8)))  # a deep hole of 3.5 mm for a cutter of 3
    hole = [np.array([(3, 7, 0), (8.5, 7, 0), (8.5, 12.5, 0), (3, 12.5, 0)])]
    op = plan.finish(
        plan.Setup(part, stock()), riffler.Tool.flat(3, 25), "waterline",
        cusp=0.1, slopes=(1.2, math.pi / 2), region=hole, lead=4.0,
    )  # fmt: skip
    assert len(op) and op.report.stats["straight"] > 0
    plan.program(plan.Setup(part, stock()), [op])
    with pytest.raises(ValueError, match="lead"):
        plan.finish(plan.Setup(part, stock()), FLAT, lead=-1)
    with pytest.raises(ValueError, match="lead"):
        plan.outline(plan.Setup(part, stock()), FLAT, lead=math.nan)


def test_a_holder_low_over_the_stock_keeps_arcs_away():
    part = carved(((4, 4, 3), (22, 16, 8)))
    tool = riffler.Tool.flat(3, 4.6).with_holder([(4.6, 6, 30, 6)])
    op = plan.finish(plan.Setup(part, stock()), tool, cusp=0.1, slopes=(0.0, 0.3), lead=0.7)
    assert any("holder" in one.reason for one in op.report.blocked)
    plan.program(plan.Setup(part, stock()), [op])


def test_an_outline_leaves_on_an_arc_and_beside_a_fixture_straight():
    part = riffler.Volume.block((4, 4, 0), (22, 16, 4), 0.25, "xyz").to_mesh()
    block = riffler.Volume.block((0, 0, 0), (26, 20, 4), 0.25)
    clamp = box(np.array([10.0, 12, 0]), np.array([14.0, 20, 9]))
    alone, beside = (plan.outline(plan.Setup(part, block, fixtures=f), FLAT, stepdown=2) for f in ([], [clamp]))
    assert (alone.report.stats["arcs"], alone.report.stats["straight"]) == (1, 0)
    # The cuts end at the clamp, where an arc has no room.
    assert beside.report.stats["arcs"] == 0 and beside.report.stats["straight"] == 2 * beside.report.stats["levels"]
    for op, fixtures in ((alone, []), (beside, [clamp])):
        assert len(plan.program(plan.Setup(part, block, fixtures=fixtures), [op])) == len(op)
    assert plan.outline(plan.Setup(part, block), FLAT, stepdown=2, lead=0).report.stats["arcs"] == 0
