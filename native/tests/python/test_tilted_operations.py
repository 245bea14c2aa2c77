"""Operations along a tilted axis (3+2), turns between two axes, and rest regions. Judged in numpy: the moves are turned
back to an upright part for the brute-force judge, and turns are sampled at dense places, also as the machine moves."""

import itertools
import math

import finish_judge as judge
import numpy as np
import pytest
import riffler
from finish_judge import Judge, setup_of
from riffler import plan
from riffler_bench import nc_judge

TABLE = {"rot_point": [0.0, 0.0, -60.0], "offset": [0.0, 0.0, 20.0]}
TILT = math.radians(40)
TURN = np.array([[1, 0, 0], [0, math.cos(TILT), -math.sin(TILT)], [0, math.sin(TILT), math.cos(TILT)]])
AXIS = TURN @ [0, 0, 1]
CENTRE = np.array([15.0, 15.0, 5.0])


def turned(points):
    """Upright points, turned about the part's centre, so that the former z is the tilted axis."""
    return (np.asarray(points) - CENTRE) @ TURN.T + CENTRE


def turned_back(op):
    """An operation along the tilted axis, as it would be for the upright part."""
    poses = np.hstack([(op.poses[:, :3] - CENTRE) @ TURN + CENTRE, op.poses[:, 3:] @ TURN])
    assert np.allclose(poses[:, 3:], [0, 0, 1], atol=1e-12)
    return plan.Operation(poses, op.kind, op.feed, op.tool, op.report, op.reason, op.spindle, op.tolerance)


def tilted_setup(part, pitch=0.4, top=1.0):
    """The part turned, in a block that holds it."""
    leaning = riffler.Mesh(turned(part.vertices), part.triangles)
    lower, upper = leaning.bounds
    stock = riffler.Volume.block(lower, upper + np.array([0, 0, top]), pitch, "xyz")
    return plan.Setup(leaning, stock, machine="linuxcnc-xyzac")


def test_finishing_along_a_tilted_axis_leaves_what_it_leaves_upright():
    part, tool = judge.dome(), riffler.Tool.ball(diameter=6, length=30)
    op = plan.finish(tilted_setup(part), tool, cusp=0.05, tolerance=0.02, slopes=(0, 1.2), orientation=AXIS)
    assert np.allclose(op.poses[:, 3:], AXIS)
    back, known = turned_back(op), Judge(part, tool, 0.0, (0, 1.2), count=600)
    assert len(known.standing(back, 0.05, 0.02)) == 0 and len(known.deep(back, 0.02)) == 0


def test_roughing_along_a_tilted_axis_keeps_the_allowance():
    part, tool = judge.cone(), riffler.Tool.flat(diameter=6, length=30)
    setup = tilted_setup(part)
    op = plan.rough(setup, tool, stepdown=3, allowance=0.3, tolerance=0.05, orientation=AXIS)
    known = Judge(part, tool, 0.3, (0, 1.3), count=600)  # next to the rim the block ends
    back = turned_back(op)
    assert len(known.deep(back, 0.05)) == 0
    assert len(known.standing(back, 3.0, 0.05)) == 0
    lower = setup.along(AXIS)
    assert lower.stock is setup.stock and setup.axis.tolist() == [0, 0, 1]


def test_roughing_stops_at_its_depth():
    part, tool = judge.steps(), riffler.Tool.flat(diameter=5, length=20)
    op = plan.rough(setup_of(part), tool, stepdown=2, depth=5.0)
    assert op.poses[:, 2].min() == pytest.approx(10 - 5)  # the part's highest point is at 10 mm
    with pytest.raises(ValueError, match=r"^depth must be positive, not 0"):
        plan.rough(setup_of(part), tool, depth=0)


def test_holes_and_outlines_follow_the_axis():
    part = riffler.Volume.cylinder((15, 15, 5), 10, 6, pitch=0.3, directions="xyz", lower=(0, 0, 0), upper=(30, 30, 8))
    bit = riffler.Tool.flat(diameter=5, length=40)
    part.carve(bit, [(15, 15, 20, 0, 0, 1), (15, 15, 0, 0, 0, 1)])
    setup = tilted_setup(part.to_mesh(tolerance=0.02))
    mouth = turned([(15, 15, 8)])
    drilling = plan.drill(setup, riffler.Tool.flat(diameter=4.5, length=40), mouth, depth=6, orientation=AXIS)
    deepest = drilling.poses[np.argmin(drilling.poses[:, :3] @ AXIS), :3]
    assert np.allclose(deepest, turned([(15, 15, 2)])[0], atol=1e-9)
    tool = riffler.Tool.flat(diameter=4, length=40)
    outline = turned_back(plan.outline(setup, tool, depth=6, stepdown=3, orientation=AXIS, tolerance=0.02))
    cuts = outline.poses[outline.kind == 2]
    far = np.hypot(cuts[:, 0] - 15, cuts[:, 1] - 15)
    assert far[far > 5].min() > 11.9 and cuts[:, 2].min() == pytest.approx(2, abs=0.05)


