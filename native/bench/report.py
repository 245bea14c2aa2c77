"""Markdown tables for the benchmark jobs, printed as they come and kept for docs/benchmarks.md."""

from __future__ import annotations

import platform
import sys
from pathlib import Path


def machine() -> str:
    """One line about the machine, without its name."""
    model = platform.processor() or platform.machine()
    for line in Path("/proc/cpuinfo").read_text().splitlines() if Path("/proc/cpuinfo").exists() else []:
        if line.startswith("model name"):
            model = line.split(":", 1)[1].strip()
            break
    import os

    return f"{model}, {len(os.sched_getaffinity(0))} cores, Python {platform.python_version()}"


class Table:
    """A table that appears row by row."""

    def __init__(self, title: str, *columns: str):
        self.lines = [f"### {title}", "", "| " + " | ".join(columns) + " |", "|" + "---|" * len(columns)]
        for line in self.lines:
            print(line)

    def row(self, *cells: object) -> None:
        line = "| " + " | ".join(str(c) for c in cells) + " |"
        self.lines.append(line)
        print(line)
        sys.stdout.flush()

    def note(self, text: str) -> None:
        self.lines += ["", text]
        print("\n" + text)

    def text(self) -> str:
        return "\n".join(self.lines) + "\n"
