"""Finishing with axes that change along the rows, checked by tilting_judge.py."""

import math

import numpy as np
import pytest
import riffler
from finish_judge import dome, revolved, surface_samples
from riffler import plan
from tilting_judge import centres, deepest, distance_to_cuts, turns

CUSP, TOLERANCE = 0.15, 0.03
BALL = riffler.Tool.ball(diameter=6, length=12).with_shank([(12, 2.5, 25, 2.5)]).with_holder([(25, 9, 50, 9)])
MIDDLE = np.array([15.0, 15.0, 2.0])  # of the dome
RULES = {
    "normal": "normal",
    "lead and tilt": (0.25, -0.1),
    "towards": {"towards": (15, 15, 60)},
    "away from a curve": {"away": [(10, 15, -8), (20, 15, -8)]},
    "least tilt": "least_tilt",
}


def setup_of(part, machine="tcp", allowance=0.3):
    lower, upper = part.bounds
    setup = plan.Setup(part, riffler.Volume.block(lower, [*upper[:2], upper[2] + 1], 0.4, "xyz"), machine=machine)
    setup.apply(plan.rough(setup, riffler.Tool.flat(6, 60), stepdown=1.0, allowance=allowance))
    return setup


@pytest.fixture(scope="module")
def domed():
    return setup_of(dome())


def finished(setup, orientation, pattern="parallel", tool=BALL, **more):
    options = {"cusp": CUSP, "tolerance": TOLERANCE, "slopes": (0, 1.1), **more}
    return plan.finish(setup, tool, pattern, orientation=orientation, **options)


@pytest.mark.parametrize("name", RULES)
def test_no_rule_gouges_and_every_one_reaches_the_cusp(domed, name):
    op = finished(domed, RULES[name], "scallop" if name == "towards" else "parallel")
    depth, move = deepest(op, domed.part, (1, 2, 3), count=1000, step=0.4, turn=0.05)
    assert depth <= TOLERANCE + 1e-6, f"move {move}"
    angle, way = turns(op)
    assert (angle <= 0.1 * way + 1e-3).all()  # the length may be that of a chord
    points, normals, _ = surface_samples(domed.part, 1500, 5)
    # A ball reaches the faces apart from the groove around the dome and the rim of the disc.
    far = np.hypot(*(points[:, :2] - 15).T)
    on_dome = (points[:, 2] > 5) & (np.arccos(normals[:, 2].clip(-1, 1)) < 1.0)
    on_disc = (np.abs(points[:, 2] - 2) < 1e-6) & (normals[:, 2] > 0.9) & (far > 12) & (far < 13.5)
    meant = on_dome | on_disc
    high = points[meant] + (CUSP + TOLERANCE + 2e-3) * normals[meant]
    assert meant.sum() > 100
    assert (distance_to_cuts(op, high) <= 3.0).all()
    assert len(plan.program(domed, [op])) == len(op)


def test_normal_follows_the_surface(domed):
    op = finished(domed, "normal", max_tilt=math.radians(75))
    cuts = np.flatnonzero((op.kind == 2) & (centres(op)[:, 2] > 10.5))  # near the top, where the axis need not wait
    radial = centres(op)[cuts] - MIDDLE
    radial /= np.linalg.norm(radial, axis=1)[:, None]
    angle = np.arccos(np.einsum("ij,ij->i", radial, op.poses[cuts, 3:]).clip(-1, 1))
    assert len(cuts) > 100 and np.quantile(angle, 0.9) < math.radians(5)  # facets are 3.75° apart


def test_lead_leans_forward_and_tilt_to_the_left():
    plate = riffler.Volume.block((0, 0, 0), (60, 30, 10), 2.0, "xyz").to_mesh()
    setup = plan.Setup(plate, riffler.Volume.block((0, 0, 0), (60, 30, 11), 1.0, "xyz"), machine="tcp")
    tool = riffler.Tool.ball(diameter=6, length=40)
    op = finished(setup, (0.2, 0.1), tool=tool, cusp=0.5)
    rows = [k for k in range(1, len(op)) if op.kind[k] == 2 and 25 < centres(op)[k, 0] < 35]
    for k in rows:
        way = centres(op)[k] - centres(op)[k - 1]
        forward = np.sign(way[0])
        lead = math.atan2(forward * op.poses[k, 3], op.poses[k, 5])
        assert lead == pytest.approx(0.2, abs=1e-3)
        assert math.asin(forward * op.poses[k, 4]) == pytest.approx(0.1, abs=1e-3)  # the left of +x is +y
    assert len(rows) > 5


def test_towards_a_point_leads_through_it():
    setup = setup_of(dome())
    point = np.array([15.0, 15.0, 60.0])
    op = finished(setup, {"towards": point})
    cuts = op.kind == 2
    way = point - centres(op)[cuts]
    off = np.linalg.norm(np.cross(way, op.poses[cuts, 3:]), axis=1)
    assert np.median(off) < 0.2 and off.max() < 3.0  # averaged over 3 mm of the row


