"""The search for a Python that reads CAD files."""

import sys

import pytest

from addon.common import cad_python


def test_the_first_that_has_the_packages_is_taken():
    asked = []
    assert cad_python.find("", ["a", "b", "c"], lambda python: asked.append(python) or python == "b") == "b"
    assert asked == ["a", "b"]


def test_a_choice_without_the_packages_is_refused():
    with pytest.raises(ValueError, match=r"^/x/python has no package .*: install it there \(pip install"):
        cad_python.find("/x/python", ["a"], lambda python: python == "a")


def test_none_at_all_names_the_command():
    with pytest.raises(ValueError, match=r"pip install 'riffler\[cad\]'.*Riffler's preferences"):
        cad_python.find("", ["a"], lambda python: False)


def test_the_environments_choice_is_asked_first_and_each_once():
    found = cad_python.candidates({"RIFFLER_CAD_PYTHON": "/my/python"}, sys.executable)
    assert found[:2] == ["/my/python", sys.executable] and len(found) == len(set(found))


def test_what_cannot_run_has_no_packages(tmp_path):
    assert not cad_python.has_packages(str(tmp_path / "none"))
