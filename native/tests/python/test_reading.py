"""Reading NC code and APT files from Python: streams, options, what is recorded."""

import itertools
import pickle
import threading

import numpy as np
import pytest
import riffler

LINES = 20_000


@pytest.fixture
def part(tmp_path):
    file = tmp_path / "part.ngc"
    t = np.arange(LINES) * 1e-2
    lines = [f"G1 X{x:.4f} Y{y:.4f} Z-1" for x, y in zip(t, np.sin(t), strict=True)]
    file.write_text("\n".join(["G21 G90", "F500", *lines, "M2"]) + "\n")
    return file


def test_a_stream_gives_the_same_rows_as_reading(part):
    whole = riffler.Program.read(part)
    chunks = list(riffler.Program.stream(part, machine="tcp", rows=1000))
    assert all(len(chunk) <= 1000 for chunk in chunks)
    for before, after in itertools.pairwise(chunks):
        np.testing.assert_array_equal(before.poses[-1], after.poses[0])
    for column in ("poses", "feed", "rapid", "tool", "line", "spindle"):
        parts = [getattr(chunk, column)[k > 0 :] for k, chunk in enumerate(chunks)]
        np.testing.assert_array_equal(np.concatenate(parts), getattr(whole, column))
    assert all(chunk.provenance == {"source": "part.ngc"} for chunk in chunks)


def test_a_stream_raises_an_error_when_it_reaches_it(part):
    part.write_text(part.read_text().replace("M2", "G1 X"))
    stream = riffler.Program.stream(part, rows=LINES)
    assert len(next(stream)) == LINES
    wrong = rf"^part\.ngc, line {LINES + 3}: expected a number after X \[G1 X\]$"
    with pytest.raises(riffler.FormatError, match=wrong):
        next(stream)
    with pytest.raises(riffler.FormatError, match="none"):
        riffler.Program.stream(part.with_name("none.ngc"))
    with pytest.raises(ValueError, match="rows"):
        riffler.Program.stream(part, rows=1)
    with pytest.raises(ValueError, match="unknown option 'rows'"):
        riffler.Program.stream(part, options={"rows": 5})


def test_a_conversational_program_streams_too(tmp_path):
    file = tmp_path / "part.h"
    blocks = [f"{k} L X+{k % 97} Y-{k % 89},5 Z+{k % 3} F300" for k in range(5000)]
    file.write_text("\r\n".join(["BEGIN PGM PART MM", "TOOL CALL 4 Z S900", *blocks, "M30", "END PGM PART MM"]))
    whole = riffler.Program.read(file, machine="heidenhain")
    assert len(whole) == 5000 and whole.poses[4999, 1] == -15.5
    chunks = list(riffler.Program.stream(file, machine="heidenhain", rows=700))
    parts = [chunk.poses[k > 0 :] for k, chunk in enumerate(chunks)]
    np.testing.assert_array_equal(np.concatenate(parts), whole.poses)
    with pytest.raises(riffler.FormatError, match=r"machines that read heidenhain: heidenhain, heidenhain-bc$"):
        riffler.Program.stream(file)


