"""Pencil, engraving and swarf operations, whose leads and links are checked like their cuts."""

import numpy as np
import pytest
import riffler
from finish_judge import dome
from riffler import plan
from tilting_judge import deepest

BIT = riffler.Tool.taper(tip_radius=0.2, half_angle=0.4, diameter=4, length=15)


def block_setup(mesh, machine="tcp", pitch=0.5):
    return plan.Setup(mesh, riffler.Volume.from_mesh(mesh, pitch, directions="xyz"), machine=machine)


def overhang():
    """A valley along x under a roof that covers the half y > 8 of it."""
    part = riffler.Volume.block((0, 0, 0), (40, 30, 30), pitch=0.25, directions="xyz")
    end = riffler.Tool.flat(diameter=6, length=80)
    for z in (8.0, 10.0, 12.0, 14.0):  # a slot from the front, open at both ends
        part.carve(end, [(-10, 6, z, 0, -1, 0), (50, 6, z, 0, -1, 0)])
    part.carve(end, [(-10, 3, 12, 0, 0, 1), (50, 3, 12, 0, 0, 1)])
    return part.to_mesh(tolerance=0.02)


def test_pencil_leads_stay_clear_of_overhangs():
    part = overhang()
    setup = block_setup(part)
    ball = riffler.Tool.ball(diameter=3, length=40)
    lean = np.array([0, -0.8, 0.6])
    op = plan.pencil_operation(setup, ball, tolerance=0.02, orientation=lean)
    depth, move = deepest(op, part, (0, 1, 2, 3), count=4000, step=0.3)
    assert len(op) and depth <= 0.02 + 1e-6, f"move {move}"
    assert len(plan.program(setup, [op])) == len(op)


def test_a_cut_that_no_lead_reaches_is_left_out_with_its_place():  # in a cave
    cave = riffler.Volume.block((0, 0, 0), (40, 30, 30), pitch=0.5, directions="xyz")
    cave.carve(riffler.Tool.ball(diameter=16, length=60), [(20, -40, 7, 0, -1, 0), (20, 23, 7, 0, -1, 0)])
    mesh = cave.to_mesh(tolerance=0.02)
    setup = block_setup(mesh)
    op = plan.engrave_operation(setup, riffler.Tool.ball(diameter=2, length=6), [[(18, 10, 7), (22, 10, 7)]], depth=0.2)
    assert not len(op) and op.reason == op.report.blocked[0].reason


def test_engraving_on_a_plate_is_as_deep_as_asked():
    plate = riffler.Volume.block((0, 0, 0), (40, 30, 10), 0.5).to_mesh()
    setup = plan.Setup(plate, riffler.Volume.block((0, 0, 0), (40, 30, 10), 0.25))
    op = plan.engrave_operation(setup, BIT, [[(5, 10, 11), (35, 10, 11)], [(5, 20, 10), (35, 20, 10)]], depth=0.3)
    cuts = op.poses[op.kind == 2]
    assert np.allclose(cuts[:, 2], 9.7, atol=1e-9) and op.engraved == 0.3 and op.report.stats["curves"] == 2
    assert op.report.cut_mm == pytest.approx(60)
    assert len(plan.program(setup, [op])) == len(op)
    before = setup.stock.volume
    setup.apply(op)
    assert setup.stock.volume < before


def test_engraving_ends_at_a_clamp_and_lists_it():
    plate = riffler.Volume.block((0, 0, 0), (40, 30, 10), 0.5).to_mesh()
    clamp = riffler.Volume.block((18, 0, 10), (24, 30, 16), 0.5).to_mesh()
    setup = plan.Setup(plate, riffler.Volume.block((0, 0, 0), (40, 30, 10), 0.25), fixtures=[clamp])
    op = plan.engrave_operation(setup, BIT, [[(5, 10, 10), (35, 10, 10)], [(20, 20, 10), (22, 20, 10)]], depth=0.3)
    ends = np.sort(op.poses[op.kind == 2][:, 0])
    assert ((ends < 18) | (ends > 24)).all() and ends[0] < 18 < 24 < ends[-1]
    assert [one.reason for one in op.report.blocked] == ["the tool meets a fixture"]
    assert op.report.cut_mm + op.report.blocked[0].length == pytest.approx(32, abs=1e-6)
    assert len(plan.program(setup, [op])) == len(op)


