"""The map of free orientations as a picture: cells, angles, pixels, colours; and the tool's surroundings."""

import math
import time

import numpy as np
import pytest
import riffler

from addon.plan.pure import clearance as surroundings
from addon.plan.pure import orientation_map

ANGLES = tuple(np.radians(np.linspace(-75, 75, 21)))
TOOL = riffler.Tool.ball(6, 25).with_shank([(25, 3, 40, 3)]).with_holder([(40, 14, 70, 16)])


def grid(cell=8.0):
    return orientation_map.Grid(ANGLES, ANGLES[5:16], cell)


def test_each_pixel_is_of_the_cell_that_is_drawn_there():
    g = grid()
    assert g.size == (88, 168)
    corners = g.triangles().reshape(21, 11, 6, 2)
    for row, column in ((0, 0), (20, 10), (7, 3)):
        low, high = corners[row, column].min(axis=0), corners[row, column].max(axis=0)
        assert np.array_equal(high - low, (8, 8))
        for x, y in (low + 0.5, high - 0.5, (low + high) / 2):
            assert g.cell_at(x, y) == (row, column)
            assert g.angles_at(x, y) == (ANGLES[row], ANGLES[5 + column])
    for x, y in ((-0.5, 5), (88.5, 5), (5, -0.5), (5, 168.5)):
        assert g.cell_at(x, y) is None and g.angles_at(x, y) is None


def test_angles_are_in_the_middle_of_their_cell_and_beyond_on_the_edge():
    g = grid(10.0)
    for row, column in ((0, 0), (20, 10), (7, 3)):
        assert g.place(*g.angles_of(row, column)) == pytest.approx((10 * column + 5, 10 * row + 5))
    between = g.place((ANGLES[3] + ANGLES[4]) / 2, ANGLES[5])
    assert between == pytest.approx((5, 40))
    assert g.place(math.pi, -math.pi / 2) == (0, 210)


def test_triangles_cover_the_map_once():
    t = grid().triangles()
    a, b = t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]
    area = 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    assert (area > 0).all() and area.sum() == pytest.approx(88 * 168)


def test_colours_tell_states_and_depths_apart_and_old_maps_are_grey():
    state = np.array([[0, 1], [1, 3]])
    clearance = np.array([[0.0, -0.1], [-2.0, np.nan]])
    new = orientation_map.colours(state, clearance)
    assert new.shape == (2, 2, 4) and np.isfinite(new).all()
    assert new[0, 0, 1] > new[0, 0, 0] and new[0, 1, 0] > new[0, 1, 1]
    assert new[0, 1, 0] > new[1, 0, 0], "what collides deeper is darker"
    old = orientation_map.colours(state, clearance, old=True)
    assert np.ptp(old[..., :3], axis=-1).max() == 0 and (old[..., 3] < new[..., 3]).all()


# ------------------------------------------------------------------ surroundings
def box(low, high):
    x, y, z = np.meshgrid(*np.transpose([low, high]), indexing="ij")
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = [t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))]
    return riffler.Mesh(np.c_[x.ravel(), y.ravel(), z.ravel()].astype(float), np.array(triangles))


def floor():
    return box((-50, -50, -10), (50, 50, 0))


# The holder's flank, 16 mm from the axis at its top, leans by 1 : 15. A point 3 mm inside it is as far from the flank
# as from the top, at depth h with (3 - h / 15) c = h and the flank's cosine c.
FLANK = 15 / math.hypot(15, 1)
IN_HOLDER = 3 * FLANK / (1 + FLANK / 15)
UPRIGHT, BESIDE = np.array([(0.0, 0, 0, 0, 0, 1), (10, 0, 0, 0, 0, 1)])


def test_the_cutter_may_touch_and_the_nearest_other_obstacle_is_named():
    near = surroundings.Making(floor(), "Plate").result()
    state = near.state(TOOL, UPRIGHT)
    assert state.free and state.piece == "shank" and state.distance == pytest.approx(25, abs=1e-6)
    assert str(state) == "Free, 25 mm to Plate"
    bare = near.state(riffler.Tool.ball(6, 25), UPRIGHT)
    assert bare.free and str(bare) == "Free"


