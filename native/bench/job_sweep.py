"""Every cutter x motion x tolerance: the compiled table of native/bench/sweep_error.cpp."""

from __future__ import annotations

import subprocess
from pathlib import Path

from report import Table

PROGRAM = Path("build/bench/native/bench/riffler_sweep_error")


def run():
    process = subprocess.Popen([PROGRAM, "100"], stdout=subprocess.PIPE, text=True)
    table = None
    for line in process.stdout:
        cells = [c.strip() for c in line.strip().strip("|").split("|")]
        if line.startswith("| cutter"):
            table = Table("Error of carving against the dense reference", *cells)
        elif line.startswith("| "):
            table.row(*cells)
        elif line.strip() and not line.startswith("|---"):
            table.note(line.strip())
    return table, process.wait() == 0
