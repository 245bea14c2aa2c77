"""riffler.Collider: shapes, units, errors and promises of what Python gets; the geometry is tested in C++."""

import threading

import numpy as np
import pytest
import riffler


def box(lower, upper):
    corners = np.array([[(lower, upper)[k >> a & 1][a] for a in range(3)] for k in range(8)], float)
    triangles = [
        [0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4],
        [2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5],
    ]  # fmt: skip
    return riffler.Mesh(corners, np.array(triangles, np.int32))


@pytest.fixture(scope="module")
def part():
    return box((-20, -20, -10), (20, 20, 0))


@pytest.fixture(scope="module")
def tool():
    return riffler.Tool.ball(6, 20).with_shank([(20, 3, 35, 3)]).with_holder([(35, 10, 60, 10)])


def pose(x, y, z, axis=(0, 0, 1)):
    return np.array([x, y, z, *axis], float)


def test_clearance_is_one_signed_number_per_pose(part, tool):
    poses = np.array([pose(0, 0, z) for z in (-0.5, 0, 2)])
    assert np.allclose(riffler.Collider(part).clearance(tool, poses), [-0.5, 0, 2], atol=1e-9)
    assert riffler.Collider(part).clearance(tool, np.empty((0, 6))).shape == (0,)


def test_a_query_gives_force_torque_depth_and_points(part, tool):
    hit = riffler.Collider(part, spacing=0.1, stiffness=2).query(tool, pose(1, 2, -0.3))
    assert hit.depth == pytest.approx(0.3, abs=1e-9)
    assert hit.force.shape == (3,) and hit.torque.shape == (3,)
    assert hit.force[2] > 0 and abs(hit.force[0]) < 0.05 * hit.force[2]
    assert hit.points.shape == (len(hit.parts), 3) and set(hit.parts) == {"cutter"}
    assert hit.points[0] == pytest.approx([1, 2, 0], abs=1e-6)
    assert hit.checked == 1 and hit.missed_depth_bound <= 1e-9
    assert "depth 0.3" in repr(hit) or "depth 0.29" in repr(hit)


def test_stiffness_scales_the_force_and_the_holder_has_its_own(part, tool):
    at = pose(22, 0, -40)  # the shank next to the block, the holder over its edge
    weak = riffler.Collider(part, holder_stiffness=1).query(tool, at)
    strong = riffler.Collider(part, holder_stiffness=10).query(tool, at)
    assert weak.parts[0] == "holder"
    assert np.allclose(strong.force, 10 * weak.force)


def test_a_tool_that_touches_nothing_gets_no_force(part, tool):
    hit = riffler.Collider(part).query(tool, pose(0, 0, 1))
    assert hit.depth == 0 and not hit.force.any() and not hit.torque.any()
    assert hit.points.shape == (0, 3) and hit.parts == []


def test_a_budget_is_kept_and_its_bound_holds(part, tool):
    collider = riffler.Collider(part)
    for z in np.linspace(-2, 2, 21):
        full, some = collider.query(tool, pose(0, 0, z)), collider.query(tool, pose(0, 0, z), budget_us=0)
        assert full.depth <= some.depth + some.missed_depth_bound
        assert 0 <= some.checked <= 1


