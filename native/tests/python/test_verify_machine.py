"""Whether the machine can run it: limits of axes as findings of a verification, and as errors of the reader."""

import numpy as np
import pytest
import riffler

TABLE = {"rot_point": [0, 0, -60], "limits_a": [-30, 30]}


def leaning(rows, tilt):
    """A level path over the block, the axis leaning by `tilt` degrees (one or one a row)."""
    t = np.linspace(0, 1, rows)
    angle = np.radians(np.broadcast_to(tilt, rows))
    axes = np.column_stack([0 * t, np.sin(angle), np.cos(angle)])
    poses = np.column_stack([5 + 30 * t, 15 + 0 * t, 9 + 0 * t, axes])
    tool = riffler.Tool.ball(4, 40)
    return riffler.Program(poses, 600, spindle=9000, line=np.arange(rows) + 100, tools={1: tool})


def stock():
    return riffler.Volume.block([0, 0, 0], [40, 30, 10], 0.5)


def test_the_first_row_beyond_a_limit_is_a_finding_with_its_line():
    program = leaning(12, np.linspace(0, 55, 12))  # 5 degrees a row: row 7 is the first beyond 30
    report = riffler.verify(program, stock(), machine="linuxcnc-xyzac", machine_options=TABLE)
    assert not report.passed and [f.kind for f in report.findings] == ["machine"]
    found = report.findings[0]
    assert (found.row, found.line, found.unit, found.tool) == (7, 107, "", 1)
    assert "A would stand at" in found.message and "tilt the tool less" in found.message
    assert not any("no machine" in sentence for sentence in report.not_checked)


def test_programs_within_limits_pass_and_limits_without_a_machine_are_not_checked():
    program = leaning(12, 20)
    report = riffler.verify(program, stock(), machine="linuxcnc-xyzac", machine_options=TABLE)
    assert report.passed
    alone = riffler.verify(program, stock())
    assert "limits and reach: no machine was given" in alone.not_checked
    upright = riffler.verify(program, stock(), machine="3-axis")
    assert [f.kind for f in upright.findings] == ["machine"] and upright.findings[0].row == 0


def test_chunks_and_edits_give_the_same_report():
    program = leaning(12, np.linspace(0, 55, 12))
    how = {"machine": "linuxcnc-xyzac", "machine_options": TABLE}
    chunks = [program.trimmed(0, 5), riffler.Program(program.poses[4:], 600, spindle=9000, line=program.line[4:],
                                                     tools=program.tools)]  # fmt: skip
    report = riffler.verify(chunks, stock(), **how)
    assert [(f.kind, f.row, f.line) for f in report.findings] == [("machine", 7, 107)]
    verification = riffler.Verification(stock(), **how)
    assert [f.row for f in verification.run(program).findings] == [7]
    assert verification.run(leaning(12, 20)).passed


def test_a_machine_holds_the_program_in_its_own_frame():
    """The stock and the program stand turned by a quarter about z and moved: the machine has them as they were."""
    program, c = leaning(12, np.linspace(0, 55, 12)), 20.0
    matrix = np.array([[0, -1, 0, 30], [1, 0, 0, 5], [0, 0, 1, c], [0, 0, 0, 1]], float)
    block = riffler.Volume.block([0, 5, c], [30, 45, c + 10], 0.5)
    moved, back = program.transformed(matrix), np.linalg.inv(matrix)
    how = {"machine": "linuxcnc-xyzac", "machine_options": TABLE}
    (straight,) = riffler.verify(program, stock(), **how).findings
    for verify in (riffler.verify, lambda p, s, **k: riffler.Verification(s, **k).run(p)):
        (found,) = verify(moved, block, machine_frame=back, **how).findings
        assert (found.row, found.message) == (straight.row, straight.message)
        assert np.allclose(found.point, moved.poses[7, :3]), "in the frame of the stock"
    for frame, message in (
        (np.eye(3), "machine_frame must have the shape"),
        (2 * np.eye(4), "machine_frame: its last"),
    ):
        with pytest.raises(ValueError, match=message):
            riffler.verify(moved, block, machine_frame=frame, **how)
    with pytest.raises(ValueError, match="machine_frame: there is no machine"):
        riffler.verify(moved, block, machine_frame=back)


