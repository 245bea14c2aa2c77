"""Fuzzes the readers of files, each for a time, as many at once as there are cores:

tools/fuzz.py [--seconds 600] [--seed 1] [TARGET ...]

Readers in C++ run in native/fuzz's program under the address and undefined-behaviour sanitizers; those in Python by
fuzz_python.py. Both begin with the seeds and kept inputs of native/fuzz. An input that breaks a reader is written to
build/fuzz, and the command ends with 1: mend the reader, and keep the input in native/fuzz/kept/TARGET, where the tests
find it.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import fuzz_python
from preset import build_preset
from shell import PYTHON, ROOT, StepError, cores, main, say

FOUND = ROOT / "build" / "fuzz"
PROGRAM = FOUND / "native" / "fuzz" / "riffler_fuzz"  # the preset's folder has the same name
OPTIONS = {
    "ASAN_OPTIONS": "hard_rss_limit_mb=3000:max_allocation_size_mb=2000:detect_leaks=0:handle_abort=1",
    "UBSAN_OPTIONS": "print_stacktrace=1",
}


def native_targets() -> list[str]:
    return subprocess.run([PROGRAM], capture_output=True, text=True, check=True).stdout.split()


def fuzz(target: str, seconds: float, seed: int) -> bool:
    if target in fuzz_python.TARGETS:
        command = [PYTHON, ROOT / "tools" / "fuzz_python.py", target]
    else:
        command = [PROGRAM, target, "--folder", ROOT / "native" / "fuzz"]
    command += ["--seconds", str(seconds), "--seed", str(seed), "--found", FOUND / "found"]
    done = subprocess.run(command, capture_output=True, text=True, env=os.environ | OPTIONS, check=False)
    say(f"fuzz: {target}: " + (done.stdout.strip() if done.returncode == 0 else f"BROKEN ({done.returncode})"))
    if done.returncode:
        print(done.stdout + done.stderr, flush=True)
    return done.returncode == 0


def entry() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("targets", nargs="*")
    parser.add_argument("--seconds", type=float, default=600)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    if not given.targets or set(given.targets) - fuzz_python.TARGETS.keys():
        build_preset("fuzz", "riffler_fuzz")
    known = [*native_targets(), *fuzz_python.TARGETS] if PROGRAM.exists() else [*fuzz_python.TARGETS]
    for target in given.targets:
        if target not in known:
            raise StepError(f"unknown target {target}; known: {', '.join(known)}")
    with ThreadPoolExecutor(cores()) as pool:
        good = list(pool.map(lambda target: fuzz(target, given.seconds, given.seed), given.targets or known))
    sys.exit(0 if all(good) else 1)


if __name__ == "__main__":
    main(entry)
