"""Programs and NC code from Python, judged by a parser and kinematics of the test's own."""

import re

import numpy as np
import pytest
import riffler
from hypothesis import given, settings
from hypothesis import strategies as st

FIXED = settings(derandomize=True, deadline=None, max_examples=60, database=None)
WORD = re.compile(r"([A-Z])([-+]?[0-9.]+)")


def rotation(axis, degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    if axis == "x":
        return np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def blocks(text):
    """(k, 6) poses at the block ends, (k,) feed, (k,) rapid: absolute millimetres, G0 and G1 only."""
    now, feed, rapid, out = dict.fromkeys("XYZAC", 0.0), 0.0, True, []
    for line in text.splitlines():
        words = WORD.findall(re.sub(r"\(.*?\)", "", line))
        moved = False
        for letter, number in words:
            if letter == "G" and number in "01":
                rapid = number == "0"
            elif letter in now:
                now[letter], moved = float(number), True
            elif letter == "F":
                feed = float(number)
        if moved:
            axis = rotation("z", now["C"]) @ rotation("x", now["A"]) @ [0, 0, 1]
            out.append(([now["X"], now["Y"], now["Z"], *axis], 0 if rapid else feed, rapid, now["C"]))
    return tuple(np.array(column) for column in zip(*out, strict=True))


def spiral(n, tilt=0.5, turns=1.0):
    t = np.linspace(0, 1, n)
    a, z = tilt * np.sin(3 * t), 2 * np.pi * turns * t
    return np.column_stack(
        [80 * t, 20 * np.sin(9 * t), -5 * t, np.sin(a) * np.cos(z), np.sin(a) * np.sin(z), np.cos(a)]
    )


def rows_of(program, wanted):
    """Index of the row that ends at each wanted pose, in order."""
    at, out = 0, []
    for pose in wanted:
        while np.abs(program[at] - pose).max() > 1.5e-5:
            at += 1
        out.append(at)
        at += 1
    return out


AS_ROWS = {"safe_start": False}  # without the blocks that bring a tool to its first row


@pytest.fixture
def ball():
    return riffler.Tool.ball(6, 30)


def test_from_cl_makes_one_cut_of_each_array(ball):
    cl = spiral(20)
    p = riffler.Program.from_cl([cl, cl[:1]], tools=[ball], feed=700, spindle=12000, occupied=((0, 0, -9), (80, 20, 3)))
    assert len(p) == 22 + 3
    np.testing.assert_allclose(p.poses[1:21], cl, rtol=0, atol=1e-15)
    assert p.rapid.dtype == bool and np.flatnonzero(p.rapid).tolist() == [0, 21, 22, 24]
    assert (p.feed == np.where(p.rapid, 0, 700)).all()
    assert (p.spindle == 12000).all() and (p.tool == 1).all() and (p.line == 0).all()
    for rapid, end in ((0, 0), (21, 19), (22, 0), (24, 0)):
        off = p.poses[rapid, :3] - cl[end, :3]
        np.testing.assert_allclose(np.cross(off, cl[end, 3:]), 0, atol=1e-12)
        assert p.poses[rapid, 2] >= 3 + 10 - 1e-12
    assert p.tools == {1: ball}


def test_from_cl_numbers_its_tools(ball):
    flat = riffler.Tool.flat(4, 20)
    p = riffler.Program.from_cl(
        [spiral(3)] * 3, tools=[ball, flat, riffler.Tool.ball(6, 30)], feed=[1, 2, 3], spindle=[5, 6, 7]
    )
    assert p.tools == {1: ball, 2: flat}
    assert [(number, poses.shape) for number, poses in p.cuts()] == [(1, (5, 6)), (2, (5, 6)), (1, (5, 6))]
    assert p.feed.reshape(3, 5)[:, 2].tolist() == [1, 2, 3]
    assert p.spindle.reshape(3, 5)[:, 2].tolist() == [5, 6, 7]
    varying = riffler.Program.from_cl([spiral(3)], tools=None, feed=np.array([4, 5, 6]))
    assert varying.feed.tolist() == [0, 4, 5, 6, 0] and varying.tools == {}
    assert len(riffler.Program.from_cl([], tools=[ball], feed=1)) == 0


def test_columns_are_read_only_views(ball):
    p = riffler.Program.from_cl([spiral(3)], tools=[ball], feed=1)
    for column in (p.poses, p.feed, p.rapid, p.tool, p.line, p.spindle):
        with pytest.raises(ValueError, match="read-only"):
            column[0] = 0
    poses = p.poses
    del p
    assert np.isfinite(poses).all()


def test_the_constructor_takes_columns_or_one_value():
    cl = spiral(4)
    p = riffler.Program(
        cl, 100, rapid=[True, False, False, True], tool=[1, 1, 2, 2], line=5, spindle=-300, provenance={"a": "b"}
    )
    assert p.feed.tolist() == [0, 100, 100, 0] and p.tool.tolist() == [1, 1, 2, 2]
    assert p.line.tolist() == [5] * 4 and p.spindle.tolist() == [-300] * 4 and p.provenance == {"a": "b"}
    assert repr(p) == "<riffler.Program: 4 rows, 2 tool runs>"


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"poses": np.zeros((3, 5))}, r"poses must have the shape \(n, 6\)"),
        ({"poses": "abc"}, "poses"),
        ({"poses": spiral(3) * [[1, 1, 1, 1, 1, 1], [1, 1, 1, 2, 2, 2], [1, 1, 1, 1, 1, 1]]}, "poses, row 1"),
        ({"poses": np.where(np.arange(18).reshape(3, 6) == 13, np.nan, spiral(3))}, "poses, row 2"),
        ({"feed": [1, 2]}, "feed must be one number or"),
        ({"feed": [1, -2, 3]}, "feed, row 1"),
        ({"feed": [1, 2, 0]}, "feed, row 2"),
        ({"tool": 1.5}, "tool, row 0"),
        ({"tool": [1, 1, -1]}, "tool, row 2"),
        ({"spindle": np.inf}, "spindle, row 0"),
        ({"tools": {1: "ball"}}, "tools"),
    ],
)
def test_the_constructor_names_bad_input(change, message):
    with pytest.raises((ValueError, TypeError), match=message):
        riffler.Program(**({"poses": spiral(3), "feed": 100} | change))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"cl": [spiral(3), np.zeros((0, 6))]}, "path 1 has no rows"),
        ({"cl": [spiral(3), np.zeros((2, 6))]}, "path 1, row 0: the axis"),
        ({"cl": [np.zeros((2, 3))]}, r"cl\[0\] must have the shape"),
        ({"cl": ["abc"]}, r"cl\[0\] must be numbers"),
        ({"tools": [1]}, "tools must be a list of Tool"),
        ({"tools": [riffler.Tool.ball(6, 30)] * 2}, "one for all arrays or one for each"),
        ({"feed": 0}, "feed must be positive"),
        ({"feed": [1, 2]}, "feed must be one for all arrays or one for each"),
        ({"safe_height": -10}, "safe_height"),
        ({"clearance": 0}, "clearance"),
    ],
)
def test_from_cl_names_bad_input(change, message):
    arguments = {"cl": [spiral(3)], "tools": [riffler.Tool.ball(6, 30)], "feed": 100} | change
    with pytest.raises(ValueError, match=message):
        riffler.Program.from_cl(arguments.pop("cl"), **arguments)


