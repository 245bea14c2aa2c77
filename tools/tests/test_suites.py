"""The suites run in parallel: all to the end, each one's output whole, the exit code that of the worst."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

import shell
import test

TOOLS = Path(__file__).resolve().parents[1]
SCRIPT = """
import sys
sys.path.insert(0, {tools!r})
import test
from pathlib import Path
from shell import StepError, main

def fine(): print("fine, it printed")
def broken(): raise StepError("it broke")
def crashed(): raise ValueError("it crashed")
def later(): print("later")

test.LOGS, test.HEARTBEAT, test.__file__ = Path({logs!r}), 0.05, {script!r}
test.SUITES = dict(
    fine=test.Suite(fine), broken=test.Suite(broken), crashed=test.Suite(crashed, lane=1),
    later=test.Suite(later, lane=1), last=test.Suite(later, stage=2), first=test.Suite(later, stage=0),
    unasked=test.Suite(later, always=False))
main(test.entry)
"""


def suites(folder, *names):
    """Runs them in a checkout whose path has a space."""
    script = folder / "my checkout" / "suites.py"
    script.parent.mkdir()
    script.write_text(SCRIPT.format(tools=str(TOOLS), logs=str(folder / "logs"), script=str(script)))
    return subprocess.run([sys.executable, script, *names], capture_output=True, text=True, timeout=120, check=False)


def rows(done):
    table = done.stdout.rpartition("==> tests: results")[2]
    return [line.split()[:2] for line in table.splitlines() if line]


def test_all_suites_run_to_the_end_and_one_failure_fails_the_run(tmp_path):
    done = suites(tmp_path)
    assert done.returncode == 1
    assert rows(done)[:4] == [["fine", "passed"], ["broken", "FAILED"], ["crashed", "FAILED"], ["later", "passed"]]
    # At the end, behind the table: what failed, and the lines that say so.
    end = done.stdout.rpartition("total")[2]
    for name, text in (("broken", "it broke"), ("crashed", "ValueError: it crashed")):
        assert f"==> tests: {name} failed; in " in end and end.count(text) == 1
    assert "fine" not in end
    begun = [line.split()[-1] for line in done.stdout.splitlines() if re.fullmatch(r"==> tests: \w+", line)]
    assert begun[0] == "first" and begun[-2:] == ["last", "results"]
    for text in ("fine, it printed", "it broke", "ValueError: it crashed"):
        assert done.stdout.count(text) == 1 + (text != "fine, it printed")
    assert "unasked" not in done.stdout
    assert "tests: running: " in done.stdout


def test_named_suites_run_and_pass(tmp_path):
    done = suites(tmp_path, "fine", "unasked", "fine")
    assert done.returncode == 0, done.stdout + done.stderr
    assert rows(done)[:2] == [["fine", "passed"], ["unasked", "passed"]]


@pytest.mark.parametrize("name, code", [("fine", 0), ("broken", 1)])
def test_a_single_suite_prints_while_it_runs(tmp_path, name, code):
    done = suites(tmp_path, name)
    assert done.returncode == code
    assert not (tmp_path / "logs").exists()
    assert rows(done)[0] == [name, "FAILED" if code else "passed"]


def test_an_unknown_suite_is_named(tmp_path):
    done = suites(tmp_path, "fine", "fin")
    assert done.returncode == 1 and "unknown suite 'fin'" in done.stderr and "fine, it printed" not in done.stdout


@pytest.mark.parametrize("cores, processes", [(1, "2"), (2, "4"), (16, "4")])
def test_few_and_many_cores_run_the_python_tests(monkeypatch, cores, processes):
    commands = []
    monkeypatch.setattr(test, "cores", lambda: cores)
    monkeypatch.setattr(test, "run", lambda *words, env: commands.append(words))
    test.python()
    (words,) = commands
    assert words[words.index("-n") + 1] == processes


def test_a_stamp_is_of_its_key_and_a_digest_of_names_and_contents(tmp_path, monkeypatch):
    monkeypatch.setattr(shell, "ROOT", tmp_path)
    (tmp_path / "a").write_text("1")
    before = shell.digest([tmp_path / "a"], "word")
    assert before == shell.digest([tmp_path / "a"], "word") != shell.digest([tmp_path / "a"], "other")
    (tmp_path / "a").rename(tmp_path / "b")
    assert before != shell.digest([tmp_path / "b"], "word")
    stamp = tmp_path / "x" / "stamp"
    assert not shell.is_stamped(stamp, before)
    shell.write_stamp(stamp, before)
    assert shell.is_stamped(stamp, before) and not shell.is_stamped(stamp, "")


def test_the_reason_under_a_failure_is_repeated_with_it():
    reasons = ["      Traceback (most recent call last):", "      AssertionError: ('cutter', 'free')"]
    log = ["  passed    1.00 s  fine", "  failed   window_feel", *reasons, "2 passed", "      not a reason"]
    assert test.failures("\n".join(log)) == log[1:4]
