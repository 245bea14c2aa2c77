"""Random machines from files and random programs on them: what is written is read by a parser of the tests' own, and
forward kinematics of their own say where the tool is, at the ends of blocks and between them."""

import numpy as np
import pytest
import riffler
from riffler_bench.nc_judge import Axes, joints_of
from riffler_bench.nc_judge import poses as forward

X, Y, Z = np.eye(3)
TOOLS = {1: riffler.Tool.ball(6, 30), 2: riffler.Tool.flat(10, 60)}
LIMITS_C = [None, (-360, 360), (-180, 180), (0, 360), (65.000000123, 603.58), (-3600, 3600)]
LIMITS_TILT = [None, (-10.12345678, 120.87654321), (-110, 110)]


def unit(v):
    return np.asarray(v, float) / np.linalg.norm(v, axis=-1, keepdims=True)


def machine(random):
    """TOML, kinematics, limits by letter, the largest tilt of the tool that it holds everywhere, rad."""
    letter, across = [("A", X), ("B", Y)][random.integers(2)]
    pivot, here = [0, 0, random.uniform(50, 300)], random.uniform(-200, 200, 3)
    sign = random.choice([-1, 1], 2)
    oblique = np.radians(random.uniform(30, 60))
    tilting, most = sign[0] * across, 1.9
    if random.random() < 0.4:
        tilting, most = np.sin(oblique) * tilting + np.cos(oblique) * Z, 1.95 * oblique
    tables = random.integers(3)
    axes = [("C", sign[1] * Z, here if tables else pivot), (letter, tilting, here + 20 if tables == 2 else pivot)]
    limits = {"C": LIMITS_C[random.integers(6)], letter: LIMITS_TILT[random.integers(3)]}
    joints = bool(random.integers(2))
    text = f'description = "m"\nwords = "{"joints" if joints else "tip"}"\n'
    for name, (low, high) in ((name, pair) for name, pair in limits.items() if pair):
        text += f"[axis.{name}]\nlimits = [{low!r}, {high!r}]\n"
    for k, (name, direction, point) in enumerate(axes):
        numbers = [[float(v) for v in vector] for vector in (direction, point)]
        text += f'[[rotary]]\nletter = "{name}"\ncarries = "{"part" if k < tables else "tool"}"\n'
        text += f"axis = {numbers[0]}\nat = {numbers[1]}\n"
    return text, Axes(axes[:tables], axes[tables:], tip=not joints), limits, min(most, 1.9)


