"""Runs benchmark jobs and writes their tables: python native/bench/run.py [job ...] [--out out/bench].

Jobs: b200, random, models, threads. Every figure compares with an independent reference or with a rival measured
in the same run; a rival that is not installed is named as left out.
"""

from __future__ import annotations

import argparse
import importlib
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from report import machine

JOBS = {
    "b200": "job_b200",
    "random": "job_random",
    "models": "job_models",
    "threads": "job_threads",
}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("jobs", nargs="*", choices=[*JOBS, []], help="jobs to run; all of them if none is named")
    parser.add_argument("--out", type=Path, default=Path("out/bench"))
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    print(f"{machine()}\n")
    good = True
    for name in args.jobs or JOBS:
        start = time.perf_counter()
        table, ok = importlib.import_module(JOBS[name]).run()
        (args.out / f"{name}.md").write_text(table.text())
        print(f"\n[{name}: {time.perf_counter() - start:.0f} s, {'good' if ok else 'BAD'}]\n")
        good &= ok
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
