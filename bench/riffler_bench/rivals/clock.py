"""Clocks and memory for the scripts that measure rivals; knows nothing but Python's own library.

script.py FUNCTION ARGUMENTS      calls FUNCTION with the JSON ARGUMENTS and prints what it returns as JSON
"""

from __future__ import annotations

import json
import os
import statistics
import sys
import time
from pathlib import Path


def timed(work, repeats):
    """The last result, and the medians of wall and processor time."""
    wall, cpu, result = [], [], None
    for _ in range(repeats):
        result = None
        start = time.perf_counter(), time.process_time()
        result = work()
        wall.append(time.perf_counter() - start[0])
        cpu.append(time.process_time() - start[1])
    return result, {"wall_s": statistics.median(wall), "cpu_s": statistics.median(cpu)}


def peak_bytes():
    """This process's peak memory. Not getrusage's: that one still counts the process which started this one."""
    status = Path("/proc/self/status")
    lines = status.read_text().splitlines() if status.exists() else []
    return next((1024 * int(line.split()[1]) for line in lines if line.startswith("VmHWM")), None)


def main(functions):
    result = functions[sys.argv[1]](**json.loads(sys.argv[2]))
    print(json.dumps({**result, "peak_bytes": peak_bytes()}))
    sys.stdout.flush()
    os._exit(0)  # some of them do not end cleanly
