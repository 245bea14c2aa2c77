"""Approach, links and retract of programs that are made from cutter locations, and what is refused to be written."""

import itertools

import numpy as np
import pytest
import riffler
from riffler import plan

TOOL = riffler.Tool.ball(6, 25).with_shank([(25, 3, 40, 3)]).with_holder([(40, 14, 70, 16)])
LEANING = [0, -0.6, 0.8]
TABLE = {"rot_point": [0, 0, -40]}


def step():
    """60 × 40 mm, its profile in (y, z) drawn along x: a floor at z = 8, behind it a wall from y = 20 to z = 24."""
    profile = np.array([(0, 0), (40, 0), (40, 24), (20, 24), (20, 8), (0, 8)], float)
    ends = [np.column_stack([np.full(6, x), profile]) for x in (0, 60)]
    caps = np.array([(0, 5, 4), (0, 4, 1), (1, 4, 3), (1, 3, 2)])
    sides = [(k, (k + 1) % 6, 6 + k) for k in range(6)] + [((k + 1) % 6, 6 + (k + 1) % 6, 6 + k) for k in range(6)]
    return riffler.Mesh(np.concatenate(ends), np.concatenate([caps, caps[:, ::-1] + 6, sides]))


PART = step()
(VALLEY,) = plan.pencil(PART, TOOL)


def block(lower, upper):
    return riffler.Volume.block(lower, upper, 1.0)


def clamp():
    """A bar before the part and above it: the holder meets it where the leaning tool goes out along its axis."""
    return block([-40, -75, 60], [100, -58, 90])


def located(collider, axis=LEANING, tool=TOOL):
    cl, report = plan.cutter_locations(VALLEY.divided(6).orient({0: axis}), tool, collider)
    assert report.ok
    return cl


def cylinder_of_holder(poses):
    """Points (n, k, 3) on the holder's outside at poses: an independent look at where it is."""
    tips, axes = poses[:, None, :3], poses[:, None, 3:]
    u = np.cross(axes, [1.0, 0, 0])
    u /= np.linalg.norm(u, axis=2, keepdims=True)
    v = np.cross(axes, u)
    a = np.linspace(0, 2 * np.pi, 48, endpoint=False)
    points = [
        tips + h * axes + r * (np.cos(b) * u + np.sin(b) * v)
        for h, r in zip(np.linspace(40, 70, 31), np.linspace(14, 16, 31), strict=True)
        for b in a
    ]
    return np.concatenate(points, axis=1)


def enters(program, lower, upper):
    """Whether a point of the holder is in a box at any of many places along the rows."""
    poses = program.poses
    share = np.linspace(0, 1, 60)[:, None]
    for a, b in itertools.pairwise(poses):
        way = a + share * (b - a)
        way[:, 3:] /= np.linalg.norm(way[:, 3:], axis=1)[:, None]
        points = cylinder_of_holder(way)
        if ((points > lower).all(axis=2) & (points < upper).all(axis=2)).any():
            return True
    return False


def test_a_link_goes_round_a_clamp_that_the_straight_approach_would_hit(tmp_path):
    fixture = clamp()
    collider = riffler.Collider(PART, fixtures=[fixture])
    cl = located(collider)
    inside = np.array([-40, -75, 60]) + 0.1, np.array([100, -58, 90]) - 0.1
    plain = riffler.Program.from_cl([cl], tools=[TOOL], feed=800, spindle=9000, safe_height=150)
    assert enters(plain, *inside), "the scene has an obstacle"
    program = riffler.Program.from_cl([cl], tools=[TOOL], feed=800, spindle=9000, collider=collider)
    assert not enters(program, *inside)
    rows = [int(np.abs(program.poses - row).max(axis=1).argmin()) for row in cl]
    assert np.array_equal(program.poses[rows], cl) and not program.rapid[rows].any()
    # A path off the axis may cross stock: it is fed, up to above everything.
    across = np.flatnonzero(program.rapid)
    assert (program.poses[across, 2] > 89.9).all()
    stock = riffler.Volume.from_mesh(PART, 0.5)
    for name, options in (("tcp", {}), ("linuxcnc-xyzac", TABLE), ("linuxcnc-xyzbc", TABLE), ("heidenhain", {})):
        file = tmp_path / name
        with pytest.raises(
            ValueError, match=r"poses, row \d+: on the (feed|rapid).*the holder meets a fixture, .* mm deep"
        ):
            plain.write(file, post=name, options=options, collider=collider)
        assert not file.exists(), "nothing is written"
        assert program.write(file, post=name, options=options, collider=collider, stock=stock).blocks > len(cl)
        program.write(tmp_path / "again", post=name, options=options)
        assert file.read_bytes() == (tmp_path / "again").read_bytes(), "checking changes nothing"
    found = {f.kind for f in riffler.verify(plain, stock, part_mesh=PART, fixtures=[fixture]).findings}
    assert "fixture" in found
    # What follows the holder is not described: that the clamp stands higher is all that there is to say.
    assert {f.kind for f in riffler.verify(program, stock, part_mesh=PART, fixtures=[fixture]).findings} <= {"unknown"}


