"""What is written for LinuxCNC, judged by its own interpreter and by forward kinematics of the tests' own."""

import numpy as np
import pytest
import riffler
from riffler_bench.nc_judge import Axes, tilting_table
from riffler_bench.nc_judge import poses as forward

import linuxcnc

pytestmark = linuxcnc.needed

ROT_POINT, OFFSET = [12.0, -7.0, 30.0], [3.0, 4.0, -25.0]
PIVOT = 180.0
X, Y, Z = np.eye(3)
TABLE = {"rot_point": ROT_POINT, "offset": OFFSET}


def tilting(letter, offset=OFFSET):
    return tilting_table(letter, ROT_POINT, offset)


def tips(axes):
    return Axes(axes.tables, axes.heads, tip=True)


HEADS = Axes(heads=[("C", Z, [0, 0, PIVOT]), ("B", Y, [0, 0, PIVOT])])
HEAD_TABLE = Axes(tables=[("C", -Z, ROT_POINT)], heads=[("B", Y, [0, 0, PIVOT])])
# What is written, with which options, and the machine by which it is judged.
POSTS = {
    "linuxcnc-xyzac": ("linuxcnc-xyzac", TABLE, tilting("A")),
    "linuxcnc-xyzbc": ("linuxcnc-xyzbc", TABLE, tilting("B")),
    "linuxcnc-xyzac, kinematics on": ("linuxcnc-xyzac", TABLE | {"tcp": True}, tips(tilting("A"))),
    "head-head": ("head-head", {}, tips(HEADS)),
    "head-head, its axes": ("head-head", {"tcp": False, "pivot_length": PIVOT}, HEADS),
    "head-table": ("head-table", {"rot_point": ROT_POINT}, tips(HEAD_TABLE)),
    "head-table, its axes": (
        "head-table", {"tcp": False, "pivot_length": PIVOT, "rot_point": ROT_POINT}, HEAD_TABLE
    ),
    # LinuxCNC has no G43.4; the words are the same under G43.
    "tcp": ("tcp", {"tool_length": "G43"}, Axes(heads=[("C", Z, [0, 0, 0]), ("A", X, [0, 0, 0])], tip=True)),
    "tcp-bc": ("tcp-bc", {"tool_length": "G43"}, Axes(heads=[("C", Z, [0, 0, 0]), ("B", Y, [0, 0, 0])], tip=True)),
}  # fmt: skip
JOINTS = ["linuxcnc-xyzac", "linuxcnc-xyzbc", "head-head, its axes", "head-table, its axes"]
PRINTED = 2e-4  # rs274 prints 4 decimals


def normed(v):
    v = np.asarray(v, float)
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def path(name):
    t = np.linspace(0, 1, 40)[:, None]
    one = np.ones_like(t)
    tips, axes = {
        "smooth": (
            np.hstack([80 * t, 20 * np.sin(9 * t), -5 * t]),
            np.hstack([np.sin(7 * t), np.sin(5 * t) - 0.3, one]),
        ),
        "through the pole": (np.hstack([60 * t, 0 * t, 0 * t]), np.hstack([t - 0.5, 0.02 * (t - 0.5), one])),
        "near the pole": (np.hstack([60 * t, 5 * t, 0 * t]), np.hstack([t - 0.5, 1e-3 * one, one])),
        "wound up": (
            np.hstack([20 * np.cos(15 * t), 20 * np.sin(15 * t), -9 * t]),
            np.hstack([np.cos(15 * t), np.sin(15 * t), 2 * one]),
        ),
        "turning in place": (
            np.tile([[10.0, 20.0, -3.0]], (40, 1)),
            np.hstack([np.sin(4 * t), np.cos(3 * t) - 1, one]),
        ),
        "long and straight": (np.hstack([900 * t, -700 * t, 30 * t]), np.hstack([0.3 * one, 0.1 + 0.5 * t, one])),
    }[name]
    return np.hstack([tips, normed(axes)])


PATHS = ["smooth", "through the pole", "near the pole", "wound up", "turning in place", "long and straight"]


def written(tmp_path, poses, post, tolerance=0.01, **options):
    tool = riffler.Tool.ball(6, 30)
    # One pose a move: what has no length of its own still has the feed of its neighbours.
    program = riffler.Program.from_cl([poses], tools=[tool], feed=600, spindle=8000)
    file = tmp_path / "p.ngc"
    name, own, _ = POSTS[post]
    program.write(file, post=name, tolerance=tolerance, options={"safe_start": False} | own | options)
    return file


def off(a, b):
    """mm and rad between poses (…, 6)."""
    far = np.linalg.norm(a[..., :3] - b[..., :3], axis=-1)
    return far, 2 * np.arcsin(np.minimum(1, np.linalg.norm(a[..., 3:] - b[..., 3:], axis=-1) / 2))


