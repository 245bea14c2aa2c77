"""riffler pen identify with simulated pens, whose true motors, friction and weights are drawn at random."""

from __future__ import annotations

import itertools
import time
import tomllib
from contextlib import contextmanager

import numpy as np
import pytest
import riffler
from commands import in_shell, result, riffle
from riffler.command import pen_fit, pen_identify, pen_sweeps
from riffler.command.pen_fit import (
    JOINTS,
    NAMES,
    WIDTH,
    HungWeight,
    Identified,
    IdentifyError,
    Sweep,
    equations_of,
    filtered,
    identify,
    low_pass,
    square_to,
)
from riffler.command.pen_identify import (
    BARS,
    Motion,
    begin,
    covered,
    identified,
    real,
    rewritten,
    swept,
    truth_of,
)
from riffler.command.pen_sweeps import (
    ELBOW,
    FAST,
    SLOW,
    Keyboard,
    MotionStoppedError,
    MotionTrippedError,
    Record,
    base_axes,
    cut,
    drive,
    home_of,
    reaches,
    reversed_motors,
    sweeps,
    told,
    wiggles,
)

WEIGHT = HungWeight(0.04, 0.03e-3, 15.0, 0.1)


@pytest.fixture(scope="module")
def geometry():
    return riffler.pen.PenGeometry.load("riffler")


@pytest.fixture(scope="module")
def found(geometry):
    """Two random pens: what was identified, and the truth. A third one is the command's."""
    out = []
    for seed in (1, 2):
        with riffler.pen.open("simulated", seed=seed, real_time=False) as device:
            out.append((identified(device, WEIGHT, Keyboard(False), seed, None), device.truth))
    return out


class Results:
    """A console that keeps what a command hands back."""

    @contextmanager
    def step(self, _):
        yield None

    def result(self, data, title, rows):
        self.data = data


def made_up() -> Identified:
    values = {name: np.arange(1.0, 7.0) for name in NAMES}
    values["torque_constant"] = np.arange(26.0, 32.0)
    values["gravity"] = np.array([1.0, 2.0, 0.0, 4.0, 5.0, 0.0])
    return Identified(values, {name: 0.01 * v for name, v in values.items()}, 100, 0.01)


# ---- the fit


def test_low_pass_and_its_derivatives_are_exact_for_parabolas():
    t = np.arange(200) * 1e-3
    value, slope, curve = low_pass(1e-3, WIDTH)
    half = len(value) // 2
    x = 3 + 5 * t - 40 * t**2
    np.testing.assert_allclose(filtered(x, slope), (5 - 80 * t)[half:-half], atol=1e-9)
    np.testing.assert_allclose(filtered(x, curve), -80, atol=1e-6)
    np.testing.assert_allclose(filtered(x, value) - x[half:-half], -40 * WIDTH**2, rtol=0.05)


def test_the_tension_of_the_grip_is_projected_away():
    vectors = np.random.default_rng(1).normal(size=(50, 6))
    vectors[0] = [-1, 0, 0, 0, 0, 0]
    basis = square_to(vectors)
    np.testing.assert_allclose(np.einsum("nkj,nk->nj", basis, vectors), 0, atol=1e-12)
    squares = np.einsum("nki,nkj->nij", basis, basis)
    np.testing.assert_allclose(squares, np.broadcast_to(np.eye(5), (50, 5, 5)), atol=1e-12)


