"""Messages for users: errors of the system, invalid files, surfaces too large, tables of a report."""

import errno
import os

import pytest

from addon.common import diagnosis, problems
from addon.stock.pure import estimate


@pytest.mark.parametrize("code", sorted(problems.REMEDIES))
def test_an_error_of_the_system_names_the_file_and_what_helps(code):
    text = problems.said(OSError(code, os.strerror(code), "/a/b.stl"))
    assert text.startswith("/a/b.stl: ") and "choose" in text and "Errno" not in text


def test_other_errors_are_shown_unchanged_and_never_empty():
    assert problems.said(ValueError("pitch: 3")) == "pitch: 3"
    for nothing in (MemoryError(), MemoryError("std::bad_alloc")):
        assert "not enough memory" in problems.said(nothing)
    assert problems.said(MemoryError("rays: too many")) == "rays: too many"
    assert problems.said(RuntimeError()) == "RuntimeError"
    assert problems.said(OSError(errno.EIO, "Input/output error", "/a")) == "[Errno 5] Input/output error: '/a'"
    assert problems.said(FileNotFoundError("there is no folder /x")) == "there is no folder /x"


def test_a_message_begins_with_a_capital_and_names_stay_unchanged():
    large = problems.capitalised
    assert large("the mesh has no volume") == "The mesh has no volume"
    assert large("stroke: there are no rows") == "Stroke: there are no rows"
    for kept in ("Cube has no faces", "part.stl, byte 3: short", "3 paths", "/a/b is a folder", ""):
        assert large(kept) == kept
    assert large("cube is flat", ["torus", "cube"]) == "cube is flat"


def test_a_writable_file_is_accepted(tmp_path):
    problems.check_target(tmp_path / "new.stl")
    (tmp_path / "old.stl").write_text("old")
    problems.check_target(tmp_path / "old.stl")
    assert (tmp_path / "old.stl").read_text() == "old" and not (tmp_path / "new.stl").exists()


def test_a_file_that_cannot_be_written_is_named(tmp_path, monkeypatch):
    for path, words in ((tmp_path, "is a folder"), (tmp_path / "no" / "x.stl", "there is no folder")):
        with pytest.raises(ValueError, match=words):
            problems.check_target(path)
    with pytest.raises(ValueError, match="no file was chosen: give one a name"):
        problems.check_target("")
    for name in ("x.obj", "x", "x.stl.gz"):
        with pytest.raises(ValueError, match=f"choose a name that ends with .stl, not {name}"):
            problems.check_target(tmp_path / name, ".stl")
    problems.check_target(tmp_path / "x.STL", ".stl")
    monkeypatch.setattr(os, "access", lambda path, mode: False)
    with pytest.raises(ValueError, match="may not be written: choose another folder"):
        problems.check_target(tmp_path / "x.stl")


def test_a_file_that_cannot_be_read_is_named(tmp_path, monkeypatch):
    for path in (tmp_path, tmp_path / "x.rjournal"):
        with pytest.raises(ValueError, match=r"there is no file .*: choose another"):
            problems.check_source(path)
    with pytest.raises(ValueError, match="no file was chosen: choose one"):
        problems.check_source("")
    (tmp_path / "x.rjournal").write_text("")
    problems.check_source(tmp_path / "x.rjournal")
    monkeypatch.setattr(os, "access", lambda path, mode: False)
    with pytest.raises(ValueError, match="may not be read"):
        problems.check_source(tmp_path / "x.rjournal")


def test_a_surface_is_refused_by_its_triangles_not_by_its_box():
    cube = (2000.0, 2000.0, 2000.0)
    with pytest.raises(ValueError, match=r"The cube is 2000 × 2000 × 2000 mm, or 192.000.000 triangles at 0.5 mm"):
        estimate.check_surface("The cube", cube, estimate.box_area(cube), 0.5)
    estimate.check_surface("The cube", cube, estimate.box_area(cube), 2.0)  # 12 million
    estimate.check_surface("A rod across", cube, 1e5, 0.5)
    estimate.check_surface("No number", cube, float("nan"), 0.5)  # the volume refuses it with its own message


def test_boxes_have_the_predicted_number_of_triangles():
    """Two for each square of the pitch on six sides: 20 × 20 × 20 mm at 0.5 mm has 19 200 (counted in Blender)."""
    assert 2 * estimate.box_area((20, 20, 20)) / 0.5**2 == 19_200


def test_a_report_is_a_table_that_shows_whether_folders_can_be_used(tmp_path, monkeypatch):
    text = diagnosis.table("Title", [("a", "1"), ("longer", "2")])
    assert text == "Title\na       1\nlonger  2\n"
    assert diagnosis.folder(tmp_path) == str(tmp_path)
    assert diagnosis.folder(tmp_path / "x" / "y") == f"{tmp_path}/x/y, created on demand"
    monkeypatch.setattr(os, "access", lambda path, mode: False)
    assert "may not be written" in diagnosis.folder(tmp_path)