def judged(file, axes, poses):
    """How far the program is off the poses at their blocks, and off the moves between them, mm and rad."""
    moves = linuxcnc.interpreted(file)
    joints = moves.joints[1:]
    at = forward(joints, axes)
    # Every pose is the end of a block, in their order.
    ends, start, worst = [], 0, np.zeros(2)
    for pose in poses:
        far, turned = off(at[start:], pose)
        k = start + int(np.argmax((far < 2e-3) & (turned < 4e-5)))
        worst = np.maximum(worst, [off(at[k], pose)[0], off(at[k], pose)[1]])
        ends.append(k)
        start = k + (len(ends) < len(poses) and not np.array_equal(pose, poses[len(ends)]))
    inner = np.zeros(2)
    for first, last, a, b in zip(ends, ends[1:], poses, poses[1:], strict=False):
        dense = forward(linuxcnc.between(joints[first : last + 1], 16).reshape(-1, 6), axes)
        way = b[:3] - a[:3]
        share = np.clip((dense[:, :3] - a[:3]) @ way / max(way @ way, 1e-300), 0, 1)[:, None]
        aside = np.linalg.norm(dense[:, :3] - a[:3] - share * way, axis=1).max(initial=0)
        plane = np.cross(a[3:], b[3:])
        length = np.linalg.norm(plane)
        lifted = np.arcsin(np.clip(abs(dense[:, 3:] @ plane) / length, 0, 1)).max(initial=0) if length > 1e-9 else 0
        inner = np.maximum(inner, [aside, lifted])
    return worst, inner, moves


@pytest.mark.parametrize("post", POSTS)
@pytest.mark.parametrize("name", PATHS)
def test_blocks_reach_the_poses_and_moves_between_them_keep_the_tolerances(tmp_path, post, name):
    poses = path(name)
    worst, inner, moves = judged(written(tmp_path, poses, post), POSTS[post][2], poses)
    reach = np.abs(moves.joints[:, :3]).max() + 50  # what a printed angle's last digit moves
    assert worst[0] <= 1e-3 + reach * 2e-6 and np.degrees(worst[1]) <= 1e-3
    assert inner[0] <= 0.01 + PRINTED + reach * 2e-6 and inner[1] <= 0.00175 + 1e-5


@pytest.mark.parametrize("feed", ["inverse-time", "per-minute"])
@pytest.mark.parametrize("post", JOINTS)
def test_every_block_takes_the_time_of_its_tips_path_or_of_its_turn(tmp_path, post, feed):
    poses = path("smooth")
    file = written(tmp_path, poses, post, max_rotary=2000.0, feed=feed)
    assert ("G93" in file.read_text()) == (feed == "inverse-time")
    moves = linuxcnc.interpreted(file)
    at = forward(moves.joints, POSTS[post][2])
    way = np.linalg.norm(np.diff(at[:, :3], axis=0), axis=1)
    turn = abs(np.diff(moves.joints[:, 3:], axis=0)).max(1)
    wanted = np.maximum(way / 600, turn / 2000)
    fed = ~moves.rapid[1:]
    assert fed.sum() > 40
    np.testing.assert_allclose(moves.minutes[1:][fed], wanted[fed], atol=5e-7, rtol=2e-3)


def test_mutated_code_does_not_pass(tmp_path):
    post, poses = "linuxcnc-xyzac", path("smooth")
    axes = POSTS[post][2]
    file = written(tmp_path, poses, post)
    text = file.read_text()

    def error(changed):
        file.write_text(changed)
        try:
            worst, inner, moves = judged(file, axes, poses)
        except linuxcnc.RefusedError:
            return np.inf
        at = forward(moves.joints, axes)
        minutes = np.linalg.norm(np.diff(at[:, :3], axis=0), axis=1) / 600
        fed = ~moves.rapid[1:]
        late = abs(moves.minutes[1:] - minutes)[fed].max()
        return max(worst.max(), inner[0], late)

    assert error(text) < 0.02
    assert error(text.replace(" C-", " C").replace(" C1", " C-1")) > 1, "the sign of C"
    assert error(text.replace(" A", " Q").replace(" C", " A").replace(" Q", " C")) > 1, "A and C exchanged"
    assert error(text.replace("G21", "G20")) > 1, "millimetres as inches"
    lines = text.splitlines()
    dropped = next(k for k, line in enumerate(lines) if "F" in line and "G" not in line and "(" not in line)
    lines[dropped] = lines[dropped].split(" F")[0]
    assert error("\n".join(lines)) > 1, "an F that is missing under G93"
    worst, _, _ = judged(written(tmp_path, poses, post), tilting("A", [0, 0, 0]), poses)
    assert worst[0] > 1, "another machine"


@pytest.mark.parametrize("post", ["linuxcnc-xyzac", "linuxcnc-xyzbc"])
def test_iso_directions_turn_the_other_way(tmp_path, post):
    poses = path("smooth")
    own = linuxcnc.interpreted(written(tmp_path, poses, post)).joints
    iso = linuxcnc.interpreted(written(tmp_path, poses, post, direction="iso")).joints
    assert len(own) == len(iso)
    np.testing.assert_allclose(own[:, :3], iso[:, :3], atol=PRINTED)
    turned = np.mod(own[:, 3:] + iso[:, 3:] + 180, 360) - 180
    np.testing.assert_allclose(turned, 0, atol=PRINTED)