def test_streams_run_at_the_same_time(part):
    sums = []

    def read():
        sums.append(sum(len(chunk) - 1 for chunk in riffler.Program.stream(part, rows=500)))

    threads = [threading.Thread(target=read) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sums == [LINES - 1] * 4


def test_an_apt_file_is_a_program_like_any_other(tmp_path):
    file = tmp_path / "part.apt"
    file.write_text(
        "PARTNO PART\nUNITS/MM\nMULTAX/ON\nCUTTER/6,3,0,3,0,0,30\nLOADTL/2\nSPINDL/9000,RPM,CLW\nRAPID\n"
        "GOTO/0,0,30,0,0,1\nFEDRAT/600,MMPM\nGOTO/0,0,0,0,0,1\nGOTO/50,0,-1,0.6,0,0.8\nFINI\n"
    )
    program = riffler.Program.read(file, machine="apt")
    np.testing.assert_allclose(program.poses[-1], [50, 0, -1, 0.6, 0, 0.8], atol=1e-15)
    assert program.tools == {2: riffler.Tool.ball(6, 30)} and set(program.tool) == {2}
    assert program.feed.tolist() == [0, 600, 600] and program.line.tolist() == [8, 10, 11]
    (chunk,) = riffler.Program.stream(file, machine="apt")
    assert chunk.tools == program.tools and len(chunk) == 3


def test_skipped_blocks_are_in_the_provenance(tmp_path):
    file = tmp_path / "p.ngc"
    file.write_text("G21 G0 X1\nG187 P1\nG0 X2 U5\nG28\n")
    with pytest.raises(riffler.FormatError, match=r"line 2: unknown code G187: .*'unknown': 'skip'"):
        riffler.Program.read(file)
    program = riffler.Program.read(file, options={"unknown": "skip"})
    assert program.provenance["skipped"] == "line 2: G187; line 3: U was skipped, an axis of the program"
    assert "line 4: G28 goes to a machine position" in program.provenance["notes"]


def test_notes_stay_with_the_program(tmp_path):
    file = tmp_path / "p.ngc"
    file.write_text("G21 G0 X1 Y0 Z0\nG60 X9\nG187 P1\nG1 X2 F100\nM30\nX5\n")
    program = riffler.Program.read(file, options={"unknown": "skip"})
    said = [("coordinates", 2), ("skipped", 3), ("end", 6)]
    assert [(note.kind, note.line) for note in program.notes] == said
    assert repr(program.notes[0]) == "<riffler.Note: line 2, coordinates: G60 was skipped, with its axis words>"
    program.save(tmp_path / "p.rprog")
    others = [
        riffler.Program.load(tmp_path / "p.rprog"), pickle.loads(pickle.dumps(program)), program.scale_feeds(2),
        riffler.Program.joined([program]), program.trimmed(0, 2),
        list(riffler.Program.stream(file, options={"unknown": "skip"}))[-1],
        riffler.Program(program.poses, program.feed, rapid=program.rapid, notes=program.notes),
    ]  # fmt: skip
    for other in others:
        assert [(note.kind, note.line) for note in other.notes] == said
        assert not any(key.startswith("note:") for key in other.provenance)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"unknown": "ask"}, "option unknown must be one of error, skip"),
        ({"block_delete": 1.0}, "option block_delete must be true or false"),
        ({"subroutines": 5.0}, "option subroutines must be a path"),
        ({"max_turns": -1.0}, "option max_turns must be a positive"),
    ],
)
def test_options_are_checked(tmp_path, options, message):
    file = tmp_path / "p.ngc"
    file.write_text("G0 X1\n")
    with pytest.raises(ValueError, match=message):
        riffler.Program.read(file, options=options)


def test_apt_files_that_riffler_writes_read_back(tmp_path):
    t = np.linspace(0, 1, 20)
    axes = np.column_stack([np.sin(t), 0.2 * np.cos(t), np.ones(20)])
    path = np.column_stack([50 * t, 10 * t**2, -t, axes / np.linalg.norm(axes, axis=1)[:, None]])
    tools = [riffler.Tool.fillet(8, 1, 40), riffler.Tool.flat(6, 30)]
    program = riffler.Program.from_cl([path, path[::-1]], tools=tools, feed=[300, 250.5], spindle=[5000, -900])
    program.write(tmp_path / "p.apt", post="apt")
    back = riffler.Program.read(tmp_path / "p.apt", machine="apt")
    np.testing.assert_allclose(back.poses, program.poses, atol=1e-5)
    for column in ("feed", "rapid", "tool", "spindle"):
        np.testing.assert_array_equal(getattr(back, column), getattr(program, column))
    assert {number: tool.to_dict()["kind"] for number, tool in back.tools.items()} == {1: "fillet", 2: "flat"}
    assert "skipped" not in back.provenance