def test_pencil_cuts_leave_out_valleys_on_the_other_side():
    part = riffler.Volume.block((0, 0, 0), (30, 20, 20), pitch=0.5, directions="xyz")
    end = riffler.Tool.flat(diameter=8, length=40)
    for y, axis in ((0.0, (0, -1, 0)), (20.0, (0, 1, 0))):  # a slot in the front and one in the back
        out = np.sign(axis[1])
        part.carve(end, [(-8, y - 5 * out, 10, *axis), (38, y - 5 * out, 10, *axis)])
    mesh = part.to_mesh(tolerance=0.02)
    setup = plan.Setup(mesh, riffler.Volume.block(*mesh.bounds, 0.5, "xyz"), machine="tcp")
    ball = riffler.Tool.ball(diameter=3, length=40)
    op = plan.pencil_operation(setup, ball, tolerance=0.02, orientation=(0, -1, 0))
    cuts = op.poses[op.kind == 2]
    assert len(cuts) and cuts[:, 1].max() < 8  # only the slot in the front
    assert "the tool does not reach the valley along this axis" in {one.reason for one in op.report.blocked}


# ---- turns between two axes


def heights_over_box(poses, radius, reach, lower, upper):
    """Smallest distance of a cylinder around each pose's axis, from the tip up to ``reach``, from a box: at the points
    of a dense cloud in the cylinder."""
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 25)[:-1], np.linspace(0, radius, 5))
    disc = np.column_stack([(v * np.cos(u)).ravel(), (v * np.sin(u)).ravel()])
    levels = np.linspace(0, reach, 30)
    least = np.inf
    for pose in poses:
        axis = pose[3:] / np.linalg.norm(pose[3:])
        x = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
        x /= np.linalg.norm(x)
        cloud = pose[:3] + (disc @ [x, np.cross(axis, x)])[:, None] + levels[:, None] * axis
        off = np.maximum(np.maximum(lower - cloud, cloud - upper), 0)
        least = min(least, np.linalg.norm(off, axis=-1).min())
    return least


@pytest.mark.parametrize("after", [(0, 1, 0), (1, 0, 0), (0, -0.6, 0.8), (0, 0, 1)])
def test_the_tool_turns_clear_of_everything(after, tmp_path):
    part = riffler.Mesh(judge.dome().vertices - [15, 15, 0], judge.dome().triangles)
    stock = riffler.Volume.block((-15, -15, 0), (15, 15, 11), 0.5, "xyz")
    setup = plan.Setup(part, stock, machine="linuxcnc-xyzac", clearance=4)
    tool = riffler.Tool.ball(diameter=6, length=30).with_holder([(30, 12, 60, 14)])
    more = {"cusp": 0.4, "tolerance": 0.1, "slopes": (0, 0.9)}
    ops = [plan.finish(setup, tool, orientation=axis, **more) for axis in ((0.0, -1.0, 0.0), after)]
    program = plan.program(setup, ops)
    turn = slice(len(ops[0]) - 1, len(program) - len(ops[1]) + 1)
    share = np.linspace(0, 1, 12)[:, None]
    rows = program.poses[turn]
    assert len(rows) > 3 and program.rapid[turn.start + 1 : turn.stop].all()
    dense = np.concatenate([a + share * (b - a) for a, b in itertools.pairwise(rows)])
    assert heights_over_box(dense, 14, 60, stock.lower, stock.upper) > 3.9
    program.write(tmp_path / "p.ngc", post="linuxcnc-xyzac", options=TABLE)
    joints = nc_judge.joints_of((tmp_path / "p.ngc").read_text())
    axes = nc_judge.tilting_table("A", **TABLE)
    at = nc_judge.poses(joints, axes)
    first, last = nc_judge.ends(at, program.poses)[turn][0], nc_judge.ends(at, program.poses)[turn][-1]
    moving = joints[first : last + 1]
    between = np.concatenate([a + share * (b - a) for a, b in itertools.pairwise(moving)])
    assert heights_over_box(nc_judge.poses(between, axes), 14, 60, stock.lower, stock.upper) > 3.5


def test_errors_of_an_orientation_name_it():
    part = judge.dome()
    upright = setup_of(part)
    tool = riffler.Tool.ball(diameter=6, length=30)
    with pytest.raises(ValueError, match=r"^orientation \[0.0, -0.6, 0.8\]: machine 3-axis holds the tool along z"):
        plan.finish(upright, tool, orientation=(0, -0.6, 0.8))
    along_z = plan.Setup(part, upright.stock, machine="tcp")
    with pytest.raises(ValueError, match=r"^stock: its rays run along z, the orientation is \[0.0, -0.6, 0.8\]; make"):
        plan.rough(along_z, tool, orientation=(0, -0.6, 0.8))
    with pytest.raises(ValueError, match=r"^orientation must be a unit vector, not \[0.0, -3.0, 4.0\]"):
        plan.finish(along_z, tool, orientation=(0, -3, 4))
    for wrong in ("normal", (0.1, 0.2), {"towards": (0, 0, 9)}):
        with pytest.raises(ValueError, match=r"^orientation must be a direction, three numbers"):
            plan.rough(along_z, tool, orientation=wrong)


