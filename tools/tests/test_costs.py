"""A quick run leaves out the costliest tests of the last complete run, and nothing where there was none."""

import json
import os
import shutil
import subprocess
import sys

import pytest

import costs
from shell import ROOT

CONFTEST = ROOT / "native" / "tests" / "python" / "conftest.py"


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.setattr(costs, "FOLDER", tmp_path / "costs")
    return costs.FOLDER


def test_the_fewest_tests_are_left_out_that_bring_the_others_within_the_budget():
    seconds = {"a": 1.0, "b": 5.0, "c": 2.0, "d": 0.5}
    assert costs.costliest(seconds, 8.5) == []
    assert costs.costliest(seconds, 8.4) == ["b"] == costs.costliest(seconds, 3.5)
    assert costs.costliest(seconds, 3.4) == ["b", "c"]
    assert costs.costliest(seconds, 0) == ["b", "c", "a", "d"]


def test_without_a_complete_run_every_test_runs(capsys):
    assert costs.too_costly("cpp", 0) == []
    assert "cpp: no complete run yet" in capsys.readouterr().out


def test_what_is_left_out_is_counted(capsys):
    costs.record("cpp", {"a": 1.0, "b": 5.0, "c": 2.0})
    assert costs.too_costly("cpp", 4) == ["b"]
    assert "cpp: 1 of 3 tests left out, which cost 5 of 8 s" in capsys.readouterr().out


@pytest.mark.parametrize("text", ["", "{", "[1]", '{"a": "much"}', '{"a": null}'])
def test_a_damaged_file_leaves_nothing_out(folder, text):
    folder.mkdir()
    costs.file_of("cpp").write_text(text)
    assert costs.too_costly("cpp", 0) == []


def test_pytest_writes_the_costs_and_leaves_out_what_is_named(tmp_path):
    suite, written, named = tmp_path / "suite", tmp_path / "costs.json", tmp_path / "left.json"
    suite.mkdir()
    shutil.copy(CONFTEST, suite)
    (suite / "test_few.py").write_text("def test_one(): sum(range(10 ** 6))\n\ndef test_two(): assert False\n")

    def run(**variables):
        command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(suite)]
        environment = os.environ | variables
        return subprocess.run(command, env=environment, cwd=suite, capture_output=True, text=True, check=False)

    assert run(RIFFLER_TEST_COSTS=str(written)).returncode == 1
    found = json.loads(written.read_text())
    assert sorted(found) == ["test_few.py::test_one", "test_few.py::test_two"] and found["test_few.py::test_one"] > 0
    named.write_text(json.dumps(["test_few.py::test_two"]))
    done = run(RIFFLER_TESTS_LEFT_OUT=str(named))
    assert done.returncode == 0 and "1 passed, 1 deselected" in done.stdout