def test_links_without_obstacles_are_unchanged():
    collider = riffler.Collider(PART)
    cl = located(collider)
    plain = riffler.Program.from_cl([cl, cl], tools=[TOOL], feed=800, occupied=PART.bounds)
    program = riffler.Program.from_cl([cl, cl], tools=[TOOL], feed=800, collider=collider)
    assert np.array_equal(plain.poses, program.poses) and np.array_equal(plain.rapid, program.rapid)


def test_links_are_the_same_for_any_number_of_threads():
    collider = riffler.Collider(PART, fixtures=[clamp()])
    cl, found = located(collider), []
    for threads in (1, 3):
        riffler.set_threads(threads)
        found.append(riffler.Program.from_cl([cl, cl[::-1]] * 3, tools=[TOOL], feed=800, collider=collider).poses)
    riffler.set_threads(None)
    assert np.array_equal(*found)


def roof(lower=(-300, -300, 80), upper=(360, 340, 86)):
    return riffler.Volume.block(lower, upper, 2.0)


@pytest.mark.parametrize("remedy", ["", "move the fixture", "tilt the tool", "stick out further"])
def test_paths_that_cannot_be_linked_are_refused_and_the_remedies_help(remedy):
    axis, tool, fixtures = LEANING, TOOL, [roof()]
    if remedy == "move the fixture":
        fixtures = [roof((400, -300, 80), (900, 340, 86))]
    elif remedy == "tilt the tool":
        axis, fixtures = [0, 0, 1], [roof(upper=(360, -19, 86)), roof(lower=(-300, 41, 80))]
    elif remedy == "stick out further":
        # Between two beams only the shank has room: the holder has to stay above them.
        fixtures = [roof((-300, -300, 40), (360, 10, 60)), roof((-300, 30, 40), (360, 340, 60))]
        axis = [0, 0, 1]
        tool = riffler.Tool.ball(6, 25).with_shank([(25, 3, 60, 3)]).with_holder([(60, 14, 90, 16)])
    collider = riffler.Collider(PART, fixtures=fixtures)
    cl = located(riffler.Collider(PART), axis, tool)
    how = {"tools": [tool], "feed": 800, "collider": collider}
    if remedy:
        assert len(riffler.Program.from_cl([cl], **how)) > len(cl)
        return
    free = located(riffler.Collider(PART, fixtures=[roof((400, -300, 80), (900, 340, 86))]))
    assert np.array_equal(free, cl)
    said = r"^path 1, row 0: no approach is clear: the \w+ meets a fixture, .* mm deep, at \[.*\] \(tip at \[.*\]\).*"
    with pytest.raises(ValueError, match=said + ": tilt the tool differently there .*stick out further"):
        riffler.Program.from_cl([np.array([[0, -300, 200, 0, 0, 1.0]] * 2), cl], **how)


def test_a_colliding_cut_is_named():
    collider = riffler.Collider(PART)
    deep = located(collider) - [0, 0, 0.5, 0, 0, 0]
    said = r"^path 0, row 0: no approach is clear: the cut itself stands where the cutter meets the part, 0\.\d+ mm"
    with pytest.raises(ValueError, match=said + " deep.*plan.cutter_locations"):
        riffler.Program.from_cl([deep], tools=[TOOL], feed=800, collider=collider)
    cl, _ = plan.cutter_locations(VALLEY.divided(6).orient({0: LEANING}), TOOL, collider)
    assert len(riffler.Program.from_cl([cl], tools=[TOOL], feed=800, collider=collider)) > len(cl)
    # One that only a program has: rows between which no check looked.
    through = np.array([[30, -20, 30, 0, 0, 1], [30, 60, 10, 0, 0, 1.0]])
    program = riffler.Program(through, 500, tools={1: TOOL})
    with pytest.raises(ValueError, match=r"^poses, row 1: on the feed move there the \w+ meets the part"):
        program.write("never.ngc", post="3-axis", collider=collider)


