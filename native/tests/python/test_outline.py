"""Outlines, drilling and pencil operations, checked in numpy with height maps that all moves cut, and with distances
from shapes."""

import math

import numpy as np
import pytest
import riffler
from commands import result
from riffler import plan
from riffler.plan.operations import CUT, LEAD, RAPID

CELL = 0.1
SIZE = (44.0, 34.0, 6.0)
FLAT = riffler.Tool.flat(diameter=4, length=20)
CENTRES, ROUND, HOLE, SMALL = ((14.0, 17.0), (30.0, 17.0)), 9.0, 5.0, 1.5


def slot_shape(x, y):
    """Signed distance from a stadium with holes of Ø10 and Ø3; negative inside the part."""
    (x0, y0), (x1, _) = CENTRES
    outer = np.hypot(x - np.clip(x, x0, x1), y - y0) - ROUND
    return np.maximum.reduce([outer, HOLE - np.hypot(x - x0, y - y0), SMALL - np.hypot(x - x1, y - y0)])


def ring(centre, radius, n=120, first=0.0, last=2 * math.pi):
    angle = np.linspace(first, last, n)
    return np.column_stack([centre[0] + radius * np.cos(angle), centre[1] + radius * np.sin(angle)])


def outer_curve():
    right, left = (
        ring(CENTRES[1], ROUND, 60, -math.pi / 2, math.pi / 2),
        ring(CENTRES[0], ROUND, 60, math.pi / 2, 1.5 * math.pi),
    )
    return np.concatenate([right, left])


def plate(z=4.0):
    """The stadium as a mesh: walls, and lids made of strips between curves that are divided at common values of x."""
    volume = riffler.Volume.block((0, 0, 0), (*SIZE[:2], z), pitch=0.2, directions="xyz")
    keep = riffler.Volume.block((0, 0, 0), (*SIZE[:2], z), pitch=0.2, directions="xyz")
    tool = riffler.Tool.flat(diameter=2 * ROUND, length=30)
    a, b = ((*c, 0, 0, 0, 1) for c in CENTRES)
    keep.carve(tool, [a, b])
    volume -= keep
    for centre, radius in zip(CENTRES, (HOLE, SMALL), strict=True):
        bit = riffler.Tool.flat(diameter=2 * radius, length=30)
        volume.carve(bit, [(*centre, 9, 0, 0, 1), (*centre, -1, 0, 0, 1)])
    return volume.to_mesh(tolerance=0.01)


def stock(z=SIZE[2]):
    return riffler.Volume.block((0, 0, 0), (*SIZE[:2], z), pitch=0.25)


PLATE = plate()


def swept(op, radius, kinds, step=0.05):
    """Dense places of the tip on the moves of the given kinds."""
    out = []
    for k in range(1, len(op)):
        if op.kind[k] in kinds:
            a, b = op.poses[k - 1, :3], op.poses[k, :3]
            out.append(np.linspace(a, b, max(2, math.ceil(np.linalg.norm(b - a) / step) + 1)))
    return np.concatenate(out) if out else np.zeros((0, 3))


def map_after(op, radius, z=SIZE[2]):
    x, y = np.meshgrid(np.arange(CELL / 2, SIZE[0], CELL), np.arange(CELL / 2, SIZE[1], CELL), indexing="ij")
    height = np.full(x.shape, float(z))
    for p in swept(op, radius, (LEAD, CUT, 3), CELL):
        i, j = (slice(max(0, int((c - radius) / CELL)), max(0, int((c + radius) / CELL) + 2)) for c in p[:2])
        near = np.hypot(x[i, j] - p[0], y[i, j] - p[1]) <= radius
        height[i, j] = np.where(near, np.minimum(height[i, j], p[2]), height[i, j])
    return x, y, height


@pytest.mark.parametrize("allowance", [0.0, 0.4])
@pytest.mark.parametrize("climb", [True, False])
def test_a_silhouette_is_cut_out_and_nothing_deeper(climb, allowance):
    setup = plan.Setup(PLATE, stock())
    op = plan.outline(setup, FLAT, climb=climb, allowance=allowance, tolerance=0.02)
    assert len(plan.program(setup, [op])) == len(op)
    tips = swept(op, 2, (LEAD, CUT))
    gap = slot_shape(tips[:, 0], tips[:, 1]) - 2
    assert gap[tips[:, 2] < 4].min() > allowance - 0.02  # the part's mesh is within 0.01 mm of the shape
    cuts = swept(op, 2, (CUT,))
    assert np.quantile(slot_shape(cuts[:, 0], cuts[:, 1]) - 2, 0.99) < allowance + 0.04
    x, y, height = map_after(op, 2)
    shape = slot_shape(x, y)
    beside = (
        (shape > allowance + 0.2) & (shape < 3.5 + allowance) & (np.hypot(x - CENTRES[1][0], y - CENTRES[1][1]) > 3)
    )
    assert height[beside].max() <= 1e-6 and height[shape < allowance - 0.1].min() == SIZE[2]
    # One loop around the part and one in the hole of Ø10; the hole of Ø3 is narrower than the cutter.
    assert op.report.stats["loops"] == 2 and len(op.report.blocked) == 1
    assert "narrower than the cutter" in op.report.blocked[0].reason
    assert np.allclose(op.report.blocked[0].place[:2], CENTRES[1], atol=0.7)


