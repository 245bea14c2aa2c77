"""Programs made by a grammar, read by LinuxCNC's own interpreter and by riffler: the same moves or both refuse."""

import random

import numpy as np
import pytest
import riffler
from hypothesis import given, settings
from hypothesis import strategies as st
from nc_grammar import Grammar
from riffler_bench.nc_judge import poses as forward
from riffler_bench.nc_judge import tilting_table

import linuxcnc

pytestmark = linuxcnc.needed

FIXED = settings(derandomize=True, deadline=None, max_examples=150, database=None)
CHORD = 0.002


def axis_of(joints):
    """Rz(C) Rx(A) e_z."""
    a, c = np.radians(joints[3]), np.radians(joints[5])
    return np.array([np.sin(c) * np.sin(a), -np.cos(c) * np.sin(a), np.cos(a)])


def compare(program, calls, first):
    """Every canonical move has its rows, in order, and no row is left over."""
    poses, rapid, spindle, tool, feed = program.poses, program.rapid, program.spindle, program.tool, program.feed
    row, last = 0, np.array([*first.program(calls[0].start)[:3], *axis_of(calls[0].start)]) if calls else None

    def next_row():
        """Past those that go nowhere."""
        nonlocal row
        while row < len(program) and np.abs(poses[row] - last).max() < 1e-9:
            row += 1
        assert row < len(program), f"no row for {call}"
        row += 1
        return row - 1

    def check_words(k):
        assert rapid[k] == np.isnan(call.feed)
        assert abs(spindle[k] - call.spindle) <= 1e-3, (k, call)
        assert tool[k] == call.tool
        if not rapid[k] and np.linalg.norm(call.end[:3] - call.start[:3]) > 1e-2:
            assert abs(feed[k] - call.feed) <= max(2e-3 * abs(call.feed), 2e-2), (k, call)

    error = 0.0
    for call in calls:
        start, end = first.program(call.start), first.program(call.end)
        off, error = max(call.error, error), call.error  # of where it starts and where it ends
        if call.plane is None:
            turned = np.abs(axis_of(end) - axis_of(start)).max()
            if np.abs(end - start)[:3].max() < 3 * off and turned < 1e-5:
                continue  # riffler makes a row of it where the block had axis words, LinuxCNC always
            k = next_row()
            check_words(k)
        else:
            (u, v), swept = call.plane, 0.0
            flat = call.centre if (u, v) != (0, 1) else first.program(np.array([*call.centre, 0, 0, 0, 0]))[:2]
            if (u, v) != (0, 1):
                flat = flat - (first.work + first.shift)[[u, v]]
            before = start[[u, v]] - flat
            radius = np.linalg.norm(before)
            while swept < abs(call.sweep) - 2e-2 * min(1, 1e-2 / radius) - 3 * off / radius:
                k = next_row()
                check_words(k)
                last = poses[k]
                now = poses[k, :3][[u, v]] - flat
                assert np.linalg.norm(now) == pytest.approx(radius, abs=0.005 + 2 * off)
                chord = np.linalg.norm((now + before) / 2)
                assert radius - chord < CHORD + 0.005 + 2 * off
                turn = np.sign(call.sweep) * np.arctan2(before[0] * now[1] - before[1] * now[0], before @ now)
                swept, before = swept + turn, now
                w = 3 - u - v
                height = start[w] + (end[w] - start[w]) * swept / abs(call.sweep)
                assert poses[k, w] == pytest.approx(height, abs=2e-2 * abs(end[w] - start[w]) + 3 * off)
        last = poses[k]
        bound = np.repeat([call.error + 1e-9, 1e-5], 3)
        where = np.array([*end[:3], *axis_of(end)])
        assert (np.abs(last - where) <= bound + 1e-7 * np.abs(where)).all(), (last - where, call)
    while row < len(program) and np.abs(poses[row] - last).max() < 1e-6:
        row += 1
    assert row == len(program), f"row {row} of {len(program)} was not reached"


def zeros(folder):
    """A file of parameters as rs274 begins: all offsets and homes at the machine's zero."""
    file = folder / "zero.var"
    file.write_text("5220 1\n")
    return str(file)


def both(folder, text):
    """Both read it, or both refuse it: then what they say comes back."""
    file = folder / "p.ngc"
    file.write_text(text)
    how = {"parameters": zeros(folder)}
    try:
        calls, first = linuxcnc.calls(linuxcnc.output(file, "-b"))
    except linuxcnc.RefusedError as refused:
        try:
            riffler.Program.read(file, options=how)
        except riffler.FormatError as e:
            return str(e)
        raise AssertionError(f"LinuxCNC refuses this: {refused}") from None
    compare(riffler.Program.read(file, options=how), calls, first)
    return ""


@FIXED
@given(seed=st.integers(0, 2**32))
def test_random_programs_are_read_as_linuxcnc_reads_them(tmp_path_factory, seed):
    both(tmp_path_factory.mktemp("nc"), Grammar(random.Random(seed)).program())


