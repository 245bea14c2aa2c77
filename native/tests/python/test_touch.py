"""The hand touches what it carves: a session's stock as an obstacle while no button is held."""

from __future__ import annotations

import time

import numpy as np
import pytest
import riffler

RADIUS, STIFFNESS = 3.0, 10.0
BALL = riffler.Tool.ball(2 * RADIUS, 30)
LOWER, UPPER = (-20, -15, -12), (20, 15, 0)


def dense(cut: np.ndarray, pose: np.ndarray, h: float = 0.03) -> np.ndarray:
    """N: the law of the touch, point by point, on the block without balls at the poses ``cut``; knows no rays."""
    centre = pose[:3] + RADIUS * pose[3:]
    grids = [np.arange(c - RADIUS, c + RADIUS, h) for c in centre]
    low = grids[2] < UPPER[2]
    points = np.stack(np.meshgrid(grids[0], grids[1], grids[2][low], indexing="ij"), axis=-1).reshape(-1, 3)
    points += h * np.random.default_rng(1).random(points.shape)  # no layers, which a face would meet all at once
    away = points - centre
    far = np.linalg.norm(away, axis=1)
    inside = (far < RADIUS) & (far > RADIUS - 0.3)
    points, away, far = points[inside], away[inside], far[inside]
    filled = ((points > LOWER) & (points < UPPER)).all(axis=1)
    for tip in cut[:, :3]:
        filled &= ((points - tip - (0, 0, RADIUS)) ** 2).sum(axis=1) > RADIUS**2
    return -STIFFNESS * h**3 * (away[filled] / far[filled, None]).sum(axis=0)


def homed(pen: riffler.PenDevice) -> np.ndarray:
    """The pose in which the simulated hand then holds the pen."""
    end = time.monotonic() + 20
    while not pen.state().homed and time.monotonic() < end:
        time.sleep(0.01)
    pen.aim(pen.state().pose)
    time.sleep(0.3)
    return pen.state().pose


def rests(session: riffler.Session, seconds: float = 1.2, cut: list | None = None) -> riffler.SessionFrame:
    """The last frame after so long; poses at which something was cut are added to ``cut``."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        frame = session.frame()
        if cut is not None:
            cut.extend(frame.poses[np.asarray(frame.cutting, bool)])
        time.sleep(0.02)
    return frame


def thinned(poses: list) -> np.ndarray:
    """Poses at least 0.06 mm apart."""
    kept = [poses[0]]
    for pose in poses:
        if np.linalg.norm(pose[:3] - kept[-1][:3]) > 0.06:
            kept.append(pose)
    return np.array([*kept, poses[-1]])


@pytest.mark.parametrize("directions", ["z", "xyz"])
def test_the_hand_feels_the_dense_sum_on_a_face_an_edge_and_in_a_groove_that_it_has_cut(directions):
    stock = riffler.Volume.block(LOWER, UPPER, 0.2, directions)
    with riffler.pen.open("simulated") as pen:
        home = homed(pen)
        session = riffler.Session(stock, BALL, pen, at=(0, 0, 1, 0, 0, 1), touch=True,
                                  material=riffler.Material(removal_constant=0.002))  # fmt: skip

        cut: list = []

        def go(*offset, buttons=0):
            pen.aim(home + np.array([*offset, 0, 0, 0]), buttons=buttons)
            return rests(session, cut=cut)

        def as_dense(frame, most=0.12):
            truth = dense(thinned(cut) if cut else np.zeros((0, 6)), frame.tool)
            size = np.linalg.norm(truth)
            assert size > 0.2
            assert np.linalg.norm(frame.force[:3] - truth) < most * size + 0.03, (frame.force, truth)

        with session:
            assert np.linalg.norm(rests(session).force) < 0.05, "in the air"
            face = go(0, 0, -3.0)
            as_dense(face)
            assert abs(face.tool[2]) < 0.3 and stock.volume == pytest.approx(40 * 30 * 12)
            go(0, 0, -2.5, buttons=1)
            before = stock.volume
            assert before < 40 * 30 * 12 - 1, "the button cuts"
            go(0, 6, -2.5, buttons=1)
            groove = go(1.8, 3, -3.6)
            assert stock.volume < before
            # The ball fits its groove: 80 N/mm, so a tenth of a newton is the micrometre that columns and cut leave.
            as_dense(groove, 0.3)
            assert groove.force[2] > 0
            go(0.6, 3, 2)
            go(21.5, 3, 2)
            edge = go(21.0, 3, -3.0)
            as_dense(edge)
            assert edge.force[0] > 0.1, "the edge pushes outwards"
    assert session.running is False


def test_it_is_off_by_default_and_bad_settings_are_named():
    stock = riffler.Volume.block(LOWER, UPPER, 0.5)
    with pytest.raises(ValueError, match="touch: a session that adds material"):
        riffler.Session(stock, BALL, mode="add", touch=True)
    with pytest.raises(ValueError, match="touch_force"):
        riffler.Session(stock, BALL, touch=True, touch_force=0.0)
    with riffler.pen.open("simulated") as pen:
        home = homed(pen)
        with riffler.Session(stock, BALL, pen, at=(0, 0, 1, 0, 0, 1)) as session:
            pen.aim(home + np.array([0, 0, -2, 0, 0, 0]))
            frame = rests(session)
            assert frame.state == "ready" and not frame.force.any()
            assert frame.tool[2] < -0.5, "it passes through the stock"


def test_a_mouse_stays_on_the_stock_too():
    stock = riffler.Volume.block(LOWER, UPPER, 0.25)
    mouse = riffler.pen.Pointer("mouse")
    at = time.monotonic()

    def put(height: float, buttons: int = 0) -> None:
        mouse.set_frame(origin=(0, 0, height))
        mouse.give(0, 0, buttons=buttons, time=time.monotonic() - at)

    with riffler.Session(stock, BALL, mouse, touch=True) as session:
        put(1)
        rests(session, 0.3)
        put(-2)
        assert abs(rests(session, 0.5).tool[2]) < 0.4
        put(-2, 1)
        assert rests(session, 0.5).tool[2] < -1
    assert stock.volume < 40 * 30 * 12 - 1