def test_climb_has_the_part_on_the_right():
    for climb in (True, False):
        op = plan.outline(plan.Setup(PLATE, stock()), FLAT, climb=climb)
        at, way = op.poses[1:, :2], np.diff(op.poses[:, :2], axis=0)
        cut = (op.kind[1:] == CUT) & (np.linalg.norm(way, axis=1) > 0.01)
        right = (
            at[cut] + 0.01 * np.column_stack([way[cut, 1], -way[cut, 0]]) / np.linalg.norm(way[cut], axis=1)[:, None]
        )
        nearer = slot_shape(*right.T) < slot_shape(*at[cut].T)
        assert nearer.mean() > 0.99 if climb else nearer.mean() < 0.01


def test_layers_are_as_high_as_requested_and_ramps_as_steep():
    op = plan.outline(plan.Setup(PLATE, stock()), FLAT, stepdown=2.5, slope=math.radians(4))
    assert op.report.stats["levels"] == 2 * 3  # 6 mm and one ray's distance, in layers of at most 2.5 mm
    way = np.diff(op.poses[:, :3], axis=0)
    leads = (op.kind[1:] == LEAD) & (op.kind[:-1] != RAPID) & (np.linalg.norm(way[:, :2], axis=1) > 1e-6)
    steep = -way[leads, 2] / np.linalg.norm(way[leads, :2], axis=1)
    assert steep.max() <= math.tan(math.radians(4)) + 1e-6


def test_tabs_stay_with_their_height_and_width():
    op = plan.outline(plan.Setup(PLATE, stock()), FLAT, tabs=3, tab_height=1.5, tab_width=5)
    _, _, height = map_after(op, 2)
    edge = np.concatenate([outer_curve(), outer_curve()[:1]])
    ways = np.linalg.norm(np.diff(edge, axis=0), axis=1)
    at = np.linspace(0, ways.sum(), 2000)
    line = np.column_stack([np.interp(at, np.r_[0, np.cumsum(ways)], edge[:, k]) for k in (0, 1)])
    # Points 2 mm outside of the edge, in the middle of the groove.
    normal = np.column_stack(
        [line[:, 0] - np.clip(line[:, 0], CENTRES[0][0], CENTRES[1][0]), line[:, 1] - CENTRES[0][1]]
    )
    groove = line + 2 * normal / np.linalg.norm(normal, axis=1)[:, None]
    found = height[(groove[:, 0] / CELL).astype(int), (groove[:, 1] / CELL).astype(int)]
    standing = found > 0.5
    assert np.allclose(found[standing], 1.5, atol=1e-6)
    runs = int((np.diff(standing.astype(int)) == 1).sum() + (standing[0] and not standing[-1]))
    assert runs == 3
    share = standing.mean() * ways.sum()
    assert 3 * 5 * 0.7 < share < 3 * 5 * 1.6  # the groove's middle is longer, and the cutter is round
    assert op.report.stats["tabs"] == 3 + 1, "the loop in the hole has room for one"
    assert any("only 1 of 3 tabs fit" in one.reason for one in op.report.blocked)


def test_curves_from_outside_and_from_inside():
    square = np.array([(12, 9, 4), (32, 9, 4), (32, 25, 4), (12, 25, 4)], float)
    low = riffler.Volume.block((0, 0, 0), (*SIZE[:2], 1), pitch=0.5, directions="xyz").to_mesh()
    setup = plan.Setup(low, stock())
    for inside in (False, True):
        op = plan.outline(setup, FLAT, [square], depth=2.9, inside=inside)
        tips = swept(op, 2, (CUT,))
        dx, dy = np.abs(tips[:, 0] - 22) - 10, np.abs(tips[:, 1] - 17) - 8
        outside = np.where((dx > 0) & (dy > 0), np.hypot(dx, dy), np.maximum(dx, dy))
        gap = -outside if inside else outside
        assert gap.min() >= 2 - 1e-6 and gap.max() < 2 + 0.011 + (0 if not inside else 0.02)
        assert tips[:, 2].min() == pytest.approx(1.1)
    again = plan.outline(setup, FLAT, [square[::-1]], depth=2.9)
    assert np.allclose(swept(again, 2, (CUT,))[:, 2].min(), 1.1)


