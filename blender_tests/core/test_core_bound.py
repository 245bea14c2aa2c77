"""The tests that the Blenders in the middle leave out, and the report on that."""

import ast
import json
import subprocess
import sys
from argparse import Namespace
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(HERE))
import run  # noqa: E402

from support import environments  # noqa: E402 (the path first)

ALL = len(list((HERE / "headless").rglob("test_*.py")))
# What differs between Blender's versions: tests that use it run in all of them.
DIFFERS = ("bpy.ops.ed.", "open_mainfile", "frame_set", "attributes", "insert(")


def marked():
    """(file, name, source) of each marked test."""
    for path in sorted((HERE / "headless").rglob("test_*.py")):
        text = path.read_text()
        for node in ast.parse(text).body:
            if isinstance(node, ast.FunctionDef) and "common.core_bound" in map(ast.unparse, node.decorator_list):
                yield path.name, node.name, ast.get_source_segment(text, node)


def test_no_marked_test_uses_features_that_differ_between_versions():
    found = list(marked())
    assert len(found) > 20
    assert all(name.startswith("test_") for _, name, _ in found)
    wrong = [(file, name, word) for file, name, text in found for word in DIFFERS if word in text]
    assert not wrong


def jobs(monkeypatch, capsys, versions, **more):
    """(Blender, installation mode, number of files, marks of tests that are left out) of each process, and the runs'
    output for three tests left out by each mark."""
    found = [environments.Environment(f"bpy {v}", tuple(map(int, v.split("."))), ["bpy"]) for v in versions]
    found.append(environments.Environment("bpy 9.9", (9, 9), [], "not there"))
    monkeypatch.setattr(environments, "find", lambda: found)
    seen = []

    def execute(command, variables, timeout):
        job = json.loads(Path(variables["RIFFLER_TEST_JOB"]).read_text())
        seen.append((job["leave_out"], len(job["files"])))
        lines = [{"name": "test", "outcome": "passed", "seconds": 0.1, "message": ""}]
        lines += [{"left": 3, "mark": mark} for mark in job["leave_out"]]
        return subprocess.CompletedProcess(command, 0, "\n".join(run.MARK + json.dumps(line) for line in lines), "")

    monkeypatch.setattr(environments, "execute", execute)
    bench = run.Bench([], {"extension": "e.zip", "legacy": "l.zip"}, Path("out"), "", 10, run.Tally())
    arguments = Namespace(**{"blender": "", "mode": None, "figures": False} | more)
    out = []
    for process in run.headless(bench, arguments):
        if process.func != bench.run or process.args[1] == "none":
            continue
        process()
        left, files = seen[-1]
        out.append((process.args[0].name, process.args[1], files, left))
    run.close(bench.tally)
    return out, capsys.readouterr().out


def test_middle_versions_skip_marked_tests_and_report_where_they_run(monkeypatch, capsys):
    found, said = jobs(monkeypatch, capsys, ["3.4", "4.2", "4.5", "5.0"])
    every, some = ALL, len(run.OF_THE_PLACE)
    assert found == [
        ("bpy 3.4", "legacy", every, []),
        ("bpy 4.2", "extension", every, ["core_bound"]),
        ("bpy 4.5", "source", some, ["core_bound", "anywhere"]),
        ("bpy 4.5", "extension", some, ["core_bound", "anywhere"]),
        ("bpy 5.0", "extension", every, []),
    ]
    line = "bpy 4.2, extension: tests that run in bpy 3.4 and bpy 5.0 only, because their time goes into the core: 3"
    assert said.count(line) == 2, "as it ends, and in the summary"
    line = "bpy 4.5, source: tests that do the same wherever the add-on is installed, which other Blenders run: 3"
    assert said.count(line) == 2


@pytest.mark.parametrize("more", [{"blender": "4.5"}, {"mode": "extension"}])
def test_a_named_blender_runs_everything(monkeypatch, capsys, more):
    found, said = jobs(monkeypatch, capsys, ["3.4", "4.2", "4.5", "5.0"], **more)
    assert found and not any(left for *_, left in found) and "left out" not in said
    assert {files for *_, files, _ in found} == {ALL}


def test_one_or_two_blenders_run_everything(monkeypatch, capsys):
    for versions in (["4.5"], ["4.2", "4.5"]):
        found, _ = jobs(monkeypatch, capsys, versions)
        assert found and not any(left for *_, left in found)
        assert {files for *_, files, _ in found} == {ALL}


def test_the_blender_of_installing_takes_the_branches_of_the_newest_one():
    """Each branch by a version is taken since that Blender or an earlier one, so by newer ones as well."""
    tree = ast.parse((run.ROOT / "addon" / "blender" / "versions.py").read_text())
    tuples = [
        ast.literal_eval(node)
        for node in ast.walk(tree)
        if isinstance(node, ast.Tuple) and ast.unparse(node)[1:2].isdigit()
    ]
    since = [version for version in tuples if version[0] >= 3]
    assert len(since) >= 4 and max(since)[:2] <= run.OF_INSTALLING, since


def test_windows_and_processes_without_one_are_spread_evenly():
    assert run.mixed(list("abc"), list("123456")) == list("a12b34c56")
    assert run.mixed([], [1, 2]) == [1, 2] and run.mixed([1], []) == [1]