def test_the_caller_chooses_how_the_tool_leaves():
    collider = riffler.Collider(PART)
    cl = located(collider)
    how = {"tools": [TOOL], "feed": 800, "collider": collider}
    up = riffler.Program.from_cl([cl], retract=7.5, direction=[0, 0, 1], **how)
    first = int(np.flatnonzero(np.abs(up.poses - cl[0]).max(axis=1) == 0)[0])
    assert np.allclose(up.poses[first - 1, :3] - cl[0, :3], [0, 0, 7.5], atol=1e-12)
    assert np.allclose(up.poses[:first, :2], cl[0, :2], atol=1e-12)
    lead = riffler.Program.from_cl([cl], lead_in=3, **how)
    first = int(np.flatnonzero(np.abs(lead.poses - cl[0]).max(axis=1) == 0)[0])
    assert np.allclose(lead.poses[first - 1, :3] - cl[0, :3], 3 * cl[0, 3:], atol=1e-12)
    assert lead.rapid[:first].all() and not lead.rapid[first]
    high = riffler.Program.from_cl([cl], safe_height=77, **how)
    assert high.poses[0, 2] >= 77
    # A lead-in that leaves stock above it is found where there is stock.
    block_of_all = riffler.Volume.block([0, 0, 0], [60, 40, 24], 0.5)
    with pytest.raises(
        ValueError, match=r"^poses, row \d+: on the move there at \[.*a rapid takes .* of material: retract"
    ):
        lead.write("never.ngc", collider=collider, stock=block_of_all)


@pytest.mark.parametrize(
    "wrong",
    [
        {"retract": -1}, {"retract": float("nan")}, {"lead_in": 0}, {"direction": [0, 0, 2]}, {"contact_tolerance": 0},
        {"safe_height": 10},
    ],
)  # fmt: skip
def test_wrong_options_are_named(wrong):
    collider = riffler.Collider(PART)
    with pytest.raises(ValueError, match=next(iter(wrong))):
        riffler.Program.from_cl([located(collider)], tools=[TOOL], feed=800, collider=collider, **wrong)
    with pytest.raises(ValueError, match="need a collider"):
        riffler.Program.from_cl([located(collider)], tools=[TOOL], feed=800, retract=3)
    with pytest.raises(ValueError, match="shape"):
        riffler.Program.from_cl([located(collider)], tools=None, feed=800, collider=collider)


def test_the_machines_own_motion_is_checked(tmp_path):
    """Two rapids above everything whose great circle goes over the top. A head that cannot lean back turns C by half a
    turn instead, and the holder goes round through a post at the side."""
    lean = np.radians(60)
    rows = [[0, 0, 120, 0, s * np.sin(lean), np.cos(lean)] for s in (-1, 1)]
    program = riffler.Program(np.array(rows), 0, rapid=True, tools={1: TOOL})
    posts = [block([x, -6, 100], [x + 25, 6, 180]) for x in (35, -60)]  # for either direction of turning
    collider = riffler.Collider(PART, fixtures=posts)
    between = riffler.Program(np.array([rows[0], [0, 0, 120, 0, 0, 1], rows[1]]), 0, rapid=True, tools={1: TOOL})
    file = tmp_path / "p.ngc"
    for x in (35, -60):
        clear = not enters(between, np.array([x, -6, 100]), np.array([x + 25, 6, 180]))
        assert clear, "the rows' own motion is clear"
    program.write(file, post="tcp", collider=collider)
    with pytest.raises(ValueError, match=r"^poses, row 1: on the rapid there the holder meets a fixture"):
        program.write(file, post="tcp", options={"limits_a": [0, 90]}, collider=collider)
    # The remedy: room for it.
    away = riffler.Collider(PART, fixtures=[block([135, -6, 100], [160, 6, 180])])
    program.write(file, post="tcp", options={"limits_a": [0, 90]}, collider=away)