def test_what_would_enter_the_part_is_left_out():
    step = riffler.Volume.block((0, 0, 0), (22, 34, 5), pitch=0.5, directions="xyz").to_mesh()
    square = np.array([(12, 9, 6), (32, 9, 6), (32, 25, 6), (12, 25, 6)], float)
    setup = plan.Setup(step, stock())
    op = plan.outline(setup, FLAT, [square], depth=3)
    assert [one.reason for one in op.report.blocked] == ["the cutter meets the part"]
    tips = swept(op, 2, (LEAD, CUT, 3))
    assert len(tips) and tips[tips[:, 2] < 4.99, 0].min() >= 24 - 0.01
    plan.program(setup, [op])


def test_a_fixture_is_kept_clear_of():
    clamp = riffler.Volume.block((20, 26, 0), (24, 34, 10), pitch=0.5, directions="xyz").to_mesh()
    setup = plan.Setup(PLATE, stock(), fixtures=[clamp])
    op = plan.outline(setup, FLAT)
    assert any(one.reason == "the tool meets a fixture" for one in op.report.blocked)
    tips = op.poses[:, :3]
    near = np.maximum(np.abs(tips[:, 0] - 22) - 2, np.maximum(26 - tips[:, 1], tips[:, 1] - 34)) < 1.99
    assert not (near & (tips[:, 2] < 10)).any()
    plan.program(setup, [op])


@pytest.mark.parametrize(
    ("tool", "more", "reason"),
    [
        (FLAT, {"curves": [[(5, 5, 4), (6, 5, 4), (6, 6, 4)]], "inside": True, "depth": 1}, "narrower than the cutter"),
        (FLAT, {"curves": [[(5, 5, 4), (5, 5, 4), (5, 5, 4)]], "depth": 1}, "enclose nothing"),
        (FLAT, {"curves": [[(95, 5, 4), (99, 5, 4), (99, 9, 4)]], "depth": 1}, "no stock stands on the outline"),
    ],
)
def test_an_outline_without_cuts_gives_the_reason(tool, more, reason):
    op = plan.outline(plan.Setup(PLATE, stock()), tool, **more)
    assert len(op) == 0 and reason in op.reason


@pytest.mark.parametrize(
    ("wrong", "text"),
    [
        ({"depth": 0}, "depth must be positive"),
        ({"tabs": -1}, "tabs must not be negative"),
        ({"tab_width": 0}, "tab_width"),
        ({"tab_height": -1}, "tab_height"),
        ({"stepdown": 0}, "stepdown"),
        ({"slope": 2}, "slope"),
        ({"tolerance": 0}, "tolerance"),
        ({"allowance": -1}, "allowance"),
        ({"inside": True}, "inside: needs curves"),
        ({"curves": [[(0, 0, 0), (1, 1, 1)]]}, r"curves\[0\] has fewer than three points"),
        ({"curves": [[(0, 0, 0), (1, 1, 1), (math.nan, 0, 0)]]}, r"curves\[0\]"),
    ],
)
def test_bad_options_of_an_outline_are_named(wrong, text):
    with pytest.raises(ValueError, match=text):
        plan.outline(plan.Setup(PLATE, stock()), FLAT, **wrong)


def test_an_outline_is_the_same_for_any_number_of_threads(monkeypatch):
    found = []
    for threads in ("1", "3"):
        monkeypatch.setenv("RIFFLER_THREADS", threads)
        found.append(plan.outline(plan.Setup(PLATE, stock()), FLAT, tabs=2).poses.tobytes())
    assert found[0] == found[1]


# --- drilling ---


BIT = riffler.Tool.profile([(1.5, 0.9)], length=30)
MOUTH = (*CENTRES[1], 4.0)


@pytest.mark.parametrize("peck", [None, 1.5])
def test_a_hole_is_drilled_and_rapids_touch_nothing(peck):
    setup = plan.Setup(PLATE, stock())
    op = plan.drill(setup, BIT, [MOUTH], depth=4.9, peck=peck)
    assert op.report.blocked == () and op.report.stats["holes"] == 1
    assert np.allclose(op.poses[:, :2], CENTRES[1]) and op.poses[:, 2].min() == pytest.approx(-0.9)
    deepest = SIZE[2] + 1.0
    for k in range(1, len(op)):
        if op.kind[k] == RAPID:
            assert op.poses[k, 2] > deepest, "a rapid ends in material"
        elif peck:
            assert deepest - op.poses[k, 2] <= peck + 1.5
        deepest = min(deepest, op.poses[k, 2])
    assert op.report.stats["pecks"] == (1 if peck is None else math.ceil((SIZE[2] + 0.25 + 0.9) / 1.5 - 1e-9))
    assert len(plan.program(setup, [op])) == len(op)


