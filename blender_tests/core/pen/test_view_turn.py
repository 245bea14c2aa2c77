"""The pen's axes turned with the view: how a hand moves the tool in the picture, and when they turn."""

import time

import numpy as np
import pytest
import riffler

from addon.pen.pure import view_turn
from addon.pen.pure.view_turn import ViewTurn, turn_of

# Views as rows right, up, towards the viewer, in the world.
TOP = np.eye(3)
FRONT = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
RIGHT = np.array([[0.0, 1, 0], [0, 0, 1], [1, 0, 0]])
WORLD = np.eye(3)
# The hand to the right, up and away, in the frame of a puck (right, away, up) and of a pen with arms (x to the hand).
HANDS = {
    "spacemouse": ((1, 0, 0), (0, 0, 1), (0, 1, 0)),
    "haply": ((1, 0, 0), (0, 0, 1), (0, 1, 0)),
    "simulated": ((0, 1, 0), (0, 0, 1), (-1, 0, 0)),
    "riffler-pen": ((0, 1, 0), (0, 0, 1), (-1, 0, 0)),
}


def spun(rng):
    q, r = np.linalg.qr(rng.standard_normal((3, 3)))
    q *= np.sign(np.diag(r))
    return q if np.linalg.det(q) > 0 else q[:, [1, 0, 2]]


@pytest.mark.parametrize("kind", HANDS)
def test_the_tool_moves_in_the_picture_as_the_hand_does(kind):
    rng = np.random.default_rng(4)
    for view in (TOP, FRONT, RIGHT, *(spun(rng) for _ in range(20))):
        for to_frame in (WORLD, spun(rng)):
            turn = turn_of(kind, view, to_frame)
            assert np.allclose(turn.T @ turn, np.eye(3), atol=1e-12) and np.linalg.det(turn) > 0
            for hand, seen in zip(HANDS[kind], ((1, 0, 0), (0, 1, 0), (0, 0, -1)), strict=True):
                in_world = to_frame.T @ turn @ hand
                assert np.allclose(view @ in_world, seen, atol=1e-12), "in the axes of the picture"


def test_every_kind_of_device_has_axes():
    assert not view_turn.OF_ARMS.difference(riffler.pen.kinds())
    for kind in riffler.pen.kinds():
        right, up, away = view_turn.axes_of(kind)
        assert np.allclose(np.cross(right, away), up), "right-handed"


def test_scaled_and_single_precision_axes_make_a_rotation_that_a_session_takes():
    rng = np.random.default_rng(5)
    for _ in range(50):
        view, frame = (spun(rng).astype(np.float32) * rng.uniform(0.01, 100) for _ in range(2))
        turn = turn_of("simulated", view, frame)
        stock = riffler.Volume.block((0, 0, 0), (4, 4, 4), 1.0)
        riffler.Session(stock, riffler.Tool.ball(2, 8), turn=turn)


def test_a_flat_or_broken_frame_is_refused():
    for bad in (np.zeros((3, 3)), np.diag([1.0, 1, 0]), np.full((3, 3), np.nan)):
        with pytest.raises(ValueError, match="axes are"):
            turn_of("simulated", TOP, bad)


def test_an_object_that_mirrors_still_gives_a_rotation():
    assert np.linalg.det(turn_of("simulated", TOP, np.diag([-1.0, 1, 1]))) > 0


def test_the_axes_turn_between_strokes_only():
    axes = ViewTurn("spacemouse")
    assert np.allclose(axes.follow(TOP, WORLD, held=True), turn_of("spacemouse", TOP, WORLD)), "there is none yet"
    assert axes.follow(TOP, WORLD) is None, "nothing has changed"
    assert axes.follow(FRONT, WORLD, held=True) is None and np.allclose(axes.turn, turn_of("spacemouse", TOP, WORLD))
    assert np.allclose(axes.follow(FRONT, WORLD), turn_of("spacemouse", FRONT, WORLD)), "after the release"


def test_a_turn_moves_no_tool():
    """The view turns between two steps of a session: the tool stays, and then follows the new axes."""
    pen = riffler.pen.open("simulated")
    stock = riffler.Volume.block((-30, -30, -20), (30, 30, 0), 1.0)
    with riffler.Session(stock, riffler.Tool.ball(6, 30), pen, at=(0, 0, 20, 0, 0, 1)) as session:
        wait(lambda: pen.state().homed)
        home = pen.state().pose
        pen.aim(home)
        tool = settled(session)
        session.set_workspace(turn=turn_of("simulated", FRONT, WORLD))
        assert np.abs(settled(session) - tool).max() < 0.2
        up = np.add(home, (0, 0, 8, 0, 0, 0))
        pen.aim(up)
        moved = settled(session)[:3] - tool[:3]
        assert moved[2] > 4 and np.abs(moved[:2]).max() < 2, "up in the front view is up"
        session.set_workspace(turn=turn_of("simulated", TOP, WORLD))
        tool = settled(session)
        pen.aim(home)
        moved = settled(session)[:3] - tool[:3]
        assert moved[1] < -4 and np.abs(moved[[0, 2]]).max() < 2, "down in the view from the top is -y"
    pen.stop()


def wait(done):
    end = time.monotonic() + 20
    while not done():
        assert time.monotonic() < end
        time.sleep(0.01)


def settled(session):
    """The tool's pose once it stands still."""
    last, end = None, time.monotonic() + 20
    while time.monotonic() < end:
        time.sleep(0.15)
        frame = session.frame()
        if len(frame) and last is not None and np.abs(frame.tool - last).max() < 0.02:
            return frame.tool
        last = frame.tool if len(frame) else last
    raise AssertionError("the tool does not come to rest")