def great_circle(a, b, t):
    angle = 2 * np.arcsin(np.clip(np.linalg.norm(a - b) / 2, 0, 1))
    if angle < 1e-12:
        return np.broadcast_to(a, (len(t), 3))
    return (np.sin((1 - t) * angle)[:, None] * a + np.sin(t * angle)[:, None] * b) / np.sin(angle)


axes = st.tuples(st.floats(0, 2.8), st.floats(-np.pi, np.pi)).map(
    lambda a: (np.sin(a[0]) * np.cos(a[1]), np.sin(a[0]) * np.sin(a[1]), np.cos(a[0]))
)
tips = st.tuples(*[st.floats(-50, 50)] * 3)
path = st.lists(st.tuples(tips, axes), min_size=2, max_size=8).map(lambda rows: np.array([[*t, *o] for t, o in rows]))


@FIXED
@given(cl=path, axis_tolerance=st.sampled_from([0.00175, 2e-4]))
def test_tcp_blocks_keep_the_poses_and_the_moves_between_them(tmp_path_factory, cl, axis_tolerance):
    if any(np.linalg.norm(a + b) < 1e-3 for a, b in zip(cl[:-1, 3:], cl[1:, 3:], strict=True)):
        return
    cl = cl[np.r_[True, np.linalg.norm(np.diff(cl[:, :3], axis=0), axis=1) > 1e-2]]
    p = riffler.Program.from_cl([cl], tools=[riffler.Tool.ball(6, 30)], feed=100)
    file = tmp_path_factory.mktemp("nc") / "p.ngc"
    p.write(file, post="tcp", axis_tolerance=axis_tolerance, options=AS_ROWS)
    ends, _, rapid, c = blocks(file.read_text())
    assert np.abs(np.diff(c)).max() <= 180 + 1e-6
    rows = rows_of(ends, p.poses)
    assert rows[-1] == len(ends) - 1
    now = dict.fromkeys("XYZAC", 0.0)
    words = []
    for line in file.read_text().splitlines():
        found = WORD.findall(line) if not line.startswith("(") else []
        now.update({letter: float(number) for letter, number in found if letter in now})
        if any(letter in now for letter, _ in found):
            words.append([now[letter] for letter in "XYZAC"])
    words = np.array(words)
    for k in range(1, len(p)):
        if p.rapid[k]:
            continue
        a, b = p.poses[k - 1], p.poses[k]
        for block in range(rows[k - 1] + 1, rows[k] + 1):
            assert not rapid[block]
            between = words[block - 1] + np.linspace(0, 1, 21)[:, None] * (words[block] - words[block - 1])
            way = b[:3] - a[:3]
            t = (between[:, :3] - a[:3]) @ way / (way @ way)
            assert np.linalg.norm(between[:, :3] - a[:3] - t[:, None] * way, axis=1).max() < 2e-5
            is_axis = np.array([rotation("z", w[4]) @ rotation("x", w[3]) @ [0, 0, 1] for w in between])
            # 1e-5 mm of printed length on a move of 1e-2 mm is 1e-3 of the move.
            slack = 2e-5 / np.linalg.norm(way) * np.pi + 1e-6
            error = np.linalg.norm(is_axis - great_circle(a[3:], b[3:], np.clip(t, 0, 1)), axis=1).max()
            assert error < axis_tolerance + slack


