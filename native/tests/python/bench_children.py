"""`riffler bench` with measurements in forked processes, which share one import: it takes longer than most short ones.

python bench_children.py WORDS…      runs ``riffler bench WORDS…``

A process imports what measurements need, and has no threads. For each measurement it forks a process, which gets the
environment and the arguments of the one that `riffler_bench.measure.child` starts, and runs the same function.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import traceback
from collections.abc import Iterator
from contextlib import contextmanager

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # as measure.child sets it, before numpy is imported

from riffler import cli
from riffler_bench import children, measure
from riffler_bench.rivals import clock


def serve(requests, answers) -> None:
    """Answers a line of JSON (words of the command, environment) with one of status and output."""
    for line in requests:
        words, environment = json.loads(line)
        output, far = os.pipe()
        process = os.fork()
        if not process:
            os.close(output)
            os._exit(measured(words, environment, far))
        os.close(far)
        with os.fdopen(output, encoding="utf-8") as text:
            said = text.read()
        _, status = os.waitpid(process, 0)
        print(json.dumps([os.waitstatus_to_exitcode(status), said]), file=answers, flush=True)


def measured(words: list[str], environment: dict[str, str], output: int) -> int:
    """Runs the words after ``python -m riffler_bench.children``, as that module does."""
    os.environ.clear()
    os.environ.update(environment)
    with os.fdopen(output, "w", encoding="utf-8") as out:
        try:
            result = children.WORK[words[0]](**json.loads(words[1]))
            print(json.dumps(result | {"peak_bytes": clock.peak_bytes()}), file=out)
        except BaseException:
            traceback.print_exc(file=out)
            return 1
    return 0


@contextmanager
def shared_import() -> Iterator[None]:
    """Within, `measure.child` gets its results from forked processes."""
    (requests, ours), (theirs, answers) = os.pipe(), os.pipe()
    server = os.fork()
    if not server:
        os.close(ours)
        os.close(theirs)
        with os.fdopen(requests) as lines, os.fdopen(answers, "w") as out:
            serve(lines, out)
        os._exit(0)
    os.close(requests)
    os.close(answers)
    asked, answered = os.fdopen(ours, "w"), os.fdopen(theirs)

    def started(command: list[str], environment: dict[str, str]) -> subprocess.CompletedProcess:
        assert command[:3] == [sys.executable, "-m", "riffler_bench.children"]
        print(json.dumps([command[3:], environment]), file=asked, flush=True)
        status, said = json.loads(answered.readline())
        return subprocess.CompletedProcess(command, status, said, said)

    measure.started = started
    yield
    asked.close()
    os.waitpid(server, 0)  # the processor time of all measurements counts as this process's


if __name__ == "__main__":
    with shared_import():
        status = cli.main(["bench", *sys.argv[1:]])
    sys.exit(status)