def test_wrong_machines_and_options_are_value_errors():
    with pytest.raises(ValueError, match="unknown post lathe"):
        riffler.verify(leaning(3, 0), stock(), machine="lathe")
    with pytest.raises(ValueError, match="there is no machine"):
        riffler.verify(leaning(3, 0), stock(), machine_options={"tcp": True})


def test_the_reader_names_the_line_at_which_an_axis_would_leave_its_limits(tmp_path):
    program, file = leaning(12, np.linspace(0, 55, 12)), tmp_path / "p.ngc"
    table = {"rot_point": [0, 0, -60]}
    program.write(file, post="linuxcnc-xyzac", options=table)
    assert len(riffler.Program.read(file, machine="linuxcnc-xyzac", options=table)) >= 12
    with pytest.raises(riffler.FormatError, match=r"p.ngc, line \d+: A would stand at -?3[0-9.]+, beyond the limits"):
        riffler.Program.read(file, machine="linuxcnc-xyzac", options=TABLE)


def test_the_swing_of_a_machines_rotary_axes_decides_what_is_hit(tmp_path):
    """A table that turns half way round takes the leaning holder round the side, where the clamp is, not over it."""
    file = tmp_path / "swing.ngc"
    tool = riffler.Tool.ball(4, 20).with_shank([(20, 2, 40, 2)]).with_holder([(40, 15, 90, 15)])
    block = riffler.Volume.block([-10, -10, -20], [10, 10, 0], 0.5)
    seen = {}
    for side in (-1, 1):
        clamp = riffler.Volume.block([-10, 35 * side - 8, 30], [10, 35 * side + 8, 55], 0.5)
        for code in ("G1", "G0"):
            file.write_text(f"G21 G90 T1 M6\nS1000 M3\nG1 X0 Y0 Z5 B45 C0 F500\n{code} C180\nX1 Y0\n")
            program = riffler.Program.read(file, machine="head-table")
            assert len(program) == 3 and list(program.via) == [1]
            report = riffler.verify(program, block, None, [clamp], tools={1: tool}, machine="head-table")
            hits = [f for f in report.findings if f.kind == "fixture"]
            seen[side, code] = bool(hits)
            if hits:
                assert (hits[0].row, hits[0].line, hits[0].member) == (1, 4, "holder")
            assert len(report.removed) == len(report.seconds) == 3
            # In chunks, followed, and read with rows for the swing, it is the same.
            first = {"rapid": program.rapid[:2], "line": program.line[:2], "spindle": 1000, "via": program.via}
            chunks = [riffler.Program(program.poses[:2], program.feed[:2], **first), program.trimmed(1, 3)]
            again = riffler.verify(chunks, block, None, [clamp], tools={1: tool}, machine="head-table")
            assert [(f.kind, f.row, f.value) for f in again.findings] == [
                (f.kind, f.row, f.value) for f in report.findings
            ]
            whole = riffler.verify(program.followed(), block, None, [clamp], tools={1: tool})
            assert [f.kind for f in whole.findings] == [f.kind for f in report.findings]
    assert seen[-1, "G1"] == seen[-1, "G0"] != seen[1, "G1"] == seen[1, "G0"]


def test_rapids_that_are_dog_legs_meet_what_straight_ones_pass(tmp_path):
    file = tmp_path / "rapid.ngc"
    file.write_text("G21 G90 T1 M6\nS1000 M3\nG0 X-10 Y5 Z20\nX50 Y40 Z20\nG1 Z19 F100\n")
    block = riffler.Volume.block([0, 0, 0], [40, 30, 10], 0.5)
    post = riffler.Volume.block([22, 36, 0], [28, 44, 30], 0.5)
    tools = {1: riffler.Tool.flat(6, 40)}
    straight = riffler.Program.read(file, machine="3-axis")
    report = riffler.verify(straight, block, None, [post], tools=tools)
    assert report.findings == [] and any("option rapids" in sentence for sentence in report.not_checked)
    legs = riffler.Program.read(file, machine="3-axis", options={"rapids": "independent"})
    report = riffler.verify(legs, block, None, [post], tools=tools)
    assert [(f.kind, f.row) for f in report.findings] == [("fixture", 1)]
    assert not any("option rapids" in sentence for sentence in report.not_checked)