def test_least_tilt_leans_only_where_the_holder_would_collide():
    tower = revolved([(0, 0), (25, 0), (25, 2), (9, 2), (7, 32), (0, 32)], centre=(25, 25))
    setup = plan.Setup(tower, riffler.Volume.from_mesh(tower, 0.5, directions="xyz"), machine="tcp")
    short = riffler.Tool.ball(diameter=6, length=12).with_shank([(12, 3, 16, 3)]).with_holder([(16, 12, 50, 12)])
    coarse = {"tool": short, "slopes": (0, 0.2), "cusp": 0.4}
    upright = finished(setup, None, **coarse)
    leaning = finished(setup, "least_tilt", max_tilt=math.radians(70), **coarse)
    assert leaning.report.cut_mm > 1.3 * upright.report.cut_mm
    depth, move = deepest(leaning, tower, (1, 2, 3), count=1000, step=0.6, turn=0.08)
    assert depth <= TOLERANCE + 1e-6, f"move {move}"
    cuts = leaning.kind == 2
    tilt = np.arccos(leaning.poses[cuts, 5].clip(-1, 1))
    far = np.hypot(*(centres(leaning)[cuts, :2] - 25).T)
    assert tilt[(far < 14) & (centres(leaning)[cuts, 2] < 10)].min() > 0.05  # next to the tower
    top = centres(leaning)[cuts, 2] > 30
    assert top.any() and tilt[top & (far < 5)].max() < 1e-9


def test_the_tool_rises_above_everything_before_it_turns(domed):
    op = finished(domed, "normal")
    rapid = np.flatnonzero(op.kind == 0)
    turning = [k for k in rapid if k and np.linalg.norm(op.poses[k, 3:] - op.poses[k - 1, 3:]) > 1e-9]
    top = domed.part.bounds[1][2] + 1.0  # of the stock
    assert turning
    for k in turning:
        for pose in (op.poses[k - 1], op.poses[k]):
            tilt = math.acos(min(1.0, pose[5]))
            lowest = min(z * math.cos(tilt) - r * math.sin(tilt) for z, r in ((0, 0), (3, 3), (25, 9)))
            assert pose[2] + lowest >= top + domed.clearance - 1e-9
    assert np.allclose(op.poses[[0, -1], 3:], [0, 0, 1])


def test_the_machine_accepts_the_program(domed, tmp_path):
    setup = setup_of(dome(), machine="linuxcnc-xyzac")
    op = finished(setup, (0.1, 0.0))
    program = plan.program(setup, [op])
    options = {"rot_point": [15, 15, -40]}
    path = tmp_path / "dome.ngc"
    program.write(path, post="linuxcnc-xyzac", options=options, tolerance=0.1 * TOLERANCE)
    back = riffler.Program.read(path, machine="linuxcnc-xyzac", options=options)
    limits = {"tolerance": TOLERANCE, "gouge_tolerance": 1.2 * TOLERANCE}
    report = riffler.verify(back, setup.stock, setup.part, tools=program.tools, **limits)
    assert report.passed, report.findings[:2]


def test_the_same_bytes_for_any_number_of_threads(monkeypatch):
    setup = setup_of(dome())
    found = []
    for count in ("1", "2", "4"):
        monkeypatch.setenv("RIFFLER_THREADS", count)
        found.append(finished(setup, "normal", "spiral"))
    assert all(op.poses.tobytes() == found[0].poses.tobytes() for op in found)


def test_cancel_leaves_nothing(domed):
    with pytest.raises(riffler.Cancelled):
        finished(domed, "normal", progress=lambda share: share < 0.6)


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ({"orientation": "upright"}, "orientation must be a direction"),
        ({"orientation": {"along": (0, 0, 1)}}, "orientation must be a direction"),
        ({"orientation": {"towards": (0, 1)}}, "towards needs a point"),
        ({"orientation": (1.6, 0)}, "less than 90°"),
        ({"orientation": "normal", "max_tilt": 1.5}, "max_tilt must be above 0 and at most 80°"),
        ({"orientation": "normal", "max_turn": 0.0}, "max_turn"),
        ({"orientation": "normal", "tool": riffler.Tool.flat(6, 30)}, "has no ball at its tip"),
    ],
)
def test_what_makes_no_sense_is_refused_by_name(domed, more, said):
    with pytest.raises(ValueError, match=said):
        finished(domed, **more)


def test_a_machine_of_three_axes_refuses_rules():
    part = dome()
    setup = plan.Setup(part, riffler.Volume.block(*part.bounds, 1.0))
    with pytest.raises(ValueError, match="3-axis holds the tool along z"):
        finished(setup, "normal")