def test_three_axis_programs_are_read_unchanged(tmp_path):
    t = np.linspace(0, 1, 50)
    poses = np.column_stack([50 * t, 9 * np.sin(6 * t), -t, 0 * t, 0 * t, 1 + 0 * t])
    file = tmp_path / "p.ngc"
    riffler.Program.from_cl([poses], tools=[riffler.Tool.flat(6, 30)], feed=600).write(file, post="3-axis")
    joints = linuxcnc.interpreted(file).joints
    for pose in poses:
        assert np.linalg.norm(joints[:, :3] - pose[:3], axis=1).min() <= PRINTED


def test_where_a_limit_is_met_the_tool_turns_back_above_the_part(tmp_path):
    poses = path("wound up")  # 15 rad round
    for post in JOINTS:
        file = written(tmp_path, poses, post, limits_c=[-200, 200])
        axes = POSTS[post][2]
        worst, _, moves = judged(file, axes, poses)
        assert worst[0] <= 2e-3 and np.degrees(worst[1]) <= 1e-3
        assert abs(moves.joints[:, 5]).max() <= 200
        ways = np.diff(moves.joints, axis=0)
        back = abs(ways[:, 5]) > 1e-9
        at = forward(moves.joints, axes)
        # Turns against the path's sense happen in rapids, as high as the program goes.
        against = back & (np.sign(ways[:, 5]) != np.sign(np.sum(ways[~moves.rapid[1:], 5])))
        assert against.any() and moves.rapid[1:][against].all(), post
        assert at[1:][against, 2].min() > poses[:, 2].max() + 9


def along(call, parts=12):
    """Joints (parts + 1, 6) on the path of a canonical move."""
    share = np.linspace(0, 1, parts + 1)[:, None]
    out = call.start + share * (call.end - call.start)
    if call.plane is not None:
        at = call.start[list(call.plane)] - call.centre
        angle = np.arctan2(at[1], at[0]) + share[:, 0] * call.sweep
        out[:, list(call.plane)] = call.centre + np.hypot(*at) * np.column_stack([np.cos(angle), np.sin(angle)])
    return out


@pytest.mark.parametrize("post", ["linuxcnc-xyzac", "tcp"])
def test_arcs_stay_within_the_tolerance_of_the_straight_runs(tmp_path, post):
    t = np.linspace(0, 9, 400)[:, None]
    tips = np.hstack([20 * np.cos(t), 20 * np.sin(t), -0.1 * t])
    poses = np.hstack([tips, np.tile(normed([0.1, 0.2, 1]), (400, 1))])
    file = written(tmp_path, poses, post, arcs=True)
    moves, _ = linuxcnc.calls(linuxcnc.output(file))
    cuts = [move for move in moves if not np.isnan(move.feed)]
    assert sum(move.plane is not None for move in cuts) >= 3 and len(cuts) < 100
    dense = np.vstack([forward(along(move), POSTS[post][2]) for move in cuts[1:]])
    assert abs(dense[:, 3:] - poses[0, 3:]).max() < 1e-5
    way = np.diff(tips, axis=0)

    def beside(point):
        share = np.clip(((point - tips[:-1]) * way).sum(1) / (way * way).sum(1), 0, 1)[:, None]
        return np.linalg.norm(point - tips[:-1] - share * way, axis=1).min()

    assert max(beside(point) for point in dense[:, :3]) <= 0.01 + 5e-4


@pytest.mark.parametrize("post", POSTS)
def test_the_first_blocks_retract_turn_go_across_and_come_down(tmp_path, post):
    """As the interpreter says it: no rotary axis turns, and nothing goes across, below where the retract has ended."""
    poses = path("smooth")
    tools = [riffler.Tool.ball(6, 30), riffler.Tool.ball(4, 30)]
    program = riffler.Program.from_cl(
        [poses, poses + np.array([5, 0, 0, 0, 0, 0])], tools=tools, feed=600, spindle=8000
    )
    name, own, axes = POSTS[post]
    file = tmp_path / "p.ngc"
    program.write(file, post=name, options=own)
    text = file.read_text()
    assert text.count("G53 G0 Z0\n") == 3 and text.rstrip().endswith("G53 G0 Z0\nM30")
    moves = linuxcnc.interpreted(file)
    at, first, starts = forward(moves.joints, axes), moves.joints[1], []
    assert first[2] == 0 and not first[3:].any(), "Z alone"
    for pose in (program.poses[0], program.poses[len(poses) + 2]):
        far, turned = off(at, pose)
        starts.append(int(np.flatnonzero((far < 2e-3) & (turned < 4e-5) & (moves.joints[:, 2] != 0))[0]))
    for k in starts:
        retract, turn, across, down = np.diff(moves.joints[k - 4 : k + 1], axis=0)
        assert not retract[[0, 1, 3, 4, 5]].any() and not turn[:3].any()
        assert not across[2:].any() and not down[[0, 1, 3, 4, 5]].any()
        assert moves.joints[k - 3 : k, 2].tolist() == [0, 0, 0] and moves.rapid[k - 3 : k + 1].all()
