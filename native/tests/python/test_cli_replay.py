"""``riffler volume replay``: what a session left, from its journal."""

import numpy as np
import pytest
import riffler
from commands import result, riffle


@pytest.fixture
def session(tmp_path):
    """A folder with a journal on a snapshot, and what the session left."""
    volume = riffler.Volume.block((0, 0, 0), (20, 15, 10), 0.5)
    tool = riffler.Tool.ball(4, 20)
    volume.carve(tool, [[3, 3, 8, 0, 0, 1], [17, 3, 8, 0, 0, 1]])
    volume.save(tmp_path / "stock.rvol")
    poses = np.array([[3, 8, 9, 0, 0, 1], [10, 9, 7, 0, 0.6, 0.8], [10, 9, 7, 0, 0.6, 0.8], [17, 8, 9, 0, 0, 1.0]])
    aside = np.array([0, 1, 0, 0, 0, 0])
    with riffler.JournalWriter(tmp_path / "a.rjournal") as writer:
        writer.set_stock(volume.lower, volume.upper, 0.5, volume.directions, snapshot="stock.rvol")
        writer.add_tool(1, tool)
        for k in range(3):
            writer.add_stroke(1, poses + 2 * k * aside)
        writer.undo()
    for k in range(2):
        volume.carve(tool, poses[[0, 1, 3]] + 2 * k * aside)
    volume.save(tmp_path / "left.rvol")
    return tmp_path


def test_replay_writes_the_bytes_of_the_session(session):
    data = result("volume", "replay", "a.rjournal", "--out", "out.rvol", cwd=session)
    assert (session / "out.rvol").read_bytes() == (session / "left.rvol").read_bytes()
    assert (data["strokes"], data["rows"], data["cut_at"], data["triangles"]) == (2, 8, None, None)


def test_replay_writes_a_mesh_and_uses_the_whole_strokes_of_a_truncated_journal(session):
    (session / "b").mkdir()
    whole = (session / "a.rjournal").read_bytes()
    (session / "b" / "cut.rjournal").write_bytes(whole[:-1])
    data = result("volume", "replay", "b/cut.rjournal", "--folder", ".", "--out", "out.stl", cwd=session)
    assert (data["strokes"], data["cut_at"]) == (3, len(whole) - 28), "up to the last stroke, which is not taken back"
    assert len(riffler.Mesh.read(session / "out.stl").triangles) == data["triangles"] < data["all_triangles"]
    assert (
        "cut off at byte"
        in riffle("volume", "replay", "b/cut.rjournal", "--folder", ".", "--out", "o.rvol", cwd=session).stdout
    )


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("a.rvol",), ".rjournal expected"),
        (("nowhere.rjournal",), "No such file"),
        (("a.rjournal", "--folder", "nowhere"), "stock.rvol"),
    ],
)
def test_errors_are_one_line(session, words, message):
    done = riffle("volume", "replay", *words, "--out", "out.rvol", cwd=session)
    assert done.returncode == 2 and message in done.stderr and len(done.stderr.splitlines()) == 1
    assert not (session / "out.rvol").exists()
