"""riffler.pen: shapes, units and errors of what Python gets, and its kinematics against serial chains in numpy."""

import numpy as np
import pytest
import riffler
from riffler.pen import PenGeometry

L0, UPPER, FORE = 80.0, {"R": 150.0, "L": 180.0}, 180.0
STEPS = np.array([48000, 48000, 70000, 48000, 48000, 70000])
HOME = np.array([0, 0, -5133, 0, 0, 5133], np.int32)


@pytest.fixture(scope="module")
def pen():
    return PenGeometry.load("riffler")


def turn(axis, angle):
    """4 × 4: about a coordinate axis, for complex angles too."""
    c, s = np.cos(angle), np.sin(angle)
    out = np.eye(4, dtype=np.result_type(angle, float))
    i, j = [(1, 2), (2, 0), (0, 1)][axis]
    out[i, i] = out[j, j] = c
    out[i, j], out[j, i] = -s, s
    return out


def shift(x=0.0, y=0.0, z=0.0):
    out = np.eye(4)
    out[:3, 3] = x, y, z
    return out


def chain_end(arm, angles):
    """The arm as a serial chain: shoulder, upper arm hanging down, elbow by what the parallelogram leaves of θ3."""
    first, second, third = angles
    side = L0 if arm == "R" else -L0
    # At θ2 = θ3 = 0 the fore arm stands a quarter turn before the upper arm's direction.
    matrix = shift(y=side) @ turn(2, first) @ turn(1, -second) @ shift(z=-UPPER[arm])
    matrix = matrix @ turn(1, -(third - second)) @ shift(x=FORE)
    return matrix[:3, 3]


def random_counts(n, seed):
    return np.random.default_rng(seed).integers(-8000, 8000, (n, 6)).astype(np.int32)


def chains(counts):
    """(n, 2, 3) ends of R and of L; counts come as θ2 θ3 θ1."""
    angles = counts / STEPS * 2 * np.pi
    return np.array([[chain_end("R", row[[2, 0, 1]]), chain_end("L", row[[5, 3, 4]])] for row in angles])


def test_the_shipped_pen_has_its_name_home_and_channels(pen):
    assert "two arms" in riffler.pen.names()["riffler"]
    assert pen.name == "riffler" and pen.description == riffler.pen.names()["riffler"]
    assert pen.home.dtype == np.int32 and np.array_equal(pen.home, HOME)
    assert [c.name for c in pen.channels] == ["R2", "R3", "R1", "L2", "L3", "L1"]
    assert pen.grip_length == 30 and pen.limits.force > 0


def test_forward_agrees_with_the_serial_chain(pen):
    counts = random_counts(2000, 1)
    right, left = np.moveaxis(chains(counts), 1, 0)
    assert np.abs(pen.ends(counts)[:, 0] - right).max() < 1e-12 * 400
    assert np.abs(pen.ends(counts)[:, 1] - left).max() < 1e-12 * 400
    poses = pen.forward(counts)
    assert poses.shape == (2000, 6) and poses.dtype == np.float64
    apart = left - right  # s_G of (2.4); the tool's tip is at L, so the axis leads from there to R
    assert np.allclose(poses[:, :3], (right + left) / 2, atol=1e-10)
    assert np.allclose(poses[:, 3:], -apart / np.linalg.norm(apart, axis=1)[:, None], atol=1e-12)
    assert np.allclose(pen.stretch(counts), np.linalg.norm(apart, axis=1) - 30, atol=1e-10)


def test_jacobian_is_the_chains_complex_derivative(pen):
    counts = random_counts(200, 2)
    angles = pen.joints(counts)
    jacobian = pen.jacobian(counts)
    assert jacobian.shape == (200, 2, 3, 3)
    for row in range(200):
        for arm, name in enumerate("RL"):
            own = angles[row, 3 * arm : 3 * arm + 3]
            for joint in range(3):
                step = own + 1e-30j * np.eye(3)[joint]
                assert np.abs(jacobian[row, arm, :, joint] - chain_end(name, step).imag / 1e-30).max() < 1e-11


def test_efforts_do_the_work_of_the_wrench(pen):
    rng = np.random.default_rng(3)
    poses = np.column_stack([rng.uniform((140, -40, -190), (190, 40, -140), (300, 3)), np.tile((0, 0, 1.0), (300, 1))])
    joints, reach = pen.inverse(poses)
    good = np.array([pair == ("reached", "reached") for pair in reach])
    assert good.sum() > 200
    joints, poses = joints[good], poses[good]
    assert np.allclose(pen.forward(pen.counts(joints)), poses, atol=0.02)
    wrenches = np.column_stack([rng.normal(size=(len(poses), 3)), rng.normal(size=(len(poses), 3)) * 20])
    at = poses[:, :3] + rng.normal(size=(len(poses), 3)) * 30
    torques, missing = pen.efforts(pen.counts(joints), wrenches, at)
    assert np.abs(missing[:, :2]).max() < 0.1  # along the grip, which stands upright but for rounding to counts
    step = 1e-4
    for k, axis in [(0, (0, 0, 0)), (1, (0, 0, 0)), (2, (0, 0, 0)), (3, (1, 0, 0)), (4, (0, 1, 0))]:
        move, spin = np.eye(3)[k] * step if k < 3 else np.zeros(3), np.array(axis) * step

        def at_end(sign, move=move, spin=spin):
            axes = poses[:, 3:] + sign * np.cross(spin, poses[:, 3:])
            axes /= np.linalg.norm(axes, axis=1)[:, None]
            return pen.inverse(np.column_stack([poses[:, :3] + sign * move, axes]))[0]

        work = ((at_end(1) - at_end(-1)) * torques).sum(axis=1)
        moved = move + np.cross(spin, at - poses[:, :3])
        given = 2 * ((wrenches[:, :3] * moved).sum(axis=1) + wrenches[:, 3:] @ spin)
        # The torques are of the rounded counts, the motion is of the poses themselves.
        assert np.abs(work - given).max() < 2e-3 * np.abs(torques).max() * step


