"""Runs a GoogleTest program's tests in a process for every few of them, as many processes at once as there are cores.

A process takes 0.1 s to start and to end under the sanitizers, and 0.01 s without: one for each test, as ctest has it,
costs as much as most tests. A batch that fails is shown with all that it printed; tests that a crash kept from running
have failed.
"""

from __future__ import annotations

import re
import subprocess
import tempfile
from collections.abc import Collection
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

from shell import StepError, cores, say, tool_environment

BATCH = 12  # tests of a process: few, so that a slow batch is not the only one running at the end
LIMIT = 900  # s for a process
EVERY = 100  # tests from one line of progress to the next


@dataclass
class Outcome:
    names: list[str]
    times: list[tuple[float, str]]
    failed: list[str]
    printed: str


def names_of(program: Path) -> list[str]:
    """Every test as Suite.Name; what follows a # is a parameter's text."""
    done = subprocess.run(
        [program, "--gtest_list_tests"], capture_output=True, text=True, check=False, env=tool_environment()
    )
    if done.returncode != 0:
        raise StepError(f"{program} --gtest_list_tests failed:\n{done.stdout}{done.stderr}")
    names, suite = [], ""
    for line in done.stdout.splitlines():
        word = line.split("#")[0].rstrip()
        if line.startswith("  "):
            names.append(suite + word.strip())
        elif word.endswith("."):
            suite = word
    return names


def batches(names: list[str], size: int = BATCH) -> list[list[str]]:
    """Every n-th test to one batch: those of a suite, which cost alike, are spread over all."""
    count = -(-len(names) // size)
    return [names[k::count] for k in range(count)]


def seconds_of(case: ElementTree.Element) -> float:
    """A test's processor time, which native/tests/support/processor_time.cpp records; its time without that."""
    recorded = {entry.get("name"): entry.get("value") for entry in case.iter("property")}
    return float(recorded.get("processor_seconds") or case.get("time"))


def run_batch(program: Path, names: list[str]) -> Outcome:
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.xml"
        command = [program, f"--gtest_filter={':'.join(names)}", f"--gtest_output=xml:{report}"]
        try:
            done = subprocess.run(
                command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace", timeout=LIMIT,
                check=False, env=tool_environment(), cwd=program.parent,
            )  # fmt: skip
            printed, fine = done.stdout, done.returncode == 0
        except subprocess.TimeoutExpired as over:
            printed, fine = f"{(over.stdout or b'').decode(errors='replace')}\nstopped after {LIMIT} s", False
        cases = list(ElementTree.parse(report).iter("testcase")) if report.exists() else []
    times = {f"{c.get('classname')}.{c.get('name')}": seconds_of(c) for c in cases}
    broken = {f"{c.get('classname')}.{c.get('name')}" for c in cases if c.find("failure") is not None}
    failed = [name for name in names if name in broken or name not in times]
    if not fine and not failed:  # at the end, as leaks are found
        failed = names
    return Outcome(names, [(seconds, name) for name, seconds in times.items()], failed, printed)


def run_tests(program: Path, without: str = "", left: Collection[str] = ()) -> list[tuple[float, str]]:
    """All tests but those named in `left` and those in whose name the expression `without` is found: processor seconds
    and name of each. StepError naming those that failed, after what they printed."""
    left = set(left)
    names = [name for name in names_of(program) if name not in left and not (without and re.search(without, name))]
    if not names:
        raise StepError(f"{program} has no tests")
    times, failed, ended = [], [], 0
    with ThreadPoolExecutor(cores()) as pool:
        for outcome in pool.map(lambda some: run_batch(program, some), batches(names)):
            before, ended = ended, ended + len(outcome.names)
            times += outcome.times
            failed += outcome.failed
            if outcome.failed:
                print(outcome.printed, flush=True)
            if ended // EVERY > before // EVERY or ended == len(names):
                say(f"{ended} of {len(names)} tests, {len(failed)} failed")
    if failed:
        raise StepError(f"{len(failed)} of {len(names)} tests failed: {', '.join(failed)}")
    return times