def made_sweep(geometry, seed, tension):
    """A smooth motion of all joints without inertia, with the currents that friction, weights and a tension of the grip
    (N) ask for; and the unknowns that the fit should find."""
    random = np.random.default_rng(seed)
    t = np.arange(800) * 1e-3
    signs, phase = np.sign(random.normal(size=6)), random.uniform(0.0, 0.3, 6)
    pace = random.uniform(1.2, 2.0, 6)
    joints = geometry.joints([geometry.home]) + signs * 0.2 * (1 - np.cos(pace * (t[:, None] + phase)))
    rates = signs * 0.2 * pace * np.sin(pace * (t[:, None] + phase))
    exact = np.empty_like(joints)
    for k, c in enumerate(geometry.channels):
        joint = JOINTS.index(c.name)
        a = geometry.joints(np.array([geometry.home, geometry.home + 1000 * np.eye(6, dtype=int)[k]]))[:, joint]
        exact[:, k] = geometry.home[k] + (joints[:, joint] - a[0]) * 1000 / (a[1] - a[0])
    counts = np.rint(exact).astype(np.int32)
    ends = geometry.ends(counts)
    along = ends[:, 1] - ends[:, 0]
    along /= np.linalg.norm(along, axis=1)[:, None]
    arms = np.moveaxis(geometry.jacobian(counts), 1, 2)
    apart = np.concatenate([-arms[:, :, 0], arms[:, :, 1]], axis=2)
    pull = tension(t)[:, None] * np.einsum("nxk,nx->nk", apart, along)
    currents, unknowns = np.empty_like(exact), np.zeros(30)
    weighted = [k for k, c in enumerate(geometry.channels) if c.name[1] != "1"]
    for k, c in enumerate(geometry.channels):
        joint = JOINTS.index(c.name)
        angle = joints[:, joint]
        weight = {"1": 0 * angle, "2": np.sin(angle), "3": np.cos(angle)}[c.name[1]]
        torque = c.coulomb * np.sign(rates[:, joint]) + c.viscous * c.ratio * rates[:, joint]
        torque += (c.gravity * weight + pull[:, joint]) / c.ratio
        currents[:, k] = c.sign * torque / c.torque_constant
        unknowns[[k, 6 + k, 12 + k]] = c.torque_constant, c.coulomb, c.viscous
        if k in weighted:
            unknowns[18 + weighted.index(k)] = c.gravity
    return Sweep(counts, currents, 1e-3, "fast"), unknowns


@pytest.mark.parametrize("seed", range(4))
def test_a_tension_that_changes_does_not_look_like_friction(geometry, seed, monkeypatch):
    sweep, unknowns = made_sweep(geometry, seed, lambda t: 1 + 0.3 * np.sin(3 * t))

    def off():
        """Relative error of the viscous friction, by what the equations leave with the true unknowns."""
        rows = equations_of(geometry, sweep, 0.0, 15.0, 15.0, lead=0.0).rows
        matrix, side = rows.matrix, rows.side
        assert len(side) >= 50
        friction, *_ = np.linalg.lstsq(matrix[:, 12:18], side - matrix @ unknowns, rcond=None)
        return np.abs(friction / unknowns[12:18]).max()

    narrow = off()  # of a tension and a motion faster than those of a sweep
    monkeypatch.setattr(pen_fit, "NARROW", 0.99 * WIDTH)  # the products behind the whole filter
    assert off() > 10 * narrow


def test_values_of_random_pens_are_within_the_bars(found):
    for values, truth in found:
        for name in NAMES:
            mine = real(truth, name)
            off = values.values[name][mine] / truth_of(truth, name)[mine] - 1
            assert np.abs(off).max() < BARS[name], f"{name}: {off}"


def test_intervals_hold_the_truth(found):
    inside = np.concatenate([ok for values, truth in found for ok in covered(values, truth).values()])
    assert len(inside) == 2 * 22
    assert inside.mean() > 0.88  # 95 %, and what chance allows for in 44 values


def test_intervals_are_no_wider_than_necessary(found):
    """An interval that holds everything says nothing."""
    for values, truth in found:
        for name in NAMES:
            mine = real(truth, name)
            assert (1.96 * values.uncertainty[name][mine] / truth_of(truth, name)[mine]).max() < 2 * BARS[name]


def test_sweeps_without_a_weight_determine_nothing(geometry):
    with pytest.raises(IdentifyError, match="sweeps have all joints in motion"):
        identify(geometry, [], [], WEIGHT)


# ---- motions