def program(random, most):
    n = int(random.integers(3, 20))
    tilt, around = random.uniform(0, 0.9) * most, random.uniform(0, 7)
    kind = random.integers(4)
    if kind == 0:  # a wandering axis
        tilts = np.clip(tilt + np.cumsum(random.normal(size=n) * 0.15), 0, most)
        arounds = around + np.cumsum(random.normal(size=n) * 0.4)
    elif kind == 1:  # round and round
        tilts, arounds = np.full(n, tilt), around + random.uniform(-1.5, 1.5) * np.arange(n)
    else:  # through the pole, past it by up to 6°, or from one side to the other in one move
        way = np.linspace(-1, 1, n) if kind == 2 else random.choice([-1, 1], n) * random.uniform(0.1, 1, n)
        way, aside = way * np.tan(min(most, 1.2)), random.choice([0, 10 ** random.uniform(-9, -1)])
        tilts = np.arctan(np.hypot(way, aside))
        arounds = around + np.arctan2(aside, way)
    axes = np.column_stack([np.sin(tilts) * np.cos(arounds), np.sin(tilts) * np.sin(arounds), np.cos(tilts)])
    tips = np.cumsum(random.normal(size=(n, 3)), 0) * 10 ** random.uniform(-1, 1)
    tips[:, 2] = -abs(tips[:, 2])
    if random.random() < 0.3:
        tips[:] = tips[0]
    still = random.random(n) < 0.1
    still[0] = False
    tips[still] = tips[np.maximum(np.flatnonzero(still) - 1, 0)]
    rapid = random.random(n) < (0.2 if random.random() < 0.5 else 0)
    tips[rapid & (random.random(n) < 0.5), 2] = 40
    tool = np.where(np.arange(n) < (n // 2 if random.random() < 0.3 else n), 1, 2)
    return np.hstack([tips, unit(axes)]), rapid, tool


def aside(dense, a, b):
    """How far poses (k, 6) are off the line and off the great arc from a to b, mm and rad."""
    way, share = b[:3] - a[:3], 0.0
    if way @ way > 0:
        share = np.clip((dense[:, :3] - a[:3]) @ way / (way @ way), 0, 1)[:, None]
    tip = np.linalg.norm(dense[:, :3] - a[:3] - share * way, axis=1)
    side = b[3:] - (b[3:] @ a[3:]) * a[3:]
    side = side / max(np.linalg.norm(side), 1e-300)
    turn = np.clip(np.arctan2(dense[:, 3:] @ side, dense[:, 3:] @ a[3:]), 0, np.arccos(np.clip(a[3:] @ b[3:], -1, 1)))
    near = np.outer(np.cos(turn), a[3:]) + np.outer(np.sin(turn), side)
    return tip, np.linalg.norm(dense[:, 3:] - near, axis=1)


def check(text, axes, limits, poses, rapid, tool, report, tolerance, axis_tolerance):
    joints = joints_of(text)
    for letter, pair in limits.items():
        values = joints[:, "XYZABC".index(letter)]
        assert not pair or (values.min() >= pair[0] and values.max() <= pair[1]), f"{letter} beyond its limits"
    # A free axis within 1e-6 rad of the pole, and printed digits.
    off, turned = 4e-5, 1.2e-6
    at, ends = forward(joints, axes), []
    for row, pose in enumerate(poses):
        first = ends[-1] + 1 if ends else 0
        near = np.linalg.norm(at[first:, :3] - pose[:3], axis=1) <= off
        near &= np.linalg.norm(at[first:, 3:] - pose[3:], axis=1) <= turned
        assert near.any(), f"no block ends at row {row}"
        ends.append(first + int(np.argmax(near)))
    highest = poses[~rapid, 2].max(initial=-np.inf)
    share = np.linspace(0, 1, 21)[:, None]
    for row in range(1, len(poses)):
        a, b = poses[row - 1], poses[row]
        if tool[row] != tool[row - 1]:
            assert ends[row] == ends[row - 1] + 1
            continue
        free = rapid[row] and min(a[2], b[2]) > highest
        left = row in report.rewinds or row - 1 in report.rewinds
        for k in range(ends[row - 1], ends[row]):
            dense = forward(joints[k] + share * (joints[k + 1] - joints[k]), axes)
            tip, axis = aside(dense, a, b)
            if tip.max() <= tolerance + off and (free or axis.max() <= axis_tolerance + turned):
                continue
            assert left, f"row {row}: {tip.max()} mm, {axis.max()} rad between blocks"
            held = np.linalg.norm(dense[:, :3] - dense[0, :3], axis=1).max() <= tolerance + off
            rests = abs(joints[k + 1, 3:] - joints[k, 3:]).max() < 1e-5
            assert rests or (held and dense[:, 2].min() >= poses[:, 2].max() - off), f"row {row}: turns in the material"


@pytest.mark.parametrize("seed", range(120))
def test_random_programs_are_held_everywhere_or_refused_by_row(tmp_path, seed):
    random = np.random.default_rng(seed)
    text, axes, limits, most = machine(random)
    file = tmp_path / "m.toml"
    file.write_text(text)
    poses, rapid, tool = program(random, most)
    tolerance, axis_tolerance = 10 ** random.uniform(-3, -0.5), 10 ** random.uniform(-3.5, -2.5)
    made = riffler.Program(poses, feed=np.where(rapid, 0, 600), rapid=rapid, tool=tool, spindle=8000, tools=TOOLS)
    options = {"tolerance": tolerance, "axis_tolerance": axis_tolerance}
    try:
        report = made.write(tmp_path / "p.ngc", post=str(file), **options)
    except ValueError as error:
        assert str(error).startswith("poses, row "), error
        assert "limits" in str(error) or "cannot reach" in str(error), error
        return
    written = (tmp_path / "p.ngc").read_text()
    check(written, axes, limits, poses, rapid, tool, report, **options)
    made.write(tmp_path / "q.ngc", post=str(file), **options)
    assert (tmp_path / "q.ngc").read_text() == written