@pytest.mark.parametrize(
    ("post", "options"),
    [
        ("tcp", {}),
        ("heidenhain", {}),
        ("heidenhain-bc", {}),
        ("heidenhain", {"vectors": True}),
        ("sinumerik", {}),
        ("sinumerik-bc", {}),
    ],
)
@FIXED
@given(cl=path)
def test_read_gives_back_what_was_written(tmp_path_factory, post, options, cl):
    if any(np.linalg.norm(a + b) < 1e-3 for a, b in zip(cl[:-1, 3:], cl[1:, 3:], strict=True)):
        return
    p = riffler.Program.from_cl(
        [cl, cl[::-1]], tools=[riffler.Tool.ball(6, 30), riffler.Tool.flat(6, 30)], feed=123.456, spindle=-999
    )
    file = tmp_path_factory.mktemp("nc") / "p.ngc"
    p.write(file, post=post, options=options | AS_ROWS)
    first = file.read_bytes()
    q = riffler.Program.read(file, machine=post, options=options)
    rows = rows_of(q.poses, p.poses)
    for name in ("feed", "rapid", "tool", "spindle"):
        np.testing.assert_array_equal(getattr(q, name)[rows], getattr(p, name))
    assert (q.line > 0).all() and (np.diff(q.line) > 0).all()
    assert q.provenance == {"source": "p.ngc"} and {note.kind for note in q.notes} <= {"rapid"}
    p.write(file, post=post, options=options | AS_ROWS)
    assert file.read_bytes() == first