@pytest.mark.parametrize("rate", [0.35, 2.0])
def test_sweeps_stay_where_the_arms_reach_and_keep_their_speed(geometry, rate):
    path = sweeps(geometry, 12, rate, 1)
    np.testing.assert_allclose(path.poses[0], home_of(geometry))
    np.testing.assert_allclose(path.poses[-1], home_of(geometry))
    joints, _ = geometry.inverse(path.poses)
    for k in range(path.first, len(path.times) - 1):
        assert reaches(geometry, path.poses[k], path.poses[k + 1])
        assert np.abs(joints[k + 1, [1, 4]] - joints[k + 1, [2, 5]]).max() < ELBOW, "an arm is nearly straight"
        time = path.times[k + 1] - path.times[k]
        assert 1.875 * np.abs(joints[k + 1] - joints[k]).max() / time < rate * 1.001
        assert 1.875 * np.linalg.norm(path.poses[k + 1, :3] - path.poses[k, :3]) / time < 300.1


def test_the_most_informative_sweeps_are_chosen(geometry, monkeypatch):
    def mean():
        poses = sweeps(geometry, 40, FAST, 1).poses[1:-1]
        return np.mean([told(geometry, a, b, FAST) for a, b in itertools.pairwise(poses)])

    chosen = mean()
    monkeypatch.setattr(pen_sweeps, "CANDIDATES", 1)
    assert chosen > 2 * mean()


def test_a_sweep_with_a_resting_joint_is_not_informative(geometry):
    home = home_of(geometry)
    lifted = home + np.array([0, 0, 20.0, 0, 0, 0])
    assert told(geometry, home, lifted, FAST) == 0, "joints 1 rest"
    one, other = sweeps(geometry, 3, FAST, 1).poses[2:4]
    assert told(geometry, one, other, FAST) > 0
    assert told(geometry, one, other, 0.05) == 0, "slower than the fit takes"


def test_a_pen_that_sticks_does_not_end_the_others(monkeypatch):
    def sticks_once(device, weight, keyboard, seed, console):
        if seed == 5:
            raise MotionStoppedError("a joint sticks.")
        return Identified(
            {name: truth_of(device.truth, name) for name in NAMES}, {name: np.ones(6) for name in NAMES}, 10, 0.1
        )

    monkeypatch.setattr(pen_identify, "identified", sticks_once)
    console = Results()
    assert pen_identify.many(4, 3, 0.1, console) == 1
    assert console.data["stopped"] == {"5": "a joint sticks."}
    assert sum(console.data["of"].values()) == 44 and console.data["share"] == 1


def test_axes_of_the_arms_are_those_of_the_shipped_pens_poses(geometry):
    np.testing.assert_allclose(base_axes(geometry), np.eye(3), atol=1e-6)


def test_a_reversed_motor_is_found(geometry):
    with riffler.pen.open("simulated", seed=5, real_time=False) as device:
        begin(device, Keyboard(False))
        pushed = drive(device, wiggles(geometry), Keyboard(False), leads=False)
    counts, currents = pushed.counts, pushed.currents
    assert reversed_motors(geometry, counts, currents) == []
    for k, channel in enumerate(geometry.channels):
        other = currents.copy()
        other[:, k] *= -1
        assert reversed_motors(geometry, counts, other) == [channel.name]
    with pytest.raises(MotionStoppedError, match="did not move"):
        reversed_motors(geometry, np.repeat(counts[:1], 100, axis=0), currents[:100])


def test_enter_stops_the_motion(geometry):
    keyboard = Keyboard(False)
    with riffler.pen.open("simulated", real_time=False) as device:
        begin(device, keyboard)
        with pytest.raises(MotionStoppedError, match="Enter"):
            drive(device, sweeps(geometry, 2, 0.35, 1), keyboard, shown=lambda at: at > 1 and keyboard.lines.put(""))
        end = time.monotonic() + 5
        while np.linalg.norm(device.health().force) > 0 and time.monotonic() < end:
            time.sleep(0.01)
        assert np.linalg.norm(device.health().force) == 0


def test_a_motion_that_stops_itself_is_made_on_another_path(geometry, monkeypatch):
    motion = Motion(geometry, 3, SLOW, (1, 2, 3))
    made = []

    def sticks_twice(device, path, *rest):
        made.append(path)
        if len(made) < 3:
            raise MotionTrippedError("The grip moved faster than is safe.")
        return ["sweeps"]

    monkeypatch.setattr(pen_identify, "swept_once", sticks_twice)
    assert swept(None, motion, "slow", Keyboard(False), None, None) == ["sweeps"]
    assert len({path.times[-1] for path in made}) == 3, "three paths"
    made.clear()
    motion.seeds = (1, 2)
    with pytest.raises(MotionStoppedError, match="on 2 paths: does a joint stick"):
        swept(None, motion, "slow", Keyboard(False), None, None)