def test_holes_that_cannot_be_are_named_and_the_rest_done():
    setup = plan.Setup(PLATE, stock(), fixtures=[riffler.Volume.block((1, 1, 0), (5, 5, 9), 0.5, "xyz").to_mesh()])
    op = plan.drill(setup, BIT, [(22, 17, 4), MOUTH, (3, 3, 4), (70, 70, 4)], depth=[2, 4.9, 3, 3])
    reasons = [one.reason for one in op.report.blocked]
    assert reasons[0].startswith("points[0]: the cutter would enter the part by")
    assert (
        reasons[1].startswith("points[2]: the cutter would enter a fixture")
        and reasons[2] == "points[3]: no stock stands there"
    )
    assert op.report.stats["holes"] == 1 and len(plan.program(setup, [op])) == len(op)


def test_a_drill_with_a_holder_too_low():
    low = BIT.with_holder([(3, 10, 20, 10)])
    op = plan.drill(plan.Setup(PLATE, stock()), low, [MOUTH], depth=4.9)
    assert len(op) == 0 and op.reason.startswith("points[0]: the holder would enter the part")


def test_no_points_and_bad_ones():
    setup = plan.Setup(PLATE, stock())
    op = plan.drill(setup, BIT, [], depth=3)
    assert len(op) == 0 and op.reason == "there are no points"
    for wrong, text in (
        ({"points": [(math.nan, 0, 0)], "depth": 1}, r"points\[0\] is not finite"),
        ({"points": [MOUTH], "depth": 0}, "depth must be positive"),
        ({"points": [MOUTH], "depth": [1, 2]}, "one for each of 1 points"),
        ({"points": [MOUTH], "depth": 1, "peck": 0}, "peck must be positive"),
        ({"points": [MOUTH], "depth": 1, "feed": -1}, "feed must be positive"),
    ):
        with pytest.raises(ValueError, match=text):
            plan.drill(setup, BIT, **wrong)


# --- pencil ---


def valley():
    return riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)


def test_a_pencil_operation_cuts_the_valley_and_no_deeper():
    part = valley()
    setup = plan.Setup(part, riffler.Volume.block(*part.bounds, pitch=0.4))
    ball = riffler.Tool.ball(diameter=4, length=20)
    op = plan.pencil_operation(setup, ball, tolerance=0.02, feed=700)
    assert op.report.stats["paths"] == 1 and len(plan.program(setup, [op])) == len(op)
    cuts = swept(op, 2, (CUT, LEAD))
    heights, _ = plan.drop(cuts, ball, part)
    assert np.nanmin(cuts[:, 2] - heights) > -0.021
    low = swept(op, 2, (CUT,))
    h, _ = plan.drop(low, ball, part)
    assert np.nanmax(low[:, 2] - h) < 0.1 and set(op.feed[op.kind == CUT]) == {700}
    setup.apply(op)
    assert setup.stock.volume < setup.stock_before(op).volume


def test_a_part_without_valleys_is_reported():
    block = riffler.Volume.block((0, 0, 0), (10, 10, 5), 1, "xyz").to_mesh()
    op = plan.pencil_operation(
        plan.Setup(block, riffler.Volume.block((0, 0, 0), (10, 10, 5), 0.5)), riffler.Tool.ball(4, 20)
    )
    assert len(op) == 0 and op.reason
    with pytest.raises(ValueError, match="ball"):
        plan.pencil_operation(plan.Setup(block, riffler.Volume.block((0, 0, 0), (10, 10, 5), 0.5)), FLAT)


# --- commands ---


def test_the_commands_write_programs(tmp_path):
    PLATE.write(tmp_path / "plate.stl")
    words = ["plate.stl", "--stock", "44x34x6", "--pitch", "0.25"]
    data = result("plan", "outline", *words, "--tool", "flat:4", "--tabs", "2", "--out", "out.ngc", cwd=tmp_path)
    assert data["stats"]["tabs"] >= 2 and (tmp_path / "out.ngc").read_text().count("\n") > 100
    more = ["--at", f"{MOUTH[0]},{MOUTH[1]},{MOUTH[2]}", "--depth", "4.9", "--peck", "2", "--out", "holes.ngc"]
    data = result("plan", "drill", *words, "--tool", "flat:2.9", *more, cwd=tmp_path)
    assert data["stats"]["holes"] == 1 and (tmp_path / "holes.ngc").exists()
