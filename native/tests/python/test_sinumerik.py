"""Sinumerik programs from Python: files, subprograms next to them, streams, notes in a verification."""

import numpy as np
import pytest
import riffler

PLATE = """%_N_PLATE_MPF
N10 G710 G17 G90 G94 G54
N20 T1 D1 M6
N30 S3000 M3 F400
N40 G0 X0 Y0 Z20
N50 WHILE R1<40
N60 R1=R1+1
N70 EDGE(R1, 5)
N80 ENDWHILE
N90 SUPA G0 Z0 D0
N100 M30
"""
EDGE = """PROC EDGE(REAL AT, REAL RADIUS)
G1 X=AT Y=20*SIN(9*AT) Z=-0.1*AT
G3 X=AT+2*RADIUS CR=RADIUS
G0 Z=IC(10)
RET
"""


@pytest.fixture
def plate(tmp_path):
    file = tmp_path / "plate.mpf"
    file.write_text(PLATE.replace("N50", "N45 R1=0\nN50"))
    (tmp_path / "edge.spf").write_text(EDGE)
    return file


def test_subprograms_are_found_next_to_the_file_or_in_a_folder(plate, tmp_path):
    program = riffler.Program.read(plate, machine="sinumerik")
    assert [note.kind for note in program.notes] == ["machine position"]
    ends = program.poses[1:][program.rapid[1:] & ~program.at_machine[1:], :3]
    at = np.arange(1, 41)
    np.testing.assert_allclose(ends[:, 0], at + 10)
    np.testing.assert_allclose(ends[:, 1], 20 * np.sin(np.radians(9 * at)), atol=1e-9)
    np.testing.assert_allclose(ends[:, 2], 10 - 0.1 * at, atol=1e-9)

    elsewhere = tmp_path / "library"
    elsewhere.mkdir()
    (tmp_path / "edge.spf").rename(elsewhere / "EDGE.SPF")
    with pytest.raises(riffler.FormatError, match=r"plate.mpf, line 9: unknown .*EDGE.*option subroutines"):
        riffler.Program.read(plate, machine="sinumerik")
    again = riffler.Program.read(plate, machine="sinumerik", options={"subroutines": str(elsewhere)})
    np.testing.assert_array_equal(again.poses, program.poses)


def test_a_stream_has_the_same_rows(plate):
    whole = riffler.Program.read(plate, machine="sinumerik")
    chunks = list(riffler.Program.stream(plate, machine="sinumerik", rows=100))
    assert len(chunks) > 5
    poses = np.concatenate([chunks[0].poses, *(chunk.poses[1:] for chunk in chunks[1:])])
    np.testing.assert_array_equal(poses, whole.poses)


def test_a_program_in_two_work_offsets_does_not_pass(tmp_path):
    file = tmp_path / "two.mpf"
    file.write_text("G710 G54 T1 M6 S1000 M3\nG0 X0 Y0 Z20\nG1 Z5 F100\nX10\nG0 Z20\n")
    stock = riffler.Volume.block((-20, -20, -10), (20, 20, 0), pitch=1.0, directions="z")
    tools = {1: riffler.Tool.flat(4, 30)}

    def report():
        return riffler.verify(riffler.Program.read(file, machine="sinumerik"), stock, tools=tools)

    assert report().passed
    file.write_text(file.read_text() + "G55 X1\nG1 Z6\nG0 Z20\n")
    failed = report()
    assert not failed.passed and any("G55" in text for text in failed.not_checked)


def test_options_that_are_not_the_readers_are_errors(plate):
    with pytest.raises(ValueError, match="unknown option 'g54'"):
        riffler.Program.read(plate, machine="sinumerik", options={"g54": [0, 0, 0]})
    with pytest.raises(ValueError, match="tcp must not be False"):
        riffler.Program.read(plate, machine="sinumerik", options={"tcp": False})
    with pytest.raises(riffler.FormatError, match="machines that read them: sinumerik, sinumerik-bc"):
        riffler.Program.read(plate)