def test_fixtures_of_any_pitch_are_solid(part, tool):
    vise = riffler.Volume.block((30, -20, -10), (60, 20, 30), 2.0)
    empty = riffler.Volume.block((0, 0, 0), (1, 1, 1), 1.0)
    empty.subtract(riffler.Volume.block((0, 0, 0), (1, 1, 1), 1.0))
    collider = riffler.Collider(part, fixtures=[vise, empty])
    hit = collider.query(tool, pose(45, 0, 29))
    assert hit.depth == pytest.approx(1, abs=1e-4)
    assert set(hit.parts) == {"fixture"} and hit.force[2] > 0
    distance, point, name = collider.nearest(tool, pose(45, 0, 32))
    assert distance == pytest.approx(2, abs=1e-4) and name == "fixture" and point[2] == pytest.approx(30, abs=1e-4)
    # The clearance is from the part alone.
    assert collider.clearance(tool, [pose(45, 0, 29)])[0] > 1


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda c, t: c.query(t, [0, 0, 0]), "pose"),
        (lambda c, t: c.query(t, [0, 0, np.nan, 0, 0, 1]), "pose"),
        (lambda c, t: c.query(t, [0, 0, 0, 0, 0, 2]), "axis"),
        (lambda c, t: c.query(t, [0, 0, 0, 0, 0, 1], budget_us=-1), "budget_us"),
        (lambda c, t: c.clearance(t, np.zeros((2, 5))), "poses"),
        (lambda c, t: c.clearance(t, [[0, 0, 0, 0, 0, 1], [0, 0, 0, 0, 0, 0]]), "row 1"),
        (lambda c, t: riffler.Collider(box((0, 0, 0), (1, 1, 1)), spacing=0), "spacing"),
        (lambda c, t: riffler.Collider(box((0, 0, 0), (1, 1, 1)), stiffness=-1), "stiffness"),
        (lambda c, t: riffler.Collider(riffler.Mesh(np.empty((0, 3)), np.empty((0, 3), np.int32))), "part"),
    ],
)
def test_bad_input_is_a_value_error_that_names_it(part, tool, call, message):
    with pytest.raises(ValueError, match=message):
        call(riffler.Collider(part), tool)


def test_each_fixture_may_have_a_material(part, tool):
    vise = riffler.Volume.block((100, 0, 0), (120, 20, 10), 0.5)
    clamp = riffler.Volume.block((200, 0, 0), (220, 20, 10), 0.5)
    hard, soft = riffler.Material(stiffness=6), riffler.Material(stiffness=2)
    collider = riffler.Collider(part, fixtures=[vise, clamp], fixture_stiffness=[hard, 2.0])
    forces = [np.linalg.norm(collider.query(tool, (x, 10, 8, 0, 0, 1)).force) for x in (110, 210)]
    assert forces[0] == pytest.approx(3 * forces[1], rel=1e-9)
    alike = riffler.Collider(part, fixtures=[vise, clamp], fixture_stiffness=soft)
    assert np.linalg.norm(alike.query(tool, (110, 10, 8, 0, 0, 1)).force) == pytest.approx(forces[1], rel=1e-9)
    with pytest.raises(ValueError, match="one for each fixture: there are 1 for 2"):
        riffler.Collider(part, fixtures=[vise, clamp], fixture_stiffness=[1])
    with pytest.raises(TypeError, match="a number or a Material"):
        riffler.Collider(part, fixtures=[vise, clamp], fixture_stiffness="hard")
    with pytest.raises(ValueError, match="fixture_push"):
        riffler.Collider(part, fixtures=[vise], fixture_push="up")


def test_threads_get_the_same_answers(part, tool):
    collider = riffler.Collider(part)
    poses = [pose(x, 0.3 * x, -0.2) for x in np.linspace(-15, 15, 50)]
    expected = [collider.query(tool, p).force for p in poses]
    found = [None] * 4

    def work(k):
        found[k] = [collider.query(tool, p).force for p in poses]

    threads = [threading.Thread(target=work, args=(k,)) for k in range(4)]
    for t in threads:
        t.start()
    for t in threads:
        t.join()
    assert all(np.array_equal(f, expected) for f in found)


def test_repr_describes_the_part(part):
    assert "12 triangles" in repr(riffler.Collider(part, spacing=0.5))


def test_a_fixture_pushes_off_its_wall_or_as_in_the_dissertation():
    part = riffler.Mesh([(1e4, 0, 0), (1e4 + 1, 0, 0), (1e4, 1, 0)], [(0, 1, 2)])
    wall = riffler.Volume.block((0, 0, 0), (30, 20, 10), 0.25)
    tool, pose = riffler.Tool.flat(6, 20), (-2.6, 10, -6, 0, 0, 1)
    off = riffler.Collider(part, fixtures=[wall]).query(tool, pose).force
    along = riffler.Collider(part, fixtures=[wall], fixture_push="centre").query(tool, pose).force
    assert off[0] < -60 and abs(off[2]) < 0.02 * abs(off[0])
    assert abs(along[2]) > 0.2 * abs(along[0])