@pytest.mark.parametrize("orientation", [None, "normal", (0.2, 0.0)])
def test_engraving_a_dome_goes_no_deeper_than_asked(orientation):
    part = dome()
    setup = block_setup(part)
    turn = np.linspace(0, 2 * np.pi, 60)
    ring = np.column_stack([15 + 4 * np.cos(turn), 15 + 4 * np.sin(turn), np.full(60, 9.0)])
    ball = riffler.Tool.ball(diameter=1, length=15).with_holder([(15, 8, 40, 8)])
    op = plan.engrave_operation(setup, ball, [ring], depth=0.2, tolerance=0.01, orientation=orientation)
    depth, move = deepest(op, part, (1, 2, 3), count=20000, step=0.5)
    assert op.report.cut_mm > 20 and depth <= 0.21 + 1e-6, f"move {move}"
    lowest = op.poses[op.kind == 2][:, :3] + 0.5 * op.poses[op.kind == 2][:, 3:]  # the ball's centres
    off = np.linalg.norm(lowest - [15, 15, 2], axis=1) - 8
    assert np.abs(off - 0.3).max() < 0.05  # facets
    assert len(plan.program(setup, [op])) == len(op)


def test_engraving_leaves_out_faces_that_look_away():
    block = riffler.Volume.block((0, 0, 0), (40, 30, 10), 0.5, "xyz").to_mesh()
    setup = block_setup(block)
    ball = riffler.Tool.ball(diameter=2, length=15)
    op = plan.engrave_operation(setup, ball, [[(10, 0, 5), (30, 0, 5)]], depth=0.2)
    assert not len(op) and op.reason == "the surface faces away from the tool"
    side = plan.engrave_operation(setup, ball, [[(10, 0, 5), (30, 0, 5)]], depth=0.2, orientation=(0, -1, 0))
    assert side.report.cut_mm == pytest.approx(20)


def test_swarf_cuts_follow_the_wall():
    part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
    setup = plan.Setup(part, riffler.Volume.block(*part.bounds, 0.5, "xyz"), machine="tcp")
    tool = riffler.Tool.ball(diameter=4, length=20)
    op = plan.swarf_operation(setup, tool)
    depth, move = deepest(op, part, (1, 2, 3), count=6000, step=0.5)
    assert op.report.cut_mm > 20 and depth <= 0.05 + 1e-6, f"move {move}"
    cuts = op.poses[op.kind == 2]
    walls = np.unique(np.round(cuts[:, 3:], 6), axis=0)
    assert np.degrees(np.arccos(walls[:, 2])).max() > 30  # the wall leans
    assert len(plan.program(setup, [op])) == len(op)


@pytest.mark.parametrize(
    ("work", "said"),
    [
        (lambda s: plan.engrave_operation(s, BIT, [[(5, 5, 10), (9, 5, 10)]], depth=0.0), "depth must be positive"),
        (
            lambda s: plan.engrave_operation(s, BIT, [[(5, 5, 10), (9, 5, 10)]], orientation="least_tilt"),
            "engraving takes",
        ),
        (lambda s: plan.engrave_operation(s, BIT, [[(5, 5, 10), (9, 5, 10)]], orientation="normal"), "3-axis"),
        (lambda s: plan.engrave_operation(s, BIT, [[(5, 5, 10), (9, 5, 10)]], feed=0.0), "feed must be positive"),
        (lambda s: plan.swarf_operation(s, riffler.Tool.ball(4, 20)), "3-axis"),
    ],
)
def test_wrong_arguments_are_named(work, said):
    plate = riffler.Volume.block((0, 0, 0), (40, 30, 10), 1.0).to_mesh()
    with pytest.raises(ValueError, match=said):
        work(plan.Setup(plate, riffler.Volume.block((0, 0, 0), (40, 30, 10), 1.0)))