# ---- rest


def test_a_smaller_tool_cuts_only_what_the_larger_left():
    part = judge.dome()
    large, small = riffler.Tool.ball(diameter=8, length=30), riffler.Tool.ball(diameter=3, length=30)
    lower, upper = part.bounds
    setup = plan.Setup(part, riffler.Volume.block(lower, upper + np.array([0, 0, 1]), 0.3, "xyz"), machine="tcp")
    first = plan.finish(setup, large, cusp=0.04, tolerance=0.02)
    setup.apply(first)
    more = {"cusp": 0.04, "tolerance": 0.02}
    rest, full = plan.finish(setup, small, rest=0.15, **more), plan.finish(setup, small, **more)
    assert 0 < rest.report.cut_mm < 0.5 * full.report.cut_mm
    both = plan.Operation(
        np.concatenate([rest.poses, rest.poses[-1:]]), np.append(rest.kind, 0), np.append(rest.feed, 0.0), small,
        rest.report,
    )  # fmt: skip
    known = Judge(part, small, 0.0, (0.0, 1.3), count=500)
    off = known.points + (0.15 + 0.06 + 2e-3) * known.normals
    left = np.minimum(*(judge.z_map(op, off[:, 0], off[:, 1]) for op in (first, both))) - off[:, 2]
    assert known.reachable.sum() > 120 and not (known.reachable & (left > 0)).any()
    alone = judge.z_map(first, off[:, 0], off[:, 1]) - off[:, 2]
    assert (known.reachable & (alone > 0)).any()  # the first tool did leave something
    setup.apply(rest)
    again = plan.finish(setup, small, rest=0.15, **more)
    assert again.report.cut_mm < 0.05 * rest.report.cut_mm


def inside(curves, points):
    """Whether points lie inside an odd number of curves, by winding angles."""
    turns = np.zeros(len(points))
    for curve in curves:
        a = curve[None, :, :2] - points[:, None, :2]
        b = np.roll(a, -1, axis=1)
        angle = np.arctan2(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0], (a * b).sum(-1)).sum(axis=1)
        turns += np.abs(np.round(angle / (2 * np.pi)))
    return turns % 2 == 1


def test_a_reference_tool_leaves_what_it_cannot_reach():
    """A ball of radius R in a V of 90° leaves material in a band around the edge; its thickness is known."""
    part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
    setup = plan.Setup(part, riffler.Volume.block(*part.bounds, pitch=0.25))
    radius = 4.0
    large, small = riffler.Tool.ball(2 * radius, 30), riffler.Tool.ball(2, 30)
    curves = plan.rest_region(setup, small, 0.2, reference_tool=large)
    y = np.linspace(5, 15, 401)
    points = np.column_stack([np.full(401, 15.0), y, np.zeros(401)])
    corner = part.vertices[part.triangles].reshape(-1, 3)
    slope = math.atan2(np.ptp(corner[corner[:, 2] > corner[:, 2].max() - 11][:, 2]), 10.0)
    bottom, half = float(judge.heights(part, np.array([15.0]), np.array([10.0]))[0]), math.pi / 2 - slope
    centre = bottom + radius / math.sin(half)  # of the ball that touches both sides
    ball = centre - np.sqrt(np.maximum(radius**2 - (y - 10) ** 2, 0))
    thick = (ball - judge.heights(part, points[:, 0], y)) * math.cos(slope)
    thick[np.abs(y - 10) > radius * math.sin(slope)] = 0
    found = inside(curves, points)
    assert found[thick > 0.25].all() and (thick > 0.25).any()
    assert not found[np.abs(y - 10) > np.abs(y - 10)[thick > 0.15].max() + 0.75].any()
    op = plan.finish(setup, small, rest=0.2, reference_tool=large, cusp=0.05, tolerance=0.02)
    assert np.abs(op.poses[op.kind == 2, 1] - 10).max() < radius


def test_rest_is_reported_where_there_is_none():
    part, tool = judge.dome(), riffler.Tool.ball(diameter=6, length=30)
    setup = setup_of(part, pitch=0.3)
    setup.apply(plan.finish(setup, tool, cusp=0.03, tolerance=0.02))
    op = plan.finish(setup, tool, rest=0.5, cusp=0.03, tolerance=0.02)
    assert len(op) == 0 and op.reason == "no material thicker than 0.5 mm stands on the part where the tool reaches"
    with pytest.raises(ValueError, match=r"^reference_tool: needs rest"):
        plan.finish(setup, tool, reference_tool=tool)
    with pytest.raises(TypeError, match="give the tool as reference_tool"):
        plan.finish(setup, tool, rest=tool)
    with pytest.raises(ValueError, match=r"^rest: give either rest or curves as region"):
        plan.finish(setup, tool, rest=0.1, region=[[(0, 0, 0), (9, 0, 0), (0, 9, 0)]])
    with pytest.raises(ValueError, match=r"^above must be positive and finite, not 0"):
        plan.finish(setup, tool, rest=0)