def test_shank_and_holder_alone_keep_their_place():
    body, lift = surroundings.above(TOOL)
    assert lift == 25
    wall = riffler.Collider(box((20, -50, -10), (30, 50, 100)))
    pose = np.concatenate([UPRIGHT[:3] + lift * UPRIGHT[3:], UPRIGHT[3:]])
    assert wall.nearest(body, pose)[0] == pytest.approx(20 - 16, abs=1e-6)  # the holder is 16 mm at its top
    only = riffler.Tool.ball(6, 25).with_holder([(30, 10, 50, 10)])
    body, lift = surroundings.above(only)
    assert lift == 30 and wall.nearest(body, np.array([0, 0, 30.0, 0, 0, 1]))[0] == pytest.approx(10, abs=1e-6)
    assert surroundings.above(riffler.Tool.ball(6, 25)) == (None, 0.0)


def test_a_state_names_what_hits_what_and_by_how_much():
    wall = box((13, -50, -10), (60, 50, 100))
    state = surroundings.Making(wall, "Wall").result().state(TOOL, UPRIGHT)
    assert not state.free and (state.piece, state.other) == ("holder", "Wall")
    assert state.distance == pytest.approx(-IN_HOLDER, abs=1e-6) and str(state) == "Holder hits Wall by 2.8 mm"


def test_fixtures_are_named_and_need_clearance():
    fixtures = [("Vise", box((23, -10, 0), (40, 10, 80))), ("Clamp", box((-80, -10, 0), (-60, 10, 80)))]
    near = surroundings.Making(floor(), "Plate", fixtures).result()
    state = near.state(TOOL, UPRIGHT)
    assert state.free and state.other == "Vise" and state.distance == pytest.approx(7, abs=0.05)
    tight = near.state(TOOL, UPRIGHT, room=8.0)
    assert not tight.free and "only 7 mm from Vise, not 7.99 mm" in str(tight)
    moved = near.state(TOOL, BESIDE)
    assert not moved.free and moved.other == "Vise" and moved.distance == pytest.approx(-IN_HOLDER, abs=0.1)
    clear = near.clearance(TOOL, np.array([UPRIGHT, BESIDE]))
    assert clear == pytest.approx([0, -IN_HOLDER], abs=0.1)


def test_surroundings_are_built_on_a_thread_and_errors_are_raised_by_the_result():
    fixtures = [("Vise", box((23, -10, 0), (40, 10, 80)))]
    making = surroundings.Making(floor(), "Plate", fixtures)
    asked = 0
    while not making.done():
        asked += 1
        assert 0 <= making.progress() <= 1
        time.sleep(0.001)
    assert making.progress() == 1 and making.result().state(TOOL, UPRIGHT).other == "Vise" and making.done and asked
    with pytest.raises(TypeError):
        surroundings.Making("no mesh", "Plate").result()
    flat = riffler.Mesh(np.array([(0.0, 0, 0), (9, 0, 0), (0, 9, 0)]), np.array([(0, 1, 2)]))
    with pytest.raises(ValueError, match="no volume"):  # at once, without waiting
        surroundings.Making(floor(), "Plate", [("Sheet", flat)])


def test_a_guarded_tool_has_a_larger_shank_and_holder():
    straight = riffler.Tool.ball(6, 25).with_holder([(40, 14, 70, 14)])
    wide = riffler.plan.with_room(straight, 2.0)
    assert max(r for _, _, _, r in wide.holder) == pytest.approx(16) and wide.diameter == straight.diameter
    assert not wide.shank
    assert riffler.plan.with_room(TOOL, 0.0) is TOOL
    bare = riffler.Tool.ball(6, 25)
    assert riffler.plan.with_room(bare, 2.0) is bare
