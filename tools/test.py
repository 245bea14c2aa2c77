"""Runs the test suites, several at a time, all of them even if one fails; closes with a table of results and times.

    tools/test.py [SUITE ...]      cpp python tools docs blender (all of these without arguments), lint, asan, sanitize,
                                   quick

One suite alone prints as it goes. Several print their output whole, each when it ends, and a line every half minute
says what runs; the full texts stay in build/tests. Stages come one after the other. In a stage, suites of one lane run
one after the other, lanes in parallel.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass

import compiler_cache
import costs
import package
from preset import build_preset, test_preset
from shell import PYTHON, ROOT, StepError, cores, main, run, say, tool_environment

LOGS = ROOT / "build" / "tests"
HEARTBEAT = 30  # s
# What names a failure in the output of pytest, GoogleTest, the compiler, Blender's tests and the tools' own checks.
FAILURE = re.compile(r"^(FAILED|ERROR|E  |  failed )|\[  FAILED  \]|[Ee]rror: |\bFAILED\b")
REASON = " " * 6  # begins the lines of a reason (blender_tests/run.py)
FAILURES_SHOWN = 25
# Seconds of processor time of a quick run's tests.
QUICK_CPP, QUICK_PYTHON = 80.0, 160.0


def cpp() -> None:
    test_preset("release")


def python(budget: float | None = None) -> None:
    """Many tests wait for a pen's clock, and many use all cores themselves: two processes a core, within bounds. They
    share the tests' bytecode, even where the caller writes none: each would compile all tests again. `budget`: without
    the costliest, so that the others take so many seconds of processor time."""
    processes = min(4, 2 * cores())
    options = ["-n", str(processes), "--dist", "loadfile", "--durations=20", "--durations-min=0.5"]
    costs.FOLDER.mkdir(parents=True, exist_ok=True)
    cost_files = {"RIFFLER_TEST_COSTS": str(costs.file_of("python"))}
    if budget is not None:
        left_out = costs.file_of("left-out")
        left_out.write_text(json.dumps(costs.too_costly("python", budget)))
        cost_files = {"RIFFLER_TESTS_LEFT_OUT": str(left_out)}
    environment = tool_environment(PYTHONDONTWRITEBYTECODE="", **cost_files)
    run(PYTHON, "-m", "pytest", *options, "native/tests/python", env=environment)


def quick() -> None:
    """After a change: the C++ and the Python tests without the costliest."""
    try:
        test_preset("release", QUICK_CPP)
    finally:
        python(QUICK_PYTHON)


def tools() -> None:
    run(PYTHON, "-m", "pytest", "-p", "no:cacheprovider", "tools/tests")


def docs() -> None:
    run(PYTHON, "tools/check_docs.py")
    run(PYTHON, "tools/docs.py")


def blender() -> None:
    """What is tested is what goes out: the zips with the repaired wheel."""
    made = package.package()
    wheel = next(path for path in made if path.suffix == ".whl" and package.of_this_python(path))
    run(PYTHON, "blender_tests/run.py", "--wheel", wheel, "--zips", package.DIST)


def lint() -> None:
    """Style, layers, words, commit messages, types, and that every header stands alone."""
    run(PYTHON, "-m", "ruff", "check", ".")
    run(PYTHON, "-m", "ruff", "format", "--check", ".")
    sources = [path for folder in ("native", "device", "examples") for path in (ROOT / folder).rglob("*.[chp]*")]
    sources = sorted(path for path in sources if path.suffix in {".c", ".h", ".cpp", ".hpp"})
    run(PYTHON.with_name("clang-format"), "--dry-run", "-Werror", *sources)
    run(PYTHON, "tools/check_layers.py")
    run(PYTHON, "tools/check_words.py")
    run(PYTHON, "tools/check_commits.py")
    run(PYTHON, "tools/check_types.py")
    build_preset("release", "all_verify_interface_header_sets")


def asan() -> None:
    """What `sanitize` runs is compiled, behind everything else that wants the cores."""
    os.nice(10)
    build_preset("asan", "riffler_tests")


def sanitize() -> None:
    """The C++ tests under the address and undefined-behaviour sanitizers."""
    test_preset("asan")


@dataclass(frozen=True)
class Suite:
    run: Callable[[], None]
    stage: int = 1  # a stage begins when the one before has ended
    lane: int = 0  # suites of one lane and stage wait for each other
    always: bool = True  # also where no suite is named


# Blender's windows wait much of the time: the other lanes fill that in. The C++ tests have a stage of their own, with
# the sanitizers and without: some have threads that keep a pen's time, and next to Blender these come too late. With
# only those last and the other sanitized tests next to Blender, the whole took no less (32 min 25 s): Blender took
# longer by as much, and a test with a time limit failed.
SUITES = {
    "cpp": Suite(cpp, stage=0),
    "python": Suite(python),
    "quick": Suite(quick, always=False),
    "tools": Suite(tools, lane=2),
    "docs": Suite(docs, lane=2),
    "blender": Suite(blender, lane=1),
    "lint": Suite(lint, lane=2, always=False),
    "asan": Suite(asan, lane=2, always=False),
    "sanitize": Suite(sanitize, stage=2, always=False),
}


@dataclass
class Result:
    name: str
    outcome: str
    seconds: float


class Progress:
    """What runs since when, for a line every half minute, and what was printed, whole."""

    def __init__(self) -> None:
        self.running: dict[str, float] = {}
        self.lock = threading.Lock()

    def begin(self, name: str) -> None:
        with self.lock:
            self.running[name] = time.monotonic()
            say(f"tests: {name}")

    def end(self, result: Result, text: str) -> None:
        with self.lock:
            del self.running[result.name]
            say(f"tests: {result.name}: {result.outcome} in {result.seconds:.1f} s; it printed")
            print(text, flush=True)
            say(f"tests: {result.name}: {result.outcome} in {result.seconds:.1f} s")

    def heartbeat(self, over: threading.Event) -> None:
        while not over.wait(HEARTBEAT):
            with self.lock:
                now = time.monotonic()
                if running := ", ".join(f"{name} {now - since:.0f} s" for name, since in self.running.items()):
                    say(f"tests: running: {running}")


def run_alone(name: str) -> Result:
    start = time.monotonic()
    try:
        SUITES[name].run()
        outcome = "passed"
    except StepError as failure:
        print(failure, file=sys.stderr, flush=True)
        outcome = "FAILED"
    return Result(name, outcome, time.monotonic() - start)


def run_beside(name: str, progress: Progress) -> Result:
    """In a process of its own, with its output in a file."""
    progress.begin(name)
    start = time.monotonic()
    log = LOGS / f"{name}.log"
    with log.open("wb") as file:
        command = [sys.executable, __file__, "--one", name]
        code = subprocess.run(command, stdout=file, stderr=subprocess.STDOUT, check=False).returncode
    result = Result(name, "passed" if code == 0 else "FAILED", time.monotonic() - start)
    progress.end(result, log.read_text(errors="replace"))
    return result


def run_stages(names: list[str]) -> list[Result]:
    """All suites, the lanes of a stage in parallel; results in the order of `names`."""
    LOGS.mkdir(parents=True, exist_ok=True)
    progress, results, over = Progress(), {}, threading.Event()

    def run_lane(stage: int, lane: int) -> None:
        for name in names:
            if (SUITES[name].stage, SUITES[name].lane) == (stage, lane):
                results[name] = run_beside(name, progress)

    threading.Thread(target=progress.heartbeat, args=[over], daemon=True).start()
    for stage in sorted({SUITES[name].stage for name in names}):
        wanted = sorted({SUITES[name].lane for name in names if SUITES[name].stage == stage})
        lanes = [threading.Thread(target=run_lane, args=[stage, lane]) for lane in wanted]
        for thread in lanes:
            thread.start()
        for thread in lanes:
            thread.join()
    over.set()
    return [results[name] for name in names]


def failures(text: str) -> list[str]:
    """The last lines that name a failure with the indented lines under them, which say why, each once; without any, the
    last lines. They are printed behind the table: of a long log often only the end is kept."""
    lines = [line.rstrip()[:200] for line in text.splitlines()]
    found, under = {}, False
    for line in lines:
        under = bool(FAILURE.search(line)) or (under and line.startswith(REASON))
        if under:
            found[line] = None
    return list(found or lines)[-FAILURES_SHOWN:]


def entry() -> None:
    names = sys.argv[1:]
    if names[:1] == ["--one"]:
        sys.exit(run_alone(names[1]).outcome != "passed")
    names = list(dict.fromkeys(names)) or [name for name, suite in SUITES.items() if suite.always]
    if unknown := set(names) - set(SUITES):
        raise StepError(f"unknown suite {sorted(unknown)[0]!r}; there are {', '.join(SUITES)}")
    start = time.monotonic()
    if len(names) == 1:
        say(f"tests: {names[0]}")
        results = [run_alone(names[0])]
    else:
        results = run_stages(names)
    say(compiler_cache.report())
    say("tests: results")
    for result in results:
        print(f"{result.name:<10} {result.outcome:<8} {result.seconds:7.1f} s")
    print(f"{'total':<19} {time.monotonic() - start:7.1f} s", flush=True)
    for result in results:
        log = LOGS / f"{result.name}.log"
        if result.outcome == "FAILED" and len(results) > 1:
            say(f"tests: {result.name} failed; in {log}")
            print(*failures(log.read_text(errors="replace")), sep="\n", flush=True)
    if any(result.outcome == "FAILED" for result in results):
        sys.exit(1)


if __name__ == "__main__":
    main(entry)
