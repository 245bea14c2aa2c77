"""Shank and holder in the stock: operations leave out where they would touch what is there by then. Judged by
verification, and by a map of heights in numpy that knows no planner."""

import math
from itertools import pairwise

import numpy as np
import pytest
import riffler
from finish_judge import lower_side, solid_under
from riffler import plan
from riffler.plan.operations import CUT, RAPID

PITCH = 0.4
DEEP = PITCH / 4  # mm: material between two rays is known to neither planner nor verification


def held(kind, diameter, length, holder, **shape):
    """A short cutter right under a holder."""
    tool = getattr(riffler.Tool, kind)(diameter=diameter, length=length, **shape)
    return tool.with_holder([(length, holder / 2, length + 30, holder / 2)])


def hills():
    """A block with steep hills, 40 × 40 × 29 mm."""
    x = np.linspace(0, 40, 27)
    gx, gy = np.meshgrid(x, x, indexing="ij")
    return solid_under(x, 16 + 13 * np.sin(gx / 6) * np.cos(gy / 7))


def findings(op, stock, tolerance=0.01):
    """What verification finds in the rows of an operation alone."""
    rapid = op.kind == RAPID
    count = len(op)
    program = riffler.Program(
        op.poses, np.where(rapid, 0, np.maximum(op.feed, 1)), rapid=rapid, tool=np.ones(count, int),
        spindle=np.full(count, 1000.0), tools={1: op.tool},
    )  # fmt: skip
    return riffler.verify(program, stock, tolerance=tolerance).findings


def deepest_in_stock(op, lower, upper, before=(), cell=0.6, step=0.25):
    """How deep the holder of upright tools comes into a block along ``op``, after the moves of ``before``, mm. The
    stock is a map of columns. Level moves cut it exactly, others at places a ``step`` apart; the holder is compared at
    such places, after the cut."""
    x, y = np.meshgrid(*(np.arange(lower[k] + cell / 2, upper[k], cell) for k in (0, 1)), indexing="ij")
    tops, deepest = np.full(x.shape, float(upper[2])), -math.inf

    def near(a, b, reach):
        low, high = np.minimum(a, b)[:2] - reach - lower[:2], np.maximum(a, b)[:2] + reach - lower[:2]
        return tuple(slice(max(0, int(low[k] / cell) - 1), max(0, int(high[k] / cell) + 2)) for k in (0, 1))

    def cut(tool, a, b):
        at = near(a, b, tool.diameter / 2)
        p, way = np.stack([x[at], y[at]], axis=-1) - a[:2], b[:2] - a[:2]
        share = np.clip(p @ way / max(way @ way, 1e-12), 0, 1)
        rho = np.linalg.norm(p - share[..., None] * way, axis=-1)
        tops[at] = np.minimum(tops[at], max(a[2], b[2]) + lower_side(tool, rho))

    lower = np.asarray(lower, float)
    for one in (*before, op):
        for a, b in pairwise(one.poses[:, :3]):
            if min(a[2], b[2]) > upper[2]:
                continue
            places = np.linspace(a, b, 2 if a[2] == b[2] else 2 + int(np.linalg.norm(b - a) / step))
            for start, end in pairwise(places):
                cut(one.tool, start if a[2] == b[2] else end, end)
            for tip in np.linspace(a, b, 2 + int(np.linalg.norm(b - a) / 0.5))[1:] if one is op else ():
                for z0, r0, _, _ in one.tool.holder:
                    at = near(tip, tip, r0)
                    side = r0 - np.hypot(x[at] - tip[0], y[at] - tip[1])
                    deepest = max(deepest, np.minimum(tops[at] - tip[2] - z0, side).max(initial=-math.inf))
    return deepest


def reasons(op):
    return [one.reason for one in op.report.blocked]


@pytest.fixture(scope="module")
def roughed():
    """Hills, roughed with a long tool."""
    part = hills()
    stock = riffler.Volume.block((0, 0, 0), (40, 40, 31), PITCH)
    setup = plan.Setup(part, stock)
    op = plan.rough(setup, held("flat", 6, 40, 12), stepdown=4, engagement=0.6)
    assert not findings(op, stock)
    setup.apply(op)
    return part, setup.stock, op


def test_a_short_tool_roughs_only_where_its_holder_is_free():
    part = hills()
    stock = riffler.Volume.block((0, 0, 0), (40, 40, 31), PITCH)
    op = plan.rough(plan.Setup(part, stock), held("flat", 6, 10, 20), stepdown=4, engagement=0.6)
    assert "the holder meets the stock" in reasons(op) and op.report.cut_mm > 1500
    assert not findings(op, stock)
    assert deepest_in_stock(op, (0, 0, 0), (40, 40, 31)) < DEEP


@pytest.mark.parametrize("pattern", ["parallel", "waterline"])
def test_a_short_tool_finishes_only_where_its_holder_is_free(roughed, pattern):
    part, stock, before = roughed
    tool = held("ball", 6, 12, 20)
    op = plan.finish(plan.Setup(part, stock), tool, pattern, cusp=0.5, tolerance=0.02)
    assert "the holder meets the stock" in reasons(op) and op.report.cut_mm > 500
    assert not findings(op, stock)
    assert deepest_in_stock(op, (0, 0, 0), (40, 40, 31), [before]) < DEEP
    assert len(plan.program(plan.Setup(part, stock), [op])) == len(op)


