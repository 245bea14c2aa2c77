"""Turning the tool: angles, the pointer on dials and on the ball, typed numbers; compared with rotations
computed here."""

import math

import numpy as np
import pytest
import riffler
from valleys import valley

from addon.plan.pure import tool_rotation

EAST = np.array([1.0, 0, 0])


def rotation(axis, angle):
    """Rodrigues' formula."""
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    k = np.array([(0, -z, y), (z, 0, -x), (-y, x, 0)])
    return np.eye(3) + math.sin(angle) * k + (1 - math.cos(angle)) * k @ k


def ray_to(place, eye=(30.0, -80, 60)):
    way = np.asarray(place, float) - eye
    return np.array(eye), way / np.linalg.norm(way)


def on_dial(path, handle, angles, turned, radius=20.0):
    """A place on a dial, at this angle."""
    frame = path.frames[2]
    axis = tool_rotation.dial_axis(frame, angles[0], handle)
    across = np.cross(axis, EAST if abs(axis @ EAST) < 0.9 else (0, 1, 0))
    return path.centres[2] + radius * rotation(axis, turned) @ (across / np.linalg.norm(across))


@pytest.mark.parametrize("handle", [tool_rotation.INCLINATION, tool_rotation.TILT])
@pytest.mark.parametrize("turned", [0.5, -0.5, 1e-6, 0.0])
def test_around_a_dial_the_angle_of_its_name_changes_by_the_pointer_s_own(handle, turned):
    path, angles = valley(5, 20), (0.3, -0.2)
    axis = path.axis(2, *angles)
    eye = path.centres[2] + 120 * tool_rotation.dial_axis(path.frames[2], angles[0], handle) + (20, -30, 10)
    made = tool_rotation.Turn(path, 2, axis, handle, ray_to(on_dial(path, handle, angles, 1.0), eye), 20.0)
    made.move(ray_to(on_dial(path, handle, angles, 1.0 + turned), eye))
    wanted = np.add(angles, (turned, 0) if handle == tool_rotation.INCLINATION else (0, turned))
    assert np.allclose(made.angles, wanted, rtol=0, atol=1e-7)  # seven digits of degrees are kept
    about = tool_rotation.dial_axis(path.frames[2], angles[0], handle)
    assert np.allclose(made.axis, rotation(about, turned) @ axis, atol=1e-7) or handle == tool_rotation.INCLINATION


def test_the_inclination_is_about_y_of_the_frame():
    path = valley(5, 20)
    x, y, z = path.frames[2]
    assert np.allclose(
        rotation(tool_rotation.dial_axis((x, y, z), 0.7, tool_rotation.INCLINATION), 0.4) @ z, path.axis(2, 0.4, 0)
    )
    before = path.axis(2, 0.7, 0)
    assert np.allclose(
        rotation(tool_rotation.dial_axis((x, y, z), 0.7, tool_rotation.TILT), 0.4) @ before, path.axis(2, 0.7, 0.4)
    )


def test_a_dial_counts_turns_and_goes_slowly():
    axis = np.array([0.0, 0, 1])

    def at(angle):
        return ray_to((20 * math.cos(angle), 20 * math.sin(angle), 0), (0, 0, 100))

    dial = tool_rotation.Dial((0, 0, 0), axis, 20.0, at(0))
    for angle in np.linspace(0, 13, 40):
        dial.move(at(angle))
    assert dial.turned == pytest.approx(13, abs=1e-9)
    dial.move(at(13.5), tool_rotation.SLOW)
    assert dial.turned == pytest.approx(13.05, abs=1e-9)


def test_a_dial_seen_from_the_side_follows_the_pointer_along_it():
    eye = np.array([0.0, -1e6, 0])  # so far that rays are parallel
    dial = tool_rotation.Dial((0, 0, 0), (0, 0, 1), 20.0, ray_to((0, -20, 0), eye))
    dial.move(ray_to((5, -20, 0), eye))  # its near side goes to +x for a positive angle
    assert dial.turned == pytest.approx(0.25, rel=1e-3)


