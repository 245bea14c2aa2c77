"""Mouse and tablet as the hand that holds a plan's tool."""

import time

import numpy as np
import pytest
import riffler

from addon.plan.pure import pointer_hand
from addon.plan.pure.pointer_hand import PointerHand
from addon.sculpt.pure.view_rays import ViewRays

TOOL = riffler.Tool.ball(6, 20)
UP = np.array([0.0, 0.0, 1.0])


def path(count=31):
    """60 mm along x in the corner of a plate and a wall."""
    centres = np.column_stack([np.linspace(0, 60, count), np.full(count, 3.0), np.full(count, 3.0)])
    contacts = centres[:, None] + [(0, 0, -3), (0, 3, 0)]
    normals = np.tile([[(0.0, 0, 1), (0, -1, 0)]], (count, 1, 1))
    return riffler.plan.PencilPath(3.0, centres, contacts, normals)


def view():
    """From above, x to the right: 10 pixels to a millimetre, the middle of the path in the middle of the view."""
    return ViewRays([(0.02, 0, 0, -0.6), (0, 0.04, 0, -0.12), (0, 0, -0.01, 0), (0, 0, 0, 1)], (1000, 500))


def at(x, y):
    return np.array([500 + 10 * (x - 30), 250 + 10 * (y - 3)], float)


def pose(hand):
    return hand.device.state().pose


def test_the_view_matches_its_description():
    assert np.allclose(view().project([(30, 3, 3), (40, 13, 3)]), [at(30, 3), at(40, 13)])
    right, up, back = view().basis()
    assert np.allclose([right, up, back], np.eye(3))


def test_it_begins_where_the_tool_stands():
    axis = np.array([0.0, -0.6, 0.8])
    hand = PointerHand(path(), TOOL, 15, axis)
    assert np.allclose(pose(hand), [30, 3 + 1.8, 3 - 2.4, 0, -0.6, 0.8])


def test_the_mouse_drags_the_tools_end_from_anywhere():
    hand = PointerHand(path(), TOOL, 15, UP)
    hand.move(view(), (20.0, 40.0), 20.0)
    assert np.allclose(pose(hand)[3:], UP), "the tool jumped to the mouse"
    hand.move(view(), (120.0, 40.0), 20.0)  # half the ball's radius to the right
    assert np.allclose(pose(hand)[3:], [0.5, 0, np.sqrt(0.75)], atol=1e-6)
    assert np.allclose(pose(hand)[:3], [30 - 1.5, 3, 3 - 3 * np.sqrt(0.75)], atol=1e-6), "the ball left its point"
    hand.move(view(), (920.0, 40.0), 20.0)  # beyond the ball's edge, and back from there
    assert np.allclose(pose(hand)[3:], [1, 0, 0], atol=1e-3)
    hand.move(view(), (820.0, 40.0), 20.0)
    assert np.allclose(pose(hand)[3:5], [0.5, 0], atol=1e-3)


@pytest.mark.parametrize("turned", [False, True])
def test_a_view_that_was_left_or_turned_meanwhile_turns_no_tool(turned):
    hand = PointerHand(path(), TOOL, 15, UP)
    hand.move(view(), (20.0, 40.0), 20.0)
    hand.move(view(), (120.0, 40.0), 20.0)
    before = pose(hand)
    other = ViewRays([(0.02, 0, 0, -0.6), (0, 0, 0.04, -0.12), (0, 0.01, 0, 0), (0, 0, 0, 1)], (1000, 500))
    if not turned:
        hand.leave()
    hand.move(other if turned else view(), (700.0, 100.0), 20.0)
    assert np.allclose(pose(hand), before)


def test_with_control_the_mouse_goes_along_the_path_and_keeps_the_axis():
    hand = PointerHand(path(), TOOL, 15, (0, -0.6, 0.8))
    hand.move(view(), at(44.1, 9), 20.0, along=True)
    assert hand.index == 22 and np.allclose(pose(hand), [44, 4.8, 0.6, 0, -0.6, 0.8])
    hand.move(view(), (20.0, 9.0), 20.0)  # taken up there, without a jump
    assert hand.index == 22 and np.allclose(pose(hand)[3:], [0, -0.6, 0.8])


@pytest.mark.parametrize(
    ("tilt", "axis"),
    [
        ((0, 0), UP),
        ((0.25, 0), (np.sin(np.pi / 8), 0, np.cos(np.pi / 8))),
        ((0, -1 / 3), (0, -0.5, np.sqrt(0.75))),
        ((-1, 0), (-np.sin(1), 0, np.cos(1))),  # no pen lies down
        ((np.nan, 0), UP),
    ],
)
def test_the_tool_leans_as_the_pen_of_a_tablet_does_and_is_under_it(tilt, axis):
    hand = PointerHand(path(), TOOL, 15, (0, -0.6, 0.8))
    hand.move(view(), at(10.2, 3), 20.0, tilt=tilt)
    assert hand.index == 5 and np.allclose(pose(hand)[3:], axis, atol=1e-9)
    assert np.allclose(pose(hand)[:3] + 3 * np.array(axis), [10, 3, 3], atol=1e-6)


def test_held_at_its_point_the_tool_only_turns():
    hand = PointerHand(path(), TOOL, 15, UP, slides=False)
    hand.move(view(), at(50, 3), 20.0, tilt=(0.25, 0))
    assert hand.index == 15 and pose(hand)[3] > 0.3
    hand.move(view(), at(10, 3), 20.0, along=True)
    assert hand.index == 15


def test_a_click_is_held_until_the_session_has_seen_it():
    hand = PointerHand(path(), TOOL, 15, UP)
    hand.press(pointer_hand.SET)
    hand.rest()
    assert hand.device.state().buttons == 1
    time.sleep(1.5 * pointer_hand.HELD)
    hand.rest()
    assert hand.device.state().buttons == 0
    hand.press(pointer_hand.DELETE)
    assert hand.device.state().buttons == 2


def test_a_session_follows_it_and_sets_a_key():
    part = riffler.Mesh([(0, -50, 0), (60, -50, 0), (60, 50, 0), (0, 50, 0)], [(0, 1, 2), (0, 2, 3)])
    hand = PointerHand(path(), TOOL, 15, UP)
    with riffler.OrientSession(path(), TOOL, riffler.Collider(part), hand.device, point=15, axis=UP) as session:
        hand.move(view(), at(30, 3), 20.0)
        hand.move(view(), at(30, -3), 20.0)
        time.sleep(0.3)  # the tool follows as one on a spring
        hand.press(pointer_hand.SET)
        end, changes = time.monotonic() + 10, ()
        while not changes and time.monotonic() < end:
            time.sleep(0.01)
            changes = session.frame().changes
    (change,) = changes
    assert change.point == 15 and not change.deleted and change.refused in (None, "")
    assert np.allclose(change.axis, [0, -0.3, np.sqrt(0.91)], atol=0.05)