def test_a_long_tool_leaves_out_nothing(roughed):
    part, stock, _ = roughed
    op = plan.finish(plan.Setup(part, stock), held("ball", 6, 40, 30), cusp=0.5, tolerance=0.02)
    assert "the holder meets the stock" not in reasons(op) and not findings(op, stock)


def test_a_shank_as_wide_as_its_cutter_follows_it_into_a_pocket():
    volume = riffler.Volume.block((0, 0, 0), (40, 40, 30), PITCH, directions="xyz")
    volume.carve(riffler.Tool.flat(diameter=10, length=60), [(15, 20, 40, 0, 0, 1), (15, 20, 6, 0, 0, 1),
                                                             (25, 20, 6, 0, 0, 1)])  # fmt: skip
    setup = plan.Setup(volume.to_mesh(tolerance=0.01), riffler.Volume.block((0, 0, 0), (40, 40, 30), PITCH))
    tool = riffler.Tool.flat(diameter=6, length=8).with_shank([(8, 3, 60, 3)])
    op = plan.rough(setup, tool, stepdown=4)
    assert not reasons(op) and op.poses[:, 2].min() < 6.5
    assert not findings(op, setup.stock)


def test_drills_leave_out_holes_that_are_deeper_than_their_flutes():
    part = riffler.Volume.block((0, 0, 0), (30, 30, 2), 1.0).to_mesh()
    stock = riffler.Volume.block((0, 0, 0), (30, 30, 32), PITCH)
    setup = plan.Setup(part, stock)
    drill = held("flat", 4, 15, 12)
    op = plan.drill(setup, drill, [(8, 8, 32), (20, 20, 32), (8, 20, 32)], [14, 25, 10], peck=4, tolerance=0.5)
    assert reasons(op) == ["points[1]: the holder meets the stock"] and op.report.stats["holes"] == 2
    assert not (np.linalg.norm(op.poses[:, :2] - 20, axis=1) < 1e-9).any()
    assert not findings(op, stock)


def test_outlines_end_above_the_depth_that_the_holder_can_reach():
    part = riffler.Volume.cylinder((20, 20, 3), 8, 6, 0.5, directions="xyz").to_mesh(tolerance=0.02)
    stock = riffler.Volume.block((0, 0, 0), (40, 40, 26), PITCH)
    op = plan.outline(plan.Setup(part, stock), held("flat", 6, 12, 9), stepdown=4)
    assert "the holder meets the stock" in reasons(op)
    assert len(op) and 10 < op.poses[:, 2].min() < 18
    assert not findings(op, stock)


def test_what_is_above_the_described_tool_counts():
    part = riffler.Volume.block((0, 0, 0), (30, 30, 2), 1.0).to_mesh()
    stock = riffler.Volume.block((0, 0, 0), (30, 30, 32), PITCH)
    bit = riffler.Tool.flat(diameter=4, length=15)
    op = plan.drill(plan.Setup(part, stock), bit, [(8, 8, 32)], 25, tolerance=0.5)
    assert not len(op) and op.reason == "points[0]: the tool would be in the stock up to above its described length"


def test_leaning_tools_leave_out_where_the_holder_meets_the_stock():
    part = hills()
    stock = riffler.Volume.block((0, 0, 0), (40, 40, 31), PITCH, directions="xyz")
    setup = plan.Setup(part, stock, machine="tcp")
    setup.apply(plan.rough(setup, held("flat", 10, 40, 12), stepdown=4, engagement=0.6))
    tool = held("ball", 4, 14, 24)
    op = plan.finish(setup, tool, cusp=0.6, tolerance=0.05, orientation=(0.3, 0.0))
    assert "the holder meets the stock" in reasons(op) and (op.kind == CUT).sum() > 100
    assert not findings(op, setup.stock, 0.05)
    assert len(plan.program(setup, [op])) == len(op)


def test_any_number_of_threads_gives_the_same_moves(roughed, monkeypatch):
    part, stock, _ = roughed
    found = []
    for threads in ("1", "3"):
        monkeypatch.setenv("RIFFLER_THREADS", threads)
        found.append(plan.finish(plan.Setup(part, stock), held("ball", 6, 12, 20), cusp=0.6, tolerance=0.02))
    assert found[0].poses.tobytes() == found[1].poses.tobytes() and reasons(found[0]) == reasons(found[1])


def test_cancelling_leaves_the_setup_as_it_was(roughed):
    part, stock, _ = roughed
    setup = plan.Setup(part, stock)
    before = setup.stock.to_bytes()
    shares = []

    def stop(share):
        shares.append(share)
        return share < 0.9

    with pytest.raises(riffler.Cancelled):
        plan.finish(setup, held("ball", 6, 12, 20), cusp=0.6, tolerance=0.02, progress=stop)
    assert setup.stock.to_bytes() == before and shares[-1] >= 0.9