def test_three_axis_post_has_upright_tools_only(tmp_path, ball):
    upright = spiral(5, tilt=0)
    file = tmp_path / "p.ngc"
    riffler.Program.from_cl([upright], tools=[ball], feed=100).write(file, post="3-axis", options=AS_ROWS)
    text = file.read_text()
    assert "G43 H1" in text and not re.search(r"^[^(]*[AC][-0-9]", text, re.M)
    np.testing.assert_allclose(riffler.Program.read(file, machine="3-axis").poses[1:6], upright, atol=1e-5)
    with pytest.raises(ValueError, match="row 2"):
        riffler.Program.from_cl([spiral(5)], tools=[ball], feed=100).write(file, post="3-axis")
    assert file.read_text() == text


@pytest.mark.parametrize("post", ["linuxcnc-xyzac", "linuxcnc-xyzbc"])
def test_joint_posts_read_back_with_the_same_options(tmp_path, ball, post):
    path = spiral(20)
    options = {"rot_point": [10, -5, 40], "offset": [3, 4, -20], "tool_offset": 60.0, "direction": "iso"}
    file = tmp_path / "p.ngc"
    program = riffler.Program.from_cl([path], tools=[ball], feed=400)
    program.write(file, post=post, options={**options, "max_rotary": 5e3})
    text = file.read_text()
    assert "M429" in text and "\nG93 G1 " in text and "G94" in text
    back = riffler.Program.read(file, machine=post, options=options).poses
    for pose in path:
        off = np.linalg.norm(back[:, :3] - pose[:3], axis=1) + np.linalg.norm(back[:, 3:] - pose[3:], axis=1)
        assert off.min() < 2e-5, "every row is the end of a block"
    with pytest.raises(ValueError, match="option offset must be three finite numbers"):
        riffler.Program.read(file, machine=post, options={"offset": [1, 2]})


def test_programs_are_edited_into_new_ones(ball):
    p = riffler.Program.from_cl([spiral(10), spiral(6)], tools=[ball], feed=100)
    q = p.trimmed(2, 9)
    assert len(q) == 7 and q.rapid[0] and np.array_equal(q.poses, p.poses[2:9])
    turned = np.array([[0, -1, 0, 5], [1, 0, 0, 0], [0, 0, 1, -2], [0, 0, 0, 1]], float)
    moved = p.transformed(turned)
    np.testing.assert_allclose(moved.poses[:, :3], p.poses[:, :3] @ turned[:3, :3].T + turned[:3, 3], atol=1e-12)
    np.testing.assert_allclose(moved.poses[:, 3:], p.poses[:, 3:] @ turned[:3, :3].T, atol=1e-15)
    assert np.array_equal(p.scale_feeds(0.5).feed, 0.5 * p.feed)
    both = riffler.Program.joined([p, q])
    assert len(both) == len(p) + 7 and set(both.tools) == {1}
    assert set(p.renumber_tools({1: 4}).tool) == {4} and set(p.renumber_tools({1: 4}).tools) == {4}
    with pytest.raises(ValueError, match="last row"):
        p.transformed(np.ones((4, 4)))
    with pytest.raises(ValueError, match="rows 5 to 2"):
        p.trimmed(5, 2)
    with pytest.raises(ValueError, match="would be"):
        riffler.Program.joined([p, riffler.Program.from_cl([spiral(3)], tools=[riffler.Tool.flat(3, 20)], feed=1)])


def test_unknown_names_are_value_errors_that_list_the_known_ones(tmp_path, ball):
    machines = "tcp tcp-bc linuxcnc-xyzac linuxcnc-xyzbc head-head head-table 3-axis heidenhain heidenhain-bc"
    machines += " sinumerik sinumerik-bc apt"
    assert list(riffler.machines()) == machines.split() and all(riffler.machines().values())
    p = riffler.Program.from_cl([spiral(3)], tools=[ball], feed=100)
    file = tmp_path / "p.ngc"
    with pytest.raises(ValueError, match=r"known: tcp, tcp-bc, .*, apt, or the path of a .toml"):
        p.write(file, post="lathe")
    with pytest.raises(ValueError, match=r"known: tcp, tcp-bc, .*, apt, or the path of a .toml"):
        riffler.Program.read(__file__, machine="lathe")
    with pytest.raises(ValueError, match="unknown option 'direction'"):
        p.write(file, options={"direction": "iso"})
    with pytest.raises(ValueError, match=r"known: tcp, .*chord_tolerance"):
        riffler.Program.read(__file__, options={"chords": 3})
    assert not file.exists()