# What both refuse. What riffler alone refuses, and why, is in docs/reading-nc.md.
# Separated by commas; | ends a block.
UNSOUND = """
G1 X1 X2, G0 G1 X1, G17 G18, G0 X1 P3, G0 X1 R2, G0 X1 Q1, G0 X1 I1, G2 X1 Y1, G17 G2 X30 I1 J0,
G17 G2 X1 Y1 I1 R1, G17 G2 I1 K1, G17 G3 X50 Y0 R1, G17 G2 I1 P0, G17 G90 G3 X#5420 Y#5421 R3, G93 G1 X1,
G94|G93 G1 X1 F1|X2, G93 G1 X1 F1|G94 X3, G95 F.1 S0|G1 X1, G38.2 Z-5 K, G10 L2 P10 X1, G10 L2 X1, G10 L20 P1 R5,
G92, G52, G91 G53 G0 X1, G53 X1 G2 I1, G0 X1 G92 Y3, G17 G81 X1, G17 G80|G81 X1 Z-5, G17 G80|G81 R3 X1,
G17 G81 X1 R1 Z2, G17 G90 G83 X1 R1 Z-1, G17 G90 G81 X1 R1 Z-1 L0, G17 G90 G81 X1 R1 Z-1 A5,
G93 G81 X1 R1 Z-1 F1, G80 X1, G87 X1, M72, G4, F-1, S-1, T-1, T1.5, M62, M66, M68 Q1, G96, M3 M4,
G0 X[1/0], G0 XSQRT[-1], G0 X[ACOS[2]], G0 X[1, G0 X#0, G0 X#5602, G0 X#<never>, #5420 = 1, #<_x> = 1, G0 X1 #1,
G0 X, G0 X1 N5, N5 / X2, G0 U, G5.7 X1, M97, G0 X1 =, o1 endwhile, o1 endif X, o1 if [0]|G0 X1, o999 call,
o1 sub|o1 call|o1 endsub|o1 call, G0 X1 (, G0 X1 ), G0 X[2 ** ], G0 X[[-2] ** 0.5], G1 X1 F0,
G43 H1.5, G18 G5 X1 Y1 I1 J1 P1 Q1, G17 G91 G5 X1 Y1 I1 J1, G17 G5.1 X1 Y1, M61, M98, G33 Z1 K1, G76, @, G0 X1.2.3
"""


@pytest.mark.parametrize("line", [line.strip().replace("|", "\n") for line in UNSOUND.split(",")])
def test_what_linuxcnc_refuses_is_refused(tmp_path, line):
    text = Grammar(random.Random(line)).program().rsplit("\n", 2)[0]
    message = both(tmp_path, f"{text}\nG94 F100\n{line}\nM2\n")
    assert message.startswith("p.ngc, line ")
    assert message.endswith("]") or "has no end" in message


@pytest.mark.parametrize("name", linuxcnc.FIVE_AXES)
def test_the_programs_of_linuxcncs_five_axis_simulators_are_read(name):
    program = linuxcnc.demonstration(name)
    assert len(program) > 50 and ("_test_" in name or np.ptp(program.poses[:, 3:], axis=0).max() > 0.1)


@pytest.mark.parametrize("name", ["boat-xyzac", "impeller-7bl-xyzac", "boat-xyzbc"])
def test_demonstrations_without_switches_go_where_linuxcnc_takes_them(tmp_path, name):
    """With their M428 and M429 taken out, which rs274 alone does not know: X Y Z are the tip."""
    text = "".join(
        line for line in linuxcnc.demonstration_file(name).read_text().splitlines(True)
        if not line.lower().lstrip().startswith(("m428", "m429", "m430"))
    )  # fmt: skip
    file = tmp_path / "p.ngc"
    file.write_text(text)
    calls, first = linuxcnc.calls(linuxcnc.output(file, "-b"))
    tilt = linuxcnc.FIVE_AXES[name][-2].upper()
    how = {"tcp": True, "parameters": zeros(tmp_path)}
    program = riffler.Program.read(file, machine=linuxcnc.FIVE_AXES[name], options=how)
    ends = np.array([first.program(call.end) for call in calls if np.abs(call.end - call.start).max() > 1e-3])
    axes = forward(ends, tilting_table(tilt, [0, 0, 0], [0, 0, 0]))[:, 3:]
    row = 0
    for end, axis in zip(ends, axes, strict=True):
        off = np.abs(program.poses[row:] - np.array([*end[:3], *axis])).max(1)
        ahead = np.flatnonzero(off < 1e-3)
        assert len(ahead), f"{end} is not reached after row {row}"
        row += int(ahead[0])


def test_the_programs_that_linuxcnc_ships_are_read_or_refused_with_a_reason():
    files = sorted((linuxcnc.FOLDER / "usr" / "share" / "linuxcnc" / "ncfiles").rglob("*.ngc"))
    read, refused = 0, []
    options = {"subroutines": str(linuxcnc.FOLDER / "usr/share/linuxcnc/ncfiles/ngcgui_lib"), "max_turns": 1e5}
    for file in files:
        try:
            riffler.Program.read(file, options=options)
            read += 1
        except riffler.FormatError as e:
            refused.append(str(e))
    reasons = [
        *["cutter radius compensation", "probing", "threads", "is the machine's own", "machine has no such axis"],
        *["unknown code", "unknown letter", "polar", "unknown word after", "turning cycles"],
    ]
    assert read > 0.7 * len(files)
    assert not [e for e in refused if not any(reason in e for reason in reasons)]