def test_split_has_the_force_and_the_torque_perpendicular_to_the_grip(pen):
    rng = np.random.default_rng(4)
    wrenches, apart = rng.normal(size=(1000, 6)) * 10, rng.normal(size=(1000, 3)) * 20
    forces, missing = pen.split(wrenches, apart)
    assert forces.shape == (1000, 2, 3) and missing.shape == (1000, 3)
    assert np.allclose(forces.sum(axis=1), wrenches[:, :3], atol=1e-13)
    moment = np.cross(apart / 2, forces[:, 1]) + np.cross(-apart / 2, forces[:, 0])
    assert np.allclose(moment + missing, wrenches[:, 3:], atol=1e-12)
    assert np.allclose(np.cross(missing, apart), 0, atol=1e-11)


def test_motor_commands_stay_within_the_peaks(pen):
    torques = np.array([[0, 180.0, 0, 0, 0, 0], [0, 5400, 0, 0, -540, 0]])
    currents, scale = pen.motor_currents(torques)
    assert currents.dtype == np.int16 and np.array_equal(scale, [1, 0.1])
    assert np.array_equal(currents, [[1000, 0, 0, 0, 0, 0], [3000, 0, 0, -300, 0, 0]])
    steps, _ = pen.converter_steps(torques)
    assert np.array_equal(steps, [[660, 0, 0, 0, 0, 0], [1980, 0, 0, -198, 0, 0]])


def test_a_lost_count_is_detected_and_located(pen):
    rng = np.random.default_rng(5)
    axes = np.column_stack([rng.normal(size=(200, 2)) * 0.4, np.ones(200)])
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    poses = np.column_stack([rng.uniform((130, -60, -200), (220, 60, -130), (200, 3)), axes])
    joints, reach = pen.inverse(poses)
    counts = pen.counts(joints)[[pair == ("reached", "reached") for pair in reach]]
    assert pen.diagnose(counts).fault == "none"
    counts[:, 4] += 80
    found = pen.diagnose(counts)
    assert found.fault == "channel" and found.channel == 4
    assert found.counts == pytest.approx(80, abs=2)
    noticed = pen.noticed_counts([HOME])
    assert noticed.shape == (1, 6) and noticed[0, 1] == pytest.approx(10.6, abs=0.1)


def test_homing_takes_the_readings_of_the_counters_as_home(pen):
    start = np.array([2**31 - 1, -(2**31), 5, 100, -7, 2**31 - 20])
    moved = np.array([30, -40, 50, 60, -70, 80])
    wrapped = ((start + moved + 2**31) % 2**32) - 2**31
    homed = pen.homed([start], probe=2**31 - 1)
    assert np.array_equal(homed.forward([wrapped]), pen.forward([HOME + moved]))
    assert np.array_equal(homed.home, start) and np.array_equal(pen.home, HOME)
    assert homed.probe_angle(-(2**31) + 199) == pytest.approx(np.pi / 2)
    with pytest.raises(ValueError, match="counts must have one row"):
        pen.homed([start, start])


def test_capability_names_what_the_hand_cannot_feel(pen):
    capability = pen.capability()
    assert capability.text.endswith("the hand does not feel: torque about the grip's axis")
    assert [capability.axes[a].pushes for a in "xyzabc"] == [True] * 5 + [False]
    assert capability.axes["z"].peak == pytest.approx(6, abs=1e-3)


@pytest.mark.parametrize(
    ("counts", "message"),
    [
        ([0, 0, 0], r"counts must have the shape \(n, 6\)"),
        ([[0.5] * 6], "counts, row 0: must be whole numbers of 32 bits"),
        ([[0] * 6, [2**31] + [0] * 5], "counts, row 1: must be whole numbers of 32 bits"),
        ([[np.nan] * 6], "counts, row 0: not finite"),
    ],
)
def test_bad_counts_are_refused(pen, counts, message):
    with pytest.raises(ValueError, match=message):
        pen.forward(counts)


def test_other_bad_arguments_are_refused(pen):
    with pytest.raises(ValueError, match="apart must have as many rows as wrenches: 2, not 1"):
        pen.split(np.zeros((2, 6)), np.ones((1, 3)))
    with pytest.raises(ValueError, match="at must have as many rows as counts: 1, not 2"):
        pen.efforts([HOME], np.zeros((1, 6)), np.zeros((2, 3)))
    with pytest.raises(ValueError, match="torques, row 0: not finite"):
        pen.motor_currents([[np.inf] * 6])
    with pytest.raises(ValueError, match="unknown pen 'none'; known: riffler"):
        PenGeometry.load("none")
    assert pen.forward([[2**31 - 1, -(2**31), 0, 0, 0, 0]]).shape == (1, 6)
    assert pen.forward(np.empty((0, 6))).shape == (0, 6)


def test_a_users_pen_is_loaded_from_its_file(tmp_path, monkeypatch):
    (tmp_path / "mine.toml").write_text('description = "half a pen"\n[arms]\nshoulder = -3\n')
    monkeypatch.setenv("RIFFLER_PENS", str(tmp_path))
    assert riffler.pen.names()["mine"] == "half a pen"
    with pytest.raises(riffler.FormatError, match=r"mine\.toml, line 1: base is missing"):
        PenGeometry.load("mine")