def read(tmp_path, text, **arguments):
    file = tmp_path / "part 1.ngc"
    file.write_bytes(text.encode())
    return riffler.Program.read(file, **arguments)


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("G1 X1", 1),
        ("G21\nG1 XNaN F1", 2),
        ("G21\n\nG1 X1 X2 F1", 3),
        ("G0 G1 X1 F1", 1),
        ("G0 X1 (", 1),
        ("G93 G1 X1 F1\nX2", 2),
        ("G1 X1 F1\nG93 X2 F1\nG94 X3", 3),
        ("G0 X1\nG2 X11 I5.01 F1", 2),
        ("G0 X1\nW2", 2),
        ("G0 X1\nG77", 2),
        ("G0 \u00e9", 1),
    ],
)
def test_bad_files_are_format_errors_naming_file_and_line(tmp_path, text, line):
    with pytest.raises(riffler.FormatError, match=rf"^part 1\.ngc, line {line}: "):
        read(tmp_path, text)


def test_missing_file_is_a_format_error(tmp_path):
    with pytest.raises(riffler.FormatError, match=r"no\.ngc"):
        riffler.Program.read(tmp_path / "no.ngc")


def test_arcs_are_chords_within_the_tolerance(tmp_path):
    p = read(tmp_path, "G0 X10\nG3 X-10 I-10 F60\n")
    mid = (p.poses[1:, :2] + p.poses[:-1, :2]) / 2
    assert np.abs(np.hypot(*p.poses[:, :2].T) - 10).max() < 1e-12
    assert 10 - np.hypot(*mid.T).min() <= 0.002
    assert p.poses[len(p) // 2, 1] > 9
    fine = read(tmp_path, "G0 X10\nG3 X-10 I-10 F60\n", options={"chord_tolerance": 1e-4})
    assert len(fine) > 3 * len(p)


def test_mutated_code_does_not_pass(tmp_path, ball):
    p = riffler.Program.from_cl([spiral(30, turns=0.4)], tools=[ball], feed=100)
    file = tmp_path / "p.ngc"
    p.write(file, options=AS_ROWS)
    text = file.read_text()

    def worst(mutated):
        q = read(tmp_path, mutated)
        return np.abs(q.poses - riffler.Program.read(file).poses).max()

    assert worst(text) == 0
    assert worst(re.sub(r" C(-?)(?=[1-9])", lambda m: " C" + ("" if m[1] else "-"), text)) > 0.1
    swapped = text.translate(str.maketrans("AB", "BA"))
    with pytest.raises(riffler.FormatError):
        worst(swapped)
    inverse = "G21 G90 G93\nG1 X1 F2\nX2 F2\n"
    assert len(read(tmp_path, inverse)) == 2
    with pytest.raises(riffler.FormatError, match="line 3"):
        read(tmp_path, inverse.replace("X2 F2", "X2"))


def test_replay_of_read_code_carves_as_the_program_does(tmp_path, ball):
    p = riffler.Program.from_cl(
        [spiral(12) + np.array([0, 20, 28, 0, 0, 0])], tools=[ball], feed=100, occupied=((0, 0, 0), (90, 50, 30))
    )
    p.write(tmp_path / "p.ngc", axis_tolerance=1e-4, options=AS_ROWS)
    q = riffler.Program.read(tmp_path / "p.ngc")
    volumes = []
    for program in (p, q):
        v = riffler.Volume.block((0, 0, 0), (90, 50, 30), 1)
        for number, poses in program.cuts():
            v.carve(p.tools[number], poses, tolerance=1e-3)
        volumes.append(v.volume)
    assert volumes[0] < 90 * 50 * 30 - 100
    assert volumes[1] == pytest.approx(volumes[0], abs=1)