def test_the_tool_s_end_goes_where_the_pointer_goes():
    path, axis = valley(5, 20), np.array([0.0, -0.6, 0.8])
    centre, radius = path.centres[2], 25.0
    made = tool_rotation.Turn(path, 2, axis, tool_rotation.FREE, ray_to(centre + radius * axis), radius)
    assert np.allclose(made.axis, axis, atol=1e-7)
    goal = np.array([0.48, -0.64, 0.6])
    made.move(ray_to(centre + radius * goal))
    assert np.allclose(made.axis, goal, atol=1e-6)
    made.move(ray_to(np.add(centre, (300, 0, 0))))  # outside the ball: its edge
    assert np.linalg.norm(made.axis) == pytest.approx(1) and made.axis @ goal > 0


def test_a_ball_is_held_on_the_side_that_the_axis_is_on():
    """An axis that points away from the viewer is on the far side."""
    away = np.array([0.0, 1, 0])
    ball = tool_rotation.Ball((0, 0, 0), away, 10.0, ray_to((0, 10, 0), (1, -90, 2)))
    goal = np.array([0.1, 1, 0.2]) / np.linalg.norm((0.1, 1, 0.2))
    assert np.allclose(ball.move(ray_to(10 * goal, (1, -90, 2))), goal, atol=1e-9)


def test_typed_numbers_set_the_angle_of_the_turn():
    path = valley(5, 20)
    made = tool_rotation.Turn(path, 2, path.axis(2, 0.1, 0.2), tool_rotation.TILT, ray_to((0, 0, 0)), 20.0)
    for character in "12.5":
        assert made.type("", character)
    assert made.angles == pytest.approx((0.1, 0.2 + math.radians(12.5)), abs=1e-7) and str(made.typed) == "12.5"
    before = made.angles
    made.move(ray_to((50, 50, 0)))
    assert made.angles == before, "the pointer does not count once a number is typed"
    assert made.type("MINUS", "-") and made.angles[1] == pytest.approx(0.2 - math.radians(12.5), abs=1e-7)
    assert made.type("BACK_SPACE", "") and str(made.typed) == "-12."
    assert not made.type("A", "a") and not made.type("LEFT_SHIFT", "")
    assert made.turned
    while made.typed:
        made.type("BACK_SPACE", "")
    assert not made.turned and made.angles == pytest.approx((0.1, 0.2), abs=1e-7)


def test_angles_snap_and_stay_where_they_name_an_axis():
    path = valley(5, 20)
    made = tool_rotation.Turn(
        path, 2, path.axis(2, 0.11, 0.0), tool_rotation.INCLINATION, ray_to((0, 0, 0), (5, -80, 5)), 20.0
    )
    made.move(ray_to((0, 0, 0), (5, -80, 5)), snap=True)
    assert made.angles[0] == math.radians(5)
    assert tool_rotation.within(math.pi + 0.1, 2.0) == pytest.approx((0.1 - math.pi, math.pi / 2), abs=1e-6)


def test_single_precision_angles_are_the_degrees_that_were_meant():
    for degrees in (7.5, -37.5, 75.0, 0.0, 12.345, 179.5):
        assert tool_rotation.cleaned(float(np.float32(math.radians(degrees)))) == math.radians(degrees)
    assert tool_rotation.said(math.radians(7.5), -math.radians(30)) == "Inclination 7.5°, tilt -30°"


def test_a_ball_stands_with_its_middle_on_the_point_for_any_axis():
    path, tool = valley(5, 20), riffler.Tool.ball(6, 25)
    for axis in ((0.6, -0.48, 0.64), (0, 0, 1), (-0.8, -0.6, 0)):
        assert np.allclose(tool_rotation.stand(path, 2, axis, tool), [*(path.centres[2] - 3 * np.array(axis)), *axis])