def test_enter_is_no_reason_for_another_path(geometry, monkeypatch):
    def stopped(*_):
        raise MotionStoppedError("stopped by Enter")

    monkeypatch.setattr(pen_identify, "swept_once", stopped)
    with pytest.raises(MotionStoppedError, match=r"^stopped by Enter$"):
        swept(None, Motion(geometry, 3, SLOW, (1, 2)), "slow", Keyboard(False), None, None)


def test_sweeps_with_lost_reports_are_left_out(geometry):
    path = sweeps(geometry, 2, 0.35, 1)
    times = np.arange(0, path.seconds, 1e-3)
    sequence = np.arange(len(times))
    counts, currents = np.zeros((len(times), 6), np.int32), np.zeros((len(times), 6))
    assert len(cut(path, Record(sequence, times, counts, currents), "slow")) == 3
    assert len(cut(path, Record(sequence, times, counts, currents, path.times[1] + 0.1), "slow")) == 2, "held"
    sequence[times > path.times[1] + 0.5] += 1
    assert len(cut(path, Record(sequence, times, counts, currents), "slow")) == 2


# ---- the command and its file


def test_the_file_has_the_values_and_their_uncertainties(geometry, tmp_path):
    text = riffler._core._pen_text("riffler")
    new = rewritten(text, made_up())
    data, before = tomllib.loads(new), tomllib.loads(text)
    for name in NAMES:
        assert data["channels"][name] == pytest.approx(made_up().values[name])
        assert data["uncertainty"][name] == pytest.approx(made_up().uncertainty[name])
        before["channels"].pop(name), data["channels"].pop(name)
    data.pop("uncertainty")
    per_ampere = np.array(data["converter"].pop("slope")) * made_up().values["torque_constant"]
    np.testing.assert_allclose(per_ampere, np.array(before["converter"].pop("slope")) * 30.0, rtol=1e-4)
    assert data == before, "nothing else changes"
    assert rewritten(new, made_up()) == new, "a second identification takes the place of the first"
    (tmp_path / "mine.toml").write_text(new, encoding="utf-8")
    loaded = riffler.pen.PenGeometry.load(str(tmp_path / "mine.toml"))
    assert loaded.channels[3].torque_constant == 29


def test_the_command_writes_a_pen(tmp_path):
    for seed in ("4", "5"):  # the hand's timing differs from run to run, and chance leaves 5 outside in one of 250
        out = tmp_path / f"{seed}.toml"
        data = result("pen", "identify", "simulated", "--yes", "--seed", seed, "--out", out, cwd=tmp_path, run=in_shell)
        if data["inside"] >= 18:
            break
    assert data["of"] == 22 and data["inside"] >= 18
    pen = riffler.pen.PenGeometry.load(str(out))
    written = [c.torque_constant for c in pen.channels]
    assert written == pytest.approx(data["identified"]["torque_constant"]["value"], rel=1e-4)
    again = riffle("pen", "identify", "simulated", "--yes", "--out", out, cwd=tmp_path)
    assert again.returncode == 2 and "already exists" in again.stderr


@pytest.mark.parametrize(
    ("words", "problem"),
    [
        (["spacemouse", "--yes"], "moves by itself only after"),
        (["spacemouse", "--seed", "1"], "the true values of other pens are not known"),
        (["simulated"], "asks questions"),
        (["simulated", "--yes", "--mass", "900"], "too heavy"),
        (["simulated", "--yes", "--mass", "3", "--scale", "0.01"], "friction hides the weight"),
        (["simulated", "--yes", "--mass", "-3"], "must be positive"),
        (["simulated", "--yes", "--scale", "1"], "use a finer scale"),
        (["simulated", "--yes", "--pens", "2", "--out", "x.toml"], "--out is for one pen"),
    ],
)
def test_impossible_requests_are_refused(words, problem, tmp_path):
    done = riffle("pen", "identify", *words, cwd=tmp_path)
    assert done.returncode == 2 and problem in done.stderr
