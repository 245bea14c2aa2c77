"""C++ tests in batches: every test is run once, and what fails, crashes or hangs fails by name."""

import stat

import pytest

import gtest_batches
from shell import StepError

# Answers as a GoogleTest program does, in Python; what a test does is in its name.
PROGRAM = """#!/usr/bin/env python3
import os, sys, time
names = [f"Few.{{kind}}" for kind in {kinds!r}]
options = dict(word.lstrip("-").partition("=")[::2] for word in sys.argv[1:])
if "gtest_list_tests" in options:
    print("Running main() from gtest_main.cc\\nFew.\\n" + "".join(f"  {{n[4:]}}  # GetParam() = 4\\n" for n in names))
    sys.exit(0)
cases, failed = "", False
for name in options["gtest_filter"].split(":"):
    print("[ RUN ]", name, flush=True)
    if "Crashes" in name: os.abort()
    if "Hangs" in name: time.sleep(60)
    failed |= "Fails" in name
    failure = "<failure/>" if "Fails" in name else ""
    recorded = '<properties><property name="processor_seconds" value="0.25"/></properties>' if "Records" in name else ""
    cases += f'<testcase classname="Few" name="{{name[4:]}}" time="0.5">{{failure}}{{recorded}}</testcase>'
open(options["gtest_output"].removeprefix("xml:"), "w").write(f"<testsuites>{{cases}}</testsuites>")
sys.exit(failed or "Leaks" in str(options))
"""


def program(tmp_path, *kinds):
    file = tmp_path / "my checkout" / "tests"
    file.parent.mkdir()
    file.write_text(PROGRAM.format(kinds=kinds))
    file.chmod(file.stat().st_mode | stat.S_IXUSR)
    return file


def test_every_test_runs_once_in_batches_that_are_full():
    names = [f"Suite.Test{k}" for k in range(31)]
    made = gtest_batches.batches(names, 12)
    assert sorted(name for batch in made for name in batch) == sorted(names) and [len(batch) for batch in made] == [
        11,
        10,
        10,
    ]


def test_passing_tests_report_their_times_and_excluded_ones_do_not_run(tmp_path):
    kinds = [f"Passes/{k}" for k in range(30)] + ["FailsButIsLeftOut"]
    times = gtest_batches.run_tests(program(tmp_path, *kinds), "LeftOut|Nothing")
    assert sorted(name for _, name in times) == sorted(f"Few.Passes/{k}" for k in range(30))
    assert {seconds for seconds, _ in times} == {0.5}


def test_tests_that_are_named_are_left_out(tmp_path):
    times = gtest_batches.run_tests(program(tmp_path, "Passes", "Fails"), left=["Few.Fails"])
    assert [name for _, name in times] == ["Few.Passes"]


def test_a_recorded_processor_time_replaces_the_time(tmp_path):
    times = gtest_batches.run_tests(program(tmp_path, "Passes", "Records"))
    assert sorted(times) == [(0.25, "Few.Records"), (0.5, "Few.Passes")]


def test_failing_tests_are_named_and_their_output_is_shown(tmp_path, capfd):
    with pytest.raises(StepError, match=r"^1 of 2 tests failed: Few\.Fails$"):
        gtest_batches.run_tests(program(tmp_path, "Passes", "Fails"))
    assert "[ RUN ] Few.Fails" in capfd.readouterr().out


@pytest.mark.parametrize("kind", ["Crashes", "Leaks"])
def test_a_batch_without_results_has_failed(tmp_path, kind):
    with pytest.raises(StepError, match=rf"tests failed: .*Few\.{kind}"):
        gtest_batches.run_tests(program(tmp_path, "Passes", kind))


def test_a_hanging_test_is_stopped(tmp_path, monkeypatch, capfd):
    monkeypatch.setattr(gtest_batches, "LIMIT", 0.5)
    with pytest.raises(StepError, match=r"Few\.Hangs"):
        gtest_batches.run_tests(program(tmp_path, "Hangs"))
    assert "stopped after 0.5 s" in capfd.readouterr().out


def test_a_program_without_tests_fails(tmp_path):
    with pytest.raises(StepError, match="has no tests"):
        gtest_batches.run_tests(program(tmp_path, "LeftOut"), "LeftOut")
